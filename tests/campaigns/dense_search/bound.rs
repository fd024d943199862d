//! A lower bound of the cost to go, so that the dense search can leave out what cannot win.
//!
//! The error of a point is at least `sqrt(across² + kappa lag²)`, the form without its clamp
//! (docs/reference/theory.md, section 7). Three facts bound its integral from below over steps of
//! equal length:
//! - *across* cannot shrink faster than the ship can turn toward the path and run there at full
//!   speed;
//! - *lag* cannot shrink faster than own ship can turn along the path and run there at full speed;
//! - at every instant the ship is outside every set, so its error is at least the least error
//!   outside. Its error changes at a bounded rate, so this also holds, less the rate, before and
//!   after.
//!
//! The first two add up; of their sum and the third the larger counts, step by step.

use std::f64::consts::{FRAC_PI_2, PI};

use super::polytopes;
use searoom::frame::{Pose, cross, heading_of, wrap};
use searoom::planner::Problem;
use searoom::trajectory::DesiredLeg;

/// Angles in half a turn for which progress is tabulated.
const ANGLES: usize = 90;

/// Samples of the least error outside the sets per step.
const SAMPLES: usize = 16;

pub struct Bound {
    leg: DesiredLeg,
    kappa: f64,
    fastest: f64,
    step: f64,
    /// Per angle between heading and wish, per step: metres made good at most.
    progress: Vec<Vec<f64>>,
    /// Per number of steps from t = 0: integral of the squared least error outside until then, m²
    /// s.
    outside: Vec<f64>,
}

impl Bound {
    pub fn new(problem: &Problem, leg: &DesiredLeg, step: f64) -> Self {
        let fastest = problem.own.max_speed();
        let steps = (problem.horizon / step) as usize + 1;
        let mut bound = Self {
            leg: *leg,
            kappa: problem.time_weight / (problem.time_weight + leg.speed.powi(2)),
            fastest,
            step,
            progress: Vec::new(),
            outside: vec![0.0],
        };
        for angle in 0..=ANGLES {
            let away = angle as f64 * PI / ANGLES as f64;
            bound.progress.push(
                (0..=steps)
                    .map(|k| progress(away, fastest * step * k as f64, problem.own.turning_radius))
                    .collect(),
            );
        }
        bound.tabulate_outside(problem, steps);
        bound
    }

    /// Integral of the error still to come, m² s, from below. `index` is the time in steps.
    pub fn to_go(&self, pose: &Pose, index: usize) -> f64 {
        let offset = pose.position - self.leg.start;
        let along = self.leg.direction.dot(&offset);
        let across = cross(self.leg.direction, offset);
        let heading = wrap(pose.heading - heading_of(self.leg.direction));
        let toward = if across > 0.0 { -FRAC_PI_2 } else { FRAC_PI_2 };
        let (inward, ahead) = (self.row(wrap(heading - toward)), self.row(heading));
        let lag = self.leg.speed * self.step * index as f64 - along;
        // it cannot arrive before these many whole steps
        let at_sea = ((self.leg.length - along) / self.fastest / self.step).max(0.0) as usize;
        let across_at = |k: usize| across.abs() - inward[k];
        let lag_at = |k: usize| {
            let time = self.step * k as f64;
            if lag > 0.0 {
                lag + self.leg.speed * time - ahead[k]
            } else {
                -lag - (self.leg.speed + self.fastest) * time
            }
        };
        let mut total = 0.0;
        let last = inward.len() - 1;
        for k in 0..last {
            let off = (across_at(k), across_at(k + 1));
            let behind = (lag_at(k), lag_at(k + 1));
            let sailing = k < at_sea;
            if off.0 <= 0.0 && (!sailing || behind.0.max(behind.1) <= 0.0) {
                return total
                    + (self.outside_until(index + at_sea) - self.outside_until(index + k))
                        .max(0.0);
            }
            let mut part = self.squared(off);
            if sailing {
                part += self.kappa * self.squared(behind);
                let outside = self.outside_until(index + k + 1) - self.outside_until(index + k);
                part = part.max(outside);
            }
            total += part;
        }
        total
    }

