//! The legs of a plan as a navigator reads them: turns and straight runs, and the events on each.

use super::PlanDocument;
use super::reasons::Before;
use crate::document::encounter::EncounterDocument;
use crate::document::lines::{distance_words, is_set, passing};
use crate::document::parts::segment;
use crate::frame::{
    clockwise_deg, course_deg_from_heading, heading_from_course_deg, heading_of, wrap,
};
use crate::obstacle::LAND;
use crate::text::tenths;
use crate::tolerance;
use crate::trajectory::Segment;

/// Speeds that differ by this fraction are one: the rounding of a planner, half a metre in a
/// thousand kilometres.
const SAME_SPEED: f64 = 1e-6;

/// Radians. A smaller change of course at a joint is rounding.
const CORNER_RAD: f64 = 1e-6;

/// Seconds. A shorter segment is no leg: a ship covers some millimetres.
const SHORTEST_S: f64 = 1e-3;

/// Seconds and radians. A shorter and smaller turn is part of the leg after it, as no chart shows it.
const SLIVER_S: f64 = 2.0;
const SLIVER_RAD: f64 = 0.035;

/// Radians. Straight runs whose courses differ by less are one leg.
const SAME_COURSE_RAD: f64 = 1e-3;

/// Degrees. A smaller turn is not told.
const LEAST_TURN_DEG: f64 = 0.05;

/// Event of a leg: the manoeuvre is over.
const RETURNS: &str = "returns";

/// Event of a leg: a turn at a corner of the mission.
const FOLLOWS: &str = "follows the mission";

/// Begins the event of a closest approach.
pub(crate) const CLOSEST: &str = "closest to";

/// m/s. A slower ship lies still.
pub(super) const STILL_MPS: f64 = 1e-3;

/// A turn, a straight run or a wait at one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedLeg {
    /// The whole leg; times in seconds from the present.
    pub motion: Segment,
    /// Change of course at its start, degrees, positive to starboard. Not 0 at the corners of a
    /// path, where the path-time planner turns at once.
    pub corner_deg: f64,
    /// The target for which the leg alters course or speed, or [`LAND`].
    pub because_of: Option<String>,
    /// Events on the leg, in order of time; first the alteration and its target.
    pub events: Vec<String>,
}

impl PlannedLeg {
    /// Course at the end, degrees clockwise from north.
    pub fn course_deg(&self) -> f64 {
        course_deg_from_heading(self.motion.end().heading)
    }

    /// Change of course along the leg, degrees; positive to starboard, 0 for a straight run.
    pub fn turn_deg(&self) -> f64 {
        clockwise_deg(self.motion.turn_rate * self.motion.duration)
    }

    /// The turn in words: side and degrees, at a corner "at once"; `None` where own ship goes
    /// straight on.
    pub(crate) fn turn_words(&self) -> Option<String> {
        let sided = |turn: f64| {
            let side = if turn > 0.0 { "starboard" } else { "port" };
            let shown = turn.abs() >= LEAST_TURN_DEG;
            shown.then(|| format!("{side} {:.*}°", usize::from(turn.abs() < 0.5), turn.abs()))
        };
        match (sided(self.corner_deg), sided(self.turn_deg())) {
            _ if self.waits() => Some("waits".to_owned()),
            (None, turn) => turn,
            (Some(corner), None) => Some(format!("{corner} at once")),
            (Some(corner), Some(turn)) => Some(format!("{corner} at once, {turn}")),
        }
    }

    /// The course at the end as three digits, 000 to 359.
    pub(crate) fn course_figure(&self) -> String {
        // 359.9° is 000
        format!("{:03.0}", self.course_deg().round() % 360.0)
    }

    /// Length in metres, with a decimal where the `longest` leg is short.
    pub(crate) fn length_figure(&self, longest: f64) -> String {
        let length = self.motion.length();
        match longest < 100.0 {
            true => tenths(length),
            false => format!("{length:.0}"),
        }
    }

    /// True where own ship lies still, or moves too slowly for any log to show it.
    pub fn waits(&self) -> bool {
        self.motion.speed < STILL_MPS
    }
}

