//! Checks the figures of a document against its motion.

use super::claim::{Claim, ClaimedMotion};
use super::comparison::{Rounding, differences};
use super::mismatch;
use super::risk::greatest_risk;
use searoom_document::{CostDocument, MissionDocument, PhaseDocument, RelaxationKind, finite};
use searoom_evaluation::{
    Evaluation, MovingSlabs, SpaceTimeSet, Steering, Violation, WAYPOINT_ACCURACY_M, stage_costs,
};
use searoom_geometry::ConvexSet;
use searoom_geometry::frame::{Pose, Vector};
use searoom_geometry::tolerance;
use searoom_model::ObjectiveKind;
use searoom_model::target::{Motion, Target};
use searoom_model::trajectory::{ForceNode, Segment};
use serde::Serialize;

/// The figures of a document that its motion determines.
#[derive(Serialize)]
struct Figures {
    mission: MissionDocument,
    cost: CostDocument,
    phases: Vec<PhaseDocument>,
    encounters: Vec<ClosestApproach>,
}

/// Least distance of an encounter.
#[derive(Serialize)]
struct ClosestApproach {
    target: String,
    dcpa_m: Option<f64>,
}

/// Checks the costs, the phases, the figures of the mission and the closest approaches.
pub(super) fn check(claim: &Claim, evaluation: &Evaluation) -> Vec<Violation> {
    let file = claim.file;
    let Some(cost) = &file.cost else {
        return vec![mismatch("cost", "nothing", "that of a motion")];
    };
    let claimed = Figures {
        mission: file.mission.clone(),
        cost: cost.clone(),
        phases: file.phases.clone(),
        encounters: (file.encounters.iter())
            .map(|encounter| ClosestApproach {
                target: encounter.target.clone(),
                dcpa_m: encounter.dcpa_m,
            })
            .collect(),
    };
    let proven = Figures {
        mission: MissionDocument {
            duration_s: claim.desired.duration(),
            length_m: claim.desired.length(),
            // the desired trajectory and the rest of the claim were made from these
            waypoints: file.mission.waypoints.clone(),
            leg_speeds_mps: file.mission.leg_speeds_mps.clone(),
            left_out_m: file.mission.left_out_m,
            stay_until_s: file.mission.stay_until_s,
            alternatives: file.mission.alternatives.clone(),
        },
        cost: cost_of(claim, cost, evaluation),
        // a document of an earlier program has none
        phases: match file.phases.is_empty() {
            true => Vec::new(),
            false => file.phases_of_motion(),
        },
        encounters: (claim.targets.iter().zip(&evaluation.passages))
            .map(|(target, passage)| ClosestApproach {
                target: target.name.clone(),
                dcpa_m: Some(passage.dcpa),
            })
            .collect(),
    };
    let mut found = not_finite(&proven);
    let (targets, passages) = (claim.targets.len(), evaluation.passages.len());
    if targets != passages {
        found.push(mismatch("closest approaches", passages, targets));
    }
    found.extend(differences(
        &claimed,
        &proven,
        &rounding(claim, cost, evaluation),
    ));
    found.extend(nearest_land(claim, cost, evaluation.min_land_distance));
    found.extend(way_left(claim, evaluation));
    found.extend(met_at_rest(claim));
    found
}

/// The costs of a motion.
fn cost_of(claim: &Claim, said: &CostDocument, evaluation: &Evaluation) -> CostDocument {
    let forces = claim.file.optimal_control.is_some();
    let minimised = match claim.file.objective {
        _ if forces => driven(claim, said.objective),
        ObjectiveKind::SpaceTimeError => Some(evaluation.space_time_error),
        ObjectiveKind::Time => Some(evaluation.duration),
        ObjectiveKind::Length => Some(evaluation.length),
        // that of `length-risk` is taken as given, and other planners have no others
        ObjectiveKind::LengthRisk | ObjectiveKind::StageCost => None,
    };
    CostDocument {
        objective: minimised.unwrap_or(said.objective),
        space_time_error_m2: evaluation.space_time_error,
        space_time_error_until_s: evaluation.counted.until,
        space_time_error_arc_length_m2: finite(evaluation.arc_length_error),
        arrived: !forces && !claim.gives_up_arrival(),
        duration_s: evaluation.duration,
        length_m: evaluation.length,
        delay_s: finite(evaluation.delay),
        waypoint_distances_m: evaluation.waypoint_distances.clone(),
        max_risk: greatest_risk(claim),
        min_clearance_m: finite(evaluation.min_clearance),
        hold_clearance_m: finite(evaluation.hold_clearance),
        // it says what `hold_clearance_m` covers
        arrival_hold_s: said.arrival_hold_s,
        // bounds instead of a value, see `nearest_land`
        min_land_distance_m: said.min_land_distance_m,
    }
}

