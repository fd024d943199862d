//! Comparison of planners as a table, and the rows of its data.

use super::plan::{CLEARANCE, breaks_field, manoeuvre, monitors_key, nodes, time, turned};
use super::table::{
    Field, ResultTable, both, datum, fact, number, or_dash, plain, verdict, verified, yes_or_no,
};
use crate::document::{
    CollisionDocument, CostDocument, Departure, EntryDocument, ScenarioComparisonDocument,
    SuiteOutcome,
};
use crate::evaluation::risk_figure;
use crate::obstacle::LAND;
use crate::text::{knots, signed, significant, square_metres, tenths};

pub(super) fn is_sweep(entries: &[EntryDocument]) -> bool {
    entries.iter().any(|e| e.max_risk != entries[0].max_risk)
}

/// Names in tables and keys in data of the columns of a comparison.
const COLUMNS: [(&str, &str); 25] = [
    ("", "file"),
    ("", "scenario"),
    ("method", "method"),
    ("accepted\nrisk", "max_risk"),
    ("outcome", "outcome"),
    ("", "verdict"),
    ("", "arrived"),
    ("manoeuvre", ""),
    ("", "largest_turn_deg"),
    ("", "largest_turn_side"),
    ("J\n[m²]", "space_time_error_m2"),
    ("bound\n[m²]", "lower_bound_m2"),
    ("", "space_time_error_until_s"),
    ("arc J\n[m²]", "space_time_error_arc_length_m2"),
    ("duration\n[s]", "duration_s"),
    ("delay\n[s]", "delay_s"),
    ("length\n[m]", "length_m"),
    ("clearance\n[m]", "min_clearance_m"),
    ("risk", "largest_risk"),
    ("nodes", "expanded"),
    ("time\n[ms]", "plan_ms"),
    ("verified", "verified"),
    ("safe", "safe"),
    ("breaks", "breaks"),
    ("", "reason"),
];

/// The table of one scenario: a row for each method, in a sweep for each accepted risk of it. The
/// remarks explain the columns, missing motions and the methods that do not apply. A file without a
/// comparison has one row.
pub fn comparison_table(compared: &ScenarioComparisonDocument) -> ResultTable {
    let entries = &compared.entries;
    let failed = compared.error.iter().map(|error| failed(compared, error));
    let rows = entries.iter().map(|entry| row(compared, entry));
    let rows = rows.chain(failed).collect();
    let mut table = ResultTable::new(&COLUMNS, rows)
        .titled(compared.scenario.as_deref().unwrap_or(&compared.file))
        .showing(|grid| grid.breaking_last("method", 22).breaking_last("breaks", 9));
    if !entries.iter().any(|entry| entry.lower_bound.is_some()) {
        table = table.showing(|grid| grid.without("bound"));
    }
    if !is_sweep(entries) {
        table = table.showing(|grid| grid.without("accepted"));
    }
    remark(&mut table, compared);
    table
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

/// The row of a file that yields no comparison.
fn failed(compared: &ScenarioComparisonDocument, error: &str) -> Vec<Field> {
    let word = SuiteOutcome::Unreadable.word();
    let field = |(_, key): &(&str, &str)| match *key {
        "file" => datum(&compared.file),
        "outcome" => both(verdict(word), word),
        "verdict" => datum(word),
        "reason" => datum(error),
        _ => both(or_dash(None), ""),
    };
    COLUMNS.iter().map(field).collect()
}

fn row(compared: &ScenarioComparisonDocument, entry: &EntryDocument) -> Vec<Field> {
    let cost = entry.cost.as_ref();
    let of = |value: fn(&CostDocument) -> f64| cost.map(value);
    // nobody shall take the error of a motion that collides for the best one
    let error = |value: f64| match entry.safe {
        true => square_metres(value),
        false => format!("({})", square_metres(value)),
    };
    let [degrees, side] = turned(entry.departure);
    let safe = cost.map(|_| entry.safe);
    // tables show the check of plans alone, data that of baselines, too
    let checked = cost.map(|_| entry.verified);
    let planned = checked.filter(|_| entry.search_stats.is_some());
    let breaks = entry.breaks.as_ref();
    let breaks = breaks.map(|rules| rules.iter().map(String::as_str).collect());
    vec![
        datum(&compared.file),
        datum(compared.scenario.clone().unwrap_or_default()),
        both(plain(&entry.method), &entry.method),
        number(Some(entry.max_risk), |risk| risk.to_string()),
        both(verdict(&entry.verdict), entry.outcome.to_string()),
        datum(&entry.verdict),
        datum(cost.map_or(String::new(), |c| c.arrived.to_string())),
        both(or_dash(cost.map(|_| departure(entry))), ""),
        degrees,
        side,
        number(of(|c| c.space_time_error_m2), error),
        number(
            entry.lower_bound.map(|b| b.space_time_error_m2),
            square_metres,
        ),
        number(of(|c| c.space_time_error_until_s), tenths),
        number(cost.and_then(|c| c.space_time_error_arc_length_m2), error),
        number(of(|c| c.duration_s), tenths),
        number(cost.and_then(|c| c.delay_s), signed),
        number(of(|c| c.length_m), significant),
        number(cost.and_then(|c| c.min_clearance_m), tenths),
        number(of(|c| c.max_risk), risk_figure),
        nodes(entry.search_stats.as_ref()),
        time(entry.timing.as_ref()),
        fact(verified(planned, safe), checked),
        fact(yes_or_no(safe), safe),
        breaks_field(breaks),
        datum(entry.reason.clone().unwrap_or_default()),
    ]
}

/// Adds remarks, one sentence each: the end of the interval of J, reasons for missing motions, and
/// methods that do not apply.
fn remark(table: &mut ResultTable, compared: &ScenarioComparisonDocument) {
    let entries = &compared.entries;
    if entries.iter().any(|e| e.cost.is_some()) {
        table.remark(
            "J",
            "J is counted as in `plan`: to the end at the last waypoint; a motion that need not end \
             there, until own ship's length from it; one that does not come so near, to the end of \
             the desired time",
        );
        table.remark("clearance", CLEARANCE);
    }
    if entries.iter().any(|e| e.cost.is_some() && !e.safe) {
        let why = "the motion is not safe, so its J is no measure of it";
        table.remark("J", format!("J in brackets: {why}"));
    }
    let broken = entries.iter().filter_map(|entry| entry.breaks.as_ref());
    if let Some(key) = monitors_key(broken.flatten().map(String::as_str)) {
        table.remark("breaks", key);
    }
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
        table.remark(
            "bound",
            "bound: no motion of a point around the same sets has a smaller J, whatever the rules",
        );
    }
    collided.into_iter().for_each(|line| table.remark("", line));
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
        table.remark("", format!("{method}{further}: {reason}"));
    }
    for other in &compared.inapplicable {
        let remark = format!("{} does not apply: {}", other.method, other.reason);
        table.remark("", remark);
    }
}

#[cfg(test)]
mod tests {
    use super::{ScenarioComparisonDocument, comparison_table};

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
        let table = comparison_table(&empty).brief().markdown();
        assert!(table.contains(&format!("| {header} |\n")), "{table}");
    }
}
