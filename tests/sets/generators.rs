//! Random obstacles that favour degenerate sets: points, segments, collinear and repeated vertices,
//! singular matrices. `proptest` shrinks a case that fails.

use std::f64::consts::{PI, TAU};
use std::fmt::Debug;

use nalgebra::Matrix2;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use searoom::frame::{Pose, Vector, direction};
use searoom::geometry::{ConvexPolygon, ConvexSet, Ellipse};
use searoom::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle};
use searoom::target::{TimedVelocitySet, Uncertainty};
use searoom::trajectory::Segment;

/// Steps of shrinking at most; some questions take milliseconds.
const SHRINKING: u32 = 2_000;

/// Runs a test on `cases` values, always the same ones, and panics with the smallest value that
/// fails.
pub fn check<S>(seed: u64, cases: u32, values: S, test: impl Fn(S::Value))
where
    S: Strategy,
    S::Value: Debug,
{
    let mut runner = TestRunner::new(Config {
        cases,
        rng_seed: RngSeed::Fixed(seed),
        failure_persistence: None,
        max_shrink_iters: SHRINKING,
        ..Config::default()
    });
    let result = runner.run(&values, |value| {
        test(value);
        Ok(())
    });
    if let Err(error) = result {
        panic!("seed {seed}: {error}");
    }
}

pub fn vector(scale: f64) -> impl Strategy<Value = Vector> + Clone {
    (-scale..scale, -scale..scale).prop_map(|(x, y)| Vector::new(x, y))
}

pub fn angle() -> impl Strategy<Value = f64> + Clone {
    -PI..PI
}

/// Points of a set within about `scale` of a random place within `scale`.
pub fn points(scale: f64) -> impl Strategy<Value = Vec<Vector>> {
    let (base, along) = (vector(scale), vector(scale));
    let grid = vector(2.0).prop_map(move |p| p.map(f64::round) * (scale / 4.0));
    let offsets = prop_oneof![
        1 => Just(vec![Vector::zeros()]),
        1 => along.clone().prop_map(|a| vec![Vector::zeros(), a]),
        // collinear
        1 => along.clone().prop_map(|a| (0..4).map(|i| a * (f64::from(i) / 4.0)).collect()),
        // on a coarse grid, with repetitions
        1 => vec(grid, 1..9),
        // thin
        1 => (along, vector(scale * 1e-4)).prop_map(|(a, b)| vec![Vector::zeros(), a, a + b, b]),
        3 => vec(vector(scale), 3..9),
    ];
    (base, offsets).prop_map(|(base, offsets)| offsets.iter().map(|p| base + p).collect())
}

pub fn hull(points: &[Vector]) -> ConvexPolygon {
    ConvexPolygon::hull(points).expect("finite")
}

pub fn polygon(scale: f64) -> impl Strategy<Value = ConvexPolygon> {
    points(scale).prop_map(|points| hull(&points))
}

pub fn ellipse(scale: f64) -> impl Strategy<Value = Ellipse> {
    let axes = (vector(scale), vector(scale));
    let square = |a: Vector| a * a.transpose();
    let shape = prop_oneof![
        1 => Just(Matrix2::zeros()),
        1 => vector(scale).prop_map(square),
        1 => Just(Matrix2::identity() * scale),
        1 => axes.clone().prop_map(move |(a, b)| square(a) + square(b) * 1e-8),
        2 => axes.prop_map(move |(a, b)| square(a) + square(b)),
    ];
    (vector(scale), shape).prop_map(|(center, q)| Ellipse::new(center, q).expect("a shape"))
}

pub fn disc(center: Vector, radius: f64) -> Ellipse {
    Ellipse::new(center, Matrix2::identity() * radius * radius).expect("a disc")
}

pub fn polytope() -> impl Strategy<Value = PolytopeObstacle> {
    let sets = (polygon(60.0), polygon(2.0));
    sets.prop_map(|(initial, velocity)| PolytopeObstacle::new("polytope", initial, velocity))
}

pub fn ellipsoid() -> impl Strategy<Value = EllipsoidObstacle> {
    let sets = (ellipse(60.0), ellipse(2.0));
    sets.prop_map(|(initial, velocity)| EllipsoidObstacle::new("ellipsoid", initial, velocity))
}

pub fn slabs() -> impl Strategy<Value = Obstacle> {
    (polygon(60.0), vec((1.0..40.0, polygon(2.0)), 1..5)).prop_map(in_sequence)
}

/// A sequence of velocity ellipses.
pub fn round_slabs() -> impl Strategy<Value = Obstacle> {
    (ellipse(60.0), vec((1.0..40.0, ellipse(2.0)), 2..5)).prop_map(in_sequence)
}

/// Sets with the duration of each velocity set.
fn in_sequence<S: Into<ConvexSet>>((initial, slabs): (S, Vec<(f64, S)>)) -> Obstacle {
    let mut until = 0.0;
    let timed = slabs.into_iter().map(|(duration, velocities)| {
        until += duration;
        TimedVelocitySet::new(until, velocities)
    });
    Obstacle::new("slabs", Uncertainty::new(initial, timed.collect())).expect("increasing")
}

/// Support of the exact sum `O_0 ⊕ t V` of two ellipses.
pub fn sum_support(o: &EllipsoidObstacle, n: Vector, t: f64) -> f64 {
    n.dot(&o.center(t)) + o.initial().radius(n) + t * o.velocity().radius(n)
}

/// An obstacle of any kind but changing ellipses.
pub fn obstacle() -> impl Strategy<Value = Obstacle> {
    prop_oneof![
        polytope().prop_map(Obstacle::from),
        ellipsoid().prop_map(Obstacle::from),
        slabs(),
    ]
}

/// A line of some hundred metres.
pub fn line() -> impl Strategy<Value = Segment> {
    let start = (vector(200.0), -3.2..3.2);
    let start_time = prop_oneof![Just(0.0), 0.0..40.0];
    (start, start_time, 1.0..120.0, 0.5..8.0).prop_map(|(start, start_time, duration, speed)| {
        Segment::straight(Pose::new(start.0, start.1), start_time, duration, speed)
    })
}

pub fn arc() -> impl Strategy<Value = Segment> {
    (line(), 20.0..150.0, select(vec![1.0, -1.0])).prop_map(|(line, radius, side)| Segment {
        turn_rate: side * line.speed / radius,
        ..line
    })
}

/// A line or an arc.
pub fn segment() -> impl Strategy<Value = Segment> {
    prop_oneof![line().boxed(), arc().boxed()]
}

/// Unit vectors all around.
pub fn directions(count: u32) -> impl Iterator<Item = Vector> {
    (0..count).map(move |i| direction(TAU * f64::from(i) / f64::from(count)))
}

/// Counts how often cases of a kind occur, so that a test does not hold of nothing.
#[derive(Default)]
pub struct Counter(std::cell::Cell<usize>);

impl Counter {
    pub fn add(&self, holds: bool) {
        self.0.set(self.0.get() + usize::from(holds));
    }

    pub fn count(&self) -> usize {
        self.0.get()
    }

    pub fn assert_above(&self, least: usize) {
        let found = self.count();
        assert!(found > least, "{found} cases of more than {least}");
    }
}

/// Where a function with one maximum is largest, by golden section.
pub fn golden_maximum(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let (a, b) = (low + (high - low) * 0.382, low + (high - low) * 0.618);
        if of(a) > of(b) {
            high = b;
        } else {
            low = a;
        }
    }
    0.5 * (low + high)
}
