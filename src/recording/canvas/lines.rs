//! Lines with one style each, on the chart and in the space-time volume.

use rerun::{
    Color, LineStrips2D, LineStrips3D, Points2D, Radius, SerializedComponentColumn as Column,
};

use super::style;
use crate::recording::Logged;

pub type Strip = Vec<[f32; 2]>;

/// Columns of the lines of rows.
pub fn strip_columns(
    rows: impl IntoIterator<Item = Vec<Strip>>,
) -> Logged<impl Iterator<Item = Column>> {
    let rows: Vec<Vec<Strip>> = rows.into_iter().collect();
    let lengths: Vec<usize> = rows.iter().map(Vec::len).collect();
    let strips = LineStrips2D::update_fields().with_strips(rows.into_iter().flatten());
    Ok(strips.columns(lengths)?)
}

#[derive(Debug, Default)]
pub struct Lines<const AXES: usize> {
    strips: Vec<Vec<[f32; AXES]>>,
    colors: Vec<Color>,
    radii: Vec<Radius>,
}

impl<const AXES: usize> Lines<AXES> {
    /// Adds a line; `radius` is its half width in points of the screen.
    pub fn add(&mut self, strip: impl Into<Vec<[f32; AXES]>>, color: Color, radius: f32) {
        self.strips.push(strip.into());
        self.colors.push(color);
        self.radii.push(style::points(radius));
    }
}

impl Lines<2> {
    pub fn archetype(self) -> LineStrips2D {
        LineStrips2D::new(self.strips)
            .with_colors(self.colors)
            .with_radii(self.radii)
    }
}

impl Lines<3> {
    pub fn archetype(self) -> LineStrips3D {
        LineStrips3D::new(self.strips)
            .with_colors(self.colors)
            .with_radii(self.radii)
    }
}

/// Style of lines of one colour and half width in points of the screen.
pub fn lines(color: Color, radius: f32) -> LineStrips2D {
    LineStrips2D::update_fields()
        .with_colors([color])
        .with_radii([style::points(radius)])
}

/// Style of points of one colour and radius in points of the screen.
pub fn points(color: Color, radius: f32) -> Points2D {
    Points2D::update_fields()
        .with_colors([color])
        .with_radii([style::points(radius)])
}

/// Points of one colour and radius whose labels are always shown.
pub fn labelled(
    places: impl IntoIterator<Item = [f32; 2]>,
    color: Color,
    radius: f32,
    labels: impl IntoIterator<Item = impl Into<rerun::components::Text>>,
) -> Points2D {
    points(color, radius)
        .with_positions(places)
        .with_labels(labels)
        .with_show_labels(true)
}
