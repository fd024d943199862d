//! The smallest ellipse around a polygon.

use std::f64::consts::FRAC_PI_4;

use nalgebra::{Matrix2, Matrix3, Vector3};

use super::Ellipse;
use crate::ConvexPolygon;
use crate::frame::{Vector, to_port};
use crate::tolerance;

/// Number of vertices up to which the working set is all of them.
const FEW: usize = 32;

/// Bound on the steps; some hundred are usual.
const MAX_STEPS: usize = 20_000;

/// The smallest ellipse by area that contains `set` (its Loewner ellipse), as an outer
/// approximation.
///
/// Every vertex passes [`Ellipse::contains`] after rounding, and the area exceeds the minimum by at
/// most 1e-8 of it. A point is exact; a segment becomes an ellipse some roundings wide. Khachiyan's
/// ascent with the away steps of Wolfe and Atwood (Todd and Yıldırım 2007,
/// doi:10.1016/j.dam.2007.02.013), O(vertices) per step and linear convergence.
pub fn outer_enclosing_ellipse(set: &ConvexPolygon) -> Ellipse {
    let vertices = set.vertices();
    let ellipse = match vertices {
        [p] => return Ellipse::point(*p),
        [a, b] => {
            let (center, half) = ((a + b) * 0.5, (b - a) * 0.5);
            let width = 8.0 * f64::EPSILON * (center.norm() + half.norm());
            Ellipse::from_axes(center, [half, to_port(half) / half.norm() * width])
        }
        _ => loewner(vertices),
    };
    grown_to_contain(ellipse, vertices)
}

fn loewner(vertices: &[Vector]) -> Ellipse {
    let count = vertices.len() as f64;
    let mean = vertices.iter().sum::<Vector>() / count;
    // the problem is well conditioned in the frame of the covariance, whatever the shape
    let covariance = vertices
        .iter()
        .map(|p| (p - mean) * (p - mean).transpose())
        .sum::<Matrix2<f64>>()
        / count;
    let eigen = covariance.symmetric_eigen();
    let along = eigen.eigenvectors.column(eigen.eigenvalues.imax());
    let unit = [along.into_owned(), to_port(along.into_owned())];
    let spread = unit.map(|u| {
        let largest = vertices
            .iter()
            .map(|p| u.dot(&(p - mean)).abs())
            .fold(0.0, f64::max);
        largest.max(f64::MIN_POSITIVE)
    });
    let lifted: Vec<Vector3<f64>> = vertices
        .iter()
        .map(|p| {
            let y = p - mean;
            Vector3::new(
                unit[0].dot(&y) / spread[0],
                unit[1].dot(&y) / spread[1],
                1.0,
            )
        })
        .collect();
    let moment = weighted_moment(&lifted);
    let c = Vector::new(moment[(0, 2)], moment[(1, 2)]);
    let shape = 2.0 * (moment.fixed_view::<2, 2>(0, 0) - c * c.transpose());
    // explicit 2 × 2 Cholesky factorisation that cannot fail for a set thinner than rounding
    let l00 = shape[(0, 0)].max(0.0).sqrt();
    let l10 = if l00 > 0.0 { shape[(1, 0)] / l00 } else { 0.0 };
    let l11 = (shape[(1, 1)] - l10 * l10).max(0.0).sqrt();
    let back = |z: Vector| unit[0] * (spread[0] * z.x) + unit[1] * (spread[1] * z.y);
    Ellipse::from_axes(
        mean + back(c),
        [back(Vector::new(l00, l10)), back(Vector::new(0.0, l11))],
    )
}

/// `sum w_i q_i q_i'` for the weights that maximise its determinant. Few points have a weight: the
/// ascent runs on a working set, which takes in the point farthest outside until none is.
fn weighted_moment(points: &[Vector3<f64>]) -> Matrix3<f64> {
    let mut working = first_working_set(points);
    let mut weights = vec![1.0 / working.len() as f64; working.len()];
    let moment = |working: &[usize], weights: &[f64]| {
        let mut sum = Matrix3::zeros();
        for (w, i) in weights.iter().zip(working) {
            sum += (points[*i] * points[*i].transpose()) * *w;
        }
        sum
    };
    for _ in 0..MAX_STEPS {
        let Some(inverse) = moment(&working, &weights).try_inverse() else {
            break;
        };
        let value = |i: usize| points[i].dot(&(inverse * points[i]));
        let (mut most, mut least) = ((0, f64::NEG_INFINITY), (0, f64::INFINITY));
        for (place, i) in working.iter().enumerate() {
            let value = value(*i);
            if value > most.1 {
                most = (place, value);
            }
            if weights[place] > 0.0 && value < least.1 {
                least = (place, value);
            }
        }
        let (over, under) = (most.1 - 3.0, 3.0 - least.1);
        if !(over.max(under) > tolerance::LOEWNER) {
            let all = (0..points.len()).map(|i| (i, value(i)));
            match all.max_by(|a, b| a.1.total_cmp(&b.1)) {
                Some((i, value)) if value - 3.0 > tolerance::LOEWNER && !working.contains(&i) => {
                    working.push(i);
                    weights.push(0.0);
                    continue;
                }
                _ => break,
            }
        }
        let (index, step) = if over > under {
            (most.0, over / (3.0 * (most.1 - 1.0)))
        } else {
            let all = weights[least.0] / (1.0 - weights[least.0]);
            let step = if least.1 > 1.0 {
                under / (3.0 * (least.1 - 1.0))
            } else {
                f64::INFINITY
            };
            (least.0, -step.min(all))
        };
        for w in &mut weights {
            *w *= 1.0 - step;
        }
        weights[index] = (weights[index] + step).max(0.0);
    }
    moment(&working, &weights)
}

