//! Text of plan documents: one plan in aligned lines, and a table with a row per plan.

use std::collections::HashMap;
use std::path::Path;

use super::table::{
    Display, Field, Grid, ResultTable, Styled, Tone, both, datum, fact, number, or_dash, painted,
    plain, verdict, verified, yes_or_no,
};
use crate::document::{
    CostDocument, Departure, EncounterDocument, MONITORS, PlanDocument, PlannedLeg,
    SearchStatsDocument, SuiteDocument, SuiteRunDocument, TimingDocument, breaks, in_brackets,
    longest, met, passing, plan_lines, planned_legs, verdict_parts,
};
use crate::evaluation::risk_figure;
use crate::pipeline::{NO_RETURN_STEP_S, NoReturn, Run};
use crate::text::{Times, counted, knots_figure, printable, signed, square_metres, tenths};

/// Maximum number of targets that are listed; the rest is counted.
const LISTED: usize = 3;
const MOST_LEGS: usize = 40;

pub(super) const TIME_COLUMN: &str = "time";

/// Explains the column "clearance".
pub(super) const CLEARANCE: &str =
    "clearance: own hull to any hull that a target may have, or own position to an explicit set";

/// Names in tables and keys in data of the columns of a suite.
const COLUMNS: [(&str, &str); 24] = [
    ("", "file"),
    ("scenario", "scenario"),
    ("", "planner"),
    ("outcome", "outcome"),
    ("", "verdict"),
    ("", "arrived"),
    ("encounter", "roles"),
    ("manoeuvre", ""),
    ("", "largest_turn_deg"),
    ("", "largest_turn_side"),
    ("passing", ""),
    ("J\n[m²]", "space_time_error_m2"),
    ("", "duration_s"),
    ("delay\n[s]", "delay_s"),
    ("", "length_m"),
    ("clearance\n[m]", "min_clearance_m"),
    ("risk", "largest_risk"),
    ("breaks", "breaks"),
    ("method", "method"),
    ("nodes", "expanded"),
    ("time\n[ms]", "plan_ms"),
    ("verified", "verified"),
    ("safe", "safe"),
    ("", "reason"),
];

/// The table of many scenarios, one row each. Remarks explain the clearance and the monitors in it,
/// the last one counts the outcomes.
pub fn suite_table(suite: &SuiteDocument) -> ResultTable {
    let runs = &suite.runs;
    let rows = runs.iter().zip(row_names(runs));
    let rows = rows.map(|(run, name)| suite_row(run, name)).collect();
    let mut table = ResultTable::new(&COLUMNS, rows).showing(|grid| grid.breaking("breaks", 14));
    table.remark("clearance", CLEARANCE);
    let broken = runs.iter().filter_map(|run| breaks(&run.encounters));
    if let Some(key) = monitors_key(broken.flatten()) {
        table.remark("breaks", key);
    }
    table.remark("", suite.summary.to_string());
    table
}

/// The shortest names that tell the runs apart. A file alone has its name, or its path where
/// another file has the same name. A scenario of several in a file has its title, after the file
/// where the title occurs again.
fn row_names(runs: &[SuiteRunDocument]) -> Vec<String> {
    let name_of = |file: &str| -> Option<String> {
        let name = Path::new(file).file_name()?;
        Some(name.to_string_lossy().into_owned())
    };
    let mut files: HashMap<&str, usize> = HashMap::new();
    let mut titles: HashMap<&Option<String>, usize> = HashMap::new();
    for run in runs {
        *files.entry(&run.file).or_default() += 1;
        *titles.entry(&run.scenario).or_default() += 1;
    }
    let mut names: HashMap<Option<String>, usize> = HashMap::new();
    for file in files.keys() {
        *names.entry(name_of(file)).or_default() += 1;
    }
    let label = |run: &SuiteRunDocument| {
        let name = name_of(&run.file);
        let file = match names[&name] {
            1 => name.unwrap_or_else(|| run.file.clone()),
            _ => run.file.clone(),
        };
        match &run.scenario {
            Some(title) if files[run.file.as_str()] > 1 => match titles[&run.scenario] {
                1 => title.clone(),
                _ => format!("{file}: {title}"),
            },
            _ => file,
        }
    };
    runs.iter().map(label).collect()
}

