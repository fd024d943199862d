//! Checks the nominal closest approaches of a document against its mission.

use super::claim::Claim;
use super::encounters::{distance, shape_rounding};
use super::figures::near_to;
use super::mismatch;
use crate::evaluation::{Violation, nominal_distance, nominal_legs};
use crate::target::{Motion, Target};
use crate::tolerance;
use crate::trajectory::Segment;

/// Error of a nominal distance, as a fraction of the distance that both ships cover. The search
/// that finds it narrows down the time.
const RESOLUTION: f64 = 1e-9;

/// Number of samples per leg for ellipses.
const INSTANTS: u32 = 64;

/// Checks for each target the least distance along the desired trajectory, and the distance at the
/// given time.
pub(super) fn check(claim: &Claim) -> Vec<Violation> {
    let legs = nominal_legs(&claim.desired, claim.file.horizon_s);
    let all = claim.file.encounters.iter().zip(&claim.targets);
    all.filter_map(|(said, target)| {
        let label = |key: &str| format!("encounter with '{}', {key}", target.name);
        let rounding = shape_rounding(target, said.undisturbed_tcpa_s.unwrap_or(0.0));
        let near = |said: f64, so: f64| near_to(said, so, rounding);
        let missed = RESOLUTION * legs.iter().map(|leg| way(target, leg)).sum::<f64>();
        let (least, most) = match nominal_distance(&claim.own, &legs, target) {
            Some(so) => (so, so + missed),
            None => (f64::NEG_INFINITY, sampled(claim, target, &legs)),
        };
        let Some(dcpa) = said.undisturbed_dcpa_m else {
            return Some(mismatch(&label("undisturbed_dcpa_m"), "nothing", most));
        };
        let within = (dcpa >= least || near(dcpa, least)) && (dcpa <= most || near(dcpa, most));
        if !within {
            return Some(mismatch(&label("undisturbed_dcpa_m"), dcpa, most));
        }
        let tcpa = said.undisturbed_tcpa_s.unwrap_or(f64::NAN);
        let slack = tolerance::TIME_S * (1.0 + tcpa.abs());
        let mut then = legs
            .iter()
            .filter(|s| s.start_time - slack <= tcpa && tcpa <= s.end_time() + slack)
            .map(|s| at(claim, target, s, tcpa));
        (!then.any(|then| near(then, dcpa))).then(|| {
            let so = format!("a time along the mission at which the distance is {dcpa} m");
            mismatch(&label("undisturbed_tcpa_s"), tcpa, so)
        })
    })
    .collect()
}

/// Distance between the hulls, or from own position to the set, at a time of a leg, metres.
fn at(claim: &Claim, target: &Target, leg: &Segment, time: f64) -> f64 {
    let pose = leg.pose_at(time);
    match target.outer_set_at(time) {
        Some(set) => set.signed_distance(pose.position),
        None => distance(claim, target, &pose, time),
    }
}

/// Least distance over the samples: an upper bound of the least distance.
fn sampled(claim: &Claim, target: &Target, legs: &[Segment]) -> f64 {
    let instants = |leg: &Segment| {
        let (start, step) = (leg.start_time, leg.duration / f64::from(INSTANTS));
        (0..=INSTANTS).map(move |k| start + step * f64::from(k))
    };
    let distances = legs
        .iter()
        .flat_map(|leg| instants(leg).map(|time| at(claim, target, leg, time)));
    distances.fold(f64::INFINITY, f64::min)
}

/// Upper bound of the distance that own ship and a target cover together along a leg, metres.
fn way(target: &Target, leg: &Segment) -> f64 {
    let speed = match &target.motion {
        Motion::Ship(ship) => ship.speed,
        Motion::Sets(sets) => sets.top_speed(),
    };
    (leg.speed + speed) * leg.duration
}
