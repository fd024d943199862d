//! What a report does not say, and has to be assumed.

use searoom_geometry::frame::{KNOT_MPS, NAUTICAL_MILE_M, radians_from_deg};

/// What a report does not say.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Radius of a fix that says it is better than 10 m, metres.
    pub accurate_m: f64,
    /// Radius of another one, metres.
    pub inaccurate_m: f64,
    /// Radius of a place that was not measured, metres.
    pub not_measured_m: f64,
    /// Speed below which a course is noise, m/s.
    pub least_course_mps: f64,
    /// Error of a course beyond its step, rad.
    pub course_error: f64,
    /// Error of a heading beyond its step, rad.
    pub heading_error: f64,
    /// Speed from which the course stands for an unknown heading, m/s, and within what, rad.
    pub heading_from_mps: f64,
    /// See `heading_from_mps`.
    pub heading_from_course: f64,
    /// Largest length and beam of a ship of class A, metres.
    pub class_a_m: [f64; 2],
    /// Largest length and beam of a ship of class B, metres.
    pub class_b_m: [f64; 2],
    /// Time between two reports of classes A and B, seconds: the age of a fix without a time stamp.
    pub interval_s: [f64; 2],
    /// Age of a long-range fix that is said to be older than 5 s, seconds.
    pub latent_s: f64,
    /// Largest age of the values of a row or of a Signal K delta, which are dated by their reception,
    /// seconds.
    pub delay_s: f64,
    /// Values of one Signal K context whose times differ by no more than this are of one fix, seconds.
    pub join_s: f64,
    /// Age up to which own ship's position and velocity serve a radar target, seconds.
    pub own_position_s: f64,
    /// Age up to which own ship's heading serves a relative bearing, seconds.
    pub own_heading_s: f64,
    /// Largest speed of own ship where its sentences do not bound it, m/s.
    pub own_speed_mps: f64,
    /// Largest rate of turn of own ship, rad/s: how fast an old heading becomes wrong.
    pub own_turn_rate: f64,
    /// Farthest that own ship's radar and the antenna of its position are apart, metres.
    pub radar_offset_m: f64,
    /// Error of a radar range: the larger of this part of it and of `range_error_m`.
    pub range_error: f64,
    /// Least error of a radar range, metres.
    pub range_error_m: f64,
    /// Error of a radar bearing, rad.
    pub bearing_error: f64,
    /// Error of the speed of a tracked target, m/s. Add the current where the radar's speeds are through the
    /// water. The default is the accuracy that IMO resolution MSC.192(79) asks for after three minutes.
    pub target_speed_error_mps: f64,
    /// Error of the course of a tracked target, rad; from the same resolution.
    pub target_course_error: f64,
    /// Age of a radar target without a time: a turn of the antenna, seconds.
    pub radar_age_s: f64,
    /// Farthest range of a tracked target, metres: bounds the error of a place that is sent without a range.
    pub farthest_m: f64,
    /// What the radar's relative courses and speeds mean.
    pub relative: RelativeMotion,
}

searoom_geometry::words! {
    /// What course and speed of a radar target mean where the course is marked as relative (`R`).
    pub enum RelativeMotion {
        /// Not known: any velocity that one of the readings allows.
        Unknown => "unknown",
        /// The course is measured from own ship's heading; course and speed are over ground.
        FromHeading => "from own heading",
        /// Course, from north, and speed are relative to own ship's motion.
        FromMotion => "from own motion",
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            accurate_m: 10.0,
            inaccurate_m: 50.0,
            not_measured_m: 0.5 * NAUTICAL_MILE_M,
            least_course_mps: KNOT_MPS,
            course_error: radians_from_deg(2.0),
            heading_error: radians_from_deg(2.0),
            heading_from_mps: 5.0 * KNOT_MPS,
            heading_from_course: radians_from_deg(15.0),
            class_a_m: [500.0, 130.0],
            class_b_m: [50.0, 15.0],
            interval_s: [10.0, 30.0],
            latent_s: 60.0,
            delay_s: 5.0,
            join_s: 3.0,
            own_position_s: 10.0,
            own_heading_s: 3.0,
            own_speed_mps: 25.0 * KNOT_MPS,
            own_turn_rate: radians_from_deg(3.0),
            radar_offset_m: 20.0,
            range_error: 0.01,
            range_error_m: 30.0,
            bearing_error: radians_from_deg(1.0),
            target_speed_error_mps: 0.5 * KNOT_MPS,
            target_course_error: radians_from_deg(5.0),
            radar_age_s: 3.0,
            farthest_m: 24.0 * NAUTICAL_MILE_M,
            relative: RelativeMotion::Unknown,
        }
    }
}
