//! The closed loop: current, sensors, tracker, plan, guidance and vessel, step by step.

mod behaviour;
mod commanded;
mod contact;
mod cycle;
mod forces;
mod guidance;
mod mutual;
mod own;
mod record;
mod sensor;
mod stream;
mod tracker;
mod vessel;

pub use commanded::Command;

use std::sync::OnceLock;

use behaviour::TrueTarget;
use contact::{Clearance, Shape};
use cycle::Cycle;
use mutual::MutualTarget;
use own::Own;
use sensor::TargetSensor;
use tracker::Track;

use crate::colregs::SteadyShip;
use crate::document::{Alarm, AlarmDocument, PlanDocument, ReplanDocument};
use crate::frame::{Pose, Vector, heading_of};
use crate::geometry::ConvexPolygon;
use crate::obstacle::LandObstacle;
use crate::pipeline::Relaxation;
use crate::planner::{Minimises, NoPlan, Outcome, Plan};
use crate::replanning::PreviousPlan;
use crate::scenario::{
    Behaviour, Fault, NotReported, Scenario, Sensor, SensorKind, SimulationSettings, VesselModel,
};
use crate::target::{Motion, ShipTrack, Uncertainty};
use crate::text::{rounded, tenths};
use crate::tolerance::ELLIPSE_SIDES;
use crate::trajectory::{GroundSegment, Trajectory};
use crate::vessel::Hull;

/// Seconds: times nearer than this are one.
const INSTANT: f64 = 1e-9;

/// A step ends at the next event; one shorter than this fraction of it is joined to the one before.
const SHORT_STEP: f64 = 1e-6;

/// Seconds before the end of a plan that ends short at which another one takes effect at the latest.
const BEFORE_END_S: f64 = ReplanDocument::BEFORE_END_S;

/// m/s. Added to the distance from a contact per second ahead.
const CLOSING_SPEED: f64 = 1.0;

/// Seconds after which the growth of a random walk counts.
const DIFFUSION_TIME: f64 = 5.0;

/// Spacing of samples as a fraction of the time ahead.
const SAMPLE_RATIO: f64 = 0.03;

/// A scenario that is sailed: own ship plans repeatedly and follows its plans, while targets move by their
/// behaviour models.
///
/// Within a step the order is: the current changes, the sensors report, the tracker takes in what
/// arrives, a plan is made or becomes valid, own ship steers, and all ships move. A plan is made
/// from the data of its time, and own ship follows it from `delay` seconds later on. It begins
/// where the last plan has own ship then. Contacts with hulls and land are tested in continuous
/// time.
///
/// Equal scenarios give equal motions, unless the delay is measured.
///
/// ```
/// use searoom::scenario::Scenario;
/// use searoom::simulation::Simulation;
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// let mut simulation = Simulation::new(scenario, false).expect("a scenario for the closed loop");
/// while !simulation.finished() {
///     simulation.step();
/// }
/// let sailed = simulation.record();
/// assert!(sailed.safe && sailed.arrived && sailed.targets[0].least_clearance_m > Some(20.0));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Simulation {
    scenario: Scenario,
    measured_delay: bool,
    /// Seconds since the scenario's time.
    time: f64,
    duration: f64,
    /// When the last plan ends, where it ends at own ship; infinite otherwise.
    stop_time: f64,
    own: Own,
    targets: Vec<Simulated>,
    /// The plan that own ship follows.
    active: Active,
    pending: Option<Active>,
    next_cycle: f64,
    sailed: Vec<GroundSegment>,
    /// True while own ship is beyond its tracking margin.
    is_beyond: bool,
    /// True while the current is faster than own ship.
    is_overpowered: bool,
    /// Why the clock cut a plan, until it is reported.
    out_of_time: Option<String>,
    conduct: Conduct,
    /// The documents so far, which the loop writes and never reads.
    replans: Vec<ReplanDocument>,
    alarms: Vec<AlarmDocument>,
    plan_seconds: Vec<f64>,
    /// Those of the plans that were followed; `None` where they are not kept.
    plans: Option<Vec<PlanDocument>>,
    /// All land of the map, where commands are tested against it.
    around_land: OnceLock<LandObstacle>,
}

