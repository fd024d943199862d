//! Planning of one problem: all initial guesses in parallel, then the best plan on a grid that is
//! fine enough.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use super::attempt::{StartAttempt, attempt};
use super::grid::{GridResult, Refined, refine_grid};
use super::guess::{Start, family, profile_along};
use super::keep_out::KeepOut;
use super::passing::passing_sides;
use super::report::{ControlReport, HomotopyClass, StartReport};
use super::solver::{Settings, SolverStatus};
use super::task::{Controls, Profile, Task};
use crate::{ControlSettings, NoPlan, Outcome, Plan, PlanMethod, Planned, Problem, space_time};
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance;
use searoom_model::trajectory::{Steered, Trajectory};
use searoom_model::vessel::{CyberShip2, Manoeuvring, StateVector, VesselKind};
use searoom_sets::SpaceTimeObstacle;

/// Fraction of the time budget for the initial guesses; the rest is for grid refinement. While none
/// has led to a plan they continue: the grid of the first plan may be fine enough.
const STARTS_SHARE: f64 = 0.6;

/// Fraction of the time budget for the space-time planner, which provides one initial guess.
const SPACE_TIME_SHARE: f64 = 0.25;

/// Initial barrier parameter where the last plan is the guess.
const WARM_BARRIER: f64 = 1e-4;

/// Relative difference of the objective below which two plans are the same.
const SAME_OBJECTIVE: f64 = 1e-6;

/// Plans forces that keep own ship clear of the ellipses around all sets over the whole horizon at
/// least cost near the desired trajectory.
///
/// The cost of a plan is the integral of the stage cost up to the problem's horizon. The plan is a
/// local optimum, the cheapest over all initial guesses. The guesses are the space-time planner's
/// trajectory, and the desired one bent to the sides or around the worst sets on either side in
/// every combination.
///
/// The cubics between the nodes are clear of every set. The ship model without smoothing meets the
/// next node to [`tolerance::DEFECT`] of its units. Equal problems give equal plans with any
/// number of threads, unless the deadline is reached.
pub fn plan(problem: &Problem, settings: &ControlSettings) -> Planned {
    match settings.vessel {
        VesselKind::CyberShip2 => {
            let [smooth, exact] = [CyberShip2::SMOOTH, CyberShip2::EXACT]
                .map(|model| model.at_length(settings.length));
            Planning::new(problem, settings, smooth, exact).plan()
        }
    }
}

struct Planning<'a, V> {
    problem: &'a Problem<'a>,
    controls: Controls,
    intervals: usize,
    smooth: V,
    exact: V,
    keep_outs: Vec<KeepOut>,
    started: Instant,
}

impl<'a, V: Manoeuvring> Planning<'a, V> {
    fn new(problem: &'a Problem, settings: &ControlSettings, smooth: V, exact: V) -> Self {
        Self {
            problem,
            controls: Controls::from(settings),
            intervals: settings.intervals,
            smooth,
            exact,
            keep_outs: problem.obstacles.iter().map(KeepOut::outer_of).collect(),
            started: Instant::now(),
        }
    }

    fn in_time(&self) -> bool {
        self.started.elapsed() < self.problem.deadline
    }

    fn in_share(&self, share: f64) -> bool {
        self.started.elapsed() < self.problem.deadline.mul_f64(share)
    }

