//! Path-time planner: own ship follows given paths and chooses its speed, paper section III.B.
//!
//! ```text
//! path legs ─► obstacles along each leg ─► graph over their corners (A*) ─► taut profile ─► plan
//! ```
//!
//! A motion is a curve in distance and time with `0 <= speed <= max`. An obstacle is a convex
//! polygon on each leg. The least time is exact for these polygons;
//! docs/reference/path-time-planner.md contains the proof.

mod diagram;
mod due;
mod graph;
mod harm;
mod measure;
mod nodes;
mod profile;
mod rays;
mod recovery;
mod scene;
mod weighing;

pub use diagram::{DiagramCorner, DiagramLeg, DiagramObstacle, PathTimeDiagram};
pub use harm::least_harm;
pub use weighing::plan_weighing_risk;

use petgraph::graph::NodeIndex;

use super::clock::Clock;
use super::{
    EdgeVerdict, ExploredEdge, ExploredGraph, ExploredNode, Minimises, NoPlan, NodeKind,
    NominalTarget, Objective, Outcome, Plan, PlanMethod, PlanRequest, Planned, Planner,
    PlannerFacts, PlannerKind, Problem, SearchKind,
};
use crate::search::{Counts, Fate, Search, Stop};
use graph::{Graph, State};
use measure::Measure;
use nodes::{Known, Mark, Node, Place};
use profile::Profile;
use scene::{Aim, Scene};
use searoom_geometry::frame::{Pose, heading_of};
use searoom_geometry::tolerance::{self, TOUCH_M};
use searoom_model::trajectory::{PathNetwork, Segment};
use searoom_sets::{PathTime, SpaceTimeObstacle};

/// Expansions between two checks of the search budget.
const SLICE: usize = 50;

/// Minimum number of explored nodes reported, even after the deadline.
const FEW: usize = 100;

/// Expansions after which the time-optimal search starts, and lines after which the search stops.
const HARD: usize = 2_000;
const MOST_LINES: usize = 500_000;

/// Follows given paths and chooses the speed.
pub struct PathTimePlanner;

impl Planner for PathTimePlanner {
    fn facts(&self) -> &'static PlannerFacts {
        &PlannerFacts {
            name: const { PlannerKind::PathTime.word() },
            label: "path-time",
            minimises: Minimises::Objective,
            follows_paths: true,
            keeps_off_land: true,
            keeps_rules: false,
            uses_ellipses: false,
            relaxes_domains_only: false,
            has_no_return: false,
            searches: &[SearchKind::AStar],
        }
    }

    fn plan(&self, request: &PlanRequest) -> Planned {
        let problem = &request.problem;
        match problem.objective {
            _ if request.may_wait => planned(problem, Aim::Last, request.max_risk),
            Objective::LengthRisk { weight } => {
                let whole = Problem {
                    obstacles: request.whole,
                    ..problem.clone()
                };
                plan_weighing_risk(&whole, weight, request.max_risk)
            }
            _ => plan(problem),
        }
    }

    fn leaving_sets(&self, problem: &Problem, nominal: &[NominalTarget]) -> Option<Planned> {
        least_harm(problem, nominal)
    }
}

/// Plans one problem along its desired path and the alternative paths.
///
/// The plan starts at the first waypoint at t = 0 and ends at the last waypoint before the horizon.
/// It follows the paths and moves forward up to the maximum speed, or waits. It is clear of every
/// obstacle up to rounding: no penetration exceeds 1e-7 m. Own ship turns on the spot at corners of
/// the path.
///
/// For time and length, the plan is optimal among all such motions along the paths. For the
/// space-time error, it is optimal on the graph. The result is deterministic unless the deadline
/// strikes.
pub fn plan(problem: &Problem) -> Planned {
    planned(problem, Aim::Arrive, 0.0)
}

