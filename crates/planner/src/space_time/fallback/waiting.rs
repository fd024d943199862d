//! Motion that need not arrive: own ship slows or waits on its route, short of the sets.
//!
//! ```text
//! times x distances on the route ─► moves clear of sets and land ─► least cost at the horizon
//! ```
//!
//! Dynamic programming in the plane of path and time (Kant and Zucker, "Toward Efficient Trajectory
//! Planning: The Path-Velocity Decomposition", IJRR 1986), with own ship's speeds. Every move
//! passes the exact contact test.

use std::f64::consts::FRAC_1_SQRT_2;

use crate::clock::Clock;
use crate::space_time::land;
use crate::space_time::piece::pieces;
use crate::space_time::proxy::{Proxy, first_met, within_reach};
use crate::space_time::route::Route;
use crate::{NoPlan, Outcome, Plan, PlanMethod, Planned, Problem};
use searoom_geometry::frame::{Side, Vector, to_port};
use searoom_geometry::numerics::bisected;
use searoom_geometry::tolerance;
use searoom_model::trajectory::{DesiredTrajectory, Segment};

/// Moves from the start to the horizon. The second number is used where the first finds nothing.
pub(super) const MOVES: [u32; 2] = [80, 240];

/// Distances on the route of which one motion each is kept, per move at the greatest speed.
const CELLS_PER_MOVE: f64 = 2.0;

/// Largest number of speeds beside the desired one.
const MOST_SPEEDS: usize = 4;

/// Price of a change of speed, as a fraction of the cost of lying still until the horizon.
const CHANGE_PRICE: f64 = 0.01;

/// Offsets of the routes beside the desired path, in own beams. Starboard comes first: in a narrow
/// channel own ship keeps to that side (Rule 9(a)).
const OFFSETS_BEAMS: [f64; 6] = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0];

/// Bisection steps for the room beside the desired path: to about a quarter of a metre.
const ROOM_HALVINGS: usize = 8;

/// Length in turning radii over which a route beside the desired path returns to its end.
const RETURN_RADII: f64 = 4.0;

/// Places at which own ship slows down, per route.
const PLACES: u32 = 8;

/// The motion along the route that is clear of every set and of land until the horizon, or until
/// it arrives, at the least cost; else one along a route beside the desired path.
///
/// The motion keeps own ship's speeds and its turning radius. A motion that does not arrive lasts
/// until the horizon. Cost: O(moves² speeds) contact tests, some milliseconds.
pub(crate) fn waiting(problem: &Problem, clock: Clock) -> Planned {
    let pieces = pieces(problem.obstacles, problem.horizon);
    let proxies = within_reach(problem, &pieces);
    let on = |desired: &DesiredTrajectory, moves: &[u32]| {
        let way = Way::of(problem, desired, clock)?;
        let mut moves = moves.iter();
        moves.find_map(|moves| way.waiting(&proxies, *moves, 0.0, clock))
    };
    let found = on(&problem.desired.straightened(), &MOVES)
        .or_else(|| beside(problem, clock).find_map(|desired| on(&desired, &MOVES[..1])));
    let plan = found.and_then(|motion| unfinished(problem, motion, PlanMethod::Waiting));
    Planned::of(match plan {
        Some(plan) => Outcome::Solved(plan),
        None if clock.is_up() => Outcome::Deadline(None),
        None => Outcome::Infeasible(NoPlan::NoTrajectory),
    })
}

/// A plan of a motion by `method` that may end before the last waypoint.
pub(crate) fn unfinished(
    problem: &Problem,
    motion: Vec<Segment>,
    method: PlanMethod,
) -> Option<Plan> {
    let plan = Plan::measured(problem, motion, method)?;
    let end = plan.trajectory.end().position;
    let to_go = problem.desired.left_from(end, plan.trajectory.length());
    Some(Plan { to_go, ..plan })
}

/// The desired trajectory moved aside, nearest first, and back at its end. The last ones use all the
/// room that land leaves on a side.
pub(crate) fn beside<'a>(
    problem: &'a Problem,
    clock: Clock,
) -> impl Iterator<Item = DesiredTrajectory> + 'a {
    let beam = problem.own.hull.beam.max(tolerance::START_M);
    let sides = [Side::Starboard, Side::Port].map(Side::turn_sign);
    let offsets = OFFSETS_BEAMS.map(|beams| beams * beam);
    let farthest = offsets.into_iter().fold(0.0, f64::max);
    let near = offsets.into_iter();
    let near = near.flat_map(move |offset| sides.map(|side| side * offset));
    let rooms = sides.into_iter().filter_map(move |side| {
        let room = room(problem, side, farthest, clock)?;
        Some(side * room)
    });
    let offsets = near.chain(rooms);
    offsets.filter_map(move |offset| moved_aside(problem, offset))
}

