//! Shortest paths of bounded curvature between two poses (Dubins 1957, doi:10.2307/2372560), in the
//! closed forms of Shkel & Lumelsky (doi:10.1016/S0921-8890(00)00127-5); docs/reference/theory.md
//! section 8.

use std::f64::consts::TAU;

use searoom_geometry::frame::{Pose, Side, heading_of, wrap, wrap_positive};

/// Radians. An arc this close to a full circle has no length: otherwise rounding adds a circle to a
/// straight line.
const FULL_CIRCLE_SLACK: f64 = 1e-10;

/// Metres. If the goal moves by at most this, the line between two circles of one side may start or
/// end at once. Where the circles coincide its direction is rounding, which must not add a circle
/// to an arc.
const SAME_CIRCLE_M: f64 = 1e-7;

/// Allowed rounding below zero of a squared length, relative to the radius.
const ROUNDING: f64 = 1e-12;

/// A piece of a path: an arc to one side, or a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Side of the turn, `None` on a line.
    pub turn: Option<Side>,
    /// Metres along the piece.
    pub length: f64,
}

/// A path of three pieces, some possibly without length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DubinsPath {
    /// In order.
    pub pieces: [Piece; 3],
}

impl DubinsPath {
    /// Metres.
    pub fn length(&self) -> f64 {
        self.pieces.iter().map(|p| p.length).sum()
    }
}

/// The six words of Dubins: the turn of each piece.
const WORDS: [[Option<Side>; 3]; 6] = [
    [Some(Side::Port), None, Some(Side::Port)],
    [Some(Side::Starboard), None, Some(Side::Starboard)],
    [Some(Side::Port), None, Some(Side::Starboard)],
    [Some(Side::Starboard), None, Some(Side::Port)],
    [
        Some(Side::Starboard),
        Some(Side::Port),
        Some(Side::Starboard),
    ],
    [Some(Side::Port), Some(Side::Starboard), Some(Side::Port)],
];

/// Every word that joins the two poses, in the order LSL, RSR, LSR, RSL, RLR, LRL, to
/// `SAME_CIRCLE_M`.
///
/// `radius` in metres, positive. Empty only when an input is not finite.
pub fn paths(from: &Pose, to: &Pose, radius: f64) -> Vec<DubinsPath> {
    let step = to.position - from.position;
    let d = step.norm() / radius;
    let theta = heading_of(step);
    let (a, b) = (from.heading - theta, to.heading - theta);
    let (sin_a, cos_a) = a.sin_cos();
    let (sin_b, cos_b) = b.sin_cos();
    let c = (a - b).cos();
    let csc = |square: f64| (square >= -ROUNDING).then(|| square.max(0.0).sqrt());
    // from centre to centre of the two circles: accurate also where the path is short relative to
    // them
    let same = |x: f64, y: f64| {
        let (line, k) = (x.hypot(y), y.atan2(x));
        let alike = |heading: f64| line * radius * wrap(k - heading).abs() <= SAME_CIRCLE_M;
        let k = [a, b].into_iter().find(|h| alike(*h)).unwrap_or(k);
        line.is_finite().then_some((line, k))
    };
    // likewise between the outer circles: the cosine loses eight digits where they nearly coincide
    let ccc = |x: f64, y: f64| {
        let sine = x.hypot(y) / 4.0;
        (sine <= 1.0 + ROUNDING).then(|| TAU - 2.0 * sine.min(1.0).asin())
    };
    let lsl = same(d + (sin_a - sin_b), cos_b - cos_a).map(|(p, k)| [k - a, p, b - k]);
    let rsr = same(d - (sin_a - sin_b), cos_a - cos_b).map(|(p, k)| [a - k, p, k - b]);
    let lsr = csc(-2.0 + d * d + 2.0 * c + 2.0 * d * (sin_a + sin_b)).map(|p| {
        let k = (-cos_a - cos_b).atan2(d + sin_a + sin_b) - (-2.0_f64).atan2(p);
        [k - a, p, k - b]
    });
    let rsl = csc(-2.0 + d * d + 2.0 * c - 2.0 * d * (sin_a + sin_b)).map(|p| {
        let k = (cos_a + cos_b).atan2(d - sin_a - sin_b) - 2.0_f64.atan2(p);
        [a - k, p, b - k]
    });
    let rlr = ccc(d - (sin_a - sin_b), cos_a - cos_b).map(|p| {
        let t = wrap_positive(a - (cos_a - cos_b).atan2(d - sin_a + sin_b) + p / 2.0);
        [t, p, a - b - t + p]
    });
    let lrl = ccc(d + (sin_a - sin_b), cos_b - cos_a).map(|p| {
        let k = (cos_b - cos_a).atan2(d + sin_a - sin_b);
        let t = wrap_positive(k - a + p / 2.0);
        [t, p, b - a - t + p]
    });
    [lsl, rsr, lsr, rsl, rlr, lrl]
        .into_iter()
        .zip(WORDS)
        .filter_map(|(lengths, turns)| {
            let lengths = lengths?;
            let piece = |i: usize| Piece {
                turn: turns[i],
                length: radius
                    * if turns[i].is_some() {
                        arc_angle(lengths[i])
                    } else {
                        lengths[i]
                    },
            };
            let path = DubinsPath {
                pieces: [piece(0), piece(1), piece(2)],
            };
            path.length().is_finite().then_some(path)
        })
        .collect()
}

