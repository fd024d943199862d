//! The program's plane, and its conversion to nautical units.
//!
//! Inside the program: east and north in metres, headings counter-clockwise from east in radians,
//! time in seconds, speeds in m/s. In files and reports: courses clockwise from true north in
//! degrees, knots, latitudes and longitudes, which a [`Georeference`] projects to the plane. Only
//! this file knows degrees and knots. It also names port and starboard, so that no other file needs
//! a sign for them.

use std::f64::consts::{PI, TAU};

/// A point or a displacement in the plane: `(east, north)`, metres (or m/s for a velocity).
pub type Vector = nalgebra::Vector2<f64>;

/// One nautical mile in metres (exact by definition).
pub const NAUTICAL_MILE_M: f64 = 1852.0;

/// One international knot in m/s (exact by definition).
pub const KNOT_MPS: f64 = NAUTICAL_MILE_M / 3600.0;

/// Position and heading of a ship.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Hull centre, metres.
    pub position: Vector,
    /// Radians, counter-clockwise from east.
    pub heading: f64,
}

impl Pose {
    /// A pose from its position in metres and its heading in radians counter-clockwise from east.
    #[inline]
    pub fn new(position: Vector, heading: f64) -> Self {
        Self { position, heading }
    }

    /// The unit vector ahead.
    #[inline]
    pub fn ahead(&self) -> Vector {
        direction(self.heading)
    }

    /// `(ahead, to port)` coordinates of a point in this ship's frame, metres.
    #[inline]
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

crate::words! {
    /// A side of a ship.
    pub enum Side {
        /// Left, looking ahead.
        Port => "port",
        /// Right, looking ahead.
        Starboard => "starboard",
    }
}

impl Side {
    /// Both sides, starboard first: the order in which ties are broken.
    pub const BOTH: [Self; 2] = [Self::Starboard, Self::Port];

    /// The other side.
    #[inline]
    pub fn opposite(self) -> Self {
        match self {
            Self::Port => Self::Starboard,
            Self::Starboard => Self::Port,
        }
    }

    /// Sign of a turn to this side in the program's frame (counter-clockwise positive).
    #[inline]
    pub fn turn_sign(self) -> f64 {
        match self {
            Self::Port => 1.0,
            Self::Starboard => -1.0,
        }
    }

    /// The side of a turn with this rate; `None` when it is zero or NaN.
    pub fn of_turn(turn_rate: f64) -> Option<Self> {
        match turn_rate.partial_cmp(&0.0)? {
            std::cmp::Ordering::Greater => Some(Self::Port),
            std::cmp::Ordering::Less => Some(Self::Starboard),
            std::cmp::Ordering::Equal => None,
        }
    }
}

/// The unit vector of a heading.
#[inline]
pub fn direction(heading: f64) -> Vector {
    let (sin, cos) = heading.sin_cos();
    Vector::new(cos, sin)
}

/// The heading of a displacement, in `(-pi, pi]`.
#[inline]
pub fn heading_of(v: Vector) -> f64 {
    v.y.atan2(v.x)
}

/// The vector rotated a quarter turn to port.
#[inline]
pub fn to_port(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

/// The vector rotated a quarter turn to starboard.
pub fn to_starboard(v: Vector) -> Vector {
    Vector::new(v.y, -v.x)
}

/// The scalar cross product `a x b`: positive when `b` lies to port of `a`.
#[inline]
pub fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}

/// The equivalent angle in `(-pi, pi]`.
#[inline]
pub fn wrap(angle: f64) -> f64 {
    if angle > -PI && angle <= PI {
        return angle;
    }
    // the common case of one turn, without a division
    if angle > PI && angle < 9.0 {
        return angle - TAU;
    }
    if angle > -TAU && angle <= -PI {
        return angle + TAU;
    }
    let wrapped = angle.rem_euclid(TAU);
    if wrapped > PI { wrapped - TAU } else { wrapped }
}

/// The equivalent angle in `[0, 2 pi)`.
pub fn wrap_positive(angle: f64) -> f64 {
    let wrapped = angle.rem_euclid(TAU);
    // rem_euclid rounds a tiny negative angle up to the full circle
    if wrapped >= TAU { 0.0 } else { wrapped }
}

/// Relative bearing of `point` from a ship, clockwise from ahead, in `(-pi, pi]`: positive to
/// starboard.
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

/// A turn in degrees clockwise, from radians counter-clockwise. Zero keeps its positive sign.
pub fn clockwise_deg(turn: f64) -> f64 {
    clockwise_deg_per_s(turn)
}

/// A turn rate in degrees per second clockwise, from radians per second counter-clockwise. Zero
/// keeps its positive sign.
pub fn clockwise_deg_per_s(turn_rate: f64) -> f64 {
    if turn_rate == 0.0 {
        0.0
    } else {
        -turn_rate.to_degrees()
    }
}

/// Radians from degrees, for angles without a direction such as a half-width.
pub const fn radians_from_deg(degrees: f64) -> f64 {
    degrees.to_radians()
}

/// Degrees from radians, for angles without a direction or already clockwise.
///
/// Radians that were read from degrees give these degrees back, or others that are read as the same
/// radians. So a document describes the same sets to the last digit.
pub fn deg_from_radians(radians: f64) -> f64 {
    let degrees = radians.to_degrees();
    let (above, below) = (degrees.next_up(), degrees.next_down());
    [degrees, above, below, above.next_up(), below.next_down()]
        .into_iter()
        .find(|near| radians_from_deg(*near) == radians)
        .unwrap_or(degrees)
}

/// Metres per second from knots.
pub fn mps_from_knots(knots: f64) -> f64 {
    knots * KNOT_MPS
}

/// Knots from metres per second.
pub fn knots_from_mps(speed: f64) -> f64 {
    speed / KNOT_MPS
}

/// A position on the WGS84 ellipsoid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geographic {
    /// Degrees north of the equator.
    pub lat_deg: f64,
    /// Degrees east of Greenwich.
    pub lon_deg: f64,
}

