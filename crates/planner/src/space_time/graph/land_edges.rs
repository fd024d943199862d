//! Tangent edges to the corners of land.

use crate::Problem;
use crate::space_time::graph::tangent::TangentEdges;
use crate::space_time::land::{first_contact, near};
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::proxy::Proxy;
use searoom_geometry::frame::Vector;
use searoom_geometry::{ConvexPolygon, outer_simplified};
use searoom_model::trajectory::Segment;
use searoom_sets::{LAND, PolytopeObstacle};

/// Metres. A corner at least this deep in another block is inside it, not on its boundary.
const CORNER_M: f64 = 1e-3;

/// Tangent edges to land corners near the nominal motion, where that grounds. Each block is
/// simplified to few corners; corners inside other blocks are left out because nothing can pass
/// them.
///
/// Where the nominal motion stays on water, there are none. Including them took twice the time and
/// found no cheaper plan among 60 scenarios along quays.
pub(super) fn land_edges(
    problem: &Problem,
    nominal_motion: &[Segment],
) -> impl Iterator<Item = TangentEdges> {
    let land_obstacle = problem.land_obstacle;
    let grounds = first_contact(land_obstacle, nominal_motion);
    let blocks = if grounds.is_some() {
        near(
            land_obstacle,
            nominal_motion.iter(),
            problem.settings.graph.land_m,
        )
    } else {
        Vec::new()
    };
    let speed_table = ManoeuvreSpeeds::at(problem, grounds.unwrap_or(0.0));
    blocks.into_iter().filter_map(move |b| {
        let block = &land_obstacle.blocks()[b];
        let around = outer_simplified(block.initial(), problem.settings.graph.block_vertices);
        let open = |corner: Vector| {
            !land_obstacle
                .depth(corner)
                .is_some_and(|depth| depth > CORNER_M)
        };
        if !around.vertices().iter().any(|v| open(*v)) {
            return None;
        }
        let rest = ConvexPolygon::point(Vector::zeros());
        let body = PolytopeObstacle::new(LAND, around, rest);
        let proxy = Proxy::at_rest(problem.obstacles.len(), block);
        let mut speeds = vec![speed_table.normal, speed_table.fast];
        speeds.dedup();
        Some(TangentEdges::new(&proxy, &body, speeds.into_iter(), open))
    })
}
