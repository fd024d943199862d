//! Each campaign with few scenes; `cargo campaign` runs more.

use crate::campaigns::closed_loop::replanning::{self, Behaviour, How};
use crate::campaigns::encounter_generator::Meeting;
use crate::campaigns::plans::{
    asked, compliance, encounters, harbour, invariance, mutations, tidiness,
};
use crate::campaigns::{dense_search, forces, path_time, wild};

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
    compliance::run(0..60, &Meeting::NEAR, None).assert_met();
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