fn suite_row(run: &SuiteRunDocument, name: String) -> Vec<Field> {
    let cost = run.cost.as_ref();
    let of = |value: fn(&CostDocument) -> f64| number(cost.map(value), tenths);
    let met = met(&run.encounters);
    let planned = cost.is_some();
    let risks = run.encounters.iter().filter_map(|e| e.max_risk);
    let per_target = |text: &dyn Fn(&EncounterDocument) -> String| {
        let mut lines: Vec<String> = met.iter().take(LISTED).map(|e| text(e)).collect();
        if met.len() > LISTED {
            lines.push(format!("+ {} more", met.len() - LISTED));
        }
        (!lines.is_empty()).then(|| lines.join("\n"))
    };
    let roles = per_target(&|e| e.role.to_string());
    let roles = roles.or_else(|| run.search_stats.map(|_| "none".to_owned()));
    let each_role: Vec<String> = met.iter().map(|e| e.role.to_string()).collect();
    let passing = or_dash(per_target(&passing).filter(|_| planned));
    let [degrees, side] = turned(run.departure);
    let method = run.method.map(|method| method.label().to_owned());
    let reason = run.reason.as_ref().or(run.error.as_ref());
    let (checked, safe) = (cost.map(|_| run.verified), cost.map(|_| run.safe));
    vec![
        datum(&run.file),
        both(
            plain(printable(&name)),
            run.scenario.clone().unwrap_or_default(),
        ),
        datum(run.planner.clone().unwrap_or_default()),
        both(verdict(&run.verdict), run.outcome.to_string()),
        datum(&run.verdict),
        datum(cost.map_or(String::new(), |c| c.arrived.to_string())),
        both(or_dash(roles), each_role.join(" ")),
        both(or_dash(cost.map(|_| manoeuvre(run.departure))), ""),
        degrees,
        side,
        both(passing, ""),
        number(cost.map(|c| c.space_time_error_m2), square_metres),
        of(|c| c.duration_s),
        number(cost.and_then(|c| c.delay_s), signed),
        of(|c| c.length_m),
        number(cost.and_then(|c| c.min_clearance_m), tenths),
        number(risks.max_by(f64::total_cmp), risk_figure),
        breaks_field(breaks(&run.encounters)),
        both(or_dash(method.clone()), method.unwrap_or_default()),
        nodes(run.search_stats.as_ref()),
        time(run.timing.as_ref()),
        fact(verified(checked, safe), checked),
        fact(yes_or_no(safe), safe),
        datum(reason.cloned().unwrap_or_default()),
    ]
}

/// Degrees and side of the greatest turn of a motion.
pub(super) fn turned(departure: Option<Departure>) -> [Field; 2] {
    let (degrees, side) = match departure {
        Some(Departure::Course { side, turn_deg, .. }) => (Some(turn_deg), side.to_string()),
        _ => (None, String::new()),
    };
    [number(degrees, tenths), datum(side)]
}

/// The departure of a motion in brief.
pub(super) fn manoeuvre(departure: Option<Departure>) -> String {
    departure.map_or("none".to_owned(), |departure| departure.brief())
}

pub(super) fn nodes(stats: Option<&SearchStatsDocument>) -> Field {
    let expanded = stats.and_then(|stats| stats.expanded);
    number(expanded.map(|n| n as f64), |n| n.to_string())
}

pub(super) fn time(timing: Option<&TimingDocument>) -> Field {
    number(timing.map(|timing| 1e3 * timing.plan_s), |ms| {
        format!("{ms:.2}")
    })
}

pub(super) fn breaks_field(broken: Option<Vec<&str>>) -> Field {
    let numbers = broken.as_ref().map_or_else(String::new, |b| b.join(" "));
    both(rules_broken(broken), numbers)
}

/// The numbers of the rules and monitors that are broken.
pub(super) fn rules_broken(broken: Option<Vec<&str>>) -> Styled {
    match broken {
        None => or_dash(None),
        Some(broken) if broken.is_empty() => ("none".to_owned(), Tone::Good),
        Some(broken) => (broken.join(", "), Tone::Bad),
    }
}

/// Explains the monitors among what is broken; `None` without one. Other names are rules.
pub(super) fn monitors_key<'a>(broken: impl Iterator<Item = &'a str>) -> Option<String> {
    let broken: Vec<&str> = broken.collect();
    let told = MONITORS
        .iter()
        .filter(|monitor| broken.contains(&monitor.monitor.word()));
    let told = told.map(|monitor| format!("{}: {}", monitor.monitor, monitor.breaks));
    let told: Vec<String> = told.collect();
    (!told.is_empty()).then(|| told.join("; "))
}

/// Formats the verdict and the costs of a run in aligned lines.
pub fn plan_text(run: &Run) -> String {
    plan_document_text(&PlanDocument::of(run), Display::default())
}

