//! Receding-horizon control: repeats the optimisation as the ship moves, with a warm start.

use super::attempt::{StartAttempt, attempt, resume};
use super::keep_out::KeepOut;
use super::reference::{LegSide, reference};
use super::solver::{Iterate, RowPoint, Settings, Workspace};
use super::task::{Profile, Task, force, state};
use crate::trajectory::Steered;
use crate::vessel::{Manoeuvring, StateVector};

/// Initial barrier parameter after one interval.
const BARRIER: f64 = 1e-4;

/// What a plan goes on from: own ship's state, and the plan that it follows.
#[derive(Debug, Clone, PartialEq)]
pub struct WarmStart {
    /// Own ship's state at t = 0.
    pub state: StateVector,
    /// The last plan, in the clock of the new one.
    pub plan: Steered,
}

impl WarmStart {
    /// The last plan on the grid of a task. After its end it moves as the desired trajectory does.
    ///
    /// A grid of another plan has other intervals, so that multipliers have no place on it.
    pub(super) fn profile<V: Manoeuvring>(&self, task: &Task<V>) -> Profile {
        let nodes = self.plan.nodes();
        let end = nodes[nodes.len() - 1].time;
        let desired = |time| reference(task.desired, time, LegSide::Before);
        let at = |time: f64| {
            let held = time.min(end);
            let mut planned = state(&self.plan.piece_at(held).node_at(held));
            let way = desired(time.max(end)) - desired(end);
            planned[0] += way[0];
            planned[1] += way[1];
            planned
        };
        let middle = |k: usize| task.time(k) + 0.5 * task.step();
        Profile {
            states: std::iter::once(task.first)
                .chain((1..=task.intervals).map(|k| at(task.time(k))))
                .collect(),
            forces: (0..task.intervals)
                .map(|k| force(self.plan.node_at(middle(k).min(end).next_down())))
                .collect(),
        }
    }
}

/// Plan that moves with the ship. Each step drops the first interval, adds one at the end, and
/// solves again from the current states, forces and multipliers.
#[derive(Debug, Clone)]
pub struct RecedingHorizon {
    attempt: StartAttempt,
    settings: Settings,
}

/// Measurements after an interval.
#[derive(Debug, Clone, Copy)]
pub struct Measured<'a> {
    /// Measured state.
    pub state: StateVector,
    /// Sets in the same number and order as before, in the clock of the task.
    pub keep_outs: &'a [KeepOut],
}

impl RecedingHorizon {
    /// First plan, from a guess.
    pub fn new<V: Manoeuvring>(
        task: &Task<V>,
        guess: &Profile,
        settings: Settings,
        keep_going: &dyn Fn() -> bool,
    ) -> Self {
        Self {
            attempt: attempt(task, guess, &settings, keep_going),
            settings,
        }
    }

    /// Current plan.
    pub fn plan(&self) -> &StartAttempt {
        &self.attempt
    }

    /// Moves `task` on by one interval and solves again. With another number of sets, the
    /// multipliers of the rows are discarded.
    pub fn step<'a, V: Manoeuvring>(
        &mut self,
        task: &Task<'a, V>,
        measured: Measured<'a>,
        keep_going: &dyn Fn() -> bool,
    ) -> Task<'a, V> {
        let next = Task {
            first: measured.state,
            keep_outs: measured.keep_outs,
            start_time: task.time(1),
            ..*task
        };
        let mut problem = next.transcription();
        let mut iterate = shifted(&self.attempt.iterate);
        let known = measured.keep_outs.len();
        // rows between the nodes keep their fraction of the interval
        let mut rows = Vec::new();
        let mut taken = 0;
        for (k, old) in self.attempt.rows.iter().enumerate() {
            let base = problem.row_sets()[k.saturating_sub(1)].len();
            let points = &self.attempt.iterate.rows[taken..taken + old.len()];
            taken += old.len();
            if k == 0 {
                continue;
            }
            for (obstacle, fraction) in old.iter().skip(base).filter(|(o, _)| *o < known) {
                let row = next.row(k - 1, *obstacle, *fraction);
                problem.rows_mut()[k - 1].push(row);
            }
            rows.extend_from_slice(points);
        }
        let last = problem.row_sets().last().map_or(0, Vec::len);
        let little = RowPoint {
            multiplier: BARRIER,
            ..RowPoint::central(1.0, BARRIER, self.settings.penalty)
        };
        rows.extend(std::iter::repeat_n(little, last));
        let expected: usize = problem.row_sets().iter().map(Vec::len).sum();
        if rows.len() == expected {
            iterate.rows = rows;
        } else {
            iterate = Iterate::guess(iterate.states, iterate.controls);
        }
        let work = Workspace::new(&problem);
        let settings = Settings {
            barrier: BARRIER,
            ..self.settings
        };
        self.attempt = resume(&next, problem, iterate, work, &settings, keep_going);
        next
    }
}

/// Iterate moved on by one interval; the last one is repeated.
fn shifted(old: &Iterate<6, 3>) -> Iterate<6, 3> {
    fn on<T: Clone>(values: &[T]) -> Vec<T> {
        values
            .iter()
            .skip(1)
            .chain(values.last())
            .cloned()
            .collect()
    }
    Iterate {
        states: on(&old.states),
        controls: on(&old.controls),
        multipliers: on(&old.multipliers),
        low: on(&old.low),
        high: on(&old.high),
        rows: old.rows.clone(),
    }
}
