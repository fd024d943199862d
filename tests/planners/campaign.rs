//! Each campaign with few scenes; `cargo campaign` runs more.

use crate::campaigns::closed_loop::replanning::{self, Behaviour, How};
use crate::campaigns::encounter_generator::{EncounterKind, Meeting};
use crate::campaigns::plans::several::Which;
use crate::campaigns::plans::{
    asked, compliance, encounters, harbour, invariance, mutations, several, tidiness,
};
use crate::campaigns::{dense_search, forces, meeting, path_time, scene_file, wild};
use searoom::frame::wrap;
use searoom::pipeline;
use searoom::scenario::Scenario;
use searoom::target::ShipTrack;

#[test]
fn plans_of_random_encounters_are_clear_of_whatever_the_target_may_do() {
    encounters::run(0..75).assert_met();
}

#[test]
fn plans_have_few_turns_and_changes_of_speed_and_no_short_segment() {
    tidiness::run(0..60).assert_met();
}

#[test]
fn plans_among_many_targets_are_clear_of_all() {
    encounters::run_among_many(0..10).assert_met();
}

#[test]
fn a_dense_search_finds_hardly_anything_cheaper() {
    dense_search::run(0..2).assert_met();
    // A* alone costs 2.4 times as much
    dense_search::run_among(4, 26..27).assert_met();
}

#[test]
fn plans_keep_to_the_rules() {
    compliance::run(0..60, &Meeting::NEAR, None, None).assert_met();
}

#[test]
fn a_scene_that_is_kept_as_a_file_is_read_as_it_was() {
    for seed in 0..20 {
        let scene = Which::by_the_rules(3, seed % 2 == 0)
            .scene(seed)
            .expect("drawn");
        let text = scene_file::text(&scene);
        let read = Scenario::parse(&text).expect("valid");
        assert_eq!(read.compliance, scene.compliance);
        assert_eq!(read.own_ship.speeds, scene.own_ship.speeds);
        assert_eq!(read.own_ship.hull, scene.own_ship.hull);
        assert_eq!(read.horizon, scene.horizon);
        assert_eq!(read.time_weight, scene.time_weight);
        assert_eq!(read.targets.len(), scene.targets.len());
        for (a, b) in read.targets.iter().zip(&scene.targets) {
            let (a, b) = (a.ship().expect("a ship"), b.ship().expect("a ship"));
            assert!((a.pose.position - b.pose.position).norm() < 1e-9);
            assert!(wrap(a.pose.heading - b.pose.heading).abs() < 1e-9);
            let spreads =
                |s: &ShipTrack| [s.speed, s.speed_spread, s.course_spread, s.position_std];
            for (a, b) in spreads(a).iter().zip(spreads(b)) {
                assert!((a - b).abs() < 1e-9, "{a} {b}");
            }
        }
        let plan = |scene| {
            let run = pipeline::run(scene);
            run.planned.outcome.plan().map(|plan| plan.cost)
        };
        let (a, b) = (plan(read), plan(scene));
        let same = a.zip(b).is_some_and(|(a, b)| (a / b - 1.0).abs() < 1e-6);
        assert!(same, "{seed}: {a:?} {b:?}");
    }
}

/// Six ships head-on, one after another: many sequences break a rule at the next ship, and one manoeuvre
/// toward all does not.
#[test]
fn a_long_sequence_is_lawful_where_one_manoeuvre_is() {
    let mut text = String::from(
        "title = \"six in a row\"\nhorizon_s = 4500.0\n\
         mission = { waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 0, north_m = 15000 }], speed_mps = 5.0 }\n\
         [own_ship]\nposition = { east_m = 0, north_m = 0 }\ncourse_deg = 0.0\nspeed_mps = 5.0\nlength_m = 30.0\n\
         beam_m = 8.0\nturning_radius_m = 100.0\nspeeds_mps = [2.5, 5.0, 6.0]\nsafety_margin_m = 20.0\n",
    );
    for ship in 0..6 {
        let north = 10.0 * (200.0 + 450.0 * f64::from(ship));
        text += &format!(
            "[[targets]]\nname = \"ship {ship}\"\nposition = {{ east_m = 0, north_m = {north} }}\ncourse_deg = 180.0\n\
             speed_mps = 5.0\nlength_m = 60.0\nbeam_m = 12.0\nspeed_spread_mps = 0.1\ncourse_spread_deg = 1.0\n"
        );
    }
    let run = pipeline::run(Scenario::parse(&text).expect("valid"));
    let plan = run.planned.outcome.plan().expect("a plan");
    assert!(run.relaxations.is_empty() && plan.arrives());
    assert_eq!(several::broken(&run), [""; 0]);
}

