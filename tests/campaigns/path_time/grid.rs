//! A search over (distance, time) that is small, slow and obviously right. The path-time planner's
//! arrival is compared with it.
//!
//! The path is cut into `cells` pieces and time into steps in which one piece is sailed at full
//! speed. In every step own ship sails one piece or waits. Upper bound: with the sets as they are,
//! every step is tested as a motion. The result is a plan, so it arrives no earlier than the least
//! time. Lower bound: with the sets two pieces smaller on every side, only the grid's points are
//! tested. Every motion, rounded down to the grid, is one of the grid's. It is never more than two
//! pieces away from itself at the same time. So no motion arrives more than a step earlier.
//!
//! Shared with the program: membership and contact of a set in the plane and time, not along a
//! path.

use searoom::frame::{Pose, Vector, heading_of};
use searoom::obstacle::{Obstacle, SpaceTimeObstacle};
use searoom::trajectory::{DesiredTrajectory, Segment};

/// A polyline by distance.
pub struct Path {
    pub points: Vec<Vector>,
}

impl Path {
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|p| (p[1] - p[0]).norm()).sum()
    }

    /// Waypoints passed by a distance, and the place there.
    pub fn at(&self, distance: f64) -> (usize, Vector) {
        let mut left = distance;
        for (leg, pair) in self.points.windows(2).enumerate() {
            let length = (pair[1] - pair[0]).norm();
            if left <= length || leg + 2 == self.points.len() {
                return (leg, pair[0] + (pair[1] - pair[0]) * (left / length));
            }
            left -= length;
        }
        unreachable!("the last leg ends it")
    }

    /// The motion between two distances in a span of time, straight pieces.
    pub fn motion(&self, from: f64, to: f64, start: f64, duration: f64) -> Vec<Segment> {
        let mut stops = vec![from];
        let mut run = 0.0;
        for pair in self.points.windows(2) {
            run += (pair[1] - pair[0]).norm();
            if run > from + 1e-9 && run < to - 1e-9 {
                stops.push(run);
            }
        }
        stops.push(to);
        let time = |s: f64| start + duration * (s - from) / (to - from);
        stops
            .windows(2)
            .map(|s| {
                let (a, b) = (self.at(s[0]).1, self.at(s[1]).1);
                let (begins, lasts) = match to > from {
                    true => (time(s[0]), time(s[1]) - time(s[0])),
                    false => (start, duration),
                };
                let pose = Pose::new(a, heading_of(b - a));
                Segment::straight(pose, begins, lasts, (b - a).norm() / lasts)
            })
            .collect()
    }
}

/// Metres that a motion may be inside a set. Those without interior block, too: planned around as
/// sets a millimetre wide.
fn depth(obstacle: &Obstacle) -> f64 {
    let searoom::geometry::ConvexSet::Polygon(initial) = obstacle.section(0.0) else {
        return 1e-7;
    };
    let width = |n: &Vector| initial.support(*n) + initial.support(-n);
    if initial.normals().iter().any(|n| width(n) < 1.1e-3) {
        -6e-4
    } else {
        1e-7
    }
}

/// True where own ship may sail from one distance to another in a span of time.
fn is_clear(path: &Path, sets: &[(&Obstacle, f64)], ends: [f64; 2], start: f64, step: f64) -> bool {
    let motion = path.motion(ends[0], ends[1], start, step);
    let clear = |s: &Segment| {
        sets.iter()
            .all(|(o, depth)| o.first_contact(s, *depth).is_none())
    };
    motion.iter().all(clear)
}

/// The earliest arrival on the grid, seconds; `None` when there is none before the horizon.
/// `shrunk` asks for the lower bound.
pub fn earliest(
    path: &Path,
    obstacles: &[Obstacle],
    speed: f64,
    horizon: f64,
    cells: usize,
    shrunk: bool,
) -> Option<f64> {
    let piece = path.length() / cells as f64;
    let step = piece / speed;
    let steps = (horizon / step).floor() as usize + usize::from(shrunk);
    let margin = 2.0 * piece;
    let sets: Vec<(&Obstacle, f64)> = obstacles.iter().map(|o| (o, depth(o))).collect();
    let clear_point = |i: usize, k: usize| {
        let (_, place) = path.at(i as f64 * piece);
        obstacles
            .iter()
            .all(|o| o.signed_distance(place, k as f64 * step).distance > -margin)
    };
    let clear_step = |i: usize, j: usize, k: usize| {
        let ends = [i, j].map(|k| k as f64 * piece);
        is_clear(path, &sets, ends, k as f64 * step, step)
    };
    let mut reached = vec![false; cells + 1];
    reached[0] = !shrunk || clear_point(0, 0);
    for k in 0..steps {
        let mut next = vec![false; cells + 1];
        for (i, _) in reached.iter().enumerate().filter(|(_, here)| **here) {
            for j in [i, i + 1] {
                if j > cells || next[j] {
                    continue;
                }
                next[j] = if shrunk {
                    clear_point(j, k + 1)
                } else {
                    clear_step(i, j, k)
                };
            }
        }
        reached = next;
        if reached[cells] {
            return Some((k + 1) as f64 * step);
        }
        if !reached.contains(&true) {
            return None;
        }
    }
    None
}

/// Error of lying at the end from `arrival` to the end of the desired trajectory, m² s.
fn waiting(desired: &DesiredTrajectory, arrival: f64, time_weight: f64) -> f64 {
    let left = (desired.duration() - arrival).max(0.0);
    let pieces = 100;
    let part = left / f64::from(pieces);
    let at = |k: i32| arrival + (f64::from(k) + 0.5) * part;
    let error = |t: f64| desired.nearest(desired.end(), t, time_weight).error;
    (0..pieces).map(|k| error(at(k)) * part).sum()
}

/// The least space-time error on the grid, m²; `None` when the end is not reached before the
/// horizon. The result is the cost of a plan, so it is at least the minimum. The error is
/// integrated by Simpson's rule over each step.
pub fn least_error(
    path: &Path,
    obstacles: &[Obstacle],
    desired: &DesiredTrajectory,
    time_weight: f64,
    speed: f64,
    horizon: f64,
    cells: usize,
) -> Option<f64> {
    let piece = path.length() / cells as f64;
    let step = piece / speed;
    let steps = (horizon / step).floor() as usize;
    let sets: Vec<(&Obstacle, f64)> = obstacles.iter().map(|o| (o, depth(o))).collect();
    let error = |s: f64, t: f64| desired.nearest(path.at(s).1, t, time_weight).error;
    let mut cost = vec![f64::INFINITY; cells + 1];
    cost[0] = 0.0;
    let mut best = f64::INFINITY;
    for k in 0..steps {
        let mut next = vec![f64::INFINITY; cells + 1];
        for (i, before) in cost.iter().enumerate().filter(|(_, c)| **c < best) {
            for j in [i, i + 1] {
                if j > cells || *before >= next[j] {
                    continue;
                }
                let (from, to) = (i as f64 * piece, j as f64 * piece);
                let start = k as f64 * step;
                let (middle, end) = (start + 0.5 * step, start + step);
                let mean =
                    (error(from, start) + 4.0 * error(0.5 * (from + to), middle) + error(to, end))
                        / 6.0;
                let total = before + mean * step;
                if total < next[j] && is_clear(path, &sets, [from, to], start, step) {
                    next[j] = total;
                }
            }
        }
        let arrival = (k + 1) as f64 * step;
        best = best.min(next[cells] + waiting(desired, arrival, time_weight));
        cost = next;
    }
    best.is_finite().then_some(best / desired.duration())
}
