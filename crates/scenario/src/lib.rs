#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod applicability;
mod check;
mod explicit_sets;
pub mod import;
mod land;
mod limits;
pub mod map;
mod memory;
mod open_water;
mod out_of_reach;
mod plane;
mod planner;
mod route;
mod schema;
mod simulation;
mod speed_limits;
mod status;
mod targets;
#[cfg(test)]
mod tests;
mod thresholds;

pub use land::Land;
pub use limits::FILE_MEBIBYTES;
pub use memory::Memory;
pub use open_water::{open_water, simulation_of, true_motion};
pub use out_of_reach::{DistantTarget, MOST_WITHOUT_SELECTION, OutOfReach};
pub use schema::scenario_schema;
pub use searoom_input::{Fault, InputError as ScenarioError, Remarks};
pub use searoom_model::{BehaviourKind, Compliance, SensorType};
pub use simulation::{
    Behaviour, Current, Noise, NotReported, Sensor, SensorKind, SimulatedTarget,
    SimulationSettings, VesselModel,
};
pub use speed_limits::SpeedLimit;
pub use thresholds::{parse_thresholds, read_thresholds, thresholds_schema};

use std::path::Path;
use std::sync::Arc;

use chrono::{DateTime, TimeDelta, Utc};
use planner::PlannerTable;

use searoom_colregs::Thresholds;
use searoom_geometry::frame::{Geographic, Georeference, Vector};
use searoom_input::{Faults, read_text};
use searoom_model::target::Target;
use searoom_model::trajectory::{DesiredTrajectory, Trajectory};
use searoom_model::vessel::OwnShip;
use searoom_planner::{Objective, Planner, PlannerSettings, SearchKind, Tidiness};

/// A checked scenario in SI units and the east-north plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// The scenario's title.
    pub title: String,
    /// The present on the clock of the file, seconds. All other times count from it.
    pub time: f64,
    /// The date and time at 0 s on the clock of the file, if it is known.
    pub start: Option<DateTime<Utc>>,
    /// Planning horizon, seconds.
    pub horizon: f64,
    /// Seconds after arrival for which own ship is observed at its berth; no effect on plans.
    pub arrival_hold: f64,
    /// Own ship.
    pub own_ship: OwnShip,
    /// How fast own ship changes its speed, m/s²; `None` where that is not known.
    pub acceleration: Option<f64>,
    /// The desired trajectory from the present on.
    pub desired: DesiredTrajectory,
    /// Time until which own ship lies at the last waypoint after its arrival, seconds, at most the
    /// horizon; `None` where the mission ends with the arrival.
    pub stay: Option<f64>,
    /// The legs of a route with the highest speeds that they allow, without effect on plans; empty
    /// where it has no such limit.
    pub speed_limits: Vec<SpeedLimit>,
    /// Other allowed paths, metres; for the path-time planner.
    pub alternatives: Vec<Vec<Vector>>,
    /// The targets.
    pub targets: Vec<Target>,
    /// Targets that no plan considers; none before [`Self::set_aside_out_of_reach`].
    pub out_of_reach: Arc<OutOfReach>,
    /// The planner.
    pub planner: &'static dyn Planner,
    /// The planner's objective.
    pub objective: Objective,
    /// Settings of the planners that have some.
    pub settings: PlannerSettings,
    /// The search algorithm.
    pub search: SearchKind,
    /// The sets to avoid.
    pub compliance: Compliance,
    /// Weight `q` of paper eq. (30), m²/s².
    pub time_weight: f64,
    /// Risk of paper eq. (25) that the plan may accept, in `[0, 1)`.
    pub max_risk: f64,
    /// Wall-clock budget of one plan, seconds.
    pub deadline: f64,
    /// The thresholds by which roles are found and manoeuvres planned.
    pub limits: Arc<Thresholds>,
    /// Thresholds of the judges, without effect on plans; `None` for those of the plan.
    pub thresholds: Option<Arc<Thresholds>>,
    /// Place of the plane on the earth, if it is known.
    pub earth: Option<Georeference>,
    /// The land, if there is a map.
    pub land: Option<Land>,
    /// Memory from before the present.
    pub memory: Memory,
    /// How the scenario is sailed in the closed loop, without effect on plans.
    pub simulation: SimulationSettings,
    /// Content of its files that no plan uses, without effect on plans.
    pub remarks: Remarks,
}

impl Scenario {
    /// A scenario in open water with the defaults of a file (docs/reference/scenario.md). Change
    /// its fields as needed. [`Self::unfit`] names what its planner cannot use.
    pub fn new(
        title: &str,
        horizon: f64,
        own_ship: OwnShip,
        desired: DesiredTrajectory,
        targets: Vec<Target>,
    ) -> Self {
        let tracked = targets.iter().any(|target| target.ship().is_some());
        let planner = PlannerTable::default();
        Self {
            targets,
            ..check::bare(title, horizon, own_ship, desired, planner, tracked)
        }
    }

