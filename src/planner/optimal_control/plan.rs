//! One problem: every start in parallel, the best plan of all, on a grid that is fine enough.

use std::time::Instant;

use rayon::prelude::*;

use super::attempt::{Attempt, attempt};
use super::defect::largest_defect;
use super::guess::{Start, family, profile_along};
use super::keep_out::KeepOut;
use super::passing::passing_sides;
use super::solver::{Settings, Status};
use super::task::{Controls, Profile, Task};
use super::transcription::Weights;
use crate::frame::{Side, Vector};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::planner::{
    ControlSettings, ExploredGraph, NoPlan, Outcome, Plan, Planned, Problem, SearchStats,
    space_time,
};
use crate::tolerance;
use crate::trajectory::{Steered, Trajectory, hermite};
use crate::vessel::{CyberShip2, FULL_SCALE, FroudeScaled, Manoeuvring, StateVector, VesselKind};

/// Where the intervals are too coarse there are half as many again, so often at most.
const REFINEMENTS: usize = 6;

/// The barrier to begin with on a finer grid.
const REFINED_BARRIER: f64 = 1e-2;

/// Relative. Plans this near in their objective are one plan: the earlier start is named.
const SAME: f64 = 1e-6;

/// What came of one start.
#[derive(Debug, Clone, PartialEq)]
pub struct StartReport {
    /// Which.
    pub start: Start,
    /// How its solve ended.
    pub status: Status,
    /// True when solved and clear of every set.
    pub feasible: bool,
    /// The integral of the stage cost.
    pub objective: f64,
    /// Steps of the solver.
    pub iterations: usize,
    /// Per set the side on which it is passed.
    pub sides: Vec<Option<Side>>,
}

/// Plans that pass every set alike.
#[derive(Debug, Clone, PartialEq)]
pub struct HomotopyClass {
    /// Per set the side on which it lies when nearest; `None` where it is far.
    pub sides: Vec<Option<Side>>,
    /// The least objective found.
    pub objective: f64,
    /// Starts that led there.
    pub starts: usize,
}

/// How a plan of forces was found.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlReport {
    /// Every start, in their order.
    pub starts: Vec<StartReport>,
    /// The classes of the feasible plans, the cheapest first.
    pub classes: Vec<HomotopyClass>,
    /// Intervals of the plan's grid.
    pub intervals: usize,
    /// The largest deviation at the end of an interval, in the ship's units; NaN without a plan.
    pub defect: f64,
}

/// A plan of forces and how it was found.
#[derive(Debug, Clone)]
pub struct Controlled {
    /// The verdict; the cost of a plan is the integral of the stage cost, its horizon the problem's.
    pub planned: Planned,
    /// How.
    pub report: ControlReport,
}

/// The sets that are kept out of: ellipsoids as they are, of others the smallest ellipses around their two sets, and
/// where a set has no interior one of a millimetre. Outer sets.
pub fn outer_sets(obstacles: &[Obstacle]) -> Vec<Obstacle> {
    obstacles
        .iter()
        .map(|o| KeepOut::outer_of(o).set().clone().into())
        .collect()
}

/// Plans forces that keep own ship clear of [`outer_sets`] over the whole horizon at least cost near the desired
/// trajectory.
///
/// The plan is a local optimum, the cheapest that the starts lead to: the space-time planner's trajectory, the desired one
/// bent to the sides, and bent past the worst sets on either side in every combination. Along the cubics between its
/// nodes it is clear of every set, and the ship, not smoothed, is at the next node to [`tolerance::DEFECT`] of her units.
/// The same problem gives the same plan with any number of threads, unless the deadline strikes.
pub fn plan(problem: &Problem, settings: &ControlSettings) -> Controlled {
    match settings.vessel {
        VesselKind::CyberShip2 => {
            Planner::new(problem, settings, CyberShip2::SMOOTH, CyberShip2::EXACT).plan()
        }
        VesselKind::CyberShip2Full => {
            let full = |model| FroudeScaled::new(model, FULL_SCALE);
            Planner::new(
                problem,
                settings,
                full(CyberShip2::SMOOTH),
                full(CyberShip2::EXACT),
            )
            .plan()
        }
    }
}

struct Planner<'a, V> {
    problem: &'a Problem<'a>,
    controls: Controls,
    intervals: usize,
    smooth: V,
    exact: V,
    keep_outs: Vec<KeepOut>,
    begun: Instant,
}

impl<'a, V: Manoeuvring> Planner<'a, V> {
    fn new(problem: &'a Problem, settings: &ControlSettings, smooth: V, exact: V) -> Self {
        Self {
            problem,
            controls: Controls {
                force_limits: settings.force_limits,
                weights: Weights {
                    state: settings.state_weights,
                    force: settings.force_weights,
                },
            },
            intervals: settings.intervals,
            smooth,
            exact,
            keep_outs: problem.obstacles.iter().map(KeepOut::outer_of).collect(),
            begun: Instant::now(),
        }
    }

    fn in_time(&self) -> bool {
        self.begun.elapsed() < self.problem.deadline
    }

