//! Hybrid A*: finds motions far from the path that the graph and its refinement miss.
//!
//! The start is left at once and fast, or late. A motion primitive is a turn and a line of about
//! one grid cell. Primitives are expanded best first by cost plus [`CostToGoGrid`]. Each node also
//! gets a turn and a line straight to the end. A primitive is tested when it leaves the queue; most
//! never do.

use std::collections::HashSet;

use crate::clock::Clock;
use crate::search::{Search, Space, Stop};
use crate::space_time::grid::cost_to_go::CostToGoGrid;
use crate::space_time::land;
use crate::space_time::manoeuvre::chain::Chain;
use crate::space_time::manoeuvre::interceptor::Interceptor;
use crate::space_time::piece::pieces;
use crate::space_time::proxy::{Proxy, first_met, within_reach};
use crate::{Outcome, Plan, PlanMethod, Planned, Problem, SearchStats};
use searoom_geometry::frame::{Pose, Side, wrap};
use searoom_model::trajectory::Segment;

/// Resolution of the search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Resolution {
    /// Length of a primitive in cells.
    way: f64,
    /// States that are distinguished per cell and time step.
    apart: f64,
    /// Largest number of expanded primitives: the bound on time and memory.
    most: usize,
}

/// Resolution of the first search.
pub(crate) const COARSE: Resolution = Resolution {
    way: 1.5,
    apart: 2.0,
    most: 3_000,
};

/// Resolution where the first search finds nothing.
const FINE: Resolution = Resolution {
    way: 0.75,
    apart: 3.0,
    most: 10_000,
};

/// Motion primitive: a turn and a line, or a wait.
#[derive(Debug, Clone, Copy)]
enum Primitive {
    /// `turn` in radians to port, `line` in metres.
    Turn { speed: f64, turn: f64, line: f64 },
    /// Seconds.
    Wait { duration: f64 },
}

/// State after a primitive, with the pose and time before it.
#[derive(Debug, Clone, Copy)]
struct State {
    before: (Pose, f64),
    primitive: Option<Primitive>,
    pose: Pose,
    time: f64,
    /// From the start, m².
    cost: f64,
    is_end: bool,
}

impl State {
    /// Segments of the primitive; empty at the root.
    fn motion(&self, radius: f64) -> Vec<Segment> {
        let (pose, time) = self.before;
        match self.primitive {
            Some(Primitive::Turn { speed, turn, line }) => {
                let mut chain = Chain::new(pose, time, speed, radius);
                chain.arc(turn * radius);
                chain.line(line);
                chain.segments
            }
            Some(Primitive::Wait { duration }) => {
                vec![Segment::straight(pose, time, duration, 0.0)]
            }
            None => Vec::new(),
        }
    }
}

/// Plan that is clear of every set and of land, by a coarse search over position, course and time.
/// `None` where none was found within the budget. The plan is not refined. Ten to several hundred
/// milliseconds.
pub(crate) fn hybrid_a_star(problem: &Problem, clock: Clock) -> Option<Planned> {
    let pieces = pieces(problem.obstacles, problem.horizon);
    let proxies = within_reach(problem, &pieces);
    let grid = CostToGoGrid::of(problem, &proxies, 0.0, clock)?;
    let found = [COARSE, FINE].into_iter().find_map(|resolution| {
        let limit = f64::INFINITY;
        searched(problem, &proxies, &grid, (resolution, limit), clock)
    });
    let (motion, stats) = found?;
    let plan = Plan::measured(problem, motion, PlanMethod::HybridAStar)?;
    Some(Planned {
        stats: Some(stats),
        ..Planned::of(Outcome::Solved(plan))
    })
}

/// Motion to the end, clear of every set and of land, that costs at most `limit`, m², and the
/// statistics of the search. The limit
/// bounds the search: what costs more with its cost to go by the grid is not followed.
pub(crate) fn searched(
    problem: &Problem,
    proxies: &[Proxy],
    grid: &CostToGoGrid,
    (resolution, limit): (Resolution, f64),
    clock: Clock,
) -> Option<(Vec<Segment>, SearchStats)> {
    let mut lattice = Lattice {
        problem,
        proxies,
        grid,
        resolution,
        limit,
        seen: HashSet::new(),
        clock,
    };
    let pose = problem.own.pose;
    let mut search = Search::new(State {
        before: (pose, 0.0),
        primitive: None,
        pose,
        time: 0.0,
        cost: 0.0,
        is_end: false,
    });
    search.weigh(problem.settings.grid.weight);
    let Stop::Goal(end) = search.next_goal(&mut lattice, resolution.most) else {
        return None;
    };
    let states = search.way_to(end).into_iter();
    let states = states.map(|index| search.nodes()[index].state);
    let motion = states.flat_map(|state| state.motion(problem.own.turning_radius));
    Some((motion.collect(), search.counts()))
}

