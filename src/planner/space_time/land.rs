//! Land in the planner: where the undisturbed motion would go ashore, and which blocks are near a manoeuvre.

use crate::frame::{Pose, Side, Vector, to_port};
use crate::geometry::{ConvexPolygon, outer_simplified};
use crate::obstacle::{Coast, LAND, PolytopeObstacle, window_of};
use crate::planner::Problem;
use crate::planner::space_time::graph::tangent::Aims;
use crate::planner::space_time::proxy::{Hazard, TOUCH_M};
use crate::planner::space_time::selection::initial_guess::{Conflict, Paces};
use crate::trajectory::Segment;

/// Metres. Blocks farther than this from the undisturbed motion are not aimed at.
const AIMED_M: f64 = 40.0;

/// Vertices at most of a block whose corners are nodes.
const BLOCK_VERTICES: usize = 8;

/// Metres. A corner this deep inside another block is inside it, not on its edge.
const CORNER_M: f64 = 1e-3;

/// Seconds between the instants at which the undisturbed motion is compared with the land.
const STEP_S: f64 = 2.0;

/// The blocks of the land as hazards, in their order. Of their obstacle's index there is no target.
pub(crate) fn hazards<'a>(problem: &Problem<'a>) -> Vec<Hazard<'a>> {
    let index = problem.obstacles.len();
    let blocks = problem.coast.blocks().iter();
    blocks.map(|block| Hazard::at_rest(index, block)).collect()
}

/// The first instant at which a chain of segments is ashore, deeper than touching.
pub(crate) fn first_contact(coast: &Coast, segments: &[Segment]) -> Option<f64> {
    segments
        .iter()
        .find_map(|s| coast.first_contact(s, TOUCH_M))
}

/// True when a chain of segments goes ashore.
pub(crate) fn meets(coast: &Coast, segments: &[Segment]) -> bool {
    segments.iter().any(|s| coast.meets(s, TOUCH_M))
}

/// The blocks within `margin` metres of the legs of a manoeuvre, in their order.
pub(crate) fn near<'s>(
    coast: &Coast,
    segments: impl Iterator<Item = &'s Segment>,
    margin: f64,
) -> Vec<usize> {
    if coast.is_empty() {
        return Vec::new();
    }
    let mut found: Vec<usize> = segments
        .flat_map(|s| coast.near(&window_of(s).grown(margin)))
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// A conflict with a target whose ways to the sides end on land: there they lead on to the water behind it.
pub(crate) fn beyond_land(coast: &Coast, conflict: Conflict, undisturbed: &[Segment]) -> Conflict {
    let mut conflict = conflict;
    let middle = 0.5 * (conflict.from + conflict.to);
    let Some(pose) = pose_at(undisturbed, middle).filter(|_| !coast.is_empty()) else {
        return conflict;
    };
    for (side, offset) in Side::BOTH.into_iter().zip(&mut conflict.offsets) {
        let beam = to_port(pose.ahead()) * side.turn_sign();
        *offset += coast.way_out(pose.position + beam * *offset, beam);
    }
    conflict
}

/// The stretches of the undisturbed motion that are ashore, seen every [`STEP_S`] from the first contact on, each with
/// what it takes to pass beside the land. Land does not pass: there is no waiting for it and no passing ahead.
pub(crate) fn conflicts(coast: &Coast, undisturbed: &[Segment]) -> Vec<Conflict> {
    let mut found: Vec<Conflict> = Vec::new();
    let Some(first) = first_contact(coast, undisturbed) else {
        return found;
    };
    let end = undisturbed.last().map_or(first, Segment::end_time);
    let mut on_water = true;
    for step in 0..=((end - first) / STEP_S) as usize {
        let time = first + STEP_S * step as f64;
        let Some(pose) = pose_at(undisturbed, time) else {
            break;
        };
        let ashore = coast.depth(pose.position).is_some_and(|d| d > TOUCH_M);
        // the first contact itself is at the edge
        if !ashore && step > 0 {
            on_water = true;
            continue;
        }
        if on_water {
            found.push(Conflict {
                from: time,
                to: time,
                through: 0.0,
                offsets: [0.0; 2],
                astern: (f64::INFINITY, time),
                ahead: (f64::INFINITY, time),
            });
        }
        on_water = false;
        if let Some(conflict) = found.last_mut() {
            conflict.to = time;
            for (side, offset) in Side::BOTH.into_iter().zip(&mut conflict.offsets) {
                let beam = to_port(pose.ahead()) * side.turn_sign();
                *offset = offset.max(coast.way_out(pose.position, beam));
            }
        }
    }
    for conflict in &mut found {
        let sailed = undisturbed
            .iter()
            .map(|s| s.between(conflict.from, conflict.to).length());
        conflict.through = sailed.sum();
    }
    found
}

fn pose_at(segments: &[Segment], time: f64) -> Option<Pose> {
    segments
        .iter()
        .find(|s| s.end_time() >= time)
        .or(segments.last())
        .map(|s| s.pose_at(time))
}

/// The corners of the land near the undisturbed motion, where that goes aground, each block with few: those that are
/// inside other blocks are left out, for no way leads past them. Where it stays on water ways around targets need no
/// corner of the land: to aim at them too took twice the time and found no cheaper plan among 60 along quays.
pub(crate) fn aims(problem: &Problem, undisturbed: &[Segment]) -> impl Iterator<Item = Aims> {
    let coast = problem.coast;
    let aground = first_contact(coast, undisturbed).is_some();
    let blocks = if aground {
        near(coast, undisturbed.iter(), AIMED_M)
    } else {
        Vec::new()
    };
    let paces = Paces::of(problem);
    blocks.into_iter().filter_map(move |b| {
        let block = &coast.blocks()[b];
        let around = outer_simplified(block.initial(), BLOCK_VERTICES);
        let open = |corner: Vector| !coast.depth(corner).is_some_and(|depth| depth > CORNER_M);
        if !around.vertices().iter().any(|v| open(*v)) {
            return None;
        }
        let rest = ConvexPolygon::point(Vector::zeros());
        let body = PolytopeObstacle::new(LAND, around, rest);
        let hazard = Hazard::at_rest(problem.obstacles.len(), block);
        let speeds = [paces.normal, paces.fast];
        let speeds = speeds
            .into_iter()
            .take(if paces.normal < paces.fast { 2 } else { 1 });
        Some(Aims::past(&hazard, &body, speeds, open))
    })
}
