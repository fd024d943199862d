//! May own ship hold its course? The independent check says how near a ferry comes, for every
//! velocity that it may have, and which requirement the motion violates.
//!
//! ```text
//! cargo run -p searoom-evaluation --example held_course
//! ```

use searoom_evaluation::{Request, evaluate};
use searoom_geometry::frame::{Pose, Vector, heading_from_course_deg};
use searoom_model::target::{Motion, Representation, ShipTrack, Target};
use searoom_model::trajectory::{DesiredTrajectory, Segment, TrajectoryError};
use searoom_model::vessel::{Hull, OwnShip};

fn main() -> Result<(), TrajectoryError> {
    let own = OwnShip {
        pose: Pose::new(Vector::zeros(), heading_from_course_deg(90.0)),
        speed: 5.0,
        hull: Hull::new(30.0, 8.0),
        turning_radius: 100.0,
        speeds: vec![5.0],
        safety_margin: 30.0,
        tracking_margin: 0.0,
    };
    let desired = DesiredTrajectory::new(&[Vector::zeros(), Vector::new(1500.0, 0.0)], &[5.0])?;
    let held = [Segment::straight(
        own.pose,
        0.0,
        desired.duration(),
        own.speed,
    )];
    // northbound at 4 to 6 m/s, within 10° of its course
    let place = Pose::new(Vector::new(750.0, -950.0), heading_from_course_deg(0.0));
    let ferry = Target {
        name: "ferry".to_owned(),
        motion: Motion::Ship(ShipTrack {
            speed_spread: 1.0,
            course_spread: 10.0_f64.to_radians(),
            ..ShipTrack::exact(place, 5.0, Hull::new(60.0, 12.0))
        }),
        representation: Representation::Polytope,
        status: None,
    };
    let found = evaluate(&Request {
        targets: &[ferry],
        ..Request::new(&held, &own, &desired, 600.0)
    });
    for met in &found.passages {
        println!("as estimated: {:.0} m at {:.0} s", met.dcpa, met.tcpa);
        println!("for any velocity of its set: {:.0} m", met.min_clearance);
    }
    for violation in &found.violations {
        println!("violated at {:.0} s: {}", violation.time, violation.what);
    }
    println!("{}", if found.safe() { "safe" } else { "not safe" });
    Ok(())
}
