//! Text of a simulation.

use super::plan::{monitors_key, rules_broken};
use super::table::{Display, Grid, Styled, Tone, in_cell, or_dash, painted, plain, verdict};
use crate::colregs::compliance::MonitorVerdict;
use crate::document::{
    LastingAlarm, ReplanDocument, SailedDocument, SailedManoeuvreDocument, SimulatedTargetDocument,
    SimulationDocument, breaks_in_words, conduct_breaks, rules_in_words,
};
use crate::evaluation::{NOT_BY_THE_RULES, PlanOutcome};
use crate::text::{Times, counted, tenths, to_side};

pub(super) const TIMES: &str = "Planning";

/// Formats the headline, a table of the targets, own ship's conduct, the cycles and the alarms.
pub fn simulation_text(simulation: &SimulationDocument, display: Display) -> String {
    let parts = headline_parts(simulation, Times::Seconds).into_iter();
    let parts: Vec<String> = parts.map(|part| painted(part, display)).collect();
    let mut blocks = vec![format!("{}: {}", simulation.scenario, parts.join("; "))];
    if !simulation.targets.is_empty() {
        blocks.push(targets_grid(&simulation.targets, Times::Seconds).text(display));
    }
    let lines = conduct_lines(simulation, Times::Seconds).into_iter();
    let lines: Vec<String> = lines
        .map(|(name, text)| format!("{name}: {text}"))
        .collect();
    blocks.push(lines.join("\n"));
    if !simulation.alarms.is_empty() {
        let alarms = alarm_lines(simulation, Times::Seconds).into_iter();
        let lines: Vec<String> = alarms
            .map(|line| match line.starts_with("and ") {
                true => line,
                false => format!("alarm at {line}"),
            })
            .collect();
        blocks.push(lines.join("\n"));
    }
    blocks.join("\n\n")
}

/// Formats the same as markdown, with times as on a chart, for a pane that is narrower than the table in a
/// terminal.
pub fn simulation_markdown(simulation: &SimulationDocument) -> String {
    let headline = headline(simulation, Times::Clock);
    let mut blocks = vec![format!("### {}", in_cell(&headline))];
    if !simulation.targets.is_empty() {
        blocks.push(targets_grid(&simulation.targets, Times::Clock).markdown());
    }
    let lines = conduct_lines(simulation, Times::Clock).into_iter();
    let lines = lines.map(|(name, text)| format!("- **{name}**: {}", in_cell(&text)));
    let alarms = alarm_lines(simulation, Times::Clock).into_iter();
    let alarms = alarms.map(|line| format!("- **Alarm**: {}", in_cell(&line)));
    blocks.push(lines.chain(alarms).collect::<Vec<_>>().join("\n"));
    blocks.join("\n\n")
}

/// Formats the counts of several simulations, and of the files that were not simulated.
pub fn simulations_line(simulations: &[SimulationDocument], failed: usize) -> String {
    let count = |of: fn(&SimulationDocument) -> bool| simulations.iter().filter(|s| of(s)).count();
    let plural = if simulations.len() == 1 { "" } else { "s" };
    let mut line = format!(
        "{} simulation{plural}: {} without contact, {} safe, {} arrived",
        simulations.len(),
        count(|s| !s.contact),
        count(|s| s.safe),
        count(|s| s.arrived)
    );
    let others = [
        (count(|s| s.ends_short), "ended on the way"),
        (
            count(|s| !s.conduct.breaks.is_empty()),
            "with a rule broken",
        ),
        (failed, "not simulated"),
    ];
    for (count, name) in others.into_iter().filter(|(count, _)| *count > 0) {
        line += &format!(", {count} {name}");
    }
    line
}

/// Formats whether ships met, the rules that own ship broke, and whether it arrived.
pub(super) fn headline(simulation: &SimulationDocument, times: Times) -> String {
    let parts = headline_parts(simulation, times).into_iter();
    let parts: Vec<String> = parts.map(|(text, _)| text).collect();
    format!("{}: {}", simulation.scenario, parts.join("; "))
}

