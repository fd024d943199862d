//! One cycle of planning: the scenario as it is estimated, with what the last plan leaves to it.

use super::Simulation;
use crate::colregs::SteadyShip;
use crate::document::{
    Alarm, EstimateDocument, PlanDocument, PositionDocument, ReplanDocument, finite, relaxation,
};
use crate::frame::{Pose, Vector, clockwise_deg, course_deg_from_heading, deg_from_radians, wrap};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::pipeline::{self, RelaxationLevel, Run};
use crate::planner::optimal_control::node;
use crate::planner::{Plan, WarmStart};
use crate::replanning::remember;
use crate::scenario::{Memory, Scenario};
use crate::target::{Motion, ShipTrack, Uncertainty};
use crate::text::tenths;
use crate::tolerance::{self, TOUCH_M};
use crate::trajectory::DesiredTrajectory;
use crate::vessel::ForceVector;

/// m/s and metres: rounding of a target's state.
const ROUNDING: f64 = 1e-6;

/// Metres that remain at the least of the desired trajectory under forces: the shortest leg. A ship
/// of a metre has to lie at its end, not a metre before it.
const LAST_STRETCH_M: f64 = 1e-3;

/// Share of the horizon within which own ship is due at an intermediate end, where a plan ends before
/// the last waypoint. The rest is time to give way.
pub(super) const DUE_SHARE: f64 = 0.85;

/// Time between two intermediate ends, as a share of the horizon. For that long plans have the same
/// end, so one can go on from the other.
const STEP_SHARE: f64 = 0.3;

/// Time to an intermediate end, as a share of the horizon, below which it is too near to plan to.
const LEAST_SHARE: f64 = 0.25;

/// Share of the weight of time with which the nearest place of a mission is sought.
const NEAREST_TIME: f64 = 0.01;

pub(super) struct Cycle {
    pub run: Run,
    /// That of the plan, if there is one: the independent check reads it.
    pub document: Option<PlanDocument>,
    pub replan: ReplanDocument,
    /// m²; `None` without a plan.
    pub cost: Option<f64>,
    /// True for a plan that took longer than its delay: own ship keeps the plan before.
    pub is_late: bool,
    /// Metres of the mission after the end of the plan, which may be before the intermediate end.
    pub left_out: f64,
}

