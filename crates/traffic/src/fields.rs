//! From numbers to sets, for every format: each code that stands for "unknown" or "or more" widens a set
//! here, with a [`Note`].

use std::f64::consts::PI;

use searoom_geometry::frame::{
    Geographic, KNOT_MPS, Vector, heading_from_course_deg, radians_from_deg, wrap,
};

use crate::report::{
    Directions, Fix, HullSet, Interval, Note, Notes, PositionSet, Status, VelocitySet,
};
use crate::settings::Settings;

/// Longest ship, metres: more is typed in wrongly.
const LONGEST_M: f64 = 500.0;

/// Metres for a degree of latitude, and for one of longitude at the equator. Each is the largest on WGS 84,
/// so that half a step is not too small.
const DEGREE_NORTH_M: f64 = 60.0 * 1861.7;
const DEGREE_EAST_M: f64 = 60.0 * 1855.4;

/// The set of a position that is sent in steps, half of one in degrees; none where it is not on the earth.
#[inline]
pub(crate) fn place(
    at: Geographic,
    half_step_deg: f64,
    radius_m: f64,
    notes: &mut Notes,
) -> Option<PositionSet> {
    if !at.is_on_earth() {
        notes.add(Note::NoPosition);
        return None;
    }
    // a degree of longitude is longest at the edge toward the equator
    let edge = (at.lat_deg.abs() - half_step_deg).max(0.0);
    let east = DEGREE_EAST_M * radians_from_deg(edge).cos().max(0.0);
    Some(PositionSet {
        at,
        half_cell_m: Vector::new(east, DEGREE_NORTH_M) * half_step_deg,
        radius_m,
    })
}

/// Speed in knots with half a step; above 102.15 kn it is AIS's code for "or more", and above 102.25 kn or
/// below 0 for "unknown", which may be there as a number.
pub(crate) fn speed_set(knots: Option<f64>, half_step: f64, notes: &mut Notes) -> Interval {
    match knots {
        Some(knots) if (0.0..102.15).contains(&knots) => Interval::new(
            (knots - half_step).max(0.0) * KNOT_MPS,
            (knots + half_step) * KNOT_MPS,
        ),
        Some(knots) if (102.15..102.25).contains(&knots) => {
            notes.add(Note::SpeedOrMore);
            Interval::new(102.15 * KNOT_MPS, f64::INFINITY)
        }
        _ => {
            notes.add(Note::NoSpeed);
            Interval::new(0.0, f64::INFINITY)
        }
    }
}

/// Course and its half step in degrees, where the ship is fast enough for one.
#[inline]
pub(crate) fn course_set(
    course: Option<(f64, f64)>,
    speed: Interval,
    settings: &Settings,
    notes: &mut Notes,
) -> Directions {
    let course = course.filter(|(degrees, _)| (0.0..360.0).contains(degrees));
    let Some((degrees, half_step)) = course else {
        notes.add(Note::NoCourse);
        return Directions::ALL;
    };
    if speed.least < settings.least_course_mps {
        if speed.most.is_finite() {
            notes.add(Note::SlowCourse);
        }
        return Directions::ALL;
    }
    about(degrees, half_step, settings.course_error)
}

/// Heading and its half step in degrees; where there is none, that of a fast ship is about its course.
pub(crate) fn heading_set(
    heading: Option<(f64, f64)>,
    velocity: VelocitySet,
    settings: &Settings,
    notes: &mut Notes,
) -> Directions {
    match heading.filter(|(degrees, _)| (0.0..360.0).contains(degrees)) {
        Some((degrees, half_step)) => about(degrees, half_step, settings.heading_error),
        None => without_heading(velocity.speed, velocity.course, settings, notes),
    }
}

/// The heading where none is sent: about the course of a ship that is fast.
#[inline]
pub(crate) fn without_heading(
    speed: Interval,
    course: Directions,
    settings: &Settings,
    notes: &mut Notes,
) -> Directions {
    notes.add(Note::NoHeading);
    if speed.least < settings.heading_from_mps || course.half >= PI {
        return Directions::ALL;
    }
    notes.add(Note::HeadingFromCourse);
    Directions {
        half: (course.half + settings.heading_from_course).min(PI),
        ..course
    }
}