pub(super) fn headline_parts(simulation: &SimulationDocument, times: Times) -> Vec<Styled> {
    let met = (simulation.targets.iter())
        .filter(|target| target.contact_t_s.is_some())
        .map(|target| target.name.as_str());
    let land = simulation.land.iter().filter(|land| land.grounded);
    let met: Vec<&str> = met.chain(land.map(|_| "land")).collect();
    let outcome = match (simulation.contact, simulation.safe) {
        (true, _) => format!("CONTACT with {}", met.join(", ")),
        (false, true) => "no contact, every plan safe".to_owned(),
        (false, false) => "no contact, but NOT SAFE".to_owned(),
    };
    let mut broken = Vec::new();
    if !simulation.conduct.within_tracking_margin {
        broken.push("own ship left its tracking margin".to_owned());
    }
    let left = simulation.targets.iter().filter(|t| t.outside_sets > 0);
    broken.extend(left.map(|target| format!("'{}' left its set", target.name)));
    let broken = match broken.is_empty() {
        true => String::new(),
        false => format!(" ({})", broken.join(", ")),
    };
    let tone = match simulation.safe && !simulation.contact {
        true => Tone::Good,
        false => Tone::Bad,
    };
    let breaks = breaks_in_words(simulation.conduct.breaks.iter().map(String::as_str));
    let (arrived, arrival_tone) = match (simulation.arrived, simulation.interrupted) {
        (true, _) => ("arrived".to_owned(), Tone::Plain),
        (false, true) => ("INTERRUPTED".to_owned(), Tone::Plain),
        (false, false) if simulation.ends_short => (
            format!("ENDED {:.0} m from the last waypoint", simulation.to_go_m),
            Tone::Bad,
        ),
        (false, false) => ("not arrived".to_owned(), Tone::Plain),
    };
    let end = format!("{arrived} after {}", times.at(simulation.duration_s, 0));
    let breaks = breaks.map(|breaks| (breaks, Tone::Bad));
    std::iter::once((outcome + &broken, tone))
        .chain(breaks)
        .chain([(end, arrival_tone)])
        .collect()
}

/// Own ship's manoeuvres, and when it turns back.
fn manoeuvres(sailed: &SailedDocument, times: Times) -> String {
    let manoeuvre = |m: &SailedManoeuvreDocument| match m.returns_s {
        Some(time) => {
            let departure = m.departure.words(times);
            format!("{departure}, back from {}", times.at(time, 0))
        }
        None => m.departure.words(times),
    };
    let all: Vec<String> = sailed.manoeuvres.iter().map(manoeuvre).collect();
    match all.is_empty() {
        true => "none".to_owned(),
        false => all.join("; "),
    }
}

/// A row per target: captain's figures, and the rules that own ship breaks toward it.
pub(super) fn targets_grid(targets: &[SimulatedTargetDocument], times: Times) -> Grid {
    let rows = targets.iter().map(|target| {
        let roles = target.conduct.roles.iter();
        let roles: Vec<&str> = roles.map(|r| r.role.word()).collect();
        let broken = conduct_breaks(&target.conduct);
        let clearance = match (target.least_clearance_m, target.contact_t_s) {
            (Some(metres), None) => plain(tenths(metres)),
            (metres, _) => (metres.map_or("contact".to_owned(), tenths), Tone::Bad),
        };
        let lead = target.conduct.manoeuvre.as_ref().and_then(|m| m.lead_s);
        vec![
            plain(target.name.clone()),
            plain(target.behaviour.word()),
            or_dash((!roles.is_empty()).then(|| roles.join("\n"))),
            clearance,
            plain(times.figure(target.least_clearance_t_s, 0)),
            or_dash(lead.map(|lead| times.figure(lead, 0))),
            plain(target.outside_sets.to_string()),
            rules_broken(Some(broken)),
        ]
    });
    let header = match times {
        Times::Seconds => {
            "target, behaviour, own\nrole, clearance\n[m], at\n[s], acts before\n[s], \
             outside\nits set, breaks"
        }
        Times::Clock => {
            "target, behaviour, own\nrole, clearance\n[m], at, acts before, outside\nits set, breaks"
        }
    };
    Grid::new(header, 3..7, rows).breaking("breaks", 9)
}