impl Simulation {
    /// Plans for `delay` seconds from now on, from where the present plan has own ship then.
    pub(super) fn plan(&mut self, delay: f64, reason: String) -> Cycle {
        let start = self.time + delay;
        let off_plan_m = self.off_plan();
        let mut scenario = self.scenario_of_known_targets();
        let mut estimates = Vec::with_capacity(scenario.targets.len());
        let known = self.targets.iter_mut().filter(|target| target.is_known());
        for (target, simulated) in scenario.targets.iter_mut().zip(known) {
            let ship = simulated
                .track
                .set_at(start, self.scenario.simulation.delay);
            let age_s = self.time - simulated.track.estimate().time;
            estimates.push(EstimateDocument {
                target: simulated.name.clone(),
                age_s,
                stale: simulated.is_stale,
                true_position: PositionDocument::of(simulated.truth.now.pose.position),
                position: PositionDocument::of(ship.pose.position),
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
            scenario.stay = scenario.stay.map(|until| (until - start).max(0.0));
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
        } else if let Some(previous) = &self.active.previous {
            // the last plan is own ship's, so only a ship far off it is refused
            if remember(previous, &mut scenario).is_err() {
                let reason = format!("{} m", tenths(off_plan_m));
                self.alarm(Alarm::FarOff, None, Some(reason));
            }
            let known = self.targets.iter().filter(|target| target.is_known());
            for (target, simulated) in scenario.targets.iter_mut().zip(known) {
                let Motion::Ship(ship) = &mut target.motion else {
                    continue;
                };
                if simulated.track.is_broken() {
                    // nothing of the last set is known to hold
                    (ship.kept_positions, ship.kept_velocities) = (None, None);
                    if !scenario.memory.is_outside(&target.name) {
                        scenario.memory.outside_velocities.push(target.name.clone());
                    }
                } else if simulated.track.has_begun_anew() {
                    ship.kept_velocities = None;
                }
            }
        }
        let (run, left_out_m) = self.run(&scenario);
        let plan = run.planned.outcome.plan();
        let took = run.plan_time.as_secs_f64();
        let is_late = plan.is_some() && self.measured_delay && start > 0.0 && took > delay;
        let cost = plan.and_then(|plan| {
            // the stage cost of forces has another unit
            let evaluation = run.evaluation.as_ref().filter(|_| forced.is_some());
            finite(evaluation.map_or(plan.cost, |e| e.space_time_error))
        });
        let mut document = plan.map(|_| PlanDocument::of(&run));
        if let Some(document) = &mut document {
            document.mission.left_out_m = left_out_m;
        }
        let replan = ReplanDocument {
            t_s: self.time,
            start_t_s: start,
            end_s: plan.map(|plan| start + plan.trajectory.end_time()),
            reason,
            verdict: (document.as_ref()).map_or_else(|| run.word(), |plan| plan.verdict.clone()),
            safe: document.as_ref().is_some_and(PlanDocument::is_safe),
            followed: plan.is_some() && !is_late,
            keeps_plan: run.planned.is_remainder(),
            left_out_m,
            cost_m2: cost,
            relaxations: run.relaxations.iter().map(|r| relaxation(r).kind).collect(),
            turn_deg: (run.planned.manoeuvres.first()).map(|m| clockwise_deg(m.turn)),
            off_plan_m,
            outside_velocities: run.scenario.memory.outside_velocities.clone(),
            outside_places: run.scenario.memory.outside_places.clone(),
            estimates,
        };
        let to_go = plan.map_or(0.0, |plan| plan.to_go);
        Cycle {
            run,
            document,
            replan,
            cost,
            is_late,
            left_out: left_out_m + to_go,
        }
    }

    /// The scenario without the targets that own ship has not seen.
    pub(super) fn scenario_of_known_targets(&self) -> Scenario {
        let mut scenario = self.scenario.clone();
        let targets = self.targets.iter().enumerate().rev();
        for (index, _) in targets.filter(|(_, target)| !target.is_known()) {
            scenario.targets.remove(index);
            // one per target in the same order, or none at all
            if index < scenario.memory.targets.len() {
                scenario.memory.targets.remove(index);
            }
        }
        scenario
    }

    /// Plans to where own ship is due within the horizon, or to the end of the present plan if that is
    /// farther along the mission. Where that plan gives something up, the end of the present plan is
    /// tried as well; where it takes a risk or does not get there, a place one step nearer. A nearer
    /// plan must not end soon. Returns the metres of the mission after the place, too.
    fn run(&self, scenario: &Scenario) -> (Run, f64) {
        if super::is_under_forces(scenario) {
            return (pipeline::run(scenario.clone()), 0.0);
        }
        let step = self.step_between_ends();
        let own_pace = self.at_own_pace(scenario);
        let due_now = Some(&scenario.desired).filter(|mission| !is_behind_land(scenario, mission));
        let mut missions = [due_now, own_pace.as_ref()].into_iter().flatten();
        let due = missions.find_map(|mission| Some((mission, cut_due(scenario, mission, step)?)));
        let (mission, due) = due.unwrap_or((&scenario.desired, 0.0));
        let plan_without = |cut: f64, deadline: f64| {
            let desired = match cut > 0.0 {
                true => mission.shortened(cut)?,
                false => mission.clone(),
            };
            let mut scenario = scenario.clone();
            (scenario.desired, scenario.deadline) = (desired, deadline);
            // own ship stays at the last waypoint alone
            scenario.stay = scenario.stay.filter(|_| cut == 0.0);
            Some(pipeline::run(scenario))
        };
        let present = self.active.left_out;
        let mut cut = due.min(present);
        let Some(mut best) = plan_without(cut, scenario.deadline) else {
            return (pipeline::run(scenario.clone()), 0.0);
        };
        let gives_up = |run: &Run| match run.planned.outcome.plan() {
            Some(plan) if plan.arrives() => (false, run.level),
            plan => (plan.is_none(), run.level.max(RelaxationLevel::Waiting)),
        };
        let soon = self.settings().replan + super::BEFORE_END_S;
        let soon = soon.max(LEAST_SHARE * scenario.horizon);
        // a whole mission is not cut for the sake of its end
        let nearer = if due > 0.0 { due + step } else { 0.0 };
        for (another, unless) in [
            (due.max(present), RelaxationLevel::Compliant),
            (nearer, RelaxationLevel::ReducedDomains),
        ] {
            let time_left = scenario.deadline - best.plan_time.as_secs_f64();
            let is_asked = another > cut && gives_up(&best) > (false, unless) && time_left > 0.0;
            let Some(mut run) = is_asked.then(|| plan_without(another, time_left)).flatten() else {
                continue;
            };
            let plan_time = best.plan_time + run.plan_time;
            let has_plan = best.planned.outcome.plan().is_some();
            let lasts = |plan: &Plan| plan.trajectory.end_time() > soon;
            let lasts = run.planned.outcome.plan().is_some_and(lasts);
            if gives_up(&run) < gives_up(&best) && (lasts || !has_plan) {
                std::mem::swap(&mut best, &mut run);
                cut = another;
            }
            best.plan_time = plan_time;
        }
        (best, cut)
    }

    /// Metres between two intermediate ends.
    fn step_between_ends(&self) -> f64 {
        let mission = &self.scenario.desired;
        STEP_SHARE * self.scenario.horizon * mission.length() / mission.duration()
    }

    /// The mission from the place nearest to own ship on, as fast as own ship can; straight to that
    /// place where it is far off. Of places at equal distances it is the one whose time is nearer.
    fn at_own_pace(&self, scenario: &Scenario) -> Option<DesiredTrajectory> {
        let (mission, own) = (&self.scenario.desired, &scenario.own_ship);
        let time = scenario.time - self.scenario.time;
        let nearest = mission.nearest(own.pose.position, time, NEAREST_TIME * scenario.time_weight);
        let leg = mission.legs().get(nearest.leg)?;
        let time = leg.start_time + (nearest.distance - leg.start_distance) / leg.speed;
        let left = mission.remaining(time);
        let mut waypoints = left.waypoints();
        if (waypoints[0] - own.pose.position).norm() > 2.0 * own.turning_radius {
            waypoints.insert(0, own.pose.position);
        }
        let speeds = vec![own.max_speed(); waypoints.len() - 1];
        DesiredTrajectory::new(&waypoints, &speeds).ok()
    }
}

/// True where the straight way from own ship to the beginning of a mission leads over land: after a
/// wait own ship is so late that it has another leg to sail.
fn is_behind_land(scenario: &Scenario, mission: &DesiredTrajectory) -> bool {
    let own = &scenario.own_ship;
    let way = [own.pose.position, mission.position_at(0.0)];
    let land = scenario.land.as_ref();
    land.is_some_and(|land| !land.crossings(&own.hull, &way).is_empty())
}

/// Metres to leave out at the end of a mission, so that own ship is due at the rest's end within
/// [`DUE_SHARE`] of the horizon: a multiple of `step`, or as little as possible where the place would
/// be too near. `None` where every place is.
fn cut_due(scenario: &Scenario, mission: &DesiredTrajectory, step: f64) -> Option<f64> {
    let (own, horizon) = (&scenario.own_ship, scenario.horizon);
    let fastest = own.max_speed();
    let off = (mission.position_at(0.0) - own.pose.position).norm();
    let mut time = DUE_SHARE * horizon - off / fastest;
    let mut left = mission.length();
    for leg in mission.legs() {
        let speed = leg.speed.min(fastest);
        let sailed = (time * speed).clamp(0.0, leg.length);
        (time, left) = (time - leg.length / speed, left - sailed);
    }
    // less is a rounding
    if !(left > tolerance::ARRIVAL_M) {
        return Some(0.0);
    }
    let is_far = |short: &DesiredTrajectory| short.duration() >= LEAST_SHARE * horizon;
    let without = |cut: f64| Some((cut, mission.shortened(cut).filter(is_far)?));
    let (cut, short) = without((left / step).ceil() * step).or_else(|| without(left))?;
    // a last leg that is too short to turn onto
    let last = short.legs().last().map_or(0.0, |leg| leg.length);
    let is_short = last < 2.0 * own.turning_radius;
    match short.shortened(last).filter(is_far) {
        Some(_) if is_short => Some(cut + last),
        _ => Some(cut),
    }
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
    hard.any(|set| set.is_entered(remainder, TOUCH_M))
}

/// True where the positions and the velocities that a plan assumes at its start hold the truth.
pub(super) fn holds(assumed: &ShipTrack, truth: &SteadyShip) -> bool {
    let off = truth.pose.position - assumed.pose.position;
    let velocities = assumed.outer_velocity_set();
    assumed.outer_positions().signed_distance(off) <= ROUNDING
        && velocities.signed_distance(truth.velocity()) <= ROUNDING
}
