//! Interval over which the space-time error is counted. It makes any two motions comparable: one
//! that ends at the last waypoint, one that stays there, one that is early, and one that passes by.

use crate::piece::Piece;
use crate::{cost, steered};
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance;
use searoom_model::trajectory::{Cubic, DesiredTrajectory, Segment, Trajectory};

/// Longest time step near the edge of the arrival disc, as a fraction of the duration. A shorter
/// stay in the disc may be missed.
const FINEST_LOOK: f64 = 1e-6;

/// Bisection steps between two samples.
const HALVINGS: usize = 60;

/// End of the interval over which the space-time error of a motion is counted.
///
/// A motion arrives when it enters the disc of radius `within` around the last waypoint for the
/// last time. The interval ends then, but not before the desired trajectory does: own ship lies
/// where its motion ends. If the motion never enters the disc, or starts in it and stays, the
/// interval ends with the desired trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Counted {
    /// Radius of the disc around the last waypoint, metres.
    pub within: f64,
    /// End of the counted interval, seconds.
    pub until: f64,
    /// True where the motion enters the disc.
    pub arrived: bool,
}

/// Space-time error of a motion in m², and the interval over which it is counted.
///
/// The result does not depend on the representation of the motion. `q` in m²/s², `within` in
/// metres.
pub fn counted_error(
    trajectory: &Trajectory,
    desired: &DesiredTrajectory,
    q: f64,
    within: f64,
) -> (f64, Counted) {
    match trajectory.steered() {
        Some(motion) => {
            let pieces: Vec<Cubic> = motion.pieces().collect();
            counted_error_of_cubics(&pieces, desired, q, within)
        }
        None => counted_error_of_segments(trajectory.segments(), desired, q, within),
    }
}

/// [`counted_error`] of segments.
pub fn counted_error_of_segments(
    segments: &[Segment],
    desired: &DesiredTrajectory,
    q: f64,
    within: f64,
) -> (f64, Counted) {
    let counted = counted(segments, desired, within);
    let mut kept = until(segments, counted.until);
    kept.extend(wait_until(counted.until, &kept));
    (cost::space_time_error(&kept, desired, q), counted)
}

/// Space-time error of segments that arrive at the last waypoint itself, to their end; to the end
/// of the desired trajectory where they do not arrive.
pub(crate) fn error_to_end(
    segments: &[Segment],
    desired: &DesiredTrajectory,
    q: f64,
) -> (f64, Counted) {
    let off = |s: &Segment| (s.end().position - desired.end()).norm();
    let arrived = (segments.last()).is_some_and(|s| off(s) <= tolerance::ARRIVAL_M);
    let mut all = match arrived {
        true => segments.to_vec(),
        false => until(segments, desired.duration()),
    };
    all.extend(wait_until(desired.duration(), &all));
    let counted = Counted {
        within: tolerance::ARRIVAL_M,
        until: all.last().map_or(f64::NAN, Segment::end_time),
        arrived,
    };
    (cost::space_time_error(&all, desired, q), counted)
}

/// Wait of own ship where its motion ends, until `time`. `None` where it ends on time or later.
fn wait_until(time: f64, segments: &[Segment]) -> Option<Segment> {
    let last = segments.last()?;
    let left = time - last.end_time();
    (left > tolerance::TIME_S).then(|| Segment::straight(last.end(), last.end_time(), left, 0.0))
}

/// [`counted_error`] of a motion under forces.
pub(crate) fn counted_error_of_cubics(
    pieces: &[Cubic],
    desired: &DesiredTrajectory,
    q: f64,
    within: f64,
) -> (f64, Counted) {
    let counted = counted(pieces, desired, within);
    let kept = until(pieces, counted.until);
    let error = steered::space_time_error(&kept, desired, q);
    let lies = pieces.last().map(|piece| {
        let pose = piece.pose_at(piece.end_time());
        Segment::straight(pose, piece.end_time(), 0.0, 0.0)
    });
    let wait = lies.and_then(|lies| wait_until(counted.until, &[lies]));
    let after = wait.map_or(0.0, |wait| cost::space_time_error(&[wait], desired, q));
    (error + after, counted)
}