/// Named lines of what was sailed and of the plans.
pub(super) fn conduct_lines(
    simulation: &SimulationDocument,
    times: Times,
) -> Vec<(&'static str, String)> {
    let (sailed, timing) = (&simulation.conduct, &simulation.timing);
    let first = sailed.first_plan_cost_m2;
    let share = first
        .filter(|first| *first >= LEAST_COST_M2)
        .map_or(String::new(), |first| {
            format!(", {:.2} of the first plan's", sailed.cost_m2 / first)
        });
    let plans = simulation.replans.len();
    let kept = simulation.replans.iter().filter(|r| r.keeps_plan).count();
    let with_verdict = |word: &&str| {
        simulation
            .replans
            .iter()
            .filter(|r| r.verdict == **word)
            .count()
    };
    let given_up: String = [PlanOutcome::Relaxed.word(), NOT_BY_THE_RULES]
        .iter()
        .map(|word| (with_verdict(word), word))
        .filter(|(count, _)| *count > 0)
        .map(|(count, word)| format!(", {count} {word}"))
        .collect();
    let land = simulation.land.as_ref().map(|land| {
        let text = match (land.least_m, land.grounded) {
            (Some(metres), _) => format!(
                "{} m off at least, at {}",
                tenths(metres),
                times.at(land.least_t_s, 0)
            ),
            (None, true) => "touched".to_owned(),
            (None, false) => "none in the map".to_owned(),
        };
        ("Land", text)
    });
    let seen_late = simulation
        .targets
        .iter()
        .filter(|t| t.unknown_until_s > 0.0);
    let seen_late = seen_late.map(|target| {
        let name = &target.name;
        match target.unknown_until_s < simulation.duration_s {
            true => format!("{name} from {} on", times.at(target.unknown_until_s, 0)),
            false => format!("{name} never"),
        }
    });
    let seen_late: Vec<String> = seen_late.collect();
    let mut lines = vec![
        (
            "Sailed",
            format!(
                "J {:.0} m²{share}; toward one target, until it is nearest, at most {} and {} of speed",
                sailed.cost_m2,
                counted(sailed.turns, "turn"),
                counted(sailed.speed_changes, "change")
            ),
        ),
        ("Manoeuvres", manoeuvres(sailed, times)),
        (
            "Plans",
            format!(
                "{plans}, {kept} kept from the one before{given_up}; manoeuvres by the rules replaced \
                 {}, to the other side {}; remainders lost {}, unsafe {}, without a plan {}",
                sailed.replaced_manoeuvres,
                sailed.side_switches,
                sailed.lost_remainders,
                sailed.unsafe_plans,
                sailed.without_plan
            ),
        ),
        (
            "Off the plan",
            format!(
                "at most {} m, at {}, {} the tracking margin",
                tenths(sailed.largest_off_plan_m),
                times.at(sailed.largest_off_plan_t_s, 0),
                match sailed.within_tracking_margin {
                    true => "within",
                    false => "BEYOND",
                }
            ),
        ),
        (
            TIMES,
            format!(
                "{:.1} ms in the median, {:.1} ms at 99 %, {:.1} ms at most",
                timing.quantile_ms(0.5),
                timing.quantile_ms(0.99),
                timing.quantile_ms(1.0)
            ),
        ),
    ];
    let monitors = monitors_key(sailed.breaks.iter().map(String::as_str));
    let monitors = monitors.map(|key| ("Monitors", key)).into_iter();
    let seen = (!seen_late.is_empty()).then(|| ("Seen", seen_late.join("; ")));
    lines.splice(1..1, monitors.chain(land).chain(seen));
    lines
}

/// A row per target: both judges on what was sailed.
pub(super) fn judges_grid(targets: &[SimulatedTargetDocument]) -> Grid {
    let rows = targets.iter().map(|target| {
        let conduct = &target.conduct;
        let lines = |lines: Vec<String>, tone| match lines.is_empty() {
            true => or_dash(None),
            false => (lines.join("\n"), tone),
        };
        let scores = conduct.scores.iter();
        let scores = scores.map(|(rule, score)| format!("{} {score:.2}", rule.replace('_', " ")));
        let violations = conduct.violations.iter();
        let violations = violations.map(|v| format!("{}: {}, at {:.0} s", v.rule, v.what, v.t_s));
        let monitors = |verdict: MonitorVerdict| -> Vec<String> {
            let found = conduct.monitors.iter().filter(|m| m.verdict == verdict);
            found.map(|m| rules_in_words([m.monitor.word()])).collect()
        };
        vec![
            plain(target.name.clone()),
            lines(scores.collect(), Tone::Plain),
            lines(violations.collect(), Tone::Bad),
            lines(monitors(MonitorVerdict::Satisfied), Tone::Plain),
            lines(monitors(MonitorVerdict::Violated), Tone::Bad),
        ]
    });
    let header = "target, scores, rules broken, monitors satisfied, monitors violated";
    Grid::new(header, 0..0, rows)
}

