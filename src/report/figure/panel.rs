//! Panel: one pair of axes.

use kuva::plot::legend::{LegendEntry, LegendPosition, LegendShape};
use kuva::render::annotations::TextAnnotation;
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;

use super::Stroke;
use super::outline::{area, curve};
use super::render::shortened;
use crate::frame::{Pose, Vector, direction, to_port};
use crate::geometry::{ConvexPolygon, Window};
use crate::vessel::Hull;
use std::f64::consts::FRAC_PI_4;

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

/// Letters of a title that fit above a panel.
const LETTERS: usize = 58;

/// Letters of a line of the legend that fit below a panel.
const LEGEND_LETTERS: usize = 56;

/// Width in pixels of a letter of the legend, and of all that is beside the letters.
const LETTER: f64 = 5.5;
const LEGEND_SIDES: f64 = 58.0;

/// Where the legend of a narrow panel begins, in pixels.
const NARROW: f64 = 8.0;

/// Font size of a note in pixels.
const NOTE_SIZE: u32 = 11;

/// Shortest ship in pixels, and the beam of one of that length.
const SHIP: f64 = 15.0;
const BROAD: f64 = 0.4;

/// Corners of a ship in lengths ahead and beams to port.
const SHAPE: [[f64; 2]; 5] = [
    [0.5, 0.0],
    [0.1, 0.5],
    [-0.5, 0.5],
    [-0.5, -0.5],
    [0.1, -0.5],
];

/// Pixels between a position and its text, the nearest first.
const LABEL_PX: [f64; 3] = [7.0, 14.0, 24.0];

/// Sides of a position in eighths of a circle from east, in order of preference.
const SIDES: [usize; 8] = [2, 6, 0, 4, 1, 3, 7, 5];

/// One pair of axes and its content.
pub struct Panel {
    title: String,
    axes: [String; 2],
    window: Window,
    /// What the window contains at least.
    content: Window,
    /// Size in pixels of the area between the axes.
    area: [f64; 2],
    equal: bool,
    pub(super) plots: Vec<Plot>,
    legend: Vec<LegendEntry>,
    notes: Vec<TextAnnotation>,
    /// Texts and ships; labels keep clear of them and of the curves.
    taken: Vec<Window>,
    curves: Vec<Vec<Vector>>,
}

impl Panel {
    /// Creates a panel with equal axes. The window is widened to fill the panel. `axes` include
    /// units.
    pub(super) fn plan(title: String, axes: [&str; 2], window: Window) -> Self {
        Self {
            equal: true,
            ..Self::free(title, axes, window)
        }
        .sized(AREA)
    }

    /// Sets the size in pixels of the area between the axes.
    pub(super) fn sized(self, area: [f64; 2]) -> Self {
        let window = match self.equal {
            true => with_ratio(self.content, area[0] / area[1]),
            false => self.content,
        };
        Self {
            window,
            area,
            ..self
        }
    }