/// Plans a motion to the last waypoint, or one to the horizon with the shortest remaining distance,
/// whatever the objective. `risk` is the risk level of the obstacles.
fn planned(problem: &Problem, aim: Aim, risk: f64) -> Planned {
    let refuse = |reason| Planned::of(Outcome::Infeasible(reason));
    let first = problem.desired.legs()[0].start;
    let away = (problem.own.pose.position - first).norm();
    // negated on purpose: a NaN is off the path
    if !(away <= tolerance::JOINT_M) {
        return refuse(NoPlan::OffPath { away });
    }
    let network = match PathNetwork::new(&problem.desired.waypoints(), problem.alternatives) {
        Ok(network) => network,
        Err(error) => return refuse(NoPlan::NoNetwork(error)),
    };
    let scene = Scene::new(problem, &network, aim);
    let refuse = |reason| Planned {
        path_time: Some(Box::new(Profile::new().diagram(&scene, problem.own.pose))),
        ..refuse(reason)
    };
    let to_go = network.to_go(network.start());
    if !scene.in_time(to_go, 0.0) {
        return refuse(NoPlan::PathTooLong {
            earliest: to_go / scene.max_speed,
            horizon: problem.horizon,
        });
    }
    if let Some(reason) = starts_inside(problem, &scene) {
        return refuse(reason);
    }
    search(problem, &scene, &Profile::new(), risk)
}

/// Finds the best motion that starts with the profile `begun` and then stays clear of every
/// obstacle.
fn search(problem: &Problem, scene: &Scene, begun: &Profile, risk: f64) -> Planned {
    let objective = match scene.aim {
        Aim::Arrive => problem.objective,
        // the time to the horizon, followed by the shortest remaining distance
        Aim::Last => Objective::Time,
    };
    search_for(objective, problem, scene, begun, risk)
}

/// Runs `search` with an explicit objective. If a search for the least space-time error is long,
/// a search for the least time runs meanwhile. It decides whether a plan exists, and is the
/// fallback result.
fn search_for(
    objective: Objective,
    problem: &Problem,
    scene: &Scene,
    begun: &Profile,
    risk: f64,
) -> Planned {
    let clock = Clock::new(problem.deadline);
    let asked = Problem {
        objective,
        ..problem.clone()
    };
    let measure = Measure::new(&asked);
    let begins = begun.end();
    let root = Node {
        place: begun.place(scene),
        time: begins.time,
        on_edge_of: None,
        // the desired trajectory starts at the first waypoint at t = 0
        due: begun.knots.len() == 1,
        mark: Mark::Start,
    };
    let mut known = Known::corners(scene);
    if objective == Objective::SpaceTimeError {
        rays::add_rays(scene, &mut known, &root);
    }
    if scene.aim == Aim::Last {
        known.add_last(scene, &root);
    }
    known.share(scene);
    let waits_are_free = measure.waits_are_free();
    let mut graph = Graph::new(scene, known, measure, problem.search, root, clock);
    let mut search = Search::new(graph.root());
    let mut timed_out = false;
    let mut quick: Option<Planned> = None;
    let goal = loop {
        let Counts {
            expanded,
            generated,
            ..
        } = search.counts();
        if objective == Objective::SpaceTimeError && quick.is_none() && expanded >= HARD {
            let left = Problem {
                deadline: clock.left(),
                ..problem.clone()
            };
            let found = search_for(Objective::Time, &left, scene, begun, risk);
            if matches!(found.outcome, Outcome::Infeasible(_)) {
                return found;
            }
            quick = Some(found);
        }
        match search.next_goal(&mut graph, expanded + SLICE) {
            Stop::Goal(goal) => break Some(goal),
            Stop::Exhausted => break None,
            Stop::Time => {
                timed_out = true;
                break None;
            }
            Stop::Budget if quick.is_some() && generated >= MOST_LINES => break None,
            Stop::Budget => {}
        }
    };
    if let (None, Some(quick)) = (goal, quick) {
        let outcome = match quick.outcome {
            Outcome::Solved(plan) if timed_out => Outcome::Deadline(Some(plan)),
            outcome => outcome,
        };
        return Planned { outcome, ..quick };
    }
    let stats = Some(search.counts());
    let found = goal.map(|goal| {
        let mut profile = begun.clone();
        for index in &search.way_to(goal)[1..] {
            let state = &search.nodes()[*index].state;
            let (from, to) = (&graph.nodes[state.from], &graph.nodes[state.node]);
            match state.leg {
                Some(leg) => {
                    if let Some(a) = from.on(scene, leg) {
                        let b = to.at_end_of(scene, leg);
                        profile.sail(scene, leg, a, state.via.unwrap_or(b));
                        if let Some(via) = state.via {
                            profile.sail_on(via, b);
                        }
                    }
                }
                None => profile.wait(to.time),
            }
        }
        if waits_are_free {
            profile.pull_taut(scene);
        } else {
            profile.tidy(scene);
        }
        let Node { place, .. } = graph.nodes[search.nodes()[goal].state.node];
        let to_go = if graph.has_arrived(&search.nodes()[goal].state) {
            0.0
        } else {
            place.to_go(scene)
        };
        Found {
            profile,
            to_go,
            method: PlanMethod::PathTimeGraph,
            graph_cost: Some(search.nodes()[goal].cost),
        }
    });
    let plan = found.as_ref();
    let outcome = match plan.and_then(|found| finished(problem, scene, found, risk)) {
        Some(plan) => Outcome::Solved(plan),
        None if timed_out => Outcome::Deadline(None),
        None => Outcome::Infeasible(farthest(problem, &graph, &search)),
    };
    let idle = Profile::new();
    let drawn = found.as_ref().map_or(&idle, |found| &found.profile);
    Planned {
        stats,
        explored: explored(&graph, search, clock),
        path_time: Some(Box::new(drawn.diagram(scene, problem.own.pose))),
        ..Planned::of(outcome)
    }
}

