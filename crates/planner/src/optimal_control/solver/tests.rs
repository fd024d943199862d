//! Small problems with known solutions.

use super::riccati::{RightSide, StageFactor, eliminate, factorise};
use super::*;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Test problem: `1/2 w' H w + g . w`, `y = A x + B u + c`, linear rows `G w - d >= 0`, and the
/// nonlinearity of the dynamics.
#[derive(Debug, Clone)]
struct Toy<const N: usize, const M: usize> {
    stages: usize,
    first: Vector<N>,
    limits: [Vector<M>; 2],
    cost: Blocks<N, M>,
    slope: Triple<N, M>,
    a: Matrix<N, N>,
    b: Matrix<N, M>,
    bend: f64,
    rows: Vec<(Triple<N, M>, f64)>,
}

impl<const N: usize, const M: usize> Toy<N, M> {
    fn new(stages: usize, first: Vector<N>, a: Matrix<N, N>, b: Matrix<N, M>) -> Self {
        Self {
            stages,
            first,
            limits: [
                Vector::repeat(f64::NEG_INFINITY),
                Vector::repeat(f64::INFINITY),
            ],
            cost: Blocks {
                uu: Matrix::identity(),
                yy: Matrix::identity(),
                ..Blocks::zeros()
            },
            slope: Triple::zeros(),
            a,
            b,
            bend: 0.0,
            rows: Vec::new(),
        }
    }

    fn cold(&self) -> Iterate<N, M> {
        Iterate::guess(
            vec![self.first; self.stages + 1],
            vec![Vector::zeros(); self.stages],
        )
    }

    fn solve(&self, settings: &Settings) -> (SolverReport, Iterate<N, M>) {
        let mut at = self.cold();
        let report = solve(self, &mut at, &mut Workspace::new(self), settings, &|| true);
        (report, at)
    }
}

/// `x' = x + u`.
fn scalar(stages: usize, first: f64) -> Toy<1, 1> {
    let one = Matrix::identity();
    Toy::new(stages, Vector::<1>::new(first), one, one)
}

fn times<const N: usize, const M: usize>(h: &Blocks<N, M>, at: &Triple<N, M>) -> Triple<N, M> {
    Triple {
        x: h.xx * at.x + h.ux.tr_mul(&at.u) + h.yx.tr_mul(&at.y),
        u: h.ux * at.x + h.uu * at.u + h.yu.tr_mul(&at.y),
        y: h.yx * at.x + h.yu * at.u + h.yy * at.y,
    }
}

impl<const N: usize, const M: usize> StageProblem<N, M> for Toy<N, M> {
    fn stages(&self) -> usize {
        self.stages
    }

    fn first(&self) -> Vector<N> {
        self.first
    }

    fn limits(&self) -> [Vector<M>; 2] {
        self.limits
    }

    fn rows(&self, _: usize) -> usize {
        self.rows.len()
    }

    fn values(&self, _: usize, at: &Triple<N, M>, rows: &mut [f64]) -> Values<N> {
        for (to, (g, d)) in rows.iter_mut().zip(&self.rows) {
            *to = g.dot(at) - d;
        }
        Values {
            cost: 0.5 * times(&self.cost, at).dot(at) + self.slope.dot(at),
            defect: at.y - self.a * at.x - self.b * at.u - self.bend * at.x.map(f64::sin),
        }
    }

    fn derivatives(
        &self,
        _: usize,
        at: &Triple<N, M>,
        multipliers: Multipliers<N>,
        out: &mut Derivatives<N, M>,
        rows: &mut [Triple<N, M>],
    ) {
        out.gradient = times(&self.cost, at);
        out.gradient.add_scaled(1.0, &self.slope);
        out.defect_x = -self.a - Matrix::from_diagonal(&(self.bend * at.x.map(f64::cos)));
        out.defect_u = -self.b;
        out.defect_y = Matrix::identity();
        out.convex = self.cost;
        out.curvature = Blocks::zeros();
        let bent = self.bend * at.x.map(f64::sin).component_mul(multipliers.defect);
        out.curvature.xx = Matrix::from_diagonal(&bent);
        for (to, (g, _)) in rows.iter_mut().zip(&self.rows) {
            *to = *g;
        }
    }
}

