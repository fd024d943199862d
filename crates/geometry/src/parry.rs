//! The bridge to `parry`, and the only place that names it: distances between convex sets by the
//! algorithm of Gilbert, Johnson and Keerthi (doi:10.1109/56.2083), and trees of boxes and edges.

use std::cell::Cell;

use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::math::{Pose, Vector as Point};
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use parry2d_f64::query::gjk::{CsoPoint, GJKResult, VoronoiSimplex, closest_points};
use parry2d_f64::query::{PointQuery, PointQueryWithLocation};
use parry2d_f64::shape::{Polyline, SupportMap};

use super::Window;
use crate::frame::Vector;

fn point(v: Vector) -> Point {
    Point::new(v.x, v.y)
}

fn vector(p: Point) -> Vector {
    Vector::new(p.x, p.y)
}

/// Units of parry in a metre. It takes two points for one that are nearer than 5e-8 units: a power
/// of two, so that nothing is rounded.
const UNITS: f64 = 1_048_576.0;

/// parry tells no more than this share of the largest coordinate: the root of ten roundings, by
/// which it also ends.
const RESOLUTION: f64 = 5e-8;

/// Steps of the algorithm after parry's own end.
const MORE_STEPS: usize = 8;

/// A convex set given by its farthest point in a direction.
struct Farthest<F> {
    point: F,
    /// The largest coordinate so far; a NaN where a point was no number, which the library asserts.
    largest: Cell<f64>,
}

impl<F: Fn(Vector) -> Vector> Farthest<F> {
    fn new(point: F) -> Self {
        let largest = Cell::new(0.0);
        Self { point, largest }
    }
}

impl<F: Fn(Vector) -> Vector> SupportMap for Farthest<F> {
    fn local_support_point(&self, direction: Point) -> Point {
        let found = (self.point)(vector(direction));
        let size = found.x.abs() + found.y.abs();
        if !size.is_finite() {
            self.largest.set(f64::NAN);
            return Point::ZERO;
        }
        // negated on purpose: a NaN stays
        if !(size <= self.largest.get()) && !self.largest.get().is_nan() {
            self.largest.set(size);
        }
        point(found * UNITS)
    }
}

/// The way between two convex sets.
#[derive(Debug, Clone, Copy)]
pub struct Between {
    /// From the one to the other; zero where they touch or overlap. The ends lie in the sets, so it
    /// is never shorter than the distance.
    pub shortest: Vector,
    /// Metres: sets this near may count as touching.
    pub resolution: f64,
}

/// The shortest vector from one convex set to another, each given by its farthest point in a
/// direction; `None` where it is not found. `toward` is a first guess of the vector's direction.
/// Parry's end leaves a share of the distance open, so the algorithm is taken on to the end of its
/// steps. About five farthest points of each.
pub fn shortest_between(
    from: impl Fn(Vector) -> Vector,
    to: impl Fn(Vector) -> Vector,
    toward: Vector,
) -> Option<Between> {
    let (from, to) = (Farthest::new(from), Farthest::new(to));
    let here = Pose::identity();
    let farthest = |direction: Point| CsoPoint::from_shapes(&here, &from, &to, direction);
    let mut simplex = VoronoiSimplex::new();
    simplex.reset(farthest(point(toward).try_normalize().unwrap_or(Point::X)));
    // of the points of `from - to` the nearest to the origin
    let mut nearest = match closest_points(&here, &from, &to, f64::MAX, true, &mut simplex) {
        GJKResult::Intersection => Point::ZERO,
        GJKResult::ClosestPoints(a, b, _) => a - b,
        // the first is the answer after too many steps
        GJKResult::NoIntersection(_) | GJKResult::Proximity(_) => return None,
    };
    for _ in 0..MORE_STEPS {
        let Some(direction) = (-nearest).try_normalize() else {
            break;
        };
        let next = farthest(direction);
        let proven = -direction.dot(next.point);
        let done = proven >= nearest.length() * (1.0 - 4.0 * f64::EPSILON);
        if done || simplex.dimension() > 1 || !simplex.add_point(next) {
            break;
        }
        let found = simplex.project_origin_and_reduce();
        // a simplex with the origin inside, but for rounding, tells no more
        if simplex.dimension() > 1 || !(found.length() < nearest.length()) {
            break;
        }
        nearest = found;
    }
    let largest = from.largest.get() + to.largest.get();
    (!largest.is_nan()).then(|| Between {
        shortest: vector(-nearest) / UNITS,
        resolution: RESOLUTION * largest,
    })
}

