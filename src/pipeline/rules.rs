//! The rules in a scenario: what they ask of own ship, and how its motion complies.

use std::borrow::Cow;

use super::{Relaxation, Run, TargetSets};
use crate::colregs::compliance::{ComplianceReport, OwnSamples};
use crate::colregs::{self, Duty, Encountered, SteadyShip, TargetMemory, Thresholds};
use crate::frame::{Pose, Side, heading_of};
use crate::obstacle::SpaceTimeObstacle;
use crate::parallel;
use crate::scenario::{Compliance, Scenario};
use crate::target::Motion;
use crate::tolerance;
use crate::trajectory::{DesiredTrajectory, Segment, Trajectory};

/// Side of the first turn, from the first target whose role names one.
pub(super) fn first_turn(sets: &[TargetSets]) -> Option<Side> {
    let mut roles = sets.iter().map(|s| s.encounter.role);
    roles.find_map(|role| role.duties().first_turn_to)
}

/// Removes the domains of give-way targets where own ship stands on and gives way to none.
///
/// Own ship holds course and speed as long as it can keep clear of the hard sets
/// (docs/reference/colregs.md 3.6).
pub(super) fn without_domains_of_give_way_targets(
    scenario: &Scenario,
    mut sets: Vec<TargetSets>,
) -> Vec<TargetSets> {
    let roles = sets.iter().map(|s| s.encounter.role);
    if scenario.compliance == Compliance::Rules && Duty::of(roles).stands_on {
        for set in sets
            .iter_mut()
            .filter(|s| s.encounter.role.duties().stands_on)
        {
            set.remove_domain();
        }
    }
    sets
}

/// Ratio of the risk distance of a ship that own ship alters for to the distance at which it would
/// pass: the end of a risk over its beginning (docs/reference/colregs.md 1.3).
const RISK_DISTANCE_RATIO: f64 = 1.5;

/// The scenario with a risk of collision (Rule 7(a)) with every ship that has no role though own
/// ship alters for it: its set, of which `sets` has the larger one, is met on the desired
/// trajectory. Such a ship has the role that its geometry gives without a limit of the distance.
/// `None` where no ship gets a role by this, and where the rules are not asked for.
pub(super) fn with_risk_of_sets(scenario: &Scenario, sets: &[TargetSets]) -> Option<Scenario> {
    with_risk(scenario, sets, |index, desired| {
        let legs = desired.legs().iter().map(|leg| {
            let pose = Pose::new(leg.start, heading_of(leg.direction));
            let (begins, ends) = (leg.start_time, leg.end_time().min(scenario.horizon));
            Segment::straight(pose, begins, (ends - begins).max(0.0), leg.speed)
        });
        let set = sets[index].with_domain.at_risk(scenario.max_risk);
        set.is_entered(&legs.collect::<Vec<_>>(), tolerance::TOUCH_M)
    })
}

/// The scenario with a risk of collision with every ship that has no role on the desired trajectory,
/// but toward which a plan breaks rules: a plan that keeps clear of one ship may come near another.
/// `None` as in [`with_risk_of_sets`].
pub(super) fn with_risk_of_plan(
    scenario: &Scenario,
    sets: &[TargetSets],
    plan: &Trajectory,
) -> Option<Scenario> {
    if scenario.compliance != Compliance::Rules {
        return None;
    }
    let reports = compliance(scenario, Some(plan), &scenario.limits);
    with_risk(scenario, sets, |index, _| {
        reports[index].as_ref().is_some_and(|r| !r.complies())
    })
}

/// The scenario with a risk of collision with every ship that has no role, has not passed, and of
/// which `is_met` is true.
fn with_risk(
    scenario: &Scenario,
    sets: &[TargetSets],
    is_met: impl Fn(usize, &DesiredTrajectory) -> bool + Sync,
) -> Option<Scenario> {
    if scenario.compliance != Compliance::Rules {
        return None;
    }
    let found = parallel::map(sets, |index, sets| {
        let (ship, known) = (
            scenario.targets[index].ship()?,
            scenario.memory.target(index),
        );
        if sets.encounter.risk.is_some() || known.is_some_and(|known| known.passed) {
            return None;
        }
        let desired = judged_path(scenario, known);
        if !is_met(index, &desired) {
            return None;
        }
        let (own, limits) = (&scenario.own_ship, &scenario.limits);
        colregs::least_risk_distance(own, &desired, ship, scenario.horizon, limits)
    });
    found.iter().any(Option::is_some).then(|| {
        let mut scenario = scenario.clone();
        for (target, distance) in scenario.targets.iter_mut().zip(found) {
            if let (Motion::Ship(ship), Some(distance)) = (&mut target.motion, distance) {
                ship.risk_distance = RISK_DISTANCE_RATIO * distance;
            }
        }
        scenario
    })
}

