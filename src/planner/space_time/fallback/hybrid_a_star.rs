//! Hybrid A*: finds motions far from the path that the graph and its refinement miss.
//!
//! The start is left at once and fast, or late. A motion primitive is a turn and a line of about
//! one grid cell. Primitives are expanded best first by cost plus [`CostToGoGrid`]. Each node also
//! gets a turn and a line straight to the end. A primitive is tested when it leaves the queue; most
//! never do.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashSet};

use crate::frame::{Pose, Side, Vector, heading_of, to_port, wrap};
use crate::planner::clock::Clock;
use crate::planner::cost::space_time_error;
use crate::planner::space_time::fallback::cost_to_go::CostToGoGrid;
use crate::planner::space_time::land;
use crate::planner::space_time::piece::pieces;
use crate::planner::space_time::proxy::{Proxy, first_met, within_reach};
use crate::planner::{Plan, Problem};
use crate::tolerance;
use crate::trajectory::Segment;

/// Turns of the motion primitives, radians.
const TURNS_RAD: [f64; 7] = [0.0, 0.25, -0.25, 0.6, -0.6, 1.4, -1.4];

/// Courses that are distinguished at one position and time.
const COURSES: f64 = 12.0;

/// Resolution of the search.
#[derive(Debug, Clone, Copy)]
struct Resolution {
    /// Length of a primitive in cells.
    way: f64,
    /// States that are distinguished per cell and time step.
    apart: f64,
    /// Largest number of expanded primitives: the bound on time and memory.
    most: usize,
}

/// Coarse first, then finer.
const RESOLUTIONS: [Resolution; 2] = [
    Resolution {
        way: 1.5,
        apart: 2.0,
        most: 3_000,
    },
    Resolution {
        way: 0.75,
        apart: 3.0,
        most: 10_000,
    },
];

/// Heuristic weight (weighted A*): slightly dearer plans for a fraction of the expansions.
const WEIGHT: f64 = 1.1;

/// Metres. A turn whose circle passes this near to a point has no tangent to it.
const CIRCLE_M: f64 = 1e-6;

/// Motion primitive: a turn and a line, or a wait.
#[derive(Debug, Clone, Copy)]
enum Primitive {
    /// `turn` in radians to port, `line` in metres.
    Turn { speed: f64, turn: f64, line: f64 },
    /// Seconds.
    Wait { duration: f64 },
}

impl Primitive {
    /// Segments of the primitive from a pose and time.
    fn motion(self, pose: &Pose, time: f64, radius: f64) -> Vec<Segment> {
        match self {
            Self::Turn { speed, turn, line } => {
                turn_and_line(pose, time, speed, radius, turn, line)
            }
            Self::Wait { duration } => vec![Segment {
                start: *pose,
                start_time: time,
                duration,
                speed: 0.0,
                turn_rate: 0.0,
            }],
        }
    }
}

/// Search node: a state or the end of the path, its parent, and the primitive between them.
#[derive(Debug)]
struct SearchNode {
    pose: Pose,
    time: f64,
    cost: f64,
    from: Option<(usize, Primitive)>,
    is_end: bool,
}

/// Queue entry: least estimate first; among equals the older one.
#[derive(Debug, PartialEq)]
struct QueueEntry {
    total: f64,
    index: usize,
}

impl Eq for QueueEntry {}

impl PartialOrd for QueueEntry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for QueueEntry {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_total = other.total.total_cmp(&self.total);
        by_total.then(other.index.cmp(&self.index))
    }
}

/// Plan that is clear of every set and of land, by a coarse search over position, course and time.
/// `None` where none was found within the budget. The plan is not refined: use it only where
/// nothing else is found. Ten to several hundred milliseconds.
pub(crate) fn hybrid_a_star(problem: &Problem) -> Option<Plan> {
    let clock = Clock::new(problem.deadline);
    let pieces = pieces(problem.obstacles, problem.horizon);
    let proxies = within_reach(problem, &pieces);
    let grid = CostToGoGrid::of(problem, &proxies, clock)?;
    RESOLUTIONS.into_iter().find_map(|resolution| {
        let mut search = HybridAStar {
            problem,
            proxies: &proxies,
            grid: &grid,
            resolution,
            reached: Vec::new(),
            open: BinaryHeap::new(),
            seen: HashSet::new(),
        };
        let end = search.run(clock)?;
        plan_to(&search, end)
    })
}

/// Plan that leads to a node.
fn plan_to(search: &HybridAStar, end: usize) -> Option<Plan> {
    let mut motion = Vec::new();
    let mut at = end;
    while let Some((before, _)) = search.reached[at].from {
        motion.extend(search.motion_to(at).into_iter().rev());
        at = before;
    }
    motion.reverse();
    Plan::measured(search.problem, motion, None)
}

struct HybridAStar<'a> {
    problem: &'a Problem<'a>,
    proxies: &'a [Proxy<'a>],
    grid: &'a CostToGoGrid,
    resolution: Resolution,
    reached: Vec<SearchNode>,
    open: BinaryHeap<QueueEntry>,
    seen: HashSet<[i64; 4]>,
}

