//! Moving ellipse of the checker, represented by its support function alone.

use crate::least::{Least, Probe};
use crate::moving_set::{MovingDisc, MovingVertex};
use crate::piece::Piece;
use searoom_geometry::Ellipse;
use searoom_geometry::frame::{Vector, cross, direction};
use searoom_geometry::tolerance;

/// Number of directions of the initial scan.
const DIRECTIONS: usize = 64;

/// Angle between two directions, radians.
const STEP: f64 = std::f64::consts::TAU / DIRECTIONS as f64;

/// Golden-section steps around the best direction. They determine the direction to 4e-8, so the
/// distance to 1e-15 of the set's size.
const GOLDEN_STEPS: usize = 32;

/// Relative rounding of a shape matrix and of its eigenvalues.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Ellipse of least trace around `O_0 + sum of d_j V_j + t V` for durations `d_j`,
/// docs/reference/theory.md section 3, by its support function
///
/// ```text
/// h(n, t) = n . p_t + sqrt((r + r_v t) (q(n) + t n' Q_v n / r_v))
/// r = r_o + sum of d_j r_j
/// q(n) = n' Q_o n / r_o + sum of d_j n' Q_j n / r_j
/// r_k = sqrt(trace Q_k)
/// ```
///
/// which is concave in time: it is the root of a product of two non-negative linear functions.
#[derive(Debug, Clone)]
pub(crate) struct MovingEllipse {
    /// The initial ellipse and the earlier velocity ellipses, each with its factor.
    earlier: Vec<(Term, f64)>,
    center: Vector,
    velocity: Term,
    /// Velocity of the centre, m/s.
    drift: Vector,
    /// `r`, metres.
    reach: f64,
    /// Directions of the initial scan, evenly spaced.
    directions: [Vector; DIRECTIONS],
}

/// An ellipse about the origin.
#[derive(Debug, Clone, Copy)]
struct Term {
    axes: [Vector; 2],
    /// `sqrt(trace Q)`.
    root: f64,
}

impl Term {
    fn new(ellipse: &Ellipse) -> Self {
        let axes = ellipse.semi_axes();
        Self {
            axes,
            root: axes[0].norm().hypot(axes[1].norm()),
        }
    }

    /// `n' Q n / sqrt(trace Q)`; 0 for a point.
    fn share(&self, normal: Vector) -> f64 {
        let [a, b] = self.axes;
        if self.root > 0.0 {
            (normal.dot(&a).powi(2) + normal.dot(&b).powi(2)) / self.root
        } else {
            0.0
        }
    }
}

/// Largest change of an ellipse's support by rounding of its shape matrix, for the semi-axes
/// `long >= short`. It is some epsilons of `long² / short`; where `short` is smaller still, the
/// square root of some epsilons of `long²`.
pub fn shape_rounding(long: f64, short: f64) -> f64 {
    if long > 0.0 {
        ROUNDING * long * long / (short + ROUNDING.sqrt() * long)
    } else {
        0.0
    }
}

/// Supporting line in a direction: its offset, and its outward speed.
#[derive(Debug, Clone, Copy)]
struct Line {
    support: f64,
    rate: f64,
}

impl MovingEllipse {
    /// From the ellipses whose sum is the initial section, each with its factor.
    pub fn new(earlier: &[(Ellipse, f64)], velocity: &Ellipse) -> Self {
        let centers = earlier.iter().map(|(e, factor)| e.center() * *factor);
        let center = centers.sum();
        let earlier: Vec<(Term, f64)> = (earlier.iter())
            .map(|(e, factor)| (Term::new(e), *factor))
            .collect();
        Self {
            reach: earlier.iter().map(|(e, factor)| factor * e.root).sum(),
            earlier,
            center,
            velocity: Term::new(velocity),
            drift: velocity.center(),
            directions: std::array::from_fn(|k| direction(STEP * k as f64)),
        }
    }

    /// Returns false when every section is a point or a segment, to [`tolerance::THIN_ELLIPSE`].
    pub fn has_interior(&self) -> bool {
        let terms = self.earlier.iter().map(|(e, _)| e);
        let axes: Vec<(Vector, f64)> = terms
            .chain([&self.velocity])
            .flat_map(|e| e.axes.map(|axis| (axis, e.axes[0].norm())))
            .collect();
        let spans = |(p, long): &(Vector, f64), (q, other): &(Vector, f64)| {
            // Negated on purpose: a NaN has an interior.
            !(cross(*p, *q).abs() <= tolerance::THIN_ELLIPSE * (long * other))
        };
        let mut pairs = axes.iter().enumerate();
        pairs.any(|(k, a)| axes[k + 1..].iter().any(|b| spans(a, b)))
    }

    /// Largest effect of the rounding of the shape matrices on a distance at a time, metres.
    ///
    /// A document states an ellipse with the semi-axes `a >= b` by its shape matrix. Rounding of
    /// the entries changes `n' Q n` by some epsilons of `a²`. The section's support then changes by
    /// [`shape_rounding`] of its own lesser semi-axis.
    pub fn rounding(&self, time: f64) -> f64 {
        let [long, short] = self.semi_axes(time);
        shape_rounding(long, short)
    }

