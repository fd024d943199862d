//! The Minkowski sum of two ellipses itself, which no ellipse is; docs/theory.md section 3.

use crate::frame::{Vector, cross, to_starboard};
use crate::obstacle::{EllipsoidObstacle, SpaceTimeObstacle};

/// Sections of the unit interval: the maximum is found to a millionth of a millionth of it.
const GOLDEN_STEPS: usize = 60;

/// Points of the trapezoidal rule for a mixed area; the integrand is periodic.
const AREA_POINTS: usize = 4096;

impl EllipsoidObstacle {
    /// `max over O_0 ⊕ t V of n . x = n . p_t + sqrt(n' Q_o n) + t sqrt(n' Q_v n)`, metres; at most
    /// [`SpaceTimeObstacle::support`] of the outer set, and equal to it where the ratio of the two roots is
    /// that of the roots of the traces. O(1).
    pub fn sum_support(&self, normal: Vector, time: f64) -> f64 {
        normal.dot(&self.center(time))
            + self.initial().radius(normal)
            + time * self.velocity().radius(normal)
    }

    /// The largest of [`SpaceTimeObstacle::support`] over [`Self::sum_support`], both about the centre, in all
    /// directions and up to `horizon`: the sum grown about its centre by this factor contains this set until then. At
    /// least 1; infinite where `O_0` is flat and `V` is not along it. O(1).
    ///
    /// With `rho = sqrt(n' Q_o n / n' Q_v n) / d` and `tau = t / d` the squared ratio is
    /// `1 + tau (rho - 1)² / (rho + tau)²`: largest at `tau = rho`, and for the extreme `rho`, the roots of the
    /// generalised eigenvalues.
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

    /// True when the point is in the closed sum `O_0 ⊕ t V`, `t >= 0`, which the section of this obstacle
    /// contains. NaN is inside.
    ///
    /// The sum is the intersection of the family `E(p_t, Q_o / b + t² Q_v / (1 - b))`, `0 < b < 1`, of which
    /// eq. (18) is the member of least trace. `y' (..)^-1 y` is concave in `b`, so its largest value is found by
    /// golden section and one member that excludes the point is proof. O(1), 60 evaluations.
    pub fn sum_contains(&self, position: Vector, time: f64) -> bool {
        if time < 0.0 {
            return false;
        }
        let (o, v) = (self.initial().semi_axes(), self.velocity().semi_axes());
        let v = v.map(|a| a * time);
        let still_flat = v == [Vector::zeros(); 2];
        if still_flat || self.is_flat() || o == [Vector::zeros(); 2] {
            // one term, or a sum of parallel segments: the outer section is the sum
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
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut low, mut high) = (0.0, 1.0);
        let (mut left, mut right) = (1.0 - golden, golden);
        let (mut at_left, mut at_right) = (value(left), value(right));
        for _ in 0..GOLDEN_STEPS {
            if at_left > 1.0 || at_right > 1.0 {
                return false;
            }
            if at_left > at_right {
                high = right;
                (right, at_right) = (left, at_left);
                left = high - golden * (high - low);
                at_left = value(left);
            } else {
                low = left;
                (left, at_left) = (right, at_right);
                right = low + golden * (high - low);
                at_right = value(right);
            }
        }
        true
    }

    /// Area of `O_0 ⊕ t V`, m²: `|O_0| + 2 t |O_0, V| + t² |V|` with the mixed area by quadrature, exact to
    /// rounding for ellipses with an interior and to 1e-6 of it for flat ones.
    pub fn sum_area(&self, time: f64) -> f64 {
        let (o, v) = (self.initial(), self.velocity());
        let [a, b] = v.semi_axes();
        let b = if cross(a, b) < 0.0 { -b } else { b };
        let step = std::f64::consts::TAU / AREA_POINTS as f64;
        let mixed: f64 = (0..AREA_POINTS)
            .map(|i| {
                let (sin, cos) = (step * i as f64).sin_cos();
                // normal times length of the boundary of V
                o.radius(to_starboard(b * cos - a * sin))
            })
            .sum::<f64>()
            * (0.5 * step);
        o.area() + 2.0 * time * mixed + time * time * v.area()
    }

    /// By which fraction the section at `time` is larger than the sum that it contains: area over area, less
    /// one. Zero where the sum has no area. See `docs/sets.md` for figures.
    pub fn outer_excess(&self, time: f64) -> f64 {
        let sum = self.sum_area(time);
        if sum > 0.0 {
            self.outer_section(time).area() / sum - 1.0
        } else {
            0.0
        }
    }
}