/// Largest distance in metres by which the route may be moved to a side clear of land; `None` where
/// land leaves no room, or as much as the `farthest` offset. After the deadline it is not sought.
fn room(problem: &Problem, side: f64, farthest: f64, clock: Clock) -> Option<f64> {
    if problem.land_obstacle.is_empty() {
        return None;
    }
    let is_clear = |offset: f64| {
        let desired = moved_aside(problem, side * offset);
        let way = desired.and_then(|desired| Way::of(problem, &desired, clock));
        !clock.is_up() && way.is_some_and(|way| way.clear_to.is_infinite())
    };
    if is_clear(farthest) {
        return None;
    }
    let [room, _] = bisected([0.0, farthest], ROOM_HALVINGS, is_clear);
    (room > 0.0).then_some(room)
}

/// The desired trajectory on a parallel path `offset` metres to port.
fn moved_aside(problem: &Problem, offset: f64) -> Option<DesiredTrajectory> {
    let desired = problem.desired.straightened();
    let back = RETURN_RADII * problem.own.turning_radius;
    let parallel = desired.shortened(back)?;
    let legs = parallel.legs();
    let end = parallel.end();
    let corners = legs.iter().zip(legs.iter().skip(1));
    let corners = corners.map(|(before, after)| {
        let [a, b] = [before, after].map(|leg| to_port(leg.direction));
        let middle = (a + b).normalize();
        // the corner of the parallel lines; at a sharp turn, nearer
        let share = middle.dot(&a).max(FRAC_1_SQRT_2);
        after.start + middle * (offset / share)
    });
    let first = legs[0].start + to_port(legs[0].direction) * offset;
    let last = end + to_port(legs[legs.len() - 1].direction) * offset;
    let waypoints: Vec<Vector> = std::iter::once(first)
        .chain(corners)
        .chain([last, desired.end()])
        .collect();
    let speed = desired.legs()[desired.legs().len() - 1].speed;
    let speeds: Vec<f64> = legs.iter().map(|leg| leg.speed).chain([speed]).collect();
    DesiredTrajectory::new(&waypoints, &speeds).ok()
}

/// A route on which own ship chooses its speed.
pub(crate) struct Way<'a> {
    problem: &'a Problem<'a>,
    route: Route,
    /// Distance along the route up to which it is clear of land, metres.
    clear_to: f64,
}

/// Own ship on its way, after a number of moves.
#[derive(Clone, Copy)]
struct State {
    /// Index of the state before, of the start itself.
    parent: usize,
    /// Speed since then, m/s.
    speed: f64,
    /// Distance along the route, metres, and time, seconds.
    at: f64,
    time: f64,
    /// Cost so far, m².
    cost: f64,
}

impl<'a> Way<'a> {
    /// The route along a desired trajectory, in the problem of another.
    pub(crate) fn of(
        problem: &'a Problem,
        desired: &DesiredTrajectory,
        clock: Clock,
    ) -> Option<Self> {
        let along = Problem {
            desired,
            ..problem.clone()
        };
        let route = Route::new(&along, clock)?;
        let mut at_unit_speed = Vec::new();
        route.run(0.0, 0.0, route.length(), 1.0, &mut at_unit_speed);
        let land = land::first_contact(problem.land_obstacle, &at_unit_speed);
        Some(Self {
            problem,
            clear_to: land.map_or(f64::INFINITY, |at| at - tolerance::START_M),
            route,
        })
    }

    /// Appends a move at one speed from a distance and a time until another time, or to the end of
    /// the route; returns the distance reached.
    fn advance(&self, from: [f64; 2], until: f64, speed: f64, out: &mut Vec<Segment>) -> f64 {
        let [at, time] = from;
        if speed == 0.0 {
            let pose = self.route.pose_at(at).0;
            out.push(Segment::straight(pose, time, until - time, 0.0));
            return at;
        }
        self.route.run(at, time, speed * (until - time), speed, out)
    }

    fn is_end(&self, at: f64) -> bool {
        self.route.length() - at <= tolerance::LENGTH_M
    }

    /// Some of own ship's speeds, and the one nearest to the desired speed.
    fn speeds(&self) -> Vec<f64> {
        let desired = nearest_speed(self.problem);
        let some = self.problem.own.some_speeds(MOST_SPEEDS);
        let mut speeds: Vec<f64> = some.chain(desired).collect();
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        speeds
    }

