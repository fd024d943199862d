//! Conflict search: on which side, ahead or astern each of several targets is passed.
//!
//! A node is a manoeuvre that is refined clear of the targets considered so far. The cheapest node
//! is taken first. If it meets a further target, it has a child for each way of passing that
//! target; if it meets none, it is an answer. This is conflict-based search (Sharon et al. 2015,
//! doi:10.1016/j.artint.2014.11.006) on targets in place of agents.

use crate::clock::Clock;
use crate::space_time::context::Context;
use crate::space_time::land;
use crate::space_time::manoeuvre::conflict::Conflict;
use crate::space_time::manoeuvre::corner::{Corner, corners_of};
use crate::space_time::manoeuvre::ending::Ending;
use crate::space_time::manoeuvre::motion::{pose_at, sailed_between};
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::proxy::{Proxy, by_obstacle, first_contact};
use crate::space_time::refinement::rollout::SegmentOrigin;
use crate::space_time::refinement::structure::SegmentVariable;
use crate::space_time::refinement::{InitialGuess, Refinement};
use crate::space_time::selection::initial_guess::{InitialGuessBuilder, RETURN_ANGLES};
use searoom_geometry::frame::{Side, Vector, cross, heading_of, to_port, wrap};
use searoom_model::trajectory::Segment;

/// Largest number of answers: the cheapest one before insertions need not be the cheapest one after
/// them.
const MAX_ANSWERS: usize = 3;

/// Refinement steps of a child. A child that needs more is seldom a cheap one.
pub(crate) const STEPS: usize = 4;

/// Refinement steps of a child where no other manoeuvre is clear.
pub(crate) const MORE_STEPS: usize = 10;

/// Largest number of corners of a manoeuvre: with more, its segment variables do not fit.
pub(crate) const MAX_CORNERS: usize = 6;

/// Largest numbers of corners with turns at the slow speed too, and with lines at the normal speed.
const MOST_WITH_SLOW_TURNS: usize = 3;
const MOST_WITH_ALL_SPEEDS: usize = 4;

/// A corner this near to the route, in turning radii, is on it. A line at less than this angle to
/// it, in radians, does not return to it.
const ON_ROUTE: f64 = 0.05;

/// Turn out of the way of a target, radians.
const TURN_OUT: f64 = 0.6;

/// Metres. A manoeuvre does not return where its last corner is.
pub(crate) const SHORTEST_M: f64 = 1.0;

/// Longest turn at a corner, radians.
const SHARPEST: f64 = 2.2;

/// Manoeuvre that is clear of the targets considered.
#[derive(Debug)]
struct Node {
    guess: Option<InitialGuess>,
    motion: Vec<Segment>,
    cost: f64,
    /// Corners from the departure from the route to the return; one for a manoeuvre by speed
    /// alone, none for the nominal motion.
    corners: Vec<Corner>,
    to_goal: bool,
    considered: Vec<usize>,
}

impl Node {
    fn root(nominal_motion: &[Segment]) -> Self {
        Self {
            guess: None,
            motion: nominal_motion.to_vec(),
            cost: 0.0,
            corners: Vec::new(),
            to_goal: false,
            considered: Vec::new(),
        }
    }
}

/// Manoeuvre that is clear of every target and of land, with its motion.
pub(crate) type Resolved = (InitialGuess, Vec<Segment>);

/// Manoeuvres that are clear of every target and of land, about the cheapest first. Takes at most
/// `most` nodes, and refines a child by `steps`.
pub(crate) fn resolve(
    context: &Context,
    nominal_motion: &[Segment],
    most: usize,
    steps: usize,
    clock: Clock,
) -> Vec<Resolved> {
    let mut found = Vec::new();
    let mut open = vec![Node::root(nominal_motion)];
    for _ in 0..most {
        let cheapest = (0..open.len()).min_by(|a, b| open[*a].cost.total_cmp(&open[*b].cost));
        let (false, Some(cheapest)) = (clock.is_up() || found.len() == MAX_ANSWERS, cheapest)
        else {
            break;
        };
        let node = open.swap_remove(cheapest);
        let Some((obstacle, _)) = first_contact(context.proxies, &node.motion) else {
            if !land::meets(context.problem.land_obstacle, &node.motion) {
                found.extend(node.guess.map(|guess| (guess, node.motion)));
            }
            continue;
        };
        if node.considered.contains(&obstacle) {
            continue;
        }
        let met = by_obstacle(context.proxies).find(|h| h[0].obstacle == obstacle);
        if let Some(conflict) = met.and_then(|h| Conflict::of(h, &node.motion)) {
            let children = children(context, &node, obstacle, &conflict, steps, clock);
            open.extend(children);
        }
    }
    found
}

