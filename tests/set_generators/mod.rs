//! Random obstacles that favour degenerate sets: points, segments, collinear and repeated vertices,
//! singular matrices.
#![allow(dead_code, reason = "every test file uses a part")]

use nalgebra::Matrix2;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Pose, Vector, direction};
use searoom::geometry::{ConvexPolygon, Ellipse};
use searoom::obstacle::{EllipsoidObstacle, PolytopeObstacle, SlabObstacle};
use searoom::target::{TimedVelocitySet, Uncertainty};
use searoom::trajectory::Segment;

/// The generator of one test; `SEAROOM_SEED` gives other cases.
pub fn seeded(seed: u64) -> ChaCha8Rng {
    let other: u64 = std::env::var("SEAROOM_SEED")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(0);
    ChaCha8Rng::seed_from_u64(seed.wrapping_add(other.wrapping_mul(1000)))
}

pub fn vector(rng: &mut ChaCha8Rng, scale: f64) -> Vector {
    Vector::new(
        rng.random_range(-scale..scale),
        rng.random_range(-scale..scale),
    )
}

/// Points of a set within about `scale` of a random place within `scale`.
pub fn points(rng: &mut ChaCha8Rng, scale: f64) -> Vec<Vector> {
    let base = vector(rng, scale);
    match rng.random_range(0..8) {
        0 => vec![base],
        1 => vec![base, base + vector(rng, scale)],
        2 => {
            // collinear
            let along = vector(rng, scale);
            (0..4)
                .map(|i| base + along * (f64::from(i) / 4.0))
                .collect()
        }
        3 => {
            // on a coarse grid, with repetitions
            let n = rng.random_range(1..9);
            (0..n)
                .map(|_| base + vector(rng, 2.0).map(f64::round) * (scale / 4.0))
                .collect()
        }
        4 => {
            // thin
            let (along, across) = (vector(rng, scale), vector(rng, scale * 1e-4));
            vec![base, base + along, base + along + across, base + across]
        }
        _ => {
            let n = rng.random_range(3..9);
            (0..n).map(|_| base + vector(rng, scale)).collect()
        }
    }
}

pub fn polygon(rng: &mut ChaCha8Rng, scale: f64) -> ConvexPolygon {
    ConvexPolygon::hull(&points(rng, scale)).expect("finite")
}

pub fn ellipse(rng: &mut ChaCha8Rng, scale: f64) -> Ellipse {
    let (a, b) = (vector(rng, scale), vector(rng, scale));
    let shape = match rng.random_range(0..6) {
        0 => Matrix2::zeros(),
        1 => a * a.transpose(),
        2 => Matrix2::identity() * scale,
        3 => a * a.transpose() + b * b.transpose() * 1e-8,
        _ => a * a.transpose() + b * b.transpose(),
    };
    Ellipse::new(vector(rng, scale), shape).expect("a shape")
}

pub fn polytope(rng: &mut ChaCha8Rng) -> PolytopeObstacle {
    PolytopeObstacle::new("polytope", polygon(rng, 60.0), polygon(rng, 2.0))
}

pub fn ellipsoid(rng: &mut ChaCha8Rng) -> EllipsoidObstacle {
    EllipsoidObstacle::new("ellipsoid", ellipse(rng, 60.0), ellipse(rng, 2.0))
}

pub fn slabs(rng: &mut ChaCha8Rng) -> SlabObstacle {
    let mut until = 0.0;
    let timed = (0..rng.random_range(1..5))
        .map(|_| {
            until += rng.random_range(1.0..40.0);
            TimedVelocitySet::new(until, polygon(rng, 2.0))
        })
        .collect();
    let sets = Uncertainty::new(polygon(rng, 60.0), timed);
    SlabObstacle::new("slabs", sets).expect("increasing")
}

/// A line or an arc, of some hundred metres.
pub fn segment(rng: &mut ChaCha8Rng, bent: bool) -> Segment {
    let speed = rng.random_range(0.5..8.0);
    let radius = rng.random_range(20.0..150.0) * if rng.random_bool(0.5) { 1.0 } else { -1.0 };
    Segment {
        start: Pose::new(vector(rng, 200.0), rng.random_range(-3.2..3.2)),
        start_time: rng.random_range(0.0..40.0) * f64::from(rng.random_range(0..2)),
        duration: rng.random_range(1.0..120.0),
        speed,
        turn_rate: if bent { speed / radius } else { 0.0 },
    }
}

/// Unit vectors all around.
pub fn directions(count: u32) -> impl Iterator<Item = Vector> {
    (0..count).map(move |i| direction(std::f64::consts::TAU * f64::from(i) / f64::from(count)))
}