/// Space-time error of the first plan below which no ratio to it is shown, m²: it hardly deviates.
const LEAST_COST_M2: f64 = 1.0;

/// Degrees. A smaller difference between the turns of two plans does not count.
const OTHER_TURN_DEG: f64 = 5.0;

/// A row per plan that differs from the one before: in its outcome, its manoeuvre, or the targets
/// that left their sets.
pub(super) fn replans_grid(replans: &[ReplanDocument]) -> Grid {
    let mut before: Option<&ReplanDocument> = None;
    let mut rows = Vec::new();
    for replan in replans {
        let outside = [&replan.outside_velocities, &replan.outside_places];
        let is_other = before.replace(replan).is_none_or(|before| {
            let turn = |r: &ReplanDocument| r.turn_deg.unwrap_or(0.0);
            let state = |r: &ReplanDocument| (r.verdict.clone(), r.safe, r.relaxations.clone());
            state(before) != state(replan) || (turn(before) - turn(replan)).abs() > OTHER_TURN_DEG
        });
        if !is_other && replan.followed && outside.iter().all(|names| names.is_empty()) {
            continue;
        }
        let mut remarks = Vec::new();
        if ![ReplanDocument::START, ReplanDocument::PERIOD].contains(&replan.reason.as_str()) {
            remarks.push(format!("asked for by an event: {}", replan.reason));
        }
        if !replan.followed {
            remarks.push("not followed".to_owned());
        }
        if !replan.relaxations.is_empty() {
            let kinds: Vec<&str> = replan.relaxations.iter().map(|kind| kind.word()).collect();
            remarks.push(format!("relaxed: {}", kinds.join(", ")));
        }
        for (names, what) in outside
            .into_iter()
            .zip(["another velocity", "another place"])
        {
            if !names.is_empty() {
                remarks.push(format!("{what} than assumed: {}", names.join(", ")));
            }
        }
        let word = match replan.safe {
            true => verdict(&replan.verdict),
            false => (replan.verdict.clone(), Tone::Bad),
        };
        rows.push(vec![
            plain(format!("{:.0} s", replan.t_s)),
            or_dash(replan.turn_deg.map(turn_text)),
            or_dash(replan.cost_m2.map(|cost| format!("{cost:.0}"))),
            word,
            or_dash((!remarks.is_empty()).then(|| remarks.join("\n"))),
        ]);
    }
    Grid::new("planned at, turn, J\n[m²], outcome, remarks", 1..3, rows)
}

fn turn_text(degrees: f64) -> String {
    if degrees.abs() < 0.5 {
        return "none, by speed".to_owned();
    }
    to_side(degrees)
}

/// Alarms that are listed; the others are counted.
const LISTED: usize = 12;

/// Lines of the first alarms, and the number of the others.
pub(super) fn alarm_lines(simulation: &SimulationDocument, times: Times) -> Vec<String> {
    let alarms = simulation.lasting_alarms();
    let line = |alarm: &LastingAlarm| {
        let again = match alarm.count {
            1 => String::new(),
            n => format!(", {} more until {}", n - 1, times.at(alarm.until_s, 0)),
        };
        format!(
            "{}{again}: {}",
            times.at(alarm.first.t_s, 0),
            alarm.first.words()
        )
    };
    let mut lines: Vec<String> = alarms.iter().take(LISTED).map(line).collect();
    if alarms.len() > LISTED {
        lines.push(format!("and {} more", alarms.len() - LISTED));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::{conduct_lines, headline, simulation_markdown, simulation_text};
    use crate::report::Display;
    use crate::scenario::Scenario;
    use crate::simulation::Simulation;
    use crate::text::Times;

    #[test]
    fn markdown_says_what_the_text_says() {
        let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref()).expect("valid");
        let mut simulation = Simulation::new(scenario, false).expect("a closed loop");
        simulation.step();
        let document = simulation.record();
        let markdown = simulation_markdown(&document);
        let title = headline(&document, Times::Clock);
        let headline = format!("### {title}\n\n| target | ");
        assert!(markdown.starts_with(&headline), "{markdown}");
        let named = conduct_lines(&document, Times::Clock);
        let text = simulation_text(&document, Display::default());
        assert!(
            named
                .iter()
                .all(|(name, _)| text.contains(&format!("\n{name}: ")))
        );
        assert!(named.len() >= 4);
        for (name, said) in named {
            assert!(
                markdown.contains(&format!("- **{name}**: {said}")),
                "{name}"
            );
        }
    }
}