/// Own ship's conduct so far.
#[derive(Debug, Clone, Default)]
struct Conduct {
    /// m²; `None` where the first plan ends before the last waypoint.
    first_plan_cost: Option<f64>,
    /// Plans that begin another manoeuvre before the one under way is finished.
    replaced_manoeuvres: usize,
    /// Those of them that turn to the other side.
    side_switches: usize,
    /// Plans at whose time the remainder of the last plan entered a hard set.
    lost_remainders: usize,
    without_plan: usize,
    unsafe_plans: usize,
    late_plans: usize,
    /// Metres, and when, seconds.
    largest_off_plan: (f64, f64),
}

/// One target: its true motion, its reports and its track.
#[derive(Debug, Clone)]
struct Simulated {
    name: String,
    /// An explicit set. Its centre moves with the middle of its velocities.
    set: Option<Uncertainty>,
    truth: TrueTarget,
    sensor: TargetSensor,
    track: Track,
    /// Who steers a target that plans as own ship does.
    mutual: Option<MutualTarget>,
    clearance: Clearance,
    states: Vec<(f64, SteadyShip)>,
    outside_sets: usize,
    /// Seconds from which own ship can see it.
    seen_from: f64,
    /// When own ship saw it first, seconds from the start; `None` for one that no plan knows of.
    known_from: Option<f64>,
    is_stale: bool,
    /// True where it was reported for the first time, or again after it was stale, since the last
    /// plan.
    is_acquired: bool,
}

/// A plan that own ship follows from some time on.
#[derive(Debug, Clone)]
struct Active {
    start: f64,
    trajectory: Trajectory,
    /// What the next plan goes on from; `None` where own ship holds course and speed without a plan,
    /// and under forces.
    previous: Option<PreviousPlan>,
    /// Metres of the mission after the end of the plan; infinite without a plan.
    left_out: f64,
    /// The targets that the plan assumes at its start, in the scenario's order; `None` for explicit
    /// sets, and for those that own ship does not know of.
    assumed: Vec<Option<ShipTrack>>,
}

impl Active {
    fn end(&self) -> f64 {
        self.start + self.trajectory.end_time()
    }

    /// True for a plan that ends before the last waypoint, and before the horizon.
    fn ends_short(&self) -> bool {
        let ends = |plan: &PreviousPlan| self.trajectory.end_time() < plan.horizon - INSTANT;
        self.left_out > 0.0 && self.previous.as_ref().is_some_and(ends)
    }
}

impl Simulation {
    /// Settles the tracker on the reports before t = 0 and makes the first plan, which is valid at
    /// once. With `measured_delay` a plan that takes longer than the delay comes too late.
    ///
    /// The error holds every reason why the loop cannot sail the scenario.
    pub fn new(scenario: Scenario, measured_delay: bool) -> Result<Self, Vec<Fault>> {
        Self::begun(scenario, measured_delay)?.with_first_plan()
    }

    /// [`Self::new`], and keeps the document of every plan that is followed, for [`Self::plans`].
    pub fn keeping_plans(scenario: Scenario, measured_delay: bool) -> Result<Self, Vec<Fault>> {
        let mut simulation = Self::begun(scenario, measured_delay)?;
        simulation.plans = Some(Vec::new());
        simulation.with_first_plan()
    }

    fn with_first_plan(mut self) -> Result<Self, Vec<Fault>> {
        self.observe();
        let none = self.cycle(0.0, ReplanDocument::START.to_owned());
        if let Some(why @ NoPlan::HorizonTooShort { horizon, .. }) = none {
            let allowed = format!("a longer one: {why}");
            return Err(vec![Fault::new("horizon_s", rounded(horizon), &allowed)]);
        }
        self.activate();
        Ok(self)
    }

