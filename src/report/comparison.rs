//! Comparison of planners as a table for a terminal, as markdown, and as rows of a CSV file.

use super::plan::{CLEARANCE, milliseconds, monitors_key, rules_broken};
use super::table::{Display, Grid, Styled, in_cell, or_dash, plain, verdict, verified, yes_or_no};
use crate::document::{
    CollisionDocument, CostDocument, Departure, EntryDocument, ScenarioComparisonDocument,
};
use crate::evaluation::risk_figure;
use crate::obstacle::LAND;
use crate::report::plan::manoeuvre;
use crate::text::{knots, signed, significant, square_metres, tenths};

pub(super) fn is_sweep(entries: &[EntryDocument]) -> bool {
    entries.iter().any(|e| e.max_risk != entries[0].max_risk)
}

fn title(compared: &ScenarioComparisonDocument) -> &str {
    compared.scenario.as_deref().unwrap_or(&compared.file)
}

/// Formats the table of one scenario and the methods that do not apply.
pub fn comparison_table(compared: &ScenarioComparisonDocument, display: Display) -> String {
    let (table, columns) = comparison_grid(&compared.entries).text_and_columns(display);
    // remarks on a column that is dropped are none
    let dropped = [("[m²]", "J "), ("clearance", CLEARANCE)];
    let dropped = dropped.iter().filter(|(part, _)| {
        let mut columns = columns.iter();
        !columns.any(|column| column.contains(part))
    });
    let dropped: Vec<&str> = dropped.map(|(_, remark)| *remark).collect();
    let remarks = remarks(compared).into_iter();
    let remarks = remarks.filter(|remark| !dropped.iter().any(|start| remark.starts_with(start)));
    let mut lines = vec![title(compared).to_owned(), table];
    lines.extend(remarks);
    lines.join("\n")
}

/// Formats the table as markdown, without details, so that it fits a pane of a viewer.
pub fn comparison_markdown(compared: &ScenarioComparisonDocument) -> String {
    let grid = comparison_grid(&compared.entries).brief();
    let mut lines = vec![
        format!("# {}\n", in_cell(title(compared))),
        grid.markdown(),
        String::new(),
    ];
    let remarks = remarks(compared).into_iter();
    lines.extend(remarks.map(|remark| format!("- {}", in_cell(&remark))));
    lines.join("\n")
}

/// Entries whose motion is the same as that of an earlier one follow it in its group.
fn groups(entries: &[EntryDocument]) -> Vec<Vec<&EntryDocument>> {
    let result = |entry: &EntryDocument| EntryDocument {
        method: String::new(),
        search_stats: None,
        timing: None,
        ..entry.clone()
    };
    let planned = |entry: &EntryDocument| entry.cost.is_some() && entry.search_stats.is_some();
    let mut groups: Vec<Vec<&EntryDocument>> = Vec::new();
    for entry in entries {
        let same = |group: &&mut Vec<&EntryDocument>| {
            planned(entry) && planned(group[0]) && result(entry) == result(group[0])
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(entry),
            None => groups.push(vec![entry]),
        }
    }
    groups
}

/// The end of the name of a method that plans around ellipsoids.
const ELLIPSOIDS: &str = ", ellipsoids";

/// Names of methods as one: `space-time, A* and Dijkstra` where they differ in one part. With
/// `polytopes and ellipsoids` behind it where each of them occurs with both.
pub(super) fn joined(methods: &[&str]) -> String {
    let (round, other): (Vec<&str>, Vec<&str>) =
        methods.iter().partition(|m| m.ends_with(ELLIPSOIDS));
    let plain = round.iter().map(|m| m.trim_end_matches(ELLIPSOIDS));
    if !other.is_empty() && plain.eq(other.iter().copied()) {
        return format!("{}, polytopes and ellipsoids", joined(&other));
    }
    let split: Vec<Vec<&str>> = methods.iter().map(|m| m.split(", ").collect()).collect();
    let first = &split[0];
    let differ = |part: &usize| split.iter().any(|m| m.get(*part) != first.get(*part));
    let parts: Vec<usize> = (0..first.len()).filter(differ).collect();
    match parts[..] {
        [part] if split.iter().all(|m| m.len() == first.len()) => {
            let other: Vec<&str> = split.iter().map(|m| m[part]).collect();
            let other = other.join(" and ");
            let mut all = first.clone();
            all[part] = &other;
            all.join(", ")
        }
        _ => methods.join(" and "),
    }
}

/// Values of several entries in one cell, each once.
fn listed(values: impl Iterator<Item = Option<String>>) -> Styled {
    let mut values: Vec<String> = values.flatten().collect();
    values.dedup();
    or_dash((!values.is_empty()).then(|| values.join(", ")))
}

