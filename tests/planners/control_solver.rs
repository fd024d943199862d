//! Tests of the solver of the optimal-control planner: optimum, settings and clock.

use std::cell::Cell;
use std::time::Duration;

use searoom::frame::Vector;
use searoom::obstacle::Obstacle;
use searoom::planner::optimal_control::solver::{
    Derivatives, Iterate, Multipliers, StageProblem, Triple, Values, Vector as Column, Workspace,
    solve,
};
use searoom::planner::optimal_control::transcription::Transcription;
use searoom::planner::optimal_control::{
    Controls, Profile, Settings, SolverStatus, Task, Weights, family, plan,
};
use searoom::planner::{ControlSettings, NoPlan, Outcome, Problem};
use searoom::vessel::{CyberShip2, ForceVector, StateVector, VesselKind};

use crate::campaigns::forces::scenes;

/// Problem with an additional terminal cost toward a goal.
struct Drawn<'a> {
    stages: Transcription<'a, CyberShip2>,
    goal: Vector,
    weight: f64,
}

impl StageProblem<6, 3> for Drawn<'_> {
    fn stages(&self) -> usize {
        self.stages.stages()
    }

    fn first(&self) -> Column<6> {
        self.stages.first()
    }

    fn limits(&self) -> [Column<3>; 2] {
        self.stages.limits()
    }

    fn rows(&self, stage: usize) -> usize {
        self.stages.rows(stage)
    }

    fn values(&self, stage: usize, at: &Triple<6, 3>, rows: &mut [f64]) -> Values<6> {
        let mut values = self.stages.values(stage, at, rows);
        if stage + 1 == self.stages() {
            let off = Vector::new(at.y[0], at.y[1]) - self.goal;
            values.cost += self.weight * off.norm_squared();
        }
        values
    }

    fn derivatives(
        &self,
        stage: usize,
        at: &Triple<6, 3>,
        multipliers: Multipliers<6>,
        out: &mut Derivatives<6, 3>,
        rows: &mut [Triple<6, 3>],
    ) {
        self.stages.derivatives(stage, at, multipliers, out, rows);
        if stage + 1 == self.stages() {
            for i in 0..2 {
                out.gradient.y[i] += 2.0 * self.weight * (at.y[i] - self.goal[i]);
                out.convex.yy[(i, i)] += 2.0 * self.weight;
            }
        }
    }
}

/// Compares with CasADi and IPOPT on the same transcription. They reach 7.844853, or 7.808142 with
/// another homotopy class. The margin of the constraints costs a ten-thousandth.
#[test]
fn another_solver_finds_the_same_optimum() {
    let desired = scenes::desired();
    let keep_outs = scenes::figure_9();
    let third = 1.0 / (1.5 * 1.5);
    let task = Task {
        controls: Controls {
            force_limits: ForceVector::new(2.0, 1.5, 1.5),
            weights: Weights {
                state: StateVector::new(0.05, 0.05, 0.0, 0.0, 0.0, 1.0),
                force: ForceVector::new(0.25, third, third),
            },
        },
        ..scenes::task(&desired, &keep_outs, 50)
    };
    let stages = task.transcription();
    let unit = stages.cost_unit();
    let drawn = Drawn {
        stages,
        goal: Vector::new(20.0, 10.0),
        weight: 5.0 / unit,
    };
    let straight = scenes::straight(&task);
    let still = Iterate::guess(vec![Column::zeros(); 51], vec![Column::zeros(); 50]);
    let starts = [
        (Iterate::guess(straight.states, straight.forces), 7.808142),
        (still, 7.844853),
    ];
    for (start, known) in starts {
        let mut at = start;
        let mut work = Workspace::new(&drawn);
        let report = solve(&drawn, &mut at, &mut work, &Settings::default(), &|| true);
        assert_eq!(report.status, SolverStatus::Solved);
        let cost = report.objective * unit;
        assert!((cost - known).abs() < 1e-3, "{cost} {known}");
    }
}

/// Tests settings that permit no plan. Scenario files are validated more strictly than library
/// input.
#[test]
fn settings_that_no_plan_can_come_of_are_said_and_no_panic() {
    let (own, desired) = (scenes::own_ship(), scenes::desired());
    let obstacles: Vec<Obstacle> = scenes::figure_9()
        .iter()
        .map(|k| k.set().clone().into())
        .collect();
    let problem = Problem {
        deadline: Duration::from_secs(5),
        ..scenes::problem(&own, &desired, &obstacles)
    };
    let usual = ControlSettings::of(VesselKind::CyberShip2);
    let limits = |surge: f64| ControlSettings {
        force_limits: ForceVector::new(surge, 1.5, 1.5),
        ..usual
    };
    let no_interval = ControlSettings {
        intervals: 0,
        ..usual
    };
    for (settings, why) in [
        (no_interval, "no interval"),
        (limits(0.0), "no force to choose"),
        (limits(-2.0), "no force to choose"),
        (limits(f64::NAN), "no force to choose"),
    ] {
        match plan(&problem, &settings).outcome {
            Outcome::Infeasible(NoPlan::Unsolved { why: said, .. }) => {
                assert!(said.contains(why), "{said}");
            }
            other => panic!("{settings:?}: {other:?}"),
        }
    }
    // zero or negative weights: any result is allowed, except a plan with a NaN cost
    for weight in [0.0, -1.0, f64::NAN] {
        let settings = ControlSettings {
            state_weights: StateVector::repeat(weight),
            force_weights: ForceVector::repeat(weight),
            ..usual
        };
        let begun = std::time::Instant::now();
        let found = plan(&problem, &settings).outcome;
        assert!(found.plan().is_none_or(|p| p.cost.is_finite()), "{weight}");
        assert!(begun.elapsed() < Duration::from_secs(20));
    }
}

/// Tests a step with many trial points.
#[test]
fn the_clock_is_read_between_the_trial_points_of_a_step() {
    let (desired, keep_outs) = (scenes::desired(), scenes::figure_9());
    let task = scenes::task(&desired, &keep_outs, 50);
    let problem = task.transcription();
    // number of clock readings and result if the deadline strikes at the n-th reading
    let until = |guess: &Profile, strikes: usize| {
        let mut at = Iterate::guess(guess.states.clone(), guess.forces.clone());
        let mut work = Workspace::new(&problem);
        let readings = Cell::new(0);
        let keep_going = || {
            readings.set(readings.get() + 1);
            readings.get() < strikes
        };
        let settings = Settings::default();
        let report = solve(&problem, &mut at, &mut work, &settings, &keep_going);
        (readings.get(), report)
    };
    // one reading per step if the first trial point is always accepted
    let guesses = family(&task).into_iter().map(|(_, guess)| guess);
    let (guess, all) = guesses
        .map(|guess| (until(&guess, usize::MAX), guess))
        .find(|((all, report), _)| {
            report.status == SolverStatus::Solved && *all > report.iterations
        })
        .map(|((all, _), guess)| (guess, all))
        .expect("a start with a step that is cut");
    for strikes in 1..=all {
        let (readings, report) = until(&guess, strikes);
        assert_eq!(readings, strikes);
        assert_eq!(report.status, SolverStatus::OutOfTime);
    }
}
