//! The verdict in words and figures, as markdown.

use super::explored::DrawnGraph;
use super::ships::vector_seconds;
use crate::document::{PlanDocument, TIME_LINE, headline, longest, plan_lines, planned_legs};
use crate::evaluation::Evaluation;
use crate::recording::canvas::{ShownMotion, ViewModel};
use crate::text::{Times, broken, clock, knots_figure, rounded, significant};

/// Characters of a line that a window 1280 wide shows.
const CELL_WIDTH: usize = 78;
const EVENT_WIDTH: usize = 42;

pub fn text(model: &ViewModel, plan: &PlanDocument, drawn: DrawnGraph) -> String {
    let lines = targets_first(plan_lines(plan, Times::Clock)).into_iter();
    // the planning time would make equal recordings differ
    let rows = lines.filter(|(name, _)| *name != TIME_LINE);
    let rows = rows.flat_map(|(name, value)| table_rows([name.to_owned()], &value, CELL_WIDTH));
    let rows = table(rows.collect(), 2);
    let shown = match plan.trajectory {
        Some(_) => graph(drawn),
        None => "The views show own ship as if it followed the desired trajectory.".to_owned(),
    };
    let mut parts = vec![
        format!("### {}", headline(plan)),
        rows,
        shown,
        claim(model),
        key(model),
    ];
    parts.retain(|part| !part.is_empty());
    parts.join("\n\n")
}

/// The legs of the plan as a table of markdown; `None` where it has none.
pub fn legs(plan: &PlanDocument) -> Option<String> {
    let legs = planned_legs(plan);
    let longest = longest(&legs);
    let rows = legs.into_iter().flat_map(|leg| {
        let motion = &leg.motion;
        let cells = [
            clock(motion.start_time),
            clock(motion.end_time()),
            leg.course_figure(),
            knots_figure(motion.speed),
            leg.length_figure(longest),
            leg.turn_words().unwrap_or("–".to_owned()),
        ];
        table_rows(cells, &leg.events.join("\n"), EVENT_WIDTH)
    });
    let rows: Vec<String> = rows.collect();
    let head = "| from | to | course, ° | speed, kn | length, m | turn | what happens |\n";
    (!rows.is_empty()).then(|| table([vec![head.to_owned()], rows].concat(), 7))
}

/// Rows of a table of markdown, with `last` behind the other cells. The viewer cuts lines that are
/// too long, and a cell has one line: so there are as many rows as `last` needs.
fn table_rows<const N: usize>(cells: [String; N], last: &str, width: usize) -> Vec<String> {
    let last = broken(&last.replace('|', "\\|"), width, "");
    let row = |(index, line): (usize, &str)| {
        let first = |cell: &String| {
            if index == 0 {
                cell.clone()
            } else {
                String::new()
            }
        };
        let cells = cells.each_ref().map(first);
        format!("| {} | {line} |\n", cells.join(" | "))
    };
    let lines = if last.is_empty() {
        vec![""]
    } else {
        last.lines().collect()
    };
    lines.into_iter().enumerate().map(row).collect()
}

/// Rows as one table, whose head is the first.
fn table(mut rows: Vec<String>, columns: usize) -> String {
    rows.insert(rows.len().min(1), format!("|{}\n", "---|".repeat(columns)));
    rows.concat().trim_end().to_owned()
}

/// Puts the blocks of the targets before the others: a navigator looks for them first.
fn targets_first(lines: Vec<(&'static str, String)>) -> Vec<(&'static str, String)> {
    let mut in_block = false;
    let (mut targets, others): (Vec<_>, Vec<_>) = lines.into_iter().partition(|(name, _)| {
        in_block = *name == "target" || (name.is_empty() && in_block);
        in_block
    });
    targets.extend(others);
    targets
}

fn graph(drawn: DrawnGraph) -> String {
    let shown = if drawn.edges < drawn.tested {
        format!("{} of {} tested edges are", drawn.edges, drawn.tested)
    } else {
        format!("All {} tested edges that take time are", drawn.tested)
    };
    match drawn.tested {
        0 => "No graph was searched for this plan.".to_owned(),
        _ => format!("{shown} in the recording under `explored`, hidden on the chart."),
    }
}

fn claim(model: &ViewModel) -> String {
    let run = model.run;
    let judged = run.evaluation.as_ref().is_some_and(Evaluation::verified);
    let ShownMotion::Planned(trajectory) = model.motion else {
        return String::new();
    };
    if !judged {
        return "Nothing is claimed.".to_owned();
    }
    if run.greatest_risk() > 0.0 || !run.safe() {
        let safe = if run.safe() { "safe" } else { "not safe" };
        return format!(
            "The plan is {safe}, and enters sets: nothing more is claimed about these than above."
        );
    }
    let ships = run.scenario.targets.iter().filter(|t| t.ship().is_some());
    let margin = format!(
        "so at least {} m remain between the hulls, ",
        significant(run.scenario.own_ship.safety_margin)
    );
    let hulls = match ships.count() {
        0 => String::new(),
        n if n == run.scenario.targets.len() => margin,
        _ => format!("{margin}except of targets whose sets are given, "),
    };
    let end = if run.arrives() { "arrival" } else { "its end" };
    format!(
        "**Claimed** until {end} at {}: own ship's centre stays out of all hard sets, \
         {hulls}wherever in its initial set a target starts and however its velocity varies within \
         its velocity set. **Not claimed:** anything after that, or about a target that leaves \
         its sets.",
        clock(trajectory.end_time()),
    )
}

fn key(model: &ViewModel) -> String {
    format!(
        "Chart: own ship is white, its plan yellow and thick where it is faster than desired, blue \
         and thin where it is slower; the desired trajectory is dashed. A target has a colour: \
         thick for its hard set, thin for the set with its ship domain. The green line is the \
         closest approach. Thin lines ahead of ships are speed vectors of {:.0} s; dots on the \
         tracks are every {} min; the grid has {} m. \
         Sets apply to own ship's centre: they include its hull and the margin.",
        vector_seconds(model),
        clock(super::chart::mark_step(model)),
        rounded(super::chart::grid_spacing(model)),
    )
}
