//! The plan document in named lines: the one wording of a plan for a terminal, a page and a
//! recording.

use std::collections::BTreeSet;

use searoom_document::{
    ConductDocument, ControlDocument, CostDocument, EncounterDocument, EscapeDocument,
    ImprovementDocument, ManoeuvreDocument, MemoryDocument, MonitorDocument, PlanDocument,
    PlanMethod, RelaxationDocument, RelaxationKind, SearchStatsDocument, TimingDocument, breaks,
    conduct_breaks,
};

use super::encounter::{MONITORS, breaks_in_words, has_role, rules_in_words};
use super::plan::legs::planned_legs;
use super::plan::stay::{Stay, stay};
use crate::colregs::compliance::{Measure, MonitorVerdict};
use crate::colregs::{Role, Thresholds};
use crate::evaluation::{facts, skipped_waypoints};
use crate::frame::{Side, deg_from_radians};
use crate::input::Remarks;
use crate::scenario::Compliance;
use crate::text::{
    Times, counted, knots, printable, rounded, signed, significant, square_metres, tenths, to_side,
};
use crate::tolerance;

const LISTED: usize = 3;

/// Scores from here on round to 1.
const FULL_SCORE: f64 = 0.995;
pub(crate) const TIME_LINE: &str = "time";

/// The assumption of every claim, and how often it held: docs/reference/measured.md.
const ASSUMED: &str = "each target's mean velocity stays in V, which is assumed: sets of ±0.97 kn \
                       and ±5° held ships of US AIS after 1, 5 and 10 min in 83, 57 and 45 % of \
                       cases (docs/guide/guarantees.md). Near land safety comes from planning \
                       again";

type Add<'a> = dyn FnMut(&'static str, String) + 'a;

/// Title and [`verdict_line`].
pub(crate) fn headline(plan: &PlanDocument) -> String {
    format!("{}: {}", printable(&plan.scenario), verdict_line(plan))
}

/// Outcome, whether the plan is verified and safe, the input on safety that it ignores, the rules
/// that it breaks, and the waypoints that it skips.
pub(crate) fn verdict_line(plan: &PlanDocument) -> String {
    in_brackets(&printable(&plan.verdict), &verdict_parts(plan))
}

/// What may happen after the end of a plan, which claims nothing then.
pub(crate) fn warnings(plan: &PlanDocument) -> Vec<String> {
    let cost = plan.cost.as_ref();
    let is_met = cost.filter(|cost| cost.hold_clearance_m.is_some_and(|after| after < 0.0));
    let warning = is_met.map(|cost| {
        let end = match cost.delay_s.is_some() {
            true => "arrival",
            false => "the end",
        };
        format!("a target may run into own ship where it lies after {end}")
    });
    warning.into_iter().collect()
}

/// The parts that [`verdict_line`] puts in brackets behind the outcome.
pub(crate) fn verdict_parts(plan: &PlanDocument) -> Vec<String> {
    let mut all = Vec::new();
    if plan.trajectory.is_some() {
        all.push(facts(plan.verified, plan.is_safe()).to_owned());
    }
    all.extend(ignored(&plan.cautions));
    all.extend(breaks(&plan.encounters).and_then(breaks_in_words));
    let skipped = plan.cost.as_ref().map(|cost| skipped(plan, cost));
    if let Some(skipped) = skipped.filter(|skipped| !skipped.is_empty()) {
        all.push(format!("skips {skipped}"));
    }
    all.extend(
        met_at_rest(plan).map(|(name, time)| format!("met at rest by '{name}' at {time:.0} s")),
    );
    all.iter().map(|part| printable(part)).collect()
}

