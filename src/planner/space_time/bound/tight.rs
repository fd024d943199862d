//! Tight lower bound of the cost to go for one straight leg: bounds by progress and by the
//! obstacles, interval by interval.
//!
//! # Why it never exceeds the true cost to go
//!
//! *Directions.* In a direction at an angle `theta` to the heading, the progress in `s` seconds is
//! at most 0 or `P(s)` metres ([`crate::planner::space_time::bound`]). `P` is convex, and
//! `u s - r (theta - sin theta)` after the turn. So own ship stays within a half-plane that moves
//! away by `max(0, P)`. The scheduled point, which moves steadily, is beyond it by a concave
//! function of time.
//!
//! *Between two instants* a concave function is at least the chord between its end values, and at
//! least the smaller of them. Two half-planes at right angles, toward the path and ahead, add their
//! squares. The greatest counts of those in the other, oblique directions.
//!
//! *Faces.* Outside an obstacle own ship is beyond one of its faces. Take a face that moves at
//! `h_V` and is `need > 0` metres away. Own ship is beyond it only when
//! `max(0, P(s)) - h_V s >= need`. The left side is convex and 0 at first. If it is below `need` at
//! a time after the turn, it was below at all earlier times. Faces that cannot be reached by the
//! end of an interval are left out. The depth behind a face is linear in time, and the minimum over
//! some faces is concave: again at least its chord.
//!
//! *Both.* Beyond a face and within the half-planes at once, the error is at least the shortest
//! vector with the depth along the face's normal and the distance along a half-plane's. It grows
//! with both, so the smaller values of the interval bound it. The bound takes the greatest over
//! half-planes, the least over faces, the greatest over obstacles.
//!
//! After the last contact, and after the turn, the ramps are integrated to their ends.

use std::f64::consts::{PI, TAU};

use crate::frame::{Pose, Vector, cross, heading_of, wrap};
use crate::planner::space_time::bound::half_plane::{
    DIRECTIONS, HalfPlaneBound, OBLIQUE, SideGeometry, fast_max, fast_min, squared_chord,
};
use crate::planner::space_time::bound::obstacle::{Face, ObstacleBound};
use crate::planner::space_time::bound::squared_ramp;
use crate::trajectory::DesiredLeg;

/// Least length of an interval in seconds, and greatest number of intervals.
const INTERVAL_S: f64 = 12.0;
const MOST_INTERVALS: f64 = 24.0;

/// Data of the bound that do not depend on the node.
#[derive(Debug)]
pub(crate) struct TightBound<'a> {
    leg: &'a DesiredLeg,
    /// Heading of the leg, radians.
    course: f64,
    /// `kappa` of the error's metric, and its root.
    kappa: f64,
    root: f64,
    /// m/s, positive.
    speed: f64,
    /// Metres.
    radius: f64,
    /// Geometry seen from starboard and from port of the leg.
    sides: [SideGeometry; 2],
}

/// Angles between the directions of progress and own ship's heading.
struct HeadingOffsets {
    angles: [f64; DIRECTIONS],
    cosines: [f64; DIRECTIONS],
    sines: [f64; DIRECTIONS],
    greatest: f64,
    radius: f64,
}

impl HeadingOffsets {
    /// `ahead` is the unit vector of `heading`.
    fn new(heading: f64, ahead: Vector, geometry: &SideGeometry, radius: f64) -> Self {
        let angles = geometry.headings.map(|h| between(heading, h));
        Self {
            angles,
            cosines: geometry.directions.map(|d| ahead.dot(&d)),
            sines: geometry.directions.map(|d| cross(ahead, d).abs()),
            greatest: angles.into_iter().fold(0.0, f64::max),
            radius,
        }
    }

    /// Largest progress in each direction after the given path length, metres.
    fn made_good(&self, length: f64) -> [f64; DIRECTIONS] {
        let (turned, r) = (length / self.radius, self.radius);
        if turned >= self.greatest {
            return std::array::from_fn(|k| {
                fast_max(length - r * (self.angles[k] - self.sines[k]), 0.0)
            });
        }
        let (sin, cos) = turned.sin_cos();
        std::array::from_fn(|k| {
            let progress = if self.angles[k] > turned {
                // sine of the angle left to turn
                let left = self.sines[k] * cos - self.cosines[k] * sin;
                r * (self.sines[k] - left)
            } else {
                length - r * (self.angles[k] - self.sines[k])
            };
            progress.max(0.0)
        })
    }
}

/// Angle between two headings, at most pi, radians.
fn between(a: f64, b: f64) -> f64 {
    let apart = (a - b).abs();
    if apart > PI { TAU - apart } else { apart }
}

