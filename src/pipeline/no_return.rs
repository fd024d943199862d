//! The time of no return: the last moment from which a plan clear of every hard set was found.

use super::{Run, land_obstacle, problem};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::planner::space_time;

/// Accuracy of the time of no return, seconds.
pub const NO_RETURN_STEP_S: f64 = 1.0;

/// How long own ship can hold its course and speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoReturn {
    /// The desired trajectory meets no hard set.
    Never,
    /// Seconds. After holding until then a plan clear of every hard set exists; none was found
    /// [`NO_RETURN_STEP_S`] later.
    At(f64),
    /// No such plan was found even from the start.
    Past,
}

impl NoReturn {
    /// The time in seconds, where there is one.
    pub fn time(self) -> Option<f64> {
        match self {
            Self::At(time) => Some(time),
            Self::Never | Self::Past => None,
        }
    }
}

impl Run {
    /// How long own ship can follow the desired trajectory and still have a plan clear of every
    /// hard set, independent of the plan of this run.
    ///
    /// `None` for planners other than space-time, and where the trajectory cannot be followed.
    /// Bisection between the start and the first contact: a plan from a later time is also a plan
    /// now. The plan that was found exists; the planner may have missed a later one. About ten
    /// plans.
    pub fn no_return(&self) -> Option<NoReturn> {
        let scenario = &self.scenario;
        if !scenario.planner.facts().has_no_return {
            return None;
        }
        let hard: Vec<Obstacle> = self.targets.iter().map(|t| t.sets.hard.clone()).collect();
        let land_obstacle = land_obstacle(scenario, &self.land.pieces);
        let asked = problem(scenario, &hard, &land_obstacle);
        let held = space_time::nominal_motion(&asked)?;
        let contacts = hard.iter().filter_map(|set| {
            held.iter()
                .find_map(|s| set.first_contact(s, crate::tolerance::TOUCH_M))
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
