//! Solution from one initial guess: rows at nodes and midpoints first, then more rows where the
//! motion is deepest between them, until it is clear everywhere.

use super::between::low_points;
use super::solver::{
    Iterate, Matrix, RowPoint, Settings, SolverReport, SolverStatus, Workspace, solve,
};
use super::task::{Profile, Task};
use super::transcription::Transcription;
use searoom_model::trajectory::Cubic;
use searoom_model::vessel::Manoeuvring;

/// Largest number of rounds that add rows between the nodes; one or two are usual.
const MAX_ROUNDS: usize = 12;

/// Initial barrier parameter after rows were added.
const WARM_BARRIER: f64 = 1e-4;

/// Solver tolerance while rows are still being added.
const LOOSE_TOLERANCE: f64 = 1e-3;

/// Largest constraint violation explained by the solver's tolerance, as a fraction of the set's
/// level.
const SOLVER_VIOLATION: f64 = 1e-4;

/// Factor by which the penalty is raised, once.
const PENALTY_FACTOR: f64 = 10.0;

/// Rows within this fraction of an interval from one another are the same row.
const SAME_FRACTION: f64 = 1e-4;

/// Point of a motion inside a set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inside {
    /// Index of the set.
    pub obstacle: usize,
    /// Time, seconds.
    pub time: f64,
    /// Level `(x - p_t)' Q_t^-1 (x - p_t)`, below 1.
    pub level: f64,
}

/// Result of one initial guess.
#[derive(Debug, Clone)]
pub struct StartAttempt {
    /// The motion.
    pub profile: Profile,
    /// Report of the last solve.
    pub report: SolverReport,
    /// Iterations of all solves.
    pub iterations: usize,
    /// Integral of the stage cost, in the units of the weights.
    pub objective: f64,
    /// Deepest point inside a set; `None` where the motion is clear of every set at all times.
    pub inside: Option<Inside>,
    /// True where rows were violated and no solution was found with a higher penalty: the motion is
    /// the one with the lower penalty.
    pub priced_out: bool,
}

impl StartAttempt {
    /// True where the solver made no progress. Exact second derivatives alone may succeed:
    /// Gauss–Newton steps are poor where the state weights are small relative to the force weights.
    pub fn is_lost(&self) -> bool {
        failed(self.report.status) || self.priced_out
    }

    /// True when solved and clear.
    pub fn is_feasible(&self) -> bool {
        self.report.status == SolverStatus::Solved && self.inside.is_none()
    }
}

/// Solves from a guess; `settings` apply to the first solve.
pub fn attempt<V: Manoeuvring>(
    task: &Task<V>,
    guess: &Profile,
    settings: &Settings,
    keep_going: &dyn Fn() -> bool,
) -> StartAttempt {
    let mut problem = task.transcription();
    let states = guess
        .states
        .iter()
        .map(|x| problem.scaled_state(x))
        .collect();
    let forces = guess
        .forces
        .iter()
        .map(|u| problem.scaled_force(u))
        .collect();
    let mut iterate = Iterate::guess(states, forces);
    let mut work = Workspace::new(&problem);
    let tight = settings.tolerance;
    let mut settings = *settings;
    settings.tolerance = tight.max(LOOSE_TOLERANCE);
    let mut report = solve(&problem, &mut iterate, &mut work, &settings, keep_going);
    let (mut iterations, mut rounds, mut raised) = (report.iterations, 0, false);
    // solved but with violated rows, before the penalty was raised
    let mut cheaper: Option<StartAttempt> = None;
    loop {
        let (deepest, added) = deepest(task, &problem, &iterate);
        let found = Progress {
            report,
            iterations,
            inside: deepest,
        };
        if let Some(short) = cheaper.take()
            && failed(report.status)
        {
            return StartAttempt {
                iterations,
                priced_out: true,
                ..short
            };
        }
        let short = report.shortfall > SOLVER_VIOLATION.max(settings.tolerance);
        if report.status != SolverStatus::Solved || rounds == MAX_ROUNDS || (short && raised) {
            return found.attempt(&problem, &iterate);
        }
        settings.barrier = WARM_BARRIER;
        if short {
            // the penalty may be too low: the problem is locally infeasible only if a higher one
            // does not help
            cheaper = Some(found.attempt(&problem, &iterate));
            raised = true;
            settings.penalty *= PENALTY_FACTOR;
            settings.barrier = 1e2 * WARM_BARRIER;
        }
        let fresh = add_rows(task, &mut problem, &mut iterate, &added, &settings);
        if !fresh && !short {
            if settings.tolerance <= tight {
                return found.attempt(&problem, &iterate);
            }
            settings.tolerance = tight;
        }
        if fresh {
            work = Workspace::new(&problem);
        }
        report = solve(&problem, &mut iterate, &mut work, &settings, keep_going);
        iterations += report.iterations;
        rounds += 1;
    }
}

