//! Panel: one pair of axes.

use std::sync::Arc;

use kuva::render::annotations::TextAnnotation;
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;

use super::Stroke;
use super::outline::{area, bends, curve};
use super::render::in_lines;
use crate::frame::{Pose, Vector};
use crate::geometry::{ConvexPolygon, Window};
use crate::labels::{Drawn, Label, Needed};
use crate::text::broken;
use crate::vessel::Hull;

/// Size in pixels of the area between the axes.
pub(super) const AREA: [f64; 2] = [400.0, 330.0];

/// Width in pixels below which an area is small.
const SMALL: f64 = 300.0;

/// Margins in pixels: right with a colour scale, and left with numbers, of a small area too.
const SCALE: f64 = 106.0;
const LEFT: [f64; 2] = [68.0, 56.0];

/// Pixels by which the label of the left axis gives way to its numbers.
const ASIDE: f64 = 6.0;

/// Margins in pixels: without numbers, right without a colour scale, above with and without title.
const BARE: f64 = 5.0;
const RIGHT: f64 = 12.0;
const TOP: [f64; 2] = [31.0, 8.0];

/// Height in pixels of the numbers and the label of the lower axis.
const AXIS: f64 = 38.0;

/// Letters of a line of a title that fit above a panel, and the height of a further line as a multiple
/// of its size.
pub(super) const LETTERS: usize = 58;
const LINE: f64 = 1.17;

/// Letters of a line of a name on a chart.
const NAME: usize = 24;

/// Pixels by which a title is larger than other texts.
const TITLE: u32 = 2;

/// Least pixels between two numbers of the lower axis, and of the left one.
const TICKS: [f64; 2] = [44.0, 28.0];

/// Shortest ship in pixels, in a small area too, and the beam of one of that length.
const SHIP: [f64; 2] = [15.0, 11.0];
const BROAD: f64 = 0.4;

/// Corners of a ship in lengths ahead and beams to port.
const SHAPE: [[f64; 2]; 5] = [
    [0.5, 0.0],
    [0.1, 0.5],
    [-0.5, 0.5],
    [-0.5, -0.5],
    [0.1, -0.5],
];

/// Line to a text that is not close to its position.
const LEADER: Stroke = Stroke::solid("#555555", 0.6);

/// Separates the colour of a note from its text, as the drawing library has black notes alone.
pub(super) const COLOURED: char = '\0';

/// Brightness of a text in the colour of a ship, as a fraction of it.
const TEXT_SHADE: f64 = 0.75;

/// A name in lines that fit beside a ship.
pub(super) fn name_lines(name: &str) -> String {
    broken(name, NAME, "")
}

/// True for an area without room for details.
pub(super) fn is_small(area: [f64; 2]) -> bool {
    area[0] < SMALL
}

/// Font size in pixels of notes, numbers and legends.
pub(super) fn text_size(area: [f64; 2]) -> u32 {
    if is_small(area) { 10 } else { 11 }
}

/// Width of the longest line of a text in pixels, on average.
pub(super) fn text_width(text: &str, area: [f64; 2]) -> f64 {
    let line = |line: &str| line.chars().map(letter_width).sum();
    let longest = text.lines().map(line).fold(0.0, f64::max);
    f64::from(text_size(area)) * longest
}

/// Width of a letter of DejaVu Sans, as a fraction of its size.
fn letter_width(letter: char) -> f64 {
    match letter {
        'i' | 'j' | 'l' | 'I' | ' ' | ',' | '.' | ':' | ';' | '\'' => 0.32,
        'f' | 'r' | 't' | '-' | '(' | ')' | '/' => 0.4,
        'm' | 'w' | 'M' | 'W' | '%' | '…' => 0.95,
        letter if letter.is_uppercase() => 0.72,
        _ => 0.62,
    }
}

/// One entry of the legend: a line, or an area of an opacity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Key {
    pub label: String,
    pub stroke: Stroke,
    pub filled: Option<f64>,
}

/// One pair of axes and its content.
pub struct Panel {
    title: String,
    axes: [String; 2],
    window: Window,
    /// The part of the plane that the window contains at least.
    content: Window,
    /// Size in pixels of the area between the axes.
    area: [f64; 2],
    equal: bool,
    pub(super) plots: Vec<Plot>,
    legend: Vec<Key>,
    notes: Vec<TextAnnotation>,
    /// Areas that texts keep clear of.
    drawn: Drawn,
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
            drawn: Drawn::default(),
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

    /// Replaces the names of the axes.
    pub(super) fn rename_axes(&mut self, axes: [&str; 2]) {
        self.axes = axes.map(str::to_owned);
    }

    pub(super) fn remove_title(&mut self) {
        self.title.clear();
    }

    pub(super) fn legend(&self) -> &[Key] {
        &self.legend
    }

    fn key(&mut self, label: &str, stroke: Stroke, filled: Option<f64>) {
        let label = label.to_owned();
        self.legend.push(Key {
            label,
            stroke,
            filled,
        });
    }

