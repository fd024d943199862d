//! A scenario: read from a file, checked in full, then without invalid state.

mod check;
mod control;
mod explicit_sets;
mod fault;
mod file;
mod fitness;
pub mod formats;
mod land;
mod limits;
mod plane;
mod reading;
mod section;
mod targets;

pub use fault::{Fault, ScenarioError};
pub use land::Land;

use std::path::Path;
use std::sync::Arc;

use crate::colregs::conduct::Thresholds;
use crate::frame::{Georeference, Vector};
use crate::planner::{ControlSettings, Objective, PlannerKind, SearchKind};
use crate::target::Target;
use crate::trajectory::DesiredTrajectory;
use crate::vessel::OwnShip;

/// How far a plan follows the rules of the road.
///
/// # Examples
///
/// ```
/// use searoom::scenario::Compliance;
///
/// assert_eq!((Compliance::Rules.word(), Compliance::Rules.shapes()), ("rules", true));
/// assert!(!Compliance::None.shapes(), "hulls and margins alone");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compliance {
    /// The hard sets alone.
    None,
    /// The shaped sets, so that the cheapest plan follows the rules of the road.
    Shape,
    /// The shaped sets, and what they do not achieve by filters: only alterations that are readily apparent, to the right side.
    Rules,
}

/// A checked scenario, SI and east-north.
///
/// ```
/// use searoom::scenario::{Compliance, Fault, Scenario, ScenarioError};
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// assert_eq!((scenario.title.as_str(), scenario.targets.len()), ("Head-on", 1));
/// assert_eq!(scenario.compliance, Compliance::Shape);
/// // every fault of a file at once
/// let faults: Vec<Fault> = Scenario::parse("title = 3").expect_err("much is missing");
/// assert!(faults.iter().any(|fault| fault.path == "title"), "{faults:?}");
/// # Ok::<(), ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// The scenario's title.
    pub title: String,
    /// Seconds.
    pub horizon: f64,
    /// For how long after its arrival own ship is looked at where it lies, seconds, of no effect on plans.
    pub arrival_hold: f64,
    /// Own ship.
    pub own_ship: OwnShip,
    /// Where she is meant to be, and when.
    pub desired: DesiredTrajectory,
    /// Other paths that she may sail, metres; for the path-time planner.
    pub alternatives: Vec<Vec<Vector>>,
    /// The others.
    pub targets: Vec<Target>,
    /// Which planner.
    pub planner: PlannerKind,
    /// What it minimises.
    pub objective: Objective,
    /// What the optimal-control planner needs besides.
    pub control: ControlSettings,
    /// Which search.
    pub search: SearchKind,
    /// Which sets.
    pub compliance: Compliance,
    /// `q` of eq. (30), m²/s².
    pub time_weight: f64,
    /// The risk of eq. (25) that the plan may accept, in `[0, 1)`.
    pub max_risk: f64,
    /// Wall-clock budget of one plan, seconds.
    pub deadline: f64,
    /// What own ship's behaviour is judged by, of no effect on plans; `None` for the first published set.
    pub thresholds: Option<Arc<Thresholds>>,
    /// Where the plane lies on the earth, where that is known.
    pub earth: Option<Georeference>,
    /// The land, where there is a map.
    pub land: Option<Land>,
}

impl Scenario {
    /// Reads and checks a scenario file (docs/scenario.md). Every fault of the file is in the
    /// error, not only the first.
    pub fn read(file: &Path) -> Result<Self, ScenarioError> {
        let text = reading::text_of(file, limits::FILE_BYTES)?;
        let folder = file.parent().unwrap_or(Path::new(""));
        Self::parse_beside(&text, folder).map_err(|faults| ScenarioError::Faults {
            file: file.to_owned(),
            faults,
        })
    }

    /// The thresholds of the judges of the rules: its own, or the first published set.
    pub fn judged_by(&self) -> Option<&Thresholds> {
        match &self.thresholds {
            Some(own) => Some(own),
            None => Thresholds::standard(),
        }
    }

    /// What keeps the planner that the scenario asks for from planning it; every fault, without lines.
    pub fn unfit(&self) -> Vec<Fault> {
        fitness::unfit(self)
    }

    /// True for what `max_risk` may be.
    pub fn allows_max_risk(risk: f64) -> bool {
        limits::RISK.contains(risk)
    }

    /// What `max_risk` may be, in words.
    pub fn max_risk_allowed() -> String {
        limits::RISK.to_string()
    }