    fn task(&self, intervals: usize) -> Task<'_, V> {
        let own = self.problem.own;
        Task {
            vessel: &self.smooth,
            controls: self.controls,
            desired: self.problem.desired,
            keep_outs: &self.keep_outs,
            first: self.problem.warm_start.map_or_else(
                || {
                    let place = own.pose.position;
                    StateVector::new(place.x, place.y, own.pose.heading, own.speed, 0.0, 0.0)
                },
                |warm| warm.state,
            ),
            duration: self.problem.horizon,
            intervals,
        }
    }

    fn plan(&self) -> Planned {
        let mut report = ControlReport {
            starts: Vec::new(),
            classes: Vec::new(),
            start_intervals: self.intervals,
            intervals: self.intervals,
            defect: f64::NAN,
        };
        let outcome = match self.start_inside() {
            Some(reason) => Outcome::Infeasible(reason),
            None => self.find(&mut report),
        };
        Planned {
            control: Some(Box::new(report)),
            ..Planned::of(outcome)
        }
    }

    fn start_inside(&self) -> Option<NoPlan> {
        let start = self.problem.own.pose.position;
        self.keep_outs.iter().find_map(|keep| {
            let distance = keep.set().signed_distance(start, 0.0).distance;
            // negated on purpose: a NaN is inside
            (!(distance >= -tolerance::LENGTH_M)).then(|| NoPlan::StartInside {
                target: keep.set().name().to_owned(),
                // the distance from a point is not defined at the point
                depth: (-distance).max(0.0),
            })
        })
    }

    fn find(&self, report: &mut ControlReport) -> Outcome {
        if let Some(outcome @ Outcome::Solved(_)) = self.warm_started(report) {
            return outcome;
        }
        let mut attempts = self.attempts(&Settings::default());
        let lost = |(_, attempt): &(_, Option<StartAttempt>)| {
            attempt.as_ref().is_none_or(StartAttempt::is_lost)
        };
        if attempts.iter().all(lost) && self.in_share(STARTS_SHARE) {
            attempts = self.attempts(&Settings {
                gauss_newton: false,
                ..Settings::default()
            });
        }
        let late = attempts
            .iter()
            .any(|(report, _)| report.status == SolverStatus::OutOfTime);
        let (reports, attempts): (Vec<StartReport>, Vec<Option<StartAttempt>>) =
            attempts.into_iter().unzip();
        report.starts.extend(reports);
        report.classes = classes(&report.starts);
        let attempts: Vec<StartAttempt> = attempts.into_iter().flatten().collect();
        match self.cheapest_on_fine_grid(&attempts, report) {
            Outcome::Solved(plan) if late || !self.in_time() => Outcome::Deadline(Some(plan)),
            _ if late || !self.in_time() => Outcome::Deadline(None),
            other => other,
        }
    }

    /// The plan that the last one leads to, as long as there is one: no other side is tried.
    fn warm_started(&self, report: &mut ControlReport) -> Option<Outcome> {
        let warm = self.problem.warm_start?;
        let task = self.task(self.intervals);
        let settings = Settings {
            barrier: WARM_BARRIER,
            ..Settings::default()
        };
        let guess = Some(warm.profile(&task));
        let keep_going = || self.in_share(STARTS_SHARE);
        let (start, found) =
            self.attempt_from(&task, Start::Previous, guess, &settings, &keep_going)?;
        report.starts.push(start);
        report.classes = classes(&report.starts);
        found.map(|found| self.cheapest_on_fine_grid(&[found], report))
    }

    /// Results of all initial guesses, in their order.
    fn attempts(&self, settings: &Settings) -> Vec<(StartReport, Option<StartAttempt>)> {
        let task = self.task(self.intervals);
        let mut starts: Vec<(Start, Option<Profile>)> = family(&task)
            .into_iter()
            .map(|(start, guess)| (start, Some(guess)))
            .collect();
        // the longest first, so that no thread waits for it alone
        starts.insert(0, (Start::SpaceTime, None));
        let any_feasible = AtomicBool::new(false);
        let keep_going = || {
            self.in_share(STARTS_SHARE) || self.in_time() && !any_feasible.load(Ordering::Relaxed)
        };
        starts
            .into_par_iter()
            .filter_map(|(start, guess)| {
                let attempt = self.attempt_from(&task, start, guess, settings, &keep_going)?;
                any_feasible.fetch_or(attempt.0.feasible, Ordering::Relaxed);
                Some(attempt)
            })
            .collect()
    }

    /// Result of one initial guess. `None` where the space-time planner has no plan; no attempt
    /// after the deadline.
    fn attempt_from(
        &self,
        task: &Task<V>,
        start: Start,
        guess: Option<Profile>,
        settings: &Settings,
        keep_going: &(dyn Fn() -> bool + Sync),
    ) -> Option<(StartReport, Option<StartAttempt>)> {
        if !keep_going() {
            let unsolved = StartReport {
                start,
                status: SolverStatus::OutOfTime,
                feasible: false,
                objective: f64::NAN,
                iterations: 0,
                sides: Vec::new(),
            };
            return Some((unsolved, None));
        }
        let guess = guess.or_else(|| self.space_time(task))?;
        let found = attempt(task, &guess, settings, keep_going);
        let feasible = found.is_feasible();
        let motion = self.steered(task, &found.profile).filter(|_| feasible);
        let report = StartReport {
            start,
            status: found.report.status,
            feasible,
            objective: found.objective,
            iterations: found.iterations,
            sides: motion.map_or_else(Vec::new, |m| passing_sides(&m, &self.keep_outs)),
        };
        Some((report, Some(found)))
    }

    /// Cheapest attempt that can be refined to a fine enough grid; after the deadline, the cheapest
    /// that is on one.
    fn cheapest_on_fine_grid(
        &self,
        attempts: &[StartAttempt],
        report: &mut ControlReport,
    ) -> Outcome {
        let mut unrefined = None;
        for found in cheapest_first(attempts) {
            let fine = self.refined(found);
            // of several failures the cheapest is reported
            if unrefined.is_none() || fine.plan.is_ok() {
                (report.intervals, report.defect) = (fine.intervals, fine.defect);
            }
            match fine.plan {
                Ok(plan) => return Outcome::Solved(plan),
                Err(reason) => unrefined = unrefined.or(Some(reason)),
            }
        }
        Outcome::Infeasible(unrefined.unwrap_or_else(|| self.no_plan_reason(attempts)))
    }

    /// Positions of the space-time planner's plan at the nodes; its end point after the arrival.
    fn space_time(&self, task: &Task<V>) -> Option<Profile> {
        let until = self.problem.deadline.mul_f64(SPACE_TIME_SHARE);
        let left = until.saturating_sub(self.started.elapsed());
        let planned = space_time::plan(&Problem {
            deadline: left,
            tidy: None,
            ..self.problem.clone()
        });
        let plan = planned.outcome.plan()?;
        let positions: Vec<Vector> = (0..=task.intervals)
            .map(|k| plan.trajectory.pose_at(task.time(k)).position)
            .collect();
        Some(profile_along(task, &positions))
    }

    fn steered(&self, task: &Task<V>, profile: &Profile) -> Option<Steered> {
        Steered::new(task.nodes(&profile.states, &profile.forces)).ok()
    }

    /// Attempt refined to a fine enough grid.
    fn refined(&self, found: &StartAttempt) -> Fine {
        let first = self.task(self.intervals);
        let grid = refine_grid(&first, found, &self.exact, &|| self.in_time());
        let Refined {
            intervals, defect, ..
        } = grid;
        let plan = match grid.ended {
            GridResult::Fine => self
                .steered(&self.task(intervals), &grid.found.profile)
                .map(|motion| Plan {
                    trajectory: Trajectory::from(motion),
                    cost: grid.found.objective,
                    method: PlanMethod::OptimalControl,
                    graph_cost: None,
                    // no arrival is required
                    to_go: 0.0,
                })
                .ok_or(NoPlan::NoRoute),
            GridResult::Coarse => Err(NoPlan::Coarse {
                intervals,
                off: defect,
                allowed: tolerance::DEFECT,
            }),
            GridResult::Lost => Err(NoPlan::Lost {
                intervals,
                coarse: self.intervals,
                why: match grid
                    .found
                    .inside
                    .filter(|_| grid.found.report.status == SolverStatus::Solved)
                {
                    Some(inside) => format!(
                        "it would be inside the set of '{}' at {:.1} s",
                        self.keep_outs[inside.obstacle].set().name(),
                        inside.time
                    ),
                    None => status_text(grid.found.report.status),
                },
            }),
        };
        Fine {
            plan,
            intervals,
            defect,
        }
    }

    /// Reason why none of the attempts is a plan.
    fn no_plan_reason(&self, attempts: &[StartAttempt]) -> NoPlan {
        let starts = attempts.len();
        let solved = attempts
            .iter()
            .filter(|a| a.report.status == SolverStatus::Solved)
            .filter_map(|a| a.inside)
            .max_by(|a, b| a.level.total_cmp(&b.level));
        let Some(inside) = solved else {
            let status = attempts.first().map(|a| a.report.status);
            return NoPlan::Unsolved {
                starts,
                why: status.map_or_else(|| "no start".to_owned(), status_text),
            };
        };
        let set = self.keep_outs[inside.obstacle].set();
        // least depth in the direction of the narrower half width
        let section = set.outer_section(inside.time);
        let narrow = section
            .semi_axes()
            .map(|a| a.norm())
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        NoPlan::Locked {
            starts,
            target: set.name().to_owned(),
            time: inside.time,
            depth: narrow * (1.0 - inside.level.max(0.0).sqrt()),
        }
    }
}

