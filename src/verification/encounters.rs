//! Checks the encounters of a document against its motion.

use super::claim::{Claim, ClaimedMotion};
use super::figures::near_to;
use super::file::EncounterFile;
use super::mismatch;
use crate::document::{crosses_astern, is_crossing};
use crate::evaluation::{Body, Evaluation, MovingSlabs, Violation};
use crate::frame::{Pose, Vector, wrap};
use crate::geometry::ConvexSet;
use crate::target::{Motion, Target};
use crate::tolerance;
use crate::trajectory::{Segment, Trajectory};

/// Checks for each target the least distance, the distance at the given time, the passing side and
/// the crossing of its track.
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
        found.push(mismatch(
            "encounters",
            format!("'{have}'"),
            format!("'{want}'"),
        ));
        return found;
    }
    let trajectory = motion.trajectory();
    let all = said.iter().zip(&claim.targets).zip(&evaluation.passages);
    for ((said, target), passage) in all {
        let label = |key: &str| format!("encounter with '{}', {key}", target.name);
        let (dcpa, rounding) = (passage.dcpa, shape_rounding(target, passage.tcpa));
        if !said.dcpa_m.is_some_and(|d| near_to(d, dcpa, rounding)) {
            let value = said
                .dcpa_m
                .map_or_else(|| "nothing".to_owned(), |d| d.to_string());
            found.push(mismatch(&label("dcpa_m"), value, dcpa));
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
        if !(then.is_finite() && near_to(then, dcpa, rounding)) {
            found.push(mismatch(
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
            found.push(mismatch(&label("passing_side"), side_said, so));
        }
        let crossing = trajectory.as_ref().and_then(|t| crossing(t, said, target));
        if let Some(so) = crossing {
            let word =
                |astern: Option<bool>| astern.map_or("nothing".to_owned(), |a| a.to_string());
            let (said, so) = (word(said.crosses_astern), word(so));
            found.push(mismatch(&label("crosses_astern"), said, so));
        }
    }
    found
}

/// The right value of `crosses_astern` where the document has another one.
///
/// Own ship may be on the target's centre line or abeam of it to rounding. So the value is also
/// accepted if it is right for a track shifted by [`tolerance::DEPTH_M`].
fn crossing(
    trajectory: &Trajectory,
    said: &EncounterFile,
    target: &Target,
) -> Option<Option<bool>> {
    let role = said.role.as_deref().unwrap_or_default();
    let ship = target.ship().filter(|_| is_crossing(role));
    let shifted = |east: f64, north: f64| {
        let mut ship = ship?.clone();
        ship.pose.position += Vector::new(east, north) * tolerance::DEPTH_M;
        crosses_astern(trajectory, &ship, said.tcpa_s?)
    };
    let mut shifts = [
        [0.0, 0.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [-1.0, -1.0],
        [1.0, -1.0],
    ]
    .into_iter();
    let right = shifts.any(|[east, north]| shifted(east, north) == said.crosses_astern);
    (!right).then(|| shifted(0.0, 0.0))
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
            let Some(sets) = target.sets() else {
                return f64::NAN;
            };
            match &sets.initial {
                ConvexSet::Polygon(_) => sets.outer_section(time).signed_distance(pose.position),
                ConvexSet::Ellipse(_) => {
                    let here = Segment {
                        start: *pose,
                        start_time: time,
                        duration: 0.0,
                        speed: 0.0,
                        turn_rate: 0.0,
                    };
                    MovingSlabs::new(sets)
                        .least_distance(&[here], Body::POINT)
                        .value
                }
            }
        }
    }
}

/// Largest difference of two distances from an explicit set at a time, metres; 0 for ships.
///
/// It is that of the shape matrices of ellipses. Sums of polygons omit corners at which the
/// boundary turns by less than [`tolerance::COLLINEAR_RAD`].
pub(super) fn shape_rounding(target: &Target, time: f64) -> f64 {
    let across = |set: &ConvexSet| set.as_polygon().map_or(0.0, |set| set.across());
    match &target.motion {
        Motion::Ship(_) => 0.0,
        Motion::Sets(sets) => {
            let fastest = sets.velocities.iter().map(|set| across(&set.velocities));
            let extent = across(&sets.initial) + fastest.fold(0.0, f64::max) * time;
            tolerance::COLLINEAR_RAD * extent + MovingSlabs::new(sets).rounding(time)
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