impl HybridAStar<'_> {
    /// Index of the node at the end of the path.
    fn run(&mut self, clock: Clock) -> Option<usize> {
        self.reach(SearchNode {
            pose: self.problem.own.pose,
            time: 0.0,
            cost: 0.0,
            from: None,
            is_end: false,
        });
        for _ in 0..self.resolution.most {
            let index = loop {
                if clock.is_up() {
                    return None;
                }
                let index = self.open.pop()?.index;
                let state = &self.reached[index];
                let key = self.key(state);
                if !state.is_end && self.seen.contains(&key) || !self.admits(index) {
                    continue;
                }
                if state.is_end {
                    return Some(index);
                }
                self.seen.insert(key);
                break index;
            };
            self.expand(index);
        }
        None
    }

    fn key(&self, state: &SearchNode) -> [i64; 4] {
        let place = state.pose.position / self.grid.cell;
        let course = wrap(state.pose.heading) / std::f64::consts::TAU * COURSES;
        let time = state.time / self.grid.step;
        [place.x, place.y, course, time].map(|v| (self.resolution.apart * v).round() as i64)
    }

    fn expand(&mut self, index: usize) {
        let own = self.problem.own;
        let pose = self.reached[index].pose;
        let way = self.resolution.way * self.grid.cell;
        let end = self.problem.desired.end();
        for speed in own.speeds.iter().copied() {
            if speed == 0.0 {
                let duration = self.grid.step;
                self.add_successor(index, Primitive::Wait { duration }, false);
                continue;
            }
            for turn in TURNS_RAD {
                let line = (way - turn.abs() * own.turning_radius).max(0.0);
                self.add_successor(index, Primitive::Turn { speed, turn, line }, false);
            }
            for side in [Side::Starboard, Side::Port] {
                if let Some((turn, line)) = turn_to_point(&pose, own.turning_radius, side, end) {
                    self.add_successor(index, Primitive::Turn { speed, turn, line }, true);
                }
            }
        }
    }

    /// Segments of the primitive that leads to a node; empty at the root.
    fn motion_to(&self, index: usize) -> Vec<Segment> {
        self.reached[index]
            .from
            .map_or_else(Vec::new, |(before, primitive)| {
                let before = &self.reached[before];
                primitive.motion(&before.pose, before.time, self.problem.own.turning_radius)
            })
    }

    /// True where the primitive that leads to a node is clear.
    fn admits(&self, index: usize) -> bool {
        let motion = self.motion_to(index);
        first_met(self.proxies, &motion).is_none()
            && !land::meets(self.problem.land_obstacle, &motion)
    }

    /// Adds a successor where it is in time and can still reach the end.
    fn add_successor(&mut self, from: usize, primitive: Primitive, is_end: bool) {
        let problem = self.problem;
        let before = &self.reached[from];
        let motion = primitive.motion(&before.pose, before.time, problem.own.turning_radius);
        let Some(last) = motion.last() else {
            return;
        };
        let (pose, time) = (last.end(), last.end_time());
        // negated on purpose: a NaN is too late
        if !(time <= problem.horizon) {
            return;
        }
        if !is_end && !self.grid.from(pose.position, time).is_finite() {
            return;
        }
        let more = |s| space_time_error(problem.desired, s, problem.time_weight);
        let cost = before.cost + motion.iter().map(more).sum::<f64>();
        self.reach(SearchNode {
            pose,
            time,
            cost,
            from: Some((from, primitive)),
            is_end,
        });
    }

    fn reach(&mut self, state: SearchNode) {
        let to_go = if state.is_end {
            0.0
        } else {
            self.grid.from(state.pose.position, state.time)
        };
        self.open.push(QueueEntry {
            total: state.cost + WEIGHT * to_go,
            index: self.reached.len(),
        });
        self.reached.push(state);
    }
}

/// Arc of `turn` radians to port and a line.
fn turn_and_line(
    pose: &Pose,
    time: f64,
    speed: f64,
    radius: f64,
    turn: f64,
    line: f64,
) -> Vec<Segment> {
    let mut motion = Vec::with_capacity(2);
    let arc = Segment {
        start: *pose,
        start_time: time,
        duration: turn.abs() * radius / speed,
        speed,
        turn_rate: turn.signum() * speed / radius,
    };
    let (after, then) = if turn == 0.0 {
        (*pose, time)
    } else {
        motion.push(arc);
        (arc.end(), arc.end_time())
    };
    if line > tolerance::LENGTH_M {
        motion.push(Segment {
            start: after,
            start_time: then,
            duration: line / speed,
            speed,
            turn_rate: 0.0,
        });
    }
    motion
}

/// Turn to a side (radians to port) and line that end at a point; `None` for a point within the
/// circle.
fn turn_to_point(pose: &Pose, radius: f64, side: Side, point: Vector) -> Option<(f64, f64)> {
    let sign = side.turn_sign();
    let center = pose.position + to_port(pose.ahead()) * (sign * radius);
    let away = point - center;
    let far = away.norm();
    // negated on purpose: a NaN is within
    if !(far > radius + CIRCLE_M) {
        return None;
    }
    let line = (far * far - radius * radius).sqrt();
    // course of the tangent: the bearing of the point, turned by the angle the circle subtends
    let heading = heading_of(away) + sign * (radius / far).asin();
    let mut turn = sign * wrap(heading - pose.heading);
    if turn < -tolerance::JOINT_RAD {
        turn += std::f64::consts::TAU;
    }
    let turn = sign * turn.max(0.0);
    Some((turn, line))
}