    /// Before the first plan: own ship holds course and speed.
    fn begun(scenario: Scenario, measured_delay: bool) -> Result<Self, Vec<Fault>> {
        let settings = &scenario.simulation;
        let duration = duration(&scenario);
        let faults = faults(&scenario, duration);
        if !faults.is_empty() {
            return Err(faults);
        }
        let mut mutual_targets = mutual::mutual_targets(&scenario)?.into_iter();
        let behaviours = settings.behaviours.iter().cloned();
        let behaviours = behaviours.chain(std::iter::repeat(Behaviour::Constant));
        let not_reported = settings.not_reported.iter().copied();
        let not_reported = not_reported.chain(std::iter::repeat(NotReported::default()));
        let seen_from = settings
            .seen_from
            .iter()
            .copied()
            .chain(std::iter::repeat(0.0));
        let ships = scenario.targets.iter().zip(behaviours).zip(not_reported);
        let own = SteadyShip::new(scenario.own_ship.pose, scenario.own_ship.speed);
        let targets =
            ships
                .zip(seen_from)
                .map(|(((target, behaviour), not_reported), seen_from)| {
                    let (ship, set) = match &target.motion {
                        Motion::Ship(ship) => (ship, None),
                        Motion::Sets(sets) => (&middle_of(sets), Some(sets)),
                    };
                    let shapes = match set {
                        None => (scenario.own_ship.hull, Shape::Hull(ship.hull)),
                        Some(sets) => (Hull::new(0.0, 0.0), Shape::Set(outline(sets))),
                    };
                    let assumed = ShipTrack {
                        hull: not_reported.outer_hull(ship.hull, settings.sensor.default_hull),
                        ..ship.clone()
                    };
                    let seed = settings.seed;
                    let mut simulated = Simulated {
                        name: target.name.clone(),
                        set: set.cloned(),
                        truth: TrueTarget::new(&target.name, ship, behaviour, seed),
                        mutual: mutual_targets.next().flatten(),
                        sensor: TargetSensor::new(&settings.sensor, &target.name, seed),
                        track: Track::new(&assumed, &settings.sensor),
                        clearance: Clearance::new(shapes.0, shapes.1),
                        states: Vec::new(),
                        outside_sets: 0,
                        seen_from,
                        known_from: None,
                        is_stale: false,
                        is_acquired: false,
                    };
                    let steps = (settings.sensor.settle / settings.step).ceil() as usize;
                    let measured = settings.sensor.kind != SensorKind::Exact;
                    for step in (1..=steps).rev().filter(|_| measured) {
                        let time = -(step as f64) * settings.step;
                        let there = SteadyShip::on_track(ship, time);
                        simulated.observe(time, &there, &own.moved(time), &settings.sensor);
                    }
                    simulated.track.assume_anew();
                    simulated
                });
        let own = Own::new(&scenario);
        Ok(Self {
            targets: targets.collect(),
            active: Active {
                start: 0.0,
                trajectory: own.held(&scenario, duration),
                previous: None,
                left_out: f64::INFINITY,
                assumed: Vec::new(),
            },
            own,
            measured_delay,
            time: 0.0,
            duration,
            stop_time: f64::INFINITY,
            pending: None,
            next_cycle: scenario.simulation.replan,
            sailed: Vec::new(),
            is_beyond: false,
            is_overpowered: false,
            out_of_time: None,
            conduct: Conduct::default(),
            replans: Vec::new(),
            alarms: Vec::new(),
            plan_seconds: Vec::new(),
            plans: None,
            around_land: OnceLock::new(),
            scenario,
        })
    }

    /// Every reason why a scenario cannot be sailed, as [`Self::new`] returns them.
    pub(crate) fn unfit(scenario: &Scenario) -> Vec<Fault> {
        faults(scenario, duration(scenario))
    }

    /// True where the mission is too long for the horizon, so that plans lead to intermediate ends.
    pub fn sails_in_parts(scenario: &Scenario) -> bool {
        scenario.desired.duration() > cycle::DUE_SHARE * scenario.horizon
            && !is_under_forces(scenario)
    }

    /// The documents of the plans that were followed; empty without [`Self::keeping_plans`].
    pub fn plans(&self) -> &[PlanDocument] {
        self.plans.as_deref().unwrap_or_default()
    }

    fn settings(&self) -> &SimulationSettings {
        &self.scenario.simulation
    }

    /// Seconds since the scenario's time.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Own ship now.
    pub fn own(&self) -> SteadyShip {
        let plan = &self.active;
        self.own.steady(&plan.trajectory, self.time - plan.start)
    }

    /// The name and the true state of every target now.
    pub fn targets(&self) -> impl Iterator<Item = (&str, SteadyShip)> {
        self.targets
            .iter()
            .map(|target| (target.name.as_str(), target.truth.now))
    }

