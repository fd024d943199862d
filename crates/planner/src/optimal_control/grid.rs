//! Grid refinement: from a solution on one grid to a solution on a grid fine enough for the ship's
//! dynamics.

use super::attempt::{StartAttempt, attempt};
use super::defect::largest_defect;
use super::solver::Settings;
use super::task::{Profile, Task};
use searoom_geometry::tolerance;
use searoom_model::trajectory::hermite;
use searoom_model::vessel::Manoeuvring;

/// Largest number of grids after the first one.
const MAX_REFINEMENTS: usize = 6;

/// Least and greatest ratio of intervals between two grids.
const MIN_FACTOR: f64 = 1.5;
const MAX_FACTOR: f64 = 4.0;

/// Deviations at the end of an interval decrease with this power of its duration.
const ORDER: f64 = 5.0;

/// Initial barrier parameter on a finer grid.
const REFINED_BARRIER: f64 = 1e-2;

/// Result of the grid refinement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum GridResult {
    /// The grid is fine enough.
    Fine,
    /// The last grid that was tried, or that time allowed, is too coarse.
    Coarse,
    /// No plan was found on the last grid.
    Lost,
}

/// Solution on the last grid.
#[derive(Debug)]
pub(super) struct Refined {
    pub found: StartAttempt,
    pub intervals: usize,
    /// Largest deviation of the ship at the end of an interval, in its own units.
    pub defect: f64,
    pub ended: GridResult,
}

/// Refines the grid of a feasible motion until `exact` follows it to [`tolerance::DEFECT`].
pub(super) fn refine_grid<V: Manoeuvring>(
    coarse: &Task<V>,
    found: &StartAttempt,
    exact: &V,
    keep_going: &dyn Fn() -> bool,
) -> Refined {
    let mut task = Task { ..*coarse };
    let mut found = found.clone();
    let mut refinements = 0;
    loop {
        let defect = largest_defect(exact, &found.profile, task.step());
        let ended = if !found.is_feasible() {
            Some(GridResult::Lost)
        } else if defect <= tolerance::DEFECT {
            Some(GridResult::Fine)
        } else if refinements == MAX_REFINEMENTS || !keep_going() {
            Some(GridResult::Coarse)
        } else {
            None
        };
        if let Some(ended) = ended {
            return Refined {
                found,
                intervals: task.intervals,
                defect,
                ended,
            };
        }
        refinements += 1;
        let finer = Task {
            intervals: finer(task.intervals, defect),
            ..task
        };
        let guess = resampled(&task, &found.profile, &finer);
        task = finer;
        let settings = Settings {
            barrier: REFINED_BARRIER,
            ..Settings::default()
        };
        found = attempt(&task, &guess, &settings, keep_going);
        if found.is_lost() {
            let exact = Settings {
                gauss_newton: false,
                ..settings
            };
            found = attempt(&task, &guess, &exact, keep_going);
        }
    }
}

/// Number of intervals for which a deviation should be small enough; the greatest one for a NaN.
fn finer(intervals: usize, defect: f64) -> usize {
    let factor = (defect / tolerance::DEFECT).powf(1.0 / ORDER);
    let factor = if factor < MAX_FACTOR {
        factor.max(MIN_FACTOR)
    } else {
        MAX_FACTOR
    };
    (intervals as f64 * factor).ceil() as usize
}

/// Motion on another grid: states on the cubics, forces of the middle of each interval.
fn resampled<V: Manoeuvring>(task: &Task<V>, profile: &Profile, to: &Task<V>) -> Profile {
    let h = task.step();
    let at = |time: f64| {
        let place = time / h;
        let interval = (place.floor().max(0.0) as usize).min(task.intervals - 1);
        (interval, place - interval as f64)
    };
    let state = |k: usize| {
        let (interval, part) = at(to.time(k));
        let [x, y] = [interval, interval + 1].map(|i| profile.states[i]);
        let force = &profile.forces[interval];
        let [a, b, c, d] = hermite(part);
        let rates = [&x, &y].map(|x| task.vessel.rates(x, force));
        a * x + h * b * rates[0] + c * y + h * d * rates[1]
    };
    let force = |k: usize| profile.forces[at(to.time(k) + 0.5 * to.step()).0];
    Profile {
        states: (0..=to.intervals).map(state).collect(),
        forces: (0..to.intervals).map(force).collect(),
    }
}