/// Symmetric positive definite matrix over all variables of a stage, by blocks.
fn positive(rng: &mut ChaCha8Rng) -> Blocks<4, 2> {
    let root = Matrix::<10, 10>::from_fn(|_, _| rng.random_range(-1.0..1.0));
    let full = root * root.transpose() + Matrix::identity() * 0.1;
    Blocks {
        xx: full.fixed_view::<4, 4>(0, 0).into_owned(),
        ux: full.fixed_view::<2, 4>(4, 0).into_owned(),
        uu: full.fixed_view::<2, 2>(4, 4).into_owned(),
        yx: full.fixed_view::<4, 4>(6, 0).into_owned(),
        yu: full.fixed_view::<4, 2>(6, 4).into_owned(),
        yy: full.fixed_view::<4, 4>(6, 6).into_owned(),
    }
}

/// The step and the multipliers satisfy every equation of the linear system: its solution, as the
/// system of a convex problem is regular.
#[test]
fn the_recursion_solves_the_equations() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    for stages in [1, 2, 7] {
        let mut any = |_: usize, _: usize| rng.random_range(-1.0..1.0);
        let mut derivatives = vec![Derivatives::<4, 2>::zeros(); stages];
        let mut gradient = vec![Triple::<4, 2>::zeros(); stages];
        let mut defect = vec![Vector::<4>::zeros(); stages];
        for k in 0..stages {
            let d = &mut derivatives[k];
            d.defect_x = Matrix::from_fn(&mut any);
            d.defect_u = Matrix::from_fn(&mut any);
            d.defect_y = Matrix::identity() * 2.0 + Matrix::from_fn(&mut any);
            gradient[k].x = Vector::from_fn(&mut any);
            gradient[k].u = Vector::from_fn(&mut any);
            gradient[k].y = Vector::from_fn(&mut any);
            defect[k] = Vector::from_fn(&mut any);
        }
        let hessian: Vec<Blocks<4, 2>> = (0..stages).map(|_| positive(&mut rng)).collect();
        let mut factors = vec![StageFactor::new(); stages];
        assert!(eliminate(&mut factors, &derivatives));
        assert!(factorise(&mut factors, &hessian));
        let mut steps = vec![Triple::zeros(); stages];
        let mut multipliers = vec![Vector::zeros(); stages];
        let right = RightSide {
            gradient: &gradient,
            defect: &defect,
        };
        riccati::solve(&mut factors, right, &mut steps, &mut multipliers);
        // of the Lagrangian by the variables of each stage
        let slopes: Vec<Triple<4, 2>> = (0..stages)
            .map(|k| {
                let (d, l) = (&derivatives[k], &multipliers[k]);
                let mut slope = times(&hessian[k], &steps[k]);
                slope.add_scaled(1.0, &gradient[k]);
                slope.x += d.defect_x.tr_mul(l);
                slope.u += d.defect_u.tr_mul(l);
                slope.y += d.defect_y.tr_mul(l);
                slope
            })
            .collect();
        for (k, (d, step)) in derivatives.iter().zip(&steps).enumerate() {
            let left = d.defect_x * step.x + d.defect_u * step.u + d.defect_y * step.y + defect[k];
            let before = if k == 0 {
                Vector::zeros()
            } else {
                steps[k - 1].y
            };
            let after = slopes.get(k + 1).map_or(Vector::zeros(), |next| next.x);
            assert_eq!(step.x, before);
            assert!(left.amax() < 1e-9 && slopes[k].u.amax() < 1e-9);
            assert!((slopes[k].y + after).amax() < 1e-9);
        }
    }
}

/// `x' = x + u`, cost `(u² + y²) / 2`: with many stages the gain is the golden section.
#[test]
fn a_scalar_regulator_has_the_golden_gain() {
    let toy = scalar(60, 8.0);
    let (report, at) = toy.solve(&Settings::default());
    assert_eq!(report.status, SolverStatus::Solved);
    assert_eq!(report.iterations, 1);
    let gain = 2.0 / (1.0 + 5.0_f64.sqrt());
    assert!((at.controls[0][0] + gain * 8.0).abs() < 1e-9);
    // P = golden section: cost of the next states, without the first state's own
    let worth = 0.5 * 64.0 * (0.5 * (1.0 + 5.0_f64.sqrt()) - 1.0);
    assert!((report.objective - worth).abs() < 1e-9, "{report:?}");
}