/// Returns the pieces up to a time.
fn until<P: Piece>(pieces: &[P], time: f64) -> Vec<P> {
    pieces
        .iter()
        .filter(|piece| piece.start_time() < time)
        .map(|piece| piece.part(piece.start_time(), time, 0.0))
        .collect()
}

fn counted<P: Piece>(pieces: &[P], desired: &DesiredTrajectory, within: f64) -> Counted {
    let entrance = last_entrance(pieces, desired.end(), within);
    let duration = desired.duration();
    Counted {
        within,
        until: entrance.map_or(duration, |entrance| entrance.max(duration)),
        arrived: entrance.is_some(),
    }
}

/// Last time at which a motion enters the disc of radius `within` around `place`, seconds. Searches
/// backwards in time with steps in which the motion cannot reach the edge.
fn last_entrance<P: Piece>(pieces: &[P], place: Vector, within: f64) -> Option<f64> {
    let beyond = |piece: &P, time: f64| (piece.pose_at(time).position - place).norm() - within;
    let (first, last) = (pieces.first()?, pieces.last()?);
    let least = FINEST_LOOK * (last.end_time() - first.start_time());
    // Last sampled time inside the disc.
    let mut inside = None;
    for piece in pieces.iter().rev() {
        let fastest = piece.bounds().speed;
        let mut time = piece.end_time();
        loop {
            let off = beyond(piece, time);
            if off <= 0.0 {
                inside = Some(time);
            } else if let Some(later) = inside {
                return Some(entrance(piece, time, later, &beyond));
            }
            // Negated on purpose: a NaN ends the search.
            if !(time > piece.start_time()) {
                break;
            }
            // The edge is not reached within this time.
            let step = (off.abs() / fastest).max(least);
            time = (time - step).max(piece.start_time());
        }
    }
    None
}

