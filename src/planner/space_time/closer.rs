//! The closer bound of the cost to go, for one straight leg: what the way back and the obstacles ask for,
//! interval by interval.
//!
//! # Why it never exceeds the true cost to go
//!
//! *Ways.* In a direction at an angle `theta` to the heading own ship makes good at most 0 or `P(s)` metres in
//! `s` seconds ([`super::heuristic`]): `P` is convex, and `u s - r (theta - sin theta)` once she has turned. So
//! she is nowhere beyond a half-plane that moves away by `max(0, P)`, and the point on schedule, which moves
//! steadily, is beyond it by a concave function of time.
//!
//! *Between two instants* a concave function is at least the chord between its values there, and at least
//! the lesser of them. Two half-planes at right angles, toward the path and ahead, add their squares; of
//! those in other directions, [`ASLANT`], the greatest counts.
//!
//! *Faces.* Outside a body she is beyond one of its faces. One from whose outer side she is `need > 0` metres
//! away, itself moving at `h_V`, she is beyond only when `max(0, P(s)) - h_V s >= need`; the left side is
//! convex and 0 at first, so what it is below at a time after the turn it was below before. Faces that
//! nobody can be beyond by the end of an interval are left out. The depth behind a face is linear in time and
//! the least over some faces concave: again at least its chord.
//!
//! *Both.* Beyond a face and within the half-planes at once, her error is at least the least vector that
//! has the depth along the face's normal and the distance beyond along a half-plane's; it grows with
//! both, so the lesser values of the interval bound it. Of the half-planes the greatest counts, of the faces
//! the least, of the bodies the greatest.
//!
//! After the last contact, and once she has turned, the ramps are integrated to their ends.

use super::heuristic::squared_ramp;
use super::keep_out::{Face, KeepOut};
use crate::frame::{Pose, Vector, cross, heading_of, wrap};
use crate::trajectory::DesiredLeg;

/// Seconds of an interval.
const INTERVAL_S: f64 = 12.0;

/// Radians from straight to the path toward straight ahead.
const ASLANT: [f64; 6] = [-1.0, -0.4, 0.2, 0.7, 1.1, 1.57];

/// What the bound depends on beside the node.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Closer<'a> {
    pub leg: &'a DesiredLeg,
    /// `kappa` of the error's metric.
    pub kappa: f64,
    /// m/s, positive.
    pub speed: f64,
    /// Metres.
    pub radius: f64,
    pub keep_out: &'a KeepOut,
}

/// A direction in which own ship makes way at last.
#[derive(Debug, Clone, Copy)]
struct Way {
    angle: f64,
    sine: f64,
}

impl Way {
    fn new(angle: f64) -> Self {
        Self {
            angle,
            sine: angle.sin(),
        }
    }

    /// Metres made good at most after so many metres sailed.
    fn made_good(self, sailed: f64, radius: f64) -> f64 {
        let left = self.angle - sailed / radius;
        let way = if left > 0.0 {
            radius * (self.sine - left.sin())
        } else {
            sailed - radius * (self.angle - self.sine)
        };
        way.max(0.0)
    }
}

/// A half-plane that own ship cannot be beyond: its outer normal in the error's metric.
#[derive(Debug, Clone, Copy)]
struct Limit {
    metric: Vector,
    scale: f64,
    way: Way,
}