/// The regulator with its control limited to 1: full force until the unlimited law requires less.
#[test]
fn limits_hold_and_their_multipliers_balance() {
    let mut toy = scalar(60, 8.0);
    toy.limits = [Vector::repeat(-1.0), Vector::repeat(1.0)];
    let (report, at) = toy.solve(&Settings::default());
    assert_eq!(report.status, SolverStatus::Solved);
    for k in 0..5 {
        assert!((at.controls[k][0] + 1.0).abs() < 1e-5 && at.low[k][0] > 0.1);
    }
    assert!(at.controls.iter().all(|u| u[0].abs() < 1.0));
    // stationarity of the first control: u - l - low = 0 with defect y - x - u
    let residual = at.controls[0][0] - at.multipliers[0][0] - at.low[0][0] + at.high[0][0];
    assert!(residual.abs() < 1e-5);
}

/// An unsatisfiable row ends at the penalty and reports its shortfall.
#[test]
fn unsatisfiable_rows_have_the_least_shortfall() {
    let mut toy = scalar(1, 0.0);
    toy.limits = [Vector::repeat(-1.0), Vector::repeat(1.0)];
    let mut row = Triple::zeros();
    row.y[0] = 1.0;
    toy.rows = vec![(row, 3.0)];
    let (report, at) = toy.solve(&Settings::default());
    assert_eq!(report.status, SolverStatus::Solved);
    assert!((at.states[1][0] - 1.0).abs() < 1e-5 && (report.shortfall - 2.0).abs() < 1e-5);
    assert!((report.row_multiplier - 100.0).abs() < 1e-4);
}

#[test]
fn a_nonlinear_problem_with_rows_satisfies_its_conditions() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for _ in 0..50 {
        let mut any = |_: usize, _: usize| rng.random_range(-0.6..0.6);
        let mut toy = Toy::<4, 2>::new(
            12,
            Vector::from_fn(&mut any),
            Matrix::from_fn(&mut any),
            Matrix::from_fn(&mut any),
        );
        toy.limits = [Vector::repeat(-0.5), Vector::repeat(0.7)];
        toy.bend = 0.5;
        toy.slope.y = Vector::from_fn(&mut any);
        let mut row = Triple::zeros();
        row.x[0] = 0.4;
        row.y[1] = 1.0;
        toy.rows = vec![(row, -0.3)];
        let (report, at) = toy.solve(&Settings::default());
        assert_eq!(report.status, SolverStatus::Solved, "{report:?}");
        assert!(report.error <= 1e-6);
        for k in 0..12 {
            let mut value = [0.0];
            let found = toy.values(k, &at.point(k), &mut value);
            assert!(found.defect.amax() < 1e-6);
            let p = at.rows[k];
            // complementarity: rows with a shortfall pay the penalty, others have no elastic
            assert!(p.multiplier * value[0].max(0.0) < 1e-4);
            assert!(value[0] > -1e-5 || p.multiplier > 99.9, "{value:?} {p:?}");
        }
    }
}

#[test]
fn divergence_and_nan_are_reported() {
    let status = |toy: &Toy<1, 1>, settings: &Settings| toy.solve(settings).0.status;
    let usual = Settings::default();
    let toy = scalar(3, 1.0);
    let mut falling = toy.clone();
    falling.cost.uu = Matrix::zeros();
    falling.cost.yy = -Matrix::identity();
    assert_eq!(status(&falling, &usual), SolverStatus::Unbounded);
    let mut unknown = toy.clone();
    unknown.cost.yy = Matrix::repeat(f64::NAN);
    assert_eq!(status(&unknown, &usual), SolverStatus::NotANumber);
    let short = Settings {
        max_iterations: 0,
        ..usual
    };
    assert_eq!(status(&toy, &short), SolverStatus::Iterations);
    let from = |mut at: Iterate<1, 1>, go_on: bool| {
        let mut workspace = Workspace::new(&toy);
        solve(&toy, &mut at, &mut workspace, &usual, &|| go_on).status
    };
    assert_eq!(from(toy.cold(), false), SolverStatus::OutOfTime);
    let mut cut = toy.cold();
    cut.states.pop();
    assert_eq!(from(cut, true), SolverStatus::BadProblem);
    for [low, high] in [[0.0, 0.0], [1.0, -1.0], [f64::NAN, f64::NAN]] {
        let mut bad = toy.clone();
        bad.limits = [Vector::repeat(low), Vector::repeat(high)];
        assert_eq!(status(&bad, &usual), SolverStatus::BadProblem);
    }
    let empty = Toy { stages: 0, ..toy };
    assert_eq!(status(&empty, &usual), SolverStatus::BadProblem);
}
