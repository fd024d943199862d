//! Checks the figures of a document against its motion.

use super::claim::{ARRIVAL, Claim, ClaimedMotion};
use super::encounters::shape_rounding;
use super::mismatch;
use crate::document::first_alteration;
use crate::evaluation::{Evaluation, Steering, Violation, stage_costs};
use crate::frame::Vector;
use crate::tolerance;
use crate::trajectory::{ForceNode, Segment};

/// Checks the costs, the figures of the mission and the path-time profile.
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
    same(
        "mission.duration_s",
        Some(file.mission.duration_s),
        claim.desired.duration(),
    );
    same(
        "mission.length_m",
        Some(file.mission.length_m),
        claim.desired.length(),
    );
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
    same(
        "cost.space_time_error_m2",
        Some(cost.space_time_error_m2),
        evaluation.space_time_error,
    );
    same(
        "cost.space_time_error_arc_length_m2",
        cost.space_time_error_arc_length_m2,
        evaluation.arc_length_error,
    );
    if let Some(said) = cost.space_time_error_until_s {
        let so = evaluation.counted.until;
        same("cost.space_time_error_until_s", Some(said), so);
    }
    same(
        "cost.duration_s",
        Some(cost.duration_s),
        evaluation.duration,
    );
    same("cost.length_m", Some(cost.length_m), evaluation.length);
    same("cost.delay_s", cost.delay_s, evaluation.delay);
    let minimised = match file.objective.as_str() {
        _ if forces => driven(claim, cost.objective),
        "space-time-error" => Some(evaluation.space_time_error),
        "time" => Some(evaluation.duration),
        "length" => Some(evaluation.length),
        _ => None,
    };
    if let Some(so) = minimised {
        same("cost.objective", Some(cost.objective), so);
    }
    same_to(
        "cost.min_clearance_m",
        cost.min_clearance_m,
        evaluation.min_clearance,
        rounding,
    );
    // A figure that the document omits is not checked.
    if cost.arrival_hold_s.is_some() || cost.hold_clearance_m.is_some() {
        same_to(
            "cost.hold_clearance_m",
            cost.hold_clearance_m,
            evaluation.hold_clearance,
            rounding,
        );
    }
    let arrives = !forces && !claim.gives_up_arrival();
    if cost.arrived != arrives {
        found.push(mismatch("cost.arrived", cost.arrived, arrives));
    }
    // The document holds only the land within reach; the nearest land of the map may be beyond.
    let land = evaluation.min_land_distance;
    if let Some(said) = cost
        .min_land_distance_m
        .filter(|said| !(*said <= land || near(*said, land)))
    {
        found.push(mismatch("cost.min_land_distance_m", said, land));
    }
    if let Some(said) = cost
        .min_land_distance_m
        .filter(|said| !(land.is_finite() && near(*said, land)))
    {
        let beyond = beyond_reach(claim);
        if !(said >= beyond || near(said, beyond)) {
            let so = format!("{land}, or at least {beyond} for land beyond reach");
            found.push(mismatch("cost.min_land_distance_m", said, so));
        }
    }
    if cost.min_land_distance_m.is_none() && land.is_finite() {
        found.push(mismatch("cost.min_land_distance_m", "nothing", land));
    }
    found.extend(first_turn(claim));
    found.extend(profile(claim));
    found.extend(way_left(claim, evaluation));
    found
}

/// Checks the first alteration of course.
fn first_turn(claim: &Claim) -> Option<Violation> {
    let said = claim.file.cost.as_ref()?.first_turn.as_ref();
    let so = first_alteration(&claim.motion.as_ref()?.trajectory()?);
    let agree = match (said, &so) {
        (Some(said), Some(so)) => {
            said.side == so.side.to_string()
                && near(said.turn_deg, so.degrees)
                && near(said.t_s, so.start)
        }
        (said, so) => said.is_none() && so.is_none(),
    };
    let turn = |side: &str, degrees: f64, time: f64| format!("{degrees}° to {side} at {time} s");
    let words = |turn: Option<String>| turn.unwrap_or_else(|| "nothing".to_owned());
    let said = said.map(|t| turn(&t.side, t.turn_deg, t.t_s));
    let so = so.map(|t| turn(&t.side.to_string(), t.degrees, t.start));
    (!agree).then(|| mismatch("cost.first_turn", words(said), words(so)))
}

/// Checks the remaining distance of a plan that does not arrive. It is at least the straight
/// distance; with a single path, it is the part of the path that was not covered.
fn way_left(claim: &Claim, evaluation: &Evaluation) -> Option<Violation> {
    let mut relaxation = claim.file.relaxations.iter();
    let said = relaxation.find(|r| r.kind == ARRIVAL)?.amount;
    let Some(ClaimedMotion::Segments(segments)) = &claim.motion else {
        return None;
    };
    let end = segments.last()?.end().position;
    let straight = (claim.desired.end() - end).norm();
    let unsailed = claim.desired.length() - evaluation.length;
    let alone = claim.file.mission.alternatives.is_empty();
    let so = if alone { unsailed } else { straight };
    // Negated on purpose: a NaN is a mismatch.
    if !(said > 0.0 && (near(said, so) || !alone && said >= so)) {
        let so = format!("{so} m{}", if alone { "" } else { " at least" });
        return Some(mismatch("relaxation of arrival, amount", said, so));
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

/// Distance along the profile at a time, metres; `None` outside the profile.
fn profile_at(profile: &[[f64; 2]], time: f64) -> Option<f64> {
    let piece = profile
        .windows(2)
        .find(|w| w[0][1] <= time && time <= w[1][1])?;
    let [from, to] = [piece[0], piece[1]];
    let share = (time - from[1]) / (to[1] - from[1]);
    Some(if share.is_nan() {
        to[0]
    } else {
        from[0] + share * (to[0] - from[0])
    })
}

/// Checks that the profile is the distance covered over time.
fn profile(claim: &Claim) -> Option<Violation> {
    let profile = &claim.file.path_time.as_ref()?.profile;
    let Some(ClaimedMotion::Segments(segments)) = &claim.motion else {
        return None;
    };
    let sailed = |time: f64| -> f64 {
        let way = |s: &Segment| s.speed * (time - s.start_time).clamp(0.0, s.duration);
        segments.iter().map(way).sum()
    };
    let Some([begin, at]) = profile.first() else {
        return Some(mismatch("path_time.profile", "nothing", "that of a motion"));
    };
    let start = segments.first().map_or(f64::NAN, |s| s.start_time);
    if !near(*at, start) {
        let said = format!("a start at {at} s");
        return Some(mismatch("path_time.profile", said, format!("{start} s")));
    }
    // The profile is linear between its points, and the covered distance between the joints of the
    // motion. They are equal if they are equal at both.
    let joints = segments.iter().map(Segment::end_time);
    let at_joints = joints.filter_map(|t| Some([profile_at(profile, t)?, t]));
    let mut points = profile.iter().copied().chain(at_joints);
    let wrong = points.find(|[s, t]| !near(*s - begin, sailed(*t)));
    if let Some([s, t]) = &wrong {
        let so = begin + sailed(*t);
        return Some(Violation {
            time: *t,
            ..mismatch(
                "path_time.profile",
                format!("{s} m at {t} s"),
                format!("{so} m"),
            )
        });
    }
    let end = segments.last().map_or(f64::NAN, Segment::end_time);
    let last = profile.last().map_or(f64::NAN, |[_, t]| *t);
    (!near(last, end)).then(|| {
        mismatch(
            "path_time.profile",
            format!("an end at {last} s"),
            format!("{end} s"),
        )
    })
}
