//! One simulation, prepared for the views.

use super::{Canvas, Palette, cursor_times, with_sea};
use crate::colregs::{self, Role, SteadyShip};
use crate::document::{
    EncounterDocument, PlanDocument, RoleDocument, SampleDocument, SegmentDocument,
    SimulatedTargetDocument, SimulationDocument, has_role,
};
use crate::frame::{Pose, Vector, heading_of};
use crate::geometry::{ConvexPolygon, Window};
use crate::scenario::Scenario;
use crate::target::{ShipTrack, Uncertainty};
use crate::tolerance;
use crate::trajectory::Segment;
use crate::vessel::OwnShip;

/// Most rows of what moves: one in ten seconds of an hour.
const CURSOR_TIMES: f64 = 360.0;

/// See [`Canvas::pane`]; with a lane of rules below it.
const PANE: [f64; 2] = [702.0, 444.0];

/// A simulation on its canvas. Times count from the scenario's present.
#[derive(Debug)]
pub struct ClosedLoop<'a> {
    pub simulation: &'a SimulationDocument,
    pub canvas: Canvas<'a>,
    /// The plans in the order in which own ship follows them.
    pub plans: Vec<FollowedPlan<'a>>,
}

/// A plan that own ship follows from a time on.
#[derive(Debug)]
pub struct FollowedPlan<'a> {
    pub from: f64,
    pub segments: Vec<Segment>,
    pub targets: Vec<AssumedTarget>,
    /// Times count from the plan's start.
    encounters: &'a [EncounterDocument],
}

/// A target as a plan assumes it. Times count from the plan's start.
#[derive(Debug)]
pub struct AssumedTarget {
    ship: ShipTrack,
    hard: Uncertainty,
}

impl<'a> ClosedLoop<'a> {
    /// `plans` are those that own ship followed, in their order.
    pub fn new(
        scenario: &'a Scenario,
        simulation: &'a SimulationDocument,
        plans: &'a [PlanDocument],
    ) -> Self {
        let end = simulation.duration_s.max(1.0);
        let times = cursor_times(end, CURSOR_TIMES);
        let followed = simulation.replans.iter().filter(|replan| replan.followed);
        let plans = followed
            .zip(plans)
            .filter(|(replan, _)| replan.start_t_s <= end)
            .map(|(replan, plan)| FollowedPlan::new(scenario, replan.start_t_s, plan));
        let mut closed_loop = Self {
            simulation,
            canvas: Canvas::new(scenario, [], &[], end, (Palette::Targets, PANE)),
            plans: plans.filter(|plan| !plan.segments.is_empty()).collect(),
        };
        // the curves reach the reported values
        let samples = &mut closed_loop.canvas.samples;
        samples.push(simulation.conduct.largest_off_plan_t_s);
        samples.extend(simulation.targets.iter().map(|t| t.least_clearance_t_s));
        samples.sort_by(f64::total_cmp);
        samples.dedup();
        closed_loop.canvas.bounds = closed_loop.bounds(&times);
        closed_loop.canvas.cursor_times = times;
        closed_loop
    }

    /// The desired trajectory, the plans, and every ship while it is near own ship.
    fn bounds(&self, times: &[f64]) -> Window {
        let desired = &self.canvas.scenario.desired;
        let near = 0.6 * desired.length();
        let mut points = desired.waypoints();
        let planned = self.plans.iter().flat_map(|plan| &plan.segments);
        points.extend(planned.map(|segment| segment.start.position));
        for &time in times {
            let own = self.own_at(time).0.position;
            points.push(own);
            let targets = self.simulation.targets.iter().filter_map(|t| t.at(time));
            let places = targets.map(|ship| ship.pose.position);
            points.extend(places.filter(|place| (place - own).norm() < near));
        }
        with_sea(&points)
    }

    /// Pose of own hull and its velocity over ground; at rest at its start where nothing was sailed.
    pub fn own_at(&self, time: f64) -> (Pose, Vector) {
        let start = self.canvas.scenario.own_ship.pose;
        let sailed = self.simulation.own_at(time);
        sailed.unwrap_or_else(|| (start, Vector::zeros()))
    }

