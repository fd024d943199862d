//! Bound on the error of a ship that must stay within half-planes and outside obstacles during an
//! interval: part of [`crate::planner::space_time::bound::tight`].

use std::f64::consts::FRAC_PI_2;

use crate::frame::{Vector, direction, heading_of};
use crate::planner::space_time::bound::obstacle::ObstacleBound;

/// Angles from the perpendicular to the path, radians, positive toward straight ahead.
const OBLIQUE_RAD: [f64; OBLIQUE] = [-1.0, -0.4, 0.2, 0.7, 1.1, 1.57];
pub(crate) const OBLIQUE: usize = 6;

/// Directions in which progress is bounded: perpendicular to the path, straight ahead, and
/// [`OBLIQUE_RAD`].
pub(crate) const DIRECTIONS: usize = OBLIQUE + 2;

/// Obstacle faces and directions of progress on one side of the leg. Headings are relative to the
/// leg.
#[derive(Debug)]
pub(crate) struct SideGeometry {
    /// Heading of every direction, radians, and its unit vector.
    pub headings: [f64; DIRECTIONS],
    pub directions: [Vector; DIRECTIONS],
    pub half_planes: [HalfPlane; OBLIQUE],
    /// Products of each face of all obstacles, in order, with each half-plane.
    pairs: Vec<[Pair; OBLIQUE]>,
}

/// Half-plane that contains own ship: its outer normal in the metric of the error.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HalfPlane {
    pub metric: Vector,
    pub scale: f64,
}

/// Two unit normals: their product and the inverse square of the sine between them, zero where
/// parallel.
#[derive(Debug, Clone, Copy)]
struct Pair {
    cosine: f64,
    spread: f64,
}

impl Pair {
    fn new(cosine: f64) -> Self {
        let square = 1.0 - cosine * cosine;
        Self {
            cosine,
            spread: if square < 1e-9 { 0.0 } else { 1.0 / square },
        }
    }

    /// Least squared norm of a vector with at least these components along the two normals; the
    /// first is positive.
    fn least_square(self, a: f64, b: f64) -> f64 {
        if self.spread == 0.0 {
            fast_max(a, b).powi(2)
        } else if b <= self.cosine * a {
            a * a
        } else if b > 0.0 && a <= self.cosine * b {
            b * b
        } else {
            (a * a + b * b - 2.0 * self.cosine * a * b) * self.spread
        }
    }
}

impl SideGeometry {
    /// `side` is 1 where the path is to port.
    pub(crate) fn new(side: f64, root: f64, obstacle_bound: &ObstacleBound) -> Self {
        let mut headings = [0.0; DIRECTIONS];
        headings[0] = side * FRAC_PI_2;
        let half_planes: [HalfPlane; OBLIQUE] = std::array::from_fn(|k| {
            let normal = Vector::new(OBLIQUE_RAD[k].sin(), side * OBLIQUE_RAD[k].cos());
            headings[k + 2] = heading_of(normal);
            let metric = Vector::new(normal.x / root, normal.y);
            let scale = metric.norm();
            HalfPlane {
                metric: metric / scale,
                scale,
            }
        });
        let faces = obstacle_bound.obstacles().iter().flat_map(|b| &b.faces);
        let pairs = faces
            .map(|f| half_planes.map(|l| Pair::new(-l.metric.dot(&f.metric))))
            .collect();
        Self {
            headings,
            directions: headings.map(direction),
            half_planes,
            pairs,
        }
    }
}

/// Constraints on own ship in one interval.
pub(crate) struct HalfPlaneBound<'a> {
    pub obstacle_bound: &'a ObstacleBound,
    pub geometry: &'a SideGeometry,
    pub reach_times: &'a [f64],
    /// Least distance of the scheduled point beyond each half-plane, metres.
    pub half_planes: [f64; OBLIQUE],
}

impl HalfPlaneBound<'_> {
    /// Least mean squared error between two times, outside every obstacle and within the
    /// half-planes. `known` is the bound by the half-planes alone.
    pub(crate) fn least(&self, known: f64, from: f64, to: f64) -> f64 {
        let mut greatest = known;
        let mut first = 0;
        for body in self.obstacle_bound.obstacles() {
            let faces = first..first + body.faces.len();
            first = faces.end;
            if to < body.from || from > body.to {
                continue;
            }
            let (mut a, mut b) = (f64::INFINITY, f64::INFINITY);
            let mut shallowest = (f64::INFINITY, first);
            for (face, index) in body.faces.iter().zip(faces.clone()) {
                if self.reach_times[index] <= to {
                    let (start, end) = (face.depth_at(from), face.depth_at(to));
                    (a, b) = (fast_min(start, a), fast_min(end, b));
                    let depth = fast_min(start, end);
                    if depth < shallowest.0 {
                        shallowest = (depth, index);
                    }
                }
            }
            greatest = fast_max(greatest, squared_chord(a, b));
            // beyond a face that is not deep, only the half-planes count
            if !(shallowest.0 > 0.0) || greatest == f64::INFINITY {
                continue;
            }
            // the smallest first: it decides most of the others
            let mut joint = self.beyond_face(shallowest.0, shallowest.1);
            for (face, index) in body.faces.iter().zip(faces) {
                if joint <= greatest {
                    break;
                }
                if self.reach_times[index] <= to {
                    let depth = fast_min(face.depth_at(from), face.depth_at(to));
                    if depth * depth < joint {
                        joint = fast_min(self.beyond_face(depth, index), joint);
                    }
                }
            }
            greatest = fast_max(greatest, joint);
        }
        greatest
    }

    /// Least squared error of a point beyond a face and within the half-planes.
    fn beyond_face(&self, depth: f64, face: usize) -> f64 {
        let pairs = self.geometry.pairs[face].iter();
        pairs
            .zip(&self.half_planes)
            .map(|(pair, beyond)| pair.least_square(depth, *beyond))
            .fold(depth * depth, fast_max)
    }
}

/// Minimum; `b` when `a` is a NaN. Compiles to one instruction, unlike [`f64::min`].
pub(crate) fn fast_min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Maximum; `b` when `a` is a NaN.
pub(crate) fn fast_max(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Mean of the squared positive part along a line from `a` to `b`.
pub(crate) fn squared_chord(a: f64, b: f64) -> f64 {
    let (low, high) = (fast_min(a, b), fast_max(a, b));
    if high <= 0.0 {
        0.0
    } else if low >= 0.0 {
        (a * a + a * b + b * b) * (1.0 / 3.0)
    } else {
        high * high * high / (3.0 * (high - low))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_of_normals_gives_the_least_of_a_dense_scan() {
        for (a, b, angle) in [
            (1.0, 0.5, 0.3_f64),
            (1.0, 0.9, 2.0),
            (0.7, -0.3, 1.9),
            (0.2, 1.0, 1.2),
        ] {
            let mut least = f64::INFINITY;
            for i in -400..=400 {
                for k in -400..=400 {
                    let v = Vector::new(f64::from(i), f64::from(k)) * 0.01;
                    let second = v.x * angle.cos() + v.y * angle.sin();
                    if v.x >= a && second >= b {
                        least = least.min(v.norm());
                    }
                }
            }
            let found = Pair::new(angle.cos()).least_square(a, b).sqrt();
            assert!(
                (found - least).abs() < 0.02,
                "{a} {b} {angle}: {found} {least}"
            );
        }
    }
}
