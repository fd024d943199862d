//! Small, slow reference search over (east, north, heading, time), against which the space-time
//! planner's cost is measured.
//!
//! Own ship steps `STEP` seconds at a time at one of its speeds, straight on or on its smallest
//! circle to either side. States stay continuous; of those that fall into one cell at one time only
//! the most promising goes on. From every state that goes on the ship also tries to close: back
//! to the desired path, recover the lag, steer to the end. The result is a trajectory of the same
//! ship, clear of the same sets (sampled in time), so its cost is an upper bound of the
//! optimum. It is not the optimum: turns come in multiples of a step and cells merge, which costs a
//! few per cent. A planner that this search does not beat has a ratio of at most 1.
//!
//! Shared with the program: the motion along a [`Segment`], the space-time error of a point, and
//! membership of a set. One straight desired leg only.

mod bound;
mod closing;
mod comparison;
#[cfg(test)]
mod tests;

use std::collections::HashMap;

use searoom::frame::{Pose, Vector, cross, heading_of, wrap};
use searoom::obstacle::PolytopeObstacle;
use searoom::planner::Problem;
use searoom::trajectory::{DesiredLeg, Segment, Trajectory};

use bound::Bound;
use closing::{chain, returns, turn_then_straight};
pub use comparison::{run, run_among};

/// Metres before the end from which the ship also steers straight for the last waypoint.
const HOMING: f64 = 500.0;

/// Metres from the path beyond which no return is tried: the lattice comes nearer by itself.
const RETURN_FROM: f64 = 100.0;

/// Seconds of a step.
const STEP: f64 = 4.0;

/// Cells of a full turn.
const HEADINGS: f64 = 72.0;

/// Seconds between the instants at which membership is tested.
const CHECK: f64 = 0.02;

/// How fine the search is.
#[derive(Debug, Clone, Copy)]
pub struct DenseSearch {
    /// Metres.
    pub cell: f64,
    /// States to step from at most: the bound on time and memory.
    pub max_states: usize,
}

impl Default for DenseSearch {
    fn default() -> Self {
        Self {
            cell: 10.0,
            max_states: 3_000_000,
        }
    }
}

impl DenseSearch {
    /// Cells that grow with the manoeuvre, so that even a dear one is searched in seconds. An error
    /// that costs `incumbent` m² is as large as its cubic root. Where the cells have grown it
    /// overlooks a few per cent that the default still finds.
    pub fn coarse(incumbent: f64) -> Self {
        Self {
            cell: Self::default().cell * (incumbent / 2000.0).cbrt().max(1.0),
            max_states: 500_000,
        }
    }
}

/// A cheaper trajectory.
#[derive(Debug, Clone)]
pub struct Found {
    /// Space-time error, m².
    pub cost: f64,
    /// Clear at every instant tested.
    pub trajectory: Trajectory,
}

/// Result and effort of a search.
#[derive(Debug, Clone)]
pub struct Answer {
    /// The cheapest trajectory below the incumbent, if any.
    pub cheaper: Option<Found>,
    /// States that were stepped from.
    pub states: usize,
    /// False when the search ran out of states: something cheaper may be left.
    pub complete: bool,
}

struct State {
    pose: Pose,
    /// Integral of the error so far, m² s.
    cost: f64,
    /// The cost plus the lower bound of the cost to go. States of one cell are compared by it.
    total: f64,
    /// Index of the state before, and the step from there.
    before: Option<(usize, Segment)>,
}

/// Everything a step is judged by.
struct Scene<'a> {
    problem: &'a Problem<'a>,
    leg: DesiredLeg,
    /// `q / (q + speed²)`: the weight of a squared lag.
    kappa: f64,
    /// m/s: the slack of a set changes at most this fast along any motion of the ship.
    closing_speed: f64,
}

