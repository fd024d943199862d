//! One solve from one guess: the problem with rows at nodes and midpoints, then again with rows where the motion is
//! deepest between them, until it is clear everywhere.

use super::between::low_points;
use super::solver::{Iterate, Matrix, Report, RowPoint, Settings, Status, Workspace, solve};
use super::task::{Profile, Task};
use super::transcription::Transcription;
use crate::trajectory::Cubic;
use crate::vessel::Manoeuvring;

/// Rounds of rows between the nodes, at most. One or two are usual.
const ROUNDS: usize = 12;

/// The barrier to go on with after rows were added.
const WARM_BARRIER: f64 = 1e-4;

/// Tolerance of the solver as long as rows are still to be found.
const LOOSE: f64 = 1e-3;

/// Of the level of a set. A row that falls short by more is not the tolerance's doing.
const SHORT: f64 = 1e-4;

/// The penalty is raised by this, once.
const DEARER: f64 = 10.0;

/// Rows nearer than this in an interval are one, as a fraction.
const SAME: f64 = 1e-4;

/// A place where a motion is in a set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inside {
    /// Index of the set.
    pub obstacle: usize,
    /// Seconds.
    pub time: f64,
    /// `(x - p_t)' Q_t^-1 (x - p_t)`, below 1.
    pub level: f64,
}

/// What came of one guess.
#[derive(Debug, Clone)]
pub struct Attempt {
    /// The motion.
    pub profile: Profile,
    /// How the last solve ended.
    pub report: Report,
    /// Steps of all solves.
    pub iterations: usize,
    /// Solves after the first, for rows between the nodes.
    pub rounds: usize,
    /// The integral of the stage cost, in the units of the weights.
    pub objective: f64,
    /// The deepest place; `None` where the motion is clear of every set at all times.
    pub inside: Option<Inside>,
    /// True where rows fell short and no solution was found at a higher price: the motion is that at the lower one.
    pub priced_out: bool,
    /// Where later solves may go on from.
    pub(super) iterate: Iterate<6, 3>,
    /// Fractions and sets of the rows, per interval.
    pub(super) rows: Vec<Vec<(usize, f64)>>,
}

impl Attempt {
    /// True where the solver got nowhere. Exact second derivatives alone may: Gauss–Newton steps are poor where the weights
    /// of the states are small beside those of the forces.
    pub fn is_lost(&self) -> bool {
        got_nowhere(self.report.status) || self.priced_out
    }

    /// True when solved and clear.
    pub fn is_feasible(&self) -> bool {
        self.report.status == Status::Solved && self.inside.is_none()
    }
}

/// Solves from a guess. `settings` are those of the first solve.
pub fn attempt<V: Manoeuvring>(
    task: &Task<V>,
    guess: &Profile,
    settings: &Settings,
    keep_going: &dyn Fn() -> bool,
) -> Attempt {
    let problem = task.transcription();
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
    let iterate = Iterate::guess(states, forces);
    let work = Workspace::new(&problem);
    go_on(task, problem, iterate, work, settings, keep_going)
}

/// Solves from an iterate, warm or not, of a problem whose rows may already be more than the base ones.
pub(super) fn go_on<V: Manoeuvring>(
    task: &Task<V>,
    mut problem: Transcription<V>,
    mut iterate: Iterate<6, 3>,
    mut work: Workspace<6, 3>,
    settings: &Settings,
    keep_going: &dyn Fn() -> bool,
) -> Attempt {
    let tight = settings.tolerance;
    let mut settings = *settings;
    // multipliers come with rows that were found already
    if iterate.multipliers.is_empty() {
        settings.tolerance = tight.max(LOOSE);
    }
    let mut report = solve(&problem, &mut iterate, &mut work, &settings, keep_going);
    let (mut iterations, mut rounds, mut raised) = (report.iterations, 0, false);
    // solved but short of rows, before the price was raised
    let mut cheaper: Option<Attempt> = None;
    loop {
        let (deepest, added) = deepest(task, &problem, &iterate);
        let found = Found {
            report,
            iterations,
            rounds,
            inside: deepest,
        };
        if let Some(short) = cheaper.take()
            && got_nowhere(report.status)
        {
            return Attempt {
                iterations,
                rounds,
                priced_out: true,
                ..short
            };
        }
        let short = report.shortfall > SHORT.max(settings.tolerance);
        if report.status != Status::Solved || rounds == ROUNDS || (short && raised) {
            return found.attempt(&problem, iterate);
        }
        settings.barrier = WARM_BARRIER;
        if short {
            // maybe the price was too low: locally infeasible only if a higher one does not help
            cheaper = Some(found.attempt(&problem, iterate.clone()));
            raised = true;
            settings.penalty *= DEARER;
            settings.barrier = 1e2 * WARM_BARRIER;
        }
        let fresh = add_rows(task, &mut problem, &mut iterate, &added, &settings);
        if !fresh && !short {
            if settings.tolerance <= tight {
                return found.attempt(&problem, iterate);
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

/// What the solves so far came to.
#[derive(Debug, Clone, Copy)]
struct Found {
    report: Report,
    iterations: usize,
    rounds: usize,
    inside: Option<Inside>,
}

impl Found {
    fn attempt<V: Manoeuvring>(
        self,
        problem: &Transcription<V>,
        iterate: Iterate<6, 3>,
    ) -> Attempt {
        Attempt {
            profile: Profile {
                states: iterate.states.iter().map(|x| problem.state(x)).collect(),
                forces: iterate.controls.iter().map(|u| problem.force(u)).collect(),
            },
            report: self.report,
            iterations: self.iterations,
            rounds: self.rounds,
            objective: self.report.objective * problem.cost_unit(),
            inside: self.inside,
            priced_out: false,
            iterate,
            rows: problem
                .row_sets()
                .iter()
                .map(|rows| rows.iter().map(|r| (r.obstacle, r.fraction)).collect())
                .collect(),
        }
    }
}

/// True where a solve ended away from any solution.
fn got_nowhere(status: Status) -> bool {
    matches!(status, Status::Iterations | Status::Stalled)
}

/// A row to be added.
#[derive(Debug, Clone, Copy)]
struct Added {
    interval: usize,
    obstacle: usize,
    fraction: f64,
}

/// The deepest place of all, and every local minimum within a set.
fn deepest<V: Manoeuvring>(
    task: &Task<V>,
    problem: &Transcription<V>,
    iterate: &Iterate<6, 3>,
) -> (Option<Inside>, Vec<Added>) {
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
                added.push(Added {
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

/// False where all of them were there already.
fn add_rows<V: Manoeuvring>(
    task: &Task<V>,
    problem: &mut Transcription<V>,
    iterate: &mut Iterate<6, 3>,
    added: &[Added],
    settings: &Settings,
) -> bool {
    let mut fresh = false;
    let mut start = 0;
    for interval in 0..task.intervals {
        let rows = &mut problem.rows_mut()[interval];
        for new in added.iter().filter(|a| a.interval == interval) {
            let fraction = new.fraction;
            let known = rows
                .iter()
                .any(|r| r.obstacle == new.obstacle && (r.fraction - fraction).abs() < SAME);
            // at the very start nothing can be moved
            if known || (interval == 0 && fraction < SAME) {
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