impl Closer<'_> {
    /// Least integral of the squared error from a pose at a time to the arrival, which is at least
    /// `arrival` seconds away; m² s.
    pub(crate) fn cost_to_go(&self, pose: &Pose, time: f64, arrival: f64) -> f64 {
        let (leg, kappa, u, r) = (self.leg, self.kappa, self.speed, self.radius);
        let offset = pose.position - leg.start;
        let across = cross(leg.direction, offset);
        let lag = leg.speed * (time - leg.start_time) - leg.direction.dot(&offset);
        let heading = wrap(pose.heading - heading_of(leg.direction));
        // from here the point on schedule is at `(lag + u_d tau, -across)`, along and across the leg
        let side = -across.signum();
        let root = kappa.sqrt();
        let limits = ASLANT.map(|slant| {
            let normal = Vector::new(slant.sin(), side * slant.cos());
            let metric = Vector::new(normal.x / root, normal.y);
            let scale = metric.norm();
            Limit {
                metric: metric / scale,
                scale,
                way: Way::new(wrap(heading - heading_of(normal)).abs()),
            }
        });
        let beyond = |tau: f64| {
            let due = Vector::new(root * (lag + leg.speed * tau), -across);
            limits.map(|l| l.metric.dot(&due) - l.way.made_good(u * tau, r) / l.scale)
        };
        let aside = Way::new((side * heading.sin()).clamp(-1.0, 1.0).acos());
        let ahead = Way::new(heading.abs());
        let slope = if lag >= 0.0 {
            leg.speed - u
        } else {
            -leg.speed - u
        };
        let back = |tau: f64| {
            let late = if lag >= 0.0 {
                lag + leg.speed * tau - ahead.made_good(u * tau, r)
            } else {
                -lag + slope * tau
            };
            (across.abs() - aside.made_good(u * tau, r), late)
        };
        let reached = self.reached(pose, time);
        let turned = aside.angle.max(ahead.angle) * r / u;
        let until = arrival.min(turned.max(self.keep_out.last_contact() - time));
        let (mut from, mut sum) = (0.0, 0.0);
        let (mut here, mut apart) = (back(0.0), beyond(0.0));
        while from < until {
            let to = (from + INTERVAL_S).min(until);
            let (next, beyond) = (back(to), beyond(to));
            let mut least = squared_chord(here.0, next.0) + kappa * squared_chord(here.1, next.1);
            let mut lesser = limits.map(|l| (l.metric, 0.0));
            for (k, lesser) in lesser.iter_mut().enumerate() {
                least = least.max(squared_chord(apart[k], beyond[k]));
                lesser.1 = apart[k].min(beyond[k]);
            }
            least = least.max(self.outside(&reached, time + from, time + to, &lesser));
            let envelope = self.keep_out.cost_between(time + from, time + to);
            sum += (least * (to - from)).max(envelope);
            (from, here, apart) = (to, next, beyond);
        }
        let rest = squared_ramp(here.0, -u, f64::INFINITY).cost
            + kappa * squared_ramp(here.1, slope, arrival - from).cost;
        sum + rest.max(self.keep_out.cost_from(time + from))
    }

    /// The earliest time at which own ship can be beyond each face of each body.
    fn reached(&self, pose: &Pose, time: f64) -> Vec<f64> {
        self.keep_out
            .bodies()
            .iter()
            .flat_map(|b| &b.faces)
            .map(|face| time + self.reached_after(face, pose, time))
            .collect()
    }

    /// Seconds; infinite when never.
    fn reached_after(&self, face: &Face, pose: &Pose, time: f64) -> f64 {
        let need = -face.plane.slack(pose.position, time);
        let faster = self.speed - face.plane.velocity_support;
        if need <= 0.0 {
            return 0.0;
        }
        if faster <= 0.0 {
            return f64::INFINITY;
        }
        let angle = wrap(face.heading - pose.heading).abs();
        let turned = (need + self.radius * (angle - angle.sin())) / faster;
        if turned < self.radius * angle / self.speed {
            need / faster
        } else if face.plane.velocity_support < 0.0 {
            // or she waits for it
            turned.min(-need / face.plane.velocity_support)
        } else {
            turned
        }
    }

    /// Least mean squared error between two times outside every body and within the limits.
    fn outside(&self, reached: &[f64], from: f64, to: f64, limits: &[(Vector, f64)]) -> f64 {
        let mut rest = reached;
        let mut greatest = 0.0_f64;
        for body in self.keep_out.bodies() {
            let (reached, others) = rest.split_at(body.faces.len());
            rest = others;
            if to < body.from || from > body.to {
                continue;
            }
            let (mut a, mut b) = (f64::INFINITY, f64::INFINITY);
            let mut joint = f64::INFINITY;
            for (face, reached) in body.faces.iter().zip(reached) {
                if *reached > to {
                    continue;
                }
                let (start, end) = (face.depth_at(from), face.depth_at(to));
                (a, b) = (a.min(start), b.min(end));
                let depth = start.min(end).max(0.0);
                if depth < joint {
                    let both = limits
                        .iter()
                        .map(|(m, beyond)| outside_both(depth, *beyond, -m.dot(&face.metric)))
                        .fold(depth, f64::max);
                    joint = joint.min(both);
                }
            }
            greatest = greatest.max(squared_chord(a, b)).max(joint * joint);
        }
        greatest
    }
}

/// Least length of a vector with at least these components along two unit vectors with this product.
fn outside_both(a: f64, b: f64, cosine: f64) -> f64 {
    let sine = 1.0 - cosine * cosine;
    if a <= 0.0 || sine < 1e-9 {
        return a.max(b).max(0.0);
    }
    if b <= cosine * a {
        a
    } else if b > 0.0 && a <= cosine * b {
        b
    } else {
        ((a * a + b * b - 2.0 * cosine * a * b) / sine).sqrt()
    }
}

