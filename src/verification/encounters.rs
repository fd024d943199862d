//! Checks the encounters of a document against its motion.

use super::claim::{Claim, ClaimedMotion};
use super::figures::near;
use super::untrue;
use crate::evaluation::{Evaluation, Violation};
use crate::frame::{Pose, Vector, wrap};
use crate::geometry::{ConvexSet, Ellipse};
use crate::target::{Target, Uncertainty};
use crate::tolerance;
use nalgebra::Matrix2;

/// Checks for each target the least distance, the distance at the given time, and the passing side.
pub(super) fn check(
    claim: &Claim,
    motion: &ClaimedMotion,
    evaluation: &Evaluation,
) -> Vec<Violation> {
    let mut found = Vec::new();
    let said = &claim.file.encounters;
    let names =
        |names: &mut dyn Iterator<Item = &String>| names.cloned().collect::<Vec<_>>().join(", ");
    let (have, want) = (
        names(&mut said.iter().map(|e| &e.target)),
        names(&mut claim.targets.iter().map(|t| &t.name)),
    );
    if have != want {
        found.push(untrue(
            "encounters",
            format!("'{have}'"),
            format!("'{want}'"),
        ));
        return found;
    }
    let all = said.iter().zip(&claim.targets).zip(&evaluation.passages);
    for ((said, target), passage) in all {
        let label = |key: &str| format!("encounter with '{}', {key}", target.name);
        let dcpa = passage.dcpa;
        if !said.dcpa_m.is_some_and(|d| near(d, dcpa)) {
            let value = said
                .dcpa_m
                .map_or_else(|| "nothing".to_owned(), |d| d.to_string());
            found.push(untrue(&label("dcpa_m"), value, dcpa));
            continue;
        }
        // The least distance may last for some time, so the distance at the given time is compared.
        let tcpa = said.tcpa_s.unwrap_or(f64::NAN);
        let poses = motion.poses_at(tcpa);
        let then = poses.iter().map(|pose| distance(claim, target, pose, tcpa));
        let then = then.fold(f64::INFINITY, f64::min);
        let then = match &poses[..] {
            [before, .., after] => then.min(while_turning(claim, target, (before, after), tcpa)),
            _ => then,
        };
        if !(then.is_finite() && near(then, dcpa)) {
            found.push(untrue(
                &label("tcpa_s"),
                tcpa,
                format!(
                    "{} s; at the time given the distance is {then} m",
                    passage.tcpa
                ),
            ));
            continue;
        }
        let side_said = said.passing_side.as_deref().unwrap_or("nothing");
        let abeam = |pose: &Pose| port_of(pose, target.position_at(tcpa));
        // Dead ahead and astern count as starboard; within rounding, both sides are accepted.
        let may_be = |pose: &Pose| match side_said {
            "port" => abeam(pose) >= 0.0,
            "starboard" => abeam(pose) <= 2.0 * tolerance::DEPTH_M,
            _ => false,
        };
        if !poses.iter().any(may_be) {
            let to_port = poses.first().is_some_and(|p| abeam(p) > tolerance::DEPTH_M);
            let so = if to_port { "port" } else { "starboard" };
            found.push(untrue(&label("passing_side"), side_said, so));
        }
    }
    found
}

/// Offset of a place to port of the line ahead through a pose, metres.
fn port_of(pose: &Pose, place: Vector) -> f64 {
    let (sin, cos) = pose.heading.sin_cos();
    let offset = place - pose.position;
    cos * offset.y - sin * offset.x
}

/// Distance between the hulls, or from own position to the set.
pub(super) fn distance(claim: &Claim, target: &Target, pose: &Pose, time: f64) -> f64 {
    match target.ship() {
        Some(ship) => claim
            .own
            .hull
            .polygon(pose)
            .separation(&ship.hull.polygon(&ship.pose_at(time))),
        None => {
            let distance = |sets: &Uncertainty| match &sets.initial {
                ConvexSet::Polygon(_) => {
                    Some(sets.outer_section(time).signed_distance(pose.position))
                }
                ConvexSet::Ellipse(initial) => {
                    let section = least_trace_sum(initial, sets, time)?;
                    Some(section.signed_distance(pose.position).distance)
                }
            };
            target.sets().and_then(distance).unwrap_or(f64::NAN)
        }
    }
}

/// Sampled headings of a turn on the spot, and bisection steps about the nearest of them.
const HEADINGS: u32 = 180;
const HALVINGS: usize = 60;

/// Least distance while own ship turns on the spot between two headings, through the smaller angle.
fn while_turning(claim: &Claim, target: &Target, turn: (&Pose, &Pose), time: f64) -> f64 {
    let (before, after) = turn;
    let angle = wrap(after.heading - before.heading);
    let at = |share: f64| {
        let pose = Pose::new(before.position, before.heading + share * angle);
        distance(claim, target, &pose, time)
    };
    let mut step = 1.0 / f64::from(HEADINGS);
    let all = (0..=HEADINGS).map(|k| f64::from(k) * step);
    let nearest = all.map(|share| (at(share), share));
    let (mut least, mut share) =
        nearest.fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a });
    for _ in 0..HALVINGS {
        step *= 0.5;
        for beside in [share - step, share + step] {
            let found = at(beside.clamp(0.0, 1.0));
            if found < least {
                (least, share) = (found, beside.clamp(0.0, 1.0));
            }
        }
    }
    least
}

/// Ellipse of least trace around a sum of ellipses, docs/theory.md section 3.
pub(super) fn least_trace_sum(initial: &Ellipse, sets: &Uncertainty, time: f64) -> Option<Ellipse> {
    let (mut center, mut shape, mut sum) = (Vector::zeros(), Matrix2::zeros(), 0.0);
    let mut add = |ellipse: &Ellipse, factor: f64| {
        let scaled = ellipse.shape() * (factor * factor);
        let root = scaled.trace().sqrt();
        // Negated on purpose: a NaN is included.
        if !(root <= 0.0) {
            shape += scaled / root;
            sum += root;
        }
        center += ellipse.center() * factor;
    };
    add(initial, 1.0);
    for (duration, velocities) in sets.durations(time) {
        add(velocities.as_ellipse()?, duration);
    }
    Ellipse::new(center, shape * sum).ok()
}
