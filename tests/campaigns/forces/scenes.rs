//! Scenes of the optimal-control planner: figure 9, and random ones with every ellipsoid aimed at
//! own ship's way.
#![allow(dead_code, reason = "tests and benches use a part each")]

use std::f64::consts::PI;
use std::time::Duration;

use nalgebra::Matrix2;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Pose, Vector, direction};
use searoom::geometry::Ellipse;
use searoom::obstacle::{EllipsoidObstacle, Obstacle};
use searoom::planner::optimal_control::{Controls, KeepOut, Profile, Task, profile_along};
use searoom::planner::{ControlSettings, Problem};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::{CyberShip2, Hull, Manoeuvring, OwnShip, StateVector, VesselKind};

/// Seconds, of every scene.
pub const DURATION: f64 = 100.0;

/// From (0, 0) to (20, 10) in 100 s.
pub fn desired() -> DesiredTrajectory {
    let points = [Vector::zeros(), Vector::new(20.0, 10.0)];
    DesiredTrajectory::new(&points, &[500.0_f64.sqrt() / DURATION]).expect("valid")
}

/// Position, velocity and the diagonals of both shape matrices, metres and m/s.
pub fn ellipsoid(
    place: [f64; 2],
    velocity: [f64; 2],
    shape: [f64; 2],
    spread: [f64; 2],
) -> KeepOut {
    let ellipse = |center: [f64; 2], q: [f64; 2]| {
        let shape = Matrix2::new(q[0], 0.0, 0.0, q[1]);
        Ellipse::new(Vector::new(center[0], center[1]), shape).expect("a shape")
    };
    let set = EllipsoidObstacle::new("target", ellipse(place, shape), ellipse(velocity, spread));
    KeepOut::outer_of(&set.into())
}

/// The three ellipsoids of `scenarios/paper/figure_9.toml`.
pub fn figure_9() -> Vec<KeepOut> {
    vec![
        ellipsoid([9.0, -3.0], [-0.1, 0.2], [1.0, 0.36], [4e-4, 4e-4]),
        ellipsoid([20.0, 8.0], [-0.15, -0.04], [1.0, 0.36], [4e-4, 1e-4]),
        ellipsoid([13.0, 6.5], [0.03, 0.02], [0.64, 0.64], [2.25e-4, 2.25e-4]),
    ]
}

/// Ellipsoids that each meet own ship on its way, or miss it by less than a metre, and are clear of
/// its start.
pub fn random_ellipsoids(count: usize, rng: &mut ChaCha8Rng) -> Vec<KeepOut> {
    let desired = desired();
    let mut found = Vec::new();
    while found.len() < count {
        let time = rng.random_range(15.0..90.0);
        let miss = Vector::new(rng.random_range(-0.7..0.7), rng.random_range(-0.7..0.7));
        let velocity = direction(rng.random_range(-PI..PI)) * rng.random_range(0.0..0.3);
        let place = desired.position_at(time) + miss - velocity * time;
        let square = |low: f64, high: f64, rng: &mut ChaCha8Rng| {
            [0, 1].map(|_| rng.random_range(low..high).powi(2))
        };
        let shape = square(0.5, 1.2, rng);
        let spread = square(0.0, 0.025, rng);
        let set = ellipsoid(place.into(), velocity.into(), shape, spread);
        if set.at(0.0).level(Vector::zeros()) > 4.0 {
            found.push(set);
        }
    }
    found
}

/// As many scenes, always the same.
pub fn random_scenes(scenes: usize, count: usize) -> Vec<Vec<KeepOut>> {
    let mut rng = ChaCha8Rng::seed_from_u64(count as u64);
    (0..scenes)
        .map(|_| random_ellipsoids(count, &mut rng))
        .collect()
}

/// CyberShip II from rest on course, with the default weights.
pub fn task<'a>(
    desired: &'a DesiredTrajectory,
    keep_outs: &'a [KeepOut],
    intervals: usize,
) -> Task<'a, CyberShip2> {
    let settings = ControlSettings::of(VesselKind::CyberShip2);
    Task {
        vessel: &CyberShip2::SMOOTH,
        controls: Controls::from(&settings),
        desired,
        keep_outs,
        first: StateVector::new(0.0, 0.0, 0.0, 0.2, 0.0, 0.0),
        duration: DURATION,
        intervals,
    }
}

/// As the task starts, a point.
pub fn own_ship() -> OwnShip {
    OwnShip {
        pose: Pose::new(Vector::zeros(), 0.0),
        speed: 0.2,
        hull: Hull::new(0.0, 0.0),
        turning_radius: 2.0,
        speeds: vec![0.1, 0.2, 0.24],
        safety_margin: 0.0,
        tracking_margin: 0.0,
    }
}

/// The whole of what the planner is asked.
pub fn problem<'a>(
    own: &'a OwnShip,
    desired: &'a DesiredTrajectory,
    obstacles: &'a [Obstacle],
) -> Problem<'a> {
    Problem {
        time_weight: 0.05,
        deadline: Duration::from_secs(600),
        ..Problem::new(own, desired, obstacles, DURATION)
    }
}

/// Straight along the desired trajectory, through every set.
pub fn straight(task: &Task<CyberShip2>) -> Profile {
    let place = |k| task.desired.position_at(task.time(k));
    profile_along(task, &(0..=task.intervals).map(place).collect::<Vec<_>>())
}

/// Largest amplitude of a wave of a wandering way, as a fraction of the intended length.
const WAVE: f64 = 0.18;

/// A way that wanders to the sides in three waves, as far as a third of its length, at a pace that
/// varies.
pub fn wandering<V: Manoeuvring>(task: &Task<V>, rng: &mut ChaCha8Rng) -> Profile {
    let waves: [f64; 3] = std::array::from_fn(|_| rng.random_range(-WAVE..WAVE));
    let pace = rng.random_range(-0.15..0.15);
    let way = task.desired.position_at(task.duration) - task.desired.position_at(0.0);
    let aside = Vector::new(-way.y, way.x);
    let places: Vec<Vector> = (0..=task.intervals)
        .map(|k| {
            let part = k as f64 / task.intervals as f64;
            let bow = |n: f64| (PI * n * part).sin();
            let along = (part + pace * bow(1.0)) * task.duration;
            let off = waves[0] * bow(1.0) + waves[1] * bow(2.0) + 0.5 * waves[2] * bow(3.0);
            task.desired.position_at(along) + aside * off
        })
        .collect();
    profile_along(task, &places)
}
