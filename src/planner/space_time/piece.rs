//! Convex piece: a part of an obstacle that is convex in space-time, with its time window.
//!
//! A polytope and an ellipsoid are one piece each, without a window. Consecutive velocity sets give
//! one piece per slab, whose time counts from the slab's start. Until the horizon, the union of
//! the pieces that exist at a time is the obstacle's section. The only exceptions are pieces
//! without an interior, which are enlarged. A motion that is clear of the pieces is clear of the
//! obstacle.

use crate::geometry::{DISC_SIDES, Ellipse};
use crate::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle};

/// The graph uses a polytope that contains the ellipsoid, unless that needs a larger factor than
/// this. Then it uses one that does not; the contact test rejects motions that meet the ellipsoid.
const MAX_GROWTH: f64 = 2.0;

/// Convex piece of an obstacle.
#[derive(Debug)]
pub(crate) struct Piece {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Time window; `None` for ever.
    pub window: Option<Window>,
    pub body: Body,
}

/// Time window, seconds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    pub start: f64,
    pub end: f64,
}

/// Shape of a convex piece.
#[derive(Debug)]
pub(crate) enum Body {
    Polytope(PolytopeObstacle),
    Ellipsoid(Box<BoundedEllipsoid>),
}

/// Ellipsoid with a polytope around it.
#[derive(Debug)]
pub(crate) struct BoundedEllipsoid {
    pub exact: EllipsoidObstacle,
    /// Outer polytope: two 16-gons around its sets, enlarged by the excess of the ellipsoid over
    /// their sum.
    pub around: PolytopeObstacle,
}

/// Convex pieces of all obstacles until the horizon, in their order.
pub(crate) fn pieces(obstacles: &[Obstacle], horizon: f64) -> Vec<Piece> {
    let mut pieces = Vec::with_capacity(obstacles.len());
    for (obstacle, o) in obstacles.iter().enumerate() {
        let mut push = |window, body| {
            pieces.push(Piece {
                obstacle,
                window,
                body,
            });
        };
        match o.outer_with_interior() {
            Obstacle::Slabs(slabs) => {
                for slab in slabs.slabs() {
                    let window = (slabs.slabs().len() > 1).then_some(Window {
                        start: slab.start(),
                        end: slab.end(),
                    });
                    if slab.start() <= horizon
                        && let Some(body) = body(slab.obstacle().clone(), horizon - slab.start())
                    {
                        push(window, body);
                    }
                }
            }
            whole => {
                if let Some(body) = body(whole, horizon) {
                    push(None, body);
                }
            }
        }
    }
    pieces
}

/// The body of an obstacle that is convex in space-time, until a horizon; `None` for slabs.
fn body(obstacle: Obstacle, horizon: f64) -> Option<Body> {
    match obstacle {
        Obstacle::Polytope(polytope) => Some(Body::Polytope(polytope)),
        Obstacle::Ellipsoid(ellipsoid) => Some(bounded_ellipsoid(*ellipsoid, horizon)),
        Obstacle::Slabs(_) => None,
    }
}

fn bounded_ellipsoid(exact: EllipsoidObstacle, horizon: f64) -> Body {
    let growth = exact.largest_ratio_to_sum(horizon).min(MAX_GROWTH);
    let around = |e: &Ellipse| e.scaled_about_center(growth).outer_polygon(DISC_SIDES);
    Body::Ellipsoid(Box::new(BoundedEllipsoid {
        around: PolytopeObstacle::new("", around(exact.initial()), around(exact.velocity())),
        exact,
    }))
}