/// Result of the solves so far.
#[derive(Debug, Clone, Copy)]
struct Progress {
    report: SolverReport,
    iterations: usize,
    inside: Option<Inside>,
}

impl Progress {
    fn attempt<V: Manoeuvring>(
        self,
        problem: &Transcription<V>,
        iterate: &Iterate<6, 3>,
    ) -> StartAttempt {
        StartAttempt {
            profile: Profile {
                states: iterate.states.iter().map(|x| problem.state(x)).collect(),
                forces: iterate.controls.iter().map(|u| problem.force(u)).collect(),
            },
            report: self.report,
            iterations: self.iterations,
            objective: self.report.objective * problem.cost_unit(),
            inside: self.inside,
            priced_out: false,
        }
    }
}

/// True where a solve ended away from any solution.
fn failed(status: SolverStatus) -> bool {
    matches!(status, SolverStatus::Iterations | SolverStatus::Stalled)
}

/// Row to be added.
#[derive(Debug, Clone, Copy)]
struct NewRow {
    interval: usize,
    obstacle: usize,
    fraction: f64,
}

/// Deepest point of all, and every local minimum inside a set.
fn deepest<V: Manoeuvring>(
    task: &Task<V>,
    problem: &Transcription<V>,
    iterate: &Iterate<6, 3>,
) -> (Option<Inside>, Vec<NewRow>) {
    let (mut deepest, mut added) = (None::<Inside>, Vec::new());
    let node = |k: usize| {
        super::task::node(
            task.time(k),
            &problem.state(&iterate.states[k]),
            &Matrix::zeros(),
        )
    };
    let mut before = node(0);
    for interval in 0..task.intervals {
        let after = node(interval + 1);
        let piece = Cubic::from_nodes(&before, &after);
        for (obstacle, keep) in task.keep_outs.iter().enumerate() {
            for point in low_points(&piece, keep, 1.0) {
                added.push(NewRow {
                    interval,
                    obstacle,
                    fraction: point.part,
                });
                // negated on purpose: a NaN is deepest
                if !deepest.is_some_and(|d| d.level <= point.level) {
                    deepest = Some(Inside {
                        obstacle,
                        time: piece.start_time + point.part * piece.duration,
                        level: point.level,
                    });
                }
            }
        }
        before = after;
    }
    (deepest, added)
}

/// Adds rows; false where all of them exist already.
fn add_rows<V: Manoeuvring>(
    task: &Task<V>,
    problem: &mut Transcription<V>,
    iterate: &mut Iterate<6, 3>,
    added: &[NewRow],
    settings: &Settings,
) -> bool {
    let mut fresh = false;
    let mut start = 0;
    for interval in 0..task.intervals {
        let rows = &mut problem.rows_mut()[interval];
        for new in added.iter().filter(|a| a.interval == interval) {
            let fraction = new.fraction;
            let known = rows.iter().any(|r| {
                r.obstacle == new.obstacle && (r.fraction - fraction).abs() < SAME_FRACTION
            });
            // at the start no state can be changed
            if known || (interval == 0 && fraction < SAME_FRACTION) {
                continue;
            }
            fresh = true;
            rows.push(task.row(interval, new.obstacle, fraction));
            let central = RowPoint::central(0.0, settings.barrier, settings.penalty);
            let little = RowPoint {
                multiplier: settings.barrier.sqrt(),
                ..central
            };
            iterate.rows.insert(start + rows.len() - 1, little);
        }
        start += rows.len();
    }
    fresh
}
