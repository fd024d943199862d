//! Paths of many legs among many crossing ships, for the bench of the path-time planner and for a
//! test of its search.

use searoom_geometry::frame::{Pose, Vector, direction};
use searoom_geometry::{ConvexPolygon, outer_disc};
use searoom_model::trajectory::DesiredTrajectory;
use searoom_model::vessel::{Hull, OwnShip};
use searoom_sets::{Obstacle, PolytopeObstacle};

/// m/s.
pub const SPEED: f64 = 5.0;

/// Metres.
const LEG: f64 = 600.0;

pub struct Scene {
    pub own: OwnShip,
    pub desired: DesiredTrajectory,
    pub obstacles: Vec<Obstacle>,
    pub horizon: f64,
}

/// Ships that cross a path of `legs` legs, spread over it and over the time of twice the way.
pub fn scene(targets: usize, legs: usize) -> Scene {
    let mut points = vec![Vector::zeros()];
    for leg in 0..legs {
        let way = if leg % 2 == 0 { 0.35 } else { -0.35 };
        points.push(points[leg] + direction(way) * LEG);
    }
    let desired = DesiredTrajectory::new(&points, &vec![SPEED; legs]).expect("legs");
    let length = desired.length();
    let obstacles = (0..targets)
        .map(|i| {
            // as by the golden section, in place and in time
            let share = |step: f64| (0.31 + i as f64 * step) % 1.0;
            let met = desired.position_at(share(0.618_034) * length / SPEED);
            let time = 20.0 + share(0.754_878) * 1.9 * length / SPEED;
            let speed = 3.0 + (i % 5) as f64;
            let heading = 1.2 + 0.1 * (i % 7) as f64;
            let heading = if i % 2 == 0 { heading } else { -heading };
            let way = direction(heading);
            let start = met - way * (speed * time);
            let spread = direction(heading + 1.57) * 0.03;
            let fast = way * (speed + 0.05);
            let slow = way * (speed - 0.05);
            let velocity =
                ConvexPolygon::hull(&[fast + spread, fast - spread, slow]).expect("finite");
            let hull = Hull::new(40.0, 9.0).polygon(&Pose::new(start, heading));
            let initial = hull.minkowski_sum(&outer_disc(20.0, heading));
            PolytopeObstacle::new(format!("target {i}"), initial, velocity).into()
        })
        .collect();
    let first = points[1] - points[0];
    Scene {
        own: OwnShip {
            pose: Pose::new(points[0], first.y.atan2(first.x)),
            speed: SPEED,
            hull: Hull::new(20.0, 6.0),
            turning_radius: 50.0,
            speeds: vec![SPEED],
            safety_margin: 10.0,
            tracking_margin: 0.0,
        },
        desired,
        obstacles,
        horizon: 2.0 * length / SPEED,
    }
}
