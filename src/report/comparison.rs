//! Contenders side by side for the eye, and as rows of a CSV file.

use comfy_table::Cell;

use super::summary::Turn;
use super::table::{cell, figures, metres, said, signed, square_metres, verified};
use crate::document::alteration::largest_alteration;
use crate::evaluation::{Counted, Safety, Tone, outcome, risk_figure};
use crate::frame::Side;
use crate::pipeline::Verdict;
use crate::scenario::Scenario;
use crate::study::compare::{Entry, Inapplicable, Method, Sailed};

/// Units below the names, so that the table fits a terminal.
pub(super) const HEADER: [&str; 15] = [
    "method",
    "outcome",
    "J\n[m²]",
    "arc J\n[m²]",
    "duration\n[s]",
    "delay\n[s]",
    "length\n[m]",
    "clearance\n[m]",
    "risk",
    "largest\nturn",
    "nodes\nexpanded",
    "time\n[ms]",
    "verified",
    "safe",
    "breaks",
];

/// The column of the time that planning took.
pub(super) const TIME: usize = 11;

/// Between the outcome and the accepted risk in a sweep.
pub(super) const ACCEPTED: &str = "accepted\nrisk";

/// One contender in a few figures. Figures of the motion are `None` without one.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonRow {
    /// Who.
    pub method: Method,
    /// The risk that was accepted.
    pub max_risk: f64,
    /// How it ended, in the word of the documents; of a baseline `"clear"`, `"collides"` or `"infeasible"`, and
    /// `"relaxed"` where it enters a set within the accepted risk.
    pub outcome: &'static str,
    /// Why there is no motion.
    pub reason: Option<String>,
    /// True when it ends at the last waypoint.
    pub arrived: bool,
    /// What the motion enters from start to arrival; `None` without one.
    pub safety: Option<Safety>,
    /// What the independent check found: of a baseline sets, hulls and land alone. `None` without a motion.
    pub verified: Option<bool>,
    /// Space-time error, m².
    pub space_time_error: Option<f64>,
    /// Until when that is counted.
    pub counted: Option<Counted>,
    /// Eq. (30) read literally, m².
    pub arc_length_error: Option<f64>,
    /// Seconds.
    pub duration: Option<f64>,
    /// Arrival minus desired end, seconds; `None` also where it does not arrive.
    pub delay: Option<f64>,
    /// Metres.
    pub length: Option<f64>,
    /// Least distance to any hull that a target may have, metres; `None` also without targets.
    pub clearance: Option<f64>,
    /// The largest risk along the motion; `None` also without targets.
    pub largest_risk: Option<f64>,
    /// The largest alteration to one side; `None` also without any.
    pub largest_turn: Option<Turn>,
    /// The rules of the road that it breaks toward any target, and the monitors that it violates, each once, sorted; `None` without a
    /// motion and without ships.
    pub broken: Option<Vec<&'static str>>,
    /// Nodes expanded; `None` for a baseline.
    pub expanded: Option<usize>,
    /// Wall-clock milliseconds of planning, with others at the same time; `None` for a baseline.
    pub milliseconds: Option<f64>,
}

impl ComparisonRow {
    /// The figures of an entry.
    pub fn of(scenario: &Scenario, entry: &Entry) -> Self {
        let evaluation = entry.evaluation();
        let finite = |value: f64| value.is_finite().then_some(value);
        let verified = evaluation.map(|e| e.verified());
        let run = match &entry.result {
            Sailed::Planned(run) => Some(run),
            Sailed::Baseline(_) | Sailed::Nothing(_) => None,
        };
        let largest_risk = (entry.risks().iter())
            .map(|peak| peak.risk)
            .max_by(f64::total_cmp);
        let conduct = entry.conduct(scenario);
        let mut broken: Vec<_> = conduct.iter().flat_map(|c| c.broken()).collect();
        broken.sort_unstable();
        broken.dedup();
        Self {
            method: entry.contender.method,
            max_risk: entry.contender.max_risk,
            outcome: match &entry.result {
                Sailed::Planned(run) => Verdict::of(run).word(),
                Sailed::Baseline(_) if verified != Some(true) => "collides",
                // clear of the level sets alone
                Sailed::Baseline(_)
                    if entry.contender.max_risk > 0.0 && largest_risk > Some(0.0) =>
                {
                    Verdict::Relaxed.word()
                }
                Sailed::Baseline(_) => "clear",
                Sailed::Nothing(_) => Verdict::Infeasible.word(),
            },
            reason: match &entry.result {
                Sailed::Planned(run) => run.reason(),
                Sailed::Baseline(_) => None,
                Sailed::Nothing(reason) => Some((*reason).to_owned()),
            },
            arrived: entry.arrived(),
            safety: entry.safety(),
            verified,
            space_time_error: evaluation.and_then(|e| finite(e.space_time_error)),
            arc_length_error: evaluation.and_then(|e| finite(e.arc_length_error)),
            counted: evaluation.map(|e| e.counted),
            duration: evaluation.and_then(|e| finite(e.duration)),
            delay: (evaluation.filter(|_| entry.arrived())).and_then(|e| finite(e.delay)),
            length: evaluation.and_then(|e| finite(e.length)),
            clearance: evaluation.and_then(|e| finite(e.min_clearance)),
            largest_risk,
            largest_turn: entry
                .trajectory()
                .and_then(|t| largest_alteration(t, scenario.own_ship.pose.heading)),
            broken: (!conduct.is_empty()).then_some(broken),
            expanded: run.map(|run| run.planned.stats.expanded),
            milliseconds: run.map(|run| run.plan_time.as_secs_f64() * 1e3),
        }
    }