    /// Checks the text of a scenario file. The error holds every fault, in order of lines.
    ///
    /// Courses may be given from -360° to 360°; coordinates up to 10,000 km, speeds up to 100 m/s and
    /// times up to 1,000,000 s are accepted. A time weight that is left out is the square of the
    /// mission's mean speed. A map is looked for from the current folder.
    pub fn parse(text: &str) -> Result<Self, Vec<Fault>> {
        Self::parse_beside(text, Path::new(""))
    }

    /// The same for a file in `folder`: from there its map is looked for.
    pub fn parse_beside(text: &str, folder: &Path) -> Result<Self, Vec<Fault>> {
        let source = file::Source::new(text);
        let scenario = check::text(&source, text, folder);
        let faults = source.into_faults();
        match scenario {
            Some(scenario) if faults.is_empty() => Ok(scenario),
            _ => Err(faults),
        }
    }
}

impl Compliance {
    /// The word for it in files and on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Shape => "shape",
            Self::Rules => "rules",
        }
    }

    /// True where the shaped sets are kept out of.
    pub fn shapes(self) -> bool {
        match self {
            Self::None => false,
            Self::Shape | Self::Rules => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Vector, mps_from_knots};
    use crate::target::{DomainKind, Motion};

    const LEAST: &str = r#"
title = "least"
horizon_s = 400
[own_ship]
position = { east_m = 0, north_m = 0 }
course_deg = 90
speed_mps = 5
length_m = 30
beam_m = 8
turning_radius_m = 100
[mission]
waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 1500, north_m = 0 }, { east_m = 1500, north_m = 400 }]
"#;

    const SHIP: &str = r#"
