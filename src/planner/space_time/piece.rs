//! A part of an obstacle that is convex in space-time, and when it is in force.
//!
//! A polytope and an ellipsoid are one part each, in force for ever. Velocity sets one after another are one
//! polytope per slab; its time counts from the slab's start. Every point of an obstacle up to the horizon is in
//! a part that is in force at its time, and in none else, but that those without an interior are grown: to be clear of
//! the parts is to be clear of the obstacle.

use crate::geometry::{ConvexPolygon, DISC_SIDES, Ellipse};
use crate::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle};

/// The graph aims at a polytope that contains the ellipsoid, unless that takes a greater factor than this: then at
/// one that does not, and what meets the ellipsoid is refused by the contact test.
const MOST_GROWTH: f64 = 2.0;

/// See the head of the file.
#[derive(Debug)]
pub(crate) struct Piece {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Until when it is in force, and since when: `None` for ever.
    pub window: Option<Window>,
    pub body: Body,
}

/// Seconds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    pub start: f64,
    pub end: f64,
}

/// What a part is made of.
#[derive(Debug)]
pub(crate) enum Body {
    Polytope(PolytopeObstacle),
    Ellipsoid(Box<Rounded>),
}

/// An ellipsoid between two polytopes.
#[derive(Debug)]
pub(crate) struct Rounded {
    pub exact: EllipsoidObstacle,
    /// Two 16-gons around its sets, grown by what the ellipsoid exceeds their sum.
    pub around: PolytopeObstacle,
    /// Two polygons of 16 points of the edges of its sets: within the sum, which is within the ellipsoid.
    pub within: PolytopeObstacle,
}

/// The parts of all obstacles until the horizon, in their order.
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
            Obstacle::Polytope(polytope) => push(None, Body::Polytope(polytope)),
            Obstacle::Ellipsoid(ellipsoid) => push(None, rounded(*ellipsoid, horizon)),
            Obstacle::Slabs(slabs) => {
                for slab in slabs.slabs() {
                    let window = (slabs.slabs().len() > 1).then_some(Window {
                        start: slab.start(),
                        end: slab.end(),
                    });
                    if slab.start() <= horizon {
                        push(window, Body::Polytope(slab.obstacle().clone()));
                    }
                }
            }
        }
    }
    pieces
}

fn rounded(exact: EllipsoidObstacle, horizon: f64) -> Body {
    let growth = exact.largest_ratio_to_sum(horizon).min(MOST_GROWTH);
    let around = |e: &Ellipse| e.scaled_about_center(growth).outer_polygon(DISC_SIDES);
    let within = |e: &Ellipse| {
        // points of a finite ellipse are finite
        ConvexPolygon::hull(&e.sampled_boundary(DISC_SIDES))
            .unwrap_or_else(|_| ConvexPolygon::point(e.center()))
    };
    let polytope = |set: &dyn Fn(&Ellipse) -> ConvexPolygon| {
        PolytopeObstacle::new("", set(exact.initial()), set(exact.velocity()))
    };
    Body::Ellipsoid(Box::new(Rounded {
        around: polytope(&around),
        within: polytope(&within),
        exact,
    }))
}
