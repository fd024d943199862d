//! Assumptions for values that imported files do not have.

use crate::limits;
use searoom_geometry::frame::radians_from_deg;
use searoom_input::Range;
use searoom_model::vessel::Hull;

/// Default half-width of a target's speed, m/s.
const SPEED_SPREAD: f64 = 0.5;

/// Default half-width of a target's course, degrees.
const COURSE_SPREAD_DEG: f64 = 5.0;

/// Hull of a ship whose format has no size: 100 × 20 m, as published runs of Imazu's cases assume.
pub(super) const USUAL_HULL: Hull = Hull::new(100.0, 20.0);

/// Own ship's speeds, as fractions of the speed that a situation gives it.
pub(super) const ASSUMED_SPEEDS: [f64; 3] = [0.5, 1.0, 1.2];

/// Own ship's turning radius in own lengths: a tactical diameter of five lengths, the largest that
/// IMO resolution MSC.137(76) allows.
pub(super) const TURNING_LENGTHS: f64 = 2.5;

/// Horizon in durations of own ship's route: time to stay behind a slower ship all the way.
pub(super) const HORIZON_ROUTES: f64 = 2.0;

/// Hull of a ship whose file says that its size is unknown: nearly every ship is smaller.
pub(super) const LARGE_HULL: Hull = Hull::new(400.0, 60.0);

/// Values that a scenario needs and imported files do not have. Defaults as in
/// `docs/reference/formats.md`.
#[derive(Debug, Clone, PartialEq)]
pub struct Assumed {
    /// m/s.
    pub(super) speed_spread: f64,
    /// Radians.
    pub(super) course_spread: f64,
    safety_margin: Option<f64>,
    length: Option<f64>,
    beam: Option<f64>,
    /// Own ship's speed where a file has none, m/s.
    pub(super) own_speed: Option<f64>,
    pub(super) variants: bool,
}

impl Default for Assumed {
    fn default() -> Self {
        Self {
            speed_spread: SPEED_SPREAD,
            course_spread: radians_from_deg(COURSE_SPREAD_DEG),
            safety_margin: None,
            length: None,
            beam: None,
            own_speed: None,
            variants: false,
        }
    }
}

/// One of the numbers of [`Assumed`], as a user gives it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Assumption {
    /// Half-width of every target's speed, m/s.
    SpeedSpread,
    /// Half-width of every target's course, degrees.
    CourseSpread,
    /// Kept between the hulls, metres.
    SafetyMargin,
    /// Length of ships without one, metres.
    Length,
    /// Beam of ships without one, metres.
    Beam,
    /// Speed of an own ship without one, m/s.
    OwnSpeed,
}

impl Assumption {
    fn range(self) -> Range {
        match self {
            Self::SpeedSpread => limits::SPEED,
            Self::CourseSpread => limits::COURSE_SPREAD,
            Self::SafetyMargin => limits::DISTANCE,
            Self::Length | Self::Beam => limits::SHIP_LENGTH,
            Self::OwnSpeed => limits::SHIP_WAY,
        }
    }

    /// The allowed values in words.
    pub fn allowed(self) -> String {
        self.range().to_string()
    }

    /// True for an allowed value. A NaN never is.
    pub fn allows(self, value: f64) -> bool {
        self.range().contains(value)
    }
}

impl Assumed {
    /// These assumptions with another value; unchanged if [`Assumption::allows`] refuses it.
    #[must_use]
    pub fn with(mut self, what: Assumption, value: f64) -> Self {
        if !what.allows(value) {
            return self;
        }
        match what {
            Assumption::SpeedSpread => self.speed_spread = value,
            Assumption::CourseSpread => self.course_spread = radians_from_deg(value),
            Assumption::SafetyMargin => self.safety_margin = Some(value),
            Assumption::Length => self.length = Some(value),
            Assumption::Beam => self.beam = Some(value),
            Assumption::OwnSpeed => self.own_speed = Some(value),
        }
        self
    }

    /// These assumptions with or without the variants of cases that are coded in several ways.
    #[must_use]
    pub fn with_variants(mut self, variants: bool) -> Self {
        self.variants = variants;
        self
    }

    /// Metres, for an own ship of this length.
    pub(super) fn safety_margin(&self, own_length: f64) -> f64 {
        self.safety_margin.unwrap_or(own_length)
    }

    pub(super) fn usual_hull(&self) -> Hull {
        Hull::new(
            self.length.unwrap_or(USUAL_HULL.length),
            self.beam.unwrap_or(USUAL_HULL.beam),
        )
    }

    /// Hull of a ship of which only the known sizes are given. Not wider than long.
    pub(super) fn large_hull(&self, length: Option<f64>, beam: Option<f64>) -> Hull {
        let length = length.or(self.length).unwrap_or(LARGE_HULL.length);
        let beam = beam.or(self.beam);
        Hull::new(length, beam.unwrap_or(LARGE_HULL.beam.min(length)))
    }

    /// Hull of a ship whose file lacks its size: only if the user gave one.
    pub(super) fn asked_hull(&self) -> Option<Hull> {
        Some(Hull::new(self.length?, self.beam?))
    }
}
