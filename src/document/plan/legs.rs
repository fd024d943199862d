//! The legs of a plan as a navigator reads them: turns and straight runs, and the events on each.

use searoom_document::{EncounterDocument, PlanDocument, PlannedLeg, STILL_MPS, is_same_motion};

use super::reasons::{Before, follows_mission, lesser_turns, reason, waited_for};
use crate::colregs::Role;
use crate::document::lines::{distance_words, is_set, passing};
use crate::frame::{heading_from_course_deg, heading_of, wrap};
use crate::obstacle::LAND;
use crate::tolerance;
use crate::trajectory::Segment;

/// Seconds and radians. A shorter and smaller turn is part of the leg after it, as no chart shows it.
const SLIVER_S: f64 = 2.0;
const SLIVER_RAD: f64 = 0.035;

/// Radians. Straight runs whose courses differ by less are one leg.
const SAME_COURSE_RAD: f64 = 1e-3;

/// Event of a leg: the manoeuvre is over.
const RETURNS: &str = "returns";

/// Event of a leg: a turn at a corner of the mission.
const FOLLOWS: &str = "follows the mission";

/// Begins the event of a closest approach.
pub(crate) const CLOSEST: &str = "closest to";

/// Length of the longest leg, metres.
pub(crate) fn longest(legs: &[PlannedLeg]) -> f64 {
    legs.iter()
        .map(|leg| leg.motion.length())
        .fold(0.0, f64::max)
}

/// The legs in order of time, with what happens on each. Empty without a plan, and for a plan
/// under forces.
///
/// A turn of less than 2 s and 0.035 rad is part of the leg after it, which begins where the
/// turn does. Runs on one course, to 0.001 rad, are one leg. So places are off by some
/// decimetres.
pub fn planned_legs(plan: &PlanDocument) -> Vec<PlannedLeg> {
    let mut legs: Vec<PlannedLeg> = Vec::new();
    let mut sliver: Option<Segment> = None;
    let all = plan.motions();
    let last = all.len().saturating_sub(1);
    for (index, mut leg) in all.into_iter().enumerate() {
        if let Some(turn) = sliver.take() {
            leg.motion.start.position = turn.start.position;
            leg.motion.start_time = turn.start_time;
            leg.motion.duration += turn.duration;
        }
        if index < last && is_sliver(&leg.motion) {
            sliver = Some(leg.motion);
            continue;
        }
        match legs
            .last_mut()
            .and_then(|last| one_line(&last.motion, &leg.motion).map(|line| (last, line)))
        {
            Some((last, line)) => last.motion = line,
            None => legs.push(leg),
        }
    }
    for (time, event) in events(plan) {
        let mut until = legs
            .iter_mut()
            .filter(|leg| time >= 0.0 && leg.motion.start_time <= time);
        // the plan ends with the last leg
        if let Some(leg) = until.next_back()
            && time <= leg.motion.end_time() + tolerance::TIME_S
        {
            leg.events.push(event);
        }
    }
    let mut before = Before {
        heading: heading_from_course_deg(plan.own_ship.course_deg),
        speed: plan.own_ship.speed_mps,
    };
    let (mut cause, mut told) = (None, None);
    for index in 0..legs.len() {
        let returns = plan.manoeuvres.iter().any(|m| {
            let time = legs[index].motion.start_time + tolerance::TIME_S;
            m.returns_s <= time && time < m.joins_s
        });
        let follows = follows_mission(plan, &before, &legs[index].motion);
        let reason = reason(plan, &before, &legs[index..]);
        let reason = reason.filter(|_| !returns && !follows).map(str::to_owned);
        let after = waited_for(plan, &legs, index).filter(|_| !follows);
        let after = after.map(str::to_owned);
        let known = index
            .checked_sub(1)
            .and_then(|last| legs[last].because_of.as_ref());
        let is_new = known != reason.as_ref();
        let leg = &mut legs[index];
        if let Some(target) = &reason {
            if is_new {
                let told = [
                    Some(alters_for(leg, &before, target)),
                    lesser_turns(plan, leg),
                ];
                leg.events.splice(0..0, told.into_iter().flatten());
            }
            (cause, told) = (Some(target.clone()), None);
        } else if let Some(event) = leg.events.iter_mut().find(|event| *event == RETURNS) {
            // by the rules a manoeuvre lasts until its target is past
            let is_past = |target: &String| {
                let mut encounters = plan.encounters.iter();
                let passed = |e: &EncounterDocument| e.tcpa_s <= Some(leg.motion.start_time);
                encounters.any(|e| e.target == *target && passed(e))
            };
            if let Some(target) = after.or_else(|| cause.take().filter(is_past)) {
                *event += &after_text(&target);
            }
        } else if after.is_some() && after != told {
            let after_text = after.as_deref().map(after_text).unwrap_or_default();
            leg.events
                .insert(0, format!("{}{after_text}", comes_back(leg, &before)));
            told = after;
        }
        let leg = &mut legs[index];
        if follows {
            leg.events.insert(0, FOLLOWS.to_owned());
        }
        leg.because_of = reason;
        before = Before {
            heading: leg.motion.end().heading,
            speed: leg.motion.speed,
        };
    }
    legs
}