impl<'a> TightBound<'a> {
    pub(crate) fn new(
        leg: &'a DesiredLeg,
        kappa: f64,
        speed: f64,
        radius: f64,
        obstacle_bound: &ObstacleBound,
    ) -> Self {
        let root = kappa.sqrt();
        Self {
            leg,
            course: heading_of(leg.direction),
            kappa,
            root,
            speed,
            radius,
            sides: [1.0, -1.0].map(|side| SideGeometry::new(side, root, obstacle_bound)),
        }
    }

    /// Lower bound of the integral of the squared error from a pose and time to the arrival, m² s.
    /// `arrival` is a lower bound of the seconds until the arrival.
    pub(crate) fn cost_to_go(
        &self,
        obstacle_bound: &ObstacleBound,
        pose: &Pose,
        time: f64,
        arrival: f64,
    ) -> f64 {
        let (leg, kappa, u) = (self.leg, self.kappa, self.speed);
        let offset = pose.position - leg.start;
        let across = cross(leg.direction, offset);
        let lag = leg.speed * (time - leg.start_time) - leg.direction.dot(&offset);
        // relative to own ship, the scheduled point is at `(lag + u_d tau, -across)` along and
        // across the leg
        let geometry = &self.sides[usize::from(across.is_sign_positive())];
        let heading = wrap(pose.heading - self.course);
        let ahead = pose.ahead();
        let (along, aside) = (leg.direction.dot(&ahead), cross(leg.direction, ahead));
        let offsets =
            HeadingOffsets::new(heading, Vector::new(along, aside), geometry, self.radius);
        let slope = if lag >= 0.0 {
            leg.speed - u
        } else {
            -leg.speed - u
        };
        // least distance of the scheduled point from the path, behind schedule, and beyond the
        // half-planes
        let apart = |tau: f64| {
            let made_good = offsets.made_good(u * tau);
            let late = if lag >= 0.0 {
                lag + leg.speed * tau - made_good[1]
            } else {
                -lag + slope * tau
            };
            let due = Vector::new(self.root * (lag + leg.speed * tau), -across);
            let beyond: [f64; OBLIQUE] = std::array::from_fn(|k| {
                let limit = &geometry.half_planes[k];
                limit.metric.dot(&due) - made_good[k + 2] / limit.scale
            });
            ((across.abs() - made_good[0], late), beyond)
        };
        let reach_times = self.reach_times(obstacle_bound, pose, ahead, time);
        let turned = offsets.angles[0].max(offsets.angles[1]) * self.radius / u;
        let until = arrival.min(turned.max(obstacle_bound.last_contact() - time));
        let interval = INTERVAL_S.max(until / MOST_INTERVALS);
        let (mut from, mut sum) = (0.0, 0.0);
        let (mut back, mut beyond) = apart(0.0);
        while from < until {
            let to = (from + interval).min(until);
            let next = apart(to);
            let mut least =
                squared_chord(back.0, next.0.0) + kappa * squared_chord(back.1, next.0.1);
            let mut half_planes = [0.0; OBLIQUE];
            for (k, limit) in half_planes.iter_mut().enumerate() {
                least = fast_max(least, squared_chord(beyond[k], next.1[k]));
                *limit = fast_min(beyond[k], next.1[k]);
            }
            let outside = HalfPlaneBound {
                obstacle_bound,
                geometry,
                reach_times: &reach_times,
                half_planes,
            };
            least = outside.least(least, time + from, time + to);
            let envelope = obstacle_bound.cost_between(time + from, time + to);
            sum += (least * (to - from)).max(envelope);
            from = to;
            (back, beyond) = next;
        }
        let rest = squared_ramp(back.0, -u, f64::INFINITY).cost
            + kappa * squared_ramp(back.1, slope, arrival - from).cost;
        sum + rest.max(obstacle_bound.cost_from(time + from))
    }

    /// Earliest time at which own ship can be beyond each face of each obstacle.
    fn reach_times(
        &self,
        obstacle_bound: &ObstacleBound,
        pose: &Pose,
        ahead: Vector,
        time: f64,
    ) -> Vec<f64> {
        let heading = wrap(pose.heading);
        obstacle_bound
            .obstacles()
            .iter()
            .flat_map(|b| &b.faces)
            .map(|face| {
                let need = -face.plane.slack(pose.position, time);
                let turn = || {
                    let sine = cross(ahead, face.plane.normal).abs();
                    (between(face.heading, heading), sine)
                };
                time + self.reach_time(face, need, turn)
            })
            .collect()
    }

