//! A part of an obstacle that is convex in space-time, and when it is in force.
//!
//! A polytope and an ellipsoid are one part each, in force for ever. Velocity sets one after another are one
//! polytope per slab; its time counts from the slab's start. Every point of an obstacle up to the horizon is in
//! a part that is in force at its time, and in none else: to be clear of the parts is to be clear of the obstacle.

use crate::geometry::{ConvexPolygon, DISC_SIDES, Ellipse, outer_disc};
use crate::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle, SlabObstacle};

/// Metres. Sets narrower than twice this are grown by it.
const LEAST_RADIUS_M: f64 = 5e-4;

/// The graph aims at a polytope that contains the ellipsoid, unless that takes a greater factor than this: then at
/// one that does not, and what meets the ellipsoid is refused by the contact test.
const MOST_GROWTH: f64 = 2.0;

/// See the head of the file.
#[derive(Debug)]
pub(crate) struct Part {
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
pub(crate) fn parts(obstacles: &[Obstacle], horizon: f64) -> Vec<Part> {
    let mut parts = Vec::with_capacity(obstacles.len());
    for (obstacle, o) in obstacles.iter().enumerate() {
        let mut push = |window, body| {
            parts.push(Part {
                obstacle,
                window,
                body,
            });
        };
        match o {
            Obstacle::Polytope(polytope) => push(None, Body::Polytope(outer_widened(polytope))),
            Obstacle::Ellipsoid(ellipsoid) => push(None, rounded(ellipsoid, horizon)),
            Obstacle::Slabs(slabs) => {
                let slabs = outer_widened_slabs(slabs);
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
    parts
}

/// An outer approximation of a set without an interior: grown by [`LEAST_RADIUS_M`], so that touching it,
/// which is allowed, is not meeting it. `None` where it has one.
fn outer_grown(initial: &ConvexPolygon) -> Option<ConvexPolygon> {
    let narrow = initial
        .normals()
        .iter()
        .any(|n| initial.support(*n) + initial.support(-n) < 2.0 * LEAST_RADIUS_M);
    narrow.then(|| initial.minkowski_sum(&outer_disc(LEAST_RADIUS_M, 0.0)))
}

fn outer_widened(obstacle: &PolytopeObstacle) -> PolytopeObstacle {
    match outer_grown(obstacle.initial()) {
        Some(grown) => PolytopeObstacle::new(obstacle.name(), grown, obstacle.velocity().clone()),
        None => obstacle.clone(),
    }
}

fn outer_widened_slabs(obstacle: &SlabObstacle) -> SlabObstacle {
    outer_grown(obstacle.initial())
        .and_then(|grown| SlabObstacle::new("", grown, obstacle.spells().to_vec()).ok())
        .unwrap_or_else(|| obstacle.clone())
}

fn rounded(obstacle: &EllipsoidObstacle, horizon: f64) -> Body {
    if let Some(flat) = obstacle.flat() {
        return Body::Polytope(outer_widened(flat));
    }
    let [a, b] = obstacle.initial().semi_axes();
    let exact = if a.norm().min(b.norm()) < LEAST_RADIUS_M {
        let disc = outer_round(LEAST_RADIUS_M);
        let grown = EllipsoidObstacle::new("", *obstacle.initial(), disc).outer_section(1.0);
        EllipsoidObstacle::new("", grown, *obstacle.velocity())
    } else {
        obstacle.clone()
    };
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

fn outer_round(radius: f64) -> Ellipse {
    let axes = [
        crate::frame::Vector::new(radius, 0.0),
        crate::frame::Vector::new(0.0, radius),
    ];
    Ellipse::from_axes(crate::frame::Vector::zeros(), axes)
}