impl DenseSearch {
    /// The cheapest trajectory found that costs less than `incumbent` (m²).
    ///
    /// # Panics
    /// When the desired trajectory has several legs.
    pub fn cheaper_than(&self, problem: &Problem, incumbent: f64) -> Answer {
        let [leg] = problem.desired.legs() else {
            panic!("the dense search knows one straight leg only");
        };
        let fastest_set = polytopes(problem).map(|o| o.velocity().reach());
        let scene = Scene {
            problem,
            leg: *leg,
            kappa: problem.time_weight / (problem.time_weight + leg.speed.powi(2)),
            closing_speed: problem.own.max_speed() + fastest_set.fold(0.0, f64::max),
        };
        let bound = Bound::new(problem, leg, STEP);
        let duration = problem.desired.duration();
        let mut limit = incumbent * duration;
        let mut best: Option<(usize, Vec<Segment>)> = None;
        let mut states = vec![State {
            pose: problem.own.pose,
            cost: 0.0,
            total: 0.0,
            before: None,
        }];
        let mut layer = 0..1;
        let (mut expanded, mut complete) = (0, true);
        for index in 0.. {
            let time = index as f64 * STEP;
            if !complete || layer.is_empty() || time + STEP > problem.horizon {
                break;
            }
            let mut next: Vec<State> = Vec::new();
            let mut cells: HashMap<[i64; 3], usize> = HashMap::new();
            for at in layer.clone() {
                let (pose, cost) = (states[at].pose, states[at].cost);
                if states[at].total >= limit {
                    continue;
                }
                if expanded == self.max_states {
                    complete = false;
                    break;
                }
                expanded += 1;
                for closing in scene.closings(&pose, time) {
                    let total = cost + scene.cost_below(&closing, limit - cost);
                    if total < limit && scene.is_clear(&closing) {
                        limit = total;
                        best = Some((at, closing));
                    }
                }
                for segment in scene.steps(&pose, time, STEP) {
                    let end = segment.end();
                    let to_go = bound.to_go(&end, index + 1);
                    if cost + to_go >= limit {
                        continue;
                    }
                    let cost = cost + scene.cost(&segment);
                    let state = State {
                        pose: end,
                        cost,
                        total: cost + to_go,
                        before: Some((at, segment)),
                    };
                    // of the states of a cell the most promising goes on
                    let cell = self.cell_of(&end, leg);
                    let best = cells.get(&cell).copied();
                    if state.total < limit
                        && best.is_none_or(|k| state.total < next[k].total)
                        && scene.is_clear(&[segment])
                    {
                        match best {
                            Some(k) => next[k] = state,
                            None => {
                                cells.insert(cell, next.len());
                                next.push(state);
                            }
                        }
                    }
                }
            }
            layer = states.len()..states.len() + next.len();
            states.append(&mut next);
        }
        Answer {
            cheaper: best.map(|(at, closing)| Found {
                cost: limit / duration,
                trajectory: trace(&states, at, closing),
            }),
            states: expanded,
            complete,
        }
    }

    fn cell_of(&self, pose: &Pose, leg: &DesiredLeg) -> [i64; 3] {
        let offset = pose.position - leg.start;
        let turn = wrap(pose.heading - heading_of(leg.direction)) / std::f64::consts::TAU;
        [
            (leg.direction.dot(&offset) / self.cell).round() as i64,
            (cross(leg.direction, offset) / self.cell).round() as i64,
            ((turn * HEADINGS).round() as i64).rem_euclid(HEADINGS as i64),
        ]
    }
}

