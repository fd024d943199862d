//! Random scenes and their translated, rotated, reflected and scaled copies, which must have equal
//! plans.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use searoom::frame::{Pose, Vector, direction};
use searoom::pipeline;
use searoom::planner::PlannerSettings;
use searoom::scenario::{Compliance, Scenario};
use searoom::target::{Motion, Representation, ShipTrack, Target};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::{Hull, OwnShip};

use crate::campaigns::encounter_generator::{Placement, random_traffic};
use crate::campaigns::{Report, Seeds};

/// Cost in m². Smaller costs are equal if their difference is below a millionth of this.
pub const LEAST_COST: f64 = 1.0;

/// Placement and size of a scene.
#[derive(Debug, Clone, Copy)]
pub struct Placing {
    /// Description.
    pub name: &'static str,
    /// Translation in metres.
    pub moved: Vector,
    /// Rotation in radians.
    pub turned: f64,
    /// True if port and starboard are exchanged.
    pub mirrored: bool,
    /// Factors of lengths and times.
    pub length: f64,
    pub time: f64,
}

const fn placing(name: &'static str, moved: [f64; 2], turned: f64) -> Placing {
    Placing {
        name,
        moved: Vector::new(moved[0], moved[1]),
        turned,
        mirrored: false,
        length: 1.0,
        time: 1.0,
    }
}

const fn sized(name: &'static str, length: f64, time: f64) -> Placing {
    Placing {
        length,
        time,
        ..placing(name, [0.0; 2], 0.0)
    }
}

/// Placements that must not change a plan.
pub const PLACINGS: [Placing; 9] = [
    placing("moved by 1.6 km", [1234.5, -987.25], 0.0),
    placing("moved to UTM coordinates", [569_000.0, 7_034_000.0], 0.0),
    placing("turned by 90°", [0.0; 2], std::f64::consts::FRAC_PI_2),
    placing("turned by 142°", [0.0; 2], 2.48),
    Placing {
        mirrored: true,
        ..placing("mirrored", [0.0; 2], 0.0)
    },
    sized("three times as large", 3.0, 1.0),
    sized("a seventh as large", 1.0 / 7.0, 1.0),
    sized("2.3 times as slow", 1.0, 2.3),
    Placing {
        mirrored: true,
        length: 1.7,
        time: 0.6,
        ..placing("all of it", [-431_000.0, 6_210_000.0], -0.7)
    },
];

impl Placing {
    fn place(&self, v: Vector) -> Vector {
        let v = if self.mirrored {
            Vector::new(v.x, -v.y)
        } else {
            v
        };
        let (sin, cos) = self.turned.sin_cos();
        Vector::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y) * self.length + self.moved
    }

    fn pose(&self, pose: Pose) -> Pose {
        let hand = if self.mirrored { -1.0 } else { 1.0 };
        Pose::new(self.place(pose.position), hand * pose.heading + self.turned)
    }

    fn hull(&self, hull: Hull) -> Hull {
        Hull::new(hull.length * self.length, hull.beam * self.length)
    }

    /// Returns the scene with this placement.
    pub fn of(&self, scene: &Scenario) -> Scenario {
        let speed = self.length / self.time;
        let own = &scene.own_ship;
        let waypoints: Vec<Vector> = scene.desired.waypoints();
        let waypoints: Vec<Vector> = waypoints.into_iter().map(|w| self.place(w)).collect();
        let speeds: Vec<f64> = scene
            .desired
            .legs()
            .iter()
            .map(|l| l.speed * speed)
            .collect();
        let ship = |ship: &ShipTrack| ShipTrack {
            pose: self.pose(ship.pose),
            speed: ship.speed * speed,
            hull: self.hull(ship.hull),
            position_std: ship.position_std * self.length,
            speed_spread: ship.speed_spread * speed,
            ..ship.clone()
        };
        let target = |target: &Target| Target {
            motion: match &target.motion {
                Motion::Ship(track) => Motion::Ship(ship(track)),
                other => other.clone(),
            },
            ..target.clone()
        };
        Scenario {
            title: format!("{}, {}", scene.title, self.name),
            horizon: scene.horizon * self.time,
            own_ship: OwnShip {
                pose: self.pose(own.pose),
                speed: own.speed * speed,
                hull: self.hull(own.hull),
                turning_radius: own.turning_radius * self.length,
                speeds: own.speeds.iter().map(|u| u * speed).collect(),
                safety_margin: own.safety_margin * self.length,
                tracking_margin: 0.0,
            },
            desired: DesiredTrajectory::new(&waypoints, &speeds).expect("a path"),
            targets: scene.targets.iter().map(target).collect(),
            time_weight: scene.time_weight * speed * speed,
            settings: PlannerSettings {
                tidiness: scene.settings.tidiness.scaled(self.time),
                ..scene.settings
            },
            ..scene.clone()
        }
    }

    /// Plan cost of the placed scene at the original size, in m²; `None` without a plan.
    pub fn cost(&self, scene: &Scenario) -> Option<f64> {
        Some(cost(self.of(scene))? / (self.length * self.length))
    }
}

/// Plan cost of a scene in m²; `None` without an unrelaxed plan.
pub fn cost(scene: Scenario) -> Option<f64> {
    let run = pipeline::run(scene);
    let judged = run.evaluation.as_ref()?;
    assert!(
        judged.verified(),
        "{}: {:?}",
        run.scenario.title,
        judged.violations
    );
    let plan = run.planned.outcome.plan()?;
    run.relaxations.is_empty().then_some(plan.cost)
}