    /// Draws anew all that is random from now on. What was drawn before stays: places, sizes,
    /// whether a target gives way, the present part of a current, reports that are under way.
    pub(crate) fn reseed(&mut self, seed: u64) {
        self.own.reseed(seed);
        for target in &mut self.targets {
            target.truth.reseed(&target.name, seed);
            target.sensor.reseed(&target.name, seed);
            if let Some(mutual) = &mut target.mutual {
                mutual.reseed(seed);
            }
        }
    }

    /// Level function for splitting, metres: zero if and only if hulls have met.
    ///
    /// The least of `(d + CLOSING_SPEED t) / sqrt(1 + t / DIFFUSION_TIME)` over the times `t` from now
    /// to the end.
    /// Here `d` is the distance of the hulls at `t`, if own ship keeps to its plan and the target moves
    /// as it is expected to. The root is the growth of a random walk: what is far now can still meet
    /// later. Sampled; O(log duration) for each target.
    pub(crate) fn distance_from_contact(&self) -> f64 {
        if self.targets.iter().any(|t| t.clearance.is_contact()) {
            return 0.0;
        }
        let (plan, hull) = (&self.active, self.scenario.own_ship.hull);
        let in_plan = self.time - plan.start;
        let now = self.own.pose(&plan.trajectory, in_plan);
        let planned = plan.trajectory.pose_at(in_plan);
        let left = plan.end().min(self.duration).min(self.stop_time) - self.time;
        let far = |apart: f64, ahead: f64| {
            (apart + CLOSING_SPEED * ahead) / (1.0 + ahead / DIFFUSION_TIME).sqrt()
        };
        let mut least = f64::INFINITY;
        for target in &self.targets {
            let reach = hull.half_diagonal() + target.truth.hull.half_diagonal();
            let mut ahead = 0.0;
            while ahead <= left && far(0.0, ahead) < least {
                let mut own = plan.trajectory.pose_at(in_plan + ahead);
                own.position += now.position - planned.position;
                let pose = target.truth.expected(self.time, ahead).pose;
                // centres are farther apart than hulls
                let bound = (pose.position - own.position).norm() - reach;
                if far(bound, ahead) < least {
                    let hulls = [hull.polygon(&own), target.truth.hull.polygon(&pose)];
                    let apart = hulls[0].separation(&hulls[1]).max(0.0);
                    least = least.min(far(apart, ahead));
                }
                ahead += self.settings().step.max(ahead * SAMPLE_RATIO);
            }
        }
        least.max(f64::MIN_POSITIVE)
    }

    /// True at the end of the plan that own ship follows, and at the end of the simulation.
    pub fn finished(&self) -> bool {
        let end = self.active.end().min(self.duration).min(self.stop_time);
        // negated so that a NaN ends the simulation
        !(self.time < end - INSTANT)
    }

    /// Moves all ships on to the next step or event. Without effect once finished.
    pub fn step(&mut self) {
        if self.finished() {
            return;
        }
        self.observe_and_plan();
        // the new plan may end where own ship is
        if self.finished() {
            return;
        }
        let events = [
            self.pending
                .as_ref()
                .map_or(f64::INFINITY, |plan| plan.start),
            self.next_cycle,
            self.active.end(),
            self.duration,
            self.stop_time,
        ];
        let next = events.into_iter().fold(f64::INFINITY, f64::min) - self.time;
        let mut step = self.settings().step;
        if next < step * (1.0 + SHORT_STEP) {
            step = next;
        }
        self.advance(step);
    }

    /// Takes in the reports, and plans where a plan is due or an event asks for one.
    fn observe_and_plan(&mut self) {
        self.observe();
        self.activate();
        let is_due = self.time >= self.next_cycle - INSTANT;
        let period = is_due.then(|| ReplanDocument::PERIOD.to_owned());
        if let Some(reason) = period.or_else(|| self.event()) {
            let (delay, replan) = (self.settings().delay, self.settings().replan);
            self.next_cycle = self.time + replan;
            if self.active.end() > self.time + delay + INSTANT {
                self.cycle(delay, reason);
            }
            self.activate();
        }
        // sets are smaller by then, so the next plan may go on from where this one ends
        if self.pending.is_none() && self.active.ends_short() {
            let before_end = self.active.end() - self.settings().delay - BEFORE_END_S;
            if before_end > self.time + INSTANT {
                self.next_cycle = self.next_cycle.min(before_end);
            }
        }
    }

