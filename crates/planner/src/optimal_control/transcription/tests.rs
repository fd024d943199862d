//! Compares every derivative with differences, in SI and scaled.

use super::super::keep_out::ellipsoid;
use super::*;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom_model::vessel::{CyberShip2, FroudeScaled};

fn stage<V: Manoeuvring>(vessel: &V, size: f64, rng: &mut ChaCha8Rng) -> (f64, Span) {
    let unit = vessel.scales().state;
    let mut any = || StateVector::from_fn(|_, _| rng.random_range(-1.0..1.0)).component_mul(&unit);
    (
        2.0 * size,
        Span {
            reference: [any(), any(), any()],
        },
    )
}

/// All outputs of `values` as one function of the 15 variables, with given multipliers.
fn lagrangian<V: Manoeuvring>(
    problem: &Transcription<V>,
    w: &Triple<6, 3>,
    l: &StateVector,
    z: &[f64],
) -> f64 {
    let mut rows = vec![0.0; z.len()];
    let found = problem.values(0, w, &mut rows);
    found.cost + l.dot(&found.defect) - rows.iter().zip(z).map(|(g, z)| g * z).sum::<f64>()
}

fn entry(w: &mut Triple<6, 3>, i: usize) -> &mut f64 {
    match i {
        0..6 => &mut w.x[i],
        6..9 => &mut w.u[i - 6],
        _ => &mut w.y[i - 9],
    }
}

fn block(h: &Blocks<6, 3>, i: usize, j: usize) -> f64 {
    let (i, j) = (i.max(j), i.min(j));
    match (i, j) {
        (0..6, _) => h.xx[(i, j)],
        (6..9, 0..6) => h.ux[(i - 6, j)],
        (6..9, _) => h.uu[(i - 6, j - 6)],
        (_, 0..6) => h.yx[(i - 9, j)],
        (_, 6..9) => h.yu[(i - 9, j - 6)],
        _ => h.yy[(i - 9, j - 9)],
    }
}

fn derivatives_match<V: Manoeuvring>(vessel: &V, size: f64) {
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    for _ in 0..20 {
        let (step, span) = stage(vessel, size.sqrt(), &mut rng);
        let mut any = || -> f64 {
            rng.random_range(0.2..1.0) * if rng.random_bool(0.5) { 1.0 } else { -1.0 }
        };
        let unit = vessel.scales();
        let weights = Weights {
            state: StateVector::from_fn(|i, _| any().abs() / unit.state[i].powi(2)),
            force: ForceVector::from_fn(|i, _| any().abs() / unit.force[i].powi(2)),
        };
        let mut problem = Transcription::new(
            vessel,
            step,
            StateVector::zeros(),
            Controls {
                force_limits: unit.force,
                weights,
            },
            2.5,
            vec![span],
        );
        let keep = ellipsoid(
            [3.0 * size, 1.0],
            [0.2, -0.1],
            [size * size, 0.36 * size * size],
            [4e-4, 1e-4],
        );
        for (k, fraction) in [0.5, 1.0, 0.3].into_iter().enumerate() {
            problem.rows_mut()[0].push(Row::new(k, fraction, keep.at(fraction)));
        }
        let mut w = Triple::<6, 3>::zeros();
        for i in 0..15 {
            *entry(&mut w, i) = 0.5 * any();
        }
        let l = StateVector::from_fn(|_, _| any());
        let z = [any().abs(), any().abs(), any().abs()];
        let evaluated = |w: &Triple<6, 3>| {
            let mut out = Derivatives::zeros();
            let mut rows = [Triple::zeros(); 3];
            let multipliers = Multipliers {
                defect: &l,
                rows: &z,
            };
            problem.derivatives(0, w, multipliers, &mut out, &mut rows);
            (out, rows)
        };
        let (out, _) = evaluated(&w);
        let slope = |w: &Triple<6, 3>| {
            let (out, rows) = evaluated(w);
            let mut g = out.gradient;
            g.x += out.defect_x.tr_mul(&l);
            g.u += out.defect_u.tr_mul(&l);
            g.y += out.defect_y.tr_mul(&l);
            for (row, z) in rows.iter().zip(z) {
                g.x -= z * row.x;
                g.u -= z * row.u;
                g.y -= z * row.y;
            }
            g
        };
        let mut g = slope(&w);
        let mut whole = out.convex;
        whole.xx += out.curvature.xx;
        whole.yx += out.curvature.yx;
        whole.yy += out.curvature.yy;
        for i in 0..15 {
            let (mut up, mut down) = (w, w);
            *entry(&mut up, i) += 1e-5;
            *entry(&mut down, i) -= 1e-5;
            let rise = lagrangian(&problem, &up, &l, &z) - lagrangian(&problem, &down, &l, &z);
            let off = rise / 2e-5 - *entry(&mut g, i);
            assert!(off.abs() < 1e-6, "slope {i}: {off:e}");
            let (mut rise, mut fall) = (slope(&up), slope(&down));
            for j in 0..15 {
                let bend = (*entry(&mut rise, j) - *entry(&mut fall, j)) / 2e-5;
                let off = bend - block(&whole, i, j);
                assert!(
                    off.abs() < 1e-5 * (1.0 + bend.abs()),
                    "bend {i} {j}: {off:e} of {bend}"
                );
            }
        }
    }
}

#[test]
fn derivatives_match_differences_at_both_sizes() {
    derivatives_match(&CyberShip2::SMOOTH, 1.0);
    derivatives_match(&FroudeScaled::new(CyberShip2::SMOOTH, 70.0), 70.0);
}
