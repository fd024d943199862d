//! The ellipsoid obstacle, paper eqs. (12)-(19): an outer set with elliptic sections.
//!
//! `O_0` and `V` are ellipses. Each section is the ellipse of least trace, in a known family, that
//! contains their sum.

mod contact;
mod velocity_obstacle;

use crate::closest_approach::{ClosestApproach, searched_approach, usable_horizon};
use crate::contact::Line;
use crate::contact::advancement::advanced_contact;
use crate::risk::{PeakRisk, level_of, peak_by_bisection};
use crate::{PolytopeObstacle, SpaceTimeObstacle, Support};
use searoom_geometry::frame::{Vector, cross};
use searoom_geometry::tolerance;
use searoom_geometry::{
    DISC_SIDES, Ellipse, SignedDistance, distance_in_frame, outer_enclosing_ellipse,
};
use searoom_model::trajectory::Segment;

/// Bound on root-finding steps; six are usual.
pub(crate) const MAX_STEPS: usize = 100;

/// Outer set of the positions that a target may reach: `O_t = E(p_o + p_v t, Q_t)` for `t >= 0`
/// with
///
/// ```text
/// Q_t = (r_o + r_v t) (Q_o / r_o + t Q_v / r_v),    r = sqrt(trace Q)
/// ```
///
/// This is paper eq. (18) in a form without division by zero: a term without trace is dropped, and
/// `Q_o`, `Q_v` may be singular. Convex in space-time (docs/reference/theory.md section 3). It
/// contains the Minkowski sum `O_0 ⊕ t V`, which is not an ellipse, and touches it.
///
/// Where both sets lie on parallel segments or are points, the sum does too and is stored as an
/// exact polytope.
#[derive(Debug, Clone, PartialEq)]
pub struct EllipsoidObstacle {
    name: String,
    pub(crate) initial: Ellipse,
    pub(crate) velocity: Ellipse,
    /// `r_o`, metres, and `r_v`, m/s.
    pub(crate) roots: [f64; 2],
    /// Semi-axes of `Q_o / r_o` and of `Q_v / r_v`.
    pub(crate) axes: [[Vector; 2]; 2],
    /// `det (Q_o / r_o + t Q_v / r_v)` as coefficients of 1, t, t²; all are non-negative.
    pub(crate) determinant: [f64; 3],
    pub(crate) flat: Option<PolytopeObstacle>,
}

/// A section in the frame of its axes, about its centre.
#[derive(Debug, Clone, Copy)]
struct Section {
    along: Vector,
    major: f64,
    minor: f64,
}

/// True where the squared area of each pair of semi-axes is below a fraction of its upper bound.
fn is_thinner(determinant: [f64; 3], roots: [f64; 2], fraction: f64) -> bool {
    let [still, growing] = roots;
    let largest = [still * still, still * growing, growing * growing];
    (determinant.iter().zip(largest)).all(|(area, largest)| *area <= fraction * largest)
}

impl EllipsoidObstacle {
    /// From the positions at t = 0, metres, and the velocities, m/s. O(1).
    pub fn new(name: impl Into<String>, initial: Ellipse, velocity: Ellipse) -> Self {
        let name = name.into();
        let roots = [initial.root_of_trace(), velocity.root_of_trace()];
        let scaled = |e: &Ellipse, root: f64| {
            e.semi_axes().map(|a| {
                if root > 0.0 {
                    a / root.sqrt()
                } else {
                    Vector::zeros()
                }
            })
        };
        let axes = [scaled(&initial, roots[0]), scaled(&velocity, roots[1])];
        // Cauchy-Binet formula: sums of squares, so nothing cancels
        let [a, b] = axes;
        let mixed = a
            .iter()
            .flat_map(|p| b.iter().map(move |q| cross(*p, *q).powi(2)))
            .sum();
        let determinant = [cross(a[0], a[1]).powi(2), mixed, cross(b[0], b[1]).powi(2)];
        let thin = tolerance::THIN * tolerance::THIN;
        let flat = is_thinner(determinant, roots, thin).then(|| {
            let polygon = |e: &Ellipse| e.outer_polygon(DISC_SIDES);
            PolytopeObstacle::new(name.clone(), polygon(&initial), polygon(&velocity))
        });
        Self {
            name,
            initial,
            velocity,
            roots,
            axes,
            determinant,
            flat,
        }
    }

