//! What encounters, scores and monitors are measured by: numbers of `thresholds.toml`, by name.

use std::sync::LazyLock;

use serde::Deserialize;

use super::super::role::Sectors;
use crate::frame::radians_from_deg;

/// The one file that holds the numbers.
const FILE: &str = include_str!("thresholds.toml");

/// A published set of numbers. Angles in radians, speeds in m/s, times in seconds, lengths in multiples of the longer
/// ship's, weights and shares without a unit; what each is for stands in `thresholds.toml`.
///
/// # Examples
///
/// ```
/// use searoom::colregs::conduct::Thresholds;
///
/// let names: Vec<&str> = Thresholds::all().iter().map(|profile| profile.name.as_str()).collect();
/// assert_eq!(names, ["searoom", "dnv-trafficgen", "sfi-autoship"]);
/// let [own, dnv] = ["searoom", "dnv-trafficgen"].map(|name| Thresholds::named(name).expect("a profile"));
/// assert!(dnv.sectors.head_on < own.sectors.head_on);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Thresholds {
    /// What it is asked for by.
    pub name: String,
    /// Where the numbers come from.
    pub source: String,
    /// Of the encounter.
    pub sectors: Sectors,
    /// Rule 7.
    pub risk: RiskLimits,
    /// Of the scores.
    pub score: ScoreLimits,
    /// Of the monitors.
    pub monitor: MonitorLimits,
}

/// When there is risk of collision, and when no longer.
///
/// # Examples
///
/// ```
/// use searoom::colregs::conduct::{RiskLimits, Thresholds};
///
/// let profile = Thresholds::standard().expect("the profile of the program");
/// let RiskLimits { time, lengths, .. } = profile.risk;
/// assert_eq!((time, lengths), (420.0, 2.0), "seconds ahead, and lengths between the ships");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "named as in thresholds.toml")]
pub struct RiskLimits {
    pub time: f64,
    pub lengths: f64,
    pub release_factor: f64,
    pub evaluations: usize,
}

/// What the scores are measured by.
///
/// # Examples
///
/// ```
/// use searoom::colregs::conduct::{ScoreLimits, Thresholds};
///
/// let profile = Thresholds::standard().expect("the profile of the program");
/// let score: &ScoreLimits = &profile.score;
/// let weights = score.weight_least + score.weight_near_miss + score.weight_collision;
/// assert!((weights - 1.0).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "named as in thresholds.toml")]
pub struct ScoreLimits {
    pub collision_lengths: f64,
    pub near_miss_lengths: f64,
    pub least_lengths: f64,
    pub preferred_lengths: f64,
    pub weight_least: f64,
    pub weight_near_miss: f64,
    pub weight_collision: f64,
    pub apparent: f64,
    pub steady: f64,
    pub steady_speed: f64,
    pub turn_rate: f64,
    pub small_turns: usize,
    pub starboard: f64,
    pub weight_starboard: f64,
    pub weight_delay: f64,
    pub weight_side: f64,
    pub ahead_lengths: f64,
    pub ahead_time: f64,
    pub weight_ahead_overtaking: f64,
    pub weight_ahead_crossing: f64,
    pub hold: f64,
    pub stage_3_lengths: f64,
}

/// What the monitors are measured by.
///
/// # Examples
///
/// ```
/// use searoom::colregs::conduct::{MonitorLimits, Thresholds};
///
/// let profile = Thresholds::standard().expect("the profile of the program");
/// let MonitorLimits { react, manoeuvre, .. } = profile.monitor;
/// assert_eq!((react, manoeuvre), (60.0, 70.0), "seconds");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "named as in thresholds.toml")]
pub struct MonitorLimits {
    pub turn: f64,
    pub hold: f64,
    pub lengths: f64,
    pub time: f64,
    pub react: f64,
    pub manoeuvre: f64,
}

static TABLES: LazyLock<Vec<toml::Table>> = LazyLock::new(|| tables(FILE).unwrap_or_default());

static ALL: LazyLock<Vec<Thresholds>> = LazyLock::new(|| {
    let entries = TABLES.iter().cloned().map(|t| t.try_into::<Entry>());
    let all: Result<Vec<Entry>, _> = entries.collect();
    all.map_or_else(
        |_| Vec::new(),
        |all| all.into_iter().map(Entry::thresholds).collect(),
    )
});

/// The published sets as they are written, none `like` another any more.
pub(super) fn published() -> &'static [toml::Table] {
    &TABLES
}

impl Thresholds {
    /// Every set, in the order of the file.
    pub fn all() -> &'static [Self] {
        &ALL
    }

    /// The first set, by which is judged where no other is asked for.
    pub fn standard() -> Option<&'static Self> {
        Self::all().first()
    }

    /// The set of a name; `None` when there is none.
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::all().iter().find(|t| t.name == name)
    }
}

