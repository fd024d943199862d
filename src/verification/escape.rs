//! Checks the escape manoeuvre of a stand-on ship against its motion.
//!
//! Own ship holds course and speed while it must and a clear escape is known, and escapes then. The motion contains both. Its clearances are checked like those of any other
//! motion. This module checks the hold of course and speed, the time at which it ends, and the
//! first action of the escape. It also checks that all sets are valid during the escape, and that
//! holding on would have entered something.

use super::claim::{Claim, ClaimedMotion};
use super::figures::near;
use super::file::EscapeFile;
use super::mismatch;
use crate::evaluation::{Evaluation, Request, Violation, evaluate};
use crate::frame::{clockwise_deg, wrap};
use crate::tolerance;
use crate::trajectory::Segment;

/// The only policy, and the compliance that it requires.
const POLICY: &str = "stand-on-hold";
const COMPLIANCE: &str = "rules";

/// Smallest turn to starboard that is readily apparent (Rule 8), degrees, and the largest reduced
/// speed as a fraction of the desired speed.
const APPARENT_DEG: f64 = 30.0;
const HALF: f64 = 0.5;

/// Returns all violations of an escape; none without an escape.
pub(super) fn check(claim: &Claim, evaluation: &Evaluation, request: &Request) -> Vec<Violation> {
    let Some(escape) = &claim.file.escape else {
        return Vec::new();
    };
    let mut found = Vec::new();
    let mut same = |key: &str, said: &str, so: &str| {
        if said != so {
            found.push(mismatch(key, format!("'{said}'"), format!("'{so}'")));
        }
    };
    same("escape.policy", &escape.policy, POLICY);
    same("compliance", &claim.file.compliance, COMPLIANCE);
    let Some(ClaimedMotion::Segments(segments)) = &claim.motion else {
        found.push(mismatch(
            "escape",
            "there is one",
            "no motion of lines and arcs",
        ));
        return found;
    };
    let latest = escape.held_until_s;
    let Some((hold, away)) = parted(segments, escape) else {
        let so = segments.get(escape.first_segment).map(|s| s.start_time);
        let so = so.map_or("no segment".to_owned(), |t| format!("a start at {t} s"));
        let said = format!("{latest} s, segment {}", escape.first_segment);
        found.push(mismatch("escape.held_until_s, first_segment", said, so));
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
        found.push(at(mismatch("escape", said, so)));
    }
    for (target, passage) in claim.targets.iter().zip(&evaluation.passages) {
        // Negated on purpose: a NaN is not clear.
        if !(passage.min_margin >= -tolerance::DEPTH_M) && passage.min_margin_time >= latest {
            let depth = -passage.min_margin;
            let so = format!("{depth} m deep in the set of '{}'", target.name);
            found.push(Violation {
                time: passage.min_margin_time,
                ..mismatch("escape", "clear", so)
            });
        }
    }
    found.extend(needless(claim, hold, request).map(at));
    found
}

/// Splits the segments into hold and escape. `None` where the first segment of the escape does not
/// begin at the given time.
fn parted<'s>(
    segments: &'s [Segment],
    escape: &EscapeFile,
) -> Option<(&'s [Segment], &'s [Segment])> {
    let (hold, away) = segments.split_at_checked(escape.first_segment)?;
    let begins = away.first()?.start_time;
    near(begins, escape.held_until_s).then_some((hold, away))
}

/// Returns true where own ship starts on the first leg at the desired course, with the desired
/// speed in its finite set. No alteration is then needed there.
fn is_on_her_way(claim: &Claim) -> bool {
    let (own, leg) = (&claim.own, &claim.desired.legs()[0]);
    let offset = own.pose.position - leg.start;
    let heading = crate::frame::heading_of(leg.direction);
    offset.norm() <= tolerance::JOINT_M
        && wrap(own.pose.heading - heading).abs() <= tolerance::joint_rad(own.turning_radius)
        && own.speeds.iter().any(|u| near(*u, leg.speed))
}

/// Returns the first alteration before the end of the hold. Later legs are reached around corners,
/// so only motion well before the first corner is checked.
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
    // A rounding in the start position turns the connection to the leg by a rounding.
    let heading = crate::frame::heading_of(legs[0].direction);
    let kept = |s: &Segment| {
        [s.start.heading, s.end().heading]
            .iter()
            .all(|course| wrap(course - heading).abs() <= HELD_RAD)
            && (s.turn_rate * s.duration).abs() <= HELD_RAD
    };
    let wrong = on_leg.into_iter().find(|s| {
        // Negated on purpose: a NaN is no hold.
        !(kept(s) && near(s.speed, legs[0].speed))
    })?;
    Some(Violation {
        time: wrong.start_time,
        ..mismatch(
            "escape.held_until_s",
            "course and speed are held",
            format!("{} m/s, {} rad/s", wrong.speed, wrong.turn_rate),
        )
    })
}

/// Allowed course deviation during the hold, radians; far below the accuracy of steering.
const HELD_RAD: f64 = 1e-6;

/// Distance before a corner at which own ship may begin to turn, in turning radii.
const CORNER_RADII: f64 = 4.0;

/// Checks the first action of the escape.
fn first(claim: &Claim, escape: &EscapeFile, away: &[Segment]) -> Option<Violation> {
    let speed = away[0].speed;
    if !near(escape.speed_mps, speed) {
        return Some(mismatch("escape.speed_mps", escape.speed_mps, speed));
    }
    if escape.turn_deg == 0.0 {
        let fastest = claim.desired.legs().iter().map(|l| l.speed);
        let allowed = HALF * fastest.fold(0.0, f64::max);
        let slow = speed <= allowed * (1.0 + tolerance::LIMIT);
        return (!slow).then(|| mismatch("escape.speed_mps", speed, format!("{allowed} at most")));
    }
    let side = away[0].turn_rate.signum();
    let turning = away
        .iter()
        .take_while(|s| s.turn_rate != 0.0 && s.turn_rate.signum() == side);
    let turned = clockwise_deg(turning.map(|s| s.turn_rate * s.duration).sum());
    if !near(escape.turn_deg, turned) {
        return Some(mismatch("escape.turn_deg", escape.turn_deg, turned));
    }
    let apparent = turned >= APPARENT_DEG * (1.0 - tolerance::LIMIT);
    (!apparent).then(|| {
        let so = format!("{APPARENT_DEG} to starboard at least");
        mismatch("escape.turn_deg", turned, so)
    })
}

/// Reports a needless escape: holding on to the end of the only leg would enter nothing.
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
        .then(|| mismatch("escape", "needed", "needless: holding on meets nothing"))
}