    fn task(&self, intervals: usize) -> Task<'_, V> {
        let own = self.problem.own;
        Task {
            vessel: &self.smooth,
            controls: self.controls,
            desired: self.problem.desired,
            keep_outs: &self.keep_outs,
            first: StateVector::new(
                own.pose.position.x,
                own.pose.position.y,
                own.pose.heading,
                own.speed,
                0.0,
                0.0,
            ),
            start_time: 0.0,
            duration: self.problem.horizon,
            intervals,
        }
    }

    fn plan(&self) -> Controlled {
        let mut report = ControlReport {
            starts: Vec::new(),
            classes: Vec::new(),
            intervals: self.intervals,
            defect: f64::NAN,
        };
        let outcome = match self.start_inside() {
            Some(reason) => Outcome::Infeasible(reason),
            None => self.find(&mut report),
        };
        Controlled {
            planned: Planned {
                outcome,
                stats: SearchStats::default(),
                explored: ExploredGraph::new(),
                path_time: None,
            },
            report,
        }
    }

    fn start_inside(&self) -> Option<NoPlan> {
        let start = self.problem.own.pose.position;
        self.keep_outs.iter().find_map(|keep| {
            let distance = keep.set().signed_distance(start, 0.0).distance;
            // negated on purpose: a NaN is inside
            (!(distance >= -tolerance::LENGTH_M)).then(|| NoPlan::StartInside {
                target: keep.set().name().to_owned(),
                depth: -distance,
            })
        })
    }

    fn find(&self, report: &mut ControlReport) -> Outcome {
        let task = self.task(self.intervals);
        let keep_going = || self.in_time();
        let mut starts: Vec<(Start, Option<Profile>)> = family(&task)
            .into_iter()
            .map(|(start, guess)| (start, Some(guess)))
            .collect();
        // the longest first, so that no thread waits for it alone
        starts.insert(0, (Start::SpaceTime, None));
        let attempts: Vec<(Start, Attempt)> = starts
            .into_par_iter()
            .filter_map(|(start, guess)| {
                let guess = guess.or_else(|| self.space_time(&task))?;
                Some((
                    start,
                    attempt(&task, &guess, &Settings::default(), &keep_going),
                ))
            })
            .collect();
        for (start, found) in &attempts {
            report.starts.push(StartReport {
                start: *start,
                status: found.report.status,
                feasible: found.is_feasible(),
                objective: found.objective,
                iterations: found.iterations,
                sides: self
                    .steered(&task, &found.profile)
                    .map_or_else(Vec::new, |motion| passing_sides(&motion, &self.keep_outs)),
            });
        }
        report.classes = classes(&report.starts);
        let Some(best) = cheapest(&attempts) else {
            return if self.in_time() {
                Outcome::Infeasible(self.locked(&attempts))
            } else {
                Outcome::Deadline(None)
            };
        };
        let outcome = self.refined(best, report);
        match outcome {
            Outcome::Solved(plan) if !self.in_time() => Outcome::Deadline(Some(plan)),
            _ if !self.in_time() => Outcome::Deadline(None),
            other => other,
        }
    }

    /// The space-time planner's positions at the nodes; at its end after it has arrived.
    fn space_time(&self, task: &Task<V>) -> Option<Profile> {
        let left = self.problem.deadline.saturating_sub(self.begun.elapsed());
        let planned = space_time::plan(&Problem {
            deadline: left,
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

    /// The plan on a grid that is fine enough.
    fn refined(&self, best: &Attempt, report: &mut ControlReport) -> Outcome {
        let mut task = self.task(self.intervals);
        let mut found = best.clone();
        let mut refinements = 0;
        loop {
            report.intervals = task.intervals;
            report.defect = largest_defect(&self.exact, &found.profile, task.step());
            // negated on purpose: a NaN is too coarse
            if !(report.defect > tolerance::DEFECT) {
                break;
            }
            if refinements == REFINEMENTS || !self.in_time() {
                return Outcome::Infeasible(NoPlan::Coarse {
                    intervals: task.intervals,
                    off: report.defect,
                    allowed: tolerance::DEFECT,
                });
            }
            refinements += 1;
            let finer = self.task(task.intervals + task.intervals.div_ceil(2));
            let guess = resampled(&task, &found.profile, &finer);
            task = finer;
            let settings = Settings {
                barrier: REFINED_BARRIER,
                ..Settings::default()
            };
            found = attempt(&task, &guess, &settings, &|| self.in_time());
            if !found.is_feasible() {
                return Outcome::Infeasible(self.locked(&[(Start::Refined, found)]));
            }
        }
        let motion = self.steered(&task, &found.profile);
        motion.map_or(Outcome::Infeasible(NoPlan::NoRoute), |motion| {
            Outcome::Solved(Plan {
                trajectory: Trajectory::from(motion),
                cost: found.objective,
                graph_cost: None,
            })
        })
    }

    /// Why none of the attempts is a plan.
    fn locked(&self, attempts: &[(Start, Attempt)]) -> NoPlan {
        let starts = attempts.len();
        let solved = attempts
            .iter()
            .filter(|(_, a)| a.report.status == Status::Solved)
            .filter_map(|(_, a)| a.inside)
            .max_by(|a, b| a.level.total_cmp(&b.level));
        let Some(inside) = solved else {
            let status = attempts.first().map(|(_, a)| a.report.status);
            return NoPlan::Unsolved {
                starts,
                why: status.map_or_else(|| "no start".to_owned(), |s| s.to_string()),
            };
        };
        let set = self.keep_outs[inside.obstacle].set();
        // in the direction of the narrower half width at least this deep
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

/// The cheapest feasible one; of equals the first.
fn cheapest(attempts: &[(Start, Attempt)]) -> Option<&Attempt> {
    let mut best: Option<&Attempt> = None;
    for (_, attempt) in attempts.iter().filter(|(_, a)| a.is_feasible()) {
        let better = |b: &Attempt| attempt.objective < b.objective * (1.0 - SAME);
        if best.is_none_or(better) {
            best = Some(attempt);
        }
    }
    best
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