    /// The cautions of the files, and that a motion exceeds the speed limits of the route.
    pub fn cautions(&self, motion: Option<&Trajectory>) -> Vec<String> {
        let mut remarks = self.remarks.clone();
        let corner = self.own_ship.turning_radius;
        let exceeded = motion.and_then(|m| speed_limits::exceeded(&self.speed_limits, m, corner));
        if let Some((subject, statement)) = exceeded {
            remarks.caution(subject, statement);
        }
        remarks.cautions
    }

    /// How tidy plans are; `None` for the least cost alone. Plans are tidy where the file asks for
    /// it, and under the rules unless it asks otherwise.
    pub fn tidiness(&self) -> Option<Tidiness> {
        let by_default = self.compliance == Compliance::Rules;
        let is_tidy = self.settings.tidy.unwrap_or(by_default);
        is_tidy.then_some(self.settings.tidiness)
    }

    /// Reads and checks a scenario file (docs/reference/scenario.md). The error holds every fault
    /// of the file.
    pub fn read(file: &Path) -> Result<Self, ScenarioError> {
        let text = read_text(file, limits::FILE_MEBIBYTES, "a scenario file")?;
        let folder = file.parent().unwrap_or(Path::new(""));
        Self::parse_beside(&text, folder).map_err(|faults| ScenarioError::faults(file, faults))
    }

    /// Changes the planner. Ship domains replace the rules for a planner that keeps none.
    pub fn set_planner(&mut self, planner: &'static dyn Planner) {
        self.planner = planner;
        if !planner.facts().keeps_rules && self.compliance == Compliance::Rules {
            self.compliance = Compliance::Shape;
        }
    }

    /// The date and time of the present, if it is known.
    pub fn present(&self) -> Option<DateTime<Utc>> {
        after(self.start?, self.time)
    }

    /// Thresholds of the judges.
    pub fn judged_by(&self) -> &Thresholds {
        self.thresholds.as_deref().unwrap_or(&self.limits)
    }

    /// Every reason why the scenario's planner cannot plan it; faults without lines.
    pub fn unfit(&self) -> Vec<Fault> {
        applicability::unfit(self)
    }

    /// Faults without lines, such as those of [`Self::unfit`], with their lines in the text of the
    /// scenario.
    pub fn located(text: &str, faults: Vec<Fault>) -> Vec<Fault> {
        check::located(text, faults)
    }

    /// True for an allowed `max_risk`.
    pub fn allows_max_risk(risk: f64) -> bool {
        limits::RISK.contains(risk)
    }

    /// The allowed `max_risk` in words.
    pub fn max_risk_allowed() -> String {
        limits::RISK.to_string()
    }

    /// Checks the text of a scenario file. The error holds every fault, in order of lines.
    ///
    /// Courses from -360° to 360° are accepted, coordinates up to 10,000 km, speeds up to 100 m/s
    /// and times up to 1,000,000 s. A map is searched from the current folder.
    pub fn parse(text: &str) -> Result<Self, Vec<Fault>> {
        Self::parse_beside(text, Path::new(""))
    }

    /// [`Scenario::parse`] for a file in `folder`, from where its map is searched.
    pub fn parse_beside(text: &str, folder: &Path) -> Result<Self, Vec<Fault>> {
        Self::checked(text, folder, None)
    }

    /// [`Scenario::parse_beside`] with own ship where it is now, in place of the file's position, course
    /// and speed. A mission on a route that begins at the nearest place begins there. Needs an `origin`.
    pub fn parse_at(text: &str, folder: &Path, now: &OwnNow) -> Result<Self, Vec<Fault>> {
        Self::checked(text, folder, Some(now))
    }

    fn checked(text: &str, folder: &Path, now: Option<&OwnNow>) -> Result<Self, Vec<Fault>> {
        let faults = Faults::default();
        match check::parse(text, folder, now, &faults) {
            Some(scenario) if faults.is_empty() => Ok(scenario),
            _ => Err(faults.take()),
        }
    }
}

/// Own ship at sea, where a file has it somewhere else.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnNow {
    /// The middle of its hull.
    pub place: Geographic,
    /// Radians on the plane of the file.
    pub heading: f64,
    /// m/s.
    pub speed: f64,
}

/// The date and time of seconds of Unix time; `None` beyond the calendar.
pub fn unix_time(seconds: f64) -> Option<DateTime<Utc>> {
    after(DateTime::UNIX_EPOCH, seconds)
}

/// Seconds of Unix time of a date and time of RFC 3339; `None` for another text.
pub fn unix_seconds(text: &str) -> Option<f64> {
    Some(1e-3 * searoom_input::date_time(text)?.timestamp_millis() as f64)
}

/// The date and time so many seconds later, to a millisecond; `None` beyond the calendar.
pub fn after(start: DateTime<Utc>, seconds: f64) -> Option<DateTime<Utc>> {
    let milliseconds = (1e3 * seconds).round() as i64;
    start.checked_add_signed(TimeDelta::try_milliseconds(milliseconds)?)
}
