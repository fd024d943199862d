//! Risk: the factor by which a target's velocities must shrink until a point is out of reach, paper
//! eqs. (22)-(25), docs/reference/theory.md section 4.

use super::contact::Line;
use super::{HalfSpace, Obstacle, SpaceTimeObstacle};
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance;

/// The largest risk along a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeakRisk {
    /// In `[0, 1]`. Bisection errs to the high side by at most [`tolerance::RISK`].
    pub risk: f64,
    /// Seconds: a time at which it is attained; the start where the risk is 0 throughout.
    pub time: f64,
}

impl PeakRisk {
    /// A risk at a time, seconds.
    pub fn new(risk: f64, time: f64) -> Self {
        Self { risk, time }
    }
}

/// `1 - alpha`, clipped to `[0, 1]`; 1 where alpha is not a number.
pub(super) fn risk_of(alpha: f64) -> f64 {
    if alpha.is_nan() {
        1.0
    } else {
        (1.0 - alpha).clamp(0.0, 1.0)
    }
}

/// The level `1 - risk` of a set; 1, the whole set, for a risk outside `[0, 1]`.
pub(super) fn level_of(risk: f64) -> f64 {
    if (0.0..=1.0).contains(&risk) {
        1.0 - risk
    } else {
        1.0
    }
}

/// Level sets of a risk; the whole sets where it is 0.
pub fn level_sets(whole: &[Obstacle], risk: f64) -> Vec<Obstacle> {
    if risk > 0.0 {
        whole.iter().map(|set| set.at_risk(risk)).collect()
    } else {
        whole.to_vec()
    }
}

/// Dependence of one face on alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FaceSpread {
    /// `n . v` for the centroid `v` of the velocities, m/s.
    pub nominal_rate: f64,
    /// `1 / (h_V(n) - n . v)`, s/m; infinite where the face does not depend on alpha.
    pub per_rate: f64,
}

impl FaceSpread {
    pub(super) fn of(face: &HalfSpace, centroid: Vector) -> Self {
        let nominal_rate = face.normal.dot(&centroid);
        let spread = face.velocity_support - nominal_rate;
        // smaller spreads are rounding errors
        let none = tolerance::THIN * (face.velocity_support.abs() + nominal_rate.abs());
        Self {
            nominal_rate,
            per_rate: if spread > none {
                1.0 / spread
            } else {
                f64::INFINITY
            },
        }
    }
}

/// `alpha* = max over faces of (n . (x - v t) - h_O0(n)) / (t (h_V(n) - n . v))`,
/// docs/reference/theory.md section 4. Faces that the point exceeds by at most `edge` metres do not
/// count. O(n + m).
pub(super) fn polytope_alpha(
    faces: &[HalfSpace],
    spreads: &[FaceSpread],
    position: Vector,
    time: f64,
    edge: f64,
) -> f64 {
    if time < 0.0 {
        return f64::INFINITY;
    }
    let mut most = 0.0_f64;
    for (face, spread) in faces.iter().zip(spreads) {
        let beyond = face.normal.dot(&position) - spread.nominal_rate * time - face.initial_support;
        if beyond.is_nan() {
            return 0.0;
        }
        if beyond > edge {
            most = most.max(beyond * spread.per_rate);
        }
    }
    // 0 / 0 at the start, within O_0
    if most == 0.0 { 0.0 } else { most / time }
}

/// `a u + b`.
#[derive(Debug, Clone, Copy)]
struct Affine {
    slope: f64,
    value: f64,
}

impl Affine {
    fn at(&self, u: f64) -> f64 {
        self.slope * u + self.value
    }
}