    /// True of a motion that enters no hard set, hull or land from start to arrival; `None` without one.
    pub fn safe(&self) -> Option<bool> {
        self.safety.map(|safety| safety == Safety::Safe)
    }

    /// The word that people see for how it ended, and what it says.
    pub(crate) fn seen(&self) -> (String, Tone) {
        let risk = self.largest_risk.unwrap_or(0.0);
        outcome(self.outcome, self.safety, risk)
    }

    fn is_planned(&self) -> bool {
        self.expanded.is_some()
    }
}

/// True where several risks were accepted.
pub(super) fn is_sweep(rows: &[ComparisonRow]) -> bool {
    rows.iter().any(|row| row.max_risk != rows[0].max_risk)
}

/// The table of one scenario, and what does not apply. Colour only when `colour`.
pub fn comparison_table(
    title: &str,
    rows: &[ComparisonRow],
    inapplicable: &[Inapplicable],
    colour: bool,
) -> String {
    let sweep = is_sweep(rows);
    let mut header = HEADER.to_vec();
    if sweep {
        header.insert(2, ACCEPTED);
    }
    let words = header.len() - 3;
    let mut table = figures(&header, 2..words, colour);
    for row in rows {
        let mut cells = cells(row);
        if sweep {
            cells.insert(2, Cell::new(row.max_risk));
        }
        table.add_row(cells);
    }
    let mut lines = vec![title.to_owned(), table.trim_fmt()];
    lines.extend(remarks(rows, inapplicable));
    lines.join("\n")
}

/// Until when J is counted, why there is no motion, and what does not apply: a sentence each.
pub(super) fn remarks(rows: &[ComparisonRow], inapplicable: &[Inapplicable]) -> Vec<String> {
    let mut lines: Vec<String> = counting(rows).into_iter().collect();
    let mut told: Vec<Method> = Vec::new();
    for row in rows {
        let Some(reason) = row.reason.as_ref().filter(|_| !told.contains(&row.method)) else {
            continue;
        };
        told.push(row.method);
        let alike = |r: &&ComparisonRow| r.method == row.method && r.reason.is_some();
        let further = match rows.iter().filter(alike).count() - 1 {
            0 => String::new(),
            n => format!(" (at risk {}; none at {n} more)", row.max_risk),
        };
        lines.push(format!("{}{further}: {reason}", row.method));
    }
    for other in inapplicable {
        lines.push(format!("{} does not apply: {}", other.method, other.reason));
    }
    lines
}

/// Until when J is counted.
fn counting(rows: &[ComparisonRow]) -> Option<String> {
    let counted = |row: &ComparisonRow| row.counted;
    let within = rows.iter().find_map(counted)?.within;
    let mut passing: Vec<String> = Vec::new();
    for row in rows {
        let Some(counted) = row.counted.filter(|counted| !counted.arrived) else {
            continue;
        };
        let line = format!("{} to {:.0} s", row.method, counted.until);
        if !passing.contains(&line) {
            passing.push(line);
        }
    }
    let rest = match passing.as_slice() {
        [] => String::new(),
        passing => format!(
            "; of motions that do not come so near, to the end of the desired time: {}",
            passing.join(", ")
        ),
    };
    Some(format!(
        "J is counted until {within} m, own ship's length, from the last waypoint{rest}"
    ))
}

