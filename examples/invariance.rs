//! Prints two tables: invariance of plans to translation, rotation and scaling of a scene, and
//! cases where larger sets reduce the cost.
//!
//! ```text
//! cargo run --release --no-default-features --example invariance [SCENES]
//! ```

#[path = "shared/moved.rs"]
mod moved;

use moved::{PLACINGS, apart, cost, scene};
use rayon::prelude::*;
use searoom::scenario::Scenario;
use searoom::target::Motion;

/// Relative difference below which costs are equal.
const EQUAL: f64 = 1e-6;

/// Change that enlarges the sets.
type Change = fn(&mut Scenario);
const LARGER: [(&str, Change); 4] = [
    ("margin + 20 m", |s| s.own_ship.safety_margin += 20.0),
    ("speed spread + 0.1 m/s", |s| {
        tracks(s, |ship| ship.speed_spread += 0.1);
    }),
    ("course spread + 0.02 rad", |s| {
        tracks(s, |ship| ship.course_spread += 0.02);
    }),
    ("position deviation + 4 m", |s| {
        tracks(s, |ship| ship.position_std += 4.0);
    }),
];

/// Number of scenes tested with larger sets, from the first.
const OF_LARGER: u64 = 60;

fn tracks(scene: &mut Scenario, change: impl Fn(&mut searoom::target::ShipTrack)) {
    for target in &mut scene.targets {
        if let Motion::Ship(ship) = &mut target.motion {
            change(ship);
        }
    }
}

fn main() {
    let count = std::env::args().nth(1).and_then(|n| n.parse().ok());
    let count: u64 = count.unwrap_or(300);
    let scenes: Vec<(Scenario, Option<f64>)> = (0..count)
        .into_par_iter()
        .map(|seed| (scene(seed), cost(scene(seed))))
        .collect();
    let planned = scenes.iter().filter(|s| s.1.is_some()).count();
    println!("{count} scenes, {planned} with a plan\n");
    println!("| the same scene | J equal to 1e-6 | J equal to 1 % | J over J, least | most |");
    println!("| --- | --- | --- | --- | --- |");
    for placing in PLACINGS {
        let found: Vec<_> = scenes
            .par_iter()
            .map(|(scene, cost)| (*cost, placing.cost(scene)))
            .collect();
        let within = |most: f64| found.iter().filter(|f| apart(f.0, f.1) <= most).count();
        let ratios = found.iter().filter_map(|f| Some(f.1? / f.0?));
        let (least, most) = ratios.fold((f64::INFINITY, 0.0), |(least, most), r| {
            (f64::min(least, r), f64::max(most, r))
        });
        println!(
            "| {} | {} | {} | {least:.6} | {most:.6} |",
            placing.name,
            within(EQUAL),
            within(0.01)
        );
        for (seed, f) in found.iter().enumerate() {
            if apart(f.0, f.1) > EQUAL {
                eprintln!("{}: scene {seed}: {:?} {:?}", placing.name, f.0, f.1);
            }
        }
    }
    println!("\n| larger sets | comparisons | cheaper | with one target | J over J, least |");
    println!("| --- | --- | --- | --- | --- |");
    for (name, change) in LARGER {
        let compared: Vec<(usize, f64)> = scenes
            .par_iter()
            .take(OF_LARGER as usize)
            .enumerate()
            .filter_map(|(seed, (scene, before))| {
                let mut larger = scene.clone();
                change(&mut larger);
                let (before, after) = ((*before)?, cost(larger)?);
                Some((
                    seed,
                    (after + moved::LEAST_COST) / (before + moved::LEAST_COST),
                ))
            })
            .collect();
        let cheaper = compared.iter().filter(|c| c.1 < 1.0 - EQUAL);
        let least = compared.iter().map(|c| c.1).fold(f64::INFINITY, f64::min);
        println!(
            "| {name} | {} | {} | {} | {least:.4} |",
            compared.len(),
            cheaper.clone().count(),
            cheaper
                .clone()
                .filter(|c| scenes[c.0].0.targets.len() == 1)
                .count()
        );
        for (seed, ratio) in cheaper {
            eprintln!("{name}: scene {seed}: {ratio:.6}");
        }
    }
}
