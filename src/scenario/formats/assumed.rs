//! What is assumed where a foreign file says nothing.

use super::super::file::Range;
use super::super::limits;
use crate::frame::radians_from_deg;
use crate::vessel::Hull;

/// Half-width of a target's speed where nobody says otherwise, m/s.
const SPEED_SPREAD: f64 = 0.5;

/// Half-width of a target's course where nobody says otherwise, degrees.
const COURSE_SPREAD_DEG: f64 = 5.0;

/// Hull of a ship for which its format has no place: 100 × 20 m, the size that published runs of Imazu's cases assume.
pub(super) const USUAL_HULL: Hull = Hull {
    length: 100.0,
    beam: 20.0,
};

/// Own ship's least turning radius, in own lengths: a tactical diameter of five lengths, the most that IMO
/// resolution MSC.137(76) allows.
pub(super) const TURNING_LENGTHS: f64 = 2.5;

/// The horizon, in durations of own ship's route: room to let a slower ship go ahead all the way.
pub(super) const HORIZON_ROUTES: f64 = 2.0;

/// What foreign files do not say and a scenario needs. The default is that of `docs/formats.md`.
///
/// # Examples
///
/// ```
/// use searoom::scenario::formats::{Assumed, Assumption, Contents};
///
/// let assumed = Assumed::default().with(Assumption::SafetyMargin, 500.0).with_variants(true);
/// let Contents::Situations { situations, .. } = Contents::read("scenarios/imazu/imazu.json".as_ref(), &assumed)? else {
///     panic!("situations");
/// };
/// assert_eq!((assumed.variants(), situations.len()), (true, 25));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Assumed {
    speed_spread: f64,
    course_spread: f64,
    safety_margin: Option<f64>,
    length: Option<f64>,
    beam: Option<f64>,
    variants: bool,
}

impl Default for Assumed {
    fn default() -> Self {
        Self {
            speed_spread: SPEED_SPREAD,
            course_spread: radians_from_deg(COURSE_SPREAD_DEG),
            safety_margin: None,
            length: None,
            beam: None,
            variants: false,
        }
    }
}

/// One of the numbers of [`Assumed`], as a user gives it.
///
/// # Examples
///
/// ```
/// use searoom::scenario::formats::Assumption;
///
/// assert!(Assumption::CourseSpread.allows(5.0) && !Assumption::CourseSpread.allows(f64::NAN));
/// assert!(!Assumption::SpeedSpread.allows(-1.0));
/// assert_eq!(Assumption::SpeedSpread.allowed(), "a number from 0 to 100");
/// ```
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
}

impl Assumption {
    fn range(self) -> Range {
        match self {
            Self::SpeedSpread => limits::SPEED,
            Self::CourseSpread => limits::COURSE_SPREAD,
            Self::SafetyMargin => limits::DISTANCE,
            Self::Length | Self::Beam => limits::SHIP_LENGTH,
        }
    }

    /// What it may be, in words.
    pub fn allowed(self) -> String {
        self.range().to_string()
    }

    /// True for what it may be. A NaN never is.
    pub fn allows(self, value: f64) -> bool {
        self.range().contains(value)
    }
}

impl Assumed {
    /// The same with another value; unchanged where [`Assumption::allows`] says no.
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
        }
        self
    }

    /// The same with the variants of cases that are coded in more than one way, or without.
    #[must_use]
    pub fn with_variants(mut self, variants: bool) -> Self {
        self.variants = variants;
        self
    }

    /// True when variants are to be read too.
    pub fn variants(&self) -> bool {
        self.variants
    }

    /// m/s.
    pub(super) fn speed_spread(&self) -> f64 {
        self.speed_spread
    }

    /// Radians.
    pub(super) fn course_spread(&self) -> f64 {
        self.course_spread
    }

    /// Metres, for an own ship of this length.
    pub(super) fn safety_margin(&self, own_length: f64) -> f64 {
        self.safety_margin.unwrap_or(own_length)
    }

    /// The hull of a ship for which the format has no place.
    pub(super) fn usual_hull(&self) -> Hull {
        Hull {
            length: self.length.unwrap_or(USUAL_HULL.length),
            beam: self.beam.unwrap_or(USUAL_HULL.beam),
        }
    }

    /// The hull of a ship that ought to have said how large she is: only what was asked for.
    pub(super) fn asked_hull(&self) -> Option<Hull> {
        Some(Hull {
            length: self.length?,
            beam: self.beam?,
        })
    }
}