/// Builds one row per motion; in a sweep, with the accepted risk.
pub(super) fn comparison_grid(entries: &[EntryDocument]) -> Grid {
    let groups = groups(entries);
    let header = "method, outcome, manoeuvre, J\n[m²], arc J\n[m²], duration\n[s], delay\n[s], length\n[m], \
                  clearance\n[m], risk, nodes, time\n[ms], verified, safe, breaks";
    let rows = groups.iter().map(|group| row(group));
    let mut grid = Grid::new(header, 3..12, rows)
        .breaking("method", 22)
        .breaking("breaks", 9);
    if entries.iter().any(|entry| entry.lower_bound.is_some()) {
        grid.header.insert(4, "bound\n[m²]");
        grid.numbers.end += 1;
        for (row, group) in grid.rows.iter_mut().zip(&groups) {
            let bound = group[0].lower_bound.map(|b| b.space_time_error_m2);
            row.insert(4, or_dash(bound.map(square_metres)));
        }
    }
    if is_sweep(entries) {
        grid.header.insert(3, "accepted\nrisk");
        grid.numbers.end += 1;
        for (row, group) in grid.rows.iter_mut().zip(&groups) {
            row.insert(3, plain(group[0].max_risk.to_string()));
        }
    }
    grid
}

/// The manoeuvre in brief. A baseline that turns may also have another speed from the start.
fn departure(entry: &EntryDocument) -> String {
    let brief = manoeuvre(entry.departure);
    match (entry.departure, entry.velocity) {
        (Some(Departure::Course { .. }), Some(held)) => {
            format!("{brief} at {}", knots(held.speed_mps))
        }
        _ => brief,
    }
}

fn row(group: &[&EntryDocument]) -> Vec<Styled> {
    let entry = group[0];
    let methods: Vec<&str> = group.iter().map(|entry| entry.method.as_str()).collect();
    let nodes = |entry: &&EntryDocument| Some(entry.search_stats?.expanded?.to_string());
    let cost = entry.cost.as_ref();
    let figure = |value: fn(&CostDocument) -> f64, text: fn(f64) -> String| {
        or_dash(cost.map(value).filter(|v| v.is_finite()).map(text))
    };
    let safe = cost.map(|_| entry.safe);
    // nobody shall take the error of a motion that collides for the best one
    let error = |value: f64| match entry.safe {
        true => square_metres(value),
        false => format!("({})", square_metres(value)),
    };
    let error_of = |value: fn(&CostDocument) -> Option<f64>| {
        let value = cost.and_then(value).filter(|v| v.is_finite());
        or_dash(value.map(error))
    };
    let planned = entry.search_stats.is_some();
    vec![
        plain(joined(&methods)),
        verdict(&entry.verdict),
        or_dash(cost.map(|_| departure(entry))),
        error_of(|c| Some(c.space_time_error_m2)),
        error_of(|c| c.space_time_error_arc_length_m2),
        figure(|c| c.duration_s, tenths),
        or_dash(cost.and_then(|c| c.delay_s).map(signed)),
        figure(|c| c.length_m, significant),
        or_dash(cost.and_then(|c| c.min_clearance_m).map(tenths)),
        figure(|c| c.max_risk, risk_figure),
        listed(group.iter().map(nodes)),
        listed(
            group
                .iter()
                .map(|entry| entry.timing.as_ref().map(milliseconds)),
        ),
        verified(cost.filter(|_| planned).map(|_| entry.verified), safe),
        yes_or_no(safe),
        rules_broken(
            (entry.breaks.as_ref()).map(|rules| rules.iter().map(String::as_str).collect()),
        ),
    ]
}

/// Remarks, one sentence each: the end of the interval of J, reasons for missing motions, and
/// methods that do not apply.
pub(super) fn remarks(compared: &ScenarioComparisonDocument) -> Vec<String> {
    let entries = &compared.entries;
    let mut lines = Vec::new();
    if entries.iter().any(|e| e.cost.is_some()) {
        lines.push(
            "J is counted as in `plan`: to the end at the last waypoint; a motion that need not end \
             there, until own ship's length from it; one that does not come so near, to the end of \
             the desired time"
                .to_owned(),
        );
        lines.push(CLEARANCE.to_owned());
    }
    if entries.iter().any(|e| e.cost.is_some() && !e.safe) {
        let why = "the motion is not safe, so its J is no measure of it";
        lines.push(format!("J in brackets: {why}"));
    }
    let broken = entries.iter().filter_map(|entry| entry.breaks.as_ref());
    lines.extend(monitors_key(broken.flatten().map(String::as_str)));
    let mut collided: Vec<String> = Vec::new();
    for entry in entries {
        let Some(CollisionDocument { with, t_s }) = &entry.collision else {
            continue;
        };
        let what = match with.as_str() {
            LAND => "runs aground".to_owned(),
            name => format!("collides with '{name}'"),
        };
        let when = match with.as_str() {
            LAND => "",
            _ => ", when the hulls first touch on its expected motion",
        };
        let line = format!("{}: {what} at {t_s:.0} s{when}", entry.method);
        if !collided.contains(&line) {
            collided.push(line);
        }
    }
    if entries.iter().any(|entry| entry.lower_bound.is_some()) {
        lines.push(
            "bound: no motion of a point around the same sets has a smaller J, whatever the rules"
                .to_owned(),
        );
    }
    lines.append(&mut collided);
    let mut methods: Vec<&str> = Vec::new();
    for entry in entries {
        let method = entry.method.as_str();
        let Some(reason) = entry.reason.as_ref().filter(|_| !methods.contains(&method)) else {
            continue;
        };
        methods.push(method);
        let alike = |e: &&EntryDocument| e.method == entry.method && e.reason.is_some();
        let further = match entries.iter().filter(alike).count() - 1 {
            0 => String::new(),
            n => format!(" (at risk {}; none at {n} more)", entry.max_risk),
        };
        lines.push(format!("{method}{further}: {reason}"));
    }
    for other in &compared.inapplicable {
        lines.push(format!("{} does not apply: {}", other.method, other.reason));
    }
    lines
}

