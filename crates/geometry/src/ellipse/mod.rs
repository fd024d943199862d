//! Ellipses, including points (no semi-axis) and segments (one).

mod enclosing;

pub use enclosing::outer_enclosing_ellipse;

use nalgebra::{Matrix2, SymmetricEigen};

use super::{ConvexPolygon, rounded};
use crate::frame::{Vector, cross, direction, to_port};
use crate::tolerance;

/// Bound on the Newton steps to the nearest point; four are usual, and each adds digits.
const MAX_STEPS: usize = 60;

/// Why a centre and a matrix are not an ellipse.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// A coordinate of the centre that is not finite.
    #[error("center coordinate {index} is {found}; it must be a finite number")]
    CenterNotFinite {
        /// Index of the coordinate, from 0.
        index: usize,
        /// The value found.
        found: f64,
    },
    /// An entry of the matrix that is not finite.
    #[error("shape matrix entry [{row}][{column}] is {found}; it must be a finite number")]
    NotFinite {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// The value found.
        found: f64,
    },
    /// The off-diagonal entries differ.
    #[error("a shape matrix that is not symmetric: [0][1] is {upper}, [1][0] is {lower}")]
    NotSymmetric {
        /// Entry `[0][1]`.
        upper: f64,
        /// Entry `[1][0]`.
        lower: f64,
    },
    /// A negative eigenvalue.
    #[error(
        "a shape matrix that is not positive semidefinite: its least eigenvalue is {:?}",
        rounded(*eigenvalue)
    )]
    NotPositiveSemidefinite {
        /// The smaller eigenvalue.
        eigenvalue: f64,
    },
}

/// Distance of a point from a set, and the direction to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignedDistance {
    /// Euclidean distance, negative inside: minus the distance to the boundary.
    pub distance: f64,
    /// Outward unit normal at the nearest point of the boundary.
    pub normal: Vector,
}

/// `E(p, Q) = {x : (x - p)' Q^-1 (x - p) <= 1}`, paper eq. (12), for a positive semidefinite `Q`. A
/// singular `Q` gives `{x : n . (x - p) <= sqrt(n' Q n) for all n}`.
///
/// Stored as the centre and two orthogonal semi-axes, of which one or both may be zero, so that a
/// thin ellipse loses no digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    center: Vector,
    axes: [Vector; 2],
}

