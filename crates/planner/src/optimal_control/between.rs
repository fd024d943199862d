//! Points between the constrained instants at which a motion is deepest in a set.

use super::keep_out::KeepOut;
use searoom_geometry::numerics::GoldenSection;
use searoom_model::trajectory::Cubic;

/// Least and greatest number of parts in which a piece is sampled.
const PARTS: f64 = 8.0;
const MOST_PARTS: f64 = 256.0;

/// Largest ratio of a cubic's length to its duration times the greater of its end speeds, unless it
/// is a loop.
const BULGE: f64 = 1.5;

/// Golden-section steps: they reduce a bracket to 2e-6, where the level is flat to rounding.
const GOLDEN_STEPS: usize = 27;

/// Local minimum of the level on a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LowPoint {
    /// Fraction of the duration.
    pub part: f64,
    /// Level `(x - p_t)' Q_t^-1 (x - p_t)`, below 1 inside.
    pub level: f64,
}

/// Local minima of the level along a piece that lie below `below`. The parts are short relative to
/// the time in which the set's narrowest half width is passed, so that none should be missed. The
/// final check of the plan finds any that is.
pub fn low_points(piece: &Cubic, keep: &KeepOut, below: f64) -> Vec<LowPoint> {
    let level = |part: f64| {
        let time = piece.start_time + part * piece.duration;
        keep.at(time).level(piece.position(part))
    };
    let drift = keep.set().velocity().center();
    let fastest = piece.velocities.map(|v| (v - drift).norm());
    let way = fastest[0].max(fastest[1]) * piece.duration;
    // sections only grow: in the norm of the last one, the piece is no nearer than its ends minus
    // its length
    let last = keep.at(piece.end_time());
    let start = piece.positions[0] + drift * piece.duration;
    let nearest = last.level(start).min(last.level(piece.positions[1])).sqrt();
    if nearest - BULGE * way / keep.narrowest() > below.sqrt() {
        return Vec::new();
    }
    let parts = (4.0 * way / keep.narrowest())
        .clamp(PARTS, MOST_PARTS)
        .ceil();
    let count = parts as usize;
    let mut found = Vec::new();
    // the two samples before, and this one
    let mut levels = [f64::INFINITY, f64::INFINITY, level(0.0)];
    for k in 1..=count + 1 {
        let next = if k <= count {
            level(k as f64 / parts)
        } else {
            f64::INFINITY
        };
        levels = [levels[1], levels[2], next];
        let [before, here, after] = levels;
        // the minimum of a parabola through the three may be far below them
        let rise = (before.min(1e3) - here).max(after.min(1e3) - here).max(0.0);
        if here <= before && here <= after && here - rise < below {
            let low = (k as f64 - 2.0).max(0.0) / parts;
            let high = (k as f64).min(parts) / parts;
            let point = least(low, high, &level);
            if point.level < below {
                found.push(point);
            }
        }
    }
    found
}

fn least(low: f64, high: f64, level: &impl Fn(f64) -> f64) -> LowPoint {
    let ends = [(low, level(low)), (high, level(high))];
    let mut search = GoldenSection::new(low, high, level);
    for _ in 0..GOLDEN_STEPS {
        search.shorten(level);
    }
    let (part, level) = [search.left, search.right]
        .into_iter()
        .chain(ends)
        .fold((0.0, f64::INFINITY), |a, b| if b.1 < a.1 { b } else { a });
    LowPoint { part, level }
}

#[cfg(test)]
mod tests {
    use super::super::keep_out::ellipsoid;
    use super::*;
    use searoom_geometry::frame::Vector;

    #[test]
    fn the_deepest_point_of_a_pass_is_found_and_a_clear_one_has_none() {
        // past a fixed disc of 1 m, 0.8 m off its centre, closest at 3/4 of the piece
        let keep = ellipsoid([3.0, 0.8], [0.0, 0.0], [1.0, 1.0], [0.0, 0.0]);
        for speed in [0.2, 2.0, 40.0] {
            let duration = 4.0 / speed;
            let piece = Cubic {
                start_time: 5.0,
                duration,
                positions: [Vector::zeros(), Vector::new(4.0, 0.0)],
                velocities: [Vector::new(speed, 0.0); 2],
                headings: [0.0; 2],
                yaw_rates: [0.0; 2],
            };
            let found = low_points(&piece, &keep, 1.0);
            assert_eq!(found.len(), 1);
            assert!((found[0].part - 0.75).abs() < 1e-5 && (found[0].level - 0.64).abs() < 1e-9);
            assert!(low_points(&piece, &keep, 0.6).is_empty());
        }
    }
}
