//! The plane of the program and its border with the navigator's.
//!
//! Inside: east and north in metres, headings counter-clockwise from east in radians, time in
//! seconds, speeds in m/s. At the border: courses clockwise from true north in degrees, knots.
//! This is the only file that knows a degree or a knot. Port and starboard are named here, so that
//! no other file needs a sign for them.

use std::f64::consts::{PI, TAU};

/// A point or a displacement in the plane: `(east, north)`, metres (or m/s for a velocity).
pub type Vector = nalgebra::Vector2<f64>;

/// One international knot in m/s (exact by definition).
pub const KNOT_MPS: f64 = 1852.0 / 3600.0;

/// Where a ship is and where she points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Hull centre, metres.
    pub position: Vector,
    /// Radians, counter-clockwise from east.
    pub heading: f64,
}

impl Pose {
    /// A pose from its position in metres and its heading in radians counter-clockwise from east.
    pub fn new(position: Vector, heading: f64) -> Self {
        Self { position, heading }
    }

    /// The unit vector ahead.
    pub fn ahead(&self) -> Vector {
        direction(self.heading)
    }

    /// `(ahead, to port)` coordinates of a point in this ship's frame, metres.
    pub fn body_coordinates(&self, point: Vector) -> Vector {
        let d = point - self.position;
        let ahead = self.ahead();
        Vector::new(ahead.dot(&d), to_port(ahead).dot(&d))
    }

    /// The point with `(ahead, to port)` coordinates `body` in this ship's frame.
    pub fn world_coordinates(&self, body: Vector) -> Vector {
        let ahead = self.ahead();
        self.position + ahead * body.x + to_port(ahead) * body.y
    }
}

/// A side of a ship.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// Left, looking ahead.
    Port,
    /// Right, looking ahead.
    Starboard,
}

impl Side {
    /// Both sides, starboard first: the order in which ties are broken.
    pub const BOTH: [Self; 2] = [Self::Starboard, Self::Port];

    /// The other side.
    pub fn opposite(self) -> Self {
        match self {
            Self::Port => Self::Starboard,
            Self::Starboard => Self::Port,
        }
    }

    /// The sign of a turn to this side in the program's frame (counter-clockwise positive).
    pub fn turn_sign(self) -> f64 {
        match self {
            Self::Port => 1.0,
            Self::Starboard => -1.0,
        }
    }

    /// The side of a turn with this rate, `None` when it is zero or not a number.
    pub fn of_turn(turn_rate: f64) -> Option<Self> {
        match turn_rate.partial_cmp(&0.0)? {
            std::cmp::Ordering::Greater => Some(Self::Port),
            std::cmp::Ordering::Less => Some(Self::Starboard),
            std::cmp::Ordering::Equal => None,
        }
    }
}

impl std::fmt::Display for Side {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Port => "port",
            Self::Starboard => "starboard",
        })
    }
}

/// The unit vector of a heading.
pub fn direction(heading: f64) -> Vector {
    let (sin, cos) = heading.sin_cos();
    Vector::new(cos, sin)
}

/// The heading of a displacement, in `(-pi, pi]`.
pub fn heading_of(v: Vector) -> f64 {
    v.y.atan2(v.x)
}

/// The vector turned a quarter circle to port.
pub fn to_port(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

/// The vector turned a quarter circle to starboard.
pub fn to_starboard(v: Vector) -> Vector {
    Vector::new(v.y, -v.x)
}

/// The scalar cross product `a x b`: positive when `b` lies to port of `a`.
pub fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}

/// The same angle in `(-pi, pi]`.
pub fn wrap(angle: f64) -> f64 {
    if angle > -PI && angle <= PI {
        return angle;
    }
    // one turn off, as most are: the same without a division
    if angle > PI && angle < 9.0 {
        return angle - TAU;
    }
    if angle > -TAU && angle <= -PI {
        return angle + TAU;
    }
    let wrapped = angle.rem_euclid(TAU);
    if wrapped > PI { wrapped - TAU } else { wrapped }
}