    /// The motion in this many moves that is clear until the horizon, or until it arrives and the
    /// rest there until `stays`, seconds, is over, at the least cost. One that arrives comes first.
    pub(super) fn waiting(
        &self,
        proxies: &[Proxy],
        moves: u32,
        stays: f64,
        clock: Clock,
    ) -> Option<Vec<Segment>> {
        let (own, horizon) = (self.problem.own, self.problem.horizon);
        let duration = horizon / f64::from(moves);
        let cell = own.max_speed() * duration / CELLS_PER_MOVE;
        let speeds = self.speeds();
        let still = Segment::straight(own.pose, 0.0, horizon, 0.0);
        let change = CHANGE_PRICE * self.problem.error_of(&[still]);
        let mut states = vec![State {
            parent: 0,
            speed: own.speed,
            at: 0.0,
            time: 0.0,
            cost: 0.0,
        }];
        let mut layer = vec![0];
        let mut arrived: Option<State> = None;
        let mut part = Vec::new();
        for step in 1..=moves {
            if clock.is_up() {
                return None;
            }
            let until = horizon * f64::from(step) / f64::from(moves);
            let mut best: Vec<Option<State>> = Vec::new();
            for parent in layer {
                let from: State = states[parent];
                for speed in &speeds {
                    part.clear();
                    let at = self.advance([from.at, from.time], until, *speed, &mut part);
                    if at > self.clear_to || first_met(proxies, &part).is_some() {
                        continue;
                    }
                    let is_end = self.is_end(at);
                    if is_end && !self.may_rest(proxies, &part, stays) {
                        continue;
                    }
                    let error = match is_end {
                        true => self.problem.error_to_end(&part),
                        false => self.problem.error_of(&part),
                    };
                    let changes = f64::from(u8::from(*speed != from.speed));
                    let state = State {
                        parent,
                        speed: *speed,
                        at,
                        time: until,
                        cost: from.cost + error + changes * change,
                    };
                    let kept = match is_end {
                        true => &mut arrived,
                        false => {
                            let index = (at / cell) as usize;
                            if best.len() <= index {
                                best.resize(index + 1, None);
                            }
                            &mut best[index]
                        }
                    };
                    // negated on purpose: a NaN is no better
                    if kept.as_ref().is_none_or(|kept| state.cost < kept.cost) {
                        *kept = Some(state);
                    }
                }
            }
            let begun = states.len();
            states.extend(best.into_iter().flatten());
            layer = (begun..states.len()).collect();
        }
        let least = layer.into_iter().map(|index| states[index]);
        let last = arrived.or_else(|| least.min_by(|a, b| a.cost.total_cmp(&b.cost)))?;
        let motion = self.motion(&states, last);
        let meets = first_met(proxies, &motion).is_some()
            || land::meets(self.problem.land_obstacle, &motion);
        (!meets).then_some(motion)
    }

    /// True where own ship may lie at the end of a motion until `stays`, seconds.
    fn may_rest(&self, proxies: &[Proxy], motion: &[Segment], stays: f64) -> bool {
        motion.last().is_none_or(|last| {
            let left = (stays - last.end_time()).max(0.0);
            let rest = Segment::straight(last.end(), last.end_time(), left, 0.0);
            left == 0.0 || first_met(proxies, &[rest]).is_none()
        })
    }

    /// The motion to a state. Moves at one speed are joined.
    fn motion(&self, states: &[State], last: State) -> Vec<Segment> {
        let mut path = vec![last];
        let mut parent = last.parent;
        while parent > 0 {
            path.push(states[parent]);
            parent = states[parent].parent;
        }
        path.reverse();
        let (mut motion, mut from) = (Vec::new(), [0.0, 0.0]);
        for moves in path.chunk_by(|a, b| a.speed == b.speed) {
            let until = moves[moves.len() - 1].time;
            let at = self.advance(from, until, moves[0].speed, &mut motion);
            from = [at, until];
        }
        motion
    }

    /// Motions at one speed to a place of the route, the start first, then at own ship's least speed
    /// until the horizon. They may meet sets, but no land.
    pub(crate) fn slowing(&self) -> impl Iterator<Item = Vec<Segment>> {
        let (own, horizon) = (self.problem.own, self.problem.horizon);
        let slowest = own.min_speed();
        let speeds = self.speeds().into_iter().filter(move |u| *u > slowest);
        let places = speeds.flat_map(move |speed| {
            let farthest = self.route.length().min(speed * horizon);
            (1..PLACES).map(move |k| (speed, farthest * f64::from(k) / f64::from(PLACES)))
        });
        let all = std::iter::once((own.max_speed(), 0.0)).chain(places);
        all.filter_map(move |(speed, distance)| {
            let motion = self.slowed_after(distance, [speed, slowest]);
            (!land::meets(self.problem.land_obstacle, &motion)).then_some(motion)
        })
    }

    /// Motion at the first speed for a distance in metres, then at the second until the horizon.
    pub(crate) fn slowed_after(&self, distance: f64, [speed, then]: [f64; 2]) -> Vec<Segment> {
        let mut motion = Vec::new();
        let time = distance / speed;
        let at = self.advance([0.0, 0.0], time, speed, &mut motion);
        self.advance([at, time], self.problem.horizon, then, &mut motion);
        motion
    }
}

/// The moving speed nearest to the mean desired one.
pub(crate) fn nearest_speed(problem: &Problem) -> Option<f64> {
    let mean = problem.desired.length() / problem.desired.duration();
    let speeds = problem.own.moving_speeds();
    speeds.min_by(|a, b| (a - mean).abs().total_cmp(&(b - mean).abs()))
}
