//! Lower bound of the space-time error that the obstacles force on every plan: part of the
//! heuristic.
//!
//! # Why it never exceeds the true cost to go
//!
//! For one straight leg the scheduled point is `p_d(tau)`. Every plan is outside every `O_tau`
//! until it arrives. The outside of a convex set is the union of its faces' outer half-planes. So
//! the unclamped error satisfies
//!
//! `e(tau) >= E(tau) = max over O of min over faces n of depth_n(p_d) / sqrt(n_across² + n_along² /
//! kappa)`:
//!
//! This is the depth of the scheduled point behind a face, in the metric of `e`. `e` changes by at
//! most `rho = max over |v| <= u_max of sqrt(v_across² + kappa (u_d - v_along)²)` per second. So
//! the envelope `max over tau' of E(tau') - rho |tau - tau'|` bounds it too, and between two
//! instants `D` apart `e >= (E_a + E_b - rho D) / 2`. The sum covers the time until the earliest
//! possible arrival. A node whose own error is below the envelope cannot be part of any plan.
//!
//! An ellipsoid is replaced by a polytope within it: a point outside the ellipsoid is outside the
//! polytope. A convex piece with a time window counts at the sampled instants of its window only.
//! Since `E` is sampled at instants only, the proof still holds. [`ObstacleBound::obstacles`]
//! leaves such pieces out.

use crate::frame::{Vector, cross, heading_of};
use crate::obstacle::HalfSpace;
use crate::planner::Problem;
use crate::planner::space_time::proxy::Proxy;
use crate::trajectory::DesiredLeg;

/// Seconds between two sampled instants.
const STEP_S: f64 = 0.5;

/// Lower bound as a function of time.
#[derive(Debug, Clone)]
pub(crate) struct ObstacleBound {
    /// Lower bound of the remaining integral at every multiple of [`STEP_S`], m² s; decreasing.
    to_come: Vec<f64>,
    obstacles: Vec<EnteredObstacle>,
    /// Envelope of `E` there, and its largest decrease per step, metres.
    least: Vec<f64>,
    fall: f64,
}

impl ObstacleBound {
    /// Zero bound: no obstacles, or more than one leg.
    pub(crate) fn none() -> Self {
        Self {
            to_come: Vec::new(),
            obstacles: Vec::new(),
            least: Vec::new(),
            fall: 0.0,
        }
    }

    /// Bound for the obstacles that the scheduled motion enters.
    pub(crate) fn new(problem: &Problem, proxies: &[Proxy]) -> Self {
        let [leg] = problem.desired.legs() else {
            return Self::none();
        };
        let (own, q) = (problem.own, problem.time_weight);
        let kappa = q / (q + leg.speed * leg.speed);
        // earliest possible arrival
        let until = (problem.desired.end() - own.pose.position).norm() / own.max_speed();
        let count = (until / STEP_S).floor().max(0.0) as usize;
        let mut least = vec![0.0; count + 1];
        let mut obstacles = Vec::new();
        for proxy in proxies {
            let faces = proxy.within.faces().iter();
            let faces: Vec<Face> = faces
                .map(|f| Face::new(in_scenario_time(f, proxy.start()), leg, kappa))
                .collect();
            let mut contact = None;
            let steps =
                contact_interval(&faces).map(|time| (time / STEP_S).clamp(0.0, least.len() as f64));
            let (first, last) = (steps[0].floor() as usize, steps[1].ceil() as usize + 1);
            for (k, least) in least.iter_mut().enumerate().take(last).skip(first) {
                let time = STEP_S * k as f64;
                if proxy
                    .window
                    .is_some_and(|w| !(time >= w.start && time <= w.end))
                {
                    continue;
                }
                let depth = faces
                    .iter()
                    .map(|f| f.depth_at(time))
                    .fold(f64::INFINITY, f64::min);
                if depth > 0.0 {
                    contact = Some((contact.map_or(time, |c: (f64, f64)| c.0), time));
                    *least = depth.max(*least);
                }
            }
            // the tight bound assumes that its faces exist for ever
            let contact = contact.filter(|_| proxy.window.is_none());
            obstacles.extend(contact.map(|(from, to)| EnteredObstacle { faces, from, to }));
        }
        let fall = rate(own.max_speed(), leg.speed, kappa) * STEP_S;
        for k in 1..least.len() {
            least[k] = least[k].max(least[k - 1] - fall);
        }
        for k in (1..least.len()).rev() {
            least[k - 1] = least[k - 1].max(least[k] - fall);
        }
        let mut to_come = vec![0.0; least.len()];
        for k in (1..least.len()).rev() {
            let between = (0.5 * (least[k - 1] + least[k] - fall)).max(0.0);
            to_come[k - 1] = to_come[k] + between * between * STEP_S;
        }
        Self {
            to_come,
            obstacles,
            least,
            fall,
        }
    }

