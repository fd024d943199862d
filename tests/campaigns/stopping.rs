//! Scenes that stopping solves: ships at rest close ahead, canals, closed basins, short horizons.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use searoom::frame::{Pose, Vector, direction};
use searoom::geometry::Polygon;
use searoom::map::Map;
use searoom::pipeline::{self, Run};
use searoom::planner::path_time::PathTimePlanner;
use searoom::scenario::{Compliance, Land, Scenario};
use searoom::target::{Motion, Representation, ShipTrack, Target};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::{Hull, OwnShip};

use super::documents::unhurried;
use super::encounter_generator::{Placement, random_traffic};
use super::{Report, Seeds};

const COMPLIANCES: [Compliance; 3] = [Compliance::None, Compliance::Shape, Compliance::Rules];

/// Fractions of the desired speed at which own ship may sail.
const SPEEDS: [&[f64]; 5] = [
    &[0.0, 0.5, 1.0],
    &[0.0, 1.0],
    &[0.0, 1.0, 1.2],
    &[0.0, 0.25, 0.5, 1.0],
    &[0.0, 0.3, 0.6, 0.8, 1.0, 1.3],
];

/// Own ship at the origin, on a straight path to the east, without targets.
fn alone(title: String, length: f64, way: f64, rng: &mut ChaCha8Rng) -> Scenario {
    let hull = Hull::new(length, 0.2 * length);
    let speed = rng.random_range(2.5..7.0);
    let speeds = SPEEDS.choose(rng).expect("some");
    let path = [Vector::zeros(), Vector::new(way, 0.0)];
    let desired = DesiredTrajectory::new(&path, &[speed]).expect("a path");
    Scenario {
        title,
        horizon: rng.random_range(1.05..2.5) * desired.duration(),
        own_ship: OwnShip {
            pose: Pose::new(Vector::zeros(), 0.0),
            speed,
            hull,
            turning_radius: rng.random_range(1.8..4.0) * length,
            speeds: speeds.iter().map(|share| share * speed).collect(),
            safety_margin: rng.random_range(0.2..1.0) * length,
            tracking_margin: 0.0,
        },
        desired,
        targets: Vec::new(),
        time_weight: speed * speed,
        compliance: *COMPLIANCES.choose(rng).expect("some"),
        ..unhurried(
            random_traffic(0, 0, Placement::Origin)
                .expect("drawn")
                .scenario,
        )
    }
}

fn ship(name: usize, pose: Pose, speed: f64, hull: Hull, spreads: [f64; 2]) -> Target {
    let [speed_spread, course_spread] = spreads;
    Target {
        name: format!("target {name}"),
        motion: Motion::Ship(ShipTrack {
            speed_spread,
            course_spread,
            ..ShipTrack::exact(pose, speed, hull)
        }),
        representation: Representation::Polytope,
        status: None,
    }
}

/// A ship at rest 160 to 400 m ahead, athwart the path more or less.
pub fn at_rest_ahead(seed: u64) -> Scenario {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let length = rng.random_range(30.0..90.0);
    let mut scenario = alone(format!("at rest ahead {seed}"), length, 3000.0, &mut rng);
    let hull = Hull::new(rng.random_range(60.0..250.0), rng.random_range(12.0..35.0));
    let place = Vector::new(
        rng.random_range(160.0..400.0),
        rng.random_range(-40.0..40.0),
    );
    let pose = Pose::new(place, rng.random_range(-3.1..3.1));
    scenario.targets = vec![ship(0, pose, 0.0, hull, [0.0, 0.0])];
    scenario
}

/// A canal with the path in its middle, or a basin with a gap; ships at rest, oncoming, ahead on the
/// same course, and crossing.
pub fn between_land(seed: u64) -> Scenario {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let length = rng.random_range(15.0..50.0);
    let mut scenario = alone(format!("canal {seed}"), length, 2500.0, &mut rng);
    let half = rng.random_range(0.8..3.0) * length + 10.0;
    let gap = match seed % 3 {
        0 => rng.random_range(0.6..1.0) * half,
        _ => half,
    };
    let bank = |from: [f64; 2], to: [f64; 2]| {
        let [[a, b], [c, d]] = [from, to];
        let corners = [(a, b), (c, b), (c, d), (a, d)];
        Polygon::new(&[corners.map(|(x, y)| Vector::new(x, y)).to_vec()]).expect("a bank")
    };
    let mut land = Vec::new();
    for side in [-1.0, 1.0] {
        let [near, far] = [half * side, 600.0 * side];
        land.push(bank([-400.0, near.min(far)], [3000.0, near.max(far)]));
        if gap < half {
            let [near, far] = [gap * side, (half + 1.0) * side];
            land.push(bank([900.0, near.min(far)], [960.0, near.max(far)]));
        }
    }
    scenario.land = Some(Land {
        map: Arc::new(Map::new(land).expect("land")),
        margin: rng.random_range(0.0..0.15) * length,
    });
    for name in 0..rng.random_range(1..3) {
        let hull = Hull::new(rng.random_range(0.8..3.0) * length, 0.2 * length);
        let spreads = [rng.random_range(0.0..0.2), rng.random_range(0.0..0.03)];
        let aside = rng.random_range(-0.6..0.6) * half;
        let [pose, speed] = match rng.random_range(0..4) {
            0 => [
                (rng.random_range(250.0..1800.0), aside, 0.0),
                (0.0, 0.0, 0.0),
            ],
            1 => [
                (rng.random_range(700.0..2500.0), aside, PI),
                (2.0, 0.0, 0.0),
            ],
            2 => [
                (rng.random_range(200.0..900.0), aside, 0.0),
                (1.0, 0.0, 0.0),
            ],
            _ => [
                (rng.random_range(300.0..1800.0), half, -FRAC_PI_2),
                (0.5, 0.0, 0.0),
            ],
        };
        let (x, y, heading) = pose;
        let pose = Pose::new(Vector::new(x, y), heading);
        let target = ship(name, pose, speed.0, hull, spreads);
        scenario.targets.push(target);
    }
    scenario
}

