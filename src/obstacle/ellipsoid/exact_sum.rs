//! The exact Minkowski sum of two ellipses, which is not an ellipse; docs/theory.md section 3.

use crate::frame::{Vector, cross, to_starboard};
use crate::numerics::GoldenSection;
use crate::obstacle::{EllipsoidObstacle, SpaceTimeObstacle};

/// Golden section steps on the unit interval: accuracy 1e-12.
const GOLDEN_STEPS: usize = 60;

/// Points of the trapezoidal rule for the mixed area; its integrand is periodic.
const AREA_POINTS: usize = 4096;

impl EllipsoidObstacle {
    /// Support of the exact sum: `max over O_0 ⊕ t V of n . x`, metres. O(1).
    ///
    /// It equals `n . p_t + sqrt(n' Q_o n) + t sqrt(n' Q_v n)`. It is at most
    /// [`SpaceTimeObstacle::support`] of the outer set, with equality where the ratio of the two
    /// roots is that of the roots of the traces.
    pub fn sum_support(&self, normal: Vector, time: f64) -> f64 {
        normal.dot(&self.center(time))
            + self.initial().radius(normal)
            + time * self.velocity().radius(normal)
    }

    /// The largest ratio of [`SpaceTimeObstacle::support`] to [`Self::sum_support`], both about the
    /// centre, over all directions and times up to `horizon`. O(1).
    ///
    /// The exact sum scaled about its centre by this factor contains the outer set. It is at least
    /// 1, and infinite where `O_0` is flat and `V` is not along it.
    ///
    /// With `rho = sqrt(n' Q_o n / n' Q_v n) / d` and `tau = t / d` the squared ratio is `1 + tau
    /// (rho - 1)² / (rho + tau)²`. It is largest at `tau = rho` for the extreme `rho`, the roots of
    /// the generalised eigenvalues.
    pub fn largest_ratio_to_sum(&self, horizon: f64) -> f64 {
        let [still, growing] = self.roots;
        if self.is_flat() || still == 0.0 || growing == 0.0 {
            return 1.0;
        }
        let delay = still / growing;
        let [d0, d1, d2] = self.determinant;
        let root = d1 + (d1 * d1 - 4.0 * d0 * d2).max(0.0).sqrt();
        let ratio = |square: f64| {
            let rho = (square / delay).sqrt();
            let tau = rho.min(horizon / delay);
            if rho.is_infinite() {
                (1.0 + tau).sqrt()
            } else if rho > 0.0 {
                (1.0 + tau * ((rho - 1.0) / (rho + tau)).powi(2)).sqrt()
            } else {
                f64::INFINITY
            }
        };
        let least = if d0 > 0.0 { 2.0 * d0 / root } else { 0.0 };
        ratio(least).max(ratio(root / (2.0 * d2)))
    }

    /// True when the point is in the closed sum `O_0 ⊕ t V`, `t >= 0`. NaN is inside. O(1), 60
    /// evaluations.
    ///
    /// The sum is the intersection of the family `E(p_t, Q_o / b + t² Q_v / (1 - b))`, `0 < b < 1`;
    /// eq. (18) is its member of least trace. `y' (..)^-1 y` is concave in `b`, so golden section
    /// finds its maximum. One member that excludes the point proves that it is outside.
    pub fn sum_contains(&self, position: Vector, time: f64) -> bool {
        if time < 0.0 {
            return false;
        }
        let (o, v) = (self.initial().semi_axes(), self.velocity().semi_axes());
        let v = v.map(|a| a * time);
        let still_flat = v == [Vector::zeros(); 2];
        if still_flat || self.is_flat() || o == [Vector::zeros(); 2] {
            // one summand, or a sum of parallel segments: the outer section equals the sum
            return self.contains(position, time);
        }
        let y = position - self.center(time);
        let square = |p: Vector, q: Vector| cross(p, q).powi(2);
        let still = square(y, o[0]) + square(y, o[1]);
        let growing = square(y, v[0]) + square(y, v[1]);
        let determinant = [
            square(o[0], o[1]),
            square(o[0], v[0]) + square(o[0], v[1]) + square(o[1], v[0]) + square(o[1], v[1]),
            square(v[0], v[1]),
        ];
        // y' adj y and det of the member, both times (b (1 - b))²
        let value = |b: f64| {
            let c = 1.0 - b;
            let above = (c * still + b * growing) * b * c;
            let below = c * c * determinant[0] + b * c * determinant[1] + b * b * determinant[2];
            above / below
        };
        let below = |b: f64| -value(b);
        let mut search = GoldenSection::new(0.0, 1.0, below);
        for _ in 0..GOLDEN_STEPS {
            if search.left.1 < -1.0 || search.right.1 < -1.0 {
                return false;
            }
            search.shorten(below);
        }
        true
    }

    /// Area of `O_0 ⊕ t V`, m²: `|O_0| + 2 t |O_0, V| + t² |V|` with the mixed area by quadrature.
    ///
    /// Exact to rounding for ellipses with an interior, to 1e-6 of the area for flat ones.
    pub fn sum_area(&self, time: f64) -> f64 {
        let (o, v) = (self.initial(), self.velocity());
        let [a, b] = v.semi_axes();
        let b = if cross(a, b) < 0.0 { -b } else { b };
        let step = std::f64::consts::TAU / AREA_POINTS as f64;
        let mixed: f64 = (0..AREA_POINTS)
            .map(|i| {
                let (sin, cos) = (step * i as f64).sin_cos();
                // normal times length of the boundary element of V
                o.radius(to_starboard(b * cos - a * sin))
            })
            .sum::<f64>()
            * (0.5 * step);
        o.area() + 2.0 * time * mixed + time * time * v.area()
    }

    /// Relative excess of the outer section's area over the exact sum at `time`; 0 where the sum
    /// has no area. Figures are in `docs/sets.md`.
    pub fn outer_excess(&self, time: f64) -> f64 {
        let sum = self.sum_area(time);
        if sum > 0.0 {
            self.outer_section(time).area() / sum - 1.0
        } else {
            0.0
        }
    }
}
