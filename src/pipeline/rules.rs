//! The rules in a scenario: what they ask of own ship, and how its motion complies.

use super::{Relaxation, Run, TargetSets};
use crate::colregs::compliance::{ComplianceReport, OwnSamples};
use crate::colregs::{Duty, Encountered, SteadyShip, Thresholds};
use crate::frame::Side;
use crate::obstacle::SpaceTimeObstacle;
use crate::parallel;
use crate::scenario::{Compliance, Scenario};
use crate::trajectory::Trajectory;

/// Side of the first turn, from the first target whose role names one.
pub(super) fn first_turn(sets: &[TargetSets]) -> Option<Side> {
    let mut roles = sets.iter().map(|s| s.encounter.role);
    roles.find_map(|role| role.duties().first_turn_to)
}

/// Removes the domains of give-way targets where own ship stands on and gives way to none.
///
/// Own ship holds course and speed as long as it can keep clear of the hard sets
/// (docs/colregs.md 3.6).
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
