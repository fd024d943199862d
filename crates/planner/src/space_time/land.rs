//! Land in the planner: groundings of the nominal motion, and land blocks near a manoeuvre.

use crate::Problem;
use crate::space_time::manoeuvre::conflict::Conflict;
use crate::space_time::manoeuvre::motion::{pose_at, sailed_between};
use crate::space_time::proxy::Proxy;
use searoom_geometry::frame::{Side, to_port};
use searoom_geometry::tolerance::TOUCH_M;
use searoom_model::trajectory::Segment;
use searoom_sets::{LandObstacle, window_of};

/// Sampling interval of the nominal motion against the land, seconds.
const STEP_S: f64 = 2.0;

/// Land blocks as proxies, in their order. Their obstacle index refers to no target.
pub(crate) fn proxies<'a>(problem: &Problem<'a>) -> Vec<Proxy<'a>> {
    let index = problem.obstacles.len();
    let blocks = problem.land_obstacle.blocks().iter();
    blocks.map(|block| Proxy::at_rest(index, block)).collect()
}

/// First instant at which a chain of segments is deeper in land than touching.
pub(crate) fn first_contact(land_obstacle: &LandObstacle, segments: &[Segment]) -> Option<f64> {
    segments
        .iter()
        .find_map(|s| land_obstacle.first_contact(s, TOUCH_M))
}

/// True when a chain of segments meets land.
pub(crate) fn meets(land_obstacle: &LandObstacle, segments: &[Segment]) -> bool {
    segments.iter().any(|s| land_obstacle.meets(s, TOUCH_M))
}

/// Blocks within `margin` metres of the segments of a manoeuvre, in their order.
pub(crate) fn near<'s>(
    land_obstacle: &LandObstacle,
    segments: impl Iterator<Item = &'s Segment>,
    margin: f64,
) -> Vec<usize> {
    if land_obstacle.is_empty() {
        return Vec::new();
    }
    let mut found: Vec<usize> = segments
        .flat_map(|s| land_obstacle.near(&window_of(s).grown(margin)))
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Conflict with a target whose lateral offsets end on land: extends the offsets to the water
/// behind it.
pub(crate) fn beyond_land(
    land_obstacle: &LandObstacle,
    mut conflict: Conflict,
    nominal_motion: &[Segment],
) -> Conflict {
    let middle = 0.5 * (conflict.from + conflict.to);
    let Some(pose) = pose_at(nominal_motion, middle).filter(|_| !land_obstacle.is_empty()) else {
        return conflict;
    };
    for (side, offset) in Side::BOTH.into_iter().zip(&mut conflict.offsets) {
        let beam = to_port(pose.ahead()) * side.turn_sign();
        *offset += land_obstacle.way_out(pose.position + beam * *offset, beam);
    }
    conflict
}

/// Conflicts of the nominal motion with land, sampled every [`STEP_S`] from the first contact on,
/// each with the offsets that clear the land.
pub(crate) fn conflicts(land_obstacle: &LandObstacle, nominal_motion: &[Segment]) -> Vec<Conflict> {
    let mut found: Vec<Conflict> = Vec::new();
    let Some(first) = first_contact(land_obstacle, nominal_motion) else {
        return found;
    };
    let end = nominal_motion.last().map_or(first, Segment::end_time);
    let mut on_water = true;
    for step in 0..=((end - first) / STEP_S) as usize {
        let time = first + STEP_S * step as f64;
        let Some(pose) = pose_at(nominal_motion, time) else {
            break;
        };
        let on_land = land_obstacle
            .depth(pose.position)
            .is_some_and(|d| d > TOUCH_M);
        // the first contact itself is at the edge
        if !on_land && step > 0 {
            on_water = true;
            continue;
        }
        if on_water {
            found.push(Conflict::at(time));
        }
        on_water = false;
        if let Some(conflict) = found.last_mut() {
            conflict.to = time;
            for (side, offset) in Side::BOTH.into_iter().zip(&mut conflict.offsets) {
                let beam = to_port(pose.ahead()) * side.turn_sign();
                *offset = offset.max(land_obstacle.way_out(pose.position, beam));
            }
        }
    }
    for conflict in &mut found {
        conflict.through = sailed_between(nominal_motion, conflict.from, conflict.to);
    }
    found
}
