//! The rows of a campaign: what is kept of each simulation, column by column.

use sha2::{Digest, Sha256};

use super::specification::{RowScenario, Specification, Stratum, hex};
use crate::colregs::compliance::MonitorVerdict;
use crate::document::{
    CycleTimingDocument, PlanOutcome, ReplanDocument, SailedDocument, SimulatedTargetDocument,
    SimulationDocument,
};
use crate::frame::{Vector, clockwise_deg, deg_from_radians, relative_bearing};
use crate::scenario::Scenario;
use crate::simulation::Simulation;
use crate::target::ShipTrack;
use crate::vessel::OwnShip;

/// A value; `None` where there is none.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// A whole number.
    Count(Option<i64>),
    /// A number; never a NaN.
    Number(Option<f64>),
    /// Yes or no.
    Truth(Option<bool>),
    /// Words.
    Word(Option<String>),
}

/// A column: its name, with the unit, and how its value is found.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// Name.
    pub name: &'static str,
    pub(super) of: Of,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Of {
    Count(fn(&Sailed) -> Option<usize>),
    Number(fn(&Sailed) -> Option<f64>),
    Truth(fn(&Sailed) -> Option<bool>),
    Word(fn(&Sailed) -> Option<String>),
}

/// A row that was sailed, or could not be.
pub(super) struct Sailed<'a> {
    row: u64,
    stratum: &'a Stratum,
    drawn: Option<&'a RowScenario>,
    document: Option<&'a SimulationDocument>,
    cpu_s: f64,
}

/// Outcome of a row that was sailed, and of one that met a fault of the program.
pub(super) const SAILED: &str = "sailed";
pub(super) const FAULT: &str = "fault";

/// The last columns, which depend on the machine and are never compared.
pub const TIMED: usize = 4;