/// Rate of turn from its root in 4.733 degrees a minute, starboard positive: half a step of the root each
/// way. From 126 on it has no bound, and 127 gives the side alone.
#[inline]
pub(crate) fn turn_rate(root: f64) -> Interval {
    let rate = |root: f64| radians_from_deg((root / 4.733).powi(2)) / 60.0;
    let size = match root.abs() {
        // to this side at more than 5° in 30 s
        126.5.. => Interval::new(radians_from_deg(10.0) / 60.0, f64::INFINITY),
        125.5.. => Interval::new(rate(125.5), f64::INFINITY),
        ..0.5 => return Interval::new(-rate(root.abs() + 0.5), rate(root.abs() + 0.5)),
        root => Interval::new(rate(root - 0.5), rate(root + 0.5)),
    };
    // to starboard is negative in the plane
    match root > 0.0 {
        true => Interval::new(-size.most, -size.least),
        false => size,
    }
}

/// Hull from the distances in metres from the antenna to bow, stern, port and starboard side. `bounds` are
/// the largest length and beam where a size is not given.
#[inline]
pub(crate) fn hull(
    [bow, stern, port, starboard]: [f64; 4],
    [length, beam]: [f64; 2],
    settings: &Settings,
    notes: &mut Notes,
) -> HullSet {
    let (long, wide) = (bow + stern, port + starboard);
    if long == 0.0 || wide == 0.0 {
        notes.add(Note::NoSize);
        let mut known = HullSet::unknown(length.max(long), beam.max(wide));
        (known.length.least, known.beam.least) = (long, wide);
        return known;
    }
    if long < wide || long > LONGEST_M && bow < 511.0 && stern < 511.0 {
        notes.add(Note::WrongSize);
        let most = long.max(wide) + 1.0;
        return HullSet::unknown(most, most);
    }
    // a code that means "or more" reaches as far as any ship
    let [longest, widest] = settings.class_a_m;
    let mut side = |code: f64, highest: f64, largest: f64| match code >= highest {
        true => {
            notes.add(Note::SizeOrMore);
            Interval::new(code - 0.5, largest.max(code))
        }
        false => Interval::new((code - 0.5).max(0.0), code + 0.5),
    };
    let sum = |a: Interval, b: Interval| Interval::new(a.least + b.least, a.most + b.most);
    let ahead = side(bow, 511.0, longest.max(511.0));
    let astern = side(stern, 511.0, longest.max(511.0));
    let to_port = side(port, 63.0, widest);
    let to_starboard = side(starboard, 63.0, widest);
    if bow == 0.0 && port == 0.0 {
        notes.add(Note::NoAntenna);
        return HullSet::anywhere(astern, to_starboard);
    }
    HullSet {
        length: sum(ahead, astern),
        beam: sum(to_port, to_starboard),
        ahead,
        astern,
        port: to_port,
        starboard: to_starboard,
    }
}

/// True for metres that may be of a ship, however wrong.
pub(crate) fn is_length(metres: &f64) -> bool {
    (0.0..10_000.0).contains(metres)
}

/// A switch that was forgotten makes no set smaller.
#[inline]
pub(crate) fn contradiction(status: Option<Status>, fix: &Fix, notes: &mut Notes) {
    let rests = matches!(
        status,
        Some(Status::Anchored | Status::Moored | Status::Aground)
    );
    if rests && fix.velocity.speed.least > KNOT_MPS {
        notes.add(Note::StatusContradictsSpeed);
    }
}

/// Metres from the centre of the earth: the largest on WGS 84, so that no distance is too small.
const RADIUS_M: f64 = 6_399_600.0;

/// Metres east and north from one place to another that is near.
pub(crate) fn metres(from: Geographic, to: Geographic) -> Vector {
    let east = wrap(radians_from_deg(to.lon_deg - from.lon_deg));
    let lat = radians_from_deg(from.lat_deg);
    let north = radians_from_deg(to.lat_deg) - lat;
    Vector::new(east * lat.cos(), north) * RADIUS_M
}

/// A number of steps, to half a step each way. Speeds are not negative.
#[inline]
pub(crate) fn steps(number: f64, step: f64) -> Interval {
    let about = Interval::about(number * step, 0.5 * step);
    Interval::new(about.least.max(0.0), about.most)
}

/// Degrees clockwise from north with half a step, and an error in radians.
#[inline]
pub(crate) fn about(degrees: f64, half_step: f64, error: f64) -> Directions {
    Directions {
        middle: heading_from_course_deg(degrees),
        half: (radians_from_deg(half_step) + error).min(PI),
    }
}