/// Plan on a fine enough grid, or the reason why there is none.
struct Fine {
    plan: Result<Plan, NoPlan>,
    intervals: usize,
    defect: f64,
}

/// Solver status in words, with a remedy.
fn status_text(status: SolverStatus) -> String {
    match hint(status) {
        Some(hint) => format!("{status}; {hint}"),
        None => status.to_string(),
    }
}

fn hint(status: SolverStatus) -> Option<&'static str> {
    match status {
        SolverStatus::Iterations | SolverStatus::Stalled | SolverStatus::Unbounded => Some(
            "what may help: weights and force limits nearer to the vessel's own, more intervals \
             (planner.optimal_control), a shorter horizon",
        ),
        SolverStatus::NotANumber | SolverStatus::Singular => Some(
            "what may help: more intervals (planner.optimal_control), a speed nearer to what the vessel can make",
        ),
        SolverStatus::OutOfTime => Some("what may help: a longer planner.deadline_s"),
        SolverStatus::Solved | SolverStatus::BadProblem => None,
    }
}

/// Feasible attempts, cheapest first; among equals the earlier one.
fn cheapest_first(attempts: &[StartAttempt]) -> Vec<&StartAttempt> {
    let mut left: Vec<&StartAttempt> = attempts.iter().filter(|a| a.is_feasible()).collect();
    // stable; then attempts with the same plan in the order of their initial guesses
    left.sort_by(|a, b| a.objective.total_cmp(&b.objective));
    let same =
        |a: &StartAttempt, b: &StartAttempt| !(a.objective < b.objective * (1.0 - SAME_OBJECTIVE));
    left.dedup_by(|next, kept| same(kept, next));
    left
}

fn classes(starts: &[StartReport]) -> Vec<HomotopyClass> {
    let mut classes: Vec<HomotopyClass> = Vec::new();
    for start in starts.iter().filter(|s| s.feasible) {
        match classes.iter_mut().find(|c| c.sides == start.sides) {
            Some(class) => {
                class.objective = class.objective.min(start.objective);
                class.starts += 1;
            }
            None => classes.push(HomotopyClass {
                sides: start.sides.clone(),
                objective: start.objective,
                starts: 1,
            }),
        }
    }
    classes.sort_by(|a, b| a.objective.total_cmp(&b.objective));
    classes
}

#[cfg(test)]
mod tests;
