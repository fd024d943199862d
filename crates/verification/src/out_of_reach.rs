//! Checks that the targets which a plan does not consider are out of its reach.
//!
//! A disc around each such target holds its hull and grows with its greatest speed. A disc around
//! own ship's start holds the whole motion, because no point of it is farther away than the way to
//! it is long. Two discs that stay apart until the horizon prove that the hulls do.

use std::collections::HashSet;

use super::claim::{Claim, ClaimedMotion};
use super::mismatch;
use searoom_document::{DistantRow, OutOfReachDocument};
use searoom_evaluation::Violation;
use searoom_geometry::frame::Vector;
use searoom_model::PlannerKind;

/// Fraction of the distances, which are sums of many numbers, to which the least one is held.
const ROUNDING: f64 = 1e-9;

/// Reports every target out of reach that is not proven to be, and a list that is not complete.
pub(super) fn check(claim: &Claim) -> Vec<Violation> {
    let Some(listed) = &claim.file.out_of_reach else {
        return Vec::new();
    };
    let mut found = Vec::new();
    let count = claim.targets.len() + listed.rows.len();
    if listed.of_targets != count {
        found.push(mismatch(
            "out_of_reach.of_targets",
            listed.of_targets,
            count,
        ));
    }
    if claim.planner == PlannerKind::OptimalControl {
        let so = "nothing, because a motion under forces has no greatest speed";
        found.push(mismatch("out_of_reach", "there is some", so));
    }
    let claimed_until = claim.file.horizon_s + claim.arrival_hold();
    // negated on purpose, here and below: a NaN proves nothing
    if !(listed.until_s >= claimed_until && listed.until_s.is_finite()) {
        let so = format!("at least {claimed_until}");
        found.push(mismatch("out_of_reach.until_s", listed.until_s, so));
    }
    if !(listed.apart_m > 0.0) {
        found.push(mismatch(
            "out_of_reach.apart_m",
            listed.apart_m,
            "a positive number",
        ));
    }
    let mut names: HashSet<&str> = claim.targets.iter().map(|t| t.name.as_str()).collect();
    let own_radius =
        farthest(claim, listed.until_s) + claim.own.hull.half_diagonal() + claim.own.safety_margin;
    for row in &listed.rows {
        let name = &row.0;
        if !names.insert(name) {
            let what = format!("'{name}' out of reach: there is another target of this name");
            found.push(Violation::new(what, 0.0));
        }
        if let Some(what) = reaches(claim, listed, row, own_radius) {
            found.push(Violation::new(
                format!("'{name}' out of reach: {what}"),
                0.0,
            ));
        }
    }
    found
}

/// Why a target is not proven to be out of reach; `None` where it is.
fn reaches(
    claim: &Claim,
    listed: &OutOfReachDocument,
    DistantRow(_, east, north, speed, radius): &DistantRow,
    own_radius: f64,
) -> Option<String> {
    if !(*speed >= 0.0 && speed.is_finite()) {
        return Some(format!(
            "its greatest speed is {speed} m/s; allowed: 0 or more"
        ));
    }
    if !(*radius > 0.0 && radius.is_finite()) {
        return Some(format!("its radius is {radius} m; allowed: above 0"));
    }
    let distance = (Vector::new(*east, *north) - claim.own.pose.position).norm();
    let apart = distance - own_radius - radius - speed * listed.until_s;
    let least = listed.apart_m - ROUNDING * (distance + listed.apart_m);
    if apart > 0.0 && apart >= least && apart.is_finite() {
        return None;
    }
    Some(format!(
        "{apart} m from what the plan reaches, expected at least {} m",
        listed.apart_m
    ))
}

/// Upper bound of the distance of own ship's centre from its start, metres. Without a motion, the
/// way at its greatest speed.
fn farthest(claim: &Claim, until: f64) -> f64 {
    let start = claim.own.pose.position;
    match &claim.motion {
        Some(ClaimedMotion::Segments(segments)) => {
            let ends = segments.iter().map(|segment| {
                let way = segment.speed.abs() * segment.duration;
                (segment.start.position - start).norm() + way
            });
            // a NaN remains
            ends.fold(0.0, |most: f64, end| match most.is_nan() || end <= most {
                true => most,
                false => end,
            })
        }
        Some(ClaimedMotion::Steered { .. }) => f64::NAN,
        None => claim.own.max_speed() * until,
    }
}
