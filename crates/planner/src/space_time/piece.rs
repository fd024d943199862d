//! Convex piece: a part of an obstacle that is convex in space-time, with its time window.
//!
//! Each slab of an obstacle is one piece, with a time window where there are several; its time
//! counts from the slab's start. Until the horizon, the union of the pieces that exist at a time is
//! the obstacle's section. The only exceptions are pieces without an interior, which are enlarged.
//! A motion that is clear of the pieces is clear of the obstacle.

use searoom_geometry::{DISC_SIDES, Ellipse};
use searoom_sets::contact::Interval;
use searoom_sets::{ConvexObstacle, EllipsoidObstacle, Obstacle, PolytopeObstacle};

/// The graph uses a polytope that contains the ellipsoid, unless that needs a larger factor than
/// this. Then it uses one that does not; the contact test rejects motions that meet the ellipsoid.
const MAX_GROWTH: f64 = 2.0;

/// Convex piece of an obstacle.
#[derive(Debug)]
pub(crate) struct Piece {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Time window; `None` for ever.
    pub window: Option<Interval>,
    /// The polytope, or two 16-gons around the sets of the ellipsoid, enlarged by its excess over
    /// their sum.
    pub body: PolytopeObstacle,
    /// The ellipsoid, where it is one.
    pub ellipsoid: Option<EllipsoidObstacle>,
}

/// Convex pieces of all obstacles until the horizon, in their order.
pub(crate) fn pieces(obstacles: &[Obstacle], horizon: f64) -> Vec<Piece> {
    let mut pieces = Vec::with_capacity(obstacles.len());
    for (obstacle, whole) in obstacles.iter().enumerate() {
        let whole = whole.outer_with_interior();
        let several = whole.slabs().len() > 1;
        let slabs = whole.slabs().iter();
        let until_horizon = slabs.filter(|slab| slab.start() <= horizon.max(0.0));
        pieces.extend(until_horizon.map(|slab| {
            let (body, ellipsoid) = match slab.obstacle() {
                ConvexObstacle::Polytope(polytope) => (polytope.clone(), None),
                ConvexObstacle::Ellipsoid(ellipsoid) => (
                    outer_polytope(ellipsoid, horizon - slab.start()),
                    Some(ellipsoid.as_ref().clone()),
                ),
            };
            Piece {
                obstacle,
                window: several.then_some(Interval {
                    start: slab.start(),
                    end: slab.end(),
                }),
                body,
                ellipsoid,
            }
        }));
    }
    pieces
}

fn outer_polytope(ellipsoid: &EllipsoidObstacle, horizon: f64) -> PolytopeObstacle {
    let growth = ellipsoid.largest_ratio_to_sum(horizon).min(MAX_GROWTH);
    let around = |e: &Ellipse| e.scaled_about_center(growth).outer_polygon(DISC_SIDES);
    PolytopeObstacle::new(
        "",
        around(ellipsoid.initial()),
        around(ellipsoid.velocity()),
    )
}