fn boxed(window: &Window) -> Aabb {
    Aabb::new(point(window.low), point(window.high))
}

/// Which of many boxes meet a box: a bounding volume hierarchy, built in O(n log n).
#[derive(Debug, Clone)]
pub struct BoxIndex {
    tree: Bvh,
}

impl BoxIndex {
    /// Builds the index of boxes numbered from 0.
    pub fn new(boxes: impl IntoIterator<Item = Window>) -> Self {
        let boxes = boxes.into_iter().map(|window| boxed(&window)).enumerate();
        Self {
            tree: Bvh::from_iter(BvhBuildStrategy::Binned, boxes),
        }
    }

    /// The boxes that meet a window, touching included, in no order. O(log n + found).
    pub fn meeting<'a>(&'a self, window: &Window) -> impl Iterator<Item = usize> + use<'a> {
        meeting(&self.tree, window)
    }
}

fn meeting<'a>(tree: &'a Bvh, window: &Window) -> impl Iterator<Item = usize> + use<'a> {
    let window = BvhNode::leaf(boxed(window), 0);
    tree.leaves(move |node| node.intersects(&window))
        .map(|index| index as usize)
}

/// An edge near a point.
#[derive(Debug, Clone, Copy)]
pub struct NearEdge {
    /// Counts from 0.
    pub index: usize,
    /// Metres.
    pub distance: f64,
}

/// Edges, by place: a polyline that need not hang together.
#[derive(Clone)]
pub struct EdgeTree {
    edges: Polyline,
}

impl EdgeTree {
    /// Builds the tree of edges numbered from 0, in O(n log n).
    pub fn new(edges: impl Iterator<Item = (Vector, Vector)>) -> Self {
        let ends: Vec<Point> = edges.flat_map(|(a, b)| [point(a), point(b)]).collect();
        let pairs = (0..ends.len() as u32 / 2).map(|k| [2 * k, 2 * k + 1]);
        let pairs = pairs.collect();
        Self {
            edges: Polyline::new(ends, Some(pairs)),
        }
    }

    /// An edge.
    pub fn edge(&self, index: usize) -> (Vector, Vector) {
        let segment = self.edges.segment(index as u32);
        (vector(segment.a), vector(segment.b))
    }

    /// The edge nearest to a point that is a number; `None` without edges. O(log n).
    pub fn nearest(&self, p: Vector) -> Option<NearEdge> {
        let p = point(p);
        let found = self.edges.bvh().project_point(p, f64::MAX, |index, _| {
            Some(self.edges.segment(index).project_local_point(p, true))
        });
        found.map(|(index, (distance, _))| NearEdge {
            index: index as usize,
            distance,
        })
    }

    /// The edges within a distance of a point, in no order. O(log n + found).
    pub fn within(&self, p: Vector, reach: f64) -> impl Iterator<Item = NearEdge> + use<'_> {
        let near = meeting(self.edges.bvh(), &Window::at(p).grown(reach));
        near.map(move |index| {
            let segment = self.edges.segment(index as u32);
            let (found, _) = segment.project_local_point_and_get_location(point(p), true);
            NearEdge {
                index,
                distance: found.point.distance(point(p)),
            }
        })
    }
}

#[cfg(test)]
mod tests;
