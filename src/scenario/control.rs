//! The table `[planner.optimal_control]`.

use super::file::{Entry, Range};
use super::limits;
use super::section::Section;
use crate::planner::ControlSettings;
use crate::vessel::{ForceVector, StateVector, VesselKind};

/// The settings of a planner's table for a ship of this length, metres; the defaults where there is none.
pub(super) fn control_settings(planner: &mut Section, length: f64) -> Option<ControlSettings> {
    let Some(entry) = planner.take("optimal_control") else {
        return Some(ControlSettings::at_length(VesselKind::CyberShip2, length));
    };
    let mut section = entry.section("a table")?;
    let vessel = if section.has("vessel") {
        section.choice("vessel", &VesselKind::WORDS)
    } else {
        Some(VesselKind::CyberShip2)
    };
    let limits = match section.take("force_limits") {
        Some(entry) => force_limits(&entry).map(Some),
        None => Some(None),
    };
    let intervals = match section.take("intervals") {
        Some(entry) => intervals(&entry).map(Some),
        None => Some(None),
    };
    let state = match section.take("state_weights") {
        Some(entry) => weights::<6>(&entry, limits::STATE_WEIGHT)
            .and_then(|weights| some_weight(&entry, weights))
            .map(Some),
        None => Some(None),
    };
    let force = match section.take("control_weights") {
        Some(entry) => weights::<3>(&entry, limits::FORCE_WEIGHT).map(Some),
        None => Some(None),
    };
    section.finish();
    let default = ControlSettings::at_length(vessel?, length);
    Some(ControlSettings {
        force_limits: limits?.unwrap_or(default.force_limits),
        intervals: intervals?.unwrap_or(default.intervals),
        state_weights: state?.map_or(default.state_weights, StateVector::from),
        // sway and yaw have the sign of starboard in files, which a square does not see
        force_weights: force?.map_or(default.force_weights, ForceVector::from),
        ..default
    })
}

fn force_limits(entry: &Entry) -> Option<ForceVector> {
    let mut section = entry.section("a table { surge_n, sway_n, yaw_nm }")?;
    let [surge, sway, yaw] =
        ["surge_n", "sway_n", "yaw_nm"].map(|key| section.required_number(key, limits::FORCE));
    section.finish();
    Some(ForceVector::new(surge?, sway?, yaw?))
}

fn intervals(entry: &Entry) -> Option<usize> {
    let number = entry.number(limits::INTERVALS)?;
    if number.fract() == 0.0 {
        Some(number as usize)
    } else {
        let Range { low, high, .. } = limits::INTERVALS;
        entry.refuse(format_args!("a whole number from {low} to {high}"))
    }
}

/// A list of exactly `N` weights.
fn weights<const N: usize>(entry: &Entry, range: Range) -> Option<[f64; N]> {
    let numbers = entry.numbers(range)?;
    let count = numbers.len();
    let weights = <[f64; N]>::try_from(numbers).ok();
    if weights.is_none() {
        let plural = if count == 1 { "" } else { "s" };
        entry.fault(
            format_args!("{count} number{plural}"),
            format_args!("{N} numbers"),
        );
    }
    weights
}

/// Without any weight on the states the mission counts for nothing.
fn some_weight(entry: &Entry, weights: [f64; 6]) -> Option<[f64; 6]> {
    if weights.iter().any(|weight| *weight > 0.0) {
        return Some(weights);
    }
    entry.fault(
        "only zeros, with which the mission counts for nothing",
        "at least one number above 0",
    );
    None
}

#[cfg(test)]
mod tests {
    use super::super::{Fault, Scenario};
    use super::*;

    const LEAST: &str = r#"
title = "least"
horizon_s = 100
own_ship = { position = { east_m = 0, north_m = 0 }, course_deg = 90, speed_mps = 0.2, length_m = 1.255, beam_m = 0.29, turning_radius_m = 2 }
mission = { waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 20, north_m = 0 }] }
[planner]
kind = "optimal-control"
"#;

    fn settings(table: &str) -> Result<ControlSettings, Vec<String>> {
        let text = format!("{LEAST}[planner.optimal_control]\n{table}");
        let faults = |faults: Vec<Fault>| faults.into_iter().map(|f| f.path).collect();
        Scenario::parse(&text).map(|s| s.control).map_err(faults)
    }

    #[test]
    fn the_vessel_is_as_long_as_own_ship() {
        for length in [0.5, 1.255, 30.0, 300.0] {
            let text = LEAST.replace("1.255", &length.to_string());
            let found = Scenario::parse(&text).expect("valid").control;
            let vessel = VesselKind::CyberShip2;
            assert_eq!(found, ControlSettings::at_length(vessel, length));
        }
    }

    #[test]
    fn what_is_left_out_is_that_of_the_ship() {
        let default = ControlSettings::of(VesselKind::CyberShip2);
        assert_eq!(settings(""), Ok(default));
        assert_eq!(default.force_limits, ForceVector::new(2.0, 1.5, 1.5));
        // the same by another word
        let full = "vessel = \"cybership2-full\"";
        assert_eq!(settings(full), Ok(default));
        let given = "intervals = 80\nforce_limits = { surge_n = 1, sway_n = 0.5, yaw_nm = 0.25 }\n\
                     state_weights = [1, 2, 3, 4, 5, 6]\ncontrol_weights = [7, 8, 9]";
        let given = settings(given).expect("valid");
        assert_eq!(given.intervals, 80);
        assert_eq!(given.force_limits, ForceVector::new(1.0, 0.5, 0.25));
        assert_eq!(
            given.state_weights,
            StateVector::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
        );
        assert_eq!(given.force_weights, ForceVector::new(7.0, 8.0, 9.0));
    }

    #[test]
    fn one_mistake_is_one_fault() {
        for (table, path) in [
            ("vessel = \"tanker\"", "vessel"),
            ("intervals = 0", "intervals"),
            ("intervals = 12.5", "intervals"),
            ("intervals = 2001", "intervals"),
            (
                "force_limits = { surge_n = 0, sway_n = 1, yaw_nm = 1 }",
                "force_limits.surge_n",
            ),
            (
                "force_limits = { surge_n = 1, sway_n = -1, yaw_nm = 1 }",
                "force_limits.sway_n",
            ),
            (
                "force_limits = { surge_n = 1, sway_n = 1 }",
                "force_limits.yaw_nm",
            ),
            ("state_weights = [1, 1, 1, 1, 1]", "state_weights"),
            ("state_weights = [1, 1, -1, 1, 1, 1]", "state_weights[2]"),
            ("state_weights = [0, 0, 0, 0, 0, 0]", "state_weights"),
            ("control_weights = [1, 0, 1]", "control_weights[1]"),
            ("control_weights = [1, nan, 1]", "control_weights[1]"),
            ("weights = [1]", "weights"),
        ] {
            let path = format!("planner.optimal_control.{path}");
            assert_eq!(settings(table), Err(vec![path]), "{table}");
        }
    }
}