/// The largest risk along a straight motion in closed form.
///
/// With `u = 1 / t` every face's ratio is affine, so alpha is a maximum of affine functions. Its
/// minimum is found by descent from both ends to the crossing of the active functions, in at most
/// as many steps as there are faces. Errs to the high side: a face that moves by at most
/// [`tolerance::LENGTH_M`] with alpha is placed where it is for alpha = 1.
pub(super) fn polytope_peak(faces: &[HalfSpace], spreads: &[FaceSpread], line: &Line) -> PeakRisk {
    let none = PeakRisk::new(0.0, line.start);
    let certain = PeakRisk { risk: 1.0, ..none };
    // the part of the motion inside all faces that do not depend on alpha
    let (mut start, mut end) = (line.start, line.end);
    let mut rows = Vec::with_capacity(faces.len() + 1);
    rows.push(Affine {
        slope: 0.0,
        value: 0.0,
    });
    for (face, spread) in faces.iter().zip(spreads) {
        let at_zero = face.normal.dot(&line.origin) - face.initial_support;
        let ahead = face.normal.dot(&line.velocity);
        let rate = ahead - spread.nominal_rate;
        if (at_zero + rate).is_nan() {
            return certain;
        }
        // faces that hardly depend on alpha stay at alpha = 1: their ratio would be rounding errors
        if line.end <= tolerance::LENGTH_M * spread.per_rate {
            let rate = ahead - face.velocity_support;
            if rate > 0.0 {
                end = end.min((tolerance::FACE_M - at_zero) / rate);
            } else if rate < 0.0 {
                start = start.max((tolerance::FACE_M - at_zero) / rate);
            } else if at_zero > tolerance::FACE_M {
                return none;
            }
        } else {
            rows.push(Affine {
                slope: at_zero * spread.per_rate,
                value: rate * spread.per_rate,
            });
        }
    }
    if start > end || end < 0.0 {
        return none;
    }
    let at = |time: f64| {
        let position = line.origin + line.velocity * time;
        polytope_alpha(faces, spreads, position, time, tolerance::FACE_M)
    };
    if at(start) == 0.0 {
        return PeakRisk::new(1.0, start);
    }
    // at t = 0 only O_0 is reachable
    if !(end > 0.0) {
        return none;
    }
    let highest = |u: f64| {
        let mut best = rows[0];
        for row in &rows[1..] {
            if row.at(u) > best.at(u) {
                best = *row;
            }
        }
        best
    };
    let (low, high) = (1.0 / end, 1.0 / start);
    let mut left = highest(low);
    let mut right = if high.is_finite() {
        highest(high)
    } else {
        let steeper = |a: &&Affine, b: &&Affine| {
            a.slope
                .total_cmp(&b.slope)
                .then(a.value.total_cmp(&b.value))
        };
        *rows.iter().max_by(steeper).unwrap_or(&rows[0])
    };
    let mut u = if left.slope >= 0.0 {
        low
    } else if right.slope <= 0.0 {
        high
    } else {
        f64::NAN
    };
    // lower bound of alpha on the line
    let mut bound = f64::INFINITY;
    if u.is_nan() {
        u = low;
        for _ in 0..rows.len() {
            u = ((right.value - left.value) / (left.slope - right.slope)).clamp(low, high);
            let best = highest(u);
            if best.slope == 0.0 {
                bound = f64::INFINITY;
                break;
            }
            // both are equal at the crossing; rounding affects the flatter one less
            bound = if left.slope.abs() < right.slope.abs() {
                left.at(u)
            } else {
                right.at(u)
            };
            if !(best.at(u) > bound + tolerance::RISK * bound.abs()) {
                break;
            }
            if best.slope < 0.0 {
                left = best;
            } else {
                right = best;
            }
        }
    }
    let time = (1.0 / u).clamp(start, end);
    // all three are alpha at that time; rounding errs to the high side of the risk
    let alpha = at(time).min(bound).min(highest(u).at(u)).max(0.0);
    PeakRisk::new(risk_of(alpha), time)
}

/// The largest risk along any segment, by bisection on the exact contact with level sets.
///
/// `contact` returns the first contact with the set of a risk. Errs to the high side by at most
/// [`tolerance::RISK`]; about 40 contacts.
pub(super) fn peak_by_bisection(
    start_time: f64,
    mut contact: impl FnMut(f64) -> Option<f64>,
) -> PeakRisk {
    let Some(first) = contact(0.0) else {
        return PeakRisk::new(0.0, start_time);
    };
    if let Some(time) = contact(1.0) {
        return PeakRisk { risk: 1.0, time };
    }
    let (mut met, mut clear, mut time) = (0.0, 1.0, first);
    while clear - met > tolerance::RISK {
        let risk = 0.5 * (met + clear);
        match contact(risk) {
            Some(instant) => (met, time) = (risk, instant),
            None => clear = risk,
        }
    }
    PeakRisk { risk: clear, time }
}