/// Bisects for the time of entry between a time outside and a later one inside.
fn entrance<P: Piece>(
    piece: &P,
    mut outside: f64,
    mut inside: f64,
    beyond: &impl Fn(&P, f64) -> f64,
) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (outside + inside);
        if beyond(piece, middle) <= 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship_fixtures::{chain, desired};
    use searoom_geometry::frame::Pose;
    use searoom_model::trajectory::{ForceNode, Steered};

    /// Legs of `(duration, speed, turn rate)`, as segments and as nodes every second.
    fn both(start: Pose, legs: &[(f64, f64, f64)]) -> [Trajectory; 2] {
        let segments = chain(start, legs);
        let mut nodes = Vec::new();
        for s in &segments {
            let many = s.duration.ceil() as usize;
            // The velocity changes instantly: two nodes, one nanosecond apart.
            nodes.extend((0..=many).map(|k| {
                let joint = k == 0 && s.start_time > 0.0;
                let first = if joint { 1e-9 } else { 0.0 };
                let time = s.start_time + first + (s.duration - first) * k as f64 / many as f64;
                ForceNode {
                    time,
                    pose: s.pose_at(time),
                    velocity: Vector::new(s.speed, 0.0),
                    yaw_rate: s.turn_rate,
                    force: Vector::zeros(),
                    moment: 0.0,
                }
            }));
        }
        [
            Trajectory::new(segments).expect("a chain"),
            Trajectory::from(Steered::new(nodes).expect("in order")),
        ]
    }

    /// Segments and nodes of one motion have equal errors.
    #[test]
    fn the_same_motion_has_the_same_error_however_it_is_given() {
        let east = Pose::new(Vector::zeros(), 0.0);
        let wish = desired(&[(0.0, 0.0), (1000.0, 0.0)], &[5.0]);
        let wide = Pose::new(Vector::new(0.0, 200.0), 0.0);
        let lies = [(250.0, 4.0, 0.0), (150.0, 0.0, 0.0)];
        let turns = [(100.0, 5.0, 0.002), (120.0, 5.0, -0.004)];
        for (name, start, legs, arrived) in [
            ("ends there", east, &[(250.0, 4.0, 0.0)][..], true),
            ("goes on", east, &[(400.0, 4.0, 0.0)], true),
            ("lies there", east, &lies, true),
            ("passes by", wide, &[(400.0, 4.0, 0.0)], false),
            ("turns", east, &turns, false),
        ] {
            let [segments, nodes] =
                both(start, legs).map(|trajectory| counted_error(&trajectory, &wish, 25.0, 30.0));
            let both = [segments, nodes].map(|found| found.1.arrived);
            assert_eq!(both, [arrived; 2], "{name}");
            assert!((segments.1.until - nodes.1.until).abs() < 1e-6, "{name}");
            let near = (segments.0 - nodes.0).abs() < 1e-6 * segments.0.max(1.0);
            assert!(near, "{name}: {segments:?} {nodes:?}");
        }
    }

    /// Motion after arrival adds no cost. For a motion that passes by, motion after the desired
    /// time adds none.
    #[test]
    fn nothing_grows_after_the_end() {
        let east = Pose::new(Vector::zeros(), 0.0);
        let wish = desired(&[(0.0, 0.0), (1000.0, 0.0)], &[5.0]);
        let error = |start: Pose, legs: &[(f64, f64, f64)]| {
            let [segments, _] = both(start, legs);
            counted_error(&segments, &wish, 25.0, 30.0)
        };
        let (ends, counted) = error(east, &[(250.0, 4.0, 0.0)]);
        assert!((counted.until - 242.5).abs() < 1e-9, "{counted:?}");
        let steps = 100_000;
        let at = |k: i32| counted.until * (f64::from(k) + 0.5) / f64::from(steps);
        let place = |time: f64| Vector::new(4.0 * time, 0.0);
        let sum: f64 = (0..steps)
            .map(|k| wish.nearest(place(at(k)), at(k), 25.0).error)
            .sum();
        let dense = sum * counted.until / f64::from(steps) / 200.0;
        assert!((ends - dense).abs() < 1e-6 * dense, "{ends} {dense}");
        for wait in [1.0, 1000.0] {
            let (waits, _) = error(east, &[(250.0, 4.0, 0.0), (wait, 0.0, 0.0)]);
            assert!((waits - ends).abs() < 1e-6 * ends, "{waits} {ends}");
        }
        let wide = Pose::new(Vector::new(0.0, 200.0), 0.0);
        let [short, long] = [300.0, 3000.0].map(|time| error(wide, &[(time, 5.0, 0.0)]));
        assert!((short.0 - 40_000.0).abs() < 1e-6 && (long.0 - short.0).abs() < 1e-6);
        assert!(!long.1.arrived && long.1.until == 200.0);
    }

    /// 3 m/s too fast for 125 s, then at rest for 75 s, with `kappa = 1/2`.
    #[test]
    fn a_ship_that_arrives_early_waits_for_the_schedule() {
        let wish = desired(&[(0.0, 0.0), (1000.0, 0.0)], &[5.0]);
        let motions = both(Pose::new(Vector::zeros(), 0.0), &[(125.0, 8.0, 0.0)]);
        let ahead = |rate: f64, duration: f64| 0.5 * rate * rate * duration.powi(3) / 3.0;
        let exact = (ahead(3.0, 125.0) + ahead(5.0, 75.0)) / wish.duration();
        let ended = error_to_end(motions[0].segments(), &wish, 25.0);
        let all = motions.map(|motion| counted_error(&motion, &wish, 25.0, 30.0));
        for (found, counted) in all.into_iter().chain([ended]) {
            assert!((found - exact).abs() < 1e-6 * exact, "{found} {exact}");
            assert!(counted.arrived && counted.until == 200.0, "{counted:?}");
        }
    }

    /// A round trip starts at its end: it arrives when it comes back.
    #[test]
    fn a_round_trip_arrives_when_it_comes_back() {
        let wish = desired(&[(0.0, 0.0), (500.0, 0.0), (0.0, 0.0)], &[5.0; 2]);
        let east = Pose::new(Vector::zeros(), 0.0);
        let half = std::f64::consts::PI / 10.0;
        let there = [(90.0, 5.0, 0.0), (10.0, 5.0, half), (90.0, 5.0, 0.0)];
        for trajectory in both(east, &there) {
            let (_, counted) = counted_error(&trajectory, &wish, 25.0, 40.0);
            // The return leg is 31.8 m to the side.
            assert!(counted.arrived && counted.until > 180.0, "{counted:?}");
        }
        let [stays, _] = both(east, &[(300.0, 0.0, 0.0)]);
        let (error, counted) = counted_error(&stays, &wish, 25.0, 40.0);
        assert!(!counted.arrived && counted.until == 200.0 && error > 1e3);
    }
}
