//! Places of labels in a drawing: point-feature label placement, one label after another.

use std::f64::consts::FRAC_PI_4;

use crate::frame::{Vector, direction, to_port};
use crate::geometry::{ConvexPolygon, Window};

/// Pixels between a position and its label, the nearest first; farther than the second constant,
/// a leader leads to the label.
const AWAY: [f64; 6] = [7.0, 14.0, 24.0, 40.0, 60.0, 85.0];
const WITHOUT_LEADER: f64 = 14.0;

/// Length of a short line of a text, as a fraction of the longest.
const SHORT_LINE: f64 = 0.4;

/// Points along a leader, as fractions of it, that keep off texts; the second is its middle.
const LEADER: [f64; 5] = [0.3, 0.5, 0.65, 0.8, 0.95];

/// Pixels that a label goes farther to keep off the frame, a text or ship, a filled area, a line.
const COSTS: [f64; 4] = [1000.0, 300.0, 60.0, 40.0];

/// Cost in pixels of the next best position.
const NEXT: f64 = 20.0;

/// Pixels that a label goes farther to stay where it was.
const STAY: f64 = 40.0;

/// Sides of a position in eighths of a circle from east, in order of preference.
const SIDES: [usize; 8] = [2, 6, 0, 4, 1, 3, 7, 5];

/// Areas of a drawing that labels keep clear of.
#[derive(Debug, Clone, Default)]
pub(crate) struct Drawn {
    /// Boxes of texts and ships.
    pub boxes: Vec<Window>,
    /// Filled areas with the boxes around them.
    filled: Vec<(Window, ConvexPolygon)>,
    /// Lines with the boxes around them.
    lines: Vec<(Window, Vec<Vector>)>,
}

/// A position with half the size of its label, pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Label {
    pub at: Vector,
    pub half: Vector,
}

/// The least that a label has to keep off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Needed {
    /// It is drawn in any case.
    Always,
    /// It stands close to its position, and only where it covers nothing of the first kinds: frame,
    /// boxes, filled areas, lines.
    OffFirst(usize),
}

/// Where a label stands.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// The position that was chosen.
    pub index: usize,
    pub window: Window,
    /// From the position to a label that is not close to it.
    pub leader: Option<[Vector; 2]>,
    /// The number of the place among those beside a position.
    #[cfg_attr(
        not(feature = "recording"),
        allow(dead_code, reason = "labels move in recordings alone")
    )]
    pub number: usize,
}

impl Drawn {
    /// Adds a filled area.
    pub fn fill(&mut self, set: ConvexPolygon) {
        let around = Window::around(set.vertices());
        self.filled.extend(around.map(|around| (around, set)));
    }

    /// Adds a line.
    pub fn line(&mut self, points: Vec<Vector>) {
        let around = Window::around(&points);
        self.lines.extend(around.map(|around| (around, points)));
    }

    /// The lines alone, with other boxes.
    #[cfg(feature = "recording")]
    pub fn lines_and(&self, boxes: Vec<Window>) -> Self {
        Self {
            boxes,
            filled: Vec::new(),
            lines: self.lines.clone(),
        }
    }

    /// The place beside one of some positions where a label covers least: the frame, texts and ships
    /// first, then filled areas, then lines. A label that was at the place of number `last` stays
    /// there unless another is much better. `view` is the visible part of the plane and the size of
    /// a pixel in it. O(positions × (boxes + areas + points of lines)).
    pub fn place(
        &self,
        (view, pixel): (Window, f64),
        labels: &[Label],
        needed: Needed,
        last: Option<usize>,
    ) -> Option<Place> {
        let beside = |index: usize, number: usize| {
            let Label { at, half } = labels[index];
            let far = AWAY[number / SIDES.len()];
            let side = direction(FRAC_PI_4 * SIDES[number % SIDES.len()] as f64);
            let off = Vector::new(side.x * (half.x + far), side.y * (half.y + far));
            let center = at + off * pixel;
            let window = Window::new(center - half * pixel, center + half * pixel);
            // lines of a text differ in length: from above and below a leader meets the middle
            let is_beside = window.low.y <= at.y && at.y <= window.high.y;
            let part = if is_beside { 1.0 } else { SHORT_LINE };
            let reach = Vector::new(part * half.x, half.y) * pixel;
            let leader = [at, at.sup(&(center - reach)).inf(&(center + reach))];
            Place {
                index,
                window,
                leader: (far > WITHOUT_LEADER).then_some(leader),
                number,
            }
        };
        let mut best = None;
        let mut least = f64::INFINITY;
        for (index, number) in (0..labels.len()).flat_map(|index| {
            let numbers = 0..AWAY.len() * SIDES.len();
            numbers.map(move |number| (index, number))
        }) {
            let place = beside(index, number);
            if needed != Needed::Always && place.leader.is_some() {
                continue;
            }
            let mut cost = AWAY[number / SIDES.len()] + NEXT * index as f64;
            if last.is_some_and(|last| last != number) {
                cost += STAY;
            }
            // a leader along a line or through a text is not seen
            let leader = place.leader.map(|[at, end]| {
                let along = LEADER.map(|part| at + part * (end - at));
                along.map(|point| Window::at(point).grown(2.0 * pixel))
            });
            for (kind, weight) in COSTS.into_iter().enumerate() {
                // most places are dearer than the best one long before all is counted
                if !(cost < least) {
                    break;
                }
                let count = self.covered(kind, view, &place.window, leader.as_ref());
                if matches!(needed, Needed::OffFirst(kinds) if kind < kinds && count > 0) {
                    cost = f64::INFINITY;
                }
                cost += count as f64 * weight;
            }
            if cost < least {
                (least, best) = (cost, Some(place));
            }
        }
        best
    }