/// A child for each way of passing a target.
fn children(
    context: &Context,
    node: &Node,
    obstacle: usize,
    conflict: &Conflict,
    steps: usize,
    clock: Clock,
) -> Vec<Node> {
    let mut considered = node.considered.clone();
    considered.push(obstacle);
    let proxies: Vec<Proxy> = context
        .proxies
        .iter()
        .filter(|proxy| considered.contains(&proxy.obstacle))
        .copied()
        .collect();
    let context = Context {
        proxies: &proxies,
        ..*context
    };
    let beside = Side::BOTH.map(|side| beside(&context, node, conflict, side));
    let ways = beside.into_iter().flatten().flatten();
    let ahead_or_astern = [
        along(node, conflict.astern, -1.0),
        along(node, conflict.ahead, 1.0),
    ];
    ways.chain(ahead_or_astern.into_iter().flatten())
        .take_while(|_| !clock.is_up())
        .filter_map(|corners| child(&context, node, &corners, &considered, steps, clock))
        .collect()
}

/// Corners of manoeuvres that pass a target at a distance on one side; `None` for an empty motion.
fn beside(
    context: &Context,
    node: &Node,
    conflict: &Conflict,
    side: Side,
) -> Option<Vec<Vec<Corner>>> {
    let offset = conflict.offset(side);
    let speeds = ManoeuvreSpeeds::at(context.problem, conflict.from);
    let at = |time: f64| {
        let begins = node.motion.first().map_or(time, |s| s.start_time);
        let pose = pose_at(&node.motion, time.max(begins))?;
        let beam = to_port(pose.ahead()) * side.turn_sign();
        Some(Corner {
            time,
            position: pose.position + beam * offset,
        })
    };
    let (from, to) = (conflict.from, conflict.to);
    let lead = offset / (speeds.normal * TURN_OUT.sin());
    if conflict.through > offset {
        let mut all = vec![inserted(node, &[at(from)?, at(to)?], lead)?];
        if !node.corners.is_empty() {
            all.push(inserted(node, &[at(to)?], lead)?);
        }
        Some(all)
    } else {
        Some(vec![inserted(node, &[at(0.5 * (from + to))?], lead)?])
    }
}

/// Corners of a manoeuvre that is ahead of the node's, or behind it; `None` for an empty motion.
fn along(node: &Node, (distance, time): (f64, f64), sign: f64) -> Option<Vec<Corner>> {
    let pose = pose_at(&node.motion, time)?;
    let position = pose.position + pose.ahead() * (sign * distance);
    inserted(node, &[Corner { time, position }], 0.0)
}

/// The node's corners and those of passing a target; those meanwhile are replaced. `None` for an
/// empty motion.
fn inserted(node: &Node, passing: &[Corner], lead: f64) -> Option<Vec<Corner>> {
    let (first, last) = (passing[0], passing[passing.len() - 1]);
    let leaves = (first.time - lead).max(0.0);
    let before = node
        .corners
        .iter()
        .filter(|c| c.time < leaves.min(first.time - 1.0));
    let mut corners: Vec<Corner> = before.copied().collect();
    let ends = node.corners.last().map_or(0.0, |c| c.time);
    // on the route, before the first turn or after the last
    if lead > 0.0 && (corners.is_empty() || leaves > ends) {
        corners.push(Corner {
            time: leaves,
            position: pose_at(&node.motion, leaves)?.position,
        });
    }
    corners.extend(passing);
    corners.extend(node.corners.iter().filter(|c| c.time > last.time + 1.0));
    Some(corners)
}

/// Refinement of a manoeuvre through at least two corners. It leaves the nominal motion at the
/// first one, and goes through the others to the last waypoint or back onto the route. `None` where
/// none fits.
pub(crate) fn through(
    context: &Context,
    nominal_motion: &[Segment],
    corners: &[Corner],
    to_goal: bool,
) -> Option<Refinement> {
    let node = Node {
        to_goal,
        ..Node::root(nominal_motion)
    };
    fitting(context, &node, corners)
}

/// Refinement of the node's manoeuvre with these corners; `None` where none fits.
fn fitting(context: &Context, node: &Node, corners: &[Corner]) -> Option<Refinement> {
    let angles = RETURN_ANGLES.into_iter();
    angles
        .filter_map(|angle| guess(context, node, corners, angle))
        .find_map(|guess| Refinement::fitting(context, guess))
}

