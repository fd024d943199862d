//! Tests of roles: of scenes of a known kind anywhere in the plane, and of ships that pass beyond the
//! limits.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::colregs::Role;
use searoom::document::PlanDocument;
use searoom::frame::{Pose, Vector, direction, heading_of, wrap};
use searoom::pipeline::{self, Run, sets};
use searoom::scenario::Scenario;
use searoom::target::{Motion, ShipTrack, Target};
use searoom::trajectory::DesiredTrajectory;

use crate::campaigns::documents::{fault, parsed};
use crate::campaigns::encounter_generator::{EncounterKind, Placement, random_encounter};

#[test]
fn a_drawn_encounter_has_the_role_it_was_drawn_for() {
    for (kind, seed) in EncounterKind::with_seeds(0..250) {
        let drawn = random_encounter(kind, seed, Placement::Random).expect("a scene");
        let found = sets(&drawn.scenario).remove(0).encounter;
        assert_eq!(found.role, kind.role(), "{} {seed}", kind.name());
    }
}

/// Sign of the first turn, positive to port; 0 where a plan alters its speed alone, and `None` where
/// it alters nothing.
fn first_alteration(run: &Run) -> Option<f64> {
    let plan = run.planned.outcome.plan().expect("a plan");
    let segments = plan.trajectory.segments();
    let ordered = run.scenario.own_ship.speed;
    let first = segments.iter().find(|s| s.turn_rate != 0.0);
    let turn = first.map(|s| s.turn_rate.signum());
    turn.or_else(|| segments.iter().any(|s| s.speed != ordered).then_some(0.0))
}

fn broken(run: &Run) -> Vec<&'static str> {
    let reports = run.judged_compliance();
    let broken = reports.iter().flatten().flat_map(|r| r.broken());
    broken.collect()
}

/// These ships would pass beyond two lengths, but their sets reach own ship's way. Without a role own
/// ship turned to port for the first, and passed ahead of the others.
#[test]
fn a_ship_that_own_ship_alters_for_has_a_role() {
    for (name, roles) in [
        ("rules-grazes-head-on.toml", &[Role::HeadOn][..]),
        ("rules-grazes-from-starboard.toml", &[Role::GiveWay]),
        ("rules-tug-and-tow.toml", &[Role::GiveWay, Role::GiveWay]),
        ("rules-fishing-head-on.toml", &[Role::HeadOn]),
    ] {
        let run = pipeline::run(parsed(&fault(name)));
        let found = run.targets.iter().map(|t| t.sets.encounter.role);
        assert_eq!(found.collect::<Vec<_>>(), roles, "{name}");
        assert_eq!(first_alteration(&run), Some(-1.0), "{name}");
        assert!(run.relaxations.is_empty(), "{name} {:?}", run.relaxations);
        assert_eq!(broken(&run), Vec::<&str>::new(), "{name}");
        for encounter in PlanDocument::of(&run).encounters {
            let roles = encounter.conduct.expect("a ship").roles;
            let named = roles.iter().all(|r| r.role == encounter.role);
            assert!(named, "{name} {roles:?}");
            assert_ne!(encounter.crosses_astern, Some(false), "{name}");
        }
    }
}

/// The ship `behind it` passes 764 m off on the desired trajectory, beyond the limit, but is met on the
/// manoeuvre for the ship `near`. Without a role own ship turned to port for it (Rule 17(c)).
#[test]
fn a_ship_that_is_met_on_the_plan_alone_has_a_role() {
    let run = pipeline::run(parsed(&fault("rules-role-on-the-plan.toml")));
    assert_eq!(run.targets[1].sets.encounter.role, Role::StandOn);
    assert!(run.relaxations.is_empty(), "{:?}", run.relaxations);
    assert_eq!(broken(&run), Vec::<&str>::new());
}