/// [`plan_text`] for a document.
pub fn plan_document_text(plan: &PlanDocument, display: Display) -> String {
    let lines = plan_lines(plan, Times::Seconds).into_iter();
    let aligned = lines.map(|(name, value)| format!("  {name:<13}{value}"));
    let all: Vec<String> = std::iter::once(painted_headline(plan, display))
        .chain(aligned)
        .collect();
    all.join("\n")
}

/// The headline of a plan with the colours of its outcome, its safety and the rules that it breaks.
fn painted_headline(plan: &PlanDocument, display: Display) -> String {
    let part = |part: String| {
        let tone = match part.split(' ').next() {
            Some("breaks") => Tone::Bad,
            Some("skips" | "ignores") => Tone::Fair,
            _ if plan.verified && plan.is_safe() => Tone::Good,
            _ => Tone::Bad,
        };
        painted((part, tone), display)
    };
    let parts: Vec<String> = verdict_parts(plan).into_iter().map(part).collect();
    let word = painted(verdict(&printable(&plan.verdict)), display);
    format!(
        "{}: {}",
        printable(&plan.scenario),
        in_brackets(&word, &parts)
    )
}

/// Formats the legs of a plan as a table; empty where it has none. A long one is cut.
pub fn legs_text(plan: &PlanDocument, display: Display) -> String {
    let mut grid = legs_grid(plan);
    if grid.rows.is_empty() {
        return String::new();
    }
    let more = grid.rows.len().saturating_sub(MOST_LEGS);
    grid.rows.truncate(MOST_LEGS);
    let more = match more {
        0 => String::new(),
        _ => format!(
            "\n{} more: `--route FILE.csv` writes all",
            counted(more, "leg")
        ),
    };
    format!("{}{more}", grid.text(display))
}

pub(super) fn legs_grid(plan: &PlanDocument) -> Grid {
    let legs = planned_legs(plan);
    let longest = longest(&legs);
    let row = |(index, leg): (usize, PlannedLeg)| {
        let motion = &leg.motion;
        vec![
            plain((index + 1).to_string()),
            plain(format!("{:.1}", motion.start_time)),
            plain(format!("{:.1}", motion.end_time())),
            plain(leg.course_figure()),
            plain(knots_figure(motion.speed)),
            plain(leg.length_figure(longest)),
            plain(leg.turn_words().unwrap_or("–".to_owned())),
            plain(leg.events.join("\n")),
        ]
    };
    let header =
        "leg, from\n[s], to\n[s], course\n[°], speed\n[kn], length\n[m], turn, what happens";
    Grid::new(header, 0..6, legs.into_iter().enumerate().map(row)).breaking("what happens", 22)
}

/// The note where no lower bound is found.
pub const NO_BOUND: &str =
    "no bound: it is found for plans along segments that arrive and enter no set";

/// Formats the line for the lower bound of the cost; `None` where there is none.
pub fn bound_line(plan: &PlanDocument) -> Option<String> {
    let least = plan.lower_bound?.space_time_error_m2;
    let cost = plan.cost.as_ref()?.space_time_error_m2;
    let above = match least > 0.0 {
        true => format!(
            "; the plan's is at most {:.2} times the least",
            cost / least
        ),
        false => String::new(),
    };
    // rounded down, because no motion is below what is said; tenths below a thousand
    let least = match least < 1e3 {
        true => (10.0 * least).floor() / 10.0,
        false => least.floor(),
    };
    let least = square_metres(least);
    Some(format!(
        "  {:<13}no motion around these sets has a J below {least} m²{above}",
        "bound"
    ))
}

/// Formats the line for the time of no return.
pub fn no_return_line(found: NoReturn) -> String {
    let text = match found {
        NoReturn::Never => "none: nothing is met on the desired trajectory".to_owned(),
        NoReturn::Past => {
            "past: no plan clear of every hard set was found even from the start".to_owned()
        }
        NoReturn::At(time) => format!(
            "{time:.0} s, to {NO_RETURN_STEP_S} s: the last time until which own ship can hold on \
             and still find a plan clear of every hard set"
        ),
    };
    format!("  {:<13}{text}", "no return")
}