    /// Why a plan is asked for before its time. Not while another one is being made.
    fn event(&self) -> Option<String> {
        if !self.settings().replan_on_events || self.pending.is_some() {
            return None;
        }
        let first = |is: fn(&Simulated) -> bool, what: &str| {
            let mut known = self.targets.iter().filter(|target| target.is_known());
            let target = known.find(|target| is(target))?;
            Some(format!("{what}: {}", target.name))
        };
        let margin = self.scenario.own_ship.tracking_margin;
        // a ship without a margin would leave it in every step
        let is_off = margin > 0.0 && self.off_plan() > margin;
        first(
            |target| target.track.has_left(),
            ReplanDocument::ANOTHER_VELOCITY,
        )
        .or_else(|| first(|target| target.is_acquired, ReplanDocument::ACQUIRED))
        .or_else(|| is_off.then(|| Alarm::BeyondMargin.to_string()))
    }

    fn observe(&mut self) {
        let own = self.own();
        let sensor = &self.scenario.simulation.sensor;
        for target in &mut self.targets {
            let now = target.truth.now;
            let was_silent = target.is_stale || !target.is_known();
            target.observe(self.time, &now, &own, sensor);
            let silent = self.time - target.track.estimate().time;
            let is_stale = target.is_known() && silent > sensor.stale;
            if is_stale && !target.is_stale {
                self.alarms.push(AlarmDocument {
                    t_s: self.time,
                    alarm: Alarm::Stale,
                    target: Some(target.name.clone()),
                    reason: None,
                });
            }
            target.is_acquired |= was_silent && target.is_known() && !is_stale;
            target.is_stale = is_stale;
        }
    }

    /// Makes a plan that holds from `delay` seconds from now on; returns why there is none.
    fn cycle(&mut self, delay: f64, reason: String) -> Option<NoPlan> {
        let Cycle {
            run,
            document,
            replan,
            cost,
            is_late,
            left_out,
        } = self.plan(delay, reason);
        if self.plan_seconds.is_empty() {
            self.conduct.first_plan_cost = cost.filter(|_| left_out == 0.0);
        }
        self.plan_seconds.push(run.plan_time.as_secs_f64());
        if let Some(begun) = run.scenario.memory.under_way.filter(|m| !m.is_returning) {
            let next = run.planned.manoeuvres.first();
            if !next.is_some_and(|m| m.begins == begun.begins) {
                self.conduct.replaced_manoeuvres += 1;
                let switches = next.is_some_and(|m| m.turn * begun.turn < 0.0);
                self.conduct.side_switches += usize::from(switches);
            }
        }
        self.conduct.lost_remainders += usize::from(cycle::remainder_is_lost(&run));
        for target in &mut self.targets {
            target.is_acquired = false;
            let left = run.scenario.memory.is_outside(&target.name);
            target.outside_sets += usize::from(left);
        }
        for name in &run.scenario.memory.outside_velocities {
            self.alarm(Alarm::AnotherVelocity, Some(name), None);
        }
        for name in &run.scenario.memory.outside_places {
            self.alarm(Alarm::AnotherPlace, Some(name), None);
        }
        let plan = run.planned.outcome.plan();
        let is_safe = document.as_ref().is_some_and(PlanDocument::is_safe);
        self.conduct.without_plan += usize::from(plan.is_none());
        self.conduct.unsafe_plans += usize::from(plan.is_some() && !is_safe);
        self.conduct.late_plans += usize::from(is_late);
        let reason = run.reason();
        if matches!(run.planned.outcome, Outcome::Deadline(_)) {
            self.out_of_time.clone_from(&reason);
        }
        if plan.is_none() {
            self.alarm(Alarm::NoPlan, None, reason);
        } else if is_late {
            self.alarm(Alarm::PlanTooLate, None, None);
        } else if !is_safe {
            let why = reason.map_or(String::new(), |reason| format!(", {reason}"));
            let why = format!("{}{why}", replan.verdict);
            // the one whose set is entered at the greatest risk
            let entered = run
                .relaxations
                .iter()
                .find_map(|relaxation| match relaxation {
                    Relaxation::Risk { target, .. } => Some(target.as_str()),
                    _ => None,
                });
            self.alarm(Alarm::UnsafePlan, entered, Some(why));
        }
        let plan = plan.filter(|_| !is_late);
        let is_stop = |plan: &Plan| !plan.arrives() && plan.trajectory.end_time() <= INSTANT;
        self.stop_time = f64::INFINITY;
        if plan.is_some_and(is_stop) {
            self.stop_time = self.time + delay;
        } else if let Some(plan) = plan {
            if let (Some(plans), Some(document)) = (&mut self.plans, document) {
                plans.push(document);
            }
            let assumed = |name: &str| {
                let target = run.scenario.targets.iter().find(|t| t.name == name);
                target.and_then(|target| target.ship().cloned())
            };
            self.pending = Some(Active {
                start: self.time + delay,
                trajectory: plan.trajectory.clone(),
                previous: PreviousPlan::of(&run),
                left_out,
                assumed: self.targets.iter().map(|t| assumed(&t.name)).collect(),
            });
        }
        self.replans.push(replan);
        match run.planned.outcome {
            Outcome::Infeasible(why) => Some(why),
            Outcome::Solved(_) | Outcome::Deadline(_) => None,
        }
    }