/// A ship that comes head-on or from starboard and would pass at one to three times the limit, which
/// is twice the longer ship's length.
fn grazing(head_on: bool, rng: &mut ChaCha8Rng) -> Scenario {
    let mut scenario = parsed(&fault("rules-grazes-head-on.toml"));
    let Motion::Ship(ship) = &mut scenario.targets[0].motion else {
        panic!("a ship");
    };
    let own = scenario.own_ship.speed;
    ship.hull.length = rng.random_range(30.0..200.0);
    ship.hull.beam = ship.hull.length / 6.0;
    ship.speed = own * rng.random_range(0.4..1.3);
    let limit = 2.0 * ship.hull.length.max(scenario.own_ship.hull.length);
    let aside = limit * rng.random_range(1.0..3.0) * [-1.0, 1.0][rng.random_range(0..2)];
    let off = |rng: &mut ChaCha8Rng, degrees: f64| rng.random_range(-degrees..degrees).to_radians();
    let heading = match head_on {
        true => -std::f64::consts::FRAC_PI_2 + off(rng, 4.0),
        false => std::f64::consts::PI + off(rng, 40.0),
    };
    let tcpa = rng.random_range(300.0..700.0);
    let relative = direction(heading) * ship.speed - Vector::new(0.0, own);
    let across = Vector::new(relative.y, -relative.x).normalize();
    let meeting = Vector::new(0.0, own * tcpa) + across * aside;
    let place = meeting - direction(heading) * (ship.speed * tcpa);
    ship.pose = Pose::new(place, heading);
    scenario
}

/// The scene mirrored about own ship's course, or turned and moved.
fn placed(scenario: &Scenario, mirrored: bool, at: Pose) -> Scenario {
    let side = if mirrored { -1.0 } else { 1.0 };
    // own ship steers north
    let place = |p: Vector| at.world_coordinates(Vector::new(p.y, -side * p.x));
    let pose = |pose: Pose| {
        let ahead = pose.ahead();
        let turned = heading_of(Vector::new(ahead.y, -side * ahead.x));
        Pose::new(place(pose.position), wrap(at.heading + turned))
    };
    let mut other = scenario.clone();
    other.own_ship.pose = pose(scenario.own_ship.pose);
    let waypoints = scenario.desired.waypoints().into_iter().map(place);
    let speeds: Vec<f64> = scenario.desired.legs().iter().map(|l| l.speed).collect();
    let waypoints: Vec<Vector> = waypoints.collect();
    other.desired = DesiredTrajectory::new(&waypoints, &speeds).expect("a way");
    let moved = |target: &Target| Target {
        motion: Motion::Ship(ShipTrack {
            pose: pose(target.ship().expect("a ship").pose),
            ..target.ship().expect("a ship").clone()
        }),
        ..target.clone()
    };
    other.targets = scenario.targets.iter().map(moved).collect();
    other
}

/// Without roles beyond the limits own ship turned to port for 8 of 38 ships that came head-on, and
/// passed ahead of 10 of 42 from starboard.
#[test]
fn no_ship_that_grazes_is_passed_on_the_wrong_side() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut altered = 0;
    for case in 0..80 {
        let scene = grazing(case % 2 == 0, &mut rng);
        let at = Pose::new(
            Vector::new(rng.random_range(-1e4..1e4), rng.random_range(-1e4..1e4)),
            rng.random_range(-3.0..3.0),
        );
        let origin = Pose::new(Vector::zeros(), std::f64::consts::FRAC_PI_2);
        for (mirrored, at) in [(false, origin), (true, origin), (false, at), (true, at)] {
            let run = pipeline::run(placed(&scene, mirrored, at));
            let encounter = run.targets[0].sets.encounter;
            let about = format!("{case} {mirrored} {at:?} {encounter:?}");
            let Some(turn) = first_alteration(&run) else {
                continue;
            };
            assert_ne!(encounter.role, Role::None, "{about}");
            let beyond = run.scenario.targets[0]
                .ship()
                .expect("a ship")
                .risk_distance;
            altered += usize::from(beyond > 0.0);
            if !run.relaxations.is_empty() {
                continue;
            }
            if encounter.role.duties().no_turn_to.is_some() {
                assert!(turn <= 0.0, "{about}");
            }
            if encounter.role == Role::GiveWay {
                let found = PlanDocument::of(&run).encounters.remove(0);
                assert_ne!(found.crosses_astern, Some(false), "{about}");
            }
            if encounter.role.duties().keeps_clear {
                assert_eq!(broken(&run), Vec::<&str>::new(), "{about}");
            }
        }
    }
    assert!(altered >= 80, "only {altered} of 320 beyond the limits");
}