/// Mean of the squared positive part along a line from `a` to `b`.
fn squared_chord(a: f64, b: f64) -> f64 {
    let (low, high) = (a.min(b), a.max(b));
    if high <= 0.0 {
        0.0
    } else if low >= 0.0 {
        (a * a + a * b + b * b) / 3.0
    } else {
        high * high * high / (3.0 * (high - low))
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::pipeline;
    use crate::planner::cost::space_time_error;
    use crate::planner::space_time::graph::Graph;
    use crate::planner::space_time::hazard::Hazard;
    use crate::planner::space_time::node::State;
    use crate::planner::space_time::part::parts;
    use crate::planner::space_time::plan;
    use crate::planner::space_time::route::Route;
    use crate::planner::{Problem, SearchKind};
    use crate::search::{Search, Space, Stop};
    use crate::simulation::{EncounterKind, Placement, random_encounter, random_traffic};
    use crate::target::{Motion, Representation, Target};

    /// The same graph without its bound.
    struct Blind<'a, 'b>(&'b mut Graph<'a>);

    impl Space for Blind<'_, '_> {
        type State = State;
        fn successors(&mut self, state: &State, out: &mut Vec<(State, f64)>) {
            self.0.successors(state, out);
        }
        fn bound(&mut self, _: &State) -> f64 {
            0.0
        }
        fn is_goal(&self, state: &State) -> bool {
            self.0.is_goal(state)
        }
        fn admits(&mut self, state: &State) -> bool {
            self.0.admits(state)
        }
    }

    /// On every way that Dijkstra finds, and on the plan that is refined, at every joint: the bounds against
    /// the cost that follows. How near the closer one comes.
    fn nearest(problem: &Problem) -> f64 {
        let route = Route::new(problem).expect("a route");
        let mut undisturbed = Vec::new();
        route.follow(0.0, 0.0, &mut undisturbed);
        let parts = parts(problem.obstacles, problem.horizon);
        let hazards: Vec<Hazard> = parts.iter().map(Hazard::new).collect();
        let mut graph = Graph::new(problem, &hazards, &route, &undisturbed);
        let mut search = Search::new(graph.root());
        let mut joints: Vec<(State, f64)> = Vec::new();
        for _ in 0..20 {
            let Stop::Goal(goal) = search.next_goal(&mut Blind(&mut graph), 1500) else {
                break;
            };
            let way = search.way_to(goal);
            let nodes = way.iter().map(|i| &search.nodes()[*i]);
            let cost = search.nodes()[goal].cost;
            joints.extend(nodes.map(|n| (n.state.clone(), cost - n.cost)));
        }
        if let Some(plan) = plan(problem).outcome.plan() {
            let mut to_go = 0.0;
            for s in plan.trajectory.segments().iter().rev() {
                to_go += space_time_error(problem.desired, s, problem.time_weight);
                let mut state = State::start(s.start);
                state.time = s.start_time;
                joints.push((state, to_go));
            }
        }
        let mut nearest = 0.0_f64;
        for (state, to_go) in joints {
            let (bound, closer) = (graph.bound(&state), graph.closer_bound(&state));
            let limit = to_go * (1.0 + 1e-9) + 1e-6;
            assert!(bound <= limit, "{bound} > {to_go} at {state:?}");
            assert!(closer <= limit, "closer: {closer} > {to_go} at {state:?}");
            if to_go > 100.0 {
                nearest = nearest.max(closer / to_go);
            }
        }
        nearest
    }

    fn ellipsoid(target: &mut Target) {
        target.representation = Representation::Ellipsoid;
    }

    fn turning(target: &mut Target) {
        target.representation = Representation::Polytope;
        if let Motion::Ship(ship) = &mut target.motion {
            ship.turn_rate = 7e-4;
        }
    }

    #[test]
    fn no_way_costs_less_than_its_bounds() {
        let encounters = EncounterKind::ALL.into_iter().flat_map(|kind| {
            (0..12).map(move |seed| random_encounter(kind, seed, Placement::Random))
        });
        let traffic = [2, 4].into_iter().flat_map(|count| {
            (0..8).map(move |seed| random_traffic(count, seed, Placement::Random))
        });
        let mut greatest = 0.0_f64;
        for drawn in encounters.chain(traffic) {
            let mut scenario = drawn.expect("drawn").scenario;
            for change in [|_: &mut Target| {}, ellipsoid, turning] {
                scenario.targets.iter_mut().for_each(change);
                let obstacles: Vec<_> = pipeline::sets(&scenario)
                    .into_iter()
                    .map(|s| s.shaped)
                    .collect();
                greatest = greatest.max(nearest(&Problem {
                    own: &scenario.own_ship,
                    desired: &scenario.desired,
                    obstacles: &obstacles,
                    horizon: scenario.horizon,
                    time_weight: scenario.time_weight,
                    search: SearchKind::AStar,
                    deadline: Duration::from_secs(60),
                }));
            }
        }
        assert!(greatest > 0.8, "the bound is idle: {greatest}");
    }

    #[test]
    fn outside_both_is_the_least_of_a_dense_scan() {
        for (a, b, angle) in [
            (1.0, 0.5, 0.3_f64),
            (1.0, 0.9, 2.0),
            (0.7, -0.3, 1.9),
            (0.2, 1.0, 1.2),
            (-1.0, 0.4, 0.9),
        ] {
            let mut least = f64::INFINITY;
            for i in -400..=400 {
                for k in -400..=400 {
                    let v = Vector::new(f64::from(i), f64::from(k)) * 0.01;
                    let second = v.x * angle.cos() + v.y * angle.sin();
                    if v.x >= a && second >= b {
                        least = least.min(v.norm());
                    }
                }
            }
            let found = outside_both(a, b, angle.cos());
            assert!(
                (found - least).abs() < 0.02,
                "{a} {b} {angle}: {found} {least}"
            );
        }
    }
}
