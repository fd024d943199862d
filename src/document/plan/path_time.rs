//! Diagram of a path-time plan.

use searoom_document::{
    PathCornerDocument, PathLegDocument, PathObstacleDocument, PathTimeDocument,
};

use crate::frame::clockwise_deg;
use crate::obstacle::{PathTime, SpaceTimeObstacle};
use crate::pipeline::Run;
use crate::planner::path_time::PathTimeDiagram;

pub(super) fn path_time_document(run: &Run, diagram: &PathTimeDiagram) -> PathTimeDocument {
    // adding +0.0 converts a negative zero to zero
    let plain = |p: &PathTime| [p.distance + 0.0, p.time + 0.0];
    PathTimeDocument {
        path: paths(diagram),
        legs: diagram
            .legs
            .iter()
            .map(|leg| PathLegDocument {
                start_m: leg.begin,
                end_m: leg.begin + leg.track.length,
                path: path(leg.path),
            })
            .collect(),
        obstacles: diagram
            .obstacles
            .iter()
            .map(|seen| PathObstacleDocument {
                target: run.targets[seen.obstacle].obstacle.name().to_owned(),
                leg: seen.leg,
                vertices: seen.corners.iter().map(plain).collect(),
            })
            .collect(),
        corners: diagram
            .corners
            .iter()
            .map(|corner| PathCornerDocument {
                s_m: corner.distance,
                turn_deg: clockwise_deg(corner.turn),
            })
            .collect(),
        profile: diagram.profile.iter().map(plain).collect(),
    }
}

/// Name of a path; 0 is the main one.
fn path(index: usize) -> String {
    match index {
        0 => "main".to_owned(),
        index => format!("alternative {index}"),
    }
}

/// Names of the paths of a plan in order.
pub(crate) fn paths(diagram: &PathTimeDiagram) -> String {
    let mut paths: Vec<usize> = diagram.legs.iter().map(|leg| leg.path).collect();
    paths.dedup();
    let names: Vec<String> = paths.into_iter().map(path).collect();
    names.join(", ")
}
