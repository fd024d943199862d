//! Own ship stays at the last waypoint after her arrival.
//!
//! ```text
//! answer ─► rest until the stay ends ─► clear? ─► done
//!                                         └─► arrive later, or clear the place and return ─► else inside
//! ```

use super::entered;
use super::relaxation::{Attempt, RelaxationLevel, Relaxer};
use super::rules;
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::planner::{NoPlan, Outcome, Plan, PlanMethod, Planned, whole_space_time_error};
use crate::tolerance::TOUCH_M;
use crate::trajectory::{Segment, Trajectory, before_rest_at};

impl Relaxer<'_> {
    /// The answer with the rest at the last waypoint until the stay ends. Where sets pass over the
    /// place, own ship arrives later, or clears it and returns; where no such motion is clear, she
    /// stays inside the sets, which the level says. An answer that does not arrive is left as it is.
    pub(super) fn with_stay(&self, answer: Attempt) -> Attempt {
        let Some(until) = self.scenario.stay else {
            return answer;
        };
        let Some(plan) = answer.planned.outcome.plan().filter(|plan| plan.arrives()) else {
            return answer;
        };
        let arrival = plan.trajectory.segments().to_vec();
        let Some(whole) = self.rested(plan, &arrival, until) else {
            return answer;
        };
        let motion = whole.trajectory.segments();
        let rest = &motion[before_rest_at(self.scenario.desired.end(), motion).len()..];
        let Some((target, from)) = first_contact(&answer.obstacles, rest) else {
            return with_plan(answer, whole);
        };
        let why = NoPlan::StayCovered {
            target,
            from,
            until,
        };
        // a motion that enters sets anyway is not made longer by a search
        let found = match answer.level < RelaxationLevel::Inside {
            true => self.off_station(&answer, &arrival, until),
            false => None,
        };
        let stayed = found.unwrap_or_else(|| self.staying_inside(answer, whole));
        Attempt {
            why: stayed.why.clone().or(Some(why)),
            ..stayed
        }
    }

    /// The plan of an answer that is off the place while sets pass over it: against its own sets, else
    /// against the hard ones and as much of the domains as the motion is clear of. Of two, the one
    /// that breaks fewer rules, then the one that returns, then the first.
    fn off_station(&self, answer: &Attempt, arrival: &[Segment], until: f64) -> Option<Attempt> {
        let planner = self.scenario.planner;
        let best = |obstacles: &[Obstacle]| {
            let problem = self.problem(obstacles);
            let plans = planner.off_station(&problem, arrival, until).into_iter();
            let plans = plans.filter_map(|plan| {
                let motion = plan.trajectory.segments().to_vec();
                let broken = rules::breaks(self.scenario, &plan.trajectory);
                Some((broken, self.rested(&plan, &motion, until)?))
            });
            let best = plans.min_by_key(|(broken, plan)| (*broken, !plan.arrives()));
            best.map(|(_, plan)| plan)
        };
        // the search of the answer did not make this motion
        let other = |plan| Attempt {
            planned: Planned::of(Outcome::Solved(plan)),
            ..answer.clone()
        };
        if let Some(plan) = best(&answer.obstacles) {
            return Some(other(plan));
        }
        let level = RelaxationLevel::ReducedDomains.max(answer.level);
        let hard = self.against_hard_sets(answer.risk);
        let plan = best(&hard)?;
        let retained = self.retained_along(&plan.trajectory, answer.risk);
        let found = other(plan);
        Some(self.clear_of(&found, &retained, level))
    }

    /// The stay inside the sets that pass over the place; nothing is claimed of each before it has
    /// passed.
    fn staying_inside(&self, answer: Attempt, plan: Plan) -> Attempt {
        let hard: Vec<Obstacle> = self.sets.iter().map(|sets| sets.hard.clone()).collect();
        let is_up = || self.time_left().is_zero();
        let left = |set| entered::left_for_good(set, &plan.trajectory, is_up);
        Attempt {
            level: RelaxationLevel::Inside,
            released: hard.iter().map(left).collect(),
            reductions: self.given_up(&answer.reductions),
            obstacles: hard.clone(),
            whole: hard,
            risk: 0.0,
            ..with_plan(answer, plan)
        }
    }

    /// A plan with the rest at its end. Its cost is that of the motion before the first rest there,
    /// because the desired trajectory ends with the arrival.
    fn rested(&self, plan: &Plan, motion: &[Segment], until: f64) -> Option<Plan> {
        let mut motion: Vec<Segment> = motion.to_vec();
        let last = motion.last()?;
        let (pose, end) = (last.end(), last.end_time());
        if until > end {
            motion.push(Segment::straight(pose, end, until - end, 0.0));
        }
        let moves = |segment: &Segment| segment.duration > 0.0;
        if motion.iter().any(moves) {
            motion.retain(moves);
        }
        let cost = match plan.method {
            PlanMethod::OffStation => {
                let (desired, weight) = (&self.scenario.desired, self.scenario.time_weight);
                whole_space_time_error(desired, before_rest_at(desired.end(), &motion), weight)
            }
            _ => plan.cost,
        };
        Some(Plan {
            trajectory: Trajectory::new(motion).ok()?,
            cost,
            ..plan.clone()
        })
    }
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

/// An attempt with another plan; a deadline stays one.
fn with_plan(mut attempt: Attempt, plan: Plan) -> Attempt {
    attempt.planned.outcome = match attempt.planned.outcome {
        Outcome::Deadline(_) => Outcome::Deadline(Some(plan)),
        _ => Outcome::Solved(plan),
    };
    attempt
}