/// Refines a manoeuvre with these corners.
fn child(
    context: &Context,
    node: &Node,
    corners: &[Corner],
    considered: &[usize],
    steps: usize,
    clock: Clock,
) -> Option<Node> {
    let refinement = fitting(context, node, corners)?.run(context, steps, clock);
    let guess = refinement.best()?;
    let rollout = guess
        .structure
        .roll_out(context.problem, context.route, &guess.lengths)?;
    let motion = rollout.motion();
    // turns of the route itself are no corners
    let own = rollout.legs[..rollout.return_segments].iter().filter(|leg| {
        !matches!(leg.owner, SegmentOrigin::SegmentVariable { index, .. } if index < rollout.runs)
    });
    let mut legs: Vec<Segment> = own.map(|leg| leg.segment).collect();
    if legs.is_empty() {
        legs.extend(
            rollout.legs[..rollout.return_segments]
                .last()
                .map(|leg| leg.segment),
        );
    }
    Some(Node {
        corners: corners_of(&legs),
        to_goal: matches!(guess.structure.ending, Ending::Goal { .. }),
        cost: refinement.best_cost(),
        considered: considered.to_vec(),
        motion,
        guess: Some(guess),
    })
}

/// Manoeuvre through corners. After the last one it goes to the last waypoint if the node does.
/// Otherwise it goes back onto the route, at an angle unless that corner is where it returns.
fn guess(context: &Context, node: &Node, corners: &[Corner], angle: f64) -> Option<InitialGuess> {
    let (problem, route) = (context.problem, context.route);
    let radius = problem.own.turning_radius;
    let first = corners.first()?;
    let speeds = ManoeuvreSpeeds::at(problem, first.time);
    let sailed = sailed_between(&node.motion, 0.0, first.time);
    let (departure, _) = route.pose_at(sailed);
    let mut builder = InitialGuessBuilder::default();
    let run = |builder: &mut InitialGuessBuilder, length: f64| {
        let length = length.max(0.0);
        let [slow, normal, fast] = mixed(&speeds, length, first.time - route.ordered_time(length));
        builder.runs(&speeds, normal, fast, slow);
    };
    // a corner may be ahead of where own ship is then, or behind it
    let off = first.position - departure.position;
    let along = sailed + departure.ahead().dot(&off);
    if corners.len() == 1 {
        run(&mut builder, along);
        return builder.build(Ending::Follow);
    }
    let (leg, end) = ending(context, node, corners, angle);
    let last = corners[corners.len() - 1].position;
    if end.is_some_and(|end| (end - last).norm() < SHORTEST_M) {
        return None;
    }
    let mut points: Vec<Vector> = corners.iter().map(|corner| corner.position).collect();
    points.extend(end);
    let turns = points.len() - 1;
    if turns > MAX_CORNERS {
        return None;
    }
    let mut heading = departure.heading;
    let mut angles = Vec::with_capacity(turns);
    for pair in points.windows(2) {
        let next = heading_of(pair[1] - pair[0]);
        angles.push(wrap(next - heading));
        heading = next;
    }
    // negated on purpose: a NaN is too sharp
    if angles.iter().any(|angle| !(angle.abs() < SHARPEST)) {
        return None;
    }
    let tangent = |angle: f64| radius * (0.5 * angle.abs()).tan();
    run(&mut builder, along - tangent(angles[0]));
    for (i, &angle) in angles.iter().enumerate() {
        let side = Side::of_turn(angle).unwrap_or(Side::Starboard);
        let last = i + 1 == turns;
        if last && node.to_goal {
            let speed = speeds.fast;
            return builder.build(Ending::Goal { side, speed });
        }
        let arc = |speed: f64| SegmentVariable::Arc { side, speed };
        if turns <= MOST_WITH_SLOW_TURNS {
            builder.push(arc(speeds.slow), 0.0);
        }
        builder.push(arc(speeds.fast), radius * angle.abs());
        if last {
            break;
        }
        let way = (points[i + 1] - points[i]).norm();
        let length = (way - tangent(angle) - tangent(angles[i + 1])).max(0.0);
        let time = (corners[i + 1].time - corners[i].time) * length / way;
        let [slow, normal, fast] = mixed(&speeds, length, time - length / speeds.normal);
        let line = |speed: f64| SegmentVariable::Line { speed };
        builder.push(line(speeds.slow), slow);
        if turns <= MOST_WITH_ALL_SPEEDS {
            builder.push(line(speeds.normal), normal);
            builder.push(line(speeds.fast), fast);
        } else {
            builder.push(line(speeds.fast), normal + fast);
        }
    }
    builder.build(Ending::Return {
        leg,
        speed: speeds.fast,
    })
}