    fn row(&self, away: f64) -> &[f64] {
        // a smaller angle makes more good: rounding down keeps the bound below
        &self.progress[(away.abs() / PI * ANGLES as f64) as usize]
    }

    fn outside_until(&self, index: usize) -> f64 {
        self.outside[index.min(self.outside.len() - 1)]
    }

    /// Integral over one step of the square of a quantity, counted only where it is positive. The
    /// quantity has these ends and is concave in time, so it lies above its chord.
    fn squared(&self, (a, b): (f64, f64)) -> f64 {
        let integral = match (a > 0.0, b > 0.0) {
            (true, true) => (a * a + a * b + b * b) / 3.0,
            (true, false) => a * a * a / (3.0 * (a - b)),
            (false, true) => b * b * b / (3.0 * (b - a)),
            (false, false) => 0.0,
        };
        integral * self.step
    }

    /// Samples the least error outside and takes its envelope under the largest rate at which an
    /// error can change. Then integrates the lowest error that two neighbouring samples allow
    /// between them.
    fn tabulate_outside(&mut self, problem: &Problem, steps: usize) {
        let spacing = self.step / SAMPLES as f64;
        let rate = (0..3600)
            .map(|i| f64::from(i) * PI / 1800.0)
            .map(|a| {
                (
                    a.sin() * self.fastest,
                    self.leg.speed - a.cos() * self.fastest,
                )
            })
            .map(|(y, x)| (y * y + self.kappa * x * x).sqrt())
            .fold(0.0, f64::max)
            * 1.0001;
        let mut least: Vec<f64> = (0..=steps * SAMPLES)
            .map(|i| self.least_outside(problem, spacing * i as f64))
            .collect();
        for i in 1..least.len() {
            least[i] = least[i].max(least[i - 1] - rate * spacing);
        }
        for i in (1..least.len()).rev() {
            least[i - 1] = least[i - 1].max(least[i] - rate * spacing);
        }
        for k in 0..steps {
            let part: f64 = (0..SAMPLES)
                .map(|i| least[k * SAMPLES + i] + least[k * SAMPLES + i + 1])
                .map(|sum| ((sum - rate * spacing) / 2.0).max(0.0).powi(2) * spacing)
                .sum();
            self.outside.push(self.outside[k] + part);
        }
    }

    /// Least error of a point outside every set. The outside of a set is a union of half-planes.
    /// The least error in a half-plane at depth `d` is `d / sqrt(n_across² + n_along² / kappa)`.
    fn least_outside(&self, problem: &Problem, time: f64) -> f64 {
        let desired = self.leg.start + self.leg.direction * (self.leg.speed * time);
        let of_set = |o: &searoom::obstacle::PolytopeObstacle| {
            o.faces()
                .iter()
                .map(|f| {
                    let n = (
                        self.leg.direction.dot(&f.normal),
                        cross(self.leg.direction, f.normal),
                    );
                    let depth = (-f.slack(desired, time)).max(0.0);
                    depth / (n.1 * n.1 + n.0 * n.0 / self.kappa).sqrt()
                })
                .fold(f64::INFINITY, f64::min)
        };
        polytopes(problem).map(of_set).fold(0.0, f64::max)
    }
}

/// Metres made good in a wished direction within `length` metres. The ship first points `away`
/// (radians) from it, turns at once on its smallest circle and then runs on. Not below 0, as it may
/// also stay. Convex in `length`.
fn progress(away: f64, length: f64, radius: f64) -> f64 {
    let turning = length.min(away * radius);
    let made = radius * (away.sin() - (away - turning / radius).sin()) + (length - turning);
    made.max(0.0)
}