[[targets]]
name = "ship"
position = { east_m = 1500, north_m = 0 }
course_deg = -90
speed_kn = 10
length_m = 60
beam_m = 12
"#;

    fn paths(text: &str) -> Vec<String> {
        let faults = Scenario::parse(text).expect_err("faulty");
        faults.into_iter().map(|fault| fault.path).collect()
    }

    #[test]
    fn what_is_left_out_takes_the_defaults_of_the_contract() {
        let scenario = Scenario::parse(&format!("{LEAST}{SHIP}")).expect("valid");
        let own = &scenario.own_ship;
        assert_eq!(own.speeds, [2.5, 5.0, 6.0]);
        assert_eq!(own.safety_margin, 30.0);
        assert!(own.pose.heading.abs() < 1e-15);
        assert!(scenario.desired.legs().iter().all(|leg| leg.speed == 5.0));
        assert!((scenario.time_weight - 25.0).abs() < 1e-12);
        assert_eq!(scenario.deadline, 5.0);
        assert_eq!(scenario.search, SearchKind::AStar);
        assert_eq!(scenario.compliance, Compliance::Shape);
        let ship = scenario.targets[0].ship().expect("a ship");
        assert_eq!(ship.speed, mps_from_knots(10.0));
        assert!((ship.velocity() - Vector::new(-ship.speed, 0.0)).norm() < 1e-12);
        assert_eq!(
            (ship.position_std, ship.speed_spread, ship.course_spread),
            (0.0, 0.0, 0.0)
        );
        assert_eq!(ship.domain, DomainKind::Colregs);
    }

    #[test]
    fn knots_replace_lists_too() {
        let text = LEAST.replace("turning", "speeds_kn = [12, 0, 6, 6]\nturning")
            + "leg_speeds_kn = [10, 5]";
        let scenario = Scenario::parse(&text).expect("valid");
        assert_eq!(
            scenario.own_ship.speeds,
            [0.0, mps_from_knots(6.0), mps_from_knots(12.0)]
        );
        assert_eq!(scenario.desired.legs()[1].speed, mps_from_knots(5.0));
        let mean = scenario.desired.length() / scenario.desired.duration();
        assert_eq!(scenario.time_weight, mean * mean);
    }

    #[test]
    fn explicit_sets_are_taken_as_they_are() {
        let text = format!(
            "{LEAST}[[targets]]\nname = \"figure 1\"\n\
             initial_set = {{ vertices_m = [[-10, -5], [10, 5], [-10, 5], [10, -5], [10, 0]] }}\n\
             velocity_set = {{ vertices_mps = [[1, 0]] }}"
        );
        let scenario = Scenario::parse(&text).expect("valid");
        let Motion::Sets { initial, velocity } = &scenario.targets[0].motion else {
            panic!("sets");
        };
        assert_eq!(initial.vertices().len(), 4);
        assert_eq!(velocity.vertices(), [Vector::new(1.0, 0.0)]);
        let dent = text.replace("[10, 0]", "[9, 0]");
        assert_eq!(paths(&dent), ["targets[0].initial_set.vertices_m[4]"]);
        let hull = text.replace("velocity_set", "length_m = 3\nvelocity_set");
        assert_eq!(paths(&hull), ["targets[0].length_m"]);
    }

    #[test]
    fn one_mistake_is_one_fault() {
        for (from, to, path) in [
            ("title = \"least\"", "", "title"),
            ("title =", "tilte =", "tilte"),
            ("horizon_s = 400", "horizon_s = -inf", "horizon_s"),
            ("horizon_s = 400", "horizon_s = 1e999", "horizon_s"),
            ("course_deg = 90", "course_deg = 361", "own_ship.course_deg"),
            ("course_deg = 90", "course = 90", "own_ship.course"),
            (
                "speed_mps = 5",
                "speed_kn = 5\nspeed_mps = 5",
                "own_ship.speed_kn",
            ),
            ("speed_mps = 5", "speed_mps = 1_000", "own_ship.speed_mps"),
            ("speed_mps = 5", "speed_mps = \"5\"", "own_ship.speed_mps"),
            ("speed_mps = 5", "", "own_ship.speed_mps"),
            (
                "beam_m = 8",
                "beam_m = 8\nspeeds_mps = []",
                "own_ship.speeds_mps",
            ),
            (
                "beam_m = 8",
                "beam_m = 8\nspeeds_mps = [0, 0]",
                "own_ship.speeds_mps",
            ),
            (
                "beam_m = 8",
                "beam_m = 8\nspeeds_mps = [-1, 2]",
                "own_ship.speeds_mps[0]",
            ),
            (
                "_radius_m = 100",
                "_radius_m = 0",
                "own_ship.turning_radius_m",
            ),
            (
                "east_m = 1500, north_m = 0 }",
                "east_m = 0, north_m = 0 }",
                "mission.waypoints[1]",
            ),
            (
                "[mission]",
                "[mission]\nleg_speeds_mps = [1]",
                "mission.leg_speeds_mps",
            ),
            (
                "[mission]",
                "[mission]\nleg_speeds_mps = [1, 2]\nspeed_kn = 1",
                "mission.leg_speeds_mps",
            ),
            ("[mission]", "[mission]\nspeed_mps = 0", "mission.speed_mps"),
        ] {
            assert!(LEAST.contains(from), "{from}");
            assert_eq!(paths(&LEAST.replacen(from, to, 1)), [path], "{to}");
        }
        for (from, to, path) in [
            ("\"ship\"", "\" \"", "targets[0].name"),
            (
                "beam_m",
                "speed_spread_mps = -0.1\nbeam_m",
                "targets[0].speed_spread_mps",
            ),
            (
                "beam_m",
                "course_spread_deg = 181\nbeam_m",
                "targets[0].course_spread_deg",
            ),
            (
                "beam_m",
                "position_std_m = nan\nbeam_m",
                "targets[0].position_std_m",
            ),
            ("beam_m", "domain = \"round\"\nbeam_m", "targets[0].domain"),
            (
                "beam_m",
                "velocity_set = { vertices_mps = [[0, 0]] }\nbeam_m",
                "targets[0].initial_set",
            ),
        ] {
            let text = format!("{LEAST}{}", SHIP.replacen(from, to, 1));
            assert_eq!(paths(&text)[0], path, "{to}");
        }
        assert_eq!(paths(&format!("{LEAST}{SHIP}{SHIP}")), ["targets[1].name"]);
    }

    #[test]
    fn grammar_comes_first_and_names_its_line() {
        let faults = Scenario::parse("title = \nhorizon_s = 1").expect_err("no TOML");
        assert_eq!(faults[0].line, Some(1));
        assert!(Scenario::parse("a = 1\na = 2").is_err());
        assert!(Scenario::parse(&"[".repeat(100_000)).is_err());
    }

    /// Nothing a file can say may panic: every prefix, and every number replaced by a hostile one.
    #[test]
    fn hostile_text_is_refused_and_never_panics() {
        let text = format!("{LEAST}{SHIP}");
        for end in 0..text.len() {
            let _ = Scenario::parse(&text[..end]);
        }
        for hostile in [
            "nan", "-inf", "1e308", "-1e308", "5e-324", "-0.0", "[]", "{}", "\"\"", "true",
        ] {
            for (at, _) in text.match_indices(char::is_numeric) {
                let _ = Scenario::parse(&format!("{}{hostile}{}", &text[..at], &text[at + 1..]));
            }
        }
    }
}