impl Ellipse {
    /// From a centre and a shape matrix in its squared unit.
    ///
    /// The matrix must be symmetric and positive semidefinite to [`tolerance::SHAPE`] of its
    /// largest entry.
    pub fn new(center: Vector, shape: Matrix2<f64>) -> Result<Self, ShapeError> {
        if let Some(index) = (0..2).find(|&i| !center[i].is_finite()) {
            let found = center[index];
            return Err(ShapeError::CenterNotFinite { index, found });
        }
        for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let found = shape[(row, column)];
            if !found.is_finite() {
                return Err(ShapeError::NotFinite { row, column, found });
            }
        }
        let (upper, lower) = (shape[(0, 1)], shape[(1, 0)]);
        let allowed = tolerance::SHAPE * shape.amax();
        if (upper - lower).abs() > allowed {
            return Err(ShapeError::NotSymmetric { upper, lower });
        }
        // scaled, so that squares neither overflow nor underflow
        let scale = shape.amax();
        if scale == 0.0 {
            return Ok(Self::point(center));
        }
        let eigen = SymmetricEigen::new((shape / scale + shape.transpose() / scale) * 0.5);
        let eigenvalue = eigen.eigenvalues.min() * scale;
        if !(eigenvalue >= -allowed) {
            return Err(ShapeError::NotPositiveSemidefinite { eigenvalue });
        }
        let axis = |i: usize| {
            let value = eigen.eigenvalues[i];
            // rounding of the entries alone changes an eigenvalue by this much
            let value = if value <= 4.0 * f64::EPSILON {
                0.0
            } else {
                value
            };
            eigen.eigenvectors.column(i) * (value.sqrt() * scale.sqrt())
        };
        Ok(Self::from_axes(center, [axis(0), axis(1)]))
    }

    /// A single point, `Q = 0`.
    pub fn point(center: Vector) -> Self {
        Self {
            center,
            axes: [Vector::zeros(); 2],
        }
    }

    /// The disc of a radius.
    pub fn disc(center: Vector, radius: f64) -> Self {
        let axes = [Vector::new(radius, 0.0), Vector::new(0.0, radius)];
        Self { center, axes }
    }

    /// `{p + F z : |z| <= 1}` for the two columns of `F`.
    ///
    /// One Jacobi rotation makes them orthogonal and preserves the digits of a small semi-axis.
    pub fn from_axes(center: Vector, columns: [Vector; 2]) -> Self {
        let [f, g] = columns;
        let angle = 0.5 * (2.0 * f.dot(&g)).atan2(f.norm_squared() - g.norm_squared());
        let (sin, cos) = angle.sin_cos();
        let (major, minor) = (f * cos + g * sin, g * cos - f * sin);
        let axes = if minor.norm() > major.norm() {
            [minor, major]
        } else {
            [major, minor]
        };
        Self { center, axes }
    }

    /// The centre `p`.
    pub fn center(&self) -> Vector {
        self.center
    }

    /// The two orthogonal semi-axes, the longer first.
    pub fn semi_axes(&self) -> [Vector; 2] {
        self.axes
    }

    /// The shape matrix `Q`.
    pub fn shape(&self) -> Matrix2<f64> {
        let [a, b] = self.axes;
        a * a.transpose() + b * b.transpose()
    }

    /// `sqrt(trace Q)`: an upper bound of the distance of a point of the set from the centre.
    pub fn root_of_trace(&self) -> f64 {
        self.axes[0].norm().hypot(self.axes[1].norm())
    }

    /// The area, `pi a b`.
    pub fn area(&self) -> f64 {
        std::f64::consts::PI * self.axes[0].norm() * self.axes[1].norm()
    }

    /// `h(n) = n . p + sqrt(n' Q n)`. O(1).
    pub fn support(&self, n: Vector) -> f64 {
        n.dot(&self.center) + self.radius(n)
    }

    /// `sqrt(n' Q n)`: the support about the centre.
    pub fn radius(&self, n: Vector) -> f64 {
        n.dot(&self.axes[0]).hypot(n.dot(&self.axes[1]))
    }

    /// True when `p` is in the closed set. NaN is inside. O(1).
    pub fn contains(&self, p: Vector) -> bool {
        let y = p - self.center;
        let [a, b] = self.axes;
        // the first condition alone would extend a segment for ever; it implies the second for an
        // interior
        let across = cross(y, a).powi(2) + cross(y, b).powi(2);
        !(across > (a.norm() * b.norm()).powi(2))
            && !(y.norm_squared() > a.norm_squared() + b.norm_squared())
    }

    /// The signed distance of `p`; NaN for a NaN. A segment and a point have no inside.
    ///
    /// Newton's method on the secular equation `sum q_i z_i² / (q_i + s)² = 1`
    /// (docs/reference/theory.md section 5.2), in the form in which every step stays below the
    /// root, to rounding.
    pub fn signed_distance(&self, p: Vector) -> SignedDistance {
        let [a, b] = self.axes;
        let (major, minor) = (a.norm(), b.norm());
        // any unit vector serves for a point
        let along = if major > 0.0 {
            a / major
        } else {
            Vector::new(1.0, 0.0)
        };
        distance_in_frame(p - self.center, along, major, minor)
    }

    /// The set translated by `shift`.
    pub fn translated(&self, shift: Vector) -> Self {
        Self {
            center: self.center + shift,
            axes: self.axes,
        }
    }

    /// The set rotated by `angle` radians about the origin.
    pub fn rotated(&self, angle: f64) -> Self {
        let (s, c) = angle.sin_cos();
        let turn = |p: Vector| Vector::new(c * p.x - s * p.y, s * p.x + c * p.y);
        Self {
            center: turn(self.center),
            axes: self.axes.map(turn),
        }
    }

    /// The set scaled about its own centre by `factor >= 0`.
    pub fn scaled_about_center(&self, factor: f64) -> Self {
        Self {
            center: self.center,
            axes: self.axes.map(|a| a * factor),
        }
    }

    /// `count` points of the boundary, counter-clockwise; for figures.
    pub fn sampled_boundary(&self, count: usize) -> Vec<Vector> {
        let [a, b] = self.axes;
        let b = if cross(a, b) < 0.0 { -b } else { b };
        (0..count)
            .map(|i| {
                let z = direction(std::f64::consts::TAU * i as f64 / count as f64);
                self.center + a * z.x + b * z.y
            })
            .collect()
    }

    /// An outer polygon with `sides >= 3` edges: the image of the circumscribed regular polygon. A
    /// segment and a point are exact.
    ///
    /// It touches the ellipse at the middle of every edge. Its area is `(k / pi) tan(pi / k)` times
    /// that of the ellipse, 1.3 % more for 16 edges.
    pub fn outer_polygon(&self, sides: usize) -> ConvexPolygon {
        let [a, b] = self.axes;
        if b == Vector::zeros() {
            let ends = vec![self.center - a, self.center + a];
            return ConvexPolygon::from_ccw(ends);
        }
        let b = if cross(a, b) < 0.0 { -b } else { b };
        let half = std::f64::consts::PI / sides.max(3) as f64;
        // allows for the rounding of the corners
        let reach = (1.0 + 4.0 * f64::EPSILON) / half.cos();
        let corners = (0..sides.max(3))
            .map(|k| {
                let z = direction(half * (2 * k + 1) as f64) * reach;
                self.center + a * z.x + b * z.y
            })
            .collect();
        ConvexPolygon::from_ccw(corners)
    }
}

