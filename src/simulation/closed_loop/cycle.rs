//! One cycle of planning: the scenario as it is estimated, with what the last plan leaves to it.

use super::Simulation;
use crate::colregs::SteadyShip;
use crate::document::{EstimateDocument, ReplanDocument, finite, position, relaxation};
use crate::frame::{Pose, Vector, clockwise_deg, course_deg_from_heading, deg_from_radians, wrap};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::pipeline::{self, RelaxationLevel, Run};
use crate::planner::WarmStart;
use crate::planner::optimal_control::node;
use crate::replanning::remember;
use crate::scenario::{Memory, Scenario};
use crate::target::{Motion, ShipTrack, Uncertainty};
use crate::tolerance::{self, TOUCH_M};
use crate::trajectory::DesiredTrajectory;
use crate::vessel::ForceVector;

/// m/s and metres: rounding of a target's state.
const ROUNDING: f64 = 1e-6;

/// Metres that remain at the least of the desired trajectory under forces: the shortest leg. A ship
/// of a metre has to lie at its end, not a metre before it.
const LAST_STRETCH_M: f64 = 1e-3;

/// Share of the horizon within which own ship is due where a plan ends. The rest is time to give
/// way.
const DUE_SHARE: f64 = 0.85;

/// Time between two places where plans may end, as a share of the horizon. Plans end at the same
/// place for that long, so one can go on from the other.
const STEP_SHARE: f64 = 0.3;

pub(super) struct Cycle {
    pub run: Run,
    pub replan: ReplanDocument,
    /// Metres of the mission beyond the end of the plan.
    pub beyond: f64,
}

impl Simulation {
    /// Plans for `delay` seconds from now on, from where the present plan has own ship then.
    pub(super) fn plan(&mut self, delay: f64, reason: String) -> Cycle {
        let start = self.time + delay;
        let off_plan_m = self.off_plan();
        let mut scenario = self.scenario.clone();
        let mut estimates = Vec::with_capacity(self.targets.len());
        for (target, simulated) in scenario.targets.iter_mut().zip(&mut self.targets) {
            let ship = simulated
                .track
                .set_at(start, self.scenario.simulation.delay);
            let age_s = self.time - simulated.track.estimate().time;
            estimates.push(EstimateDocument {
                target: simulated.name.clone(),
                age_s,
                stale: simulated.is_stale,
                true_position: position(simulated.truth.now.pose.position),
                position: position(ship.pose.position),
                course_deg: course_deg_from_heading(ship.pose.heading),
                speed_mps: ship.speed,
                length_m: ship.hull.length,
                beam_m: ship.hull.beam,
                position_std_m: ship.position_std,
                speed_spread_mps: ship.speed_spread,
                course_spread_deg: deg_from_radians(ship.course_spread),
                starboard_turn_deg: deg_from_radians(ship.starboard_turn),
            });
            target.motion = match &simulated.set {
                None => Motion::Ship(ship),
                Some(sets) => Motion::Sets(seen(sets, simulated.truth.now.pose.position, delay)),
            };
        }
        let in_plan = self.time - self.active.start;
        let forced = (self.own).forced_state(&self.active.trajectory, in_plan, delay);
        if start > 0.0 {
            scenario.time += start;
            scenario.own_ship.pose = self.pose_at(start);
            scenario.memory = Memory::default();
            scenario.desired = match forced {
                None => self.scenario.desired.remaining(start),
                Some(_) => self
                    .scenario
                    .desired
                    .remaining_stretch(start, LAST_STRETCH_M),
            };
        }
        if let (Some(state), Some(plan)) = (forced, self.active.trajectory.steered())
            && start > 0.0
        {
            let own = node(0.0, &state, &ForceVector::zeros());
            scenario.own_ship.pose = own.pose;
            scenario.own_ship.speed = own.velocity.norm();
            let plan = plan.after(start - self.active.start);
            scenario.memory.warm_start = Some(WarmStart { state, plan });
        } else if let Some(previous) = &self.active.document {
            // the last plan is own ship's, so only a ship far off it is refused
            if remember(previous, &mut scenario).is_err() {
                self.alarm("far off the plan", None);
            }
            for (target, simulated) in scenario.targets.iter_mut().zip(&self.targets) {
                if let (Motion::Ship(ship), true) =
                    (&mut target.motion, simulated.track.is_broken())
                {
                    // nothing of the last set is known to hold
                    (ship.kept_positions, ship.kept_velocities) = (None, None);
                    if !scenario.memory.is_outside(&target.name) {
                        scenario.memory.outside_velocities.push(target.name.clone());
                    }
                }
            }
        }
        let (run, beyond) = self.run(&scenario);
        let late = self.measured_delay && start > 0.0 && run.plan_time.as_secs_f64() > delay;
        let plan = run.planned.outcome.plan();
        let replan = ReplanDocument {
            t_s: self.time,
            start_t_s: start,
            reason,
            verdict: run.word(),
            safe: run.safe(),
            followed: plan.is_some() && !late,
            keeps_plan: run.planned.is_remainder,
            cost_m2: plan.and_then(|plan| {
                // the stage cost of forces has another unit
                let evaluation = run.evaluation.as_ref().filter(|_| forced.is_some());
                finite(evaluation.map_or(plan.cost, |e| e.space_time_error))
            }),
            relaxations: run.relaxations.iter().map(|r| relaxation(r).kind).collect(),
            turn_deg: (run.planned.manoeuvres.first()).map(|m| clockwise_deg(m.turn)),
            off_plan_m,
            outside_velocities: run.scenario.memory.outside_velocities.clone(),
            outside_places: run.scenario.memory.outside_places.clone(),
            estimates,
        };
        Cycle {
            run,
            replan,
            beyond,
        }
    }

