//! Is the escape of a ship that stands on what a document says of it?
//!
//! She holds course and speed until the latest time from which an escape is known to be clear, and
//! escapes then: the motion is both. That the whole of it is clear is checked as of any other; here
//! that it holds, when it ends, what follows, that all sets are in force meanwhile, and that
//! holding on would have met something. That no escape begins later is not.

use super::claim::{Claim, ClaimedMotion};
use super::figures::near;
use super::file::EscapeFile;
use super::untrue;
use crate::evaluation::{Evaluation, Request, Violation, evaluate};
use crate::frame::{clockwise_deg, wrap};
use crate::tolerance;
use crate::trajectory::Segment;

/// The only policy there is, and what it takes.
const POLICY: &str = "stand-on-hold";
const COMPLIANCE: &str = "rules";

/// Degrees to starboard that are readily apparent, and of the speed what is no more than half.
const APPARENT_DEG: f64 = 30.0;
const HALF: f64 = 0.5;

/// Everything that is wrong with an escape; nothing without one.
pub(super) fn check(claim: &Claim, evaluation: &Evaluation, request: &Request) -> Vec<Violation> {
    let Some(escape) = &claim.file.escape else {
        return Vec::new();
    };
    let mut found = Vec::new();
    let mut same = |key: &str, said: &str, so: &str| {
        if said != so {
            found.push(untrue(key, format!("'{said}'"), format!("'{so}'")));
        }
    };
    same("escape.policy", &escape.policy, POLICY);
    same("compliance", &claim.file.compliance, COMPLIANCE);
    let Some(ClaimedMotion::Segments(segments)) = &claim.motion else {
        found.push(untrue(
            "escape",
            "there is one",
            "no motion of lines and arcs",
        ));
        return found;
    };
    let latest = escape.latest_s;
    let Some((hold, away)) = parted(segments, escape) else {
        let so = segments.get(escape.first_segment).map(|s| s.start_time);
        let so = so.map_or("no segment".to_owned(), |t| format!("a start at {t} s"));
        let said = format!("{latest} s, segment {}", escape.first_segment);
        found.push(untrue("escape.latest_s, first_segment", said, so));
        return found;
    };
    let at = |violation: Violation| Violation {
        time: latest,
        ..violation
    };
    found.extend(held(claim, hold));
    found.extend(first(claim, escape, away).map(at));
    for set in claim.sets.iter().filter(|set| set.from > latest) {
        let said = format!("clear from {latest} s on");
        let so = format!("in the set of '{}' until {} s", set.name, set.from);
        found.push(at(untrue("escape", said, so)));
    }
    for (target, passage) in claim.targets.iter().zip(&evaluation.passages) {
        // negated on purpose: a NaN is not clear
        if !(passage.min_margin >= -tolerance::DEPTH_M) && passage.min_margin_time >= latest {
            let depth = -passage.min_margin;
            let so = format!("{depth} m deep in the set of '{}'", target.name);
            found.push(Violation {
                time: passage.min_margin_time,
                ..untrue("escape", "clear", so)
            });
        }
    }
    found.extend(needless(claim, hold, request).map(at));
    found
}

/// The hold and the escape; `None` where no segment begins at the time that is said, or another one
/// does.
fn parted<'s>(
    segments: &'s [Segment],
    escape: &EscapeFile,
) -> Option<(&'s [Segment], &'s [Segment])> {
    let (hold, away) = segments.split_at_checked(escape.first_segment)?;
    let begins = away.first()?.start_time;
    near(begins, escape.latest_s).then_some((hold, away))
}

/// True where own ship begins on the first leg as is desired, at a speed that she has: then nothing
/// is to be altered there.
fn is_on_her_way(claim: &Claim) -> bool {
    let (own, leg) = (&claim.own, &claim.desired.legs()[0]);
    let offset = own.pose.position - leg.start;
    let heading = crate::frame::heading_of(leg.direction);
    offset.norm() <= tolerance::JOINT_M
        && wrap(own.pose.heading - heading).abs() <= tolerance::JOINT_RAD
        && own.speeds.iter().any(|u| near(*u, leg.speed))
}

