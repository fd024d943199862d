//! Where the names of sets stand: beside them, clear of one another.

use super::Window;
use super::panel::{AREA, NOTE_SIZE};
use crate::frame::Vector;

/// Pixels between a set and its name.
const GAP: f64 = 7.0;

/// Of the size of the letters: how wide one is, and how far they reach above their line and below it, about.
const WIDTH: f64 = 0.6;
const ASCENT: f64 = 0.8;
const DESCENT: f64 = 0.25;

/// Lines that a name moves away from its set, at most.
const LINES: usize = 12;

/// Square pixels that a line between a set and its name counts for: it is rather near than clear of every set.
const FARTHER: f64 = 60.0;

/// Of a pixel that a name shares with another, or that is outside the picture; with a set it is one.
const HIDDEN: f64 = 1e3;

/// A set that is to be named: its extent, metres.
#[derive(Debug, Clone)]
pub(super) struct Named<'a> {
    pub name: &'a str,
    pub extent: Window,
    /// Whether the name stands rather below than above: on the side that the set leaves.
    pub below: bool,
}

/// Middle and base line of every name, metres. `track` is what names keep clear of too. The order decides between places that are as good.
/// O(n² + n · track).
pub(super) fn places(shown: Window, sets: &[Named], track: &[Vector]) -> Vec<Vector> {
    let view = View { shown };
    let extents: Vec<Window> = sets.iter().map(|set| view.pixels(set.extent)).collect();
    let dots = track.iter().map(|p| Window {
        low: view.pixel(*p) - Vector::repeat(1.0),
        high: view.pixel(*p) + Vector::repeat(1.0),
    });
    let seen: Vec<Window> = extents.iter().copied().chain(dots).collect();
    let picture = Window {
        low: Vector::zeros(),
        high: Vector::new(AREA[0], AREA[1]),
    };
    let mut taken: Vec<Window> = Vec::new();
    let mut places = Vec::new();
    for (set, extent) in sets.iter().zip(&extents) {
        let letters = set.name.chars().count() as f64;
        let half = 0.5 * WIDTH * f64::from(NOTE_SIZE) * letters;
        let cost = |(lines, at): &(usize, Vector)| {
            let place = written(*at, half);
            let outside = area(place) - shared(place, picture);
            let others: f64 = taken.iter().map(|t| shared(place, *t)).sum();
            let covered: f64 = seen.iter().map(|s| shared(place, *s)).sum();
            HIDDEN * (outside + others) + covered + FARTHER * *lines as f64
        };
        let all = candidates(*extent, half, set.below);
        // the first of the best
        let best = (all.iter()).min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let at = best.map_or(extent.low, |(_, at)| *at);
        taken.push(written(at, half));
        places.push(view.metres(at));
    }
    places
}

/// Middles of base lines around a set, pixels, with how many lines they are away: above and below it, and on both sides.
fn candidates(extent: Window, half: f64, below: bool) -> Vec<(usize, Vector)> {
    let size = f64::from(NOTE_SIZE);
    let line = size * (ASCENT + DESCENT);
    let middle = 0.5 * (extent.low + extent.high);
    let beside = middle.y - 0.5 * size * (ASCENT - DESCENT);
    let away = |lines: usize| {
        let far = line * lines as f64;
        let top = Vector::new(middle.x, extent.high.y + GAP + DESCENT * size + far);
        let bottom = Vector::new(middle.x, extent.low.y - GAP - ASCENT * size - far);
        let ends = if below { [bottom, top] } else { [top, bottom] };
        let columns = [extent.high.x + GAP + half, extent.low.x - GAP - half];
        let rows = if below { [-far, far] } else { [far, -far] };
        let sides = columns.map(|x| rows.map(|far| Vector::new(x, beside + far)));
        let places = ends.into_iter().chain(sides.into_iter().flatten());
        places.map(move |at| (lines, at))
    };
    (0..=LINES).flat_map(away).collect()
}

/// What a name covers whose base line has its middle at a place.
fn written(at: Vector, half: f64) -> Window {
    let size = f64::from(NOTE_SIZE);
    Window {
        low: at - Vector::new(half, DESCENT * size),
        high: at + Vector::new(half, ASCENT * size),
    }
}

fn area(window: Window) -> f64 {
    let size = window.high - window.low;
    size.x.max(0.0) * size.y.max(0.0)
}

fn shared(a: Window, b: Window) -> f64 {
    area(Window {
        low: a.low.sup(&b.low),
        high: a.high.inf(&b.high),
    })
}

/// Metres to pixels, north upward.
#[derive(Debug, Clone, Copy)]
struct View {
    shown: Window,
}

impl View {
    fn scale(&self) -> Vector {
        Vector::new(AREA[0], AREA[1]).component_div(&self.shown.size())
    }

    fn pixel(&self, p: Vector) -> Vector {
        (p - self.shown.low).component_mul(&self.scale())
    }

    fn metres(&self, p: Vector) -> Vector {
        self.shown.low + p.component_div(&self.scale())
    }

    fn pixels(&self, window: Window) -> Window {
        Window {
            low: self.pixel(window.low),
            high: self.pixel(window.high),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(low: [f64; 2], high: [f64; 2]) -> Window {
        Window {
            low: low.into(),
            high: high.into(),
        }
    }

    /// Two metres for a pixel.
    fn shown() -> Window {
        window([-400.0, -330.0], [400.0, 330.0])
    }

    fn covered(sets: &[Named], places: &[Vector]) -> Vec<Window> {
        let view = View { shown: shown() };
        let both = sets.iter().zip(places);
        both.map(|(set, at)| {
            let half = 0.5 * WIDTH * f64::from(NOTE_SIZE) * set.name.len() as f64;
            written(view.pixel(*at), half)
        })
        .collect()
    }

    #[test]
    fn names_are_clear_of_one_another_and_within_the_picture() {
        // all in one place, in a corner, and along a line closer than their names are wide
        let crowd = |at: fn(usize) -> Vector| -> Vec<Window> {
            let around = |p| Window {
                low: p - Vector::repeat(8.0),
                high: p + Vector::repeat(8.0),
            };
            (0..9).map(|i| around(at(i))).collect()
        };
        for extents in [
            crowd(|_| Vector::zeros()),
            crowd(|_| Vector::new(390.0, -320.0)),
            crowd(|i| Vector::new(25.0 * i as f64 - 380.0, 325.0)),
        ] {
            for below in [false, true] {
                let named = |extent: &Window| Named {
                    name: "a target",
                    extent: *extent,
                    below,
                };
                let sets: Vec<Named> = extents.iter().map(named).collect();
                let track = [Vector::zeros(), Vector::new(0.0, 100.0)];
                let places = places(shown(), &sets, &track);
                let covered = covered(&sets, &places);
                let picture = window([0.0, 0.0], AREA);
                for (i, a) in covered.iter().enumerate() {
                    assert!(area(*a) - shared(*a, picture) < 1e-6, "{i} of {extents:?}");
                    for b in &covered[..i] {
                        assert!(shared(*a, *b) < 1e-6, "{i} of {extents:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_name_alone_stands_on_its_side() {
        let extent = window([-10.0, -10.0], [10.0, 10.0]);
        for below in [false, true] {
            let name = "alone";
            let set = Named {
                name,
                extent,
                below,
            };
            let at = places(shown(), &[set], &[])[0];
            let near = 10.0 + 2.0 * (GAP + f64::from(NOTE_SIZE));
            assert!(at.x.abs() < 1e-9 && (at.y < -10.0) == below && at.y.abs() < near);
        }
    }
}
