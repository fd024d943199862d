//! Which role has own ship toward a target, and where is the ship domain of the target enlarged, so
//! that the cheapest plan follows the rule?
//!
//! ```text
//! cargo run -p searoom-colregs --example role_and_ship_domain
//! ```

use searoom_colregs::{Role, Thresholds, first_risk, ship_domain, sweep};
use searoom_geometry::frame::{Pose, Vector, heading_from_course_deg};
use searoom_model::target::{DomainKind, ShipTrack};
use searoom_model::trajectory::{DesiredTrajectory, TrajectoryError};
use searoom_model::vessel::{Hull, OwnShip};

/// Seconds until which targets are considered.
const HORIZON: f64 = 600.0;

fn main() -> Result<(), TrajectoryError> {
    let pose = |east, north, course_deg| {
        Pose::new(
            Vector::new(east, north),
            heading_from_course_deg(course_deg),
        )
    };
    let own = OwnShip {
        pose: pose(0.0, 0.0, 90.0),
        speed: 6.0,
        hull: Hull::new(60.0, 10.0),
        turning_radius: 150.0,
        speeds: vec![3.0, 6.0],
        safety_margin: 50.0,
        tracking_margin: 0.0,
    };
    let route = [Vector::zeros(), Vector::new(3600.0, 0.0)];
    let desired = DesiredTrajectory::new(&route, &[own.speed])?;
    for (name, pose, speed) in [
        ("oncoming", pose(2000.0, 0.0, 270.0), 6.0),
        ("from starboard", pose(1200.0, -1200.0, 0.0), 6.0),
        ("from port", pose(1200.0, 1200.0, 180.0), 6.0),
        ("slow, ahead", pose(800.0, 0.0, 90.0), 2.0),
        ("far off", pose(1200.0, 4000.0, 90.0), 6.0),
    ] {
        let target = ShipTrack {
            domain: DomainKind::Colregs,
            ..ShipTrack::exact(pose, speed, Hull::new(80.0, 14.0))
        };
        let risk = first_risk(&own, &desired, &target, HORIZON, Thresholds::standard());
        let role = risk.map_or(Role::None, |risk| risk.role);
        let swept = risk.map_or(Vector::zeros(), |risk| sweep(&own, &target, &risk));
        let domain = ship_domain(&own, &target, risk.as_ref(), HORIZON);
        println!(
            "{name:>14}: {:10} domain {:4.1} ha, enlarged {:4.0} m east, {:4.0} m north",
            role.word(),
            domain.with_domain.area() / 1e4,
            swept.x,
            swept.y
        );
    }
    Ok(())
}
