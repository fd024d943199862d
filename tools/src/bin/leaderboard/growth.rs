//! How the planning time grows: with the targets, with the legs of the mission, and with the map.

use std::f64::consts::TAU;
use std::sync::Arc;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Pose, Vector};
use searoom::geometry::Polygon;
use searoom::map::Map;
use searoom::pipeline;
use searoom::scenario::{Compliance, Land, Scenario};
use searoom::target::{DomainKind, Motion, Representation, ShipTrack, Target};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::Hull;

use super::encounter_generator::{EncounterKind, Placement, random_encounter};
use super::quantile;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Scenes of each size.
pub const SCENES: u64 = 20;

/// Length of the mission in metres, its speed in m/s, and the horizon in seconds.
const LENGTH: f64 = 10_000.0;
const SPEED: f64 = 5.0;
const HORIZON: f64 = 3600.0;

/// Half-width in metres of the square with the targets. Own ship can meet most of them.
const WITHIN: f64 = 40_000.0;

/// Targets beside the legs, or beside the map.
const FEW: usize = 10;

/// Prints one row per size, and the exponent of the last factor of ten.
pub fn print(scenes: u64) -> Result<()> {
    println!(
        "
## Growth

A mission of 10 km among ships at random places and on random courses, up to 9 m/s, with spreads of
±0.3 m/s and ±5°, `compliance = \"none\"`, horizon one hour. They are in a square of 80 km, so own ship
can meet most of them. The legs, at most 100 in a file, are those of a winding river, among {FEW}
ships. The map is one ragged ring with a vertex every 30 m, beside the mission and {FEW} ships; reading
it is not part of the planning time. {scenes} scenes of each size. The exponent is that of the median
over the last factor of ten.

| of | number | verified plans | ms, median | ms, worst | exponent |
| --- | --- | --- | --- | --- | --- |"
    );
    type Build = fn(usize, u64) -> Result<Scenario>;
    let kinds: [(&str, &[usize], Build); 3] = [
        ("targets", &[1, 10, 100, 1000], among),
        ("legs", &[1, 10, 100], along),
        (
            "vertices of the map",
            &[100, 1000, 10_000, 100_000, 1_000_000],
            beside,
        ),
    ];
    for (name, sizes, build) in kinds {
        // a small sample has small sizes
        let most = if scenes < SCENES { 2 } else { sizes.len() };
        let mut before: Option<f64> = None;
        for &size in &sizes[..most] {
            let mut times = Vec::new();
            let mut planned = 0;
            for seed in 0..scenes {
                let run = pipeline::run(build(size, seed)?);
                planned += u32::from(run.evaluation.is_some_and(|e| e.verified()));
                times.push(run.plan_time.as_secs_f64() * 1e3);
            }
            let (median, worst) = (quantile(&mut times, 0.5), quantile(&mut times, 1.0));
            let exponent =
                before.map_or("–".to_owned(), |b| format!("{:.1}", (median / b).log10()));
            println!(
                "| {name} | {size} | {planned} of {scenes} | {median:.1} | {worst:.1} | {exponent} |"
            );
            before = Some(median);
        }
    }
    Ok(())
}

/// A scene with this many ships and one leg.
fn among(targets: usize, seed: u64) -> Result<Scenario> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let settings = random_encounter(EncounterKind::HeadOn, 0, Placement::Origin);
    let settings = settings.ok_or("no encounter")?.scenario;
    let end = Vector::new(LENGTH, 0.0);
    let target = |k| {
        let [east, north] = [0, 1].map(|_| rng.random_range(-WITHIN..WITHIN));
        let pose = Pose::new(
            0.5 * end + Vector::new(east, north),
            rng.random_range(0.0..TAU),
        );
        let ship = ShipTrack {
            speed_spread: 0.3,
            course_spread: 5_f64.to_radians(),
            domain: DomainKind::Hull,
            ..ShipTrack::exact(pose, rng.random_range(0.5..9.0), Hull::new(120.0, 20.0))
        };
        Target {
            name: format!("target {k}"),
            motion: Motion::Ship(ship),
            representation: Representation::Polytope,
            status: None,
        }
    };
    Ok(Scenario {
        title: format!("{targets} targets {seed}"),
        desired: DesiredTrajectory::new(&[Vector::zeros(), end], &[SPEED])?,
        targets: (0..targets).map(target).collect(),
        horizon: HORIZON,
        compliance: Compliance::None,
        ..settings
    })
}

/// A scene with this many legs, of a river that winds 300 m to either side.
fn along(legs: usize, seed: u64) -> Result<Scenario> {
    let waypoint = |k: usize| {
        let east = LENGTH * k as f64 / legs as f64;
        Vector::new(east, 300.0 * (TAU * 2.0 * east / LENGTH).sin())
    };
    let waypoints: Vec<Vector> = (0..=legs).map(waypoint).collect();
    Ok(Scenario {
        title: format!("{legs} legs {seed}"),
        desired: DesiredTrajectory::new(&waypoints, &vec![SPEED; legs])?,
        ..among(FEW, seed)?
    })
}

/// A scene with land of this many vertices, some 30 m apart. Its ragged coast is 2 km off the mission.
fn beside(vertices: usize, seed: u64) -> Result<Scenario> {
    let mean = 30.0 * vertices as f64 / TAU;
    let vertex = |k: usize| {
        let angle = TAU * k as f64 / vertices as f64;
        let waves = (0..5).map(|k| 50.0 * (1.7_f64.powi(k) * mean / 300.0 * angle).sin());
        let radius = mean + waves.sum::<f64>();
        Vector::new(angle.cos(), angle.sin()) * radius
    };
    let middle = Vector::new(0.5 * LENGTH, mean + 2000.0);
    let coast = (0..vertices).map(|k| middle + vertex(k)).collect();
    let land = Land {
        map: Arc::new(Map::new(vec![Polygon::new(&[coast])?])?),
        margin: 50.0,
    };
    Ok(Scenario {
        title: format!("{vertices} vertices {seed}"),
        land: Some(land),
        ..among(FEW, seed)?
    })
}