/// Cost of the plan of a random meeting that breaks no rule and relaxes nothing, m².
fn lawful_cost(kind: EncounterKind, seed: u64) -> f64 {
    let run = pipeline::run(meeting(kind, seed, &Meeting::NEAR));
    let evaluation = run.evaluation.as_ref().expect("judged");
    assert!(evaluation.verified() && evaluation.safe() && run.relaxations.is_empty());
    assert_eq!(several::broken(&run), [""; 0]);
    run.planned.outcome.plan().expect("a plan").cost
}

/// Three ships one after another: one manoeuvre toward all would cost 200 times as much.
#[test]
fn a_manoeuvre_toward_all_is_not_made_where_several_are_cheaper() {
    let scene = Which::by_the_rules(3, true).scene(1119).expect("drawn");
    let run = pipeline::run(scene);
    let plan = run.planned.outcome.plan().expect("a plan");
    assert!(run.relaxations.is_empty() && run.planned.manoeuvres.len() > 1);
    assert!(plan.cost < 160_000.0, "{}", plan.cost);
}

/// A give-way ship would slow down for ten minutes, 900 m off its schedule in the mean: a bend that breaks no
/// rule costs an eighteenth.
#[test]
fn a_lawful_bend_is_taken_where_a_manoeuvre_is_many_times_as_dear() {
    let cost = lawful_cost(EncounterKind::GiveWay, 50_158);
    assert!(cost < 60_000.0, "{cost}");
}

/// A stand-on ship that kept a length off the other turned 81° at once for it, at eleven times the price of
/// less speed when it may act.
#[test]
fn no_length_is_kept_at_any_price() {
    let cost = lawful_cost(EncounterKind::StandOn, 50_278);
    assert!(cost < 2_000.0, "{cost}");
}

#[test]
fn plans_among_several_targets_keep_to_the_rules() {
    several::run(0..30, &Which::by_the_rules(2, true), None, None).assert_met();
    several::run(0..30, &Which::by_the_rules(3, false), None, None).assert_met();
}

#[test]
fn plans_made_again_and_again_keep_to_the_rules() {
    let noisy = How {
        noise: true,
        ..How::STEADY
    };
    let behaviour = Behaviour::Extreme;
    for (seeds, how) in [
        (0..10, How::STEADY),
        (0..10, How { off: 1.0, ..noisy }),
        (0..10, How { behaviour, ..noisy }),
        // own ship sails into the domain that its plan has reduced
        (277..278, How::STEADY),
    ] {
        replanning::run(seeds, &Meeting::NEAR, &how).assert_met();
    }
}

#[test]
fn plans_keep_off_land_and_targets_in_the_harbour() {
    harbour::run(0..30).assert_met();
}

#[test]
fn plans_on_paths_are_those_of_a_fine_grid() {
    path_time::run(0..700).assert_met();
}

#[test]
fn plans_by_forces_are_the_ships_and_clear_between_the_nodes() {
    forces::run_scenes(5).assert_met();
}

#[test]
fn no_random_start_finds_a_cheaper_plan_by_forces() {
    forces::run_starts(10).assert_met();
}

#[test]
fn a_scene_elsewhere_another_way_or_of_another_size_has_the_same_plan() {
    invariance::run(0..60).assert_met();
}

/// By A* the plan of scene 2 around ellipses is 6 % cheaper than that around the polytopes in them.
#[test]
fn asking_for_less_makes_no_plan_dearer() {
    asked::run(0..3).assert_met();
}

#[test]
fn wild_scenes_are_planned_and_verified_without_a_fault() {
    wild::run(1, 100, None, None).assert_met();
    wild::run(1, 200, Some("path-time"), None).assert_met();
}

#[test]
fn every_number_of_a_motion_and_its_figures_is_held() {
    mutations::run(120).assert_met();
}