/// Graph of motion primitives.
struct Lattice<'a> {
    problem: &'a Problem<'a>,
    proxies: &'a [Proxy<'a>],
    grid: &'a CostToGoGrid,
    resolution: Resolution,
    /// Greatest cost so far plus cost to go, m².
    limit: f64,
    seen: HashSet<[i64; 4]>,
    clock: Clock,
}

impl Lattice<'_> {
    fn key(&self, state: &State) -> [i64; 4] {
        let place = state.pose.position / self.grid.cell;
        let course =
            wrap(state.pose.heading) / std::f64::consts::TAU * self.problem.settings.grid.courses;
        let time = state.time / self.grid.step;
        [place.x, place.y, course, time].map(|v| (self.resolution.apart * v).round() as i64)
    }

    /// State after a primitive, with its cost; `None` where it is seen, too late or too expensive.
    fn after(&self, from: &State, primitive: Primitive, is_end: bool) -> Option<(State, f64)> {
        let problem = self.problem;
        let mut state = State {
            before: (from.pose, from.time),
            primitive: Some(primitive),
            is_end,
            ..*from
        };
        let motion = state.motion(problem.own.turning_radius);
        let last = motion.last()?;
        (state.pose, state.time) = (last.end(), last.end_time());
        // the cost integral dominates, so the cheap tests come first
        let to_go = match is_end {
            true => 0.0,
            false => self.grid.from(state.pose.position, state.time),
        };
        let in_time = state.time <= problem.horizon;
        let seen = !is_end && self.seen.contains(&self.key(&state));
        // negated on purpose: a NaN is too expensive
        if !(in_time && !seen && from.cost + to_go <= self.limit) {
            return None;
        }
        let cost = match is_end {
            true => problem.error_to_end(&motion),
            false => problem.error_of(&motion),
        };
        state.cost = from.cost + cost;
        (state.cost + to_go <= self.limit).then_some((state, cost))
    }
}

impl Space for Lattice<'_> {
    type State = State;

    fn successors(&mut self, from: &State, out: &mut Vec<(State, f64)>) {
        let (own, settings) = (self.problem.own, &self.problem.settings.grid);
        let radius = own.turning_radius;
        let way = self.resolution.way * self.grid.cell;
        let end = self.problem.desired.end();
        for speed in own.some_speeds(settings.most_speeds) {
            if speed == 0.0 {
                let duration = self.grid.step;
                out.extend(self.after(from, Primitive::Wait { duration }, false));
                continue;
            }
            for turn in settings.turns {
                let line = (way - turn.abs() * radius).max(0.0);
                out.extend(self.after(from, Primitive::Turn { speed, turn, line }, false));
            }
            for side in [Side::Starboard, Side::Port] {
                let interceptor = Interceptor::new(&from.pose, from.time, speed, radius, side);
                if let Some((turn, line)) = interceptor.path_to(end) {
                    let turn = side.turn_sign() * turn;
                    out.extend(self.after(from, Primitive::Turn { speed, turn, line }, true));
                }
            }
        }
    }

    fn bound(&mut self, state: &State) -> f64 {
        match state.is_end {
            true => 0.0,
            false => self.grid.from(state.pose.position, state.time),
        }
    }

    fn is_goal(&self, state: &State) -> bool {
        state.is_end
    }

    fn admits(&mut self, state: &State) -> bool {
        let key = self.key(state);
        if !state.is_end && self.seen.contains(&key) {
            return false;
        }
        let motion = state.motion(self.problem.own.turning_radius);
        let clear = first_met(self.proxies, &motion).is_none()
            && !land::meets(self.problem.land_obstacle, &motion);
        if clear && !state.is_end {
            self.seen.insert(key);
        }
        clear
    }

    fn is_out_of_time(&self) -> bool {
        self.clock.is_up()
    }
}
