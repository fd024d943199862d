//! Are the figures of a document those of its motion?

use super::claim::{ARRIVAL, Claim, ClaimedMotion};
use super::untrue;
use crate::evaluation::{Evaluation, Steering, Violation, stage_costs};
use crate::frame::Vector;
use crate::tolerance;
use crate::trajectory::{Node, Segment};

/// Costs, the mission's own figures and the path-time profile.
pub(super) fn check(claim: &Claim, evaluation: &Evaluation) -> Vec<Violation> {
    let mut found = Vec::new();
    let file = &claim.file;
    let mut same = |what: &str, said: Option<f64>, so: f64| {
        let so = so.is_finite().then_some(so);
        let agree = match (said, so) {
            (Some(said), Some(so)) => near(said, so),
            (said, so) => said.is_none() && so.is_none(),
        };
        if !agree {
            found.push(untrue(what, words(said), words(so)));
        }
    };
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
        found.push(untrue("cost", "nothing", "that of a motion"));
        return found;
    };
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
    same(
        "cost.min_clearance_m",
        cost.min_clearance_m,
        evaluation.min_clearance,
    );
    // what is not told of is not held against anything
    if cost.arrival_hold_s.is_some() || cost.hold_clearance_m.is_some() {
        same(
            "cost.hold_clearance_m",
            cost.hold_clearance_m,
            evaluation.hold_clearance,
        );
    }
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
    let arrives = !forces && !claim.gives_up_arrival();
    if cost.arrived != arrives {
        found.push(untrue("cost.arrived", cost.arrived, arrives));
    }
    // the document holds the land within reach, the nearest of the map may lie beyond
    let land = evaluation.min_land_distance;
    if let Some(said) = cost
        .min_land_distance_m
        .filter(|said| !(*said <= land || near(*said, land)))
    {
        found.push(untrue("cost.min_land_distance_m", said, land));
    }
    if let Some(said) = cost
        .min_land_distance_m
        .filter(|said| !(land.is_finite() && near(*said, land)))
    {
        let beyond = beyond_reach(claim);
        if !(said >= beyond || near(said, beyond)) {
            let so = format!("{land}, or of land beyond reach {beyond} at least");
            found.push(untrue("cost.min_land_distance_m", said, so));
        }
    }
    if cost.min_land_distance_m.is_none() && land.is_finite() {
        found.push(untrue("cost.min_land_distance_m", "nothing", land));
    }
    found.extend(profile(claim));
    found.extend(way_left(claim, evaluation));
    found
}

/// Of a plan that does not arrive: the way that it says to be left is no shorter than the straight
/// one, and on one path it is what has not been sailed.
fn way_left(claim: &Claim, evaluation: &Evaluation) -> Option<Violation> {
    let mut given_up = claim.file.relaxations.iter();
    let said = given_up.find(|r| r.kind == ARRIVAL)?.amount;
    let Some(ClaimedMotion::Segments(segments)) = &claim.motion else {
        return None;
    };
    let end = segments.last()?.end().position;
    let straight = (claim.desired.end() - end).norm();
    let unsailed = claim.desired.length() - evaluation.length;
    let alone = claim.file.mission.alternatives.is_empty();
    let so = if alone { unsailed } else { straight };
    // negated on purpose: a NaN is untrue
    if !(said > 0.0 && (near(said, so) || !alone && said >= so)) {
        let so = format!("{so} m{}", if alone { "" } else { " at least" });
        return Some(untrue("relaxation of arrival, amount", said, so));
    }
    None
}

/// Metres from own hull to land that a document does not hold, at least. It holds all that comes
/// into the square about the middle between start and end whose half side is half of the way that
/// she can sail, and her footprint.
fn beyond_reach(claim: &Claim) -> f64 {
    let own = &claim.own;
    let (start, end) = (own.pose.position, claim.desired.end());
    let way = (own.max_speed() * claim.file.horizon_s).max((end - start).norm());
    let middle = (start + end) * 0.5;
    let off = |p: Vector| (p - middle).abs().max();
    let farthest = match &claim.motion {
        // an arc is no farther from an end than half of its way
        Some(ClaimedMotion::Segments(segments)) => {
            let most = |s: &Segment| off(s.start.position).max(off(s.end().position)) + bulge(s);
            segments.iter().map(most).fold(0.0, f64::max)
        }
        // between two nodes within the distance of these
        Some(ClaimedMotion::Steered { motion, .. }) => {
            let nodes = motion.nodes().windows(2);
            let most = |w: &[Node]| {
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

/// The stage cost of a motion under forces: of those that rounding may make of it where a leg ends
/// at an instant of the sum, the one that is nearest to what is said.
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

/// Equal to [`tolerance::FIGURE`], relative above one.
pub(super) fn near(said: f64, so: f64) -> bool {
    (said - so).abs() <= tolerance::FIGURE * so.abs().max(1.0)
}

fn words(value: Option<f64>) -> String {
    value.map_or_else(|| "nothing".to_owned(), |v| format!("{v}"))
}

/// Metres along the profile at a time; `None` where it does not reach.
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

/// The profile is the way sailed over time.
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
        return Some(untrue("path_time.profile", "nothing", "that of a motion"));
    };
    let start = segments.first().map_or(f64::NAN, |s| s.start_time);
    if !near(*at, start) {
        let said = format!("a start at {at} s");
        return Some(untrue("path_time.profile", said, format!("{start} s")));
    }
    // between its own points the profile is straight, between the joints of the motion what is
    // sailed is: they are the same where they are so at both
    let joints = segments.iter().map(Segment::end_time);
    let at_joints = joints.filter_map(|t| Some([profile_at(profile, t)?, t]));
    let mut points = profile.iter().copied().chain(at_joints);
    let wrong = points.find(|[s, t]| !near(*s - begin, sailed(*t)));
    if let Some([s, t]) = &wrong {
        let so = begin + sailed(*t);
        return Some(Violation {
            time: *t,
            ..untrue(
                "path_time.profile",
                format!("{s} m at {t} s"),
                format!("{so} m"),
            )
        });
    }
    let end = segments.last().map_or(f64::NAN, Segment::end_time);
    let last = profile.last().map_or(f64::NAN, |[_, t]| *t);
    (!near(last, end)).then(|| {
        untrue(
            "path_time.profile",
            format!("an end at {last} s"),
            format!("{end} s"),
        )
    })
}
