//! The velocity obstacle of an ellipsoid by its tangents: paper eq. (26).

use std::f64::consts::PI;

use crate::{EllipsoidObstacle, HalfPlane, VelocityObstacle};
use searoom_geometry::frame::{Vector, direction, heading_of};
use searoom_geometry::numerics::bisected;

/// Bisection steps to the last digit of an angle.
const HALVINGS: usize = 64;

/// Tangents of the region, its two sides included.
const TANGENTS: usize = 128;

/// Coefficients of `c u + sqrt((r_o u + r_v)(a u + b))` for one normal.
#[derive(Debug, Clone, Copy)]
struct Reach {
    c: f64,
    still: [f64; 2],
    growing: [f64; 2],
}

impl Reach {
    fn at(&self, u: f64) -> f64 {
        let ([a, b], [ro, rv]) = (self.still, self.growing);
        self.c * u + ((ro * u + rv) * (a * u + b)).max(0.0).sqrt()
    }

    /// The `u >= least` of the largest value; infinite where it is not attained.
    fn largest_at(&self, least: f64) -> f64 {
        let ([a, b], [ro, rv], c) = (self.still, self.growing, -self.c);
        // the root of c u decreases without bound unless this is positive
        let falling = (c - (ro * a).sqrt()) * (c + (ro * a).sqrt());
        if !(c > 0.0 && falling > 0.0) {
            return f64::INFINITY;
        }
        // the greater root of 4 alpha (alpha - c²) u² + 4 beta (alpha - c²) u + beta² - 4 gamma c²
        // = 0, without cancellation where alpha = r_o a is small; beta² - 4 alpha gamma is a square
        let beta = ro * b + rv * a;
        let below = 2.0 * (c * (ro * b - rv * a).abs() * falling.sqrt() + falling * beta);
        let above = beta * beta - 4.0 * rv * b * c * c;
        if below > 0.0 {
            (above / below).max(least)
        } else {
            least
        }
    }

    /// The limit for `u` to infinity, where the decrease of `c u` is just compensated.
    fn limit(&self) -> f64 {
        let ([a, b], [ro, rv]) = (self.still, self.growing);
        let beta = ro * b + rv * a;
        if beta > 0.0 {
            0.5 * beta / (ro * a).sqrt()
        } else {
            (rv * b).sqrt()
        }
    }
}

impl EllipsoidObstacle {
    /// Outer set of the velocities of own ship at `position` at t = 0 that come within `distance >=
    /// 0` metres within `horizon` seconds, which may be infinite. At distance 0 this is the velocity
    /// obstacle. Contains every velocity where own ship is that near already, or for a NaN.
    ///
    /// The exact region is convex, with a smooth boundary, and unbounded away from the target. With
    /// `u = 1/t` the velocities that lead into the section of `t` are the ellipse
    ///
    /// ```text
    /// p_v + u z + E(0, (r_o u + r_v)(u Q_o / r_o + Q_v / r_v)),    z = p_o - x
    /// ```
    ///
    /// so the region's support is `n . p_v + max over u >= 1/T of c u + sqrt((r_o u + r_v)(a u +
    /// b))` with `c = n . z + distance`, `a = n' Q_o n / r_o`, `b = n' Q_v n / r_v`. The root is
    /// concave in `u`, so the maximum is at the root of a quadratic or at `1/T`. Returns the two
    /// tangents from own ship to the widened `O_0`, each moved outward by the support of `V`, and
    /// `TANGENTS` between them, denser beside these two. O(`TANGENTS`).
    pub fn outer_velocities_within(
        &self,
        position: Vector,
        horizon: f64,
        distance: f64,
    ) -> VelocityObstacle {
        let away = self.initial().signed_distance(position);
        // negated so that a NaN, like a position inside, meets it with every velocity
        if !(away.distance > distance) {
            return VelocityObstacle::of(Vec::new());
        }
        let toward = self.initial().center() - position;
        // a NaN is no limit
        let least = if horizon.is_nan() {
            0.0
        } else {
            1.0 / horizon.max(0.0)
        };
        let square = |[a, b]: [Vector; 2], n: Vector| n.dot(&a).powi(2) + n.dot(&b).powi(2);
        let reach = |n: Vector| Reach {
            c: n.dot(&toward) + distance,
            still: self.axes.map(|axes| square(axes, n)),
            growing: self.roots,
        };
        // the support of the widened set relative to own ship is negative toward own ship, positive
        // away
        let ahead = heading_of(away.normal);
        let side = |way: f64| {
            let [inner, _] = bisected([0.0, PI], HALVINGS, |angle| {
                let n = direction(ahead + way * angle);
                n.dot(&toward) + self.initial().radius(n) + distance < 0.0
            });
            ahead + way * inner
        };
        let [first, last] = [side(-1.0), side(1.0)];
        let tangent = |k: usize| {
            let share = 0.5 - 0.5 * (PI * k as f64 / (TANGENTS - 1) as f64).cos();
            let normal = direction(first + (last - first) * share);
            let reach = reach(normal);
            let is_side = k == 0 || k == TANGENTS - 1;
            let most = match reach.largest_at(least) {
                _ if is_side => reach.limit(),
                u if u.is_finite() => reach.at(u),
                _ => f64::INFINITY,
            };
            HalfPlane {
                normal,
                offset: normal.dot(&self.velocity().center()) + most,
            }
        };
        // a region has no line beside which it diverges, as for a segment seen end on
        let tangents = (0..TANGENTS).map(tangent);
        VelocityObstacle::of(tangents.filter(|h| h.offset.is_finite()).collect())
    }
}
