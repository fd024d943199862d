//! The last moment at which a plan that is clear of every hard set still exists.

use super::sets::TargetSets;
use super::{Run, coast, problem};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::planner::{PlannerKind, space_time};

/// Seconds to which the time of no return is sought.
pub const NO_RETURN_STEP_S: f64 = 1.0;

/// How long own ship may hold on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoReturn {
    /// On the desired trajectory she meets no hard set.
    Never,
    /// Held so long, seconds, there still is a plan that is clear of every hard set; [`NO_RETURN_STEP_S`] later none was found.
    At(f64),
    /// None was found even from the start.
    Past,
}

impl NoReturn {
    /// Seconds, where there is such a time.
    pub fn time(self) -> Option<f64> {
        match self {
            Self::At(time) => Some(time),
            Self::Never | Self::Past => None,
        }
    }
}

impl Run {
    /// How long own ship can follow the desired trajectory as if nobody were there and still have a plan that is clear of every hard
    /// set, whatever the plan of this run is. `None` for planners other than space-time, and where the trajectory cannot be
    /// followed at all.
    ///
    /// Whoever may still leave later may leave now, so it is sought by bisection between the start and the first contact. What was
    /// found exists; the planner may have missed a later one. Some ten plans.
    pub fn no_return(&self) -> Option<NoReturn> {
        let scenario = &self.scenario;
        if scenario.planner != PlannerKind::SpaceTime {
            return None;
        }
        let hard: Vec<Obstacle> = self.sets.iter().map(TargetSets::hard_set).collect();
        let coast = coast(scenario, &self.land);
        let asked = problem(scenario, &hard, &coast);
        let held = space_time::nominal_motion(&asked)?;
        let contacts = hard.iter().filter_map(|set| {
            held.iter()
                .find_map(|s| set.first_contact(s, super::ladder::TOUCH_M))
        });
        let Some(met) = contacts.min_by(f64::total_cmp) else {
            return Some(NoReturn::Never);
        };
        let leaves = |time: f64| space_time::after_holding(&asked, &held, time).is_some();
        if !leaves(0.0) {
            return Some(NoReturn::Past);
        }
        let (mut good, mut bad) = (0.0, met);
        while bad - good > NO_RETURN_STEP_S {
            let middle = 0.5 * (good + bad);
            if leaves(middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        Some(NoReturn::At(good))
    }
}