/// The same angle in `[0, 2 pi)`.
pub fn wrap_positive(angle: f64) -> f64 {
    let wrapped = angle.rem_euclid(TAU);
    // rem_euclid rounds a tiny negative angle up to the full circle
    if wrapped >= TAU { 0.0 } else { wrapped }
}

/// Relative bearing of `point` from a ship, clockwise from ahead, in `(-pi, pi]`: positive to
/// starboard, as the rules of the road have it.
pub fn relative_bearing(ship: &Pose, point: Vector) -> f64 {
    let bearing = wrap(ship.heading - heading_of(point - ship.position));
    if bearing == -PI { PI } else { bearing }
}

/// Heading from a course in degrees clockwise from true north.
pub fn heading_from_course_deg(course_deg: f64) -> f64 {
    wrap((90.0 - course_deg).to_radians())
}

/// Course in degrees clockwise from true north, in `[0, 360)`, from a heading.
pub fn course_deg_from_heading(heading: f64) -> f64 {
    let course = (90.0 - heading.to_degrees()).rem_euclid(360.0);
    if course >= 360.0 { 0.0 } else { course }
}

/// A turn at the border, degrees clockwise, from radians counter-clockwise. Zero keeps its positive sign.
pub fn clockwise_deg(turn: f64) -> f64 {
    clockwise_deg_per_s(turn)
}

/// A turn rate at the border, degrees per second clockwise, from radians per second
/// counter-clockwise. Zero keeps its positive sign.
pub fn clockwise_deg_per_s(turn_rate: f64) -> f64 {
    if turn_rate == 0.0 {
        0.0
    } else {
        -turn_rate.to_degrees()
    }
}

/// Radians from degrees: a spread or a half-width, which has no direction.
pub fn radians_from_deg(degrees: f64) -> f64 {
    degrees.to_radians()
}

/// Degrees from radians: an angle without a direction, or one already clockwise.
pub fn deg_from_radians(radians: f64) -> f64 {
    radians.to_degrees()
}

/// Metres per second from knots.
pub fn mps_from_knots(knots: f64) -> f64 {
    knots * KNOT_MPS
}

/// Knots from metres per second.
pub fn knots_from_mps(speed: f64) -> f64 {
    speed / KNOT_MPS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn courses_and_headings_are_inverse_and_canonical() {
        for (course, heading) in [
            (0.0, PI / 2.0),
            (90.0, 0.0),
            (180.0, -PI / 2.0),
            (270.0, PI),
        ] {
            assert!((heading_from_course_deg(course) - heading).abs() < 1e-15);
            assert!((course_deg_from_heading(heading) - course).abs() < 1e-12);
        }
        for i in 0..720 {
            let course = f64::from(i) * 0.5;
            let back = course_deg_from_heading(heading_from_course_deg(course));
            assert!((back - course).abs() < 1e-9 || (back - course).abs() > 359.999);
            assert!((0.0..360.0).contains(&back));
        }
    }

    #[test]
    fn wrapping_lands_in_its_half_open_interval() {
        for i in -40..40 {
            let a = f64::from(i) * PI / 4.0;
            assert!(wrap(a) > -PI && wrap(a) <= PI);
            assert!((0.0..TAU).contains(&wrap_positive(a)));
        }
        assert!((wrap_positive(-1e-18)).abs() < 1e-15);
        assert!(wrap(f64::NAN).is_nan());
    }

    #[test]
    fn bearings_are_positive_to_starboard() {
        let ship = Pose::new(Vector::new(3.0, 4.0), heading_from_course_deg(0.0));
        let east = relative_bearing(&ship, Vector::new(13.0, 4.0));
        assert!((east - PI / 2.0).abs() < 1e-12);
        let astern = relative_bearing(&ship, Vector::new(3.0, -4.0));
        assert!((astern.abs() - PI).abs() < 1e-12);
    }

    #[test]
    fn body_coordinates_round_trip() {
        let ship = Pose::new(Vector::new(-7.0, 2.0), 0.7);
        let p = Vector::new(12.0, -5.0);
        assert!((ship.world_coordinates(ship.body_coordinates(p)) - p).norm() < 1e-12);
        assert!(
            ship.body_coordinates(ship.position + to_port(ship.ahead()))
                .y
                > 0.99
        );
    }
}
