//! Lower bound of the space-time error to the end: the lag that own ship cannot recover, even
//! without obstacles.
//!
//! Let `s` be the distance along the path, `d(t)` the desired distance, and `u` the maximum desired
//! speed. Let `c` be a lower bound of `|x(s) - x(r)| / |s - r|` over all pairs of positions on the
//! path. Then for every `r`: `|x(s) - x_d(r)| >= c |s - r|` and `|t - t_d(r)| >= |d(t) - r| / u`.
//! Minimising the sum of squares over `r` gives `e² >= k (d(t) - s)²` with
//! `k = c² q / (q + c² u²)`.
//!
//! The lag `d(t) - s` decreases at most at the maximum speed minus the minimum desired speed. A
//! lead decreases at most at `u`. The motion takes at least the remaining distance over the maximum
//! speed. The bound is the integral of the least remaining lag over this time. It follows the lag
//! of any motion from below, so it is consistent.

use crate::Problem;
use searoom_geometry::frame::Vector;
use searoom_model::trajectory::DesiredTrajectory;

/// Relative margin for rounding of a tight bound.
const ROUNDING: f64 = 1e-9;

/// Lower bound of the space-time error to the end.
#[derive(Debug, Clone)]
pub(crate) struct Recovery<'a> {
    desired: &'a DesiredTrajectory,
    /// `k` divided by the duration of the desired trajectory.
    weight: f64,
    /// Maximum rates in m/s at which a lag and a lead decrease.
    catching: f64,
    falling: f64,
    max_speed: f64,
}

impl<'a> Recovery<'a> {
    /// Returns `None` if no bound above zero is known. This holds with alternatives, where distance
    /// along the path does not bound the distance from the schedule, and on self-intersecting
    /// paths.
    pub(crate) fn new(problem: &Problem<'a>) -> Option<Self> {
        if !problem.alternatives.is_empty() {
            return None;
        }
        let desired = problem.desired;
        let speeds = desired.legs().iter().map(|leg| leg.speed);
        let fastest = speeds.clone().fold(0.0, f64::max);
        let slowest = speeds.fold(f64::INFINITY, f64::min);
        let straight = straightness(desired).powi(2);
        let q = problem.time_weight;
        let weight = straight * q / (q + straight * fastest * fastest) / desired.duration();
        let max_speed = problem.own.max_speed();
        (weight > 0.0 && weight.is_finite()).then_some(Self {
            desired,
            weight: weight * (1.0 - ROUNDING),
            catching: (max_speed - slowest).max(0.0),
            falling: fastest,
            max_speed,
        })
    }

    /// Desired distance along the path in metres; beyond the end, it grows at the maximum desired
    /// speed.
    fn due(&self, time: f64) -> f64 {
        let legs = self.desired.legs();
        let late = time - self.desired.duration();
        if late > 0.0 {
            return self.desired.length() + self.falling * late;
        }
        let index = legs.partition_point(|leg| leg.start_time <= time).max(1) - 1;
        legs[index].start_distance + (time - legs[index].start_time) * legs[index].speed
    }

    /// Lower bound in m², given the remaining distance and the current time.
    pub(crate) fn bound(&self, to_go: f64, time: f64) -> f64 {
        let lag = self.due(time) - (self.desired.length() - to_go);
        let rate = if lag > 0.0 {
            self.catching
        } else {
            self.falling
        };
        let lag = lag.abs();
        let sailing = to_go / self.max_speed;
        let until = if rate * sailing > lag {
            lag / rate
        } else {
            sailing
        };
        let rest = lag - rate * until;
        self.weight * (lag * lag + lag * rest + rest * rest) / 3.0 * until
    }
}

/// Pairs of pieces examined before the straightness is reported as 0.
const MAX_PAIRS: usize = 20_000;

/// Bisection stops if the bound of a pair is at least this fraction of the smallest ratio found.
const SETTLED: f64 = 0.6;

/// Piece of a path between two distances, with its first and last leg.
#[derive(Debug, Clone, Copy)]
struct Piece {
    from: f64,
    to: f64,
    first: usize,
    last: usize,
}