/// The motion along which a role toward a target is sought: the desired trajectory, from own place
/// where the target was seen before.
pub(super) fn judged_path<'a>(
    scenario: &'a Scenario,
    known: Option<&TargetMemory>,
) -> Cow<'a, DesiredTrajectory> {
    match known {
        Some(known) if !known.track.is_empty() => {
            Cow::Owned(scenario.desired.from(scenario.own_ship.pose.position))
        }
        _ => Cow::Borrowed(&scenario.desired),
    }
}

/// The targets toward which the rules give own ship a duty.
pub(super) fn encountered(scenario: &Scenario, sets: &[TargetSets]) -> Vec<Encountered> {
    asking(scenario, sets).map(|(_, e)| e).collect()
}

/// The rules that a plan breaks, per target.
pub(super) fn relaxed_rules(scenario: &Scenario, sets: &[TargetSets]) -> Vec<Relaxation> {
    let relaxation = |(target, e): (&TargetSets, Encountered)| Relaxation::Compliance {
        target: target.hard.name().to_owned(),
        role: e.role,
    };
    asking(scenario, sets).map(relaxation).collect()
}

fn asking<'a>(
    scenario: &'a Scenario,
    sets: &'a [TargetSets],
) -> impl Iterator<Item = (&'a TargetSets, Encountered)> {
    let both = scenario.targets.iter().zip(sets);
    both.filter_map(|(target, sets)| {
        let track = target.ship()?;
        let role = sets.encounter.role;
        let risk = sets.encounter.risk?;
        // on a known route the course on which the risk begins, as if it had come straight
        let ship = match risk.time > 0.0 && !track.route.is_empty() {
            true => risk.target.moved(-risk.time),
            false => SteadyShip::on_track(track, 0.0),
        };
        let tcpa = if risk.time < 0.0 {
            risk.with_ships_at(0.0, scenario.own_ship.pose.position, ship)
                .tcpa()
        } else {
            risk.tcpa()
        };
        let encountered = Encountered {
            role,
            ship,
            hull: track.hull,
            risk_distance: track.risk_distance,
            own: risk.own,
            risk_since: risk.time,
            tcpa,
        };
        let asks = !Duty::of(std::iter::once(role)).is_none();
        asks.then_some((sets, encountered))
    })
}

/// Number of rules and monitors that a trajectory violates by the planner's limits.
pub(super) fn breaks(scenario: &Scenario, trajectory: &Trajectory) -> usize {
    let reports = compliance(scenario, Some(trajectory), &scenario.limits);
    reports.iter().flatten().map(|r| r.broken().count()).sum()
}

/// Compliance of a trajectory toward each target, together with the motion before it.
fn compliance(
    scenario: &Scenario,
    trajectory: Option<&Trajectory>,
    thresholds: &Thresholds,
) -> Vec<Option<ComplianceReport>> {
    let (own, memory) = (&scenario.own_ship, &scenario.memory);
    let track = trajectory.map(|trajectory| OwnSamples::along(&memory.sailed, trajectory, own));
    let samples = parallel::map(&scenario.targets, |index, target| {
        let (track, ship) = (track.as_ref()?, target.ship()?);
        let known = memory.target(index);
        Some(ComplianceReport::samples(track, ship, known, thresholds))
    });
    let mut reports = ComplianceReport::of_all(samples.iter().flatten(), thresholds).into_iter();
    let report = |samples: &Option<_>| samples.as_ref().and_then(|_| reports.next());
    samples.iter().map(report).collect()
}

impl Run {
    /// Compliance of the plan toward each target, in the scenario's order.
    ///
    /// `None` without a plan, and for a target that is not a tracked ship. Uses the planned
    /// trajectory and the nominal track alone. O(targets × seconds), less for distant targets.
    pub fn compliance(&self, thresholds: &Thresholds) -> Vec<Option<ComplianceReport>> {
        let plan = self.planned.outcome.plan();
        compliance(
            &self.scenario,
            plan.map(|plan| &plan.trajectory),
            thresholds,
        )
    }

    /// [`Run::compliance`] by the scenario's thresholds.
    pub fn judged_compliance(&self) -> Vec<Option<ComplianceReport>> {
        self.compliance(self.scenario.judged_by())
    }
}
