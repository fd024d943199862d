//! Results for the eye: one row per scenario, or one scenario in a few aligned lines.

use comfy_table::{Cell, CellAlignment, Color, ContentArrangement, Table, presets};

use super::conduct;
use super::summary::{Meeting, Summary};
use crate::document::words;
pub(super) use crate::evaluation::Tone;
use crate::evaluation::{Counted, outcome, risk_figure};
use crate::frame::Side;
use crate::obstacle::SpaceTimeObstacle;
use crate::pipeline::{Relaxation, RelaxationLevel, Run};
use crate::planner::optimal_control::ControlReport;
use crate::text::printable_lines;

/// Targets of one scenario that a row names; the rest is counted.
const NAMED: usize = 3;

/// Units below the names, so that the table fits a terminal.
pub(super) const HEADER: [&str; 13] = [
    "scenario",
    "outcome",
    "encounter",
    "turn",
    "passing",
    "J\n[m²]",
    "delay\n[s]",
    "clearance\n[m]",
    "risk",
    "nodes\nexpanded",
    "time\n[ms]",
    "verified",
    "safe",
];

/// Columns with numbers.
pub(super) const NUMBERS: std::ops::Range<usize> = 5..11;

/// The column of the time that planning took.
pub(super) const TIME: usize = 10;

/// One line of a suite's table.
#[derive(Debug, Clone)]
pub enum Row {
    /// A scenario that was run.
    Run(Summary),
    /// A file or folder that could not be.
    Failed {
        /// Which.
        file: String,
        /// In one word.
        outcome: &'static str,
    },
}

/// The table of a suite. Colour only when `colour`; never wider than the terminal when there is one.
pub fn suite_table(rows: &[Row], colour: bool) -> String {
    let mut table = figures(&HEADER, NUMBERS, colour);
    for row in rows {
        table.add_row(match row {
            Row::Run(summary) => cells(summary),
            Row::Failed {
                file,
                outcome: word,
            } => {
                let outcome = outcome(word, None, 0.0);
                let mut cells = vec![cell((file.clone(), Tone::Plain)), cell(outcome)];
                cells.resize_with(HEADER.len(), || Cell::new("–"));
                cells
            }
        });
    }
    table.trim_fmt()
}