/// Additional rounding of distances: from explicit sets that of their shape, from waypoints that of
/// the search for the least distance.
fn rounding(claim: &Claim, said: &CostDocument, evaluation: &Evaluation) -> Rounding {
    let end = evaluation.duration + claim.arrival_hold();
    let targets = claim.targets.iter();
    let largest = targets.map(|target| shape_rounding(target, end));
    let largest = largest.fold(0.0, f64::max);
    let clearances = ["min_clearance_m", "hold_clearance_m"];
    let clearances = clearances.map(|key| (format!("cost.{key}"), largest));
    let passages = claim.targets.iter().zip(&evaluation.passages).enumerate();
    let passages = passages.map(|(index, (target, passage))| {
        let place = format!("encounters[{index}].dcpa_m");
        (place, shape_rounding(target, passage.tcpa))
    });
    // no distance is negative
    let distances = said.waypoint_distances_m.iter().enumerate();
    let distances = distances.filter(|(_, distance)| **distance >= 0.0);
    let distances = distances.map(|(index, _)| {
        let place = format!("cost.waypoint_distances_m[{index}]");
        (place, WAYPOINT_ACCURACY_M)
    });
    clearances
        .into_iter()
        .chain(passages)
        .chain(distances)
        .collect()
}

/// Figures that every motion has and that are no finite numbers here. A document cannot hold them,
/// so the comparison would take them for nothing.
fn not_finite(proven: &Figures) -> Vec<Violation> {
    let cost = &proven.cost;
    let figures = [
        ("mission.duration_s", proven.mission.duration_s),
        ("mission.length_m", proven.mission.length_m),
        ("cost.objective", cost.objective),
        ("cost.space_time_error_m2", cost.space_time_error_m2),
        (
            "cost.space_time_error_until_s",
            cost.space_time_error_until_s,
        ),
        ("cost.duration_s", cost.duration_s),
        ("cost.length_m", cost.length_m),
        ("cost.max_risk", cost.max_risk),
    ];
    let distances = cost.waypoint_distances_m.iter();
    let distances = distances.map(|distance| ("cost.waypoint_distances_m", *distance));
    let approaches = proven.encounters.iter();
    let approaches = approaches.map(|e| ("encounters, dcpa_m", e.dcpa_m.unwrap_or(f64::NAN)));
    let all = figures.into_iter().chain(distances).chain(approaches);
    let wrong = all.filter(|(_, figure)| !figure.is_finite());
    wrong
        .map(|(place, figure)| mismatch(place, "a number", figure))
        .collect()
}

/// Checks the distance from the nearest land. The document holds only the land within reach; the
/// nearest land of the map may be beyond.
fn nearest_land(claim: &Claim, cost: &CostDocument, land: f64) -> Vec<Violation> {
    let mut found = Vec::new();
    let what = "cost.min_land_distance_m";
    match cost.min_land_distance_m {
        None if land.is_finite() => found.push(mismatch(what, "nothing", land)),
        None => {}
        Some(said) if land.is_finite() && near(said, land) => {}
        Some(said) => {
            if !(said <= land) {
                found.push(mismatch(what, said, land));
            }
            let beyond = beyond_reach(claim);
            if !(said >= beyond || near(said, beyond)) {
                let so = format!("{land}, or at least {beyond} for land beyond reach");
                found.push(mismatch(what, said, so));
            }
        }
    }
    found
}

/// Checks that a ship that is said to meet own ship at rest touches it then. A document of an earlier
/// program says nothing of it.
fn met_at_rest(claim: &Claim) -> Vec<Violation> {
    let Some(ClaimedMotion::Segments(segments)) = &claim.motion else {
        return Vec::new();
    };
    let Some(end) = segments.last().map(Segment::end) else {
        return Vec::new();
    };
    let all = claim.file.encounters.iter().zip(&claim.targets);
    let wrong = all.filter_map(|(said, target)| {
        let apart = target.distance_from(&claim.own.hull, &end, said.met_at_rest_s?);
        // negated so that a NaN is wrong
        let is_wrong = target.ship().is_some() && !(apart <= tolerance::DEPTH_M);
        let what = format!("encounter with '{}', met_at_rest_s", target.name);
        is_wrong.then(|| mismatch(&what, "contact", format_args!("{apart} m from it")))
    });
    wrong.collect()
}