    pub(super) fn free(title: String, axes: [&str; 2], window: Window) -> Self {
        Self {
            title,
            axes: axes.map(str::to_owned),
            window,
            content: window,
            area: AREA,
            equal: false,
            plots: Vec::new(),
            legend: Vec::new(),
            notes: Vec::new(),
            taken: Vec::new(),
            curves: Vec::new(),
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

    pub(super) fn fill_hull(&mut self, points: &[Vector], colour: &str, opacity: f64) {
        if let Ok(hull) = ConvexPolygon::hull(points) {
            self.fill(&hull, colour, opacity);
        }
    }

    pub(super) fn curve(&mut self, points: &[Vector], closed: bool, stroke: Stroke) {
        self.plots.push(curve(points, closed, stroke));
        self.curves.push(points.to_vec());
    }

    pub(super) fn note(&mut self, text: &str, at: Vector) {
        let note = TextAnnotation::new(text, at.x, at.y).with_font_size(NOTE_SIZE);
        self.notes.push(note);
    }

    /// Metres of a pixel.
    pub(super) fn pixel(&self) -> f64 {
        self.window.size().x / self.area[0]
    }

    /// Draws a ship: its hull, or a symbol of the same course where the hull would be too small.
    pub(super) fn ship(&mut self, hull: &Hull, pose: &Pose, colour: &str) {
        let least = SHIP * self.pixel();
        let (length, beam) = if hull.length < least {
            (least, BROAD * least)
        } else {
            (hull.length, hull.beam)
        };
        let corners = SHAPE.map(|[x, y]| Vector::new(x * length, y * beam));
        let corners = corners.map(|corner| pose.world_coordinates(corner));
        self.fill_hull(&corners, colour, 1.0);
        self.taken.extend(Window::around(&corners));
    }

    /// Adds a text beside a position, where it covers least of what is there: the frame, texts and
    /// ships first, then lines.
    pub(super) fn label(&mut self, text: &str, at: Vector) {
        let size = f64::from(NOTE_SIZE);
        let half = Vector::new(0.3 * size * text.chars().count() as f64, 0.5 * size);
        let place = |(far, side): (f64, usize)| {
            let side = direction(FRAC_PI_4 * side as f64);
            let off = Vector::new(side.x * (half.x + far), side.y * (half.y + far));
            let center = at + off * self.pixel();
            let half = half * self.pixel();
            Window::new(center - half, center + half)
        };
        let places = LABEL_PX
            .iter()
            .flat_map(|far| SIDES.map(|side| place((*far, side))));
        let cost = |place: &Window| {
            let [low, high] = [place.low, place.high].map(|corner| self.window.contains(corner));
            let covered = self.taken.iter().filter(|other| other.meets(place)).count();
            let crossed = (self.curves.iter())
                .filter(|line| crosses(line, place))
                .count();
            let cut = usize::from(!low) + usize::from(!high);
            (cut, covered, crossed)
        };
        if let Some(best) = places.min_by_key(cost) {
            // a note is above its position
            let at = best.center() - Vector::new(0.0, size * self.pixel());
            self.note(text, at);
            self.taken.push(best);
        }
    }

    /// Height in pixels below the area for a legend with this many lines.
    pub(super) fn below(lines: usize) -> f64 {
        AXIS + if lines == 0 {
            0.0
        } else {
            LEGEND_FRAME + LEGEND_LINE * lines as f64
        }
    }

    /// Letters of a title that fit above this panel.
    fn title_letters(&self) -> usize {
        let [left, right, _] = MARGIN;
        let width = |area: f64| left + area + right;
        (LETTERS as f64 * width(self.area[0]) / width(AREA[0])) as usize
    }

    fn legend_entries(&self) -> Vec<LegendEntry> {
        let width = MARGIN[0] + self.area[0] + ALONE - LEGEND_SIDES;
        let letters = LEGEND_LETTERS.min((width / LETTER) as usize);
        let short = |entry: &LegendEntry| LegendEntry {
            label: shortened(&entry.label, letters),
            ..entry.clone()
        };
        self.legend.iter().map(short).collect()
    }

    pub(super) fn legend_lines(&self) -> usize {
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
            .with_title(shortened(&self.title, self.title_letters()))
            .with_x_label(self.axes[0].as_str())
            .with_y_label(self.axes[1].as_str())
            .with_x_axis_min(low.x)
            .with_x_axis_max(high.x)
            .with_y_axis_min(low.y)
            .with_y_axis_max(high.y)
            .with_ticks(6)
            .with_box_axes()
            .with_show_grid(false)
            .with_title_size(13)
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
            // a narrow panel has its legend below the whole of it
            let begin = if self.area[0] < AREA[0] { NARROW } else { left };
            layout = layout
                .with_legend_entries(self.legend_entries())
                .with_legend_position(LegendPosition::Custom(begin, top + self.area[1] + AXIS));
        }
        for note in &self.notes {
            layout = layout.with_annotation(note.clone());
        }
        layout
    }
}

/// True where a line runs through a box.
fn crosses(line: &[Vector], place: &Window) -> bool {
    let Window { low, high } = *place;
    let corners = [
        low,
        high,
        Vector::new(low.x, high.y),
        Vector::new(high.x, low.y),
    ];
    line.windows(2).any(|side| {
        let normal = to_port(side[1] - side[0]);
        let off = corners.map(|corner| normal.dot(&(corner - side[0])));
        let divided = off.iter().any(|d| *d > 0.0) && off.iter().any(|d| *d < 0.0);
        divided && Window::around(side).is_some_and(|side| side.meets(place))
    })
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

#[cfg(test)]
mod tests {
    use super::*;

    fn panel() -> Panel {
        let window = Window::new(Vector::zeros(), Vector::new(1000.0, 825.0));
        Panel::plan("Chart".to_owned(), ["East [m]", "North [m]"], window)
    }

    #[test]
    fn labels_keep_off_each_other_and_off_the_frame() {
        let mut panel = panel();
        for (at, count) in [(Vector::new(500.0, 400.0), 6), (Vector::new(2.0, 2.0), 2)] {
            for k in 0..count {
                panel.label(&format!("{k}00 s"), at);
            }
        }
        let taken = &panel.taken;
        assert_eq!(taken.len(), 8);
        for (k, here) in taken.iter().enumerate() {
            assert!(panel.window.contains(here.low) && panel.window.contains(here.high));
            assert!(taken[..k].iter().all(|other| !other.meets(here)));
        }
    }

    #[test]
    fn a_long_name_ends_within_the_legend() {
        let mut panel = panel();
        panel.line_key(&"ship_".repeat(40), Stroke::solid("#000000", 1.0));
        assert_eq!(
            panel.legend_entries()[0].label.chars().count(),
            LEGEND_LETTERS
        );
    }

    #[test]
    fn a_label_stands_beside_the_line_through_its_place() {
        let ends = [Vector::new(0.0, 400.0), Vector::new(1000.0, 420.0)];
        for line in [ends, ends.map(|p| Vector::new(p.y, p.x))] {
            let mut panel = panel();
            panel.curve(&line, false, Stroke::solid("#000000", 1.0));
            panel.label("600 s", 0.5 * (line[0] + line[1]));
            assert!(!crosses(&line, &panel.taken[0]));
            assert!(crosses(&line, &Window::at(line[1]).grown(1.0)));
        }
    }
}