    /// The plan that own ship follows at a time; `None` before the first.
    pub fn plan_at(&self, time: f64) -> Option<&FollowedPlan<'a>> {
        let time = time + tolerance::TIME_S;
        let begun = self.plans.partition_point(|plan| plan.from <= time);
        self.plans[..begun].last()
    }

    /// Own ship's roles toward a target, as each plan has them until the next one.
    pub fn roles(&self, target: &str) -> Vec<RoleDocument> {
        let nexts = self.plans.iter().skip(1).map(|next| next.from);
        let until = nexts.chain([self.canvas.end]);
        let mut all: Vec<RoleDocument> = Vec::new();
        for (plan, until) in self.plans.iter().zip(until) {
            let met = plan.encounters.iter().find(|met| met.target == target);
            let conduct = met.and_then(|met| met.conduct.as_ref());
            for state in conduct.iter().flat_map(|conduct| &conduct.roles) {
                let from_s = plan.from + state.from_s.max(0.0);
                let until_s = until.min(plan.from + state.until_s);
                let goes_on = |last: &&mut RoleDocument| {
                    last.role == state.role && from_s - last.until_s < tolerance::TIME_S
                };
                if until_s <= from_s {
                    continue;
                }
                match all.last_mut().filter(goes_on) {
                    Some(last) => last.until_s = until_s,
                    None => all.push(RoleDocument {
                        role: state.role,
                        from_s,
                        until_s,
                    }),
                }
            }
        }
        all
    }

    /// Own ship's role toward a target on the desired trajectory, the first that a plan has.
    pub fn desired_role(&self, target: &str) -> Role {
        let met = self.plans.iter().flat_map(|plan| plan.encounters);
        let met = met.filter(|met| met.target == target);
        let mut roles = met.map(|met| met.role);
        roles.find(|role| has_role(*role)).unwrap_or(Role::None)
    }

    /// Metres between own ship and where its plan has it; at the start of a plan, where the one
    /// before has it.
    pub fn off_plan(&self, time: f64) -> Option<f64> {
        let before = self.plan_at(time - 2.0 * tolerance::TIME_S);
        let planned = on(&before.or_else(|| self.plan_at(time))?.segments, time);
        Some((self.own_at(time).0.position - planned.pose.position).norm())
    }

    /// The distances of the hulls that matter, metres; `None` without a target.
    pub fn near_clearances(&self) -> Option<[f64; 2]> {
        let targets = self.simulation.targets.iter();
        let least = targets.filter_map(|target| target.least_clearance_m);
        let least = least.reduce(f64::min)?;
        Some(self.canvas.near(least))
    }

    /// Times at which the hulls come nearer than before, with the distance in metres.
    pub fn least_until(&self) -> Vec<(f64, f64)> {
        let mut least = f64::INFINITY;
        let nearer = self.canvas.samples.iter().filter_map(|&time| {
            let targets = self.simulation.targets.iter();
            let now = targets.filter_map(|target| self.clearance(target, time));
            let now = now.fold(f64::INFINITY, f64::min);
            (now < least).then(|| {
                least = now;
                (time, now)
            })
        });
        nearer.collect()
    }

    /// Metres between the hulls, negative in overlap.
    pub fn clearance(&self, target: &SimulatedTargetDocument, time: f64) -> Option<f64> {
        let own = self.canvas.scenario.own_ship.hull;
        let own = target.own_hull(own).polygon(&self.own_at(time).0);
        let other = target.outline(&target.at(time)?.pose)?;
        Some(own.separation(&other))
    }
}

impl<'a> FollowedPlan<'a> {
    fn new(scenario: &Scenario, from: f64, plan: &'a PlanDocument) -> Self {
        let trajectory = plan.trajectory.as_ref();
        let segments = trajectory.map_or_else(Vec::new, |trajectory| match &trajectory.segments {
            Some(segments) => segments.iter().map(SegmentDocument::segment).collect(),
            None => lines(&trajectory.samples),
        });
        let ships = plan.targets.iter().filter_map(|t| t.ship.as_ref());
        let ships = ships.filter_map(|ship| ship.track().ok());
        Self {
            from,
            segments: (segments.into_iter())
                .map(|segment| Segment {
                    start_time: segment.start_time + from,
                    ..segment
                })
                .collect(),
            targets: ships
                .map(|ship| AssumedTarget::new(&scenario.own_ship, ship, plan.horizon_s))
                .collect(),
            encounters: &plan.encounters,
        }
    }
}

impl AssumedTarget {
    fn new(own: &OwnShip, ship: ShipTrack, horizon: f64) -> Self {
        let hard = colregs::ship_domain(own, &ship, None, horizon).hard;
        let velocities = ship.outer_velocity_sets(ship.turn_rate, horizon);
        Self {
            hard: Uncertainty::new(hard, velocities),
            ship,
        }
    }

    /// The hull on the expected track.
    pub fn hull_at(&self, time: f64) -> ConvexPolygon {
        self.ship.hull.polygon(&self.ship.pose_at(time))
    }

    /// The set that own ship's centre has to keep out of, from the outside.
    pub fn hard_at(&self, time: f64) -> ConvexPolygon {
        self.hard.outer_section(time)
    }
}

/// Lines from sample to sample of a motion under forces.
fn lines(samples: &[SampleDocument]) -> Vec<Segment> {
    let place = |sample: &SampleDocument| Vector::new(sample.east_m, sample.north_m);
    let line = |pair: &[SampleDocument]| {
        let (way, duration) = (place(&pair[1]) - place(&pair[0]), pair[1].t_s - pair[0].t_s);
        let start = Pose::new(place(&pair[0]), heading_of(way));
        Segment::straight(start, pair[0].t_s, duration, way.norm() / duration)
    };
    samples.windows(2).map(line).collect()
}

/// The ship on segments, of which there is at least one.
fn on(segments: &[Segment], time: f64) -> SteadyShip {
    let begun = segments.partition_point(|segment| segment.start_time <= time);
    let segment = &segments[begun.saturating_sub(1)];
    let time = time.clamp(segment.start_time, segment.end_time());
    SteadyShip {
        pose: segment.pose_at(time),
        speed: segment.speed,
    }
}
