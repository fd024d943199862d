//! Random scenes of the path-time planner, as files: paths on a coarse grid that share places, come
//! back to their own, cross and lie on one another, tiny legs, ships over the start and over the
//! end.

use std::fmt::Write;

use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Metres.
type Place = (f64, f64);

fn places(rng: &mut ChaCha8Rng, first: Place, count: usize) -> Vec<Place> {
    let mut path = vec![first];
    while path.len() < count {
        let last = path[path.len() - 1];
        let mut next = (
            *[0.0, 200.0, 400.0, 600.0].choose(rng).expect("some"),
            *[0.0, 150.0, 300.0].choose(rng).expect("some"),
        );
        if rng.random_bool(0.05) {
            let tiny = *[1e-5, 1e-3, 0.1].choose(rng).expect("some");
            next = (last.0, last.1 + tiny);
        } else if rng.random_bool(0.1) {
            next = (rng.random_range(0.0..600.0), rng.random_range(0.0..300.0));
        }
        if next != last {
            path.push(next);
        }
    }
    path
}

fn list(path: &[Place]) -> String {
    let place = |p: &Place| format!("{{ east_m = {:?}, north_m = {:?} }}", p.0, p.1);
    let places: Vec<String> = path.iter().map(place).collect();
    format!("[{}]", places.join(", "))
}

/// A scenario file.
pub fn draw(seed: u64) -> String {
    let rng = &mut ChaCha8Rng::seed_from_u64(seed);
    let count = rng.random_range(2..6);
    let mut main = places(rng, (0.0, 0.0), count);
    if rng.random_bool(0.1) {
        main.push((0.0, 0.0));
    }
    let length: f64 = (main.windows(2))
        .map(|w| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1))
        .sum();
    let alternatives: Vec<String> = (0..rng.random_range(0..3))
        .map(|_| {
            let first = *main.choose(rng).expect("some");
            let count = rng.random_range(2..6);
            let mut path = places(rng, first, count);
            if rng.random_bool(0.7) {
                path.push(*main.choose(rng).expect("some"));
            }
            list(&path)
        })
        .collect();
    let speed = *[2.0, 5.0, 12.0].choose(rng).expect("some");
    let horizon = length / speed * rng.random_range(1.0..4.0);
    let mut text = format!(
        "title = \"network {seed}\"\nhorizon_s = {horizon:?}\n\n[own_ship]\nposition = {{ east_m = 0.0, north_m = 0.0 }}\n\
         course_deg = {:?}\nspeed_mps = {speed:?}\nlength_m = 10.0\nbeam_m = 4.0\nturning_radius_m = 20.0\n\
         safety_margin_m = {:?}\n\n[mission]\nwaypoints = {}\n",
        [0.0, 45.0, 90.0].choose(rng).expect("some"),
        [0.0, 5.0, 20.0].choose(rng).expect("some"),
        list(&main),
    );
    if !alternatives.is_empty() {
        writeln!(text, "alternatives = [{}]", alternatives.join(", ")).expect("a string");
    }
    let objective = [
        "objective = \"space-time-error\"",
        "objective = \"space-time-error\"",
        "objective = \"time\"",
        "objective = \"length\"",
        "objective = \"length-risk\"\nrisk_weight_m = 100.0\nmax_risk = 0.3",
    ];
    writeln!(
        text,
        "\n[planner]\nkind = \"path-time\"\ndeadline_s = 2.0\n{}\ncompliance = {:?}",
        objective.choose(rng).expect("some"),
        ["none", "shape"].choose(rng).expect("some"),
    )
    .expect("a string");
    for target in 0..rng.random_range(0..5) {
        let end = main[main.len() - 1];
        let near = match rng.random_range(0..6) {
            0 => (0.0, 0.0),
            1 => end,
            _ => (
                rng.random_range(-100.0..700.0),
                rng.random_range(-100.0..400.0),
            ),
        };
        let stopped = rng.random_bool(0.3);
        let fast = if stopped {
            0.0
        } else {
            rng.random_range(0.5..8.0)
        };
        let spread = if rng.random_bool(0.5) {
            0.0
        } else {
            rng.random_range(0.0..1.0)
        };
        writeln!(
            text,
            "\n[[targets]]\nname = \"t{target}\"\nposition = {{ east_m = {:?}, north_m = {:?} }}\ncourse_deg = {:?}\n\
             speed_mps = {fast:?}\nlength_m = {:?}\nbeam_m = 6.0\nspeed_spread_mps = {spread:?}\ncourse_spread_deg = {:?}\n\
             position_std_m = {:?}\nrepresentation = {:?}",
            near.0 + rng.random_range(-5.0..5.0),
            near.1 + rng.random_range(-5.0..5.0),
            rng.random_range(0..24) * 15,
            [8.0, 30.0, 100.0].choose(rng).expect("some"),
            spread * 5.0,
            [0.0, 0.0, 3.0].choose(rng).expect("some"),
            ["polytope", "polytope", "ellipsoid"].choose(rng).expect("some"),
        )
        .expect("a string");
        if rng.random_bool(0.1) {
            writeln!(text, "turn_rate_deg_per_s = 0.3").expect("a string");
        }
    }
    text
}
