//! Text of a plan document's verification.

use super::plan::CLEARANCE;
use super::table::{Display, Grid, Tone, or_dash, plain};
use crate::evaluation::{Violation, facts, outcome_word, skipped_waypoints};
use crate::text::{counted, printable, short_numbers, tenths};
use crate::verification::{SimulationVerification, Verification};

const LISTED: usize = 20;

/// The first violations, one line each, and the number of the others.
fn fault_lines(violations: &[Violation]) -> Vec<String> {
    let mut faults = violations.iter();
    let listed = faults.by_ref().take(LISTED);
    let mut lines: Vec<String> = listed
        .map(|fault| {
            let what = printable(&fault.what);
            format!("  at {} s: {what}", thousandths(fault.time))
        })
        .collect();
    let more = faults.count();
    if more > 0 {
        lines.push(format!("  and {more} more"));
    }
    lines
}

/// Formats the verdict on a simulation, and all violations.
pub fn simulation_verification_text(checked: &SimulationVerification) -> String {
    // infinite without targets
    let least = match checked.least_clearance.is_finite() {
        true => format!(", least distance {} m", tenths(checked.least_clearance)),
        false => String::new(),
    };
    let verdict = match checked.violations.len() {
        0 => format!("verified: {}{least}", checked.outcome()),
        n => format!("REJECTED, {}", counted(n, "fault")),
    };
    let mut lines = vec![format!("{}: {verdict}", printable(&checked.scenario))];
    lines.extend(fault_lines(&checked.violations));
    lines.join("\n")
}

/// Formats the verdict and what was checked in one line.
pub fn verification_line(checked: &Verification) -> String {
    let said = std::iter::once(verdict_line(checked)).chain(extent(checked));
    said.collect::<Vec<_>>().join("; ")
}

fn verdict_line(checked: &Verification) -> String {
    let verdict = match (&checked.evaluation, checked.violations.len()) {
        (None, _) => format!(
            "no plan in it (outcome {}): nothing to verify",
            checked.outcome
        ),
        (Some(evaluation), 0) => {
            let facts = facts(true, checked.safe());
            match outcome_word(checked.outcome, Some(evaluation.safety), checked.risk_taken) {
                word if word == checked.outcome.word() => facts.to_owned(),
                word => format!("{facts}: {word}"),
            }
        }
        (Some(_), n) => format!("REJECTED, {}", counted(n, "fault")),
    };
    format!("{}: {verdict}", printable(&checked.scenario))
}

/// How much was checked; `None` without a plan.
fn extent(checked: &Verification) -> Option<String> {
    let evaluation = checked.evaluation.as_ref()?;
    let out_of_reach = match checked.out_of_reach {
        0 => String::new(),
        count => format!("; {} out of reach", counted(count, "target")),
    };
    Some(format!(
        "{} plan, {} until {} s; {}, {} of land{out_of_reach}",
        checked.planner,
        counted(checked.pieces, "piece"),
        tenths(evaluation.duration),
        counted(checked.sets, "set"),
        counted(checked.land, "piece"),
    ))
}

/// Formats the verdict, the least margin to every target with its time, and all violations.
pub fn verification_text(checked: &Verification, display: Display) -> String {
    let mut lines = vec![verdict_line(checked)];
    lines.extend(fault_lines(&checked.violations));
    let Some(evaluation) = &checked.evaluation else {
        return lines.join("\n");
    };
    lines.extend(extent(checked));
    let mut entered: Vec<(&String, f64)> = (checked.targets.iter())
        .zip(checked.claimed_from.iter().copied())
        .filter(|(_, from)| *from > 0.0)
        .collect();
    entered.sort_by(|a, b| a.1.total_cmp(&b.1));
    lines.extend(entered.into_iter().map(|(target, from)| {
        let until = if from < evaluation.duration {
            format!("before {} s", tenths(from))
        } else {
            "at all".to_owned()
        };
        let target = printable(target);
        format!("The set of '{target}' is entered: nothing is claimed of it {until}")
    }));
    let skipped = skipped_waypoints(&evaluation.waypoint_distances, checked.turning_radius);
    if !skipped.is_empty() {
        lines.push(format!("Skips {skipped}"));
    }
    if evaluation.min_land_distance.is_finite() {
        lines.push(format!(
            "Least distance from land {} m, at {} s",
            tenths(evaluation.min_land_distance),
            tenths(evaluation.min_land_distance_time)
        ));
    }
    if !checked.targets.is_empty() {
        lines.push(String::new());
        lines.push(margins(checked, display));
    }
    lines.join("\n")
}

fn margins(checked: &Verification, display: Display) -> String {
    let passages = checked.evaluation.as_ref().map_or(&[][..], |e| &e.passages);
    let rows = checked
        .targets
        .iter()
        .zip(passages)
        .map(|(target, passage)| {
            // a NaN is shown
            let claimed = passage.min_margin != f64::INFINITY;
            let margin = or_dash(claimed.then(|| thousandths(passage.min_margin)));
            vec![
                plain(printable(target)),
                if passage.min_margin >= -crate::tolerance::DEPTH_M {
                    margin
                } else {
                    (margin.0, Tone::Bad)
                },
                or_dash(claimed.then(|| tenths(passage.min_margin_time))),
                plain(tenths(passage.min_clearance)),
                plain(tenths(passage.dcpa)),
                plain(tenths(passage.tcpa)),
            ]
        });
    let header = "target, margin\n[m], at\n[s], clearance\n[m], dCPA\n[m], tCPA\n[s]";
    let table = Grid::new(header, 1..6, rows).text(display);
    format!(
        "{table}\nmargin: own position to the set that the plan avoids\n{CLEARANCE}\n\
         dCPA: as expected, own hull to hull, or own position to an explicit set"
    )
}

/// Formats three decimals; values that round to zero have no sign.
fn thousandths(value: f64) -> String {
    short_numbers(&format!("{:.3}", (value * 1000.0).round() / 1000.0 + 0.0))
}