impl Geographic {
    /// A position by its latitude and longitude, degrees.
    #[inline]
    pub const fn new(lat_deg: f64, lon_deg: f64) -> Self {
        Self { lat_deg, lon_deg }
    }

    /// True when the latitude is within 90° and the longitude within 180°.
    pub fn is_on_earth(&self) -> bool {
        self.lat_deg.abs() <= 90.0 && self.lon_deg.abs() <= 180.0
    }
}

impl std::fmt::Display for Geographic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "lat {:.6}°, lon {:.6}°", self.lat_deg, self.lon_deg)
    }
}

/// Equatorial radius of WGS84, metres, by definition; its flattening follows.
const WGS84_RADIUS_M: f64 = 6_378_137.0;
const WGS84_FLATTENING: f64 = 1.0 / 298.257_223_563;

/// Scale on the central meridian, slightly below 1 as in every secant projection. Distances from
/// the origin are then within 0.1 m at 30 km in all directions.
const CENTRAL_SCALE: f64 = 1.0 - 1e-6;

/// Greatest distance from the origin of a georeference, metres. Lengths there are 0.012 % too long.
/// Positions farther away are a mistake, such as an exchanged latitude and longitude.
pub const GEOREFERENCE_REACH_M: f64 = 100_000.0;

/// Largest latitude of an origin, degrees: courses are meaningless near a pole.
pub const LARGEST_ORIGIN_LAT_DEG: f64 = 89.0;

/// The plane of a scenario on the earth: a transverse Mercator projection of WGS84 about an origin,
/// where north on the plane is true north.
///
/// Krüger's series to the fourth order in the third flattening, with an error below a micrometre
/// (C. F. F. Karney, "Transverse Mercator with an accuracy of a few nanometers", 2011,
/// doi:10.1007/s00190-011-0445-3). A position given by distance and bearing from the origin is
/// within 0.1 m of the geodesic's end at 30 km. Lengths at 100 km from the central meridian are
/// 0.012 % too long. Away from that meridian north on the plane differs from true north by `(lon -
/// lon_origin) sin(lat)`: half a degree at 30 km east in 63° N.
///
/// ```
/// use searoom_geometry::frame::{Geographic, Georeference, Vector};
/// let origin = Geographic { lat_deg: 63.44, lon_deg: 10.399 };
/// let georeference = Georeference::new(origin).expect("not at a pole");
/// assert!(georeference.to_plane(origin).norm() < 1e-8);
/// let munkholmen = georeference.to_plane(Geographic { lat_deg: 63.4512, lon_deg: 10.3833 });
/// assert!((munkholmen - Vector::new(-783.3, 1248.6)).norm() < 0.2);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Georeference {
    origin: Geographic,
    /// Metres on the plane from the equator to the origin.
    northing: f64,
}

impl Georeference {
    /// A georeference about an origin; `None` when it is not on the earth or beyond
    /// [`LARGEST_ORIGIN_LAT_DEG`].
    #[inline]
    pub fn new(origin: Geographic) -> Option<Self> {
        let sound = origin.lat_deg.abs() <= LARGEST_ORIGIN_LAT_DEG && origin.is_on_earth();
        sound.then(|| {
            let mut georeference = Self {
                origin,
                northing: 0.0,
            };
            georeference.northing = georeference.to_plane(origin).y;
            georeference
        })
    }