/// Profile of a solution.
struct Found {
    profile: Profile,
    /// Remaining distance in metres to the last waypoint.
    to_go: f64,
    method: PlanMethod,
    graph_cost: Option<f64>,
}

/// Converts a profile into a plan with its cost at the given risk.
fn finished(problem: &Problem, scene: &Scene, found: &Found, risk: f64) -> Option<Plan> {
    let trajectory = found.profile.trajectory(scene, problem.own.pose)?;
    let cost = match problem.objective {
        Objective::SpaceTimeError => problem.error_to_end(trajectory.segments()),
        Objective::Time => trajectory.end_time(),
        Objective::Length => trajectory.length(),
        Objective::LengthRisk { weight } => trajectory.length() + weight * risk,
    };
    Some(Plan {
        trajectory,
        cost,
        method: found.method,
        graph_cost: found.graph_cost.map(|_| cost),
        to_go: found.to_go,
    })
}

/// Explains why there is no plan if own ship is inside a set at t = 0.
fn starts_inside(problem: &Problem, scene: &Scene) -> Option<NoPlan> {
    let point = scene.network.start();
    let obstacle = scene.barrier_at(point, 0.0, tolerance::TIME_S)?;
    let set = &problem.obstacles[obstacle];
    let depth = -set.signed_distance(problem.own.pose.position, 0.0).distance;
    let leg = *scene.network.onward(point).first()?;
    let at = PathTime::new(0.0, 0.0);
    Some(NoPlan::StartCovered {
        target: set.name().to_owned(),
        depth: depth.max(0.0),
        until: finite(scene.covered_until(leg, obstacle, at)),
    })
}

fn finite(time: f64) -> Option<f64> {
    time.is_finite().then_some(time)
}

/// Returns the obstacle that blocks the search node closest to the end.
fn farthest(problem: &Problem, graph: &Graph, search: &Search<State>) -> NoPlan {
    let scene = graph.scene;
    let nearest = search
        .nodes()
        .iter()
        .filter(|node| node.fate == Fate::Expanded)
        .map(|node| &graph.nodes[node.state.node])
        .min_by(|a, b| {
            a.left(scene)
                .total_cmp(&b.left(scene))
                .then(a.time.total_cmp(&b.time))
        });
    let barrier = nearest.and_then(|node| {
        let leg = match node.place {
            Place::On { leg, .. } => leg,
            Place::At(point) => *scene.network.onward(point).first()?,
        };
        let from = node.on(scene, leg)?;
        let length = scene.tracks[leg].length;
        let to = PathTime::new(
            length,
            from.time + (length - from.distance) / scene.max_speed,
        );
        let (obstacle, met) = scene.nearest_barrier(leg, from, to, true)?;
        Some(NoPlan::Barred {
            target: problem.obstacles[obstacle].name().to_owned(),
            to_go: node.left(scene) - (met.distance - from.distance),
            time: met.time,
            until: finite(scene.bars_until(leg, obstacle, met)),
        })
    });
    barrier.unwrap_or_else(|| NoPlan::OutOfTime {
        target: first_met(scene)
            .map_or_else(String::new, |o| problem.obstacles[o].name().to_owned()),
        horizon: problem.horizon,
    })
}