impl Scene<'_> {
    /// Every speed, straight and to both sides.
    fn steps(&self, pose: &Pose, time: f64, step: f64) -> Vec<Segment> {
        let own = self.problem.own;
        let turns = |speed| [0.0, -1.0, 1.0].map(|turn| (speed, turn * speed / own.turning_radius));
        let steps = own.speeds.iter().copied().flat_map(turns);
        steps
            .map(|(speed, rate)| Segment::new(*pose, time, step, speed, rate))
            .collect()
    }

    /// Distance from the desired line, lag behind the desired motion along it (metres), and true
    /// where the nearest point in space-time is on the leg. Then the error is
    /// `across² + kappa lag²`.
    fn off(&self, position: Vector, time: f64) -> (f64, f64, bool) {
        let offset = position - self.leg.start;
        let (along, speed) = (self.leg.direction.dot(&offset), self.leg.speed);
        let q = self.problem.time_weight;
        let nearest = (along + q * time / speed) / (1.0 + q / (speed * speed));
        let on_leg = nearest >= -1e-9 && nearest <= self.leg.length + 1e-9;
        (
            cross(self.leg.direction, offset),
            speed * time - along,
            on_leg,
        )
    }

    /// The error at one instant of a segment, m².
    fn error(&self, segment: &Segment, elapsed: f64) -> f64 {
        let time = segment.start_time + elapsed;
        let position = segment.pose_after(elapsed).position;
        let (across, lag, on_leg) = self.off(position, time);
        if on_leg {
            across * across + self.kappa * lag * lag
        } else {
            let q = self.problem.time_weight;
            self.problem.desired.nearest(position, time, q).error
        }
    }

    /// The integral of the error along a segment, m² s. Along a line whose nearest points are on
    /// the desired leg it is that of a quadratic. Otherwise there are three Gauss points for every
    /// half radian of an arc or 5 s of a line.
    fn cost(&self, segment: &Segment) -> f64 {
        if segment.turn_rate == 0.0 {
            let a = self.off(segment.start.position, segment.start_time);
            let b = self.off(segment.end().position, segment.end_time());
            if a.2 && b.2 {
                let squared = |a: f64, b: f64| (a * a + a * b + b * b) / 3.0;
                return segment.duration * (squared(a.0, b.0) + self.kappa * squared(a.1, b.1));
            }
        }
        let turn = segment.turn_rate.abs() * segment.duration;
        let count = if turn > 0.0 {
            turn / 0.5
        } else {
            segment.duration / 5.0
        };
        let count = count.ceil().max(1.0);
        let half = segment.duration / count / 2.0;
        let node = 0.6_f64.sqrt();
        (0..count as usize)
            .map(|i| {
                let middle = half * (2 * i + 1) as f64;
                let outer = self.error(segment, middle - half * node)
                    + self.error(segment, middle + half * node);
                half * (5.0 * outer + 8.0 * self.error(segment, middle)) / 9.0
            })
            .sum()
    }

    /// The cost of a chain, or infinity as soon as it exceeds `limit`.
    fn cost_below(&self, chain: &[Segment], limit: f64) -> f64 {
        let mut total = 0.0;
        for segment in chain {
            total += self.cost(segment);
            if total >= limit {
                return f64::INFINITY;
            }
        }
        total
    }

    /// Membership at instants at most `CHECK` apart, both ends included. A stretch is halved until
    /// it is that short, or until the slack at its middle is more than can be lost within it.
    fn is_clear(&self, chain: &[Segment]) -> bool {
        chain
            .iter()
            .all(|s| self.stretch_is_clear(s, 0.0, s.duration))
    }

    fn stretch_is_clear(&self, segment: &Segment, from: f64, to: f64) -> bool {
        let slack = |elapsed: f64| {
            let position = segment.pose_after(elapsed).position;
            let time = segment.start_time + elapsed;
            let slacks = polytopes(self.problem).map(|o| o.slack(position, time).value);
            slacks.fold(f64::INFINITY, f64::min)
        };
        // touching is no contact
        let touch = -searoom::tolerance::DEPTH_M;
        let middle = (from + to) / 2.0;
        let clear = slack(middle);
        if clear > self.closing_speed * (to - from) / 2.0 {
            return true;
        }
        if to - from <= 2.0 * CHECK {
            return clear > touch && slack(from) > touch && slack(to) > touch;
        }
        clear > touch
            && self.stretch_is_clear(segment, from, middle)
            && self.stretch_is_clear(segment, middle, to)
    }

    /// Ways from a state to the last waypoint, in the leg's own frame. They go back to the path at
    /// an angle, recover the lag, and go on at the desired speed. Near the end they go straight to
    /// it.
    fn closings(&self, pose: &Pose, time: f64) -> Vec<Vec<Segment>> {
        let leg = &self.leg;
        let radius = self.problem.own.turning_radius;
        let offset = pose.position - leg.start;
        let (along, across) = (leg.direction.dot(&offset), cross(leg.direction, offset));
        let heading = wrap(pose.heading - heading_of(leg.direction));
        let mut closings = Vec::new();
        if across.abs() <= RETURN_FROM && heading.abs() < 1.6 {
            let late = leg.speed * time > along;
            let own = self.problem.own;
            let recovering = if late {
                own.max_speed()
            } else {
                own.min_speed()
            };
            for speed in [recovering, leg.speed] {
                for pieces in returns(across, heading, radius) {
                    let back = chain(pose, time, speed, radius, &pieces);
                    closings.extend(self.recovered(back, pose, time));
                }
            }
        }
        if leg.length - along <= HOMING {
            let end = leg.start + leg.direction * leg.length;
            for &speed in &self.problem.own.speeds {
                let ways = [1.0, -1.0].map(|turn| turn_then_straight(pose, end, turn, radius));
                for pieces in ways.into_iter().flatten() {
                    closings.push(chain(pose, time, speed, radius, &pieces));
                }
            }
        }
        let horizon = self.problem.horizon;
        closings.retain(|c| c.last().is_some_and(|s| s.end_time() <= horizon));
        closings
    }

    /// A return completed to the end: nothing when it overshoots the last waypoint.
    fn recovered(&self, mut back: Vec<Segment>, from: &Pose, time: f64) -> Option<Vec<Segment>> {
        let (leg, own) = (&self.leg, self.problem.own);
        let (mut pose, mut now) = back
            .last()
            .map_or((*from, time), |s| (s.end(), s.end_time()));
        let mut along = leg.direction.dot(&(pose.position - leg.start));
        if along > leg.length {
            return None;
        }
        let lag = leg.speed * now - along;
        let (speed, rate) = if lag > 0.0 {
            (own.max_speed(), own.max_speed() - leg.speed)
        } else {
            (own.min_speed(), leg.speed - own.min_speed())
        };
        let recover = if rate > 0.0 && speed > 0.0 {
            (lag.abs() / rate).min((leg.length - along) / speed)
        } else {
            0.0
        };
        for (speed, duration) in [(speed, Some(recover)), (leg.speed, None)] {
            let duration = duration.unwrap_or((leg.length - along) / speed);
            if duration > 1e-9 {
                let segment = Segment::straight(pose, now, duration, speed);
                (pose, now, along) = (segment.end(), segment.end_time(), along + speed * duration);
                back.push(segment);
            }
        }
        Some(back)
    }
}