/// All columns, in their order in files.
pub const COLUMNS: [Column; 59] = [
    Column::count("row", |s| Some(s.row as usize)),
    Column::word("stratum", |s| Some(s.stratum.name.clone())),
    Column::word("class", |s| Some(s.stratum.class.to_string())),
    Column::word("outcome", |s| Some(s.outcome().to_owned())),
    Column::count("seed", |s| Some(s.scenario()?.simulation.seed as usize)),
    Column::count("redrawn", |s| Some(s.drawn?.redrawn)),
    Column::count("targets", |s| Some(s.scenario()?.targets.len())),
    Column::number("own_speed_mps", |s| Some(s.own()?.speed)),
    // the first target at the start
    Column::number("range_m", |s| Some(s.between()?.norm())),
    Column::number("bearing_deg", |s| {
        let bearing = relative_bearing(&s.own()?.pose, s.ship()?.pose.position);
        Some(deg_from_radians(bearing))
    }),
    Column::number("relative_course_deg", |s| {
        Some(clockwise_deg(
            s.ship()?.pose.heading - s.own()?.pose.heading,
        ))
    }),
    Column::number("tcpa_s", |s| Some(s.approach()?.0)),
    Column::number("dcpa_m", |s| Some(s.approach()?.1)),
    Column::number("target_speed_mps", |s| Some(s.ship()?.speed)),
    Column::number("target_length_m", |s| Some(s.ship()?.hull.length)),
    Column::number("target_beam_m", |s| Some(s.ship()?.hull.beam)),
    Column::number("position_std_m", |s| Some(s.ship()?.position_std)),
    Column::number("speed_spread_mps", |s| Some(s.ship()?.speed_spread)),
    Column::number("course_spread_deg", |s| {
        Some(deg_from_radians(s.ship()?.course_spread))
    }),
    // what happened
    Column::truth("contact", |s| Some(s.document?.contact)),
    Column::truth("safe", |s| Some(s.document?.safe)),
    Column::truth("arrived", |s| Some(s.document?.arrived)),
    Column::number("duration_s", |s| Some(s.document?.duration_s)),
    Column::number("clearance_m", |s| Some(s.nearest()?.0)),
    Column::number("clearance_t_s", |s| Some(s.nearest()?.1)),
    Column::number("contact_t_s", |s| s.least(|t| t.contact_t_s)),
    Column::number("land_m", |s| s.document?.land.as_ref()?.least_m),
    Column::word("roles", |s| {
        let roles = s.targets()?.iter().flat_map(|t| &t.conduct.roles);
        joined(roles.map(|role| role.role.word()))
    }),
    // both judges
    Column::count("broken", |s| Some(s.conduct()?.breaks.len())),
    Column::word("breaks", |s| {
        joined(s.conduct()?.breaks.iter().map(String::as_str))
    }),
    Column::number("least_score", |s| {
        s.least(|t| t.conduct.scores.values().copied().min_by(f64::total_cmp))
    }),
    Column::count("rules_broken", |s| s.sum(|t| t.conduct.violations.len())),
    Column::count("monitors_violated", |s| {
        let violated = MonitorVerdict::Violated;
        let of = |t: &SimulatedTargetDocument| {
            let monitors = t.conduct.monitors.iter();
            monitors.filter(|m| m.verdict == violated).count()
        };
        s.sum(of)
    }),
    // own ship's manoeuvres
    Column::number("lead_s", |s| {
        s.least(|t| t.conduct.manoeuvre.as_ref()?.lead_s)
    }),
    Column::number("smallest_turn_deg", |s| {
        s.least(|t| t.conduct.manoeuvre.as_ref()?.smallest_turn_deg)
    }),
    Column::count("turns", |s| Some(s.conduct()?.turns)),
    Column::count("speed_changes", |s| Some(s.conduct()?.speed_changes)),
    Column::count("replaced_manoeuvres", |s| {
        Some(s.conduct()?.replaced_manoeuvres)
    }),
    Column::count("side_switches", |s| Some(s.conduct()?.side_switches)),
    Column::number("planned_cost_m2", |s| s.conduct()?.first_plan_cost_m2),
    Column::number("sailed_cost_m2", |s| Some(s.conduct()?.cost_m2)),
    // plans
    Column::count("plans", |s| s.plans(|_| 1)),
    Column::count("plans_kept", |s| s.plans(|p| p.keeps_plan.into())),
    Column::count("plans_relaxed", |s| {
        s.plans(|p| (!p.relaxations.is_empty()).into())
    }),
    Column::count("plans_infeasible", |s| {
        s.plans(|p| (p.verdict == PlanOutcome::Infeasible.word()).into())
    }),
    Column::count("no_plan", |s| Some(s.conduct()?.without_plan)),
    Column::count("unsafe_plans", |s| Some(s.conduct()?.unsafe_plans)),
    Column::count("lost_remainders", |s| Some(s.conduct()?.lost_remainders)),
    // assumptions
    Column::count("outside_sets", |s| s.sum(|t| t.outside_sets)),
    Column::count("outside_velocities", |s| {
        s.plans(|p| p.outside_velocities.len())
    }),
    Column::count("outside_places", |s| s.plans(|p| p.outside_places.len())),
    Column::number("off_plan_m", |s| Some(s.conduct()?.largest_off_plan_m)),
    Column::truth("within_tracking_margin", |s| {
        Some(s.conduct()?.within_tracking_margin)
    }),
    Column::count("alarms", |s| Some(s.document?.alarms.len())),
    Column::word("document", |s| document_digest(s.document?)),
    // of the machine
    Column::count("late", |s| Some(late_plans(s.document?))),
    Column::number("plan_ms_median", |s| {
        Some(s.document?.timing.quantile_ms(0.5))
    }),
    Column::number("plan_ms_most", |s| {
        Some(s.document?.timing.quantile_ms(1.0))
    }),
    Column::number("cpu_s", |s| Some(s.cpu_s)),
];

/// Plans that took longer than the delay.
fn late_plans(document: &SimulationDocument) -> usize {
    let delay = document.settings.delay_s;
    // the first plan is made before the start
    let plans = document.timing.plan_s.iter().skip(1);
    plans.filter(|seconds| **seconds > delay).count()
}