/// The shortest path, by the first of equal words. `None` only when an input is not finite.
pub fn shortest(from: &Pose, to: &Pose, radius: f64) -> Option<DubinsPath> {
    paths(from, to, radius)
        .into_iter()
        .min_by(|a, b| a.length().total_cmp(&b.length()))
}

fn arc_angle(angle: f64) -> f64 {
    let wrapped = wrap_positive(angle);
    if TAU - wrapped < FULL_CIRCLE_SLACK {
        0.0
    } else {
        wrapped
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry_fixtures::random_vector;
    use crate::trajectory::Segment;
    use rand::{Rng, SeedableRng};
    use searoom_geometry::frame::Vector;

    fn end(from: Pose, path: &DubinsPath, radius: f64) -> Pose {
        path.pieces.iter().fold(from, |pose, piece| {
            Segment::new(
                pose,
                0.0,
                piece.length,
                1.0,
                piece.turn.map_or(0.0, |s| s.turn_sign() / radius),
            )
            .end()
        })
    }

    #[test]
    fn every_word_ends_at_its_goal_and_none_is_shorter_than_the_chord() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(11);
        for _ in 0..5000 {
            let mut pose =
                || Pose::new(random_vector(&mut rng, 500.0), rng.random_range(-4.0..4.0));
            let (from, to) = (pose(), pose());
            let radius = rng.random_range(10.0..300.0);
            let all = paths(&from, &to, radius);
            assert!(!all.is_empty());
            for path in &all {
                let reached = end(from, path, radius);
                assert!((reached.position - to.position).norm() < 1e-6);
                assert!(wrap(reached.heading - to.heading).abs() < 1e-8);
            }
            let best = shortest(&from, &to, radius).expect("finite").length();
            assert!(best >= (to.position - from.position).norm() - 1e-9);
            let back = |p: &Pose| Pose::new(p.position, p.heading + std::f64::consts::PI);
            let reversed = shortest(&back(&to), &back(&from), radius)
                .expect("finite")
                .length();
            assert!((best - reversed).abs() < 1e-6, "{best} {reversed}");
        }
    }

    /// A path that is short relative to the turning circle loses no digits.
    #[test]
    fn short_ways_of_wide_turns_reach_their_goal() {
        let at = |x: f64, y: f64, h: f64| Pose::new(Vector::new(x, y), h);
        for (length, radius) in [(1.0, 1e6), (1e-3, 1e6), (50.0, 1e6), (0.01, 100.0)] {
            let (from, to) = (at(0.0, 0.0, 0.0), at(length, 0.0, 0.0));
            let path = shortest(&from, &to, radius).expect("finite");
            let missed = (end(from, &path, radius).position - to.position).norm();
            assert!(missed < 1e-9, "{length} {radius}: {missed}");
        }
    }

    /// Anywhere in the plane: the two circles coincide, and the direction between them is rounding.
    #[test]
    fn an_arc_is_that_arc_and_no_circle_more() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(12);
        for far in [0.0, 1e3, 7e6] {
            for _ in 0..2000 {
                let place = Vector::new(far * rng.random_range(-1.0..1.0), far);
                let from = Pose::new(place, rng.random_range(-3.0..3.0));
                let radius = rng.random_range(20.0..400.0);
                let turn: f64 = rng.random_range(-3.0..3.0);
                let piece = Piece {
                    turn: Side::of_turn(turn),
                    length: radius * turn.abs(),
                };
                let none = Piece {
                    turn: None,
                    length: 0.0,
                };
                let arc = DubinsPath {
                    pieces: [piece, none, none],
                };
                let to = end(from, &arc, radius);
                let found = shortest(&from, &to, radius).expect("finite");
                assert!((found.length() - piece.length).abs() < 1e-6, "{found:?}");
            }
        }
    }

    /// For nearly equal poses no word omits a circle that it needs, nor ends beside its goal.
    #[test]
    fn every_word_between_poses_a_hair_apart_reaches_its_goal() {
        let from = Pose::new(Vector::zeros(), 0.0);
        for hair in (3..=12).map(|k| 10.0_f64.powi(-k)) {
            for (along, across, turned) in [(0, 0, 1), (1, 0, 0), (0, 1, 0), (1, 1, 1), (0, 1, -1)]
            {
                let [x, y, heading] = [along, across, turned].map(|n| hair * f64::from(n));
                let to = Pose::new(Vector::new(x, y), heading);
                for path in paths(&from, &to, 300.0) {
                    let missed = (end(from, &path, 300.0).position - to.position).norm();
                    assert!(
                        missed <= 2.0 * SAME_CIRCLE_M,
                        "{hair:e}: {missed:e} {path:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn known_lengths() {
        let at = |x: f64, y: f64, h: f64| Pose::new(Vector::new(x, y), h);
        let length = |a: Pose, b: Pose| shortest(&a, &b, 100.0).expect("finite").length();
        assert!(length(at(0.0, 0.0, 0.0), at(0.0, 0.0, 0.0)) < 1e-6);
        assert!((length(at(0.0, 0.0, 0.0), at(1500.0, 0.0, 0.0)) - 1500.0).abs() < 1e-9);
        let reversal = length(at(0.0, 0.0, 0.0), at(0.0, 0.0, std::f64::consts::PI));
        assert!((reversal - 700.0 * std::f64::consts::PI / 3.0).abs() < 1e-6);
    }
}