    fn alarm(&mut self, alarm: Alarm, target: Option<&str>, reason: Option<String>) {
        self.alarms.push(AlarmDocument {
            t_s: self.time,
            alarm,
            target: target.map(str::to_owned),
            reason,
        });
    }

    /// Follows the pending plan from its start on.
    fn activate(&mut self) {
        let time = self.time;
        let is_due = |plan: &mut Active| plan.start <= time + INSTANT;
        let Some(plan) = self.pending.take_if(is_due) else {
            return;
        };
        let mut outside = Vec::new();
        for (target, assumed) in self.targets.iter_mut().zip(&plan.assumed) {
            let holds = |assumed| cycle::holds(assumed, &target.truth.now);
            if !assumed.as_ref().is_none_or(holds) {
                target.outside_sets += 1;
                outside.push(target.name.clone());
            }
        }
        for name in outside {
            self.alarm(Alarm::OutsideSet, Some(&name), None);
        }
        self.active = plan;
    }

    fn advance(&mut self, step: f64) {
        let time = self.time;
        let in_plan = time - self.active.start;
        let now = self.own();
        let (current, most) = (self.own.current_speed(), self.scenario.own_ship.max_speed());
        let is_overpowered = current > most;
        if is_overpowered && !self.is_overpowered {
            let reason = format!("{current:.2} m/s of current, own ship makes {most:.2} m/s");
            self.alarm(Alarm::Overpowered, None, Some(reason));
        }
        self.is_overpowered = is_overpowered;
        for target in &mut self.targets {
            target.truth.steer(time, step, &now);
            if let Some(mutual) = &mut target.mutual
                && let Some(reason) = mutual.steer(&mut target.truth.now, &now, step)
            {
                self.alarms.push(AlarmDocument {
                    t_s: time,
                    alarm: Alarm::PlanCut,
                    target: Some(target.name.clone()),
                    reason: Some(reason),
                });
            }
            let ship = target.truth.now;
            let course_and_speed = |ship: &SteadyShip| (ship.pose.heading, ship.speed);
            let before = target.states.last().map(|(_, ship)| course_and_speed(ship));
            if before != Some(course_and_speed(&ship)) {
                target.states.push((time, ship));
            }
        }
        let motion = self.own.advance(&self.active.trajectory, in_plan, step);
        for target in &mut self.targets {
            let now = &target.truth.now;
            target.clearance.add((time, step), &motion, now);
            target.truth.advance(step);
        }
        own::join(&mut self.sailed, &motion, time);
        self.time = time + step;
        let (off, most) = (self.off_plan(), self.tracking_margin());
        let is_beyond = off > most;
        if is_beyond && !self.is_beyond {
            let reason = format!("{} m off the plan", tenths(off));
            self.alarm(Alarm::BeyondMargin, None, Some(reason));
        }
        self.is_beyond = is_beyond;
        if off > self.conduct.largest_off_plan.0 {
            self.conduct.largest_off_plan = (off, self.time);
        }
    }

