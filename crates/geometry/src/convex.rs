//! Convex polygons, including points (one vertex) and segments (two).

use super::boxes::clipped;
use super::{Window, rounded};
use crate::frame::{Vector, cross, to_starboard};
use crate::tolerance;

/// Why points are not a convex polygon.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// No points.
    #[error("no vertices; at least one is needed")]
    Empty,
    /// A coordinate that is not finite, or whose fourth power is not.
    #[error("vertex {index} is not finite")]
    NotFinite {
        /// Index of the vertex, from 0.
        index: usize,
    },
    /// A vertex lies inside the hull of the others.
    #[error("vertex {index} inside the hull of the others, {:?} deep", rounded(*depth))]
    NotConvex {
        /// Index of the vertex, from 0.
        index: usize,
        /// Depth in the unit of the coordinates.
        depth: f64,
    },
}

/// Largest coordinate with a finite fourth power.
const LARGEST: f64 = 1e75;

/// A convex polygon with counter-clockwise vertices, none repeated and none on the line through its
/// neighbours. One vertex is a point, two are a segment.
///
/// The set is defined by its support function `h(n) = max n . p`; membership, half-spaces and sums
/// follow.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvexPolygon {
    vertices: Vec<Vector>,
}

impl ConvexPolygon {
    /// The convex hull of a non-empty set of finite points, in O(n log n).
    ///
    /// Points closer than [`tolerance::DUPLICATE`] of the extent are merged. A hull thinner than
    /// [`tolerance::THIN`] of it is a segment. Vertices are dropped by their turn angle, so that
    /// genuine short edges remain.
    pub fn hull(points: &[Vector]) -> Result<Self, GeometryError> {
        if points.is_empty() {
            return Err(GeometryError::Empty);
        }
        // negated so that a NaN is rejected
        let too_large = |p: &Vector| !(p.x.abs() <= LARGEST && p.y.abs() <= LARGEST);
        if let Some(index) = points.iter().position(too_large) {
            return Err(GeometryError::NotFinite { index });
        }
        let mut sorted = unsigned_zeros(points);
        sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let extent = extent(&sorted);
        sorted.dedup_by(|a, b| (*a - *b).norm() <= tolerance::DUPLICATE * extent);
        let mut chain: Vec<Vector> = Vec::with_capacity(2 * sorted.len());
        for half in 0..2 {
            let start = chain.len();
            let mut push = |p: Vector| {
                while chain.len() >= start + 2
                    && cross(
                        chain[chain.len() - 1] - chain[chain.len() - 2],
                        p - chain[chain.len() - 2],
                    ) <= 0.0
                {
                    chain.pop();
                }
                chain.push(p);
            };
            if half == 0 {
                sorted.iter().for_each(|p| push(*p));
            } else {
                sorted.iter().rev().for_each(|p| push(*p));
            }
            chain.pop();
        }
        if chain.is_empty() {
            chain.push(sorted[0]);
        }
        Ok(Self::from_ccw(chain))
    }

