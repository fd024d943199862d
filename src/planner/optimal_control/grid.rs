//! From a motion on one grid to the same one on a grid on which it is the ship's.

use super::attempt::{Attempt, attempt};
use super::defect::largest_defect;
use super::solver::Settings;
use super::task::{Profile, Task};
use crate::tolerance;
use crate::trajectory::hermite;
use crate::vessel::Manoeuvring;

/// Grids that are tried after the first one, at most.
const REFINEMENTS: usize = 6;

/// A finer grid has so many times the intervals, at least and at most.
const LEAST_FACTOR: f64 = 1.5;
const MOST_FACTOR: f64 = 4.0;

/// Deviations at the end of an interval fall with this power of its duration.
const ORDER: f64 = 5.0;

/// The barrier to begin with on a finer grid.
const REFINED_BARRIER: f64 = 1e-2;

/// How the search for a grid ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ended {
    /// With one that is fine enough.
    Fine,
    /// The last one that was tried, or that there was time for, is too coarse.
    Coarse,
    /// On the last one no plan was found any more.
    Lost,
}

/// A motion on the last grid that was tried.
#[derive(Debug)]
pub(super) struct Refined {
    pub found: Attempt,
    pub intervals: usize,
    /// The largest deviation of the ship at the end of an interval, in her units.
    pub defect: f64,
    pub ended: Ended,
}

/// Brings a feasible motion to a grid on which `exact` follows it to [`tolerance::DEFECT`].
pub(super) fn brought_to<V: Manoeuvring>(
    coarse: &Task<V>,
    found: &Attempt,
    exact: &V,
    keep_going: &dyn Fn() -> bool,
) -> Refined {
    let mut task = Task { ..*coarse };
    let mut found = found.clone();
    let mut refinements = 0;
    loop {
        let defect = largest_defect(exact, &found.profile, task.step());
        let ended = if !found.is_feasible() {
            Some(Ended::Lost)
        } else if defect <= tolerance::DEFECT {
            Some(Ended::Fine)
        } else if refinements == REFINEMENTS || !keep_going() {
            Some(Ended::Coarse)
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

/// Intervals with which a deviation should be small enough; a NaN takes the most.
fn finer(intervals: usize, defect: f64) -> usize {
    let factor = (defect / tolerance::DEFECT).powf(1.0 / ORDER);
    let factor = if factor < MOST_FACTOR {
        factor.max(LEAST_FACTOR)
    } else {
        MOST_FACTOR
    };
    (intervals as f64 * factor).ceil() as usize
}

/// The same motion on another grid: states on the cubics, forces as they are at the middle of each interval.
fn resampled<V: Manoeuvring>(task: &Task<V>, profile: &Profile, to: &Task<V>) -> Profile {
    let h = task.step();
    let at = |time: f64| {
        let place = (time - task.start_time) / h;
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