    /// Metres that own ship may be off its plan; rounding without a tracking margin.
    fn tracking_margin(&self) -> f64 {
        let margin = self.scenario.own_ship.tracking_margin;
        margin.max(crate::tolerance::JOINT_M)
    }

    /// Metres between own ship and where its plan has it.
    fn off_plan(&self) -> f64 {
        let in_plan = self.time - self.active.start;
        let there = self.active.trajectory.pose_at(in_plan).position;
        let own = self.own.pose(&self.active.trajectory, in_plan);
        (own.position - there).norm()
    }
}

impl Simulated {
    /// Takes in what arrives at `time`, with the true state of both ships.
    fn observe(&mut self, time: f64, ship: &SteadyShip, own: &SteadyShip, sensor: &Sensor) {
        let distance = (ship.pose.position - own.pose.position).norm();
        // an explicit set has no sight: it is where the file has it
        let in_sight = self.set.is_some()
            || time.max(0.0) >= self.seen_from - INSTANT && distance <= sensor.range;
        let mut is_reported = false;
        if sensor.kind != SensorKind::Exact {
            for report in self.sensor.reports(time, ship, in_sight) {
                self.track.update(&report);
                is_reported = true;
            }
        } else if in_sight {
            self.track.set_exact(time, ship);
            is_reported = true;
        }
        if is_reported && self.known_from.is_none() {
            self.known_from = Some(time.max(0.0));
            // nothing was assumed of it before
            self.track.assume_anew();
        }
    }

    /// True where own ship has seen the target.
    fn is_known(&self) -> bool {
        self.known_from.is_some()
    }
}

/// End of the simulation, seconds, if own ship has not arrived before.
fn duration(scenario: &Scenario) -> f64 {
    let parts = match Simulation::sails_in_parts(scenario) {
        true => scenario.desired.duration(),
        false => 0.0,
    };
    let settings = &scenario.simulation;
    settings.duration.unwrap_or(scenario.horizon + parts)
}

/// True where the plans are forces, which drive the planner's own model of the ship.
fn is_under_forces(scenario: &Scenario) -> bool {
    matches!(scenario.planner.facts().minimises, Minimises::Own(_))
}

/// An explicit set as a ship: its centre, with the middle of its velocities.
fn middle_of(sets: &Uncertainty) -> ShipTrack {
    let velocity = sets.velocities.first().map(|set| set.velocities.center());
    let velocity = velocity.unwrap_or_else(Vector::zeros);
    let (outline, (east, north)) = (outline(sets), (Vector::x(), Vector::y()));
    let extent = |axis: Vector| outline.support(axis) + outline.support(-axis);
    ShipTrack::exact(
        Pose::new(sets.initial.center(), heading_of(velocity)),
        velocity.norm(),
        Hull::new(extent(east), extent(north)),
    )
}

/// The polygon around the initial set, about its centre.
fn outline(sets: &Uncertainty) -> ConvexPolygon {
    let polygon = sets.initial.outer_polygon(ELLIPSE_SIDES);
    polygon.translated(-sets.initial.center())
}