/// The signed distance of `y` from the ellipse about the origin with semi-axes `major` along the
/// unit vector `along` and `minor` across it.
pub fn distance_in_frame(y: Vector, along: Vector, major: f64, minor: f64) -> SignedDistance {
    let across = to_port(along);
    let z = [y.dot(&along), y.dot(&across)];
    let (distance, n) = distance_in_quadrant(z[0].abs(), z[1].abs(), major, minor);
    SignedDistance {
        distance,
        normal: along * n[0].copysign(z[0]) + across * n[1].copysign(z[1]),
    }
}

/// [`distance_in_frame`] in the quadrant of positive coordinates: distance and normal.
fn distance_in_quadrant(z0: f64, z1: f64, e0: f64, e1: f64) -> (f64, [f64; 2]) {
    if !(z0.is_finite() && z1.is_finite()) {
        return (f64::NAN, [f64::NAN; 2]);
    }
    if e1 <= tolerance::THIN * e0 {
        // a segment, or a point
        let beyond = (z0 - e0).max(0.0);
        let distance = beyond.hypot(z1);
        return if distance > 0.0 {
            (distance, [beyond / distance, z1 / distance])
        } else {
            (0.0, [0.0, 1.0])
        };
    }
    let (q1, gap) = (e1 * e1, (e0 - e1) * (e0 + e1));
    let (p0, p1) = (e0 * z0, e1 * z1);
    // sigma = q1 + s; each term of the sum is at most 1
    let mut sigma = p1.max(p0 - gap);
    if sigma <= 0.0 {
        // on the major axis between the centres of curvature: the nearest points are beside it
        let x = if gap > 0.0 { e0 * p0 / gap } else { 0.0 };
        let height = e1 * (1.0 - (x / e0).powi(2)).max(0.0).sqrt();
        let normal = Vector::new(x * q1, height * e0 * e0).normalize();
        return (-(x - z0).hypot(height), [normal.x, normal.y]);
    }
    for _ in 0..MAX_STEPS {
        let (i0, i1) = (1.0 / (sigma + gap), 1.0 / sigma);
        let (u0, u1) = (p0 * i0, p1 * i1);
        let (t0, t1) = (u0 * u0, u1 * u1);
        let sum = t0 + t1;
        let step = sum * (sum.sqrt() - 1.0) / (t0 * i0 + t1 * i1);
        if !(step > 2.0 * f64::EPSILON * sigma) {
            break;
        }
        sigma += step;
    }
    let (n0, n1) = (z0 / (sigma + gap), z1 / sigma);
    let norm = n0.hypot(n1);
    ((sigma - q1) * norm, [n0 / norm, n1 / norm])
}

#[cfg(test)]
mod tests;