/// Indices of the first working set: all points if they are few, else the farthest ones in eight
/// directions.
fn first_working_set(points: &[Vector3<f64>]) -> Vec<usize> {
    if points.len() <= FEW {
        return (0..points.len()).collect();
    }
    let mut found: Vec<usize> = (0..8)
        .filter_map(|k| {
            let (sine, cosine) = (f64::from(k) * FRAC_PI_4).sin_cos();
            let along = |i: &usize| points[*i].x * cosine + points[*i].y * sine;
            (0..points.len()).max_by(|a, b| along(a).total_cmp(&along(b)))
        })
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// The ellipse scaled about its centre by the least factor that contains every point after
/// rounding.
fn grown_to_contain(ellipse: Ellipse, points: &[Vector]) -> Ellipse {
    let [a, b] = ellipse.semi_axes();
    let reach = points
        .iter()
        .map(|p| {
            let y = p - ellipse.center();
            (y.dot(&a) / a.norm_squared()).hypot(y.dot(&b) / b.norm_squared())
        })
        .fold(0.0, f64::max);
    let mut margin = f64::EPSILON;
    loop {
        let grown = ellipse.scaled_about_center(reach * (1.0 + margin));
        if points.iter().all(|p| grown.contains(*p)) || !(margin < 1.0) {
            return grown;
        }
        margin *= 2.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{cross, direction};
    use crate::geometry_fixtures::random_vector;
    use crate::outer_disc;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::f64::consts::PI;

    fn hull(points: &[Vector]) -> ConvexPolygon {
        ConvexPolygon::hull(points).expect("finite")
    }

    #[test]
    fn every_vertex_is_inside_after_rounding() {
        let mut rng = ChaCha8Rng::seed_from_u64(21);
        for case in 0..3000 {
            let n = rng.random_range(1..30);
            let thin = [1.0, 1e-2, 1e-6, 1e-9, 0.0][case % 5];
            let far = [0.0, 1e3, 1e6][case % 3];
            let ahead = direction(0.1 * case as f64);
            let points: Vec<Vector> = (0..n)
                .map(|_| random_vector(&mut rng, 50.0))
                .map(|p| ahead * p.x + to_port(ahead) * (p.y * thin) + Vector::new(far, -far))
                .collect();
            let set = hull(&points);
            let ellipse = outer_enclosing_ellipse(&set);
            for p in set.vertices() {
                assert!(ellipse.contains(*p), "{set:?} {ellipse:?}");
            }
            // John's theorem: the ellipse scaled by one half lies within the set
            let half = ellipse.scaled_about_center(0.5);
            for i in 0..32 {
                let n = direction(f64::from(i) * 0.2);
                let excess = half.support(n) - set.support(n);
                assert!(excess <= 1e-7 * (1.0 + far), "{set:?} {excess}");
            }
        }
    }

    #[test]
    fn known_shapes_have_their_known_ellipses() {
        let relative = |found: f64, known: f64| (found / known - 1.0).abs();
        let a = Vector::new(0.0, 0.0);
        let b = Vector::new(7.0, 1.0);
        let c = Vector::new(2.0, 5.0);
        // Steiner's ellipse of a triangle
        let steiner = 4.0 * PI / (3.0 * 3.0_f64.sqrt()) * 0.5 * cross(b - a, c - a);
        let found = outer_enclosing_ellipse(&hull(&[a, b, c]));
        assert!(relative(found.area(), steiner) < 1e-8);
        assert!((found.center() - (a + b + c) / 3.0).norm() < 1e-8);
        let rectangle = ConvexPolygon::rectangle(Vector::zeros(), 30.0, 6.0);
        let found = outer_enclosing_ellipse(&rectangle).semi_axes();
        assert!(relative(found[0].norm(), 30.0 * 2.0_f64.sqrt()) < 1e-8);
        assert!(relative(found[1].norm(), 6.0 * 2.0_f64.sqrt()) < 1e-8);
        let on_ellipse = |k: u32| {
            let (sine, cosine) = (f64::from(k) * PI / 150.0).sin_cos();
            Vector::new(30.0 * cosine, 6.0 * sine)
        };
        let many: Vec<Vector> = (0..300).map(on_ellipse).collect();
        let found = outer_enclosing_ellipse(&hull(&many)).semi_axes();
        assert!(relative(found[0].norm(), 30.0) < 1e-7);
        assert!(relative(found[1].norm(), 6.0) < 1e-7);
        let disc = outer_enclosing_ellipse(&outer_disc(10.0, 0.4));
        assert!(relative(disc.area(), PI * (10.0 / (PI / 16.0).cos()).powi(2)) < 1e-8);
    }

    #[test]
    fn no_ellipse_of_a_random_search_is_smaller() {
        let mut rng = ChaCha8Rng::seed_from_u64(22);
        for _ in 0..100 {
            let n = rng.random_range(3..9);
            let points: Vec<Vector> = (0..n).map(|_| random_vector(&mut rng, 5.0)).collect();
            let set = hull(&points);
            let found = outer_enclosing_ellipse(&set);
            let mut best = found;
            for k in 0..3000 {
                let size = 0.3_f64.powi(k / 300);
                let mut shake =
                    || Vector::new(rng.random::<f64>() - 0.5, rng.random::<f64>() - 0.5) * size;
                let (moved, [a, b]) = (best.center() + shake(), best.semi_axes());
                let other = Ellipse::from_axes(moved, [a + shake(), b + shake()]);
                let other = grown_to_contain(other, set.vertices());
                if other.area() < best.area() {
                    best = other;
                }
            }
            assert!(found.area() <= best.area() * (1.0 + 1e-8), "{set:?}");
        }
    }
}
