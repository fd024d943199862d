//! Panel: one pair of axes.

use kuva::plot::legend::{LegendEntry, LegendPosition, LegendShape};
use kuva::render::annotations::TextAnnotation;
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;

use super::Stroke;
use super::outline::{area, curve};
use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Window};

/// Size in pixels of the area between the axes.
pub(super) const AREA: [f64; 2] = [400.0, 330.0];

/// Margins in pixels: left, right, top. The legend is below.
pub(super) const MARGIN: [f64; 3] = [74.0, 106.0, 44.0];

/// Right margin in pixels of a single panel without a colour scale.
const ALONE: f64 = 18.0;

/// Height in pixels of the numbers and the label of the lower axis.
const AXIS: f64 = 64.0;

/// Offset in pixels by which the label of the lower axis is raised.
const LIFT: f64 = 16.0;

/// Height in pixels of a legend line, and its padding.
const LEGEND_LINE: f64 = 20.0;
const LEGEND_FRAME: f64 = 26.0;

/// Font size of a note in pixels.
const NOTE_SIZE: u32 = 11;

/// One pair of axes and its content.
pub struct Panel {
    title: String,
    axes: [String; 2],
    window: Window,
    equal: bool,
    pub(super) plots: Vec<Plot>,
    legend: Vec<LegendEntry>,
    notes: Vec<TextAnnotation>,
}

impl Panel {
    /// Creates a panel with equal axes. The window is widened to fill the panel. `axes` include
    /// units.
    pub(super) fn plan(title: String, axes: [&str; 2], window: Window) -> Self {
        Self {
            window: with_ratio(window, AREA[0] / AREA[1]),
            equal: true,
            ..Self::free(title, axes, window)
        }
    }

    /// Creates a panel whose axes have different units.
    pub(super) fn free(title: String, axes: [&str; 2], window: Window) -> Self {
        Self {
            title,
            axes: axes.map(str::to_owned),
            window,
            equal: false,
            plots: Vec::new(),
            legend: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Title.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Visible part of the plane.
    pub fn window(&self) -> Window {
        self.window
    }

    pub(super) fn line_key(&mut self, label: &str, stroke: Stroke) {
        self.legend.push(LegendEntry {
            label: label.to_owned(),
            color: stroke.colour.to_owned(),
            shape: LegendShape::Line,
            dasharray: stroke.dashed.then(|| "8 4".to_owned()),
        });
    }

    pub(super) fn point_key(&mut self, label: &str, colour: &str) {
        self.legend.push(LegendEntry {
            label: label.to_owned(),
            color: colour.to_owned(),
            shape: LegendShape::Circle,
            dasharray: None,
        });
    }

    /// Draws a filled polygon; without effect if its area is zero.
    pub(super) fn fill(&mut self, polygon: &ConvexPolygon, colour: &str, opacity: f64) {
        self.plots.extend(area(polygon, colour, opacity));
    }

    /// Fills the hull of points.
    pub(super) fn fill_hull(&mut self, points: &[Vector], colour: &str, opacity: f64) {
        if let Ok(hull) = ConvexPolygon::hull(points) {
            self.fill(&hull, colour, opacity);
        }
    }

    /// Draws a polyline, closed on request.
    pub(super) fn curve(&mut self, points: &[Vector], closed: bool, stroke: Stroke) {
        self.plots.push(curve(points, closed, stroke));
    }

    /// Adds a text at a position.
    pub(super) fn note(&mut self, text: &str, at: Vector) {
        let note = TextAnnotation::new(text, at.x, at.y).with_font_size(NOTE_SIZE);
        self.notes.push(note);
    }

    /// Adds a text on one side of a position, in the direction of a unit vector.
    pub(super) fn note_beside(&mut self, text: &str, at: Vector, side: Vector) {
        let size = f64::from(NOTE_SIZE);
        let half_width = 0.3 * size * text.chars().count() as f64;
        // a note is above its position
        let off = Vector::new(side.x * (half_width + size), side.y * 1.4 * size - size);
        self.note(text, at + off * (self.window.size().x / AREA[0]));
    }

    /// Height in pixels below the area for a legend with this many lines.
    pub(super) fn below(lines: usize) -> f64 {
        AXIS + if lines == 0 {
            0.0
        } else {
            LEGEND_FRAME + LEGEND_LINE * lines as f64
        }
    }

    pub(super) fn lines(&self) -> usize {
        self.legend.len()
    }

    /// Width in pixels that a single panel needs to the right of its area.
    pub(super) fn right(&self) -> f64 {
        if self.plots.iter().any(|p| p.colorbar_info(false).is_some()) {
            MARGIN[1]
        } else {
            ALONE
        }
    }

    /// Layout in a cell, with the pixels to the right of the area and below it.
    pub(super) fn layout(&self, right: f64, below: f64) -> Layout {
        let Window { low, high } = self.window;
        let [left, _, top] = MARGIN;
        let mut layout = Layout::new((low.x, high.x), (low.y, high.y))
            .with_title(self.title.as_str())
            .with_x_label(self.axes[0].as_str())
            .with_y_label(self.axes[1].as_str())
            .with_x_axis_min(low.x)
            .with_x_axis_max(high.x)
            .with_y_axis_min(low.y)
            .with_y_axis_max(high.y)
            .with_ticks(6)
            .with_box_axes()
            .with_show_grid(false)
            .with_title_size(15)
            .with_label_size(13)
            .with_tick_size(11)
            .with_body_size(11)
            .with_force_margins(left, right)
            .with_force_margins_y(top, below);
        layout.show_colorbar = self.plots.iter().any(|p| p.colorbar_info(false).is_some());
        // place the axis label next to its axis, above the legend
        layout = layout.with_x_label_offset(0.0, AXIS - below - LIFT);
        if self.equal {
            layout = layout.with_equal_aspect();
        }
        if !self.legend.is_empty() {
            layout = layout
                .with_legend_entries(self.legend.clone())
                .with_legend_position(LegendPosition::Custom(left, top + AREA[1] + AXIS));
        }
        for note in &self.notes {
            layout = layout.with_annotation(note.clone());
        }
        layout
    }
}

/// Bounding box of points, with a margin of `share` of its longer side. Without finite points, a
/// window of size 1 around the origin.
pub(super) fn window_around(points: impl IntoIterator<Item = Vector>, share: f64) -> Window {
    let points: Vec<Vector> = points.into_iter().collect();
    let finite = Window::around(&points).filter(|window| window.size().norm().is_finite());
    let window = finite.unwrap_or_else(|| Window::at(Vector::zeros()).grown(0.5));
    let side = window.size().max();
    window.grown(if side > 0.0 { share * side } else { 0.5 })
}

/// Widens a window about its centre until width over height is `ratio`.
fn with_ratio(window: Window, ratio: f64) -> Window {
    let size = window.size();
    let half = Vector::new(size.x.max(size.y * ratio), size.y.max(size.x / ratio)) * 0.5;
    let middle = window.center();
    Window::new(middle - half, middle + half)
}
