//! Small problems with known solutions, and a dense solve of the same equations.

use super::riccati::{RightSide, StageFactor, eliminate, factorise};
use super::*;
use nalgebra::{DMatrix, DVector};
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

fn times<const N: usize, const M: usize>(h: &Blocks<N, M>, at: Point<N, M>) -> Triple<N, M> {
    Triple {
        x: h.xx * at.x + h.ux.tr_mul(at.u) + h.yx.tr_mul(at.y),
        u: h.ux * at.x + h.uu * at.u + h.yu.tr_mul(at.y),
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

    fn values(&self, _: usize, at: Point<N, M>, rows: &mut [f64]) -> Values<N> {
        let w = Triple {
            x: *at.x,
            u: *at.u,
            y: *at.y,
        };
        for (to, (g, d)) in rows.iter_mut().zip(&self.rows) {
            *to = g.dot(&w) - d;
        }
        Values {
            cost: 0.5 * times(&self.cost, at).dot(&w) + self.slope.dot(&w),
            defect: at.y - self.a * at.x - self.b * at.u - self.bend * at.x.map(f64::sin),
        }
    }

    fn derivatives(
        &self,
        _: usize,
        at: Point<N, M>,
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
    let root = DMatrix::from_fn(10, 10, |_, _| rng.random_range(-1.0..1.0));
    let full = &root * root.transpose() + DMatrix::identity(10, 10) * 0.1;
    let block = |i: usize, j: usize, r: usize, c: usize| full.view((i, j), (r, c)).into_owned();
    Blocks {
        xx: Matrix::from_fn(|i, j| block(0, 0, 4, 4)[(i, j)]),
        ux: Matrix::from_fn(|i, j| block(4, 0, 2, 4)[(i, j)]),
        uu: Matrix::from_fn(|i, j| block(4, 4, 2, 2)[(i, j)]),
        yx: Matrix::from_fn(|i, j| block(6, 0, 4, 4)[(i, j)]),
        yu: Matrix::from_fn(|i, j| block(6, 4, 4, 2)[(i, j)]),
        yy: Matrix::from_fn(|i, j| block(6, 6, 4, 4)[(i, j)]),
    }
}

/// Compares with the whole system of a few stages as one dense matrix.
#[test]
fn the_recursion_solves_the_dense_equations() {
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
        // variables u_k, y_k per stage, then the multipliers; x of the first stage is fixed
        let (size, base) = (6 * stages, 6 * stages);
        let mut matrix = DMatrix::<f64>::zeros(10 * stages, 10 * stages);
        let mut rhs = DVector::<f64>::zeros(10 * stages);
        for k in 0..stages {
            let (u, y) = (6 * k, 6 * k + 2);
            let x = if k > 0 { Some(6 * k - 4) } else { None };
            let (h, d, l) = (&hessian[k], &derivatives[k], base + 4 * k);
            let mut add = |i: usize, j: usize, block: DMatrix<f64>| {
                let mut view = matrix.view_mut((i, j), block.shape());
                view += &block;
                if i != j {
                    let mut view = matrix.view_mut((j, i), (block.ncols(), block.nrows()));
                    view += block.transpose();
                }
            };
            let dense =
                |r: usize, c: usize, of: &dyn Fn(usize, usize) -> f64| DMatrix::from_fn(r, c, of);
            add(u, u, dense(2, 2, &|i, j| h.uu[(i, j)]));
            add(y, u, dense(4, 2, &|i, j| h.yu[(i, j)]));
            add(y, y, dense(4, 4, &|i, j| h.yy[(i, j)]));
            add(l, u, dense(4, 2, &|i, j| d.defect_u[(i, j)]));
            add(l, y, dense(4, 4, &|i, j| d.defect_y[(i, j)]));
            if let Some(x) = x {
                add(x, x, dense(4, 4, &|i, j| h.xx[(i, j)]));
                add(u, x, dense(2, 4, &|i, j| h.ux[(i, j)]));
                add(y, x, dense(4, 4, &|i, j| h.yx[(i, j)]));
                add(l, x, dense(4, 4, &|i, j| d.defect_x[(i, j)]));
            }
            for i in 0..4 {
                if let Some(x) = x {
                    rhs[x + i] -= gradient[k].x[i];
                }
                rhs[y + i] -= gradient[k].y[i];
                rhs[l + i] -= defect[k][i];
            }
            for i in 0..2 {
                rhs[u + i] -= gradient[k].u[i];
            }
        }
        let dense = matrix.lu().solve(&rhs).expect("regular");
        for k in 0..stages {
            for i in 0..4 {
                assert!((dense[6 * k + 2 + i] - steps[k].y[i]).abs() < 1e-9);
                assert!((dense[size + 4 * k + i] - multipliers[k][i]).abs() < 1e-9);
            }
            assert!((dense[6 * k] - steps[k].u[0]).abs() < 1e-9);
        }
    }
}

/// `x' = x + u`, cost `(u² + y²) / 2`: with many stages the gain is the golden section.
#[test]
fn a_scalar_regulator_has_the_golden_gain() {
    let toy = Toy::<1, 1>::new(
        60,
        Vector::<1>::new(8.0),
        Matrix::identity(),
        Matrix::identity(),
    );
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
    let mut toy = Toy::<1, 1>::new(
        60,
        Vector::<1>::new(8.0),
        Matrix::identity(),
        Matrix::identity(),
    );
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

/// Out of the unit disc, towards (0.3, 0): the nearest point is (1, 0), its multiplier 0.7.
#[derive(Debug, Clone, Copy)]
struct Disc {
    first: Vector<2>,
    goal: f64,
}

impl StageProblem<2, 2> for Disc {
    fn stages(&self) -> usize {
        1
    }

    fn first(&self) -> Vector<2> {
        self.first
    }

    fn limits(&self) -> [Vector<2>; 2] {
        [Vector::repeat(-10.0), Vector::repeat(10.0)]
    }

    fn rows(&self, _: usize) -> usize {
        1
    }

    fn values(&self, _: usize, at: Point<2, 2>, rows: &mut [f64]) -> Values<2> {
        rows[0] = at.y.norm_squared() - 1.0;
        Values {
            cost: (at.y - Vector::<2>::new(self.goal, 0.0)).norm_squared(),
            defect: at.y - at.x - at.u,
        }
    }

    fn derivatives(
        &self,
        _: usize,
        at: Point<2, 2>,
        multipliers: Multipliers<2>,
        out: &mut Derivatives<2, 2>,
        rows: &mut [Triple<2, 2>],
    ) {
        *out = Derivatives::zeros();
        out.gradient.y = 2.0 * (at.y - Vector::<2>::new(self.goal, 0.0));
        out.defect_x = -Matrix::identity();
        out.defect_u = -Matrix::identity();
        out.defect_y = Matrix::identity();
        out.convex.yy = Matrix::identity() * 2.0;
        out.curvature.yy = -Matrix::identity() * 2.0 * multipliers.rows[0];
        rows[0] = Triple::zeros();
        rows[0].y = 2.0 * at.y;
    }
}

#[test]
fn a_point_in_a_disc_moves_to_its_nearest_point() {
    for gauss_newton in [true, false] {
        for start in [
            Vector::<2>::new(3.0, 1.0),
            Vector::<2>::new(0.1, 0.2),
            Vector::<2>::new(0.5, -0.7),
        ] {
            let disc = Disc {
                first: start,
                goal: 0.3,
            };
            let settings = Settings {
                gauss_newton,
                ..Settings::default()
            };
            let mut at = Iterate::guess(vec![start; 2], vec![Vector::zeros()]);
            let report = solve(
                &disc,
                &mut at,
                &mut Workspace::new(&disc),
                &settings,
                &|| true,
            );
            assert_eq!(report.status, SolverStatus::Solved, "{start} {report:?}");
            assert!(
                (at.states[1] - Vector::<2>::new(1.0, 0.0)).amax() < 1e-5,
                "{at:?}"
            );
            assert!((at.rows[0].multiplier - 0.7).abs() < 1e-4);
            assert!(report.shortfall < 1e-5 && (report.objective - 0.49).abs() < 1e-4);
            // again from there: only the barrier decreases
            let warm = Settings {
                barrier: 1e-4,
                ..settings
            };
            let again = solve(&disc, &mut at, &mut Workspace::new(&disc), &warm, &|| true);
            assert!(
                again.status == SolverStatus::Solved && again.iterations <= 5,
                "{again:?}"
            );
        }
    }
}

/// An unsatisfiable row ends at the penalty and reports its shortfall.
#[test]
fn unsatisfiable_rows_have_the_least_shortfall() {
    let mut toy = Toy::<1, 1>::new(
        1,
        Vector::<1>::new(0.0),
        Matrix::identity(),
        Matrix::identity(),
    );
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
            let found = toy.values(k, at.point(k), &mut value);
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
    let mut toy = Toy::<1, 1>::new(
        3,
        Vector::<1>::new(1.0),
        Matrix::identity(),
        Matrix::identity(),
    );
    toy.cost.uu = Matrix::zeros();
    toy.cost.yy = -Matrix::identity();
    assert_eq!(
        toy.solve(&Settings::default()).0.status,
        SolverStatus::Unbounded
    );
    toy.cost.yy = Matrix::repeat(f64::NAN);
    assert_eq!(
        toy.solve(&Settings::default()).0.status,
        SolverStatus::NotANumber
    );
    toy.cost.yy = Matrix::identity();
    toy.cost.uu = Matrix::identity();
    let short = Settings {
        max_iterations: 0,
        ..Settings::default()
    };
    assert_eq!(toy.solve(&short).0.status, SolverStatus::Iterations);
    let mut at = toy.cold();
    let stopped = solve(
        &toy,
        &mut at,
        &mut Workspace::new(&toy),
        &Settings::default(),
        &|| false,
    );
    assert_eq!(stopped.status, SolverStatus::OutOfTime);
    for bad in [
        Toy {
            stages: 0,
            ..toy.clone()
        },
        Toy {
            limits: [Vector::zeros(), Vector::zeros()],
            ..toy.clone()
        },
        Toy {
            limits: [Vector::repeat(1.0), Vector::repeat(-1.0)],
            ..toy.clone()
        },
        Toy {
            limits: [Vector::repeat(f64::NAN); 2],
            ..toy.clone()
        },
    ] {
        assert_eq!(
            bad.solve(&Settings::default()).0.status,
            SolverStatus::BadProblem
        );
    }
    let mut at = toy.cold();
    at.states.pop();
    let report = solve(
        &toy,
        &mut at,
        &mut Workspace::new(&toy),
        &Settings::default(),
        &|| true,
    );
    assert_eq!(report.status, SolverStatus::BadProblem);
}