    /// The position of the plane's origin.
    pub fn origin(&self) -> Geographic {
        self.origin
    }

    /// Metres east and north of the origin. NaN for a NaN.
    pub fn to_plane(&self, place: Geographic) -> Vector {
        let lat = place.lat_deg.to_radians();
        let lon = wrap((place.lon_deg - self.origin.lon_deg).to_radians());
        let tau = conformal(lat.tan());
        let xi = tau.atan2(lon.cos());
        let eta = (lon.sin() / tau.hypot(lon.cos())).asinh();
        let series = Kruger::of_wgs84();
        let (mut x, mut y) = (eta, xi);
        for (k, alpha) in (1..).zip(series.alpha) {
            let order = 2.0 * f64::from(k);
            x += alpha * (order * xi).cos() * (order * eta).sinh();
            y += alpha * (order * xi).sin() * (order * eta).cosh();
        }
        Vector::new(series.radius * x, series.radius * y - self.northing)
    }

    /// [`Georeference::to_plane`] within [`GEOREFERENCE_REACH_M`] of the origin; `None` elsewhere.
    pub fn to_near_plane(&self, place: Geographic) -> Option<Vector> {
        let point = self.to_plane(place);
        (place.is_on_earth() && point.norm() <= GEOREFERENCE_REACH_M).then_some(point)
    }

    /// The inverse of [`Georeference::to_plane`].
    pub fn to_geographic(&self, point: Vector) -> Geographic {
        let series = Kruger::of_wgs84();
        let eta = point.x / series.radius;
        let xi = (point.y + self.northing) / series.radius;
        let (mut x, mut y) = (eta, xi);
        for (k, beta) in (1..).zip(series.beta) {
            let order = 2.0 * f64::from(k);
            x -= beta * (order * xi).cos() * (order * eta).sinh();
            y -= beta * (order * xi).sin() * (order * eta).cosh();
        }
        let lon = x.sinh().atan2(y.cos());
        let tau = y.sin() / x.sinh().hypot(y.cos());
        // Newton's method on the conformal latitude: three steps give every digit
        let e2 = WGS84_FLATTENING * (2.0 - WGS84_FLATTENING);
        let mut t = tau / (1.0 - e2);
        for _ in 0..5 {
            let found = conformal(t);
            let slope = (1.0 + (1.0 - e2) * t * t)
                / ((1.0 - e2) * (1.0 + found * found).sqrt() * (1.0 + t * t).sqrt());
            t += (tau - found) * slope;
        }
        Geographic::new(
            t.atan().to_degrees(),
            wrap(lon + self.origin.lon_deg.to_radians()).to_degrees(),
        )
    }
}

/// Tangent of the conformal latitude from that of the geographic latitude.
fn conformal(tan_lat: f64) -> f64 {
    let e = (WGS84_FLATTENING * (2.0 - WGS84_FLATTENING)).sqrt();
    let secant = tan_lat.hypot(1.0);
    let sigma = (e * (e * tan_lat / secant).atanh()).sinh();
    tan_lat * sigma.hypot(1.0) - sigma * secant
}

/// Coefficients of Krüger's series.
struct Kruger {
    /// Metres on the plane per unit.
    radius: f64,
    alpha: [f64; 4],
    beta: [f64; 4],
}

impl Kruger {
    fn of_wgs84() -> Self {
        let n = WGS84_FLATTENING / (2.0 - WGS84_FLATTENING);
        let (n2, n3, n4) = (n * n, n * n * n, n * n * n * n);
        let mean = WGS84_RADIUS_M / (1.0 + n) * (1.0 + n2 / 4.0 + n4 / 64.0);
        Self {
            radius: CENTRAL_SCALE * mean,
            alpha: [
                n / 2.0 - 2.0 * n2 / 3.0 + 5.0 * n3 / 16.0 + 41.0 * n4 / 180.0,
                13.0 * n2 / 48.0 - 3.0 * n3 / 5.0 + 557.0 * n4 / 1440.0,
                61.0 * n3 / 240.0 - 103.0 * n4 / 140.0,
                49_561.0 * n4 / 161_280.0,
            ],
            beta: [
                n / 2.0 - 2.0 * n2 / 3.0 + 37.0 * n3 / 96.0 - n4 / 360.0,
                n2 / 48.0 + n3 / 15.0 - 437.0 * n4 / 1440.0,
                17.0 * n3 / 480.0 - 37.0 * n4 / 840.0,
                4397.0 * n4 / 161_280.0,
            ],
        }
    }
}

#[cfg(test)]
mod tests;