/// Largest difference of two distances from an explicit set at a time, metres; 0 for ships.
///
/// It is that of the shape matrices of ellipses. Sums of polygons omit corners at which the
/// boundary turns by less than [`tolerance::COLLINEAR_RAD`].
fn shape_rounding(target: &Target, time: f64) -> f64 {
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

/// Checks the remaining distance of a plan that does not arrive. Along a single path it is the part
/// of the path that was not covered, on a network at least the straight distance. Off paths it is
/// that from the nearest point of the path. There the plan lasts until the horizon, or at no risk a
/// set is over the last waypoint at the horizon.
fn way_left(claim: &Claim, evaluation: &Evaluation) -> Option<Violation> {
    let mut relaxation = claim.file.relaxations.iter();
    let given_up = relaxation.find(|r| r.kind == RelaxationKind::Arrival)?;
    let said = given_up.amount;
    let Some(ClaimedMotion::Segments(segments)) = &claim.motion else {
        return None;
    };
    let (last, end) = (claim.desired.end(), segments.last()?.end().position);
    let alone = claim.file.mission.alternatives.is_empty();
    let (so, exactly) = match &claim.paths {
        Some(_) if alone => (claim.desired.length() - evaluation.length, true),
        Some(_) => ((last - end).norm(), false),
        None => (claim.desired.left_from(end, evaluation.length), true),
    };
    // Negated on purpose: a NaN is a mismatch.
    if !(said > 0.0 && (near(said, so) || !exactly && said >= so)) {
        let so = format!("{so} m{}", if exactly { "" } else { " at least" });
        return Some(mismatch("relaxation of arrival, amount", said, so));
    }
    let horizon = claim.file.horizon_s;
    let there = [Segment::straight(Pose::new(last, 0.0), horizon, 0.0, 0.0)];
    let mut sets = claim.sets.iter().filter(|s| s.name == given_up.target);
    let covers = |set: &SpaceTimeSet| set.least_distance(&there).value <= tolerance::LENGTH_M;
    // a remainder may end on the way for what was found before
    let is_kept = claim
        .file
        .memory
        .as_ref()
        .is_some_and(|memory| memory.keeps_plan);
    let stops = segments.last()?.end_time();
    // or until the stay ends, where one is asked for
    let until = claim.file.mission.stay_until_s.unwrap_or(horizon);
    let lasts =
        (until - stops).abs().min((horizon - stops).abs()) <= tolerance::TIME_S * (1.0 + horizon);
    // the sets of a risk are smaller than those that are over it
    let is_judged = claim.paths.is_none() && claim.file.max_risk == 0.0 && !is_kept && !lasts;
    if is_judged && !sets.any(covers) {
        let so = "a target whose set is over the last waypoint at the horizon, where the plan ends";
        return Some(mismatch(
            "relaxation of arrival, target",
            &given_up.target,
            so,
        ));
    }
    None
}

/// Lower bound of the distance from own hull to land outside the document, metres.
///
/// The document holds all land in a square about the midpoint of start and end. Half of its side is
/// half of the distance that own ship can cover, plus its footprint.
fn beyond_reach(claim: &Claim) -> f64 {
    let own = &claim.own;
    let (start, end) = (own.pose.position, claim.desired.end());
    let way = (own.max_speed() * claim.file.horizon_s).max((end - start).norm());
    let middle = (start + end) * 0.5;
    let off = |p: Vector| (p - middle).abs().max();
    let farthest = match &claim.motion {
        // The distance of an arc from its nearer end is at most half of its length.
        Some(ClaimedMotion::Segments(segments)) => {
            let most = |s: &Segment| off(s.start.position).max(off(s.end().position)) + bulge(s);
            segments.iter().map(most).fold(0.0, f64::max)
        }
        // Between two nodes, the motion is within their distance of the nodes.
        Some(ClaimedMotion::Steered { motion, .. }) => {
            let nodes = motion.nodes().windows(2);
            let most = |w: &[ForceNode]| {
                let [a, b] = [w[0].pose.position, w[1].pose.position];
                off(a).max(off(b)) + (b - a).norm()
            };
            nodes.map(most).fold(0.0, f64::max)
        }
        None => 0.0,
    };
    0.5 * way + claim.file.own_ship.land_margin_m - farthest
}

fn bulge(segment: &Segment) -> f64 {
    if segment.turn_rate == 0.0 {
        0.0
    } else {
        0.5 * segment.length()
    }
}

/// Stage cost of a motion under forces. Where a leg ends at a sampled instant, rounding may change
/// the cost; the candidate nearest to the reported cost is returned.
fn driven(claim: &Claim, said: f64) -> Option<f64> {
    let Some(ClaimedMotion::Steered {
        motion,
        vessel,
        force_limits,
        start_velocity,
        weights,
    }) = &claim.motion
    else {
        return None;
    };
    let vessel = vessel.exact(claim.own.hull.length);
    let steering = Steering {
        motion,
        vessel: vessel.as_ref(),
        force_limits: *force_limits,
        start_velocity: *start_velocity,
    };
    let costs = stage_costs(&steering, &claim.desired, weights);
    let off = |cost: &f64| (cost - said).abs();
    costs.into_iter().min_by(|a, b| off(a).total_cmp(&off(b)))
}

/// Returns true for figures that are equal to [`tolerance::FIGURE`], relative above one.
pub(super) fn near(said: f64, so: f64) -> bool {
    near_to(said, so, 0.0)
}

/// Returns true for figures that are [`near`] up to an additional rounding.
pub(super) fn near_to(said: f64, so: f64, rounding: f64) -> bool {
    (said - so).abs() <= tolerance::FIGURE * so.abs().max(1.0) + rounding
}