/// Random path of one to three legs and one to four targets, each of which would meet own ship on
/// it. In every second group of four scenes the targets are ellipsoids.
pub fn scene(seed: u64) -> Scenario {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let speed = rng.random_range(4.0..8.0);
    let mut waypoints = vec![Vector::zeros()];
    let mut heading: f64 = 0.0;
    for _ in 0..rng.random_range(1..4) {
        let last = waypoints[waypoints.len() - 1];
        waypoints.push(last + direction(heading) * rng.random_range(2000.0..5000.0));
        heading += rng.random_range(-0.6..0.6);
    }
    let desired = DesiredTrajectory::new(&waypoints, &vec![speed; waypoints.len() - 1]);
    let desired = desired.expect("a path");
    let representation =
        [Representation::Polytope, Representation::Ellipsoid][(seed / 4 % 2) as usize];
    let mut targets = Vec::new();
    while targets.len() as u64 <= seed % 4 {
        let time = desired.duration() * rng.random_range(0.2..0.8);
        let course: f64 = rng.random_range(-3.1..3.1);
        let miss = direction(rng.random_range(-3.1..3.1)) * rng.random_range(0.0..200.0);
        let pace = speed * rng.random_range(0.4..1.4);
        let start = desired.position_at(time) + miss - direction(course) * (pace * time);
        let length = rng.random_range(30.0..150.0);
        let ship = ShipTrack {
            position_std: rng.random_range(0.0..8.0),
            speed_spread: rng.random_range(0.0..0.2),
            course_spread: rng.random_range(0.0..0.07),
            ..ShipTrack::exact(
                Pose::new(start, course),
                pace,
                Hull::new(length, length / 5.0),
            )
        };
        if start.norm() > 1000.0 {
            targets.push(Target {
                name: format!("target {}", targets.len() + 1),
                motion: Motion::Ship(ship),
                representation,
                status: None,
            });
        }
    }
    Scenario {
        title: format!("scene {seed}"),
        horizon: 2.0 * desired.duration(),
        own_ship: OwnShip {
            pose: Pose::new(Vector::zeros(), 0.0),
            speed,
            hull: Hull::new(100.0, 20.0),
            turning_radius: rng.random_range(100.0..400.0),
            speeds: vec![0.5 * speed, speed, 1.2 * speed],
            safety_margin: rng.random_range(30.0..150.0),
            tracking_margin: 0.0,
        },
        desired,
        targets,
        compliance: Compliance::None,
        time_weight: speed * speed,
        deadline: 600.0,
        ..random_traffic(0, 0, Placement::Origin)
            .expect("drawn")
            .scenario
    }
}

/// Relative difference of two costs; 1 if only one exists.
pub fn apart(a: Option<f64>, b: Option<f64>) -> f64 {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() / a.max(b).max(LEAST_COST),
        (None, None) => 0.0,
        _ => 1.0,
    }
}

/// Relative difference below which costs are equal, and nearly equal.
pub const EQUAL: f64 = 1e-6;
const NEARLY: f64 = 0.01;

/// Prints a table: invariance of plans to translation, rotation, reflection and scaling. Requires
/// 99 % of the placed scenes to have the plan's cost, and all of them nearly.
pub fn run(seeds: Seeds) -> Report {
    let mut report = Report::default();
    let scenes: Vec<(u64, Scenario, Option<f64>)> = seeds
        .into_par_iter()
        .map(|seed| (seed, scene(seed), cost(scene(seed))))
        .collect();
    let planned = scenes.iter().filter(|s| s.2.is_some()).count();
    println!("{} scenes, {planned} with a plan\n", scenes.len());
    println!("| the scene | J equal to 1e-6 | J equal to 1 % | J over J, least | most |");
    println!("| --- | --- | --- | --- | --- |");
    for placing in PLACINGS {
        let found: Vec<_> = scenes
            .par_iter()
            .map(|(seed, scene, cost)| (*seed, *cost, placing.cost(scene)))
            .collect();
        let within = |most: f64| found.iter().filter(|f| apart(f.1, f.2) <= most).count();
        let ratios = found.iter().filter_map(|f| Some(f.2? / f.1?));
        let (least, most) = ratios.fold((f64::INFINITY, 0.0), |(least, most), r| {
            (f64::min(least, r), f64::max(most, r))
        });
        let (name, equal, nearly) = (placing.name, within(EQUAL), within(NEARLY));
        println!("| {name} | {equal} | {nearly} | {least:.6} | {most:.6} |");
        for (seed, before, after) in &found {
            report.require(apart(*before, *after) <= NEARLY, || {
                format!("{name}: scene {seed}: {before:?} {after:?}")
            });
        }
        report.require(100 * equal >= 99 * found.len(), || {
            format!("{name}: only {equal} are equal")
        });
    }
    let conflicts = scenes
        .iter()
        .filter(|s| s.2.is_some_and(|cost| cost > LEAST_COST));
    let conflicts = conflicts.count();
    report.require(6 * conflicts >= 5 * scenes.len(), || {
        format!("{conflicts} scenes have a conflict")
    });
    report
}