/// Columns of [`comparison_csv`], with commas between them.
pub const COMPARISON_COLUMNS: &str = "file,scenario,method,max_risk,outcome,verified,safe,arrived,\
    space_time_error_m2,lower_bound_m2,space_time_error_until_s,space_time_error_arc_length_m2,duration_s,delay_s,\
    length_m,min_clearance_m,largest_risk,largest_turn_deg,largest_turn_side,breaks,expanded,\
    plan_ms,reason";

/// Builds a row of values in the order of [`COMPARISON_COLUMNS`]; missing values are empty.
pub fn comparison_csv(compared: &ScenarioComparisonDocument, entry: &EntryDocument) -> Vec<String> {
    let cost = entry.cost.as_ref();
    let optional = |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
    let number =
        |value: fn(&CostDocument) -> f64| optional(cost.map(value).filter(|v| v.is_finite()));
    let word = |value: bool| cost.map_or_else(String::new, |_| value.to_string());
    let turn = match entry.departure {
        Some(Departure::Course { side, turn_deg, .. }) => Some((turn_deg, side)),
        _ => None,
    };
    vec![
        compared.file.clone(),
        compared.scenario.clone().unwrap_or_default(),
        entry.method.clone(),
        entry.max_risk.to_string(),
        entry.outcome.to_string(),
        word(entry.verified),
        word(entry.safe),
        cost.is_some_and(|c| c.arrived).to_string(),
        number(|c| c.space_time_error_m2),
        optional(entry.lower_bound.map(|b| b.space_time_error_m2)),
        number(|c| c.space_time_error_until_s),
        optional(cost.and_then(|c| c.space_time_error_arc_length_m2)),
        number(|c| c.duration_s),
        optional(cost.and_then(|c| c.delay_s)),
        number(|c| c.length_m),
        optional(cost.and_then(|c| c.min_clearance_m)),
        number(|c| c.max_risk),
        optional(turn.map(|(degrees, _)| degrees)),
        turn.map_or_else(String::new, |(_, side)| side.to_string()),
        (entry.breaks.as_ref()).map_or_else(String::new, |b| b.join(" ")),
        (entry.search_stats.and_then(|stats| stats.expanded))
            .map_or_else(String::new, |expanded| expanded.to_string()),
        optional(entry.timing.as_ref().map(|timing| 1e3 * timing.plan_s)),
        entry.reason.clone().unwrap_or_default(),
    ]
}

#[cfg(test)]
mod tests {
    use super::{ScenarioComparisonDocument, comparison_markdown, joined};

    #[test]
    fn a_table_of_a_recording_has_no_details() {
        let empty = ScenarioComparisonDocument {
            file: "a.toml".to_owned(),
            scenario: None,
            error: None,
            entries: Vec::new(),
            inapplicable: Vec::new(),
        };
        let header =
            "method | outcome | manoeuvre | J [m²] | clearance [m] | verified | safe | breaks";
        let table = comparison_markdown(&empty);
        assert!(table.contains(&format!("| {header} |\n")), "{table}");
    }

    #[test]
    fn methods_with_one_plan_have_one_name() {
        for (methods, name) in [
            (&["space-time, A*"][..], "space-time, A*"),
            (
                &["space-time, A*", "space-time, Dijkstra"],
                "space-time, A* and Dijkstra",
            ),
            (
                &[
                    "space-time, A*, ellipsoids",
                    "space-time, Dijkstra, ellipsoids",
                ],
                "space-time, A* and Dijkstra, ellipsoids",
            ),
            (
                &["space-time, A*", "space-time, A*, ellipsoids"],
                "space-time, A*, polytopes and ellipsoids",
            ),
            (
                &["path-time", "optimal control"],
                "path-time and optimal control",
            ),
        ] {
            assert_eq!(joined(methods), name);
        }
    }
}
