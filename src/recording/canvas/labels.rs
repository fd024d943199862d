//! Labels on the chart that keep off ships, marks and each other, in a window of 1280 × 800.

use rerun::{Color, LineStrips2D};

use super::{Canvas, flat, labelled, lines, style};
use crate::frame::Vector;
use crate::geometry::Window;
use crate::labels::{Drawn, Label, Needed};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, MAP, path};

/// Pixels of the viewer's labels: width of a letter on average, height of a line, margins around
/// the text, and from a point down to its label.
const LETTER: f64 = 6.4;
const LINE: f64 = 17.0;
const MARGINS: [f64; 2] = [10.0, 6.0];
const BELOW: f64 = 3.0;

/// Half the width in pixels of what the symbol of a ship covers along its track, and of a mark.
const HALF_SYMBOL: f64 = 5.5;
const HALF_MARK: f64 = 3.0;

/// Pixels between the corner of the chart and a text in it.
const CORNER: f64 = 12.0;

/// The labels of the chart that stay, and what they keep off.
#[derive(Debug)]
pub struct Labels {
    view: (Window, f64),
    drawn: Drawn,
    /// Boxes of labels, and of what else is there at all times.
    lasting: Vec<Window>,
    texts: Vec<(String, Color)>,
    places: Vec<Placed>,
}

/// The place of a label.
#[derive(Debug, Clone, Copy)]
pub struct Placed {
    /// The point below which the viewer draws the text.
    pub anchor: [f32; 2],
    pub leader: Option<[[f32; 2]; 2]>,
    /// The number of the place among those beside its position.
    pub number: usize,
}

impl Labels {
    pub fn new(canvas: &Canvas) -> Self {
        Self {
            view: (canvas.view(), canvas.pixel()),
            drawn: Drawn::default(),
            lasting: Vec::new(),
            texts: Vec::new(),
            places: Vec::new(),
        }
    }

    /// The same chart at a moment, with its labels and no ship.
    pub fn without_ships(&self) -> Self {
        Self {
            view: self.view,
            drawn: self.drawn.lines_and(self.lasting.clone()),
            lasting: Vec::new(),
            texts: Vec::new(),
            places: Vec::new(),
        }
    }

    /// Labels keep off a ship of a beam in metres on its way through these places.
    pub fn keep_off_track(&mut self, beam: f64, places: impl IntoIterator<Item = Vector>) {
        let half = (HALF_SYMBOL * self.view.1).max(0.5 * beam);
        let mut last: Option<Vector> = None;
        for place in places {
            if last.is_none_or(|last| (place - last).norm() > half) {
                self.keep_off(Window::at(place).grown(half));
                last = Some(place);
            }
        }
    }

    /// Labels keep off a mark from one place to another.
    pub fn keep_off_mark(&mut self, [from, to]: [Vector; 2]) {
        let half = HALF_MARK * self.view.1;
        let boxes = ((to - from).norm() / half).ceil().clamp(1.0, 1e3);
        for k in 0..=boxes as usize {
            let place = from + (to - from) * (k as f64 / boxes);
            self.reserve(Window::at(place).grown(half));
        }
    }

    /// Labels keep off what is there at all times.
    pub fn reserve(&mut self, covered: Window) {
        self.keep_off(covered);
        self.lasting.push(covered);
    }

    pub fn keep_off(&mut self, covered: Window) {
        self.drawn.boxes.push(covered);
    }

    /// Labels keep off a line if there is room.
    pub fn keep_off_line(&mut self, line: Vec<Vector>) {
        self.drawn.line(line);
    }

    /// Takes a place for a text beside a position; it stays at the number `last` while it can.
    pub fn place(&mut self, text: &str, at: Vector, last: Option<usize>) -> Option<Placed> {
        let half = half_size(text);
        let label = [Label { at, half }];
        let place = self.drawn.place(self.view, &label, Needed::Always, last)?;
        let leader = place.leader.map(|ends| ends.map(flat));
        Some(self.taken(place.window, leader, place.number))
    }

    fn taken(&mut self, covers: Window, leader: Option<[[f32; 2]; 2]>, number: usize) -> Placed {
        self.reserve(covers);
        let pixel = self.view.1;
        let top = covers.high.y + (BELOW - 0.5 * MARGINS[1]) * pixel;
        Placed {
            anchor: flat(Vector::new(covers.center().x, top)),
            leader,
            number,
        }
    }

    /// Adds a label beside a position.
    pub fn add(&mut self, text: &str, at: Vector, color: Color) {
        let placed = self.place(text, at, None);
        self.places.extend(placed);
        self.texts.extend(placed.map(|_| (text.to_owned(), color)));
    }

    /// Adds a text in the corner of the chart where it covers least; north is in the fourth.
    pub fn add_in_corner(&mut self, text: &str, color: Color) {
        let (view, pixel) = self.view;
        let half = half_size(text) * pixel;
        let inner = half.add_scalar(CORNER * pixel);
        let (low, high) = (view.low + inner, view.high - inner);
        let corners = [high, Vector::new(high.x, low.y), low];
        let boxes = corners.map(|center| Window::new(center - half, center + half));
        let covered = |place: &Window| self.drawn.boxes.iter().filter(|b| b.meets(place)).count();
        let least = boxes.into_iter().min_by_key(covered);
        let placed = least.map(|least| self.taken(least, None, 0));
        self.places.extend(placed);
        self.texts.extend(placed.map(|_| (text.to_owned(), color)));
    }

    pub fn log(&self, rec: &mut Recorder) -> Logged {
        if self.texts.is_empty() {
            return Ok(());
        }
        let (texts, colors): (Vec<String>, Vec<Color>) = self.texts.iter().cloned().unzip();
        let anchors = self.places.iter().map(|place| place.anchor);
        let texts = labelled(anchors, style::CHART_TEXT, 0.0, texts).with_colors(colors);
        let leaders = self.places.iter().filter_map(|place| place.leader);
        let leaders = leader_style().with_strips(leaders);
        let parts: [&dyn rerun::AsComponents; 2] = [&leaders, &texts];
        rec.log_static(path(&[MAP, "labels"]), &parts)
    }
}

/// Area that a label below a point covers.
#[cfg(test)]
pub fn covered(canvas: &Canvas, anchor: Vector, text: &str) -> Window {
    let half = half_size(text);
    let down = half.y + BELOW - 0.5 * MARGINS[1];
    let center = anchor - Vector::new(0.0, down) * canvas.pixel();
    let half = half * canvas.pixel();
    Window::new(center - half, center + half)
}

/// Half the size of a label, pixels.
fn half_size(text: &str) -> Vector {
    let letters = text.lines().map(|line| line.chars().count()).max();
    let width = LETTER * letters.unwrap_or(0) as f64 + MARGINS[0];
    let height = LINE * text.lines().count() as f64 + MARGINS[1];
    Vector::new(width, height) * 0.5
}

/// Thin lines from positions to labels that are not close to them.
pub fn leader_style() -> LineStrips2D {
    lines(style::CHART_TEXT, 0.5).with_draw_order(50.0)
}