/// SHA-256 of a document without its timing, which depends on the machine.
pub(super) fn document_digest(document: &SimulationDocument) -> Option<String> {
    let timing = CycleTimingDocument::default();
    let untimed = SimulationDocument {
        timing,
        ..document.clone()
    };
    let mut hash = Sha256::new();
    hash.update(serde_json::to_vec(&untimed).ok()?);
    Some(hex(hash))
}

/// True where a column of a row is true or above zero.
pub(super) fn happened(row: &[Cell], name: &str) -> bool {
    match row[column(name)] {
        Cell::Count(Some(count)) => count > 0,
        Cell::Truth(Some(truth)) => truth,
        _ => false,
    }
}

/// True for a row whose document is kept, because somebody has to look at it.
pub(super) fn is_kept(row: &[Cell]) -> bool {
    let events = ["contact", "no_plan", "unsafe_plans", "late", "broken"];
    events.iter().any(|name| happened(row, name))
}

/// The index of a column that is in [`COLUMNS`].
pub(super) fn column(name: &str) -> usize {
    let found = COLUMNS.iter().position(|column| column.name == name);
    found.unwrap_or_else(|| unreachable!("no column {name}"))
}

impl Column {
    const fn count(name: &'static str, of: fn(&Sailed) -> Option<usize>) -> Self {
        let of = Of::Count(of);
        Self { name, of }
    }

    const fn number(name: &'static str, of: fn(&Sailed) -> Option<f64>) -> Self {
        let of = Of::Number(of);
        Self { name, of }
    }

    const fn truth(name: &'static str, of: fn(&Sailed) -> Option<bool>) -> Self {
        let of = Of::Truth(of);
        Self { name, of }
    }

    const fn word(name: &'static str, of: fn(&Sailed) -> Option<String>) -> Self {
        let of = Of::Word(of);
        Self { name, of }
    }

    fn cell(&self, sailed: &Sailed) -> Cell {
        match self.of {
            Of::Count(of) => Cell::Count(of(sailed).and_then(|count| count.try_into().ok())),
            // +0.0 turns a negative zero into zero
            Of::Number(of) => Cell::Number(of(sailed).filter(|x| x.is_finite()).map(|x| x + 0.0)),
            Of::Truth(of) => Cell::Truth(of(sailed)),
            Of::Word(of) => Cell::Word(of(sailed)),
        }
    }
}

/// Words with semicolons between them; `None` for none.
fn joined<'w>(words: impl Iterator<Item = &'w str>) -> Option<String> {
    let words: Vec<&str> = words.collect();
    (!words.is_empty()).then(|| words.join(";"))
}

impl<'a> Sailed<'a> {
    fn outcome(&self) -> &'static str {
        self.document.map_or(FAULT, |_| SAILED)
    }

    fn scenario(&self) -> Option<&'a Scenario> {
        self.drawn.map(|drawn| &drawn.scenario)
    }

    fn own(&self) -> Option<&'a OwnShip> {
        self.scenario().map(|scenario| &scenario.own_ship)
    }

    fn ship(&self) -> Option<&'a ShipTrack> {
        self.scenario()?.targets.first()?.ship()
    }

    fn conduct(&self) -> Option<&'a SailedDocument> {
        self.document.map(|document| &document.conduct)
    }

    fn targets(&self) -> Option<&'a [SimulatedTargetDocument]> {
        self.document.map(|document| document.targets.as_slice())
    }

    fn sum(&self, of: impl Fn(&SimulatedTargetDocument) -> usize) -> Option<usize> {
        Some(self.targets()?.iter().map(of).sum())
    }

    fn least(&self, of: impl Fn(&SimulatedTargetDocument) -> Option<f64>) -> Option<f64> {
        self.targets()?.iter().filter_map(of).min_by(f64::total_cmp)
    }

    fn plans(&self, of: impl Fn(&ReplanDocument) -> usize) -> Option<usize> {
        Some(self.document?.replans.iter().map(of).sum())
    }

    /// From own ship to the first target at the start, metres.
    fn between(&self) -> Option<Vector> {
        Some(self.ship()?.pose.position - self.own()?.pose.position)
    }

    /// Seconds to the closest approach on nominal tracks, and metres then.
    fn approach(&self) -> Option<(f64, f64)> {
        let own = self.own()?;
        let relative = own.pose.ahead() * own.speed - self.ship()?.velocity();
        let time = self.between()?.dot(&relative) / relative.norm_squared();
        Some((time, (self.between()? - relative * time).norm()))
    }

    /// Least distance of the hulls from any target, metres, and its time. A distance that is no
    /// number is a contact, and the least.
    fn nearest(&self) -> Option<(f64, f64)> {
        let each = self.targets()?.iter().map(|t| {
            let least = t.least_clearance_m.unwrap_or(f64::NEG_INFINITY);
            (least, t.least_clearance_t_s)
        });
        each.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// A row of a campaign, as it is kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// One cell for each of [`COLUMNS`].
    pub cells: Vec<Cell>,
    /// The document of a row that somebody has to look at: with a contact, a cycle without a plan
    /// or with one that is late or not safe, or a broken rule.
    pub document: Option<Box<SimulationDocument>>,
}

