//! What does an alteration of course cost? Own ship turns to starboard, turns back after a minute,
//! and is then beside its route and behind its schedule.
//!
//! ```text
//! cargo run -p searoom-model --example course_alteration
//! ```

use searoom_geometry::frame::{Pose, Vector, heading_from_course_deg};
use searoom_model::trajectory::{DesiredTrajectory, Segment, Trajectory, TrajectoryError};

/// Speed in m/s and turning radius in metres.
const SPEED: f64 = 6.0;
const RADIUS: f64 = 150.0;

fn main() -> Result<(), TrajectoryError> {
    let route = [Vector::zeros(), Vector::new(3000.0, 0.0)];
    let desired = DesiredTrajectory::new(&route, &[SPEED])?;
    println!(
        "{:>10} {:>10} {:>10} {:>10}",
        "alteration", "until", "off track", "behind"
    );
    for turn_deg in [10.0, 20.0, 30.0, 45.0, 60.0] {
        let motion = altered(turn_deg)?;
        let place = motion.end().position;
        // with a time weight of 0, the nearest place of the route at any time
        let along = desired.nearest(place, motion.end_time(), 0.0).distance;
        println!(
            "{turn_deg:>9.0}° {:>8.0} s {:>8.0} m {:>8.1} s",
            motion.end_time(),
            (place - desired.position_at(along / SPEED)).norm(),
            motion.end_time() - along / SPEED
        );
    }
    Ok(())
}

/// East for a minute, an arc to starboard, a minute on the new course, and an arc back to east.
fn altered(turn_deg: f64) -> Result<Trajectory, TrajectoryError> {
    let east = heading_from_course_deg(90.0);
    let turn = turn_deg.to_radians();
    let rate = SPEED / RADIUS;
    let ahead = Segment::straight(Pose::new(Vector::zeros(), east), 0.0, 60.0, SPEED);
    let aside = Segment::new(ahead.end(), 60.0, turn / rate, SPEED, -rate);
    let held = Segment::straight(aside.end(), aside.end_time(), 60.0, SPEED);
    let back = Segment::new(held.end(), held.end_time(), turn / rate, SPEED, rate);
    Trajectory::new(vec![ahead, aside, held, back])
}