/// Depth, cost, limits and ends of a trajectory, each by brute force. Between
/// the instants that the search tests it may cut a corner, by 10 cm at most.
///
/// # Panics
/// When one of them is wrong.
pub fn recheck(problem: &Problem, found: &Found) {
    let (own, desired) = (problem.own, problem.desired);
    let trajectory = &found.trajectory;
    assert!((trajectory.segments()[0].start.position - own.pose.position).norm() < 1e-9);
    assert!((trajectory.end().position - desired.end()).norm() < 1e-5);
    for s in trajectory.segments() {
        assert!(own.speeds.iter().any(|u| (u - s.speed).abs() < 1e-12));
        assert!(s.turn_rate.abs() <= s.speed / own.turning_radius + 1e-12);
    }
    let count = (trajectory.end_time() / 0.01) as usize;
    let mut integral = 0.0;
    for i in 0..count {
        let t = 0.01 * (i as f64 + 0.5);
        let position = trajectory.pose_at(t).position;
        for o in polytopes(problem) {
            assert!(o.slack(position, t).value > -0.1, "inside at {t}");
        }
        integral += 0.01 * desired.nearest(position, t, problem.time_weight).error;
    }
    let cost = integral / desired.duration();
    assert!(
        (cost - found.cost).abs() < 1e-3 * cost + 0.1,
        "{cost} {}",
        found.cost
    );
}

/// The obstacles: the dense search knows polytopes only.
fn polytopes<'a>(problem: &Problem<'a>) -> impl Iterator<Item = &'a PolytopeObstacle> {
    let obstacles = problem.obstacles.iter();
    obstacles.map(|o| o.as_polytope().expect("a polytope"))
}

fn trace(states: &[State], mut at: usize, closing: Vec<Segment>) -> Trajectory {
    let mut backwards: Vec<Segment> = closing.into_iter().rev().collect();
    while let Some((before, segment)) = states[at].before {
        backwards.push(segment);
        at = before;
    }
    backwards.reverse();
    Trajectory::new(backwards).expect("segments that were chained meet")
}