/// The table as markdown, without the time that planning took: the same comparison, the same text.
pub fn comparison_markdown(
    title: &str,
    rows: &[ComparisonRow],
    inapplicable: &[Inapplicable],
) -> String {
    let sweep = is_sweep(rows);
    let line = |mut cells: Vec<String>, risk: String| {
        cells.remove(TIME);
        if sweep {
            cells.insert(2, risk);
        }
        let cells: Vec<String> = cells.iter().map(|cell| in_cell(cell)).collect();
        format!("| {} |", cells.join(" | "))
    };
    let names = HEADER.map(|name| name.replace('\n', " ")).to_vec();
    let columns = HEADER.len() - 1 + usize::from(sweep);
    let mut lines = vec![
        format!("# {}", in_cell(title)),
        String::new(),
        line(names, ACCEPTED.replace('\n', " ")),
        format!("|{}", "---|".repeat(columns)),
    ];
    lines.extend(rows.iter().map(|row| {
        let cells = texts(row).into_iter().map(|(text, _)| text).collect();
        line(cells, row.max_risk.to_string())
    }));
    lines.push(String::new());
    let told = remarks(rows, inapplicable).into_iter();
    lines.extend(told.map(|remark| format!("- {}", in_cell(&remark))));
    lines.join("\n")
}

/// A text that stays in its cell.
fn in_cell(text: &str) -> String {
    text.replace('|', "\\|").replace(['\n', '\r'], " ")
}

/// A row as texts, in the order of [`HEADER`].
pub(super) fn texts(row: &ComparisonRow) -> [(String, Tone); 15] {
    let text = |value: Option<String>| (value.unwrap_or_else(|| "–".to_owned()), Tone::Plain);
    let tenths = |value: f64| format!("{value:.1}");
    let moved = row.verified.is_some();
    [
        (row.method.to_string(), Tone::Plain),
        row.seen(),
        text(row.space_time_error.map(square_metres)),
        text(row.arc_length_error.map(square_metres)),
        text(row.duration.map(tenths)),
        text(row.delay.map(signed)),
        text(row.length.map(|length| format!("{length:.0}"))),
        text(row.clearance.map(metres)),
        text(row.largest_risk.map(risk_figure)),
        text(moved.then(|| row.largest_turn.map_or_else(|| "none".to_owned(), short))),
        text(row.expanded.map(|n| n.to_string())),
        text(row.milliseconds.map(|ms| format!("{ms:.2}"))),
        verified(row.verified.filter(|_| row.is_planned()), row.safe()),
        said(row.safe()),
        match &row.broken {
            None => text(None),
            Some(broken) if broken.is_empty() => ("nothing".to_owned(), Tone::Good),
            Some(broken) => (broken.join(", "), Tone::Fair),
        },
    ]
}

fn cells(row: &ComparisonRow) -> Vec<Cell> {
    texts(row).into_iter().map(cell).collect()
}

/// `S 39°` or `P 12°`.
fn short(turn: Turn) -> String {
    let side = match turn.side {
        Side::Port => 'P',
        Side::Starboard => 'S',
    };
    format!("{side} {:.0}°", turn.degrees)
}

/// The columns of [`comparison_csv`].
pub const COMPARISON_COLUMNS: [&str; 22] = [
    "file",
    "scenario",
    "method",
    "max_risk",
    "outcome",
    "verified",
    "safe",
    "arrived",
    "space_time_error_m2",
    "space_time_error_until_s",
    "space_time_error_arc_length_m2",
    "duration_s",
    "delay_s",
    "length_m",
    "min_clearance_m",
    "largest_risk",
    "largest_turn_deg",
    "largest_turn_side",
    "breaks",
    "expanded",
    "plan_ms",
    "reason",
];

/// A row of values in the order of [`COMPARISON_COLUMNS`]; empty where there is none.
pub fn comparison_csv(file: &str, title: &str, row: &ComparisonRow) -> [String; 22] {
    let number = |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
    let word = |value: Option<bool>| value.map_or_else(String::new, |v| v.to_string());
    [
        file.to_owned(),
        title.to_owned(),
        row.method.to_string(),
        row.max_risk.to_string(),
        row.outcome.to_owned(),
        word(row.verified),
        word(row.safe()),
        row.arrived.to_string(),
        number(row.space_time_error),
        number(row.counted.map(|c| c.until)),
        number(row.arc_length_error),
        number(row.duration),
        number(row.delay),
        number(row.length),
        number(row.clearance),
        number(row.largest_risk),
        number(row.largest_turn.map(|t| t.degrees)),
        row.largest_turn
            .map_or_else(String::new, |t| t.side.to_string()),
        row.broken
            .as_ref()
            .map_or_else(String::new, |b| b.join(" ")),
        row.expanded.map_or_else(String::new, |n| n.to_string()),
        number(row.milliseconds),
        row.reason.clone().unwrap_or_default(),
    ]
}