    /// Upper bound of the greater semi-axis of the section at a time, and its lesser semi-axis,
    /// metres.
    pub fn semi_axes(&self, time: f64) -> [f64; 2] {
        let terms = self.earlier.iter().copied();
        let terms = terms.chain([(self.velocity, time)]);
        let reach = self.reach + self.velocity.root * time;
        let [mut xx, mut xy, mut yy, mut long] = [0.0; 4];
        for (term, factor) in terms.filter(|(term, _)| term.root > 0.0) {
            let weight = reach * factor / term.root;
            for axis in term.axes {
                xx += weight * axis.x * axis.x;
                xy += weight * axis.x * axis.y;
                yy += weight * axis.y * axis.y;
            }
            long += weight * term.axes[0].norm_squared();
        }
        let least = 0.5 * (xx + yy) - (0.5 * (xx - yy)).hypot(xy);
        [long.sqrt(), least.max(0.0).sqrt()]
    }

    fn line(&self, normal: Vector, time: f64) -> Line {
        let (still, growing) = (self.reach, self.velocity.root);
        let earlier = (self.earlier.iter()).map(|(e, factor)| factor * e.share(normal));
        let (a, b) = (earlier.sum::<f64>(), self.velocity.share(normal));
        let (reach, mean) = (still + growing * time, a + b * time);
        let radius = (reach * mean).sqrt();
        let rate = if still == 0.0 {
            (growing * b).sqrt()
        } else if growing == 0.0 {
            0.0
        } else {
            // Infinite at the instant at which a segment starts to widen.
            let opening = if b > 0.0 {
                b * (reach / mean).sqrt()
            } else {
                0.0
            };
            0.5 * (growing * (mean / reach).sqrt() + opening)
        };
        Line {
            support: normal.dot(&self.center) + time * normal.dot(&self.drift) + radius,
            rate: normal.dot(&self.drift) + rate,
        }
    }

    /// Least signed distance along a chain of pieces.
    ///
    /// The value is the largest over directions of the distance from a supporting line. Each line
    /// separates the set from the points beyond it, so the value never exceeds the true distance.
    /// It is smaller by at most a rounding, where the search ended beside the best direction: it
    /// errs toward rejection. Between two probes, a line stays below its tangent in time because it
    /// is concave. About a hundred directions per probe.
    ///
    /// With a `known` least distance to something else, parts that are not nearer are not refined.
    pub fn least_distance_below<P: Piece>(&self, known: Least, pieces: &[P]) -> Least {
        let mut least = known;
        for s in pieces {
            for time in [s.start_time(), s.end_time()] {
                let found = self.probe(s, [time, 0.0], least.value);
                least.see(found.value, time);
            }
        }
        for s in pieces {
            least.search(s.start_time(), s.end_time(), |time, half, known| {
                self.probe(s, [time, half], known)
            });
        }
        least
    }

    /// Disc that contains the section at every time.
    pub fn disc(&self) -> MovingDisc {
        MovingDisc {
            center: MovingVertex {
                initial: self.center,
                velocity: self.drift,
            },
            radius: self.reach,
            growth: self.velocity.root,
        }
    }

    fn probe(&self, piece: &impl Piece, [time, half]: [f64; 2], known: f64) -> Probe {
        let position = piece.pose_at(time).position;
        // A comparison below loses a NaN, so it is caught here.
        if !(position.x.is_finite() && position.y.is_finite() && time.is_finite()) {
            return Probe::new(f64::NAN, f64::NAN);
        }
        let apart = self.disc().least_distance(piece, [time, half]);
        if let Some(far) = Probe::beyond(known, apart) {
            return far;
        }
        let beyond = |normal: Vector| normal.dot(&position) - self.line(normal, time).support;
        let sampled = self.directions.map(beyond);
        // Inside the set there may be several local maxima.
        let (mut angle, mut best) = (0.0, f64::NEG_INFINITY);
        for (k, here) in sampled.iter().enumerate() {
            let before = sampled[(k + DIRECTIONS - 1) % DIRECTIONS];
            let after = sampled[(k + 1) % DIRECTIONS];
            if *here >= before && *here >= after {
                let (other, found) =
                    golden_maximum(STEP * k as f64, STEP, |a| beyond(direction(a)));
                if found > best {
                    (angle, best) = (other, found);
                }
            }
        }
        let normal = direction(angle);
        let rate = normal.dot(&piece.velocity_at(time)) - self.line(normal, time).rate;
        let bend = 0.5 * half * half * piece.bounds().acceleration;
        Probe::new(best, best - rate.abs() * half - bend)
    }
}

/// Golden-section search: returns the argument and the value of the maximum within `reach` of
/// `place`.
fn golden_maximum(place: f64, reach: f64, value: impl Fn(f64) -> f64) -> (f64, f64) {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (place - reach, place + reach);
    let (mut left, mut right) = (high - golden * 2.0 * reach, low + golden * 2.0 * reach);
    let (mut at_left, mut at_right) = (value(left), value(right));
    for _ in 0..GOLDEN_STEPS {
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
    [(left, at_left), (right, at_right)]
        .into_iter()
        .fold((place, value(place)), |a, b| if b.1 > a.1 { b } else { a })
}

#[cfg(test)]
mod tests {
    use super::*;
    /// Two segments across one another: each is thin, their sum is not.
    #[test]
    fn rounding_is_that_of_the_section_and_not_of_its_parts() {
        let segment = |a: f64, b: f64| {
            Ellipse::new(
                Vector::zeros(),
                nalgebra::Matrix2::new(a * a, 0.0, 0.0, b * b),
            )
            .expect("a segment")
        };
        let crossed = MovingEllipse::new(&[(segment(1500.0, 0.0), 1.0)], &segment(0.0, 5.0));
        assert!(crossed.rounding(0.0) > 1e-5);
        assert!(
            crossed.rounding(100.0) < 1e-9,
            "{}",
            crossed.rounding(100.0)
        );
    }
}
