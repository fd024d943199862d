//! Every document of a simulation verifies: random missions in parts, with every behaviour, sensor
//! and vessel, at a risk, in a current, and under forces.

use std::fmt::Write;

use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use searoom::scenario::Scenario;
use searoom::simulation::Simulation;
use searoom::verification::{verify, verify_simulations};

use crate::campaigns::documents::scenario;

/// Number of simulations; the variable `SEAROOM_SIMULATIONS` asks for another.
const COUNT: u64 = 12;

/// One in so many is under forces, whose plans take the longest.
const FORCES: u64 = 12;

fn one<'a>(rng: &mut ChaCha8Rng, of: &[&'a str]) -> &'a str {
    of.choose(rng).expect("some")
}

/// A mission of three legs that lasts up to three horizons, among ships that cross it.
fn mission(seed: u64) -> String {
    let rng = &mut ChaCha8Rng::seed_from_u64(seed);
    let speed: f64 = rng.random_range(3.0..8.0);
    let leg = rng.random_range(400.0..900.0);
    let mut ways = vec![[0.0, 0.0]];
    for k in 1..4 {
        ways.push([leg * f64::from(k), rng.random_range(-0.3..0.3) * leg]);
    }
    let horizon = 3.0 * leg / speed * rng.random_range(0.35..1.4);
    let tracking_margin = if rng.random_bool(0.5) { 20.0 } else { 0.0 };
    let steered = tracking_margin > 0.0;
    let places = ways
        .iter()
        .map(|[x, y]| format!("{{ east_m = {x:?}, north_m = {y:?} }}"))
        .collect::<Vec<_>>()
        .join(", ");
    let length = *[15.0, 30.0, 90.0].choose(rng).expect("some");
    let mut text = format!(
        "title = \"{seed}\"\nhorizon_s = {horizon:?}\n[own_ship]\nposition = {{ east_m = 0.0, \
         north_m = 0.0 }}\ncourse_deg = 90.0\nspeed_mps = {speed:?}\nlength_m = {length:?}\n\
         beam_m = {:?}\nturning_radius_m = {:?}\nsafety_margin_m = {:?}\ntracking_margin_m = {:?}\n\
         [mission]\nwaypoints = [{places}]\n[planner]\ncompliance = \"{}\"\nmax_risk = {}\n\
         deadline_s = 2.0\n",
        length / 5.0,
        4.0 * length,
        tracking_margin + rng.random_range(0.0..2.0) * length,
        tracking_margin,
        one(rng, &["none", "shape", "rules"]),
        one(rng, &["0.0", "0.0", "0.3"]),
    );
    let sensor = one(
        rng,
        &[
            "exact\"",
            "radar\"",
            "ais\"",
            "ais\", latency_s = 2.0, dropout = { every_s = 100.0, lasts_s = 30.0 }",
        ],
    );
    for index in 0..rng.random_range(1..4) {
        let [x, y] = *ways[1..].choose(rng).expect("some");
        let time = rng.random_range(30.0..250.0);
        let course = rng.random_range(0.0..360.0_f64);
        let fast = rng.random_range(0.5..8.0);
        let place = [
            x - course.to_radians().sin() * fast * time,
            y - course.to_radians().cos() * fast * time,
        ];
        writeln!(
            text,
            "[[targets]]\nname = \"t{index}\"\nposition = {{ east_m = {:?}, north_m = {:?} }}\n\
             course_deg = {course:?}\nspeed_mps = {fast:?}\nlength_m = 80.0\nbeam_m = 15.0\n\
             speed_spread_mps = {}\ncourse_spread_deg = {}\nrepresentation = \"{}\"\n\
             behaviour = {{ kind = \"{}\" }}",
            place[0],
            place[1],
            one(rng, &["0.0", "0.4", "1.0"]),
            one(rng, &["0.0", "3.0", "12.0"]),
            one(rng, &["polytope", "polytope", "ellipsoid"]),
            one(rng, &["constant", "pursuit", "extremes", "mutual"]),
        )
        .expect("text grows");
        if sensor.starts_with("ais") && rng.random_bool(0.3) {
            text += "not_reported = [\"heading\"]\n";
        }
    }
    let vessel = match steered {
        true => one(rng, &["first-order", "nomoto"]),
        false => "kinematic",
    };
    let current = match steered && rng.random_bool(0.5) {
        true => "current = { speed_mps = 0.3, toward_deg = 10, std_mps = 0.05 }\n",
        false => "",
    };
    write!(
        text,
        "[simulation]\nreplan_s = {}\nreplan = \"{}\"\nvessel = {{ kind = \"{vessel}\" }}\n{current}\
         sensor = {{ kind = \"{sensor} }}\n",
        one(rng, &["10.0", "20.0", "20.0"]),
        one(rng, &["period", "events"]),
    )
    .expect("text grows");
    text
}

/// A ship under its own forces, whose target has another course.
fn forced(seed: u64) -> Scenario {
    let rng = &mut ChaCha8Rng::seed_from_u64(seed);
    let mut scene = scenario("forces/give-way.toml");
    if let searoom::target::Motion::Ship(ship) = &mut scene.targets[0].motion {
        ship.pose.position.y += rng.random_range(-60.0..60.0);
        ship.speed *= rng.random_range(0.9..1.1);
    }
    scene.simulation.duration = Some(400.0);
    scene
}

/// The documents of a simulation, and what is wrong with those that are rejected.
fn rejected(seed: u64) -> (usize, Vec<String>) {
    let scene = match seed % FORCES {
        0 => forced(seed),
        _ => Scenario::parse(&mission(seed)).expect("a scenario"),
    };
    let simulation = Simulation::keeping_plans(scene, false);
    let mut simulation = simulation.expect("a scenario for the loop");
    while !simulation.finished() {
        simulation.step();
    }
    let mut wrong = Vec::new();
    let mut note = |what: String| wrong.push(format!("seed {seed}: {what}"));
    for (index, plan) in simulation.plans().iter().enumerate() {
        let text = serde_json::to_string(plan).expect("a document");
        match verify(&text) {
            Ok(found) if found.verified() && plan.verified => {}
            Ok(found) if !found.verified() && !plan.verified => {
                note(format!("plan {index}: in both: {:?}", found.violations));
            }
            Ok(found) => note(format!("plan {index}: {:?}", found.violations)),
            Err(error) => note(format!("plan {index}: {error}")),
        }
    }
    let sailed = serde_json::to_string(&simulation.record()).expect("a document");
    match verify_simulations(&sailed) {
        Ok(found) if found[0].violations.is_empty() => {}
        Ok(found) => note(format!("simulation: {:?}", found[0].violations)),
        Err(error) => note(format!("simulation: {error}")),
    }
    (simulation.plans().len() + 1, wrong)
}

#[test]
fn every_document_of_random_simulations_verifies() {
    let count = std::env::var("SEAROOM_SIMULATIONS");
    let count = count.map_or(COUNT, |count| count.parse().expect("a number"));
    let all: Vec<(usize, Vec<String>)> = (0..count).into_par_iter().map(rejected).collect();
    let documents: usize = all.iter().map(|(documents, _)| documents).sum();
    let wrong: Vec<String> = all.into_iter().flat_map(|(_, wrong)| wrong).collect();
    println!(
        "{documents} documents of {count} simulations, {} rejected",
        wrong.len()
    );
    assert!(documents as u64 > 5 * count, "{documents}");
    assert!(wrong.is_empty(), "{} rejected: {wrong:#?}", wrong.len());
}
