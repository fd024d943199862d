//! Own ship stays at the last waypoint after its arrival.
//!
//! ```text
//! answer ─► rest until the stay ends ─► clear? ─► done
//!                                         └─► arrive later, or clear the place and return,
//!                                             else smaller domains, else inside
//! ```

use super::entered;
use super::judge::judge;
use super::relaxation::{Attempt, RelaxationLevel, Relaxer, out_of_time};
use super::rules;
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::planner::{NoPlan, Outcome, Plan, PlanMethod, Planned, whole_space_time_error};
use crate::scenario::Compliance;
use crate::tolerance::TOUCH_M;
use crate::trajectory::{Segment, Trajectory, before_stay, rested};

impl Relaxer<'_> {
    /// The answer with the rest at the last waypoint until the stay ends. Where sets pass over the
    /// place, own ship arrives later, or clears it and returns; where no such motion is clear, it
    /// stays inside the sets, which the level says. A motion that ends before the place rests where it
    /// ends.
    pub(super) fn with_stay(&self, answer: Attempt) -> Attempt {
        let Some(until) = self.scenario.stay else {
            return answer;
        };
        let Some(plan) = answer.planned.outcome.plan() else {
            return answer;
        };
        let arrival = plan.trajectory.segments().to_vec();
        let Some(whole) = self.with_rest(plan, until) else {
            return answer;
        };
        let rest = rest_after(&arrival, &whole);
        let Some((target, from)) = first_contact(&answer.obstacles, &rest) else {
            return with_plan(answer, whole);
        };
        let is_late = matches!(answer.planned.outcome, Outcome::Deadline(_));
        let found = match answer.level < RelaxationLevel::Inside {
            true => self.clear_stay(&answer, &arrival, &rest, &whole, until),
            false => self.stay_beside_entered(&answer, &arrival, &rest, &whole, until),
        };
        let mut stayed = found.unwrap_or_else(|| self.staying_inside(&answer, whole));
        let gives_up = stayed.level > answer.level || has_arrived(&answer) && !has_arrived(&stayed);
        if gives_up || stayed.why.is_none() {
            stayed.why = Some(NoPlan::StayCovered {
                target,
                from,
                until,
            });
        }
        match is_late || self.time_left().is_zero() {
            true => out_of_time(stayed),
            false => stayed,
        }
    }

    /// A clear stay: off the place while the answer's sets pass over it, else at rest in smaller
    /// domains, else off the place against the hard sets and as much of the domains as is clear.
    fn clear_stay(
        &self,
        answer: &Attempt,
        arrival: &[Segment],
        rest: &[Segment],
        whole: &Plan,
        until: f64,
    ) -> Option<Attempt> {
        if let Some(found) = self.off_station(answer, &answer.obstacles, arrival, until) {
            return Some(found);
        }
        let hard = self.against_hard_sets(answer.risk);
        let found = match first_contact(&hard, rest) {
            None => with_plan(answer.clone(), whole.clone()),
            Some(_) => self.off_station(answer, &hard, arrival, until)?,
        };
        let level = RelaxationLevel::ReducedDomains.max(found.level);
        let retained = self.retained_along(found.trajectory()?, answer.risk);
        Some(self.clear_of(&found, &retained, level))
    }

    /// The stay of own ship that is in some sets from the start, off the place while the others pass
    /// over it. It is taken where the least clearance to any hull that a target may have is larger
    /// than at rest.
    fn stay_beside_entered(
        &self,
        answer: &Attempt,
        arrival: &[Segment],
        rest: &[Segment],
        whole: &Plan,
        until: f64,
    ) -> Option<Attempt> {
        let start = self.scenario.own_ship.pose.position;
        // negated on purpose: a set at an unknown distance is avoided, too
        let is_outside = |set: &&Obstacle| !(set.signed_distance(start, 0.0).distance <= 0.0);
        let hard = self.sets.iter().map(|sets| &sets.hard);
        let others: Vec<Obstacle> = hard.filter(is_outside).cloned().collect();
        first_contact(&others, rest)?;
        let found = self.off_station(answer, &others, arrival, until)?;
        let plan = found.planned.outcome.plan()?.clone();
        let clearance = |plan: &Plan| {
            let evaluation = judge(self.scenario, &[], &plan.trajectory);
            let [hulls, land] = [evaluation.min_clearance, evaluation.min_land_distance];
            // the minimum would pass over a NaN, which is a collision
            match hulls.is_nan() || land.is_nan() {
                true => f64::NEG_INFINITY,
                false => hulls.min(land),
            }
        };
        (clearance(&plan) > clearance(whole)).then(|| self.staying_inside(answer, plan))
    }

    /// The motion off the place that breaks the fewest rules, of these the one that returns, and of
    /// these the first. Where it breaks one, the level says that the rules are given up.
    fn off_station(
        &self,
        answer: &Attempt,
        obstacles: &[Obstacle],
        arrival: &[Segment],
        until: f64,
    ) -> Option<Attempt> {
        let problem = self.problem(obstacles);
        let plans = self.scenario.planner.off_station(&problem, arrival, until);
        let plans = plans.into_iter().filter_map(|plan| {
            let plan = self.with_rest(&plan, until)?;
            Some((rules::breaks(self.scenario, &plan.trajectory), plan))
        });
        let best = plans.min_by_key(|(broken, plan)| (*broken, !plan.arrives()));
        let (broken, plan) = best?;
        let gives_up_rules = broken > 0 && self.scenario.compliance == Compliance::Rules;
        Some(Attempt {
            level: match gives_up_rules {
                true => answer.level.max(RelaxationLevel::Domains),
                false => answer.level,
            },
            // the search of the answer did not make this motion
            planned: Planned::of(Outcome::Solved(plan)),
            ..answer.clone()
        })
    }

    /// The stay inside the sets that pass over the place; nothing is claimed of each before it has
    /// passed.
    fn staying_inside(&self, answer: &Attempt, plan: Plan) -> Attempt {
        let hard: Vec<Obstacle> = self.sets.iter().map(|sets| sets.hard.clone()).collect();
        let is_up = || self.time_left().is_zero();
        let left = |set| entered::left_for_good(set, &plan.trajectory, is_up);
        let released = hard.iter().map(left).collect();
        let plan = Plan {
            method: match plan.method {
                // it is the rest that enters the sets
                PlanMethod::Rules => PlanMethod::LeastHarm,
                method => method,
            },
            ..plan
        };
        let planned = Planned {
            // no search made a motion off the place
            stats: (answer.planned.stats).filter(|_| plan.method != PlanMethod::OffStation),
            path_time: answer.planned.path_time.clone(),
            ..Planned::of(Outcome::Solved(plan))
        };
        Attempt {
            level: RelaxationLevel::Inside,
            released,
            reductions: self.given_up(&answer.reductions),
            obstacles: hard.clone(),
            whole: hard,
            risk: 0.0,
            planned,
            why: answer.why.clone(),
        }
    }

    /// A plan with the rest at its end. The cost of a motion off the place is that before its first
    /// rest there, because the desired trajectory ends with the arrival.
    fn with_rest(&self, plan: &Plan, until: f64) -> Option<Plan> {
        let mut motion = rested(plan.trajectory.segments().to_vec(), until);
        if motion.is_empty() {
            motion = plan.trajectory.segments().to_vec();
        }
        let cost = match plan.method {
            PlanMethod::OffStation => {
                let (desired, weight) = (&self.scenario.desired, self.scenario.time_weight);
                whole_space_time_error(desired, before_stay(desired, &motion), weight)
            }
            _ => plan.cost,
        };
        let trajectory = match self.scenario.planner.facts().follows_paths {
            true => Trajectory::with_corners(motion),
            false => Trajectory::new(motion),
        };
        Some(Plan {
            trajectory: trajectory.ok()?,
            cost,
            ..plan.clone()
        })
    }
}