impl Row {
    /// Sails a row to its end. A row that cannot be drawn, or at which the program fails, has the
    /// outcome "fault".
    pub fn sail(specification: &Specification, row: u64) -> Self {
        Self::sail_by(specification, row, |scenario| {
            let mut simulation = Simulation::new(scenario, false).ok()?;
            while !simulation.finished() {
                simulation.step();
            }
            Some(simulation.record())
        })
    }

    fn sail_by(
        specification: &Specification,
        row: u64,
        simulate: impl Fn(Scenario) -> Option<SimulationDocument>,
    ) -> Self {
        let begun = thread_seconds();
        let sail = || {
            let drawn = specification.scenario(row)?;
            let document = simulate(drawn.scenario.clone())?;
            Some((drawn, document))
        };
        // a fault of one row in a million must not end the others; `replay` shows where it is
        let sailed = std::panic::catch_unwind(std::panic::AssertUnwindSafe(sail));
        let (drawn, document) = sailed.ok().flatten().unzip();
        let cpu_s = thread_seconds() - begun;
        Self::of(specification, row, drawn.as_ref(), document, cpu_s)
    }

    /// The row of a simulation that was sailed.
    pub fn of(
        specification: &Specification,
        row: u64,
        drawn: Option<&RowScenario>,
        document: Option<SimulationDocument>,
        cpu_s: f64,
    ) -> Self {
        let stratum = specification.stratum(row);
        let sailed = Sailed {
            row,
            stratum,
            drawn,
            document: document.as_ref(),
            cpu_s,
        };
        let cells: Vec<Cell> = COLUMNS.iter().map(|column| column.cell(&sailed)).collect();
        let document = document.filter(|_| is_kept(&cells)).map(Box::new);
        Self { cells, document }
    }
}

/// Processor time of this thread, seconds; elsewhere than on Unix that of the clock.
fn thread_seconds() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
    }
    #[cfg(not(unix))]
    {
        use std::time::{SystemTime, UNIX_EPOCH};
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        since.map_or(0.0, |since| since.as_secs_f64())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_at_which_the_program_panics_is_a_fault() {
        let text = "name = 'one'\nseed = 1\nrows = 4\n[[strata]]\nname = 'a'\n\
                    scenario = 'scenarios/colregs/head-on.toml'\n";
        let here = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let specification = Specification::parse(text, here).expect("a specification");
        let row = Row::sail_by(&specification, 3, |_| panic!("on purpose"));
        let word = |word: &str| Cell::Word(Some(word.to_owned()));
        assert_eq!(row.cells[column("outcome")], word(FAULT));
        assert_eq!(row.cells[column("stratum")], word("a"));
        assert_eq!(row.cells[0], Cell::Count(Some(3)));
        assert_eq!(row.cells[column("contact")], Cell::Truth(None));
        assert_eq!((row.cells.len(), row.document), (COLUMNS.len(), None));
    }
}