    /// Plans a mission up to where own ship is due in time, or farther if the present plan ends there,
    /// and returns the metres beyond. Where this plan gives something up, nearer places are tried as
    /// well, of which the next plan would not come too late.
    fn run(&self, scenario: &Scenario) -> (Run, f64) {
        let run_to = |beyond: f64| {
            let mut scenario = scenario.clone();
            scenario.desired = up_to(&scenario, beyond)?;
            Some((pipeline::run(scenario), beyond))
        };
        if super::is_under_forces(scenario) {
            return (pipeline::run(scenario.clone()), 0.0);
        }
        let slowest = self.scenario.desired.legs().iter().map(|leg| leg.speed);
        let slowest = slowest.fold(f64::INFINITY, f64::min);
        let step = STEP_SHARE * scenario.horizon * slowest;
        let due = (beyond(scenario) / step).ceil() * step;
        let present = self.active.beyond;
        let Some((mut best, mut at)) = run_to(due.min(present)) else {
            return (pipeline::run(scenario.clone()), 0.0);
        };
        let end = |run: &Run| {
            let plan = run.planned.outcome.plan()?;
            Some(plan.trajectory.end_time())
        };
        let gives_up = |run: &Run| (end(run).is_none(), run.level);
        let next = self.settings().replan + super::BEFORE_END_S;
        let nearest = if due > 0.0 { due + step } else { 0.0 };
        for beyond in [due.max(present), nearest] {
            if gives_up(&best) == (false, RelaxationLevel::Compliant) {
                break;
            }
            let nearer = (beyond > at).then(|| run_to(beyond));
            let Some((mut run, beyond)) = nearer.flatten() else {
                continue;
            };
            let in_time = end(&best).is_none() || end(&run) > Some(next);
            let plan_time = best.plan_time + run.plan_time;
            if gives_up(&run) < gives_up(&best) && in_time {
                std::mem::swap(&mut best, &mut run);
                at = beyond;
            }
            best.plan_time = plan_time;
        }
        (best, at)
    }
}

/// Metres at the end of a mission that own ship is not due to sail within [`DUE_SHARE`] of the
/// horizon.
fn beyond(scenario: &Scenario) -> f64 {
    let (own, legs) = (&scenario.own_ship, scenario.desired.legs());
    let fastest = own.max_speed();
    let off = (scenario.desired.position_at(0.0) - own.pose.position).norm();
    let mut time = DUE_SHARE * scenario.horizon - off / fastest;
    let mut left = scenario.desired.length();
    for leg in legs {
        let speed = leg.speed.min(fastest);
        let sailed = (time * speed).clamp(0.0, leg.length);
        (time, left) = (time - leg.length / speed, left - sailed);
    }
    // a rounding is no way
    match left > tolerance::ARRIVAL_M {
        true => left,
        false => 0.0,
    }
}

/// The mission without its last metres, and without a last leg that is too short for own ship to turn
/// onto; `None` where nothing is left.
fn up_to(scenario: &Scenario, beyond: f64) -> Option<DesiredTrajectory> {
    let desired = &scenario.desired;
    if beyond == 0.0 {
        return Some(desired.clone());
    }
    let short = desired.shortened(beyond)?;
    let last = short.legs().last()?.length;
    let is_short = last < 2.0 * scenario.own_ship.turning_radius;
    let at_waypoint = is_short.then(|| short.shortened(last)).flatten();
    Some(at_waypoint.unwrap_or(short))
}

impl Simulation {
    /// Own ship at a later time, if it stays off its plan as it is now.
    fn pose_at(&self, time: f64) -> Pose {
        let plan = &self.active;
        let [now, then] = [self.time, time].map(|t| plan.trajectory.pose_at(t - plan.start));
        // the course over ground: in a current the heading is another
        let own = self
            .own
            .steady(&plan.trajectory, self.time - plan.start)
            .pose;
        let off = now.body_coordinates(own.position);
        Pose::new(
            then.world_coordinates(off),
            then.heading + wrap(own.heading - now.heading),
        )
    }
}

/// Explicit sets whose centre is seen now, `delay` seconds later.
fn seen(sets: &Uncertainty, center: Vector, delay: f64) -> Uncertainty {
    let now = Uncertainty {
        initial: sets.initial.translated(center - sets.initial.center()),
        ..sets.clone()
    };
    match Obstacle::new("", now.clone()) {
        Ok(obstacle) => obstacle.remaining_sets(delay),
        Err(_) => now,
    }
}

/// True where the remainder of the last plan enters a hard set of the present.
pub(super) fn remainder_is_lost(run: &Run) -> bool {
    let remainder = &run.scenario.memory.remainder;
    let mut hard = run.targets.iter().map(|target| &target.sets.hard);
    hard.any(|set| {
        let enters = |s| set.first_contact(s, TOUCH_M).is_some();
        remainder.iter().any(enters)
    })
}

/// True where the positions and the velocities that a plan assumes at its start hold the truth.
pub(super) fn holds(assumed: &ShipTrack, truth: &SteadyShip) -> bool {
    let off = truth.pose.position - assumed.pose.position;
    let velocities = assumed.outer_velocity_set();
    assumed.outer_positions().signed_distance(off) <= ROUNDING
        && velocities.signed_distance(truth.velocity()) <= ROUNDING
}
