//! How far off a moored barge must the centre of own ship pass? The Minkowski sum of the barge and
//! own hull answers it: exactly for one heading, and for any heading by a disc around the hull.
//!
//! ```text
//! cargo run -p searoom-geometry --example keep_out_area
//! ```

use std::f64::consts::FRAC_PI_6;

use searoom_geometry::frame::{Vector, heading_from_course_deg};
use searoom_geometry::{ConvexPolygon, outer_disc};

/// Metres between the hulls.
const MARGIN_M: f64 = 20.0;

fn main() {
    // 80 m long and 20 m wide, turned by 30° from the fairway, which runs from west to east
    let barge = ConvexPolygon::rectangle(Vector::zeros(), 40.0, 10.0).rotated(FRAC_PI_6);
    // own hull: 120 m long and 18 m wide
    let hull = ConvexPolygon::rectangle(Vector::zeros(), 60.0, 9.0);
    let margin = outer_disc(MARGIN_M, 0.0);

    println!("{:>12} {:>12} {:>10}", "course", "off barge", "area");
    for course_deg in [90.0, 60.0, 30.0] {
        let own = hull.rotated(heading_from_course_deg(course_deg));
        // the centre is clear where the hull about it does not meet the barge
        let keep_out = barge.minkowski_sum(&own.negated()).minkowski_sum(&margin);
        print_row(&format!("{course_deg:.0}°"), &keep_out);
    }
    let any_heading = outer_disc(hull.reach(), 0.0);
    let keep_out = barge.minkowski_sum(&any_heading).minkowski_sum(&margin);
    print_row("any", &keep_out);
}

/// Prints how far north of the barge's centre the area reaches, and how large it is.
fn print_row(course: &str, keep_out: &ConvexPolygon) {
    let north = keep_out.support(Vector::new(0.0, 1.0));
    println!(
        "{course:>12} {north:>10.1} m {:>7.2} ha",
        keep_out.area() / 1e4
    );
}
