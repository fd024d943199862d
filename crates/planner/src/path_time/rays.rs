//! Additional nodes at which a profile of least space-time error may bend. There it joins or leaves
//! the desired trajectory or an edge of an obstacle.
//!
//! While own ship is behind or ahead of schedule, no intermediate speed is optimal. It waits, moves
//! at full speed, or slides along an edge. Rays therefore start at every corner at both extreme
//! speeds, forward and backward in time, toward the schedule. They end at the schedule or at an
//! obstacle.

use super::due::Due;
use super::nodes::{Known, Mark, Node, Place};
use super::scene::Scene;
use searoom_geometry::tolerance;
use searoom_sets::PathTime;

/// Maximum number of pieces of one ray over consecutive legs.
const MAX_PIECES: usize = 100;

/// Adds the intersections of the schedule with leg ends and obstacle edges, and the ends of the
/// rays.
pub(crate) fn add_rays(scene: &Scene, known: &mut Known, root: &Node) {
    for (leg, due) in scene.dues.iter().enumerate() {
        if let Some(due) = due {
            schedule(scene, leg, due, known);
        }
    }
    // latest arrival: a profile leaves a later schedule for it
    for (leg, ends) in scene.network.legs().iter().map(|leg| leg.ends).enumerate() {
        if scene.network.is_end(ends[1]) {
            let last = PathTime::new(scene.tracks[leg].length, scene.horizon);
            known.add(scene, leg, last, None, Mark::Corner);
        }
    }
    let corners: Vec<(usize, PathTime)> = sources(scene, known, root);
    for (leg, at) in corners {
        for forward in [true, false] {
            cast(scene, leg, at, forward, known);
        }
    }
    known.in_order();
}

/// Lists the corners with a leg that contains each, and the root. A corner at a point is listed
/// with every leg there.
fn sources(scene: &Scene, known: &Known, root: &Node) -> Vec<(usize, PathTime)> {
    let nodes = known.on.iter().chain(&known.at).flatten();
    let mut sources = Vec::new();
    for node in nodes.filter(|n| n.mark == Mark::Corner) {
        match node.place {
            Place::On { leg, distance } => sources.push((leg, PathTime::new(distance, node.time))),
            Place::At(point) => {
                for &(leg, distance) in scene.touching(point) {
                    sources.push((leg, PathTime::new(distance, node.time)));
                }
            }
        }
    }
    let onward = match root.place {
        Place::On { leg, .. } => &[leg][..],
        Place::At(point) => scene.network.onward(point),
    };
    let begun = |leg: &usize| Some((*leg, root.on(scene, *leg)?));
    sources.extend(onward.iter().filter_map(begun));
    sources
}

/// Adds the schedule at the ends of a leg and its intersections with obstacles.
fn schedule(scene: &Scene, leg: usize, due: &Due, known: &mut Known) {
    let length = scene.tracks[leg].length;
    let from = PathTime::new(0.0, due.start);
    let to = PathTime::new(length, due.start + length / due.speed);
    // own ship cannot follow a schedule above its maximum speed
    if due.speed > scene.max_speed * (1.0 + tolerance::LIMIT) {
        return;
    }
    known.add(scene, leg, from, None, Mark::Due);
    known.add(scene, leg, to, None, Mark::Due);
    for seen in &scene.seen[leg] {
        if let Some(shares) = seen.body.inside(from, to, 0.0) {
            for share in shares.into_iter().filter(|s| *s > 0.0 && *s < 1.0) {
                let at = PathTime::new(length * share, from.time + (to.time - from.time) * share);
                known.add(scene, leg, at, Some(seen.obstacle), Mark::Due);
            }
        }
    }
}

/// Casts a ray toward the schedule. Forward, full speed reduces a lag and rest reduces a lead;
/// backward is the reverse. Without a schedule, the ray has full speed.
fn cast(scene: &Scene, leg: usize, at: PathTime, forward: bool, known: &mut Known) {
    let Some(due) = scene.dues[leg] else {
        run(scene, leg, at, forward, None, known);
        return;
    };
    let behind = due.lag(at);
    if behind.abs() <= tolerance::LENGTH_M {
        return;
    }
    if (behind > 0.0) == forward {
        run(scene, leg, at, forward, Some(behind > 0.0), known);
    } else {
        // rest until on schedule
        let time = due.start + at.distance / due.speed;
        let to = PathTime::new(at.distance, time.clamp(0.0, scene.horizon));
        end(scene, leg, at, to, forward, to.time == time, known);
    }
}

/// Casts a full-speed ray over the legs until it meets the schedule, an obstacle, or the last
/// leg.
fn run(
    scene: &Scene,
    leg: usize,
    at: PathTime,
    forward: bool,
    behind: Option<bool>,
    known: &mut Known,
) {
    let sign = if forward { 1.0 } else { -1.0 };
    let mut open = vec![(leg, at)];
    for _ in 0..MAX_PIECES {
        let Some((leg, at)) = open.pop() else { return };
        let length = scene.tracks[leg].length;
        let way = if forward {
            length - at.distance
        } else {
            at.distance
        };
        let sailed = |way: f64| {
            PathTime::new(
                at.distance + sign * way,
                at.time + sign * way / scene.max_speed,
            )
        };
        let mut to = sailed(way);
        let mut due_there = false;
        if let Some(due) = scene.dues[leg]
            && behind.is_some()
        {
            let closing = scene.max_speed - due.speed;
            let needed = due.lag(at).abs() * scene.max_speed / closing;
            if closing > 0.0 && needed <= way {
                to = sailed(needed);
                due_there = true;
            }
        }
        if !(to.time >= 0.0 && to.time <= scene.horizon) {
            continue;
        }
        let whole = end(scene, leg, at, to, forward, due_there, known);
        if due_there || !whole {
            continue;
        }
        let ends = scene.network.legs()[leg].ends;
        let point = if forward { ends[1] } else { ends[0] };
        for &(next, distance) in scene.touching(point) {
            let starts = distance == 0.0;
            let same_schedule = behind.is_none() || scene.dues[next].is_some();
            if starts == forward && next != leg && same_schedule {
                let at = PathTime::new(distance, to.time);
                open.push((next, at));
            }
        }
    }
}

/// Adds the end of a line, or its first intersection with an obstacle. True without an
/// intersection.
fn end(
    scene: &Scene,
    leg: usize,
    at: PathTime,
    to: PathTime,
    forward: bool,
    due: bool,
    known: &mut Known,
) -> bool {
    let (from, until) = if forward { (at, to) } else { (to, at) };
    match scene.nearest_barrier(leg, from, until, forward) {
        None => {
            let mark = if due { Mark::Due } else { Mark::Passed };
            known.add(scene, leg, to, None, mark);
            true
        }
        Some((obstacle, met)) => {
            known.add(scene, leg, met, Some(obstacle), Mark::Passed);
            false
        }
    }
}
