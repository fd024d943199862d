//! What the rules ask of own ship in a scenario.

use super::{Relaxation, TargetSets};
use crate::colregs::{Duty, Encountered, Role, SteadyShip};
use crate::frame::Side;
use crate::obstacle::SpaceTimeObstacle;
use crate::scenario::{Compliance, Scenario};

/// Rules 14 and 15 in open water: to starboard where own ship meets head-on or gives way.
pub(super) fn first_turn(sets: &[TargetSets]) -> Option<Side> {
    let alters = |s: &TargetSets| matches!(s.encounter.role, Role::HeadOn | Role::GiveWay);
    sets.iter().any(alters).then_some(Side::Starboard)
}

/// The sets where own ship stands on and gives way to none: of those who are to give way the hard ones alone. She keeps course and speed
/// as long as these can be kept clear of (docs/colregs.md 3.6).
pub(super) fn without_shapes_stood_on_for(
    scenario: &Scenario,
    mut sets: Vec<TargetSets>,
) -> Vec<TargetSets> {
    let roles = sets.iter().map(|s| s.encounter.role);
    if scenario.compliance == Compliance::Rules && Duty::of(roles).stands_on {
        for set in sets
            .iter_mut()
            .filter(|s| s.encounter.role.duties().stands_on)
        {
            set.give_up_shape();
        }
    }
    sets
}

/// The targets that the rules ask something about.
pub(super) fn encountered(scenario: &Scenario, sets: &[TargetSets]) -> Vec<Encountered> {
    asking(scenario, sets).map(|(_, e)| e).collect()
}

/// The rules that a plan does not keep to.
pub(super) fn rules_given_up(scenario: &Scenario, sets: &[TargetSets]) -> Vec<Relaxation> {
    let given_up = |(target, e): (&TargetSets, Encountered)| Relaxation::Compliance {
        target: target.hard.name().to_owned(),
        role: e.role,
    };
    asking(scenario, sets).map(given_up).collect()
}

fn asking<'a>(
    scenario: &'a Scenario,
    sets: &'a [TargetSets],
) -> impl Iterator<Item = (&'a TargetSets, Encountered)> {
    let both = scenario.targets.iter().zip(sets);
    both.filter_map(|(target, sets)| {
        let track = target.ship()?;
        let role = sets.encounter.role;
        let ship = SteadyShip {
            pose: track.pose,
            speed: track.speed,
        };
        let length = track.hull.length;
        let asks = !Duty::of(std::iter::once(role)).is_none();
        asks.then_some((sets, Encountered { role, ship, length }))
    })
}
