//! Moving, growing ellipses that a plan of forces keeps out of.

use nalgebra::Matrix2;

use searoom_geometry::frame::{Vector, to_port};
use searoom_geometry::{Ellipse, outer_enclosing_ellipse};
use searoom_sets::{EllipsoidObstacle, Obstacle, SpaceTimeObstacle};

/// Least semi-axis in metres. The constraint needs a set with interior, so a narrower initial
/// ellipse is widened: an outer set.
const LEAST_SEMI_AXIS: f64 = 1e-3;

/// Ellipsoid with interior at every time.
#[derive(Debug, Clone, PartialEq)]
pub struct KeepOut {
    set: EllipsoidObstacle,
}

/// Section in the form of the constraint: `(x - center)' inverse (x - center) >= 1`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keep {
    /// Centre, metres.
    pub center: Vector,
    /// Inverse of the shape matrix, 1/m².
    pub inverse: Matrix2<f64>,
}

impl Keep {
    /// Level `(x - center)' inverse (x - center)`: one on the edge, less inside.
    pub fn level(&self, position: Vector) -> f64 {
        let d = position - self.center;
        d.dot(&(self.inverse * d))
    }
}

impl KeepOut {
    /// Outer ellipsoid of an obstacle: an ellipsoid itself, else the smallest ellipses around its
    /// positions and all its velocities.
    pub fn outer_of(obstacle: &Obstacle) -> Self {
        let sets = obstacle.sets();
        let velocity = match obstacle.as_ellipsoid() {
            Some(ellipsoid) => *ellipsoid.velocity(),
            None => outer_enclosing_ellipse(&sets.outer_velocities_after(f64::NEG_INFINITY)),
        };
        let initial = outer_widened(&sets.initial.outer_ellipse());
        Self {
            set: EllipsoidObstacle::new(obstacle.name(), initial, velocity),
        }
    }

    /// The ellipsoid.
    pub fn set(&self) -> &EllipsoidObstacle {
        &self.set
    }

    /// The section at `time >= 0`, seconds. O(1).
    pub fn at(&self, time: f64) -> Keep {
        let section = self.set.outer_section(time);
        let [a, b] = section.semi_axes();
        let square = |v: Vector| v * v.transpose() / v.norm_squared().powi(2);
        Keep {
            center: section.center(),
            inverse: square(a) + square(b),
        }
    }

    /// Least half width of the initial ellipse, metres: no section is narrower.
    pub fn narrowest(&self) -> f64 {
        let [a, b] = self.set.initial().semi_axes();
        a.norm().min(b.norm())
    }
}

/// Ellipse with each semi-axis at least [`LEAST_SEMI_AXIS`].
fn outer_widened(ellipse: &Ellipse) -> Ellipse {
    let [long, short] = ellipse.semi_axes();
    if short.norm() >= LEAST_SEMI_AXIS {
        return *ellipse;
    }
    let along = long
        .try_normalize(0.0)
        .unwrap_or_else(|| Vector::new(1.0, 0.0));
    let long = along * long.norm().max(LEAST_SEMI_AXIS);
    let axes = [long, to_port(along) * LEAST_SEMI_AXIS];
    Ellipse::from_axes(ellipse.center(), axes)
}

/// Test ellipsoid at a position with a velocity; axes of both sets.
#[cfg(test)]
pub(super) fn ellipsoid(
    center: [f64; 2],
    velocity: [f64; 2],
    shape: [f64; 2],
    spread: [f64; 2],
) -> KeepOut {
    let ellipse = |c: [f64; 2], q: [f64; 2]| {
        let axes = [Vector::new(q[0].sqrt(), 0.0), Vector::new(0.0, q[1].sqrt())];
        Ellipse::from_axes(Vector::new(c[0], c[1]), axes)
    };
    let set = EllipsoidObstacle::new("a", ellipse(center, shape), ellipse(velocity, spread));
    KeepOut::outer_of(&set.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use searoom_geometry::ConvexPolygon;
    use searoom_sets::PolytopeObstacle;

    #[test]
    fn the_level_is_one_on_the_edge_and_agrees_with_the_set() {
        let keep = ellipsoid([3.0, 1.0], [0.2, -0.1], [1.0, 0.36], [4e-4, 1e-4]);
        for i in 0..60 {
            let time = 2.0 * f64::from(i);
            let section = keep.set().outer_section(time);
            for point in section.sampled_boundary(17) {
                assert!((keep.at(time).level(point) - 1.0).abs() < 1e-9);
                let outside = section.center() + (point - section.center()) * 1.01;
                assert!(keep.at(time).level(outside) > 1.0 && !keep.set().contains(outside, time));
            }
        }
    }

    #[test]
    fn flat_sets_are_widened_and_polytopes_enclosed() {
        let point = ConvexPolygon::point(Vector::new(5.0, 5.0));
        let wall =
            ConvexPolygon::hull(&[Vector::new(0.0, 0.0), Vector::new(0.0, 9.0)]).expect("finite");
        for initial in [point.clone(), wall] {
            let polytope = PolytopeObstacle::new("thin", initial.clone(), point.clone());
            let keep = KeepOut::outer_of(&polytope.into());
            assert!(keep.narrowest() >= LEAST_SEMI_AXIS);
            for vertex in initial.vertices() {
                assert!(keep.at(0.0).level(*vertex) <= 1.0 + 1e-9);
            }
            assert!(keep.at(3.0).inverse.iter().all(|v| v.is_finite()));
        }
    }
}