    /// True when a plan with this error (metres) at this time cannot clear the obstacles later.
    pub(crate) fn forbids(&self, error: f64, time: f64) -> bool {
        let before = (time / STEP_S).floor().max(0.0) as usize;
        match (self.least.get(before), self.least.get(before + 1)) {
            (Some(a), Some(b)) => error < a.min(*b) - self.fall - 1e-6,
            _ => false,
        }
    }

    pub(crate) fn obstacles(&self) -> &[EnteredObstacle] {
        &self.obstacles
    }

    /// Last time at which the scheduled point is inside an obstacle.
    pub(crate) fn last_contact(&self) -> f64 {
        self.obstacles.iter().map(|b| b.to).fold(0.0, f64::max)
    }

    /// Least integral of the squared error from a time on, m² s.
    pub(crate) fn cost_from(&self, time: f64) -> f64 {
        // the next instant: what precedes it is not counted
        let steps = (time / STEP_S).max(0.0);
        let before = steps as usize;
        let next = before + usize::from(steps > before as f64);
        self.to_come.get(next).copied().unwrap_or(0.0)
    }

    /// Least integral of the squared error between two times, m² s.
    pub(crate) fn cost_between(&self, from: f64, to: f64) -> f64 {
        let before = (to / STEP_S).max(0.0) as usize;
        let after = self.to_come.get(before).copied().unwrap_or(0.0);
        (self.cost_from(from) - after).max(0.0)
    }
}

/// Time interval during which the scheduled point is behind every face; empty (first > second)
/// where it never is.
fn contact_interval(faces: &[Face]) -> [f64; 2] {
    let (mut from, mut to) = (0.0_f64, f64::INFINITY);
    for face in faces {
        let root = -face.depth / face.rate;
        if face.rate > 0.0 {
            from = from.max(root);
        } else if face.rate < 0.0 {
            to = to.min(root);
        } else if face.depth <= 0.0 {
            to = f64::NEG_INFINITY;
        }
    }
    [from, to]
}

/// Face in scenario time; its own clock starts at `start`.
fn in_scenario_time(face: &HalfSpace, start: f64) -> HalfSpace {
    HalfSpace {
        initial_support: face.initial_support - face.velocity_support * start,
        ..*face
    }
}

/// Obstacle that the scheduled point is inside of for some time.
#[derive(Debug, Clone)]
pub(crate) struct EnteredObstacle {
    pub faces: Vec<Face>,
    /// Seconds.
    pub from: f64,
    pub to: f64,
}

/// Face of an obstacle relative to the scheduled point.
#[derive(Debug, Clone)]
pub(crate) struct Face {
    pub plane: HalfSpace,
    /// Heading of its normal, radians.
    pub heading: f64,
    /// Its unit normal in the metric of the error, along and across the leg.
    pub metric: Vector,
    /// Depth of the scheduled point behind it in that metric: metres at t = 0, and m/s.
    depth: f64,
    rate: f64,
}

impl Face {
    fn new(plane: HalfSpace, leg: &DesiredLeg, kappa: f64) -> Self {
        let along = leg.direction.dot(&plane.normal);
        let metric = Vector::new(along / kappa.sqrt(), cross(leg.direction, plane.normal));
        let scale = metric.norm();
        let at_zero = leg.start - leg.direction * (leg.speed * leg.start_time);
        Self {
            plane,
            heading: heading_of(plane.normal),
            metric: metric / scale,
            depth: -plane.slack(at_zero, 0.0) / scale,
            rate: (plane.velocity_support - leg.speed * along) / scale,
        }
    }

    pub(crate) fn depth_at(&self, time: f64) -> f64 {
        self.depth + self.rate * time
    }
}

/// `rho`: a convex function of the velocity, so its maximum lies on the circle of the greatest
/// speed.
fn rate(max_speed: f64, desired: f64, kappa: f64) -> f64 {
    let square = |cosine: f64| {
        let across = max_speed * max_speed * (1.0 - cosine * cosine);
        across + kappa * (desired - max_speed * cosine).powi(2)
    };
    let turning = -kappa * desired / (max_speed * (1.0 - kappa)).max(f64::MIN_POSITIVE);
    [-1.0, 1.0, turning.clamp(-1.0, 1.0)]
        .into_iter()
        .map(square)
        .fold(0.0, f64::max)
        .sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_is_the_largest_over_every_velocity() {
        for kappa in [0.1, 0.5, 0.9, 1.0] {
            let bound = rate(6.0, 5.0, kappa);
            let mut largest = 0.0_f64;
            for i in 0..=200 {
                for k in 0..=20 {
                    let v = crate::frame::direction(f64::from(i) * 0.0315)
                        * (6.0 * f64::from(k) / 20.0);
                    largest = largest.max((v.y * v.y + kappa * (5.0 - v.x).powi(2)).sqrt());
                }
            }
            assert!(
                bound >= largest - 1e-9 && bound < largest * 1.01,
                "{bound} {largest}"
            );
        }
    }
}