/// Length of the longest leg, metres.
pub(crate) fn longest(legs: &[PlannedLeg]) -> f64 {
    legs.iter()
        .map(|leg| leg.motion.length())
        .fold(0.0, f64::max)
}

impl PlanDocument {
    /// The legs in order of time, with what happens on each. Empty without a plan, and for a plan
    /// under forces.
    ///
    /// A turn of less than 2 s and 0.035 rad is part of the leg after it, which begins where the
    /// turn does. Runs on one course, to 0.001 rad, are one leg. So places are off by some
    /// decimetres.
    pub fn legs(&self) -> Vec<PlannedLeg> {
        let mut legs: Vec<PlannedLeg> = Vec::new();
        let mut sliver: Option<Segment> = None;
        let all = self.motions();
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
        for (time, event) in self.events() {
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
            heading: heading_from_course_deg(self.own_ship.course_deg),
            speed: self.own_ship.speed_mps,
        };
        let (mut cause, mut told) = (None, None);
        for index in 0..legs.len() {
            let returns = self.manoeuvres.iter().any(|m| {
                let time = legs[index].motion.start_time + tolerance::TIME_S;
                m.returns_s <= time && time < m.joins_s
            });
            let follows = self.follows_mission(&before, &legs[index].motion);
            let reason = self.reason(&before, &legs[index..]);
            let reason = reason.filter(|_| !returns && !follows).map(str::to_owned);
            let after = self.waited_for(&legs, index).filter(|_| !follows);
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
                        self.lesser_turns(leg),
                    ];
                    leg.events.splice(0..0, told.into_iter().flatten());
                }
                (cause, told) = (Some(target.clone()), None);
            } else if let Some(event) = leg.events.iter_mut().find(|event| *event == RETURNS) {
                // by the rules a manoeuvre lasts until its target is past
                let is_past = |target: &String| {
                    let mut encounters = self.encounters.iter();
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

    /// The segments of a millisecond or more, where those that go on in the same motion are joined.
    pub(super) fn motions(&self) -> Vec<PlannedLeg> {
        let segments = self.trajectory.as_ref().and_then(|t| t.segments.as_ref());
        let segments = segments.into_iter().flatten().map(segment);
        let mut legs: Vec<PlannedLeg> = Vec::new();
        for motion in segments.filter(|s| s.duration >= SHORTEST_S) {
            let mut corner_deg = 0.0;
            if let Some(last) = legs.last_mut() {
                let corner = wrap(motion.start.heading - last.motion.end().heading);
                if corner.abs() > CORNER_RAD {
                    corner_deg = clockwise_deg(corner);
                } else if are_one(&last.motion, &motion) {
                    last.motion.duration += motion.duration;
                    continue;
                }
            }
            legs.push(PlannedLeg {
                motion,
                corner_deg,
                because_of: None,
                events: Vec::new(),
            });
        }
        legs
    }

    /// Events of the plan, by time. A manoeuvre that is under way began before.
    fn events(&self) -> Vec<(f64, String)> {
        let mut events = Vec::new();
        for manoeuvre in &self.manoeuvres {
            let parts = [
                (manoeuvre.begins_s, "begins the manoeuvre"),
                (manoeuvre.returns_s, RETURNS),
                (manoeuvre.joins_s, "back on the mission"),
            ];
            events.extend(parts.map(|(time, what)| (time, what.to_owned())));
        }
        let has_role = |e: &&EncounterDocument| {
            e.role != "none" || e.conduct.as_ref().is_some_and(|c| !c.roles.is_empty())
        };
        let met = self.encounters.iter().filter(has_role);
        events.extend(met.filter_map(|e| closest_approach(e, is_set(self, &e.target))));
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        events
    }
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
    if last.is_arc() || next.is_arc() || bend > SAME_COURSE_RAD || !are_one(last, next) {
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

/// True for two motions of one speed and one rate of turn.
fn are_one(last: &Segment, next: &Segment) -> bool {
    let turns = last.turn_rate.abs().max(next.turn_rate.abs());
    (last.speed - next.speed).abs() <= SAME_SPEED * last.speed.max(next.speed)
        && (last.turn_rate - next.turn_rate).abs() <= SAME_SPEED * turns
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
