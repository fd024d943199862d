//! Tests of encounter classification on scenes of a known kind anywhere in the plane.

use searoom::obstacle::Obstacle;
use searoom::pipeline::{TargetSets, sets};

use crate::campaigns::encounter_generator::{EncounterKind, Placement, random_encounter};

fn judged(kind: EncounterKind, seed: u64, placement: Placement) -> TargetSets {
    let drawn = random_encounter(kind, seed, placement).expect("a scene");
    sets(&drawn.scenario).remove(0)
}

#[test]
fn a_drawn_encounter_has_the_role_it_was_drawn_for() {
    for (kind, seed) in EncounterKind::with_seeds(0..250) {
        let found = judged(kind, seed, Placement::Random).encounter;
        assert_eq!(found.role, kind.role(), "{} {seed}", kind.name());
    }
}

#[test]
fn turning_and_moving_the_scene_changes_no_judgement_and_no_shape() {
    let size = |set: &Obstacle| set.outer_section(0.0).area().sqrt();
    let figures = |found: &TargetSets| {
        [
            found.encounter.undisturbed_dcpa,
            found.shape_reduced,
            size(&found.hard),
            size(&found.with_domain),
        ]
    };
    for (kind, seed) in EncounterKind::with_seeds(0..100) {
        let here = judged(kind, seed, Placement::Origin);
        let there = judged(kind, seed, Placement::Random);
        assert_eq!(here.encounter.role, there.encounter.role);
        for (a, b) in figures(&here).into_iter().zip(figures(&there)) {
            assert!((a - b).abs() < 1e-6, "{} {seed}: {a} {b}", kind.name());
        }
    }
}