/// One to three ships that come near the path, and a horizon that is often too short to pass them.
pub fn among_ships(seed: u64) -> Scenario {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let length = rng.random_range(20.0..100.0);
    let mut scenario = alone(format!("among ships {seed}"), length, 2000.0, &mut rng);
    let duration = scenario.desired.duration();
    scenario.horizon = rng.random_range(1.02..1.5) * duration;
    for name in 0..rng.random_range(1..4) {
        let hull = Hull::new(rng.random_range(10.0..200.0), rng.random_range(4.0..30.0));
        let speed = rng.random_range(0.0..12.0);
        let course = rng.random_range(-3.1..3.1);
        let time = rng.random_range(0.2..0.8) * duration;
        let near = scenario.desired.position_at(time);
        let aside = Vector::new(rng.random_range(-60.0..60.0), rng.random_range(-60.0..60.0));
        let pose = Pose::new(near + aside - direction(course) * (speed * time), course);
        let spreads = [rng.random_range(0.0..1.5), rng.random_range(0.0..0.09)];
        let target = ship(name, pose, speed, hull, spreads);
        scenario.targets.push(target);
    }
    scenario
}

fn along_the_path(scenario: &Scenario) -> Run {
    pipeline::run(Scenario {
        planner: &PathTimePlanner,
        ..scenario.clone()
    })
}

/// Where the plan of a scene is unsafe, that along its path is unsafe, too. `scene` seeds of each
/// kind.
pub fn run(seeds: Seeds) -> Report {
    let mut report = Report::default();
    for (name, draw) in [
        ("at rest ahead", at_rest_ahead as fn(u64) -> Scenario),
        ("between land", between_land),
        ("among ships", among_ships),
    ] {
        let seeds = seeds.clone().into_par_iter();
        let runs: Vec<(u64, Run)> = (seeds)
            .map(|seed| (seed, pipeline::run(draw(seed))))
            .collect();
        let planned = |run: &Run| run.planned.outcome.plan().is_some();
        let of = |is: &dyn Fn(&Run) -> bool| {
            let found = runs.iter().filter(|(_, run)| is(run));
            found.map(|(seed, _)| *seed).collect::<Vec<u64>>()
        };
        let unverified = of(&|run| !run.evaluation.as_ref().is_none_or(|e| e.verified()));
        let unplanned = of(&|run| !planned(run));
        let short = of(&|run| planned(run) && run.safe() && !run.arrives());
        let unsafe_plans = of(&|run| planned(run) && !run.safe());
        let missed: Vec<u64> = (unsafe_plans.par_iter().copied())
            .filter(|seed| along_the_path(&draw(*seed)).safe())
            .collect();
        let all = runs.len();
        println!(
            "{name}: {all} scenes, {} without a plan, {} safe short of the end, {} unsafe",
            unplanned.len(),
            short.len(),
            unsafe_plans.len()
        );
        report.at_most(name, "not verified", 0.0, &unverified, all);
        report.at_most(name, "unsafe, but safe along the path", 0.0, &missed, all);
        report.require(20 * short.len() >= all, || {
            format!("{name}: only {} of {all} end short", short.len())
        });
    }
    lawful_by_stops(seeds);
    report
}

/// Prints how many scenes among ships are planned by the rules with stops and without them.
fn lawful_by_stops(seeds: Seeds) {
    let all = seeds.clone().into_par_iter();
    let lawful = all.map(|seed| {
        let scenario = Scenario {
            compliance: Compliance::Rules,
            ..among_ships(seed)
        };
        let mut moving = scenario.clone();
        moving.own_ship.speeds.retain(|speed| *speed > 0.0);
        [scenario, moving].map(|scenario| {
            let run = pipeline::run(scenario);
            run.planned.outcome.plan().is_some() && run.relaxations.is_empty()
        })
    });
    let lawful: Vec<[bool; 2]> = lawful.collect();
    let of = |which: fn(&[bool; 2]) -> bool| lawful.iter().filter(|l| which(l)).count();
    println!(
        "among ships, by the rules: {} of {} solved, {} of them only with a stop, {} only without",
        of(|l| l[0]),
        lawful.len(),
        of(|l| l[0] && !l[1]),
        of(|l| l[1] && !l[0]),
    );
}
