//! Closest approaches of own ship and its targets on the chart.

use rerun::{AsComponents, Color};

use super::ships::{Ships, Sighted};
use crate::frame::Vector;
use crate::geometry::ConvexPolygon;
use crate::recording::canvas::{Canvas, Labels, Lines, Strip, flat, points, style};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, MAP, path};
use crate::text::{clock, tenths};
use crate::tolerance;

/// Strength of the colours of ships at their closest approach, of 1, and of the lines to targets
/// that are not the nearest.
const STRENGTH: f32 = 0.6;

/// Part of the whole time before and after a closest approach for which labels that stay keep off
/// the ships.
pub const ENCOUNTER: f64 = 1.0 / 15.0;

/// The name of a target, when it is closest in seconds, and how far apart the hulls are in metres.
pub type Passage<'a> = (&'a str, f64, f64);

/// A closest approach of the hulls.
struct Approach {
    target: String,
    /// Seconds.
    time: f64,
    /// Metres, negative in overlap.
    apart: f64,
    is_set: bool,
    /// The nearest points of the hulls.
    ends: [Vector; 2],
    /// The two ships as they are drawn there.
    ships: [(Vec<Strip>, Color); 2],
}

impl Approach {
    /// Own ship and a target at a time.
    ///
    /// Own ship is a point to an explicit set.
    fn new((target, time, apart): Passage, [own, other]: [&Sighted; 2], color: Color) -> Self {
        let hull = if other.is_set {
            &ConvexPolygon::point(own.place)
        } else {
            &own.outline
        };
        let drawn = |ship: &Sighted, color| {
            let color = style::toward_background(color, STRENGTH);
            (ship.strips().collect(), color)
        };
        Self {
            target: target.to_owned(),
            time,
            // a distance that is no number is a contact
            apart: if apart.is_nan() {
                f64::NEG_INFINITY
            } else {
                apart
            },
            is_set: other.is_set,
            ends: nearest_points(hull, &other.outline),
            ships: [drawn(own, style::OWN_SHIP), drawn(other, color)],
        }
    }

    fn is_contact(&self) -> bool {
        // a plan may touch an explicit set
        match self.is_set {
            true => self.apart < -tolerance::DEPTH_M,
            false => self.apart <= 0.0,
        }
    }

    fn text(&self) -> String {
        let (target, time) = (&self.target, clock(self.time));
        let apart = tenths(self.apart);
        match (self.is_contact(), self.is_set) {
            (true, false) => format!("in contact with {target} at {time}"),
            (true, true) => format!("in the set of {target} at {time}"),
            (false, false) => format!("CPA {apart} m at {time} to {target}"),
            (false, true) => format!("CPA {apart} m at {time} to the set of {target}"),
        }
    }
}

/// Logs a line between the hulls at every closest approach; thick and named is the least, with both
/// ships around it. The others are named where they are pointed at.
pub fn log_closest(
    rec: &mut Recorder,
    canvas: &Canvas,
    labels: &mut Labels,
    ships: &Ships,
    passages: &[Passage],
) -> Logged {
    let passages = passages.iter().enumerate();
    let approaches = passages.filter_map(|(index, passage)| {
        let ships = (ships.at)(passage.1)?;
        let pair = [&ships[0], &ships[index + 1]];
        Some(Approach::new(*passage, pair, canvas.target_color(index)))
    });
    let approaches: Vec<Approach> = approaches.collect();
    let is_near = |time: f64| {
        let mut nearest = approaches.iter().map(|approach| approach.time);
        nearest.any(|nearest| (time - nearest).abs() <= ENCOUNTER * canvas.end)
    };
    let rows = canvas.cursor_times.iter().zip(&ships.rows);
    for (_, row) in rows.filter(|(time, _)| is_near(**time)) {
        row.iter().for_each(|ship| labels.keep_off(ship.covers()));
    }
    let least = approaches.iter().min_by(|a, b| a.apart.total_cmp(&b.apart));
    let Some(least) = least else {
        return Ok(());
    };
    let mut lines = Lines::default();
    let mut texts = Vec::new();
    for approach in &approaches {
        let is_least = std::ptr::eq(approach, least);
        let (color, radius) = match (approach.is_contact(), is_least) {
            (true, _) => (style::ALARM, 2.5),
            (false, true) => (style::CLOSEST, 2.5),
            (false, false) => (style::toward_background(style::CLOSEST, STRENGTH), 0.8),
        };
        lines.add(approach.ends.map(flat), color, radius);
        texts.push(approach.text());
        if approach.is_contact() || is_least {
            let [a, b] = approach.ends;
            labels.keep_off_mark(approach.ends);
            labels.add(&approach.text(), 0.5 * (a + b), color);
        }
    }
    let color = if least.is_contact() {
        style::ALARM
    } else {
        style::CLOSEST
    };
    let ends = points(color, 4.0).with_positions(least.ends.map(flat));
    let lines = lines.archetype().with_labels(texts).with_show_labels(false);
    let parts: [&dyn AsComponents; 2] = [&lines, &ends];
    rec.log_static(path(&[MAP, "closest_points"]), &parts)?;
    let mut outlines = Lines::default();
    for (strips, color) in &least.ships {
        for strip in strips {
            outlines.add(strip.clone(), *color, 0.8);
        }
    }
    rec.log_static(
        path(&[MAP, "closest_points", "ships"]),
        &outlines.archetype(),
    )
}

/// A point of each of two convex sets; where these are apart, the nearest. O(product of vertices).
fn nearest_points(one: &ConvexPolygon, other: &ConvexPolygon) -> [Vector; 2] {
    let pairs = |from: &ConvexPolygon, to: &ConvexPolygon| {
        let mut pairs = Vec::new();
        for &p in from.vertices() {
            pairs.extend(to.vertices().iter().map(|q| [p, *q]));
            pairs.extend(to.edges().map(|(a, b)| {
                let edge = b - a;
                let part = (p - a).dot(&edge) / edge.norm_squared();
                [p, a + edge * part.clamp(0.0, 1.0)]
            }));
        }
        pairs
    };
    let mut all = pairs(one, other);
    all.extend(pairs(other, one).into_iter().map(|[p, q]| [q, p]));
    let length = |[p, q]: &[Vector; 2]| (p - q).norm();
    let least = all
        .into_iter()
        .min_by(|a, b| length(a).total_cmp(&length(b)));
    least.unwrap_or([one.centroid(), other.centroid()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_is_as_long_as_the_distance_of_the_hulls() {
        let square = ConvexPolygon::rectangle(Vector::zeros(), 5.0, 5.0);
        for (angle, shift) in [
            (0.0, [30.0, 0.0]),
            (0.7, [-18.0, 25.0]),
            (2.0, [3.0, -40.0]),
        ] {
            let other = square.rotated(angle).translated(Vector::from(shift));
            let [a, b] = nearest_points(&square, &other);
            assert!(((a - b).norm() - square.separation(&other)).abs() < 1e-9);
            let off = [square.signed_distance(a), other.signed_distance(b)];
            assert!(off.iter().all(|off| off.abs() < 1e-9), "{off:?}");
        }
        let point = ConvexPolygon::point(Vector::new(9.0, 0.0));
        let [a, b] = nearest_points(&point, &square);
        assert_eq!([a, b], [Vector::new(9.0, 0.0), Vector::new(5.0, 0.0)]);
    }
}