/// An empty table with these names, lines between them and the rows alone, and the columns `numbers` set to the right.
pub(super) fn figures(header: &[&str], numbers: std::ops::Range<usize>, colour: bool) -> Table {
    let mut table = Table::new();
    table
        .load_style(presets::UTF8_HORIZONTAL_ONLY)
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(header);
    table.style_mut().row_separator = presets::NOTHING.row_separator;
    if colour {
        table.enforce_styling();
    } else {
        table.force_no_tty();
    }
    for index in numbers {
        if let Some(column) = table.column_mut(index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

/// A cell in its colour, without control characters.
pub(super) fn cell((text, tone): (String, Tone)) -> Cell {
    let text = printable_lines(&text);
    match tone {
        Tone::Plain => Cell::new(text),
        Tone::Good => Cell::new(text).fg(Color::Green),
        Tone::Fair => Cell::new(text).fg(Color::Yellow),
        Tone::Bad => Cell::new(text).fg(Color::Red),
    }
}

fn cells(summary: &Summary) -> Vec<Cell> {
    texts(summary).into_iter().map(cell).collect()
}

/// A row as texts, in the order of [`HEADER`].
pub(super) fn texts(summary: &Summary) -> [(String, Tone); 13] {
    let planned = summary.verified.is_some();
    let plain = |text: String| (text, Tone::Plain);
    let text = |value: Option<String>| plain(value.unwrap_or_else(|| "–".to_owned()));
    [
        plain(summary.title.clone()),
        summary.outcome(),
        plain(encounters(summary)),
        text(planned.then(|| turn(summary))),
        text(planned.then(|| passings(summary))),
        text(summary.space_time_error.map(square_metres)),
        text(summary.delay.map(signed)),
        text(summary.clearance.map(metres)),
        text(summary.max_risk.map(risk_figure)),
        plain(summary.expanded.to_string()),
        plain(format!("{:.2}", summary.milliseconds)),
        verified(summary.verified, summary.safe()),
        said(summary.safe()),
    ]
}

/// What the independent check said. Nothing is good of a plan that is not safe.
pub(super) fn verified(verified: Option<bool>, safe: Option<bool>) -> (String, Tone) {
    match said(verified) {
        (word, Tone::Good) if safe != Some(true) => (word, Tone::Plain),
        other => other,
    }
}

/// Yes or no.
pub(super) fn said(fact: Option<bool>) -> (String, Tone) {
    match fact {
        Some(true) => ("yes".to_owned(), Tone::Good),
        Some(false) => ("NO".to_owned(), Tone::Bad),
        None => ("–".to_owned(), Tone::Plain),
    }
}

pub(super) fn square_metres(value: f64) -> String {
    if value.is_nan() {
        return "undefined".to_owned();
    }
    if value < 1000.0 {
        format!("{value:.1}")
    } else {
        format!("{value:.0}")
    }
}

/// With one decimal; what rounds to zero has no sign.
pub(super) fn metres(value: f64) -> String {
    format!("{:.1}", (value * 10.0).round() / 10.0 + 0.0)
}

/// With a sign and one decimal; what rounds to zero is not late and not early.
pub(super) fn signed(value: f64) -> String {
    format!("{:+.1}", (value * 10.0).round() / 10.0 + 0.0)
}

fn encounters(summary: &Summary) -> String {
    if summary.meetings.is_empty() {
        return "none".to_owned();
    }
    per_target(summary, |meeting| meeting.role.to_owned())
}

fn passings(summary: &Summary) -> String {
    if summary.meetings.is_empty() {
        return "–".to_owned();
    }
    per_target(summary, passing)
}

fn per_target(summary: &Summary, say: impl Fn(&Meeting) -> String) -> String {
    let mut lines: Vec<String> = summary.meetings.iter().take(NAMED).map(say).collect();
    if summary.meetings.len() > NAMED {
        lines.push(format!("+ {} more", summary.meetings.len() - NAMED));
    }
    lines.join("\n")
}

fn turn(summary: &Summary) -> String {
    match summary.turn {
        Some(turn) => format!("{} {:.0}°", turn.side, turn.degrees),
        None => "none".to_owned(),
    }
}

/// The side of own ship on which the target lies at the closest approach, and in a crossing whether
/// own ship cuts her track ahead or astern of her.
fn passing(meeting: &Meeting) -> String {
    let side = match meeting.side {
        Some(Side::Port) => "port",
        Some(Side::Starboard) => "starboard",
        None => return "–".to_owned(),
    };
    match meeting.cuts_astern {
        Some(true) => format!("{side}, astern"),
        Some(false) => format!("{side}, ahead"),
        None => side.to_owned(),
    }
}

/// The largest risk, and whose and when where there is one.
fn risk_text(run: &Run, largest: f64) -> String {
    let mut text = format!("{largest:.3} at most");
    if run.max_risk > 0.0 {
        text.push_str(&format!(" ({} accepted)", run.max_risk));
    }
    for (sets, peak) in run.sets.iter().zip(&run.risks) {
        if peak.risk > 0.0 {
            let name = sets.hard.name();
            text.push_str(&format!(
                ", {:.3} with '{name}' at {:.0} s",
                peak.risk, peak.time
            ));
        }
    }
    text
}

/// How a plan of forces was found.
fn forces(run: &Run, report: &ControlReport) -> Vec<(&'static str, String)> {
    let mut said = Vec::new();
    if !run.enclosed.is_empty() {
        let names = run.enclosed.join("', '");
        said.push((
            "sets",
            format!("of '{names}' by the smallest ellipse around each"),
        ));
    }
    let [first, last] = [report.start_intervals, report.intervals];
    if let Some(plan) = run.planned.outcome.plan() {
        said.push(("stage cost", stage_cost(plan.cost)));
        let coarse = if last == first {
            String::new()
        } else {
            format!(", {first} were too coarse")
        };
        said.push((
            "grid",
            format!(
                "{last} intervals{coarse}; at their ends the ship is within {:.1e} of her units",
                report.defect
            ),
        ));
    }
    if report.starts.is_empty() {
        return said;
    }
    let feasible = report.starts.iter().filter(|start| start.feasible).count();
    let steps: usize = report.starts.iter().map(|start| start.iterations).sum();
    // of two passes, with the domains and without, one is told of
    let pass = if run.level == RelaxationLevel::ReducedDomains {
        "without the domains, "
    } else {
        ""
    };
    said.push((
        "starts",
        format!(
            "{pass}on {first} intervals: {feasible} of {} led to a plan, in {steps} steps of the solver",
            report.starts.len(),
        ),
    ));
    let ways = report.classes.len();
    if ways > 0 && !run.obstacles.is_empty() {
        let names: Vec<&str> = run.obstacles.iter().map(SpaceTimeObstacle::name).collect();
        let more = if ways > NAMED { ", the cheapest" } else { "" };
        said.push((
            "ways to pass",
            format!(
                "'{}': {ways} on {first} intervals{more}",
                names.join("', '")
            ),
        ));
        for class in report.classes.iter().take(NAMED) {
            let sides: Vec<&str> = class
                .sides
                .iter()
                .map(|side| side.map_or("far", words::side))
                .collect();
            let cost = stage_cost(class.objective);
            said.push(("", format!("{cost}: {}", sides.join(", "))));
        }
    }
    said
}

/// Until when the errors of a motion are counted that ends at the horizon.
fn counted(counted: &Counted) -> String {
    let (until, within) = (counted.until, counted.within);
    if counted.arrived {
        format!("J is counted until {until:.1} s, {within} m from the last waypoint")
    } else {
        format!(
            "J is counted until {until:.1} s: afterwards it does not come within {within} m of the last waypoint"
        )
    }
}

/// With four decimals, where these say something and are not all noise.
fn stage_cost(value: f64) -> String {
    if value == 0.0 || (1e-2..1e6).contains(&value.abs()) {
        format!("{value:.4}")
    } else {
        format!("{value:.4e}")
    }
}

/// What a line of a plan's text says of the time that planning took.
pub(super) const TIME_LINE: &str = "time";

/// The verdict and the costs of one run, aligned.
pub fn plan_text(run: &Run) -> String {
    let (head, lines) = plan_lines(run);
    let aligned = lines
        .iter()
        .map(|(name, value)| format!("  {name:<13}{value}"));
    let all: Vec<String> = std::iter::once(head).chain(aligned).collect();
    all.join("\n")
}

/// The verdict of one run, and its costs with their names; a line without a name goes on with the one before.
pub(super) fn plan_lines(run: &Run) -> (String, Vec<(&'static str, String)>) {
    let summary = Summary::of(run);
    let head = run.headline();
    let mut lines: Vec<(&'static str, String)> = Vec::new();
    let mut say = |name: &'static str, value: String| lines.push((name, value));
    if let Some(reason) = run.reason() {
        say("reason", reason);
    }
    for given_up in &run.relaxations {
        let what = match given_up {
            Relaxation::Domain { target, amount } => {
                format!("the domain of '{target}' was drawn back by {amount:.1} m")
            }
            Relaxation::Risk {
                target,
                amount,
                until,
            } => {
                let until = until.map_or(String::new(), |time| {
                    format!("; clear of it only from {time:.1} s on")
                });
                format!("the set of '{target}', at a risk of up to {amount:.3}{until}")
            }
            Relaxation::Arrival { target, amount } => {
                format!(
                    "it does not arrive: {amount:.0} m are left at the horizon, '{target}' is in the way"
                )
            }
            Relaxation::Compliance { target, role } => {
                format!(
                    "no plan complies with the rules as {} to '{target}'",
                    role.name()
                )
            }
        };
        let entered = matches!(given_up, Relaxation::Risk { .. });
        say(if entered { "enters" } else { "given up" }, what);
    }
    if let Some(escape) = &run.planned.escape {
        say("stands on", words::stand_on(escape));
    }
    if summary.meetings.is_empty() {
        say("encounter", "none".to_owned());
    }
    for meeting in &summary.meetings {
        let undisturbed = if meeting.undisturbed_dcpa > 0.0 {
            format!("{:.1} m", meeting.undisturbed_dcpa)
        } else {
            "collision".to_owned()
        };
        say(
            "encounter",
            format!(
                "{} with '{}': undisturbed {undisturbed} at {:.0} s",
                meeting.role, meeting.target, meeting.undisturbed_tcpa
            ),
        );
        if let (Some(dcpa), Some(tcpa)) = (meeting.dcpa, meeting.tcpa) {
            say(
                "",
                format!(
                    "planned {dcpa:.1} m at {tcpa:.0} s, passing {}",
                    passing(meeting)
                ),
            );
        }
    }
    for (name, value) in conduct::lines(run) {
        say(name, value);
    }
    if let Some(evaluation) = &run.evaluation {
        say("turn", turn(&summary));
        say(
            "J",
            format!(
                "{} m² ({} m² by arc length)",
                square_metres(evaluation.space_time_error),
                square_metres(evaluation.arc_length_error)
            ),
        );
        let way = format!(
            "{:.1} s and {:.0} m",
            evaluation.duration, evaluation.length
        );
        match summary.delay {
            Some(delay) => say(
                "delay",
                format!("{} s (arrives after {way})", signed(delay)),
            ),
            None if run.control.is_some() => {
                say("horizon", format!("{way}; no arrival is asked for"));
                say("", counted(&evaluation.counted));
            }
            None => say("delay", format!("does not arrive ({way} at the horizon)")),
        }
        if let Some(clearance) = summary.clearance {
            let then = if summary.delay.is_some() {
                "arrival"
            } else {
                "the end"
            };
            let lying = metres(evaluation.hold_clearance);
            let hold = evaluation.arrival_hold;
            say(
                "clearance",
                format!(
                    "{} m; after {then} {lying} m within {hold} s",
                    metres(clearance)
                ),
            );
        }
        if evaluation.min_land_distance.is_finite() {
            let (distance, time) = (
                evaluation.min_land_distance,
                evaluation.min_land_distance_time,
            );
            say("land", format!("{distance:.1} m off at {time:.0} s"));
        }
        if let Some(risk) = summary.max_risk {
            say("risk", risk_text(run, risk));
        }
        for violation in &evaluation.violations {
            say(
                "violation",
                format!("{} (at {:.1} s)", violation.what, violation.time),
            );
        }
    }
    if let Some(report) = &run.control {
        forces(run, report)
            .into_iter()
            .for_each(|(name, value)| say(name, value));
        say(TIME_LINE, format!("{:.2} ms", summary.milliseconds));
        return (head, lines);
    }
    let stats = &run.planned.stats;
    say(
        "search",
        format!(
            "{} expanded, {} generated, {} edges checked",
            stats.expanded, stats.generated, stats.edges_checked
        ),
    );
    say(TIME_LINE, format!("{:.2} ms", summary.milliseconds));
    (head, lines)
}

#[cfg(test)]
mod tests;
