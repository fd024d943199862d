//! How near does a ferry come whose velocity is only known to be in a set, and how great is the
//! risk? Own ship compares courses at the same speed.
//!
//! ```text
//! cargo run -p searoom-sets --example risk_and_closest_approach
//! ```

use searoom_geometry::frame::{Pose, Vector, heading_from_course_deg};
use searoom_geometry::{ConvexPolygon, outer_disc};
use searoom_model::trajectory::Segment;
use searoom_sets::{PolytopeObstacle, SpaceTimeObstacle};

/// Own speed in m/s, and how far ahead to look, in seconds.
const SPEED: f64 = 5.0;
const HORIZON: f64 = 600.0;

fn main() {
    // within 100 m of (1200, 600), coming south at 3 to 5 m/s and up to 0.5 m/s to either side; the
    // disc contains own hull and a safety margin
    let initial = outer_disc(100.0, 0.0).translated(Vector::new(1200.0, 600.0));
    let velocity = ConvexPolygon::rectangle(Vector::new(0.0, -4.0), 0.5, 1.0);
    let ferry = PolytopeObstacle::new("ferry", initial, velocity);

    println!(
        "{:>6} {:>9} {:>7} {:>10} {:>6}",
        "course", "distance", "at", "enters", "risk"
    );
    for course_deg in [60.0, 75.0, 90.0, 105.0, 120.0, 135.0] {
        let own = Pose::new(Vector::zeros(), heading_from_course_deg(course_deg));
        let held = Segment::straight(own, 0.0, HORIZON, SPEED);
        let closest = ferry.closest_approach(own.position, own.ahead() * SPEED, HORIZON);
        let enters = match ferry.first_contact(&held, 0.0) {
            Some(time) => format!("{time:.0} s"),
            None => "never".to_owned(),
        };
        // 0 outside of the set, 1 where the ferry is if it keeps the middle of its velocities
        let risk = ferry.peak_risk(&held).risk;
        println!(
            "{course_deg:>5.0}° {:>7.0} m {:>5.0} s {enters:>10} {risk:>6.2}",
            closest.distance, closest.time
        );
    }
}