/// First obstacle on the shortest path at maximum speed.
fn first_met(scene: &Scene) -> Option<usize> {
    let network = scene.network;
    let (mut point, mut time) = (network.start(), 0.0);
    for _ in network.legs() {
        let on = |leg: &&usize| {
            let leg = &network.legs()[**leg];
            leg.length + network.to_go(leg.ends[1])
        };
        let leg = *(network.onward(point).iter()).min_by(|a, b| on(a).total_cmp(&on(b)))?;
        let length = scene.tracks[leg].length;
        let at = |distance: f64| PathTime::new(distance, time + distance / scene.max_speed);
        if let Some((obstacle, _)) = scene.nearest_barrier(leg, at(0.0), at(length), true) {
            return Some(obstacle);
        }
        (point, time) = (network.legs()[leg].ends[1], at(length).time);
    }
    None
}

/// Converts the line into a state to segments.
fn lines(scene: &Scene, graph: &Graph, state: &State, heading: f64) -> Vec<Segment> {
    let (from, to) = (&graph.nodes[state.from], &graph.nodes[state.node]);
    let still = |time| PathTime::new(0.0, time);
    let ends = match state.leg {
        Some(leg) => from.on(scene, leg).map(|a| (a, to.at_end_of(scene, leg))),
        None => Some((still(from.time), still(to.time))),
    };
    let Some((start, end)) = ends else {
        return Vec::new();
    };
    let place = |p: PathTime| match state.leg {
        Some(leg) => scene.tracks[leg].at(p.distance),
        None => from.place.position(scene),
    };
    let stops: Vec<PathTime> = [Some(start), state.via, Some(end)]
        .into_iter()
        .flatten()
        .collect();
    stops
        .windows(2)
        .map(|p| {
            let duration = p[1].time - p[0].time;
            let way = p[1].distance - p[0].distance;
            Segment::straight(
                Pose::new(place(p[0]), heading),
                p[0].time,
                duration,
                if duration > 0.0 { way / duration } else { 0.0 },
            )
        })
        .collect()
}

/// Exports the nodes and tested lines; after the first `FEW` nodes, until the deadline.
fn explored(graph: &Graph, search: Search<State>, clock: Clock) -> ExploredGraph {
    let scene = graph.scene;
    let nodes = search.into_nodes();
    let mut made = ExploredGraph::with_capacity(64, 64);
    let mut index_of: Vec<Option<NodeIndex>> = vec![None; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        let state = &node.state;
        if made.node_count() >= FEW && clock.is_up() {
            break;
        }
        if index > 0 && !state.tested.get() {
            continue;
        }
        let here = &graph.nodes[state.node];
        let (position, heading) = match state.leg {
            Some(leg) => {
                let track = &scene.tracks[leg];
                let place = track.at(here.at_end_of(scene, leg).distance);
                (place, heading_of(track.direction))
            }
            None => (here.place.position(scene), 0.0),
        };
        let kind = match (here.mark, here.on_edge_of) {
            _ if node.fate == Fate::Goal => NodeKind::End,
            (Mark::Start, _) => NodeKind::Start,
            (Mark::Corner | Mark::Passed | Mark::Due, Some(obstacle)) => {
                NodeKind::Corner { obstacle }
            }
            (_, _) => NodeKind::Waypoint,
        };
        let added = made.add_node(ExploredNode {
            kind,
            pose: Pose::new(position, heading),
            time: here.time,
            cost: node.cost,
            expanded: node.fate == Fate::Expanded,
        });
        index_of[index] = Some(added);
        let Some((parent, before)) = node.parent.and_then(|p| Some((p, index_of[p]?))) else {
            continue;
        };
        let edge = ExploredEdge {
            segments: lines(scene, graph, state, heading),
            cost: node.cost - nodes[parent].cost,
            verdict: match state.met.get() {
                Some(obstacle) => EdgeVerdict::Blocked { obstacle },
                None => EdgeVerdict::Free,
            },
        };
        made.add_edge(before, added, edge);
    }
    made
}