    /// An outer set of a polytope: the smallest ellipses around its two sets.
    pub fn outer_of(polytope: &PolytopeObstacle) -> Self {
        Self::new(
            polytope.name(),
            outer_enclosing_ellipse(polytope.initial()),
            outer_enclosing_ellipse(polytope.velocity()),
        )
    }

    /// True when both sets are points or lie on parallel segments, to
    /// [`tolerance::THIN_ELLIPSE`].
    pub(crate) fn is_thin(&self) -> bool {
        let thin = tolerance::THIN_ELLIPSE * tolerance::THIN_ELLIPSE;
        is_thinner(self.determinant, self.roots, thin)
    }

    /// The exact polytope where both sets are points or lie on parallel segments.
    pub fn flat(&self) -> Option<&PolytopeObstacle> {
        self.flat.as_ref()
    }

    /// `O_0 = E(p_o, Q_o)`, metres.
    pub fn initial(&self) -> &Ellipse {
        &self.initial
    }

    /// `V = E(p_v, Q_v)`, m/s.
    pub fn velocity(&self) -> &Ellipse {
        &self.velocity
    }

    /// The largest ratio of [`SpaceTimeObstacle::support`] to the support of the exact sum `O_0 ⊕ t
    /// V`, both about the centre, over all directions and times up to `horizon`. O(1).
    ///
    /// The exact sum scaled about its centre by this factor contains the outer set. It is at least
    /// 1, and infinite where `O_0` is flat and `V` is not along it.
    ///
    /// With `rho = sqrt(n' Q_o n / n' Q_v n) / d` and `tau = t / d` the squared ratio is `1 + tau
    /// (rho - 1)² / (rho + tau)²`. It is largest at `tau = rho` for the extreme `rho`, the roots of
    /// the generalised eigenvalues.
    pub fn largest_ratio_to_sum(&self, horizon: f64) -> f64 {
        let [still, growing] = self.roots;
        if self.flat.is_some() || still == 0.0 || growing == 0.0 {
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

    /// The section `E(p_t, Q_t)` at `time >= 0`, paper eq. (18).
    pub fn outer_section(&self, time: f64) -> Ellipse {
        let s = self.section(time);
        let axes = [
            s.along * s.major,
            searoom_geometry::frame::to_port(s.along) * s.minor,
        ];
        Ellipse::from_axes(self.center(time), axes)
    }

    /// `p_t = p_o + p_v t`, metres.
    pub fn center(&self, time: f64) -> Vector {
        self.initial.center() + self.velocity.center() * time
    }

    fn section(&self, time: f64) -> Section {
        let [a, b] = self.axes;
        let sum = |f: fn(&Vector) -> f64| f(&a[0]) + f(&a[1]) + time * (f(&b[0]) + f(&b[1]));
        let trace = sum(|v| v.norm_squared());
        let difference = sum(|v| v.x * v.x - v.y * v.y);
        let skew = 2.0 * sum(|v| v.x * v.y);
        let root = (difference * difference + skew * skew).sqrt();
        let most = 0.5 * (trace + root);
        let least = if most > 0.0 {
            self.determinant_at(time) / most
        } else {
            0.0
        };
        // the form of the eigenvector without cancellation
        let along = if difference >= 0.0 {
            Vector::new(difference + root, skew)
        } else {
            Vector::new(skew, root - difference)
        };
        let norm = along.norm();
        let reach = self.reach(time);
        Section {
            along: if norm > 0.0 {
                along / norm
            } else {
                Vector::new(1.0, 0.0)
            },
            major: (reach * most).sqrt(),
            minor: (reach * least).sqrt(),
        }
    }

    /// `r_o + r_v t`, the root of the trace of `Q_t`: an upper bound of the radius of the section.
    pub(crate) fn reach(&self, time: f64) -> f64 {
        self.roots[0] + self.roots[1] * time
    }

    fn determinant_at(&self, time: f64) -> f64 {
        let [d0, d1, d2] = self.determinant;
        d0 + time * (d1 + time * d2)
    }

    /// `y' adj(Q / r) y` of `Q_o` and of `Q_v`.
    fn adjugates(&self, y: Vector) -> [f64; 2] {
        self.axes
            .map(|[a, b]| cross(y, a).powi(2) + cross(y, b).powi(2))
    }

    /// Has the sign of `y' Q_t^-1 y - 1` for `time > 0`.
    ///
    /// At t = 0 it is zero along the line of an `O_0` that is a segment, and everywhere around a
    /// point. [`Self::is_beyond`] decides these cases.
    pub(crate) fn excess(&self, y: Vector, time: f64) -> f64 {
        let [still, growing] = self.adjugates(y);
        still + time * growing - self.reach(time) * self.determinant_at(time)
    }

    /// True outside the circle that contains the section; decides where the section is a segment or
    /// a point.
    pub(crate) fn is_beyond(&self, y: Vector, time: f64) -> bool {
        let reach = self.reach(time);
        y.norm_squared() > reach * reach
    }

    fn alpha_at(&self, y: Vector, time: f64) -> f64 {
        let norm = y.norm();
        let [still, growing] = self.adjugates(y);
        let [d0, d1, d2] = self.determinant;
        let [ro, rv] = self.roots;
        if !(still > ro * d0) && !(norm > ro) {
            return 0.0;
        }
        if rv == 0.0 || time == 0.0 {
            return f64::INFINITY;
        }
        // (r_o + r_v tau) det(tau) - still - growing tau: convex, and positive from the root on
        let k = [
            ro * d0 - still,
            ro * d1 + rv * d0 - growing,
            ro * d2 + rv * d1,
            rv * d2,
        ];
        let value = |s: f64| k[0] + s * (k[1] + s * (k[2] + s * k[3]));
        let mut tau = time;
        let mut found = value(tau);
        while found < 0.0 {
            tau *= 2.0;
            found = value(tau);
            if !(tau < f64::MAX.sqrt()) {
                return f64::INFINITY;
            }
        }
        for _ in 0..MAX_STEPS {
            let slope = k[1] + tau * (2.0 * k[2] + 3.0 * tau * k[3]);
            let next = tau - found / slope;
            // Newton's method from the right stays right of the root, up to rounding
            if !(next < tau * (1.0 - f64::EPSILON)) {
                break;
            }
            tau = next;
            found = value(tau);
            if found <= 0.0 {
                break;
            }
        }
        tau / time
    }
}

fn is_number(position: Vector, time: f64) -> bool {
    position.x.is_finite() && position.y.is_finite() && time.is_finite()
}

impl SpaceTimeObstacle for EllipsoidObstacle {
    fn name(&self) -> &str {
        &self.name
    }

    /// `n . p_t + sqrt(n' Q_t n)`. O(1).
    fn support(&self, normal: Vector, time: f64) -> Support {
        if let Some(flat) = &self.flat {
            return flat.support(normal, time);
        }
        let [still, growing] = self
            .axes
            .map(|[a, b]| normal.dot(&a).powi(2) + normal.dot(&b).powi(2));
        let (mean, reach) = (still + time * growing, self.reach(time));
        // the root of a product of two linear functions; its slope may be infinite at t = 0
        let rate = if self.roots[0] == 0.0 {
            (self.roots[1] * growing).sqrt()
        } else if mean > 0.0 {
            let share = (mean / reach).sqrt();
            0.5 * (self.roots[1] * share + growing / share)
        } else if growing > 0.0 {
            f64::INFINITY
        } else {
            0.0
        };
        Support {
            value: normal.dot(&self.center(time)) + (reach * mean).sqrt(),
            rate: normal.dot(&self.velocity.center()) + rate,
        }
    }

    /// Accurate to rounding; O(1), about five Newton steps.
    fn signed_distance(&self, position: Vector, time: f64) -> SignedDistance {
        if let Some(flat) = &self.flat {
            return flat.signed_distance(position, time);
        }
        let s = self.section(time);
        distance_in_frame(position - self.center(time), s.along, s.major, s.minor)
    }

    /// Paper eq. (19) with `t >= 0`. O(1).
    fn contains(&self, position: Vector, time: f64) -> bool {
        if let Some(flat) = &self.flat {
            return flat.contains(position, time);
        }
        let y = position - self.center(time);
        // negated so that a NaN is inside
        !(time < 0.0) && !(self.excess(y, time) > 0.0) && !self.is_beyond(y, time)
    }

    /// Exact on a line at depth 0. Otherwise conservative advancement on the signed distance: on
    /// arcs early by at most [`tolerance::GRAZE_M`] of depth.
    fn first_contact(&self, segment: &Segment, depth: f64) -> Option<f64> {
        if let Some(flat) = &self.flat {
            return flat.first_contact(segment, depth);
        }
        if segment.is_valid() && !segment.is_arc() && depth == 0.0 {
            return self.line_start(&Line::of(segment));
        }
        advanced_contact(self, segment, depth)
    }

    /// The positive root of a cubic, in O(1): the sets `O_alpha` at `t` are the sections at `alpha
    /// t` about the centre of `t`, docs/reference/theory.md section 4. With respect to the outer
    /// set, so never below that of the exact sum.
    fn alpha_within(&self, position: Vector, time: f64, edge: f64) -> f64 {
        if let Some(flat) = &self.flat {
            return flat.alpha_within(position, time, edge);
        }
        if time < 0.0 {
            return f64::INFINITY;
        }
        if !is_number(position, time) {
            return 0.0;
        }
        let y = position - self.center(time);
        let nominal = || self.initial.signed_distance(self.initial.center() + y);
        if edge > tolerance::FACE_M && nominal().distance <= edge {
            return 0.0;
        }
        self.alpha_at(y, time)
    }

    /// By bisection over contacts, to [`tolerance::RISK`]. Contacts are exact on lines and early by
    /// [`tolerance::GRAZE_M`] on arcs, which errs to the high side.
    fn peak_risk(&self, segment: &Segment) -> PeakRisk {
        match &self.flat {
            Some(flat) => flat.peak_risk(segment),
            None => peak_by_bisection(segment.start_time, |risk| {
                self.at_risk(risk).first_contact(segment, 0.0)
            }),
        }
    }

    fn at_risk(&self, risk: f64) -> Self {
        let velocity = self.velocity.scaled_about_center(level_of(risk));
        Self::new(self.name.clone(), self.initial, velocity)
    }

    /// Contact by the cubic; otherwise a search for the minimum of a convex function, about ten
    /// distance evaluations, to rounding.
    fn closest_approach(
        &self,
        position: Vector,
        velocity: Vector,
        horizon: f64,
    ) -> ClosestApproach {
        if let Some(flat) = &self.flat {
            return flat.closest_approach(position, velocity, horizon);
        }
        let Some(end) = usable_horizon(position, velocity, horizon) else {
            return ClosestApproach::contact(0.0);
        };
        let line = Line::ahead(position, velocity, end);
        if let Some(start) = self.line_start(&line) {
            return ClosestApproach::contact(start);
        }
        let w = self.relative(&line);
        let guess = -(position - self.initial.center()).dot(&w) / w.norm_squared();
        searched_approach(self, position, velocity, end, guess)
    }

    /// By the cubic, O(1).
    fn in_velocity_obstacle(&self, position: Vector, velocity: Vector, horizon: f64) -> bool {
        usable_horizon(position, velocity, horizon).is_none_or(|end| {
            self.line_start(&Line::ahead(position, velocity, end))
                .is_some()
        })
    }
}
