//! Thresholds of encounters, scores and monitors: three published sets, or a user's own.
//!
//! The planner uses [`Thresholds::STANDARD`], and the limits that a scenario sets instead.

use std::borrow::Cow;
use std::f64::consts::FRAC_PI_6;

use super::Sectors;
use searoom_geometry::frame::radians_from_deg;
use searoom_model::vessel::Hull;

/// A set of thresholds: radians, m/s, seconds, multiples of the longer ship's length, fractions.
#[derive(Debug, Clone, PartialEq)]
pub struct Thresholds {
    /// Name by which it is selected.
    pub name: Cow<'static, str>,
    /// Source of the numbers.
    pub source: Cow<'static, str>,
    /// Encounter sectors.
    pub sectors: Sectors,
    /// Rule 7.
    pub risk: RiskLimits,
    /// Scores and rule violations.
    pub score: ScoreLimits,
    /// Compliance monitors.
    pub monitor: MonitorLimits,
    /// Factor of the times of risk, of ample time, to react and to manoeuvre for own ships of
    /// `LARGE_M` (100 m) and more.
    pub large_factor: f64,
}

/// When risk of collision begins and ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RiskLimits {
    /// Longest time to the closest approach, seconds.
    pub time: f64,
    /// Longest distance of the centres at the closest approach, in lengths.
    pub lengths: f64,
    /// In metres instead; only a scenario sets it.
    pub distance: Option<f64>,
    /// Distance of the hulls, in lengths, at which a target that opens is past and clear.
    pub release_lengths: f64,
    /// Consecutive samples that must agree.
    pub evaluations: usize,
}

/// Thresholds of scores and rule violations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScoreLimits {
    /// Distance of the hulls in lengths: a collision.
    pub collision_lengths: f64,
    /// A near miss.
    pub near_miss_lengths: f64,
    /// The least safe distance.
    pub least_lengths: f64,
    /// The preferred distance.
    pub preferred_lengths: f64,
    /// Penalty between preferred and least distance.
    pub weight_least: f64,
    /// Penalty between least distance and near miss.
    pub weight_near_miss: f64,
    /// Penalty between near miss and collision.
    pub weight_collision: f64,
    /// Rule 8(b): a readily apparent alteration of course.
    pub apparent: f64,
    /// A smaller alteration is none.
    pub steady: f64,
    /// A smaller fraction of the speed is no change of speed.
    pub steady_speed: f64,
    /// A slower turn is none, rad/s.
    pub turn_rate: f64,
    /// Rule 8(b): more small turns are a succession of small alterations.
    pub small_turns: usize,
    /// Rule 14: full score for this turn to starboard.
    pub starboard: f64,
    /// Rule 14: penalty of a smaller turn.
    pub weight_starboard: f64,
    /// Rule 14: penalty of late action.
    pub weight_delay: f64,
    /// Rule 14: penalty of not passing port to port.
    pub weight_side: f64,
    /// Rules 13 and 15: distance ahead of the target in its lengths, or
    pub ahead_lengths: f64,
    /// the distance that the target makes good in this time, if that is longer.
    pub ahead_time: f64,
    /// Rule 13: penalty of passing ahead.
    pub weight_ahead_overtaking: f64,
    /// Rule 15: penalty of crossing ahead.
    pub weight_ahead_crossing: f64,
    /// Rule 17(a)(i): deviation from the course of a ship that holds it.
    pub hold: f64,
    /// Rule 17(a)(ii): distance in lengths at which the stand-on ship may act.
    pub stage_3_lengths: f64,
    /// Rule 17(b): distance in lengths at which it must.
    pub stage_4_lengths: f64,
    /// Stage 3 of an overtaken ship: the time left to the closest approach, in lengths of way that
    /// own ship makes good in it. The ships come near slowly, so a distance would be soon reached.
    pub overtaken_lengths: f64,
    /// Rule 8(a): action is in ample time up to this many seconds before the closest approach.
    pub ample_time: f64,
}

/// Thresholds of the compliance monitors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonitorLimits {
    /// The least avoiding turn; smaller turns are small alterations.
    pub turn: f64,
    /// Time to react, seconds.
    pub react: f64,
    /// Time to manoeuvre, seconds.
    pub manoeuvre: f64,
}

impl RiskLimits {
    /// Longest distance of the centres at the closest approach, metres: within it the hulls may come
    /// nearer than own safety margin, or than the limit.
    pub fn distance(&self, own: &Hull, safety_margin: f64, target: &Hull) -> f64 {
        let limit = self
            .distance
            .unwrap_or(self.lengths * own.length.max(target.length));
        limit.max(safety_margin + own.half_diagonal() + target.half_diagonal())
    }