    pub(super) fn line_key(&mut self, label: &str, stroke: Stroke) {
        self.key(label, stroke, None);
    }

    pub(super) fn area_key(&mut self, label: &str, colour: &'static str, opacity: f64) {
        self.key(label, Stroke::solid(colour, 1.0), Some(opacity));
    }

    /// Visible part of the plane without the frame around it.
    pub(super) fn inside(&self) -> Window {
        self.window.grown(-self.pixel())
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
        self.drawn.line(bends(points));
    }

    /// Labels keep off a line that is drawn already.
    pub(super) fn keep_off(&mut self, points: &[Vector]) {
        self.drawn.line(bends(points));
    }

    /// Fills a set, from which labels keep clear, with its boundary.
    pub(super) fn fill_set(&mut self, points: &[Vector], colour: &'static str, opacity: f64) {
        if let Ok(hull) = ConvexPolygon::hull(points) {
            self.fill(&hull, colour, opacity);
            self.curve(points, true, Stroke::solid(colour, 1.0));
            self.drawn.fill(hull);
        }
    }

    /// Writes a text in a darker shade of a colour.
    pub(super) fn note(&mut self, text: &str, at: Vector, colour: &str) {
        let text = format!("{}{COLOURED}{text}", shaded(colour));
        let note = TextAnnotation::new(text, at.x, at.y);
        self.notes.push(note.with_font_size(text_size(self.area)));
    }

    /// Metres of a pixel.
    pub(super) fn pixel(&self) -> f64 {
        self.window.size().x / self.area[0]
    }

    /// Draws a ship: its hull, or a symbol of the same course where the hull would be too small.
    pub(super) fn ship(&mut self, hull: &Hull, pose: &Pose, colour: &str) {
        let least = SHIP[usize::from(is_small(self.area))] * self.pixel();
        let (length, beam) = if hull.length < least {
            (least, BROAD * least)
        } else {
            (hull.length, hull.beam)
        };
        let corners = SHAPE.map(|[x, y]| Vector::new(x * length, y * beam));
        let corners = corners.map(|corner| pose.world_coordinates(corner));
        self.fill_hull(&corners, colour, 1.0);
        self.drawn.boxes.extend(Window::around(&corners));
    }

    /// Adds one of some texts beside its position, where it covers least of what is there: the
    /// frame, texts and ships first, then filled areas, then lines. Returns the position.
    pub(super) fn label(
        &mut self,
        texts: &[(String, Vector)],
        colour: &str,
        needed: Needed,
    ) -> Option<Vector> {
        let (size, pixel) = (f64::from(text_size(self.area)), self.pixel());
        let label = |(text, at): &(String, Vector)| Label {
            at: *at,
            half: Vector::new(
                0.5 * text_width(text, self.area),
                0.5 * LINE * size * text.lines().count() as f64,
            ),
        };
        let labels: Vec<Label> = texts.iter().map(label).collect();
        let view = (self.window, pixel);
        let place = self.drawn.place(view, &labels, needed, None)?;
        if let Some(leader) = place.leader {
            self.curve(&leader, false, LEADER);
        }
        let best = place.window;
        let corner = |x: f64, y: f64| Vector::new(x, y);
        let Window { low, high } = best;
        let around = [low, corner(high.x, low.y), high, corner(low.x, high.y)];
        self.fill_hull(&around, "#ffffff", 0.6);
        let (text, at) = &texts[place.index];
        for (index, line) in text.lines().enumerate() {
            // a note is above its position
            let down = ((index as f64 + 0.5) * LINE + 1.0) * size * pixel;
            let below = corner(best.center().x, high.y - down);
            self.note(line, below, colour);
        }
        self.drawn.boxes.push(best);
        Some(*at)
    }

    /// A text that gives way to others, and in a small area to filled ones.
    pub(super) fn optional(&self) -> Needed {
        Needed::OffFirst(if is_small(self.area) { 3 } else { 2 })
    }

    /// Width in pixels to the left of an area.
    pub(super) fn left(area: [f64; 2], numbered: bool) -> f64 {
        match numbered {
            true => LEFT[usize::from(is_small(area))],
            false => BARE,
        }
    }

    /// Height in pixels below an area.
    pub(super) fn below(numbered: bool) -> f64 {
        if numbered { AXIS } else { BARE }
    }

    /// Height in pixels above the area.
    pub(super) fn top(&self) -> f64 {
        let further = self.title_lines().len().saturating_sub(1) as f64;
        let line = LINE * f64::from(text_size(self.area) + TITLE);
        TOP[usize::from(self.title.is_empty())] + line * further
    }

    fn title_lines(&self) -> Vec<String> {
        let share = (self.area[0] + LEFT[0]) / (AREA[0] + LEFT[0]);
        in_lines(&self.title, (LETTERS as f64 * share) as usize)
    }

    /// Width in pixels to the right of the area.
    pub(super) fn right(&self) -> f64 {
        if self.has_scale() { SCALE } else { RIGHT }
    }

