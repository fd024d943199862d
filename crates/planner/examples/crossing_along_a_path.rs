//! When does a ferry that keeps to its path cross a fairway with two ships? The path-time planner
//! finds the earliest arrival for several greatest speeds: before, between or after the ships.
//!
//! ```text
//! cargo run -p searoom-planner --example crossing_along_a_path
//! ```

use std::f64::consts::FRAC_PI_2;

use searoom_geometry::frame::{Pose, Vector};
use searoom_geometry::{ConvexPolygon, outer_disc};
use searoom_model::trajectory::{DesiredTrajectory, TrajectoryError};
use searoom_model::vessel::{Hull, OwnShip};
use searoom_planner::{Objective, Problem, path_time};
use searoom_sets::{Obstacle, PolytopeObstacle};

/// Length of the path in metres; the fairway crosses its middle.
const LENGTH: f64 = 1200.0;

fn main() -> Result<(), TrajectoryError> {
    let path = [Vector::zeros(), Vector::new(0.0, LENGTH)];
    // discs of 100 m that contain the ferry's hull and its margin; eastward at 4.5 to 5.5 m/s
    let ship = |name: &str, east: f64| -> Obstacle {
        let initial = outer_disc(100.0, 0.0).translated(Vector::new(east, 0.5 * LENGTH));
        let velocities = ConvexPolygon::rectangle(Vector::new(5.0, 0.0), 0.5, 0.0);
        PolytopeObstacle::new(name, initial, velocities).into()
    };
    let fairway = [ship("tanker", -600.0), ship("trawler", -1500.0)];
    for speed in [2.0, 3.0, 5.0, 8.0] {
        let own = OwnShip {
            pose: Pose::new(path[0], FRAC_PI_2),
            speed,
            hull: Hull::new(40.0, 12.0),
            turning_radius: 60.0,
            speeds: vec![speed],
            safety_margin: 30.0,
            tracking_margin: 0.0,
        };
        let desired = DesiredTrajectory::new(&path, &[speed])?;
        let planned = path_time::plan(&Problem {
            objective: Objective::Time,
            ..Problem::new(&own, &desired, &fairway, 1200.0)
        });
        let arrival = planned
            .outcome
            .plan()
            .map(|plan| plan.trajectory.end_time());
        let Some((arrival, diagram)) = arrival.zip(planned.path_time) else {
            println!("at most {speed} m/s: no crossing");
            continue;
        };
        println!(
            "at most {speed} m/s: arrives at {arrival:.0} s, {:.0} s later than without ships",
            arrival - desired.duration()
        );
        for corner in &diagram.profile {
            println!("  {:5.0} m at {:4.0} s", corner.distance, corner.time);
        }
    }
    Ok(())
}