    /// Part of [`Thresholds::STANDARD`].
    pub const STANDARD: Self = Self {
        time: 420.0,
        lengths: 2.0,
        distance: None,
        release_lengths: 1.5,
        evaluations: 2,
    };
}

impl ScoreLimits {
    /// Part of [`Thresholds::STANDARD`].
    pub const STANDARD: Self = Self {
        collision_lengths: 0.0,
        near_miss_lengths: 0.5,
        least_lengths: 1.0,
        preferred_lengths: 2.0,
        weight_least: 0.2,
        weight_near_miss: 0.3,
        weight_collision: 0.5,
        apparent: FRAC_PI_6,
        steady: radians_from_deg(2.0),
        steady_speed: 0.2,
        turn_rate: radians_from_deg(0.3),
        small_turns: 2,
        starboard: radians_from_deg(10.0),
        weight_starboard: 0.4,
        weight_delay: 0.2,
        weight_side: 0.6,
        ahead_lengths: 3.0,
        ahead_time: 60.0,
        weight_ahead_overtaking: 0.3,
        weight_ahead_crossing: 0.5,
        hold: radians_from_deg(10.0),
        stage_3_lengths: 12.0,
        stage_4_lengths: 4.0,
        overtaken_lengths: 28.0,
        ample_time: 240.0,
    };

    /// Distance ahead of a ship, metres, within which its course line must not be crossed.
    pub fn room_ahead(&self, length: f64, speed: f64) -> f64 {
        (self.ahead_lengths * length).max(self.ahead_time * speed)
    }
}

impl MonitorLimits {
    /// Part of [`Thresholds::STANDARD`].
    pub const STANDARD: Self = Self {
        turn: radians_from_deg(20.0),
        react: 60.0,
        manoeuvre: 70.0,
    };

    /// Seconds in which a ship that keeps clear alters its course.
    pub fn response(&self) -> f64 {
        self.react + 2.0 * self.manoeuvre
    }
}

/// Metres: own ships of this length and more act earlier.
pub const LARGE_M: f64 = 100.0;

static PUBLISHED: [Thresholds; 3] = [
    Thresholds::STANDARD,
    Thresholds::published(
        "dnv-trafficgen",
        "theta14 = 5 deg of the generator of baseline situations; the rest as searoom",
        radians_from_deg(5.0),
        radians_from_deg(10.0),
    ),
    Thresholds::published(
        "sfi-autoship",
        "theta_critical_ho = 13 deg and ranges for ships of the AIS of evaluator.yaml; the rest as searoom",
        radians_from_deg(13.0),
        radians_from_deg(20.0),
    ),
];

impl Thresholds {
    /// The set by which plans are made and judged unless another is asked for.
    pub const STANDARD: Self = Self::published(
        "searoom",
        "scaled by length; weights of an evaluator of the NTNU lineage (evaluator.yaml of the SFI AutoShip simulator)",
        radians_from_deg(10.0),
        radians_from_deg(10.0),
    );

    const fn published(
        name: &'static str,
        source: &'static str,
        head_on: f64,
        starboard: f64,
    ) -> Self {
        Self {
            name: Cow::Borrowed(name),
            source: Cow::Borrowed(source),
            sectors: Sectors {
                head_on,
                ..Sectors::STANDARD
            },
            risk: RiskLimits::STANDARD,
            score: ScoreLimits {
                starboard,
                ..ScoreLimits::STANDARD
            },
            monitor: MonitorLimits::STANDARD,
            large_factor: 3.0,
        }
    }

    /// Factor of the times for an own ship of a length, metres.
    pub fn time_factor(&self, own_length: f64) -> f64 {
        if own_length < LARGE_M {
            1.0
        } else {
            self.large_factor
        }
    }

    /// Rule 7: longest time to the closest approach for an own ship of a length, seconds.
    pub fn risk_time(&self, own_length: f64) -> f64 {
        self.risk.time * self.time_factor(own_length)
    }

    /// Rule 8(a): action is in ample time up to this many seconds before the closest approach.
    pub fn ample_time(&self, own_length: f64) -> f64 {
        self.score.ample_time * self.time_factor(own_length)
    }

    /// [`Thresholds::STANDARD`].
    pub fn standard() -> &'static Self {
        &PUBLISHED[0]
    }

    /// Every published set.
    pub fn all() -> &'static [Self] {
        &PUBLISHED
    }

    /// The published set of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::all().iter().find(|t| t.name == name)
    }
}