/// The entries of a file, one that is `like` another completed from that.
fn tables(text: &str) -> Result<Vec<toml::Table>, toml::de::Error> {
    #[derive(Deserialize)]
    struct File {
        profile: Vec<toml::Table>,
    }
    let file: File = toml::from_str(text)?;
    let mut tables: Vec<toml::Table> = Vec::new();
    for entry in file.profile {
        let like = entry.get("like").cloned();
        let base = tables
            .iter()
            .find(|t| like.is_some() && t.get("name") == like.as_ref());
        let mut table = base.cloned().unwrap_or_default();
        table.extend(entry.into_iter().filter(|(key, _)| key != "like"));
        tables.push(table);
    }
    Ok(tables)
}

/// An entry as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Entry {
    name: String,
    source: String,
    head_on_deg: f64,
    abaft_the_beam_deg: f64,
    at_rest_mps: f64,
    closing_mps: f64,
    risk_time_s: f64,
    risk_lengths: f64,
    release_factor: f64,
    evaluations: usize,
    collision_lengths: f64,
    near_miss_lengths: f64,
    least_lengths: f64,
    preferred_lengths: f64,
    weight_least: f64,
    weight_near_miss: f64,
    weight_collision: f64,
    apparent_deg: f64,
    steady_deg: f64,
    steady_speed: f64,
    turn_rate_deg_per_s: f64,
    small_turns: usize,
    starboard_deg: f64,
    weight_starboard: f64,
    weight_delay: f64,
    weight_side: f64,
    ahead_lengths: f64,
    ahead_s: f64,
    weight_ahead_overtaking: f64,
    weight_ahead_crossing: f64,
    hold_deg: f64,
    stage_3_lengths: f64,
    monitor_turn_deg: f64,
    monitor_lengths: f64,
    monitor_time_s: f64,
    react_s: f64,
    manoeuvre_s: f64,
}

impl Entry {
    pub(super) fn thresholds(self) -> Thresholds {
        let angle = radians_from_deg;
        Thresholds {
            sectors: Sectors {
                head_on: angle(self.head_on_deg),
                abaft_the_beam: angle(self.abaft_the_beam_deg),
                at_rest: self.at_rest_mps,
                closing: self.closing_mps,
            },
            risk: RiskLimits {
                time: self.risk_time_s,
                lengths: self.risk_lengths,
                release_factor: self.release_factor,
                evaluations: self.evaluations,
            },
            score: ScoreLimits {
                collision_lengths: self.collision_lengths,
                near_miss_lengths: self.near_miss_lengths,
                least_lengths: self.least_lengths,
                preferred_lengths: self.preferred_lengths,
                weight_least: self.weight_least,
                weight_near_miss: self.weight_near_miss,
                weight_collision: self.weight_collision,
                apparent: angle(self.apparent_deg),
                steady: angle(self.steady_deg),
                steady_speed: self.steady_speed,
                turn_rate: angle(self.turn_rate_deg_per_s),
                small_turns: self.small_turns,
                starboard: angle(self.starboard_deg),
                weight_starboard: self.weight_starboard,
                weight_delay: self.weight_delay,
                weight_side: self.weight_side,
                ahead_lengths: self.ahead_lengths,
                ahead_time: self.ahead_s,
                weight_ahead_overtaking: self.weight_ahead_overtaking,
                weight_ahead_crossing: self.weight_ahead_crossing,
                hold: angle(self.hold_deg),
                stage_3_lengths: self.stage_3_lengths,
            },
            monitor: MonitorLimits {
                turn: angle(self.monitor_turn_deg),
                hold: angle(self.hold_deg),
                lengths: self.monitor_lengths,
                time: self.monitor_time_s,
                react: self.react_s,
                manoeuvre: self.manoeuvre_s,
            },
            name: self.name,
            source: self.source,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_sets_are_found_by_name_and_the_first_is_what_planners_use() {
        let head_on = |name| Thresholds::named(name).map(|t| t.sectors.head_on);
        let degrees = |d: f64| Some(radians_from_deg(d));
        assert_eq!(head_on("searoom"), degrees(10.0));
        assert_eq!(head_on("dnv-trafficgen"), degrees(5.0));
        assert_eq!(head_on("sfi-autoship"), degrees(13.0));
        assert_eq!(head_on("nobody"), None);
        let default = Thresholds::standard().expect("the file is read");
        assert_eq!(Thresholds::all().len(), 3);
        let (a, b) = (default.sectors, Sectors::default());
        for (a, b) in [
            (a.head_on, b.head_on),
            (a.abaft_the_beam, b.abaft_the_beam),
            (a.at_rest, b.at_rest),
            (a.closing, b.closing),
        ] {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
        for t in Thresholds::all() {
            let s = &t.score;
            assert!(!t.source.is_empty());
            assert!((s.weight_least + s.weight_near_miss + s.weight_collision - 1.0).abs() < 1e-12);
            assert!(s.collision_lengths < s.near_miss_lengths);
            assert!(s.near_miss_lengths < s.least_lengths && s.least_lengths < s.preferred_lengths);
        }
    }
}