    /// A polygon from vertices that must all lie on its boundary, in either orientation.
    ///
    /// Duplicates and points on an edge are accepted; a vertex inside is an error. For vertices
    /// written by a user.
    pub fn from_vertices(points: &[Vector]) -> Result<Self, GeometryError> {
        let hull = Self::hull(points)?;
        let farthest = points.iter().map(|p| p.amax()).fold(0.0, f64::max);
        let limit = 1e-9 * extent(points) + 2.0 * f64::EPSILON * farthest;
        let by_place = |a: &Vector, b: &Vector| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y));
        let mut corners = hull.vertices.clone();
        corners.sort_by(by_place);
        for (index, p) in unsigned_zeros(points).iter().enumerate() {
            // most given points are corners
            if corners.binary_search_by(|c| by_place(c, p)).is_ok() {
                continue;
            }
            let depth = -hull.signed_distance(*p);
            if depth > limit {
                return Err(GeometryError::NotConvex { index, depth });
            }
        }
        Ok(hull)
    }

    /// A single point.
    pub fn point(p: Vector) -> Self {
        Self { vertices: vec![p] }
    }

    /// The rectangle about a centre, with these half-widths east and north.
    pub fn rectangle(center: Vector, east: f64, north: f64) -> Self {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corners = corners.map(|(x, y)| center + Vector::new(x * east, y * north));
        Self::from_ccw(corners.to_vec())
    }

    /// A polygon from the counter-clockwise boundary of a convex set.
    ///
    /// Removes duplicates, collinear vertices and slivers. Never panics; an empty list gives the
    /// origin.
    pub fn from_ccw(points: Vec<Vector>) -> Self {
        let mut v = unsigned_zeros(&points);
        let extent = extent(&v);
        v.dedup_by(|a, b| (*a - *b).norm() <= tolerance::DUPLICATE * extent);
        while v.len() > 1 && (v[0] - v[v.len() - 1]).norm() <= tolerance::DUPLICATE * extent {
            v.pop();
        }
        // remove vertices by turn angle until none is left to remove
        let mut i = 0;
        let mut kept = 0;
        while v.len() > 2 && kept < v.len() {
            let last = v.len() - 1;
            let before = if i > 0 { i - 1 } else { last };
            let after = if i < last { i + 1 } else { 0 };
            let (e, f) = (v[i] - v[before], v[after] - v[i]);
            if cross(e, f) <= tolerance::COLLINEAR_RAD * e.norm() * f.norm() && e.dot(&f) > 0.0 {
                v.remove(i);
                kept = 0;
                i %= last;
            } else {
                i = after;
                kept += 1;
            }
        }
        if v.len() > 2 && !is_wide(&v, extent) {
            let (a, b) = farthest_pair(&v);
            let axis = (b - a) / (b - a).norm();
            let (mut low, mut high) = (0.0_f64, 0.0_f64);
            for p in &v {
                let d = cross(axis, p - a);
                low = low.min(d);
                high = high.max(d);
            }
            if high - low <= tolerance::THIN * extent {
                v = vec![a, b];
            }
        }
        if v.is_empty() {
            v.push(Vector::zeros());
        }
        Self::from_lowest(v)
    }

    /// Counter-clockwise vertices, lowest first.
    pub fn vertices(&self) -> &[Vector] {
        &self.vertices
    }

    /// `h(n) = max over the set of n . p`. O(vertices).
    pub fn support(&self, n: Vector) -> f64 {
        self.vertices
            .iter()
            .map(|p| n.dot(p))
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The farthest vertices in directions sorted counter-clockwise with gaps of at most half a
    /// turn. O(vertices + directions).
    pub fn extremes<'a>(&'a self, directions: &'a [Vector]) -> impl Iterator<Item = Vector> + 'a {
        self.farthest(directions).map(|index| self.vertices[index])
    }

    /// Indices of [`Self::extremes`].
    ///
    /// Directions of lengths up to 2. The farthest vertices are sorted likewise, so each search
    /// starts at the last result. It goes on past vertices that are lower by no more than rounding,
    /// which grows with the distance from the origin.
    pub fn farthest<'a>(&'a self, directions: &'a [Vector]) -> impl Iterator<Item = usize> + 'a {
        let vertices = &self.vertices;
        let count = vertices.len();
        let rounding = 16.0 * f64::EPSILON * self.reach();
        let mut at = 0;
        if let Some(along) = directions.first() {
            for (index, p) in vertices.iter().enumerate() {
                if along.dot(p) > along.dot(&vertices[at]) {
                    at = index;
                }
            }
        }
        directions.iter().map(move |along| {
            let (mut next, mut most) = (at, along.dot(&vertices[at]));
            for _ in 1..count {
                next = if next + 1 < count { next + 1 } else { 0 };
                let reach = along.dot(&vertices[next]);
                if reach > most {
                    (at, most) = (next, reach);
                } else if reach < most - rounding {
                    break;
                }
            }
            at
        })
    }

    /// Supports in the directions of [`Self::extremes`].
    pub fn supports(&self, directions: &[Vector]) -> Vec<f64> {
        let farthest = self.extremes(directions).zip(directions);
        farthest.map(|(p, along)| along.dot(&p)).collect()
    }

    /// An upper bound of the diameter, at most twice as large.
    pub fn across(&self) -> f64 {
        2.0 * self.translated(-self.vertices[0]).reach()
    }

    /// Outward unit normals of half-spaces whose intersection is the set.
    ///
    /// One per edge; for a segment both perpendiculars and both ends; for a point the four axes.
    pub fn normals(&self) -> Vec<Vector> {
        match self.vertices.as_slice() {
            [_] => vec![
                Vector::new(1.0, 0.0),
                Vector::new(0.0, 1.0),
                Vector::new(-1.0, 0.0),
                Vector::new(0.0, -1.0),
            ],
            [a, b] => {
                let along = (b - a).normalize();
                let across = to_starboard(along);
                vec![along, across, -along, -across]
            }
            _ => self
                .edges()
                .map(|(a, b)| to_starboard(b - a).normalize())
                .collect(),
        }
    }

    /// Directed edges, counter-clockwise; a segment has one in each direction, a point has none.
    pub fn edges(&self) -> impl Iterator<Item = (Vector, Vector)> + '_ {
        let n = if self.vertices.len() < 2 {
            0
        } else {
            self.vertices.len()
        };
        (0..n).map(move |i| (self.vertices[i], self.vertices[(i + 1) % n]))
    }

    /// The Minkowski sum `{a + b}`, by merging the edges by angle, in O(n + m).
    pub fn minkowski_sum(&self, other: &Self) -> Self {
        let edges = |p: &Self| p.edges().map(|(a, b)| b - a).collect::<Vec<_>>();
        let (left, right) = (edges(self), edges(other));
        let mut at = self.vertices[0] + other.vertices[0];
        let mut points = Vec::with_capacity(left.len() + right.len() + 1);
        points.push(at);
        let (mut i, mut j) = (0, 0);
        while i < left.len() || j < right.len() {
            let take_left = j == right.len()
                || (i < left.len()
                    && half_plane_then_cross(left[i], right[j]) != std::cmp::Ordering::Greater);
            let step = if take_left {
                i += 1;
                left[i - 1]
            } else {
                j += 1;
                right[j - 1]
            };
            at += step;
            points.push(at);
        }
        points.pop_if(|_| left.len() + right.len() > 0);
        Self::from_ccw(points)
    }

    /// The set translated by `shift`. Vertices that coincide after rounding are merged.
    pub fn translated(&self, shift: Vector) -> Self {
        let vertices: Vec<Vector> = self.vertices.iter().map(|p| p + shift).collect();
        let next = vertices.iter().cycle().skip(1);
        if vertices.len() > 1 && vertices.iter().zip(next).any(|(a, b)| a == b) {
            return Self::from_ccw(vertices);
        }
        Self::from_lowest(vertices)
    }

    /// Starts with the lowest, then leftmost vertex: a polygon has one representation, and its
    /// edges are in order of their angle, as [`Self::minkowski_sum`] requires.
    fn from_lowest(mut vertices: Vec<Vector>) -> Self {
        let by_place = |a: &Vector, b: &Vector| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x));
        let lowest = (0..vertices.len()).min_by(|&i, &j| by_place(&vertices[i], &vertices[j]));
        vertices.rotate_left(lowest.unwrap_or(0));
        Self { vertices }
    }

    /// The set rotated by `angle` radians about the origin.
    pub fn rotated(&self, angle: f64) -> Self {
        let (s, c) = angle.sin_cos();
        Self::from_ccw(
            self.vertices
                .iter()
                .map(|p| Vector::new(c * p.x - s * p.y, s * p.x + c * p.y))
                .collect(),
        )
    }

    /// The set scaled about the origin by `factor >= 0`.
    pub fn scaled(&self, factor: f64) -> Self {
        Self::from_ccw(self.vertices.iter().map(|p| p * factor).collect())
    }

    /// `c + factor (x - c)` for every `x` of the set, with its centroid `c`; `factor >= 0`.
    pub fn scaled_about_center(&self, factor: f64) -> Self {
        if factor == 1.0 {
            return self.clone();
        }
        let center = self.centroid();
        let scale = |p: &Vector| center + (p - center) * factor;
        Self::from_ccw(self.vertices.iter().map(scale).collect())
    }

    /// The set reflected through the origin, `-P`.
    pub fn negated(&self) -> Self {
        Self::from_ccw(self.vertices.iter().map(|p| -p).collect())
    }

    /// Area centroid of a polygon, midpoint of a segment, the point itself.
    pub fn centroid(&self) -> Vector {
        let o = self.vertices[0];
        match self.vertices.as_slice() {
            [p] => *p,
            [a, b] => (a + b) * 0.5,
            v => {
                let (mut area, mut moment) = (0.0, Vector::zeros());
                for w in v[1..].windows(2) {
                    let (a, b) = (w[0] - o, w[1] - o);
                    let twice = cross(a, b);
                    area += twice;
                    moment += (a + b) * twice;
                }
                o + moment / (3.0 * area)
            }
        }
    }

    /// Enclosed area; zero for a segment and a point.
    pub fn area(&self) -> f64 {
        let o = self.vertices[0];
        self.edges().map(|(a, b)| cross(a - o, b - o)).sum::<f64>() * 0.5
    }

    /// Euclidean distance from `p` to the set; inside, minus the distance to the boundary.
    /// O(vertices).
    ///
    /// A segment and a point have no inside. NaN for a NaN.
    pub fn signed_distance(&self, p: Vector) -> f64 {
        if !(p.x.is_finite() && p.y.is_finite()) {
            return f64::NAN;
        }
        if let [only] = self.vertices.as_slice() {
            return (p - only).norm();
        }
        let mut outside = self.vertices.len() == 2;
        let mut nearest = f64::INFINITY;
        for (a, b) in self.edges() {
            let e = b - a;
            outside |= cross(e, p - a) < 0.0;
            let t = ((p - a).dot(&e) / e.norm_squared()).clamp(0.0, 1.0);
            nearest = nearest.min((p - a - e * t).norm());
        }
        if outside { nearest } else { -nearest }
    }

    /// An outer polygon of the intersection, larger by rounding. `None` where the two do not meet,
    /// and where one without an interior is in part outside the other. O(vertices²).
    pub fn outer_intersection(&self, other: &Self) -> Option<Self> {
        let slack = tolerance::DUPLICATE * self.reach().max(other.reach());
        let within = |a: &Self, b: &Self| {
            let mut vertices = a.vertices.iter();
            vertices.all(|p| b.signed_distance(*p) <= slack)
        };
        if within(self, other) {
            return Some(self.clone());
        }
        if within(other, self) {
            return Some(other.clone());
        }
        let n = other.vertices.len();
        if n < 3 || self.vertices.len() < 3 {
            return None;
        }
        let edges = (0..n).map(|i| (other.vertices[i], other.vertices[(i + 1) % n]));
        let kept = edges.fold(self.vertices.clone(), |kept, (a, b)| {
            let outward = crate::frame::to_starboard(b - a).normalize();
            clipped(&kept, |p| outward.dot(&(p - a)) - slack)
        });
        Self::hull(&kept).ok()
    }

    /// True when `p` is in the closed set. NaN is inside.
    pub fn contains(&self, p: Vector) -> bool {
        // negated so that a NaN is inside
        !(self.signed_distance(p) > 0.0)
    }

    /// The first part of a way from `start`, in `[0, 1]`, that is in the closed set; `None` where
    /// none is, and for a set without an inside. A NaN is inside at once. O(vertices) (Cyrus & Beck,
    /// doi:10.1016/0097-8493(78)90021-3).
    pub fn first_on(&self, start: Vector, way: Vector) -> Option<f64> {
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        if self.vertices.len() < 3 {
            return None;
        }
        for (a, b) in self.edges() {
            // distance to the left of the edge, which is inside, and its change along the way
            let (inside, change) = (cross(b - a, start - a), cross(b - a, way));
            if change > 0.0 {
                enters = enters.max(-inside / change);
            } else if change < 0.0 {
                leaves = leaves.min(-inside / change);
            } else if inside < 0.0 {
                return None;
            }
        }
        // negated so that a NaN is inside
        (!(enters > leaves)).then_some(enters)
    }

    /// Euclidean distance between two sets; where they overlap, minus the shortest separating
    /// translation. O(n + m).
    pub fn separation(&self, other: &Self) -> f64 {
        self.minkowski_sum(&other.negated())
            .signed_distance(Vector::zeros())
    }

    /// The largest distance of a point of the set from the origin.
    pub fn reach(&self) -> f64 {
        self.vertices.iter().map(|p| p.norm()).fold(0.0, f64::max)
    }
}