    /// Seconds until own ship can have moved `need` metres along the face's normal; infinite when
    /// never. `turn` gives the angle to the normal and its sine.
    fn reach_time(&self, face: &Face, need: f64, turn: impl FnOnce() -> (f64, f64)) -> f64 {
        let faster = self.speed - face.plane.velocity_support;
        if need <= 0.0 {
            return 0.0;
        }
        if faster <= 0.0 {
            return f64::INFINITY;
        }
        let (angle, sine) = turn();
        let turned = (need + self.radius * (angle - sine)) / faster;
        if turned < self.radius * angle / self.speed {
            need / faster
        } else if face.plane.velocity_support < 0.0 {
            // or it waits for the face
            turned.min(-need / face.plane.velocity_support)
        } else {
            turned
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use crate::obstacle::LandObstacle;
    use crate::pipeline;
    use crate::planner::clock::Clock;
    use crate::planner::cost::space_time_error;
    use crate::planner::space_time::graph::Graph;
    use crate::planner::space_time::graph::node::State;
    use crate::planner::space_time::piece::pieces;
    use crate::planner::space_time::plan;
    use crate::planner::space_time::proxy::Proxy;
    use crate::planner::space_time::refinement::trial::Context;
    use crate::planner::space_time::route::Route;
    use crate::planner::{Problem, SearchKind};
    use crate::search::{Search, Space, Stop};
    use crate::simulation::{EncounterKind, Placement, random_encounter, random_traffic};
    use crate::target::{Motion, Representation, Target};

    /// A graph without its heuristic.
    struct Uninformed<'a, 'b>(&'b mut Graph<'a>);

    impl Space for Uninformed<'_, '_> {
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

    /// Compares the bounds at every joint of every path that Dijkstra finds, and of the refined
    /// plan, with the cost that follows. Returns the largest ratio of the tight bound.
    fn tightest_ratio(problem: &Problem) -> f64 {
        let route = Route::new(problem, Clock::new(problem.deadline)).expect("a route");
        let nominal_motion = route.follow(0.0, 0.0);
        let pieces = pieces(problem.obstacles, problem.horizon);
        let proxies: Vec<Proxy> = pieces.iter().map(Proxy::new).collect();
        let context = Context::new(problem, &route, &proxies, &[]);
        let mut graph = Graph::new(&context, &nominal_motion, Clock::new(Duration::MAX));
        let mut search = Search::new(graph.root());
        let mut joints: Vec<(State, f64)> = Vec::new();
        let mut cheapest = None;
        for _ in 0..20 {
            let Stop::Goal(goal) = search.next_goal(&mut Uninformed(&mut graph), 1500) else {
                break;
            };
            let path = search.way_to(goal);
            let nodes = path.iter().map(|i| &search.nodes()[*i]);
            let cost = search.nodes()[goal].cost;
            cheapest.get_or_insert(cost);
            joints.extend(nodes.map(|n| (n.state.clone(), cost - n.cost)));
        }
        // with its heuristic the graph has the same best plan, also among several targets
        if let Some(cheapest) = cheapest {
            let mut search = Search::new(graph.root());
            let Stop::Goal(goal) = search.next_goal(&mut graph, 1500) else {
                panic!("Dijkstra finds one of {cheapest}");
            };
            let cost = search.nodes()[goal].cost;
            assert!((cost - cheapest).abs() <= 1e-9 * cheapest, "{cost}");
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
        let mut tightest_ratio = 0.0_f64;
        for (state, to_go) in joints {
            let (bound, tight_bound) = (graph.bound(&state), graph.tight_bound(&state));
            let limit = to_go * (1.0 + 1e-9) + 1e-6;
            assert!(bound <= limit, "{bound} > {to_go} at {state:?}");
            assert!(
                tight_bound <= limit,
                "closer: {tight_bound} > {to_go} at {state:?}"
            );
            if to_go > 100.0 {
                tightest_ratio = tightest_ratio.max(tight_bound / to_go);
            }
        }
        tightest_ratio
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
    fn no_path_costs_less_than_its_bounds() {
        let encounters = EncounterKind::ALL.into_iter().flat_map(|kind| {
            (0..12).map(move |guess| random_encounter(kind, guess, Placement::Random))
        });
        let traffic = [2, 4].into_iter().flat_map(|count| {
            (0..8).map(move |guess| random_traffic(count, guess, Placement::Random))
        });
        let mut greatest = 0.0_f64;
        for drawn in encounters.chain(traffic) {
            let mut scenario = drawn.expect("drawn").scenario;
            for change in [|_: &mut Target| {}, ellipsoid, turning] {
                scenario.targets.iter_mut().for_each(change);
                let obstacles: Vec<_> = pipeline::sets(&scenario)
                    .into_iter()
                    .map(|s| s.with_domain)
                    .collect();
                greatest = greatest.max(tightest_ratio(&Problem {
                    search: SearchKind::AStar,
                    deadline: Duration::from_secs(60),
                    ..pipeline::problem(&scenario, &obstacles, LandObstacle::none())
                }));
            }
        }
        assert!(greatest > 0.8, "the bound is idle: {greatest}");
    }
}