/// The part of a plan after the motion that it rests from.
fn rest_after(motion: &[Segment], whole: &Plan) -> Vec<Segment> {
    let end = motion.last().map_or(0.0, Segment::end_time);
    let segments = whole.trajectory.segments().iter();
    let rest = segments.filter(|segment| segment.start_time >= end && segment.duration > 0.0);
    rest.copied().collect()
}

/// The first set that a motion enters, with the time.
fn first_contact(obstacles: &[Obstacle], motion: &[Segment]) -> Option<(String, f64)> {
    let contact = |set: &Obstacle| {
        let mut contacts = (motion.iter()).filter_map(|s| set.first_contact(s, TOUCH_M));
        Some((set.name().to_owned(), contacts.next()?))
    };
    let contacts = obstacles.iter().filter_map(contact);
    contacts.min_by(|a, b| a.1.total_cmp(&b.1))
}

fn has_arrived(attempt: &Attempt) -> bool {
    attempt.planned.outcome.plan().is_some_and(Plan::arrives)
}

/// An attempt with another plan; a deadline stays one.
fn with_plan(mut attempt: Attempt, plan: Plan) -> Attempt {
    attempt.planned.outcome = match attempt.planned.outcome {
        Outcome::Deadline(_) => Outcome::Deadline(Some(plan)),
        _ => Outcome::Solved(plan),
    };
    attempt
}
