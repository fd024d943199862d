//! The tables `[planner]` and `[planner.optimal_control]`.

use super::{Compliance, limits};
use searoom_colregs::Thresholds;
use searoom_input::text::counted;
use searoom_input::{Field, Range, Table};
use searoom_model::vessel::{ForceVector, StateVector, VesselKind};
use searoom_planner::{
    ControlSettings, Objective, Planner, PlannerSettings, SearchKind, SpaceTimeSettings, Tidiness,
    planner_words,
};

/// The fields of the table `[planner]` that a file has.
#[derive(Debug, Default)]
pub(super) struct PlannerTable {
    pub(super) kind: Option<&'static dyn Planner>,
    pub(super) objective: Option<Objective>,
    pub(super) settings: Option<PlannerSettings>,
    pub(super) search: Option<SearchKind>,
    pub(super) compliance: Option<Compliance>,
    pub(super) time_weight: Option<f64>,
    pub(super) max_risk: Option<f64>,
    pub(super) deadline: Option<f64>,
    ample_time: Option<f64>,
    in_sight: Option<bool>,
    risk_time: Option<f64>,
    risk_distance: Option<f64>,
}

impl PlannerTable {
    /// The standard thresholds with the limits of the file, for an own ship of `length` metres.
    pub(super) fn limits(&self, length: f64) -> Thresholds {
        let mut limits = Thresholds::STANDARD;
        let factor = limits.time_factor(length);
        let [ample, risk] = [self.ample_time, self.risk_time].map(|t| t.map(|t| t / factor));
        limits.score.ample_time = ample.unwrap_or(limits.score.ample_time);
        limits.risk.time = risk.unwrap_or(limits.risk.time);
        limits.risk.distance = self.risk_distance;
        limits.sectors.in_sight = self.in_sight.unwrap_or(true);
        if limits != Thresholds::STANDARD {
            limits.name = "searoom, with the limits of the scenario".into();
        }
        limits
    }
}

/// Reads the table `[planner]` for an own ship of `length` metres.
pub(super) fn planner(mut table: Table, length: f64) -> PlannerTable {
    let optimal_control = control_settings(&mut table, length);
    let (tidy, tidiness) = tidiness(&mut table, length);
    let fields = PlannerTable {
        settings: optimal_control.map(|optimal_control| PlannerSettings {
            optimal_control,
            tidy,
            tidiness,
            space_time: &SpaceTimeSettings::DEFAULT,
        }),
        kind: table.choice("kind", &planner_words()),
        objective: objective(&mut table),
        search: table.choice("search", SearchKind::WORDS),
        compliance: table.choice("compliance", Compliance::WORDS),
        time_weight: table.number("time_weight_m2_per_s2", limits::TIME_WEIGHT),
        max_risk: table.number("max_risk", limits::RISK),
        deadline: table.number("deadline_s", limits::DURATION),
        in_sight: table.choice("visibility", &[("good", true), ("restricted", false)]),
        ample_time: table.number("ample_time_s", limits::BEFORE_CPA),
        risk_time: table.number("tcpa_limit_s", limits::BEFORE_CPA),
        risk_distance: table.distance("cpa_limit", limits::DISTANCE),
    };
    table.finish();
    fields
}

/// Whether plans are tidy, and how.
fn tidiness(table: &mut Table, length: f64) -> (Option<bool>, Tidiness) {
    let tidy = table.take("tidy").and_then(|field| field.truth());
    let default = Tidiness::at_length(length);
    if tidy == Some(false) {
        let because = "nothing: with tidy = false own ship may change its speed at any time";
        table.forbid("min_speed_time_s", because);
        return (tidy, default);
    }
    let speed_time = table.number("min_speed_time_s", limits::SPEED_TIME);
    let tidiness = Tidiness {
        speed_time: speed_time.unwrap_or(default.speed_time),
        ..default
    };
    (tidy, tidiness)
}

/// The objective; only the one that weighs risk has a weight, and needs it.
fn objective(table: &mut Table) -> Option<Objective> {
    use Objective::{Length, SpaceTimeError, Time};
    let weighed = Objective::LengthRisk { weight: 0.0 };
    let all = [SpaceTimeError, Time, Length, weighed]
        .map(|objective| (objective.kind().word(), objective));
    let objective = table.choice("objective", &all);
    if objective == Some(weighed) {
        let weight = table.required_number("risk_weight_m", limits::DISTANCE)?;
        return Some(Objective::LengthRisk { weight });
    }
    let because = "nothing: only the objective \"length-risk\" weighs risk";
    table.forbid("risk_weight_m", because);
    objective
}

/// Settings for a ship of `length` metres; what the table does not set is the default.
fn control_settings(planner: &mut Table, length: f64) -> Option<ControlSettings> {
    let Some(field) = planner.take("optimal_control") else {
        return Some(ControlSettings::at_length(VesselKind::CyberShip2, length));
    };
    let mut table = field.table("a table")?;
    let vessel = table.choice("vessel", &VesselKind::WORDS);
    let default = ControlSettings::at_length(vessel.unwrap_or(VesselKind::CyberShip2), length);
    let settings = ControlSettings {
        force_limits: table.read_or("force_limits", default.force_limits, force_limits),
        intervals: table.read_or("intervals", default.intervals, |field| {
            field.whole_number(limits::INTERVALS)
        }),
        state_weights: table.read_or("state_weights", default.state_weights, |field| {
            let weights = weights::<6>(field, limits::STATE_WEIGHT)?;
            some_weight(field, weights).map(StateVector::from)
        }),
        // sway and yaw are positive to starboard in files, which a square does not see
        force_weights: table.read_or("control_weights", default.force_weights, |field| {
            weights::<3>(field, limits::FORCE_WEIGHT).map(ForceVector::from)
        }),
        ..default
    };
    table.finish();
    Some(settings)
}

fn force_limits(field: &Field) -> Option<ForceVector> {
    let mut table = field.table("a table { surge_n, sway_n, yaw_nm }")?;
    let [surge, sway, yaw] =
        ["surge_n", "sway_n", "yaw_nm"].map(|key| table.required_number(key, limits::FORCE));
    table.finish();
    Some(ForceVector::new(surge?, sway?, yaw?))
}

fn weights<const N: usize>(field: &Field, range: Range) -> Option<[f64; N]> {
    let numbers = field.numbers(range)?;
    let count = numbers.len();
    let weights = <[f64; N]>::try_from(numbers).ok();
    if weights.is_none() {
        field.fault(counted(count, "number"), format_args!("{N} numbers"));
    }
    weights
}

/// State weights of which at least one is positive: without any, the mission has no effect.
fn some_weight(field: &Field, weights: [f64; 6]) -> Option<[f64; 6]> {
    if weights.iter().any(|weight| *weight > 0.0) {
        return Some(weights);
    }
    field.reject(
        "only zeros, with which the mission counts for nothing",
        "at least one number above 0",
    )
}