/// Explains why [`Run::no_return`] returns nothing.
pub fn no_return_reason(run: &Run) -> String {
    let planner = run.scenario.planner.facts();
    let reason = if planner.has_no_return {
        "the desired trajectory cannot be followed".to_owned()
    } else {
        format!(
            "it is sought for plans of the space-time planner, this one is of the {} planner",
            planner.name
        )
    };
    format!("no time of no return: {reason}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colregs::compliance::MonitorVerdict;
    use crate::document::{SuiteOutcome, headline};
    use crate::pipeline;
    use crate::scenario::Scenario;

    fn planned() -> SuiteRunDocument {
        let text = include_str!("../../scenarios/colregs/give-way.toml");
        let run = pipeline::run(Scenario::parse(text).expect("valid"));
        SuiteRunDocument::of("a.toml".to_owned(), &PlanDocument::of(&run), Vec::new())
    }

    fn suite_text(runs: &[SuiteRunDocument], display: Display) -> String {
        suite_table(&SuiteDocument::of(runs.to_vec())).text(display)
    }

    #[test]
    fn rows_name_a_few_targets_and_count_the_rest() {
        let mut busy = planned();
        busy.encounters = vec![busy.encounters[0].clone(); 5];
        let table = suite_text(std::slice::from_ref(&busy), Display::default());
        assert_eq!(table.matches("port, astern").count(), LISTED, "{table}");
        assert!(table.contains("+ 2 more") && table.contains("a.toml"));
        assert!(!table.contains('\u{1b}'));
        let colour = Display {
            colour: true,
            width: None,
        };
        assert!(suite_text(&[planned()], colour).contains('\u{1b}'));
        let failed = SuiteRunDocument::failed(
            "x.toml".to_owned(),
            SuiteOutcome::NotApplicable,
            "no".to_owned(),
        );
        let both = suite_text(&[failed, busy], Display::default());
        assert!(both.find("x.toml") < both.find("a.toml"));
    }

    /// A name of a scenario is no column.
    #[test]
    fn a_remark_on_a_column_needs_the_column() {
        let mut run = planned();
        run.file = "clearance.toml".to_owned();
        for (width, is_told) in [(None, true), (Some(40), true), (Some(81), false)] {
            let display = Display {
                colour: false,
                width,
            };
            run.verdict = "a long outcome of many words which leaves no room for others".to_owned();
            let table = suite_text(std::slice::from_ref(&run), display);
            assert_eq!(table.contains(CLEARANCE), is_told, "{table}");
        }
    }

    #[test]
    fn a_headline_has_the_colours_of_its_parts() {
        let text = include_str!("../../scenarios/colregs/give-way.toml");
        let run = pipeline::run(Scenario::parse(text).expect("valid"));
        let mut plan = PlanDocument::of(&run);
        let first = |plan: &PlanDocument, colour: bool| {
            let display = Display {
                colour,
                width: None,
            };
            let text = plan_document_text(plan, display);
            text.lines().next().map(str::to_owned).expect("a line")
        };
        let [green, red, end] = ["\u{1b}[38;5;10m", "\u{1b}[38;5;9m", "\u{1b}[39m"];
        let both = format!("{green}solved{end} ({green}verified, safe{end})");
        assert_eq!(first(&plan, true), format!("Give-way: {both}"));
        assert_eq!(first(&plan, false), headline(&plan));
        plan.safe = Some(false);
        plan.encounters[0]
            .conduct
            .as_mut()
            .expect("a ship")
            .monitors[0]
            .verdict = MonitorVerdict::Violated;
        let ends = format!("({red}verified, not safe{end}; {red}breaks contact (S){end})");
        assert!(
            first(&plan, true).ends_with(&ends),
            "{}",
            first(&plan, true)
        );
    }

    #[test]
    fn a_row_has_the_shortest_name_that_tells_it_from_the_others() {
        let of = |file: &str, title: &str| SuiteRunDocument {
            file: file.to_owned(),
            scenario: Some(title.to_owned()),
            ..planned()
        };
        let runs = [
            of("dnv/one.toml", "HO"),
            of("imazu/all.json", "imazu-01"),
            of("imazu/all.json", "imazu-02"),
            of("copy/all.json", "imazu-02"),
            of("copy/all.json", "imazu-03"),
            of("a/same.toml", "HO"),
            of("b/same.toml", "HO"),
        ];
        let wanted = [
            "one.toml",
            "imazu-01",
            "imazu/all.json: imazu-02",
            "copy/all.json: imazu-02",
            "imazu-03",
            "a/same.toml",
            "b/same.toml",
        ];
        let names = row_names(&runs);
        assert_eq!(names, wanted);
    }

    #[test]
    fn a_verdict_has_the_tone_of_its_word() {
        for (word, tone) in [
            ("solved", Tone::Good),
            ("at risk 0.20", Tone::Fair),
            ("at risk 0.20, deadline", Tone::Bad),
            ("COLLIDES", Tone::Bad),
            ("unreadable", Tone::Bad),
            ("not applicable", Tone::Plain),
        ] {
            assert_eq!(verdict(word).1, tone, "{word}");
        }
    }
}