    /// How much of a kind of [`COSTS`] a label and its leader cover: the frame, texts and ships,
    /// filled areas, lines.
    fn covered(
        &self,
        kind: usize,
        view: Window,
        place: &Window,
        leader: Option<&[Window; LEADER.len()]>,
    ) -> usize {
        let meets = |place: &Window| self.boxes.iter().filter(|other| other.meets(place)).count();
        let crossed = |place: &Window| {
            let lines = self.lines.iter().filter(|(around, _)| around.meets(place));
            lines.filter(|(_, line)| crosses(line, place)).count()
        };
        let filled = |(around, set): &&(Window, ConvexPolygon)| {
            around.meets(place) && !place.part_of(set).is_empty()
        };
        match kind {
            0 => {
                let ends = [place.low, place.high].into_iter();
                ends.filter(|corner| !view.contains(*corner)).count()
            }
            1 => meets(place),
            2 => {
                let most = leader.into_iter().flatten().map(meets).max();
                self.filled.iter().filter(filled).count() + most.unwrap_or(0)
            }
            _ => crossed(place) + leader.map_or(0, |points| crossed(&points[1])),
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A drawing of a metre per pixel.
    const VIEW: Window = Window {
        low: Vector::new(0.0, 0.0),
        high: Vector::new(1000.0, 800.0),
    };

    fn label(at: Vector) -> Label {
        let half = Vector::new(30.0, 8.0);
        Label { at, half }
    }

    fn placed(drawn: &Drawn, at: Vector, last: Option<usize>) -> Place {
        let place = drawn.place((VIEW, 1.0), &[label(at)], Needed::Always, last);
        place.expect("always")
    }

    #[test]
    fn labels_keep_off_each_other_and_off_the_frame() {
        let mut drawn = Drawn::default();
        for (at, count) in [(Vector::new(500.0, 400.0), 6), (Vector::new(2.0, 2.0), 2)] {
            for _ in 0..count {
                let here = placed(&drawn, at, None).window;
                assert!(VIEW.contains(here.low) && VIEW.contains(here.high));
                assert!(drawn.boxes.iter().all(|other| !other.meets(&here)));
                drawn.boxes.push(here);
            }
        }
    }

    #[test]
    fn a_label_keeps_off_a_filled_set() {
        let set = ConvexPolygon::rectangle(Vector::new(475.0, 375.0), 37.5, 37.5);
        let mut drawn = Drawn::default();
        drawn.fill(set.clone());
        let at = Vector::new(470.0, 380.0);
        let place = placed(&drawn, at, None);
        assert!(place.window.part_of(&set).is_empty());
        let [from, to] = place.leader.expect("it is far");
        assert!(from == at && place.window.grown(1e-9).contains(to));
        // there is no such place close by
        let close = drawn.place((VIEW, 1.0), &[label(at)], Needed::OffFirst(3), None);
        assert!(close.is_none());
    }

    #[test]
    fn a_label_stands_beside_the_line_through_its_place() {
        let ends = [Vector::new(0.0, 400.0), Vector::new(800.0, 420.0)];
        for line in [ends, ends.map(|p| Vector::new(p.y, p.x))] {
            let mut drawn = Drawn::default();
            drawn.line(line.to_vec());
            let place = placed(&drawn, 0.5 * (line[0] + line[1]), None);
            assert!(!crosses(&line, &place.window));
            assert!(crosses(&line, &Window::at(line[1]).grown(1.0)));
        }
    }

    #[test]
    fn a_label_stays_where_it_was_unless_something_is_there() {
        let mut drawn = Drawn::default();
        let at = Vector::new(500.0, 400.0);
        let first = placed(&drawn, at, None);
        let other = 1 + first.number;
        assert_eq!(placed(&drawn, at, Some(other)).number, other);
        let there = placed(&drawn, at, Some(other)).window;
        drawn.boxes.push(there);
        assert_eq!(placed(&drawn, at, Some(other)).number, first.number);
    }
}