/// Lower bound in [0, 1] of `|x(s) - x(r)| / |s - r|` over a path. It is 1 on a straight path and
/// the cosine of half the turn at a single corner. It is 0 if the path intersects itself, or if the
/// search exceeds `MAX_PAIRS`. Branch and bound over pairs of pieces: every point of a piece lies
/// within half its length of its midpoint.
fn straightness(desired: &DesiredTrajectory) -> f64 {
    let legs = desired.legs();
    let at = |distance: f64, leg: usize| -> Vector {
        legs[leg].start + legs[leg].direction * (distance - legs[leg].start_distance)
    };
    let corner = |leg: usize| {
        let cosine = legs[leg].direction.dot(&legs[leg + 1].direction);
        (0.5 * (1.0 + cosine)).max(0.0).sqrt()
    };
    let mut least: f64 = (0..legs.len() - 1).map(corner).fold(1.0, f64::min);
    let mut seen = least;
    let halves = |piece: &Piece| -> [Piece; 2] {
        let (at, last, first) = if piece.first == piece.last {
            (0.5 * (piece.from + piece.to), piece.last, piece.first)
        } else {
            let cut = usize::midpoint(piece.first, piece.last) + 1;
            (legs[cut].start_distance, cut - 1, cut)
        };
        [
            Piece {
                to: at,
                last,
                ..*piece
            },
            Piece {
                from: at,
                first,
                ..*piece
            },
        ]
    };
    let middle = |piece: &Piece| {
        let distance = 0.5 * (piece.from + piece.to);
        let leg = legs.partition_point(|leg| leg.start_distance <= distance);
        at(distance, leg.max(1) - 1)
    };
    let whole = Piece {
        from: 0.0,
        to: desired.length(),
        first: 0,
        last: legs.len() - 1,
    };
    let mut open = vec![(whole, whole)];
    for _ in 0..MAX_PAIRS {
        let Some((a, b)) = open.pop() else {
            return least;
        };
        // one leg or two adjacent legs: already bounded
        if b.last <= a.first + 1 {
            continue;
        }
        if a.from == b.from && a.to == b.to {
            let [first, second] = halves(&a);
            open.extend([(first, first), (first, second), (second, second)]);
            continue;
        }
        let (longer, shorter) = (a.to - a.from, b.to - b.from);
        let apart = (middle(&a) - middle(&b)).norm();
        let along = 0.5 * (b.from + b.to - a.from - a.to);
        seen = seen.min(apart / along);
        let bound = (apart - 0.5 * (longer + shorter)) / (b.to - a.from);
        if bound >= SETTLED * seen {
            least = least.min(bound);
        } else if longer >= shorter {
            open.extend(halves(&a).map(|half| (half, b)));
        } else {
            open.extend(halves(&b).map(|half| (a, half)));
        }
    }
    0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use searoom_geometry::frame::direction;

    fn path(points: &[(f64, f64)]) -> DesiredTrajectory {
        let points: Vec<Vector> = points.iter().map(|&(x, y)| Vector::new(x, y)).collect();
        DesiredTrajectory::new(&points, &vec![5.0; points.len() - 1]).expect("valid")
    }

    #[test]
    fn straightness_is_at_most_that_of_any_two_places() {
        assert_eq!(straightness(&path(&[(0.0, 0.0), (50.0, 10.0)])), 1.0);
        let square = straightness(&path(&[(0.0, 0.0), (50.0, 0.0), (50.0, 80.0)]));
        assert!((square - 0.5_f64.sqrt()).abs() < 1e-12);
        let back = [(0.0, 0.0), (50.0, 0.0), (50.0, 80.0), (0.0, 0.0)];
        assert!(straightness(&path(&back)) < 1e-9);
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        for case in 0..60 {
            let mut points = vec![Vector::zeros()];
            for leg in 0..rng.random_range(1..12) {
                let turn = if case % 2 == 0 { 0.5 } else { 1.4 };
                let heading = rng.random_range(-turn..turn);
                points.push(points[leg] + direction(heading) * rng.random_range(5.0..300.0));
            }
            let desired =
                DesiredTrajectory::new(&points, &vec![5.0; points.len() - 1]).expect("valid");
            let found = straightness(&desired);
            let place = |k: usize| desired.position_at(desired.duration() * k as f64 / 150.0);
            let mut sampled: f64 = 1.0;
            for i in 0..150 {
                for j in i + 1..=150 {
                    let along = desired.length() * (j - i) as f64 / 150.0;
                    sampled = sampled.min((place(j) - place(i)).norm() / along);
                }
            }
            assert!(found <= sampled + 1e-9, "{case}: {found} {sampled}");
            assert!(found >= 0.55 * sampled, "{case}: {found} {sampled}");
        }
    }
}