/// The leg to which a manoeuvre through corners returns, and where; nowhere if the last corner is
/// there already. The end of the path for a manoeuvre that goes there.
fn ending(
    context: &Context,
    node: &Node,
    corners: &[Corner],
    angle: f64,
) -> (usize, Option<Vector>) {
    let problem = context.problem;
    let legs = problem.desired.legs();
    let [.., before, last] = corners else {
        return (0, None);
    };
    let leg = legs.iter().position(|l| l.end_time() > last.time);
    let leg = leg.unwrap_or(legs.len() - 1);
    if node.to_goal {
        return (leg, Some(problem.desired.end()));
    }
    let line = &legs[leg];
    let offset = |p: Vector| cross(line.direction, p - line.start);
    let way = last.position - before.position;
    let is_back = offset(last.position).abs() < ON_ROUTE * problem.own.turning_radius
        && cross(line.direction, way).abs() > ON_ROUTE * way.norm()
        && line.direction.dot(&way) > 0.0;
    if is_back {
        return (leg, None);
    }
    let back = offset(last.position).abs() / angle.tan();
    let along = line.direction.dot(&(last.position - line.start)) + back;
    (leg, Some(line.start + line.direction * along))
}

/// Lengths at the slow, the normal and the fast speed that together take some seconds more than the
/// normal speed, as nearly as possible.
fn mixed(speeds: &ManoeuvreSpeeds, length: f64, spare: f64) -> [f64; 3] {
    let ManoeuvreSpeeds {
        slow, normal, fast, ..
    } = *speeds;
    let other = if spare > 0.0 { slow } else { fast };
    // without another speed the share is a NaN or infinite, and becomes the length
    let share = (spare / (1.0 / other - 1.0 / normal)).min(length).max(0.0);
    if spare > 0.0 {
        [share, length - share, 0.0]
    } else {
        [0.0, length - share, share]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Problem;
    use crate::ship_fixtures::own_ship;
    use crate::space_time::piece::pieces;
    use crate::space_time::proxy::within_reach;
    use crate::space_time::route::Route;
    use searoom_geometry::ConvexPolygon;
    use searoom_model::trajectory::DesiredTrajectory;
    use searoom_sets::PolytopeObstacle;
    use std::time::Duration;

    /// A square of 200 m crosses the route from south to north.
    #[test]
    fn a_target_is_passed_on_either_side() {
        let points = [Vector::zeros(), Vector::new(4000.0, 0.0)];
        let desired = DesiredTrajectory::new(&points, &[5.0]).expect("valid");
        let own = own_ship(&[2.5, 5.0, 7.0]);
        let corners = [
            (-100.0, -100.0),
            (100.0, -100.0),
            (100.0, 100.0),
            (-100.0, 100.0),
        ];
        let square = corners.map(|(x, y)| Vector::new(2000.0 + x, -800.0 + y));
        let body = PolytopeObstacle::new(
            "square",
            ConvexPolygon::hull(&square).expect("convex"),
            ConvexPolygon::point(Vector::new(0.0, 2.0)),
        );
        let obstacles = [body.into()];
        let problem = Problem::new(&own, &desired, &obstacles, 1600.0);
        let pieces = pieces(&obstacles, problem.horizon);
        let proxies = within_reach(&problem, &pieces);
        let clock = Clock::new(Duration::from_secs(60));
        let route = Route::new(&problem, clock).expect("a route");
        let context = Context::new(&problem, &route, &proxies, &[], 0.0);
        let nominal = route.follow(0.0, 0.0);
        let conflict = Conflict::of(&proxies, &nominal).expect("a conflict");
        let root = Node::root(&nominal);
        let found = children(&context, &root, 0, &conflict, MORE_STEPS, clock);
        let mut sides = [false; 2];
        for child in &found {
            assert!(first_contact(&proxies, &child.motion).is_none());
            let north = child.motion.iter().map(|s| s.end().position.y);
            let (south, north) = north.fold((0.0_f64, 0.0_f64), |(low, high), y| {
                (low.min(y), high.max(y))
            });
            sides[usize::from(north > -south)] = true;
        }
        assert_eq!(sides, [true; 2]);
    }
}