/// The target that is the first to meet own ship where it lies after its plan, and when.
fn met_at_rest(plan: &PlanDocument) -> Option<(&str, f64)> {
    let met = plan.encounters.iter();
    let met = met.filter_map(|e| Some((e.target.as_str(), e.met_at_rest_s?)));
    met.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The subjects of the cautions in brief; `None` without one.
fn ignored(cautions: &[String]) -> Option<String> {
    let subjects = Remarks::ignored(cautions);
    let more = match subjects.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let listed: Vec<&str> = subjects.into_iter().take(LISTED).collect();
    (!listed.is_empty()).then(|| format!("ignores {}{more}", listed.join(", ")))
}

/// A word with further parts in brackets.
pub(crate) fn in_brackets(word: &str, parts: &[String]) -> String {
    match parts.is_empty() {
        true => word.to_owned(),
        false => format!("{word} ({})", parts.join("; ")),
    }
}

fn skipped(plan: &PlanDocument, cost: &CostDocument) -> String {
    skipped_waypoints(&cost.waypoint_distances_m, plan.own_ship.turning_radius_m)
}

/// Named lines of a plan. A line without a name continues the previous one.
pub(crate) fn plan_lines(plan: &PlanDocument, times: Times) -> Vec<(&'static str, String)> {
    let mut lines: Vec<(&'static str, String)> = Vec::new();
    let mut add = |name: &'static str, value: String| lines.push((name, printable(&value)));
    add("planner", planner_words(plan));
    if let Some(all) = plan.land_outer_of {
        let pieces = plan.land.len();
        let text = format!("{pieces} pieces around {all} of the map: an outer approximation");
        add("land", text);
    }
    if let Some(reason) = &plan.reason {
        add("reason", reason.clone());
    }
    for caution in &plan.cautions {
        add("ignores", caution.clone());
    }
    for relaxation in &plan.relaxations {
        let (name, text) = relaxed(plan, relaxation, times);
        add(name, text);
    }
    if let Some(memory) = &plan.memory {
        memory_lines(plan, memory, &mut add);
    }
    if let Some(escape) = &plan.escape {
        add("stands on", stand_on(escape, times));
    }
    target_lines(plan, times, &mut add);
    if let Some(cost) = &plan.cost {
        cost_lines(plan, cost, times, &mut add);
    }
    for violation in &plan.violations {
        let time = times.at(violation.t_s.unwrap_or(f64::NAN), 1);
        add("violation", format!("{} (at {time})", violation.what));
    }
    let assumes = !plan.obstacles.is_empty() || plan.out_of_reach.is_some();
    if plan.trajectory.is_some() && assumes {
        add("assumes", ASSUMED.to_owned());
    }
    if let Some(control) = &plan.optimal_control {
        control_lines(plan, control, &mut add);
    } else {
        add("search", search_words(&plan.search_stats));
    }
    add(TIME_LINE, time_words(&plan.timing));
    lines
}

/// The planner, and what made the plan; without a plan, what was searched.
fn planner_words(plan: &PlanDocument) -> String {
    let SearchStatsDocument {
        expanded,
        heuristic_weight,
        ..
    } = plan.search_stats;
    let is_searched = expanded.is_some() && plan.trajectory.is_none() && plan.path_time.is_none();
    let searched = is_searched.then(|| plan.search.label());
    // the planner says the rest
    let made = plan.method.filter(|m| *m != PlanMethod::OptimalControl);
    let made = made.map(PlanMethod::label).or(searched);
    let weight = heuristic_weight.filter(|weight| *weight > 1.0);
    let parts = [
        Some(plan.planner.clone()),
        made.map(str::to_owned),
        weight.map(|weight| format!("bounds × {weight}")),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    parts.join(", ")
}

/// The search for the plan.
fn search_words(stats: &SearchStatsDocument) -> String {
    let SearchStatsDocument {
        expanded: Some(expanded),
        generated: Some(generated),
        edges_checked: Some(checked),
        ..
    } = stats
    else {
        return "none".to_owned();
    };
    format!("{expanded} expanded, {generated} generated, {checked} edges checked")
}

/// The planning time, and when a thorough search found cheaper answers.
fn time_words(timing: &TimingDocument) -> String {
    let whole = format!("{:.2} ms", 1e3 * timing.plan_s);
    let step = |step: &ImprovementDocument| {
        let cost = square_metres(step.cost_m2);
        format!("{cost} m² after {:.0} ms", 1e3 * step.after_s)
    };
    let steps: Vec<String> = timing.improvements.iter().map(step).collect();
    match steps.len() {
        0 | 1 => whole,
        _ => format!("{whole}; J {}", steps.join(", ")),
    }
}

/// Manoeuvres that the plan continues, and the targets that did not stay in their sets.
fn memory_lines(plan: &PlanDocument, memory: &MemoryDocument, add: &mut Add) {
    let begun = plan.manoeuvres.iter().find(|m| m.begins_s < 0.0);
    let begun = begun.map(|m| {
        let phase = plan.phases.first().map(|now| now.phase.word());
        let phase = phase.map_or(String::new(), |word| format!(", in the phase '{word}'"));
        format!("the manoeuvre that began {:.0} s ago{phase}", -m.begins_s)
    });
    let kept = memory
        .keeps_plan
        .then(|| "the previous plan, unchanged".to_owned());
    let goes_on: Vec<String> = kept.into_iter().chain(begun).collect();
    if !goes_on.is_empty() {
        add("goes on", goes_on.join("; "));
    }
    if memory.off_plan_m > 0.0 {
        let most = plan.own_ship.tracking_margin_m;
        let off = tenths(memory.off_plan_m);
        let text = match memory.off_plan_m <= most {
            true => format!("{off} m off the plan; its tracking margin is {most} m"),
            false => format!(
                "{off} m from the previous plan, more than its tracking margin of {most} m: the \
                 rest of that plan is not used"
            ),
        };
        add("own ship", text);
    }
    for name in &memory.outside_velocities {
        let left =
            format!("'{name}' left the velocities that the previous plan assumed; a new set");
        add("assumption", left);
    }
    for name in &memory.outside_places {
        let left = format!("'{name}' is where it could not be; it counts as another ship");
        add("assumption", left);
    }
    for name in &memory.missing {
        let left =
            format!("'{name}' of the previous plan is not in this file; its role is forgotten");
        add("assumption", left);
    }
}

fn relaxed(
    plan: &PlanDocument,
    relaxation: &RelaxationDocument,
    times: Times,
) -> (&'static str, String) {
    let RelaxationDocument { target, amount, .. } = relaxation;
    let text = match relaxation.kind {
        RelaxationKind::Domain => format!(
            "the domain of '{target}', which is reduced by {} m",
            tenths(*amount)
        ),
        RelaxationKind::Risk => {
            let ends = plan.cost.as_ref().map_or(f64::INFINITY, |c| c.duration_s);
            let until = relaxation.until_s.map_or(String::new(), |time| {
                if time >= ends {
                    return "; nothing is claimed of it".to_owned();
                }
                let time = times.at(time, 1);
                format!("; the plan is clear of it only from {time} on")
            });
            let text = format!("the set of '{target}', at a risk of up to {amount:.3}{until}");
            return ("enters", text);
        }
        RelaxationKind::Arrival => {
            let left = significant(*amount);
            format!(
                "the arrival: {left} m are left at the end of the plan because '{target}' is in the way"
            )
        }
        RelaxationKind::Compliance => {
            let role = plan.encounters.iter().find(|e| e.target == *target);
            let role = role.map_or("unknown", |e| e.role.word());
            format!(
                "the rules: no plan was found that complies with them toward '{target}' (own ship: {role})"
            )
        }
    };
    ("relaxes", text)
}

/// Time until which own ship holds course and speed, and the subsequent manoeuvre.
fn stand_on(escape: &EscapeDocument, times: Times) -> String {
    let (until, escape_words) = (times.at(escape.held_until_s, 1), escape_words(escape));
    format!("course and speed are held until {until}, then there is a clear escape: {escape_words}")
}

/// The manoeuvre with which own ship escapes.
pub(crate) fn escape_words(escape: &EscapeDocument) -> String {
    let speed = knots(escape.speed_mps);
    match escape.turn_deg {
        0.0 => speed,
        turn => format!("{} at {speed}", to_side(turn)),
    }
}

/// A block per target: own ship's role, the closest approach, the manoeuvre, and what the judges
/// say of the plan. Targets without a role follow in one line each, the nearest first.
fn target_lines(plan: &PlanDocument, times: Times, add: &mut Add) {
    if plan.encounters.is_empty() && plan.out_of_reach.is_none() {
        add("target", "none".to_owned());
    }
    let altered = altered_for(plan);
    let matters = |e: &EncounterDocument| {
        let judged = (e.conduct.as_ref())
            .is_some_and(|c| !c.roles.is_empty() || !conduct_breaks(c).is_empty());
        e.role != Role::None || judged || altered.contains(&e.target)
    };
    let by = |key: fn(&EncounterDocument) -> Option<f64>| {
        let key = move |e: &EncounterDocument| key(e).unwrap_or(f64::INFINITY);
        move |a: &&EncounterDocument, b: &&EncounterDocument| key(a).total_cmp(&key(b))
    };
    let (mut met, mut others): (Vec<_>, Vec<_>) = plan.encounters.iter().partition(|e| matters(e));
    met.sort_by(by(|e| e.undisturbed_tcpa_s));
    others.sort_by(by(|e| e.dcpa_m.or(e.undisturbed_dcpa_m)));
    for encounter in met {
        let target = &encounter.target;
        add("target", format!("'{target}': {}", roles(encounter, times)));
        let apart = apart(plan, encounter, true, times);
        if !apart.is_empty() {
            add("", apart);
        }
        if let Some(conduct) = &encounter.conduct {
            conduct_lines(plan, conduct, times, add);
        }
        if let Some(note) = risk_note(plan, encounter, &altered) {
            add("", note);
        }
    }
    let more = others.len().saturating_sub(LISTED);
    for encounter in others.into_iter().take(LISTED) {
        let text = [
            format!("'{}': no role", encounter.target),
            apart(plan, encounter, false, times),
        ];
        let text: Vec<String> = text.into_iter().filter(|part| !part.is_empty()).collect();
        add("target", text.join("; "));
    }
    if more > 0 {
        add(
            "",
            format!("and {more} more without a role, none of them nearer"),
        );
    }
    if let Some(listed) = &plan.out_of_reach {
        let targets = counted(listed.rows.len(), "target");
        let until = times.at(listed.until_s.floor(), 0);
        // rounded down, because none comes nearer
        let apart = listed.apart_m.floor();
        let reason = format!(
            "up to its assumed greatest speed none comes within {apart:.0} m of own hull and its \
             margin until {until}"
        );
        add(
            "target",
            format!("{targets} out of reach, not planned for: {reason}; no role, no risk"),
        );
    }
}

/// Why own ship has a role toward a ship that passes beyond the limits, or has none toward a target
/// that it alters for.
fn risk_note(
    plan: &PlanDocument,
    encounter: &EncounterDocument,
    altered: &BTreeSet<String>,
) -> Option<String> {
    let mut targets = plan.targets.iter();
    let target = targets.find(|target| target.name == encounter.target)?;
    match &target.ship {
        Some(ship) if ship.cpa_limit_m > 0.0 => {
            let limit = ship.cpa_limit_m;
            let text = "passes beyond the limits, but own ship alters for its set: so there is risk \
                        of collision, Rule 7(a), up to";
            Some(format!("{text} {limit:.0} m of the centres"))
        }
        _ if plan.compliance != Compliance::Rules
            || encounter.role != Role::None
            || !altered.contains(&encounter.target) =>
        {
            None
        }
        ship => {
            let why = match ship {
                Some(_) => "it does not come nearer on the desired trajectory",
                None => "it is given as a set",
            };
            let text = "gives no role: the rules do not restrict the alteration for it";
            Some(format!("{text}, as {why}"))
        }
    }
}

/// Own ship's role on the desired trajectory, and its roles along the plan where these differ.
fn roles(encounter: &EncounterDocument, times: Times) -> String {
    let role = match encounter.role {
        Role::None => "no role".to_owned(),
        Role::Static => "at rest, so without a role".to_owned(),
        // as a bare word it would read as the duty of the target
        role => format!("own ship is {role}"),
    };
    let Some(conduct) = &encounter.conduct else {
        return role;
    };
    let along = conduct.roles.iter();
    let along = along.map(|r| {
        let from = times.figure(r.from_s, 0);
        format!("{} from {from} to {}", r.role, times.at(r.until_s, 0))
    });
    let along = format!("own ship is {}", along.collect::<Vec<_>>().join(", "));
    let first = conduct.roles.first().map(|role| role.role);
    match first {
        Some(first) if first == encounter.role => along,
        Some(_) => format!("{role} on the desired trajectory; on the plan {along}"),
        None if !has_role(encounter.role) => role,
        None => format!("{role} on the desired trajectory, no role on the plan"),
    }
}

/// The closest approach of the plan, and with `desired` that of the desired trajectory, for the
/// expected motion of the target.
fn apart(
    plan: &PlanDocument,
    encounter: &EncounterDocument,
    desired: bool,
    times: Times,
) -> String {
    let is_set = is_set(plan, &encounter.target);
    let mut parts = Vec::new();
    if let (Some(distance), Some(time)) = (encounter.dcpa_m, encounter.tcpa_s) {
        let side = match (&encounter.passing_side, encounter.crosses_astern) {
            (None, _) => String::new(),
            (Some(side), None) => format!(", to {side}"),
            (Some(side), Some(true)) => format!(", to {side}, own ship crosses astern"),
            (Some(side), Some(false)) => format!(", to {side}, own ship crosses ahead"),
        };
        let (distance, time) = (distance_words(distance, is_set), times.at(time, 0));
        parts.push(format!("closest: {distance} at {time}{side}"));
    }
    let undisturbed = encounter
        .undisturbed_dcpa_m
        .zip(encounter.undisturbed_tcpa_s);
    if let Some((distance, time)) = undisturbed.filter(|_| desired || parts.is_empty()) {
        let (distance, time) = (distance_words(distance, is_set), times.at(time, 0));
        parts.push(format!("on the desired trajectory {distance} at {time}"));
    }
    parts.join("; ")
}

/// Ends of a distance: own hull to a target's hull, or own position to a set, which has
/// no hull.
pub(super) fn distance_words(metres: f64, is_set: bool) -> String {
    match (contact(metres), is_set) {
        (Contact::Overlap(None), true) => "in its set".to_owned(),
        (Contact::Overlap(Some(depth)), true) => format!("{} m deep in its set", tenths(depth)),
        (Contact::Overlap(depth), false) => format!("the hulls overlap{}", by(depth)),
        (Contact::Touch, true) => "touches its set".to_owned(),
        (Contact::Touch, false) => "the hulls touch".to_owned(),
        (Contact::Apart, true) => format!("{} m to its set", tenths(metres)),
        (Contact::Apart, false) => format!("{} m hull to hull", tenths(metres)),
    }
}

/// How two bodies lie to each other, with the depth of an overlap where it is known.
enum Contact {
    Apart,
    Touch,
    Overlap(Option<f64>),
}

/// Planned motions may touch to rounding. A NaN counts as an overlap.
fn contact(metres: f64) -> Contact {
    if metres > tolerance::TOUCH_M {
        Contact::Apart
    } else if metres >= -tolerance::TOUCH_M {
        Contact::Touch
    } else {
        Contact::Overlap((!metres.is_nan()).then_some(-metres))
    }
}

/// The depth of an overlap, behind what overlaps.
fn by(depth: Option<f64>) -> String {
    depth.map_or(String::new(), |depth| format!(" by {} m", tenths(depth)))
}

/// True for a target that is given by its sets, without a hull.
pub(super) fn is_set(plan: &PlanDocument, name: &str) -> bool {
    let mut targets = plan.targets.iter();
    targets.any(|target| target.name == name && target.ship.is_none())
}

/// The manoeuvre, the rules that own ship breaks toward a target, and its scores.
fn conduct_lines(plan: &PlanDocument, conduct: &ConductDocument, times: Times, add: &mut Add) {
    if let Some(manoeuvre) = &conduct.manoeuvre {
        add("", manoeuvre_text(manoeuvre, times));
    }
    for violation in &conduct.violations {
        let (rule, what) = (&violation.rule, &violation.what);
        let time = times.at(violation.t_s, 0);
        add("", format!("breaks {rule} at {time}: {what}"));
    }
    for monitor in conduct
        .monitors
        .iter()
        .filter(|m| m.verdict == MonitorVerdict::Violated)
    {
        add("", monitor_text(plan, monitor, times));
    }
    // without a role nobody asks for the scores
    let scores = conduct.scores.iter();
    let scores = scores.filter(|(_, score)| !conduct.roles.is_empty() && **score < FULL_SCORE);
    let scores: Vec<String> = scores
        .map(|(name, score)| format!("{} {score:.2} of 1", name.replace('_', " ")))
        .collect();
    let unbroken = !conduct.roles.is_empty() && conduct_breaks(conduct).is_empty();
    let said = [
        unbroken.then(|| "breaks no rule".to_owned()),
        (!scores.is_empty()).then(|| format!("scores: {}", scores.join(", "))),
    ];
    let said: Vec<String> = said.into_iter().flatten().collect();
    if !said.is_empty() {
        add("", said.join("; "));
    }
}

/// The targets for which the plan alters course or speed.
fn altered_for(plan: &PlanDocument) -> BTreeSet<String> {
    let legs = planned_legs(plan).into_iter();
    legs.filter_map(|leg| leg.because_of).collect()
}

/// How own ship violated a monitor, when, and by how much. The limits are named if the profile
/// is a published one.
fn monitor_text(plan: &PlanDocument, monitor: &MonitorDocument, times: Times) -> String {
    let published = Thresholds::named(&plan.thresholds);
    let degrees = |limit: fn(&Thresholds) -> f64| {
        published.map(|t| format!("{:.0}°", deg_from_radians(limit(t))))
    };
    let turn = degrees(|t| t.monitor.turn).unwrap_or("far enough".to_owned());
    let hold = degrees(|t| t.score.hold).map_or(String::new(), |hold| format!(" within {hold}"));
    let time = published.map_or("in time".to_owned(), |t| {
        let factor = t.time_factor(plan.own_ship.length_m);
        format!("within {:.0} s", factor * t.monitor.response())
    });
    let number = monitor.monitor.word();
    let what = match MONITORS
        .iter()
        .find(|known| known.monitor == monitor.monitor)
    {
        Some(known) => (known.violated)
            .replace("TURN", &turn)
            .replace("HOLD", &hold)
            .replace("TIME", &format!("{time} and before the target was past")),
        None => format!("violated {number}"),
    };
    // avoids a negative zero; a violation is more than nothing, so that none reads 0
    let short = 0.0 - monitor.robustness.unwrap_or(f64::NAN);
    let short = match monitor.unit {
        _ if short == 0.0 => String::new(),
        Measure::Distance if short < 1.0 => format!(", missed by {} m", tenths(short.max(5e-5))),
        Measure::Distance => format!(", missed by {:.1} m", 0.1 * (10.0 * short).ceil()),
        Measure::Angle => format!(", missed by {:.0}°", short.ceil()),
        Measure::Time => format!(", missed by {:.0} s", short.ceil()),
    };
    let time = times.at(monitor.t_s.unwrap_or(f64::NAN), 0);
    let name = rules_in_words([number]);
    format!("breaks {name} at {time}: {what}{short}")
}

/// The manoeuvre as a navigator looks at it.
fn manoeuvre_text(manoeuvre: &ManoeuvreDocument, times: Times) -> String {
    if manoeuvre.lead_s.is_none() && manoeuvre.turns + manoeuvre.speed_changes == 0 {
        return "no alteration for it".to_owned();
    }
    let first = match manoeuvre.lead_s {
        None => "no alteration".to_owned(),
        Some(lead) => {
            let when = if lead.round() < 0.0 {
                "after"
            } else {
                "before"
            };
            let lead = times.at(lead.round().abs(), 0);
            format!("first alteration {lead} {when} the closest approach on the course before it")
        }
    };
    let turns = counted(manoeuvre.turns, "turn");
    let speeds = match manoeuvre.speed_changes {
        1 => "1 change of speed".to_owned(),
        count => format!("{count} changes of speed"),
    };
    let parts = [(manoeuvre.turns, turns), (manoeuvre.speed_changes, speeds)];
    let parts = parts.into_iter().filter(|(count, _)| *count > 0);
    let parts: Vec<String> = parts.map(|(_, part)| part).collect();
    match parts.is_empty() {
        true => first,
        false => format!("{first}: {}", parts.join(", ")),
    }
}

fn cost_lines(plan: &PlanDocument, cost: &CostDocument, times: Times, add: &mut Add) {
    let none = || "none".to_owned();
    let departure = plan
        .departure_of_motion()
        .map(|departure| departure.words(times));
    add("manoeuvre", departure.unwrap_or_else(none));
    let error = square_metres(cost.space_time_error_m2);
    let stay = stay(plan);
    let begins = stay.as_ref().is_some_and(Stay::begins);
    match cost.space_time_error_arc_length_m2 {
        _ if begins => add("J", format!("{error} m² until the stay begins")),
        // a motion of no length has none
        None => add("J", format!("{error} m²")),
        Some(by_length) => {
            let by_length = square_metres(by_length);
            add("J", format!("{error} m² ({by_length} m² by arc length)"));
        }
    }
    if let Some(stay) = stay {
        add("stay", stay.words(times));
    }
    let (lasts, length) = (times.at(cost.duration_s, 1), significant(cost.length_m));
    let way = format!("{lasts} and {length} m");
    match cost.delay_s {
        Some(delay) => {
            let delay = signed(delay);
            let arrives = match plan.mission.stay_until_s {
                Some(_) => "ends",
                None => "arrives",
            };
            add("delay", format!("{delay} s ({arrives} after {way})"));
        }
        None if plan.optimal_control.is_some() => {
            add("horizon", format!("{way}; no arrival is asked for"));
            let until = times.at(cost.space_time_error_until_s, 1);
            add("", format!("J is counted until {until}"));
        }
        None => {
            add("delay", format!("does not arrive (ends after {way})"));
            let until = times.at(cost.space_time_error_until_s, 1);
            add("", format!("J is counted until {until}"));
        }
    }
    let skipped = skipped(plan, cost);
    if !skipped.is_empty() {
        add("skips", skipped);
    }
    if let Some(clearance) = cost.min_clearance_m {
        let end = if cost.delay_s.is_some() {
            "arrival"
        } else {
            "the end"
        };
        let sets = plan.targets.iter().filter(|t| t.ship.is_none()).count();
        let to = match sets {
            0 => "any hull that a target may have",
            _ if sets == plan.targets.len() => "the hard sets",
            _ => "the hard sets and any hull that a target may have",
        };
        let clearance = match contact(clearance) {
            Contact::Overlap(depth) => format!("overlaps {to}{}", by(depth)),
            Contact::Touch => format!("touches {to}"),
            Contact::Apart => format!("{} m to {to}", tenths(clearance)),
        };
        let after = cost.hold_clearance_m.map_or("–".to_owned(), tenths);
        let hold = cost.arrival_hold_s;
        let text = format!("{clearance}; after {end} {after} m within {hold} s");
        add("clearance", text);
        for warning in warnings(plan) {
            add("warning", warning);
        }
    }
    if let Some((name, time)) = met_at_rest(plan) {
        let time = times.at(time, 0);
        let text = format!(
            "'{name}' runs into own ship where it lies, at {time}, if neither moves off: nothing is \
             claimed after the end of a plan"
        );
        add("warning", text);
    }
    if let Some(distance) = cost.min_land_distance_m {
        add("land", format!("{} m off", tenths(distance)));
    }
    if !plan.encounters.is_empty() {
        add("risk", risk(plan, cost.max_risk, times));
    }
}

/// Largest risk, with its targets and time.
fn risk(plan: &PlanDocument, largest: f64, times: Times) -> String {
    let mut text = format!("{largest:.3} at most");
    if plan.max_risk > 0.0 {
        text += &format!(" ({} accepted)", rounded(plan.max_risk));
    }
    for encounter in &plan.encounters {
        if let (Some(risk), Some(time)) = (encounter.max_risk, encounter.max_risk_t_s) {
            let name = &encounter.target;
            let time = times.at(time, 0);
            text += &format!(", {risk:.3} with '{name}' at {time}");
        }
    }
    text
}

fn control_lines(plan: &PlanDocument, control: &ControlDocument, add: &mut Add) {
    if !control.enclosed_targets.is_empty() {
        let names = control.enclosed_targets.join("', '");
        let text = format!("'{names}' enclosed in the smallest ellipses");
        add("sets", text);
    }
    let [first, last] = [control.start_intervals, control.intervals];
    if let Some(cost) = &plan.cost {
        add("stage cost", stage_cost(cost.objective));
        let coarse = match first {
            _ if first == last => String::new(),
            _ => format!(", {first} were too coarse"),
        };
        let defect = control.defect.unwrap_or(f64::NAN);
        let text = format!(
            "{last} intervals{coarse}; at their ends the ship is within {defect:.1e} of its units"
        );
        add("grid", text);
    }
    if control.starts.is_empty() {
        return;
    }
    let feasible = control.starts.iter().filter(|s| s.feasible).count();
    let steps: usize = control.starts.iter().map(|s| s.iterations).sum();
    let all = control.starts.len();
    let text = format!(
        "on {first} intervals: {feasible} of {all} led to a plan, in {steps} solver iterations"
    );
    add("starts", text);
    let mut names: Vec<&str> = plan.obstacles.iter().map(|o| o.name.as_str()).collect();
    names.dedup();
    let ways = control.homotopy_classes.len();
    if ways > 0 && !names.is_empty() {
        let more = if ways > LISTED { ", the cheapest" } else { "" };
        let names = names.join("', '");
        add(
            "ways to pass",
            format!("'{names}': {ways} on {first} intervals{more}"),
        );
        for class in control.homotopy_classes.iter().take(LISTED) {
            let sides = class.sides.iter();
            let sides: Vec<&str> = sides.map(|s| s.map_or("far", Side::word)).collect();
            let cost = stage_cost(class.objective);
            add("", format!("{cost}: {}", sides.join(", ")));
        }
    }
}

/// Formats four decimals if they are significant.
fn stage_cost(value: f64) -> String {
    if value == 0.0 || (1e-2..1e6).contains(&value.abs()) {
        format!("{value:.4}")
    } else {
        format!("{value:.4e}")
    }
}

/// Targets toward which own ship has a role, in order of nominal closest approach.
pub(crate) fn met(encounters: &[EncounterDocument]) -> Vec<&EncounterDocument> {
    let mut met: Vec<_> = encounters.iter().filter(|e| e.role != Role::None).collect();
    let time = |e: &EncounterDocument| e.undisturbed_tcpa_s.unwrap_or(f64::INFINITY);
    met.sort_by(|a, b| time(a).total_cmp(&time(b)));
    met
}

/// Side of own ship on which the target lies at the closest approach. In a crossing, it also states
/// whether own ship crosses ahead or astern.
pub(crate) fn passing(encounter: &EncounterDocument) -> String {
    match (&encounter.passing_side, encounter.crosses_astern) {
        (None, _) => "–".to_owned(),
        (Some(side), Some(true)) => format!("{side}, astern"),
        (Some(side), Some(false)) => format!("{side}, ahead"),
        (Some(side), None) => side.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colregs::compliance::Monitor;
    use crate::pipeline;
    use crate::scenario::Scenario;

    #[test]
    fn an_alteration_after_the_closest_approach_says_so() {
        let text = |lead| {
            let manoeuvre = ManoeuvreDocument {
                lead_s: Some(lead),
                turns: 1,
                smallest_turn_deg: None,
                speed_changes: 0,
            };
            manoeuvre_text(&manoeuvre, Times::Seconds)
        };
        let begins = ["after 308 s", "before 308 s", "before 0 s"].map(|words| {
            let (side, time) = words.split_once(' ').expect("two words");
            format!("first alteration {time} {side} the closest approach")
        });
        for (lead, begin) in [-308.2, 308.2, -0.2].into_iter().zip(begins) {
            assert!(text(lead).starts_with(&begin), "{}", text(lead));
        }
    }

    #[test]
    fn monitors_are_told_in_words() {
        let text = include_str!("../../scenarios/colregs/give-way.toml");
        let run = pipeline::run(Scenario::parse(text).expect("valid"));
        let mut plan = PlanDocument::of(&run);
        let mut said = |monitor: Monitor, unit: Measure, large: bool, profile: &str| {
            plan.own_ship.length_m = if large { 150.0 } else { 30.0 };
            plan.thresholds = profile.to_owned();
            let monitor = MonitorDocument {
                monitor,
                verdict: MonitorVerdict::Violated,
                robustness: Some(-11.2),
                unit,
                t_s: Some(40.4),
            };
            monitor_text(&plan, &monitor, Times::Seconds)
        };
        let name = &Thresholds::standard().name;
        let late = format!(
            "within {:.0} s and before the target was past",
            Thresholds::standard().time_factor(150.0) * 200.0
        );
        assert_eq!(
            said(Monitor::HeadOn, Measure::Angle, false, name),
            "breaks head-on (R4) at 40 s: did not turn 20° to starboard within 200 s and before the target \
             was past, missed by 12°"
        );
        assert!(said(Monitor::Crossing, Measure::Angle, true, name).contains(&late));
        assert_eq!(
            said(Monitor::StandOn, Measure::Angle, false, name),
            "breaks stand-on (R6) at 40 s: did not hold its course within 10°, missed by 12°"
        );
        assert_eq!(
            said(Monitor::Contact, Measure::Distance, false, "mine"),
            "breaks contact (S) at 40 s: did not keep the hulls apart, missed by 11.2 m"
        );
        // a profile of a file has limits of its own
        assert!(said(Monitor::Overtaking, Measure::Angle, false, "mine").starts_with(
            "breaks overtaking (R5) at 40 s: did not turn far enough or halve its speed in time and before"
        ));
    }

    /// A plan may touch to rounding, and what is no number is never apart.
    #[test]
    fn a_distance_is_apart_a_touch_or_an_overlap() {
        for (metres, hulls, set) in [
            (1.5, "1.5 m hull to hull", "1.5 m to its set"),
            (1e-9, "the hulls touch", "touches its set"),
            (-0.0, "the hulls touch", "touches its set"),
            (-1e-9, "the hulls touch", "touches its set"),
            (-1.5, "the hulls overlap by 1.5 m", "1.5 m deep in its set"),
            (f64::NAN, "the hulls overlap", "in its set"),
        ] {
            let words = [false, true].map(|is_set| distance_words(metres, is_set));
            assert_eq!(words, [hulls, set], "{metres}");
        }
        let text = include_str!("../../scenarios/colregs/give-way.toml");
        let mut plan = PlanDocument::of(&pipeline::run(Scenario::parse(text).expect("valid")));
        for (metres, begins) in [
            (-0.0, "touches any hull"),
            (-1e-9, "touches any hull"),
            (-1.5, "overlaps any hull that a target may have by 1.5 m;"),
            (f64::NAN, "overlaps any hull that a target may have;"),
        ] {
            plan.cost.as_mut().expect("a plan").min_clearance_m = Some(metres);
            let lines = plan_lines(&plan, Times::Seconds);
            let line = lines.iter().find(|(name, _)| *name == "clearance");
            assert!(line.expect("a line").1.starts_with(begins), "{line:?}");
        }
    }

    #[test]
    fn only_scores_below_one_are_told() {
        let text = include_str!("../../scenarios/colregs/stand-on.toml");
        let run = pipeline::run(Scenario::parse(text).expect("valid"));
        let mut plan = PlanDocument::of(&run);
        let scores = |plan: &PlanDocument| {
            let mut lines = plan_lines(plan, Times::Seconds).into_iter();
            lines.find_map(|(_, line)| Some(line.split_once("scores: ")?.1.to_owned()))
        };
        let conduct = |plan: &mut PlanDocument, score| {
            let conduct = plan.encounters[0].conduct.as_mut().expect("a ship");
            conduct.scores = [("rule_17", score), ("safety", 0.996)]
                .map(|(name, score)| (name.to_owned(), score))
                .into();
        };
        conduct(&mut plan, 0.331);
        assert_eq!(scores(&plan).as_deref(), Some("rule 17 0.33 of 1"));
        conduct(&mut plan, 1.0);
        assert_eq!(scores(&plan), None);
    }
}