/// Everything that the loop cannot sail. Conditions are negated so that a NaN is refused.
fn faults(scenario: &Scenario, duration: f64) -> Vec<Fault> {
    let (settings, facts) = (&scenario.simulation, scenario.planner.facts());
    let mut faults = Vec::new();
    let mut refuse_if = |is_wrong: bool, path: &str, found: String, allowed: &str| {
        if is_wrong {
            faults.push(Fault::new(path, found, allowed));
        }
    };
    refuse_if(
        facts.follows_paths,
        "planner.kind",
        format!("{:?}", facts.name),
        "\"space-time\" or \"optimal-control\": the closed loop goes on from their plans alone",
    );
    let forces = is_under_forces(scenario);
    refuse_if(
        forces && settings.vessel.is_some(),
        "simulation.vessel",
        "another ship than the planner's".to_owned(),
        "nothing: the forces of the plans drive the planner's own vessel",
    );
    refuse_if(
        forces && !(scenario.own_ship.tracking_margin > 0.0),
        "own_ship.tracking_margin_m",
        "0".to_owned(),
        "above 0: the vessel is never exactly on a plan under forces",
    );
    refuse_if(
        forces && !settings.current.is_none(),
        "simulation.current",
        "a current".to_owned(),
        "nothing: the vessel of plans under forces has no current",
    );
    for (index, target) in scenario.targets.iter().enumerate() {
        let path = format!("targets[{index}]");
        let Some(ship) = target.ship() else {
            let seen = settings.sensor.kind;
            let acts = !matches!(
                settings.behaviours.get(index),
                None | Some(Behaviour::Constant)
            );
            let (what, allowed) = match &target.motion {
                _ if !forces => ("explicit sets", "a tracked ship, or plans under forces"),
                Motion::Sets(sets) if sets.velocities.len() > 1 => {
                    ("several sets of velocities", "one, whose middle it keeps")
                }
                _ if acts => ("explicit sets that act", "behaviour = \"constant\""),
                _ if seen != SensorKind::Exact || settings.sensor.range.is_finite() => (
                    "explicit sets that are measured",
                    "simulation.sensor = { kind = \"exact\" }, without range_m",
                ),
                _ => continue,
            };
            refuse_if(true, &path, what.to_owned(), allowed);
            continue;
        };
        refuse_if(
            ship.kept_velocities.is_some(),
            &format!("{path}.velocity_set"),
            "a set of velocities".to_owned(),
            "spreads: the loop estimates a velocity and its spreads",
        );
        refuse_if(
            !ship.route.is_empty(),
            &format!("{path}.waypoints"),
            "a known route".to_owned(),
            "nothing: the loop estimates a course; behaviour = \"track\" turns",
        );
        let is_mutual = settings.behaviours.get(index) == Some(&Behaviour::Mutual);
        refuse_if(
            is_mutual && !(ship.speed >= mutual::NO_WAY),
            &format!("{path}.behaviour"),
            format!("a ship of {} m/s that plans", rounded(ship.speed)),
            &format!("a speed of at least {} m/s", mutual::NO_WAY),
        );
        refuse_if(
            is_mutual && forces,
            &format!("{path}.behaviour"),
            "a ship that plans".to_owned(),
            "another behaviour: own ship's forces are those of its own length",
        );
        let path = format!("{path}.not_reported");
        let missing = settings.not_reported.get(index).copied();
        let missing = missing.unwrap_or_default();
        let (kind, default) = (settings.sensor.kind, settings.sensor.default_hull);
        let reports_all = !matches!(kind, SensorKind::Ais { .. });
        refuse_if(
            missing != NotReported::default() && reports_all,
            &path,
            format!("a sensor of kind {:?}", kind.sensor_type().word()),
            "\"ais\": other sensors report neither heading nor size",
        );
        let Hull { length, beam } = default;
        refuse_if(
            missing.size && !(ship.hull.length <= length && ship.hull.beam <= beam),
            &path,
            format!("a larger ship than the default of {length} × {beam} m"),
            "a ship within simulation.sensor.default_length_m and default_beam_m",
        );
    }
    let between_plans = "the time between plans";
    for (key, value, most, of) in [
        ("replan_s", settings.replan, scenario.horizon, "the horizon"),
        ("delay_s", settings.delay, settings.replan, between_plans),
        ("step_s", settings.step, settings.replan, between_plans),
    ] {
        let allowed = format!("at most {most}, {of}");
        let path = format!("simulation.{key}");
        refuse_if(!(value <= most), &path, value.to_string(), &allowed);
    }
    refuse_if(
        !(duration > 0.0),
        "simulation.duration_s",
        duration.to_string(),
        "a time above 0",
    );
    let model = settings.vessel.unwrap_or(VesselModel::Kinematic);
    let vessel = vessel::Vessel::new(model, &scenario.own_ship);
    let (least, planned) = (vessel.least_radius(), scenario.own_ship.turning_radius);
    refuse_if(
        !(least <= planned),
        "simulation.vessel",
        format!("a ship that turns at {least:.1} m at full rudder"),
        &format!("one that can hold the turns of its plans, {planned} m"),
    );
    faults
}
