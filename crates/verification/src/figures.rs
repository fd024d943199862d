//! Checks the figures of a document against its motion.

use super::claim::{Claim, ClaimedMotion};
use super::mismatch;
use searoom_document::{PhaseDocument, PlanDocument, RelaxationKind};
use searoom_evaluation::{
    Evaluation, MovingSlabs, SpaceTimeSet, Steering, Violation, WAYPOINT_ACCURACY_M, stage_costs,
};
use searoom_geometry::ConvexSet;
use searoom_geometry::frame::{Pose, Vector};
use searoom_geometry::tolerance;
use searoom_model::ObjectiveKind;
use searoom_model::target::{Motion, Target};
use searoom_model::trajectory::{ForceNode, Segment};

/// Checks the phases. A document of an earlier program has none.
fn phases(file: &PlanDocument) -> Option<Violation> {
    let (said, so) = (&file.phases, file.phases_of_motion());
    let is_same = |(a, b): (&PhaseDocument, &PhaseDocument)| {
        a.phase == b.phase && near(a.from_s, b.from_s) && near(a.until_s, b.until_s)
    };
    let are_same = said.len() == so.len() && said.iter().zip(&so).all(is_same);
    let words = |phases: &[PhaseDocument]| {
        let words = phases
            .iter()
            .map(|p| format!("{} to {} s", p.phase.word(), p.until_s));
        words.collect::<Vec<_>>().join(", ")
    };
    let is_wrong = !said.is_empty() && !are_same;
    is_wrong.then(|| mismatch("phases", words(said), words(&so)))
}

/// Checks the costs, the phases, the figures of the mission and the closest approaches.
pub(super) fn check(claim: &Claim, evaluation: &Evaluation) -> Vec<Violation> {
    let mut found = Vec::new();
    let file = &claim.file;
    let mut same_to = |what: &str, said: Option<f64>, so: f64, rounding: f64| {
        let so = so.is_finite().then_some(so);
        let agree = match (said, so) {
            (Some(said), Some(so)) => near_to(said, so, rounding),
            (said, so) => said.is_none() && so.is_none(),
        };
        if !agree {
            found.push(mismatch(what, words(said), words(so)));
        }
    };
    let mut same = |what: &str, said: Option<f64>, so: f64| same_to(what, said, so, 0.0);
    let (mission, desired) = (&file.mission, &claim.desired);
    let [time, length] = [mission.duration_s, mission.length_m].map(Some);
    same("mission.duration_s", time, desired.duration());
    same("mission.length_m", length, desired.length());
    let Some(cost) = &file.cost else {
        found.push(mismatch("cost", "nothing", "that of a motion"));
        return found;
    };
    let end = evaluation.duration + claim.arrival_hold();
    let targets = claim.targets.iter();
    let rounding = targets
        .map(|target| shape_rounding(target, end))
        .fold(0.0, f64::max);
    let forces = file.optimal_control.is_some();
    let (error, until) = (cost.space_time_error_m2, cost.space_time_error_until_s);
    let so = evaluation.space_time_error;
    same("cost.space_time_error_m2", Some(error), so);
    let by_length = cost.space_time_error_arc_length_m2;
    let so = evaluation.arc_length_error;
    same("cost.space_time_error_arc_length_m2", by_length, so);
    let so = evaluation.counted.until;
    same("cost.space_time_error_until_s", Some(until), so);
    let so = evaluation.duration;
    same("cost.duration_s", Some(cost.duration_s), so);
    same("cost.length_m", Some(cost.length_m), evaluation.length);
    same("cost.delay_s", cost.delay_s, evaluation.delay);
    let minimised = match file.objective {
        _ if forces => driven(claim, cost.objective),
        ObjectiveKind::SpaceTimeError => Some(evaluation.space_time_error),
        ObjectiveKind::Time => Some(evaluation.duration),
        ObjectiveKind::Length => Some(evaluation.length),
        _ => None,
    };
    if let Some(so) = minimised {
        same("cost.objective", Some(cost.objective), so);
    }
    let (said, so) = (&cost.waypoint_distances_m, &evaluation.waypoint_distances);
    let counts = [said, so].map(|distances| distances.len() as f64);
    let what = "cost.waypoint_distances_m, length";
    same(what, Some(counts[0]), counts[1]);
    for (k, (said, so)) in said.iter().zip(so).enumerate() {
        let what = format!("cost.waypoint_distances_m[{k}]");
        // no distance is negative
        let accuracy = if *said < 0.0 {
            0.0
        } else {
            WAYPOINT_ACCURACY_M
        };
        same_to(&what, Some(*said), *so, accuracy);
    }
    let (said, so) = (cost.min_clearance_m, evaluation.min_clearance);
    same_to("cost.min_clearance_m", said, so, rounding);
    let (said, so) = (cost.hold_clearance_m, evaluation.hold_clearance);
    same_to("cost.hold_clearance_m", said, so, rounding);
    let arrives = !forces && !claim.gives_up_arrival();
    if cost.arrived != arrives {
        found.push(mismatch("cost.arrived", cost.arrived, arrives));
    }
    // The document holds only the land within reach; the nearest land of the map may be beyond.
    let land = evaluation.min_land_distance;
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
    found.extend(phases(file));
    found.extend(way_left(claim, evaluation));
    found.extend(closest_approaches(claim, evaluation));
    found.extend(met_at_rest(claim));
    found
}

/// Checks that there is an encounter for each target, and its least distance.
fn closest_approaches(claim: &Claim, evaluation: &Evaluation) -> Vec<Violation> {
    let encounters = &claim.file.encounters;
    let said: Vec<&str> = encounters.iter().map(|e| e.target.as_str()).collect();
    let names: Vec<&str> = claim.targets.iter().map(|t| t.name.as_str()).collect();
    if said != names {
        let [said, names] = [said, names].map(|names| format!("'{}'", names.join(", ")));
        return vec![mismatch("encounters", said, names)];
    }
    let all = encounters.iter().zip(&claim.targets);
    let wrong = all
        .zip(&evaluation.passages)
        .filter(|((said, target), passage)| {
            let rounding = shape_rounding(target, passage.tcpa);
            !said
                .dcpa_m
                .is_some_and(|dcpa| near_to(dcpa, passage.dcpa, rounding))
        });
    wrong
        .map(|((said, target), passage)| {
            let what = format!("encounter with '{}', dcpa_m", target.name);
            mismatch(&what, words(said.dcpa_m), passage.dcpa)
        })
        .collect()
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

fn words(value: Option<f64>) -> String {
    value.map_or_else(|| "nothing".to_owned(), |v| format!("{v}"))
}