/// The first thing that is altered before the end of the hold. Legs after the first are reached
/// around corners: only what is sailed well before the first of these is looked at.
fn held(claim: &Claim, hold: &[Segment]) -> Option<Violation> {
    if !is_on_her_way(claim) {
        return None;
    }
    let legs = claim.desired.legs();
    let corner = if legs.len() > 1 {
        CORNER_RADII * claim.own.turning_radius
    } else {
        0.0
    };
    let straight = legs[0].length - corner;
    let on_leg = hold.iter().take_while(|s| {
        let along = (s.end().position - legs[0].start).dot(&legs[0].direction);
        along <= straight
    });
    // from beside the leg by a rounding a way onto it turns by one
    let heading = crate::frame::heading_of(legs[0].direction);
    let kept = |s: &Segment| {
        [s.start.heading, s.end().heading]
            .iter()
            .all(|course| wrap(course - heading).abs() <= HELD_RAD)
            && (s.turn_rate * s.duration).abs() <= HELD_RAD
    };
    let wrong = on_leg.into_iter().find(|s| {
        // negated on purpose: a NaN is no hold
        !(kept(s) && near(s.speed, legs[0].speed))
    })?;
    Some(Violation {
        time: wrong.start_time,
        ..untrue(
            "escape.latest_s",
            "course and speed are held",
            format!("{} m/s, {} rad/s", wrong.speed, wrong.turn_rate),
        )
    })
}

/// Radians off the course that is held: nobody steers that exactly.
const HELD_RAD: f64 = 1e-6;

/// Turning radii before a corner within which she may begin to turn.
const CORNER_RADII: f64 = 4.0;

/// What the escape begins with.
fn first(claim: &Claim, escape: &EscapeFile, away: &[Segment]) -> Option<Violation> {
    let speed = away[0].speed;
    if !near(escape.speed_mps, speed) {
        return Some(untrue("escape.speed_mps", escape.speed_mps, speed));
    }
    if escape.turn_deg == 0.0 {
        let fastest = claim.desired.legs().iter().map(|l| l.speed);
        let allowed = HALF * fastest.fold(0.0, f64::max);
        let slow = speed <= allowed * (1.0 + tolerance::LIMIT);
        return (!slow).then(|| untrue("escape.speed_mps", speed, format!("{allowed} at most")));
    }
    let side = away[0].turn_rate.signum();
    let turning = away
        .iter()
        .take_while(|s| s.turn_rate != 0.0 && s.turn_rate.signum() == side);
    let turned = clockwise_deg(turning.map(|s| s.turn_rate * s.duration).sum());
    if !near(escape.turn_deg, turned) {
        return Some(untrue("escape.turn_deg", escape.turn_deg, turned));
    }
    let apparent = turned >= APPARENT_DEG * (1.0 - tolerance::LIMIT);
    (!apparent).then(|| {
        let so = format!("{APPARENT_DEG} to starboard at least");
        untrue("escape.turn_deg", turned, so)
    })
}

/// Where nothing would be met by holding on to the end of the one leg, nothing is to be escaped
/// from.
fn needless(claim: &Claim, hold: &[Segment], request: &Request) -> Option<Violation> {
    let [leg] = claim.desired.legs() else {
        return None;
    };
    if !is_on_her_way(claim) {
        return None;
    }
    let begun = hold.last().map_or(claim.own.pose, Segment::end);
    let left = leg.length - (begun.position - leg.start).dot(&leg.direction);
    let mut on = hold.to_vec();
    on.push(Segment {
        start: begun,
        start_time: hold.last().map_or(0.0, Segment::end_time),
        duration: left / leg.speed,
        speed: leg.speed,
        turn_rate: 0.0,
    });
    let straight = evaluate(&Request {
        segments: &on,
        ..request.clone()
    });
    let met = |v: &Violation| v.what.starts_with("set of ") || v.what.starts_with("land");
    (!straight.violations.iter().any(met))
        .then(|| untrue("escape", "needed", "needless: holding on meets nothing"))
}
