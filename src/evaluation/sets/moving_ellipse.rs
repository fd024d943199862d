//! Moving ellipse of the checker, represented by its support function alone.

use crate::evaluation::distance::least::{Least, Probe};
use crate::evaluation::distance::piece::Piece;
use crate::frame::{Vector, direction};
use crate::geometry::Ellipse;
use crate::tolerance;

/// Number of directions of the initial scan.
const DIRECTIONS: usize = 64;

/// Angle between two directions, radians.
const STEP: f64 = std::f64::consts::TAU / DIRECTIONS as f64;

/// Golden-section steps around the best direction. They determine the direction to 4e-8, so the
/// distance to 1e-15 of the set's size.
const GOLDEN_STEPS: usize = 32;

/// Relative rounding of a shape matrix and of its eigenvalues.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Ellipse of least trace around `O_0 + t V`, docs/theory.md section 3, by its support function
///
/// ```text
/// h(n, t) = n . p_t + sqrt((r_o + r_v t) (n' Q_o n / r_o + t n' Q_v n / r_v))
/// r = sqrt(trace Q)
/// ```
///
/// which is concave in time: it is the root of a product of two non-negative linear functions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MovingEllipse {
    initial: Ellipse,
    velocity: Ellipse,
    /// `r` of the initial ellipse in metres, and of the velocity ellipse in m/s.
    roots: [f64; 2],
    /// Directions of the initial scan, evenly spaced.
    directions: [Vector; DIRECTIONS],
}

/// Supporting line in a direction: its offset, and its outward speed.
#[derive(Debug, Clone, Copy)]
struct Line {
    support: f64,
    rate: f64,
}

impl MovingEllipse {
    pub fn new(initial: &Ellipse, velocity: &Ellipse) -> Self {
        let root = |e: &Ellipse| {
            let [a, b] = e.semi_axes();
            a.norm().hypot(b.norm())
        };
        Self {
            initial: *initial,
            velocity: *velocity,
            roots: [root(initial), root(velocity)],
            directions: std::array::from_fn(|k| direction(STEP * k as f64)),
        }
    }

    /// Returns false when every section is a point or a segment, to [`tolerance::THIN_ELLIPSE`].
    pub fn has_interior(&self) -> bool {
        let [a, b] = self.initial.semi_axes();
        let [c, d] = self.velocity.semi_axes();
        let spans = |p: Vector, q: Vector, lengths: f64| {
            // Negated on purpose: a NaN has an interior.
            !(crate::frame::cross(p, q).abs() <= tolerance::THIN_ELLIPSE * lengths)
        };
        let (still, moving) = (a.norm(), c.norm());
        spans(a, b, still * still)
            || spans(c, d, moving * moving)
            || [(a, c), (a, d), (b, c), (b, d)]
                .into_iter()
                .any(|(p, q)| spans(p, q, still * moving))
    }

    /// Depth at a time within which a motion is on the edge of the set, metres; `None` without an
    /// interior.
    pub fn edge(&self, time: f64) -> Option<f64> {
        self.has_interior()
            .then(|| tolerance::DEPTH_M + self.rounding(time))
    }

    /// Largest effect of the rounding of the shape matrices on a distance at a time, metres.
    ///
    /// A document states an ellipse with the semi-axes `a >= b` by its shape matrix. Rounding of
    /// the entries changes `b²` by some epsilons of `a²`, so `b` by that fraction of `a² / b`, or
    /// of `a²` by the square root where `b` is smaller still.
    pub fn rounding(&self, time: f64) -> f64 {
        let [still, moving] = [&self.initial, &self.velocity].map(Ellipse::semi_axes);
        let [long, short] = [0, 1].map(|axis| still[axis].norm() + moving[axis].norm() * time);
        if long > 0.0 {
            ROUNDING * long * long / (short + ROUNDING.sqrt() * long)
        } else {
            0.0
        }
    }

    fn line(&self, normal: Vector, time: f64) -> Line {
        let square = |e: &Ellipse| {
            let [a, b] = e.semi_axes();
            normal.dot(&a).powi(2) + normal.dot(&b).powi(2)
        };
        let [still, growing] = self.roots;
        let share = |square: f64, root: f64| if root > 0.0 { square / root } else { 0.0 };
        let (a, b) = (
            share(square(&self.initial), still),
            share(square(&self.velocity), growing),
        );
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
            support: normal.dot(&self.initial.center())
                + time * normal.dot(&self.velocity.center())
                + radius,
            rate: normal.dot(&self.velocity.center()) + rate,
        }
    }

    /// Least signed distance along a chain of pieces.
    ///
    /// The value is the largest over directions of the distance from a supporting line. Each line
    /// separates the set from the points beyond it, so the value never exceeds the true distance.
    /// It is smaller by at most a rounding, where the search ended beside the best direction: it
    /// errs toward rejection. Between two probes, a line stays below its tangent in time because it
    /// is concave. About a hundred directions per probe.
    pub fn least_distance<P: Piece>(&self, pieces: &[P]) -> Least {
        let mut least = Least::new();
        for s in pieces {
            for time in [s.start_time(), s.end_time()] {
                least.see(self.probe(s, time, 0.0).value, time);
            }
        }
        for s in pieces {
            least.search(s.start_time(), s.end_time(), |time, half| {
                self.probe(s, time, half)
            });
        }
        least
    }

    fn probe(&self, piece: &impl Piece, time: f64, half: f64) -> Probe {
        let position = piece.pose_at(time).position;
        // A comparison below loses a NaN, so it is caught here.
        if !(position.x.is_finite() && position.y.is_finite() && time.is_finite()) {
            return Probe {
                value: f64::NAN,
                lower: f64::NAN,
            };
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
        Probe {
            value: best,
            lower: best - rate.abs() * half - bend,
        }
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
