//! Tests of encounter classification on scenes of a known kind anywhere in the plane.

use searoom::pipeline::sets;

use crate::campaigns::encounter_generator::{EncounterKind, Placement, random_encounter};

#[test]
fn a_drawn_encounter_has_the_role_it_was_drawn_for() {
    for (kind, seed) in EncounterKind::with_seeds(0..250) {
        let drawn = random_encounter(kind, seed, Placement::Random).expect("a scene");
        let found = sets(&drawn.scenario).remove(0).encounter;
        assert_eq!(found.role, kind.role(), "{} {seed}", kind.name());
    }
}