/// Replaces -0 by 0, which total orders distinguish.
fn unsigned_zeros(points: &[Vector]) -> Vec<Vector> {
    points.iter().map(|p| p.add_scalar(0.0)).collect()
}

fn extent(points: &[Vector]) -> f64 {
    Window::around(points).map_or(0.0, |window| (window.high - window.low).norm())
}

/// True where a polygon is certainly wider than a segment, by the factor [`WIDE`]. O(vertices).
///
/// The area is at most the width times the extent. [`farthest_pair`] compares every pair.
fn is_wide(vertices: &[Vector], extent: f64) -> bool {
    let from = |p: &Vector| p - vertices[0];
    let twice: f64 = (vertices.windows(2))
        .map(|side| cross(from(&side[0]), from(&side[1])))
        .sum();
    twice > 2.0 * WIDE * tolerance::THIN * extent * extent
}

/// Far above the rounding error of an area.
const WIDE: f64 = 1e3;

fn farthest_pair(points: &[Vector]) -> (Vector, Vector) {
    let mut best = (points[0], points[0]);
    let mut length = -1.0;
    for (i, a) in points.iter().enumerate() {
        for b in &points[i + 1..] {
            if (b - a).norm() > length {
                length = (b - a).norm();
                best = (*a, *b);
            }
        }
    }
    best
}

/// Orders edge directions by angle from east, counter-clockwise, exactly.
fn half_plane_then_cross(a: Vector, b: Vector) -> std::cmp::Ordering {
    let lower = |v: Vector| v.y < 0.0 || (v.y == 0.0 && v.x < 0.0);
    lower(a)
        .cmp(&lower(b))
        .then_with(|| 0.0_f64.total_cmp(&cross(a, b)))
}

#[cfg(test)]
mod tests;