/// Events of the plan, by time. A manoeuvre that is under way began before.
fn events(plan: &PlanDocument) -> Vec<(f64, String)> {
    let mut events = Vec::new();
    for manoeuvre in &plan.manoeuvres {
        let parts = [
            (manoeuvre.begins_s, "begins the manoeuvre"),
            (manoeuvre.returns_s, RETURNS),
            (manoeuvre.joins_s, "back on the mission"),
        ];
        events.extend(parts.map(|(time, what)| (time, what.to_owned())));
    }
    let has_role = |e: &&EncounterDocument| {
        e.role != Role::None || e.conduct.as_ref().is_some_and(|c| !c.roles.is_empty())
    };
    let met = plan.encounters.iter().filter(has_role);
    events.extend(met.filter_map(|e| closest_approach(e, is_set(plan, &e.target))));
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    events
}

/// Own ship's action, and the target that it is for.
fn alters_for(leg: &PlannedLeg, before: &Before, target: &str) -> String {
    let motion = &leg.motion;
    let verb = if leg.waits() {
        "waits"
    } else if motion.is_arc() || leg.corner_deg != 0.0 {
        "turns"
    } else if motion.speed < before.speed {
        "slows"
    } else {
        "goes faster"
    };
    match target {
        LAND => format!("{verb} for land"),
        target => format!("{verb} for '{target}'"),
    }
}

/// How own ship comes back to the mission's course or speed.
fn comes_back(leg: &PlannedLeg, before: &Before) -> &'static str {
    let motion = &leg.motion;
    if motion.is_arc() || leg.corner_deg != 0.0 {
        "turns back"
    } else if before.speed < STILL_MPS {
        "goes on"
    } else if motion.speed > before.speed {
        "goes faster again"
    } else {
        "slows again"
    }
}

/// Whom own ship has let pass before it comes back.
fn after_text(target: &str) -> String {
    match target {
        LAND => " past land".to_owned(),
        target => format!(" after '{target}'"),
    }
}

/// Two straight runs at one speed on nearly one course as the line between their ends.
fn one_line(last: &Segment, next: &Segment) -> Option<Segment> {
    let bend = wrap(next.start.heading - last.start.heading).abs();
    if last.is_arc() || next.is_arc() || bend > SAME_COURSE_RAD || !is_same_motion(last, next) {
        return None;
    }
    let way = next.end().position - last.start.position;
    let mut line = *last;
    line.duration += next.duration;
    if last.speed > 0.0 {
        line.start.heading = heading_of(way);
    }
    Some(line)
}

fn is_sliver(motion: &Segment) -> bool {
    let turned = (motion.turn_rate * motion.duration).abs();
    motion.is_arc() && motion.duration < SLIVER_S && turned < SLIVER_RAD
}

fn closest_approach(encounter: &EncounterDocument, is_set: bool) -> Option<(f64, String)> {
    let (distance, time) = (encounter.dcpa_m?, encounter.tcpa_s?);
    let (target, distance) = (&encounter.target, distance_words(distance, is_set));
    let side = match encounter.passing_side {
        Some(_) => format!(", {}", passing(encounter)),
        None => String::new(),
    };
    Some((time, format!("{CLOSEST} '{target}': {distance}{side}")))
}