    fn has_scale(&self) -> bool {
        self.plots.iter().any(|p| p.colorbar_info(false).is_some())
    }

    /// Layout in a cell, with the pixels to the left of the area, to the right, above and below,
    /// and whether the vertical and the lower axis have numbers.
    pub(super) fn layout(&self, sides: [f64; 4], numbered: [bool; 2]) -> Layout {
        let Window { low, high } = self.window;
        let [left, right, top, below] = sides;
        let size = text_size(self.area);
        let steps = [0, 1].map(|i| {
            let least = (high - low)[i] / self.area[i] * TICKS[i];
            tick_step(low[i], high[i], least)
        });
        let mut layout = Layout::new((low.x, high.x), (low.y, high.y))
            .with_x_axis_min(low.x)
            .with_x_axis_max(high.x)
            .with_y_axis_min(low.y)
            .with_y_axis_max(high.y)
            .with_x_tick_step(steps[0])
            .with_y_tick_step(steps[1])
            .with_tick_format(TickFormat::Custom(Arc::new(tick_text)))
            .with_box_axes()
            .with_show_grid(false)
            .with_title_size(size + TITLE)
            .with_label_size(size + 1)
            .with_tick_size(size)
            .with_body_size(size)
            .with_force_margins(left, right)
            .with_force_margins_y(top, below);
        layout.show_colorbar = self.has_scale();
        if !self.title.is_empty() {
            let lines = self.title_lines();
            // lines are broken already
            layout = layout
                .with_title(lines.join("\n"))
                .with_title_wrap(usize::MAX);
        }
        layout.suppress_y_ticks = !numbered[0];
        layout.suppress_x_ticks = !numbered[1];
        if numbered[0] {
            layout = layout
                .with_y_label(self.axes[1].as_str())
                .with_y_label_offset(-ASIDE, 0.0);
        }
        if numbered[1] {
            layout = layout.with_x_label(self.axes[0].as_str());
        }
        if self.equal {
            layout = layout.with_equal_aspect();
        }
        for note in &self.notes {
            layout = layout.with_annotation(note.clone());
        }
        layout
    }
}

/// Next of 1, 2, 5, 10, 20, … times a power of ten that is at least `least`.
pub(super) fn round_step(least: f64) -> f64 {
    if !(least > 0.0 && least.is_finite()) {
        return 1.0;
    }
    let power = 10.0_f64.powf(least.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|s| s * power);
    let fits = |s: &&f64| **s >= least * (1.0 - 1e-9);
    steps.iter().find(fits).copied().unwrap_or(10.0 * power)
}

/// Round step of at least `least` between the numbers of an axis; a smaller one where fewer than two
/// numbers would be on it.
fn tick_step(low: f64, high: f64, least: f64) -> f64 {
    let numbers = |step: f64| (high / step).floor() - (low / step).ceil() + 1.0;
    let mut step = round_step(least);
    while numbers(step) < 2.0 && step > 0.1 * least {
        step = round_step(0.4 * step);
    }
    step
}

/// The number of a tick. One below a hundredth has an exponent, and is rounded: it is a multiple of
/// the step up to the rounding of the machine, of which it would show all digits.
fn tick_text(value: f64) -> String {
    let rounded = match value.abs() < 0.01 {
        true => format!("{value:.5e}").parse().unwrap_or(value),
        false => value,
    };
    TickFormat::Auto.format(rounded)
}

/// A darker shade of a colour `#rrggbb`.
fn shaded(colour: &str) -> String {
    let part = |at: usize| u8::from_str_radix(colour.get(at..at + 2)?, 16).ok();
    let shade = |part: Option<u8>| (TEXT_SHADE * f64::from(part.unwrap_or(0))) as u8;
    let [red, green, blue] = [1, 3, 5].map(|at| shade(part(at)));
    format!("#{red:02x}{green:02x}{blue:02x}")
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
pub(super) fn with_ratio(window: Window, ratio: f64) -> Window {
    let size = window.size();
    let half = Vector::new(size.x.max(size.y * ratio), size.y.max(size.x / ratio)) * 0.5;
    let middle = window.center();
    Window::new(middle - half, middle + half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_axis_has_two_numbers() {
        for (low, high) in [(-1.1, 1.6), (1.0, 9.0), (-0.4, 0.4), (1e5 + 1.0, 1e5 + 1.7)] {
            for pixels in [100.0, 70.0, 400.0] {
                let step = tick_step(low, high, (high - low) / pixels * TICKS[0]);
                let numbers = ((low / step).ceil() as i64..=(high / step).floor() as i64).count();
                assert!(
                    (2..=10).contains(&numbers),
                    "{low} {high} {pixels}: {numbers}"
                );
            }
        }
        assert_eq!(
            [tick_step(0.0, f64::NAN, f64::NAN), round_step(0.4 * 0.5)],
            [1.0, 0.2]
        );
    }
}
