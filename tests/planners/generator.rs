//! Random encounters are of their kind, and the same scene for the same seed.

use searoom::frame::wrap;

use crate::campaigns::encounter_generator::{
    EncounterKind, Placement, RandomEncounter, random_encounter, random_traffic,
};

fn all(count: u64) -> Vec<RandomEncounter> {
    EncounterKind::with_seeds(0..count)
        .map(|(kind, seed)| random_encounter(kind, seed, Placement::Origin).expect("drawn"))
        .collect()
}

#[test]
fn undisturbed_ships_miss_by_at_most_half_a_length_at_the_meeting_time() {
    for d in all(300) {
        let own = &d.scenario.own_ship;
        let ship = d.scenario.targets[0].ship().expect("a ship");
        let relative = own.pose.ahead() * own.speed - ship.velocity();
        let between = ship.pose.position - own.pose.position;
        let tcpa = between.dot(&relative) / relative.norm_squared();
        let dcpa = (between - relative * tcpa).norm();
        assert!((100.0 - 1e-6..=220.0 + 1e-6).contains(&tcpa), "{tcpa}");
        assert!(dcpa <= ship.hull.length / 2.0 + 1e-6, "{dcpa}");
    }
}

#[test]
fn a_placed_scene_is_the_same_scene_moved() {
    for seed in 0..50 {
        let kind = EncounterKind::GiveWay;
        let here = random_encounter(kind, seed, Placement::Origin).expect("drawn");
        let there = random_encounter(kind, seed, Placement::Random).expect("drawn");
        let again = random_encounter(kind, seed, Placement::Random);
        assert_eq!(Some(&there), again.as_ref());
        let ship = |d: &RandomEncounter| d.scenario.targets[0].ship().expect("a ship").clone();
        let pose = there.scenario.own_ship.pose;
        let body = pose.body_coordinates(ship(&there).pose.position);
        assert!((body - ship(&here).pose.position).norm() < 1e-8);
        let turned = wrap(ship(&there).pose.heading - pose.heading);
        assert!(wrap(turned - ship(&here).pose.heading).abs() < 1e-9);
        assert!((pose.position - there.scenario.desired.legs()[0].start).norm() < 1e-12);
    }
}

#[test]
fn every_kind_is_drawn_without_many_replacements_and_no_two_seeds_are_alike() {
    for kind in EncounterKind::ALL {
        let drawn: Vec<RandomEncounter> = (0..300)
            .map(|s| random_encounter(kind, s, Placement::Origin).expect("drawn"))
            .collect();
        let rejected: usize = drawn.iter().map(|d| d.rejected).sum();
        assert!(rejected < 300 * 9, "{kind:?}: {rejected} rejected");
        let mut pairs = drawn.windows(2);
        assert!(pairs.all(|w| w[0].scenario.targets != w[1].scenario.targets));
    }
}

#[test]
fn traffic_has_as_many_targets_as_asked_for() {
    for count in [0, 2, 4, 10] {
        let d = random_traffic(count, 3, Placement::Random).expect("drawn");
        assert_eq!((d.scenario.targets.len(), d.kinds.len()), (count, count));
    }
}
