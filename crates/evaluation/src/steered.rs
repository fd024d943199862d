//! Evaluates a motion under forces: checks the vessel dynamics and the clearances.

use super::{Evaluation, Request, Safety, Violation, land_distance, least_of, meetings};
use crate::cost::counted::counted_error_of_cubics;
use crate::cost::quadrature::smooth;
use crate::distance::waypoints::waypoint_distances;
use crate::motion::Report;
use crate::piece::Piece;
use searoom_geometry::frame::{Vector, wrap};
use searoom_geometry::tolerance;
use searoom_model::trajectory::{Cubic, DesiredTrajectory, ForceNode, Steered};
use searoom_model::vessel::{ForceVector, Manoeuvring, StateVector};

/// Initial number of integrator steps per interval; doubled until two results agree.
const FIRST_STEPS: usize = 8;
const MOST_STEPS: usize = 4096;

/// Largest difference of two results that agree, in the vessel's state units.
const AGREED: f64 = 1e-9;

/// Parts of a piece, each integrated by one quadrature rule.
const PARTS: usize = 4;

/// Motion under forces and the vessel that executes it.
#[derive(Debug, Clone, Copy)]
pub struct Steering<'a> {
    /// Nodes with forces.
    pub motion: &'a Steered,
    /// Published vessel model, not smoothed.
    pub vessel: &'a dyn Manoeuvring,
    /// Largest absolute surge force, sway force and yaw moment: newtons, newtons, newton metres.
    pub force_limits: ForceVector,
    /// Surge, sway and yaw rate at the start: m/s, m/s, rad/s.
    pub start_velocity: [f64; 3],
}

/// Evaluates a motion under forces over the whole horizon.
///
/// Checks
///
/// - that it starts at own ship's pose and ends at the horizon, with forces within their limits;
/// - that the vessel model, integrated from each node, reaches the next node to
///   [`tolerance::DEFECT`] in its state units;
/// - that the cubics between the nodes stay outside every set, to [`tolerance::DEPTH_M`], and
///   outside every hull, with certified distances.
///
/// Arrival is not required, so the delay is NaN. The space-time error is counted until the motion
/// is within own ship's length of the last waypoint ([`Counted`](super::Counted)).
/// `request.segments` is ignored.
pub fn evaluate_steered(request: &Request, steering: &Steering) -> Evaluation {
    let mut violations = check(request, steering);
    let pieces: Vec<Cubic> = steering.motion.pieces().collect();
    let sound = Safety::of_motion(violations.is_empty());
    let (passages, met) = meetings(request, &pieces, &[], true, &mut violations);
    let land_distance = land_distance(request, &pieces, &[], true, &mut violations);
    let length = steering.motion.length();
    let nodes = steering.motion.nodes();
    let within = request.own.hull.length;
    let (space_time_error, counted) =
        counted_error_of_cubics(&pieces, request.desired, request.time_weight, within);
    Evaluation {
        violations,
        safety: sound.max(met).max(Safety::of_land(&land_distance, request)),
        space_time_error,
        arc_length_error: arc_length_error(&pieces, request.desired, request.time_weight),
        counted,
        duration: nodes[nodes.len() - 1].time - nodes[0].time,
        length,
        delay: f64::NAN,
        waypoint_distances: waypoint_distances(&pieces, request.desired),
        min_clearance: least_of(&passages, |p| p.min_clearance),
        hold_clearance: least_of(&passages, |p| p.hold_clearance),
        arrival_hold: request.arrival_hold,
        min_land_distance: land_distance.value,
        min_land_distance_time: land_distance.time,
        passages,
    }
}

/// Checks start, end, forces and dynamics.
fn check(request: &Request, steering: &Steering) -> Vec<Violation> {
    let nodes = steering.motion.nodes();
    let (first, last) = (&nodes[0], &nodes[nodes.len() - 1]);
    let own = request.own;
    let mut found = Report {
        time: last.time,
        ..Report::default()
    };
    let (off, allowed) = (last.time - request.horizon, 1.0 + request.horizon);
    let allowed = tolerance::TIME_S * allowed;
    found.limit("end time", "s from the horizon", off.abs(), allowed);
    found.time = first.time;
    found.limit("start time", "s", first.time.abs(), tolerance::TIME_S);
    let gap = (first.pose.position - own.pose.position).norm();
    found.limit("start position", "m from own ship", gap, tolerance::JOINT_M);
    let turn = wrap(first.pose.heading - own.pose.heading);
    let unit = "rad from own ship's";
    found.limit("start heading", unit, turn.abs(), tolerance::JOINT_RAD);
    let [surge, sway, yaw_rate] = steering.start_velocity;
    let speed = (first.velocity - Vector::new(surge, sway)).norm();
    let speed = speed + (first.yaw_rate - yaw_rate).abs();
    let allowed = tolerance::LIMIT * own.speed.max(1.0);
    found.limit("start velocity", "m/s from own ship's", speed, allowed);
    let scales = steering.vessel.scales();
    for (index, pair) in nodes.windows(2).enumerate() {
        let (from, to) = (&pair[0], &pair[1]);
        let force = force(from);
        found.time = from.time;
        let axes = [
            ("surge force", "N"),
            ("sway force", "N"),
            ("yaw moment", "Nm"),
        ];
        for (axis, (name, unit)) in axes.into_iter().enumerate() {
            let allowed = steering.force_limits[axis] * (1.0 + tolerance::LIMIT);
            let what = format!("{name} in interval {index}");
            found.limit(&what, unit, force[axis].abs(), allowed);
        }
        let reached = integrated(steering.vessel, &state(from), &force, to.time - from.time);
        let off = (reached - state(to)).component_div(&scales.state);
        // The maximum norm would lose a NaN.
        let finite = off.sum().is_finite();
        let off = if finite { off.amax() } else { f64::NAN };
        found.time = to.time;
        let what = format!("vessel state off the plan after interval {index}");
        found.limit(&what, "of its units", off, tolerance::DEFECT);
    }
    found.violations
}

/// Forces from a node until the next one.
pub(super) fn force(node: &ForceNode) -> ForceVector {
    ForceVector::new(node.force.x, node.force.y, node.moment)
}

pub(super) fn state(node: &ForceNode) -> StateVector {
    let place = node.pose.position;
    StateVector::new(
        place.x,
        place.y,
        node.pose.heading,
        node.velocity.x,
        node.velocity.y,
        node.yaw_rate,
    )
}

/// State after `duration` seconds under a constant force. Midpoint rule with Richardson
/// extrapolation (Gragg, Bulirsch and Stoer) over doubled numbers of steps, until two results agree
/// to [`AGREED`].
fn integrated(
    vessel: &dyn Manoeuvring,
    from: &StateVector,
    force: &ForceVector,
    duration: f64,
) -> StateVector {
    let unit = vessel.scales().state;
    let mut row: Vec<StateVector> = Vec::new();
    let mut steps = FIRST_STEPS;
    loop {
        let mut next = vec![modified_midpoint(vessel, from, force, duration, steps)];
        for (order, before) in row.iter().enumerate() {
            let weight = 4f64.powi(order as i32 + 1) - 1.0;
            let better = next[order] + (next[order] - before) / weight;
            next.push(better);
        }
        let (last, best) = (row.last().copied(), next[next.len() - 1]);
        let agreed = last.is_some_and(|last| (best - last).component_div(&unit).amax() <= AGREED);
        if agreed || steps >= MOST_STEPS {
            return best;
        }
        row = next;
        steps *= 2;
    }
}

/// Gragg's modified midpoint rule with an even number of `steps`. Its error expansion has only even
/// powers of the step.
fn modified_midpoint(
    vessel: &dyn Manoeuvring,
    from: &StateVector,
    force: &ForceVector,
    duration: f64,
    steps: usize,
) -> StateVector {
    let h = duration / steps as f64;
    let mut before = *from;
    let mut here = from + h * vessel.rates(from, force);
    for _ in 1..steps {
        let after = before + 2.0 * h * vessel.rates(&here, force);
        (before, here) = (here, after);
    }
    0.5 * (here + before + h * vessel.rates(&here, force))
}

/// Space-time error of all pieces, docs/reference/theory.md section 7, m².
pub(super) fn space_time_error(pieces: &[Cubic], desired: &DesiredTrajectory, q: f64) -> f64 {
    let integral: f64 = pieces
        .iter()
        .map(|piece| {
            over_parts(piece, &|time| {
                desired.nearest(piece.pose_at(time).position, time, q).error
            })
        })
        .sum();
    integral / desired.duration()
}

/// Eq. (30) with each curve parametrised by the fraction of its own length, m²; NaN for a motion of
/// zero length.
fn arc_length_error(pieces: &[Cubic], desired: &DesiredTrajectory, q: f64) -> f64 {
    let speed = |piece: &Cubic, time: f64| Piece::velocity_at(piece, time).norm();
    let length_of = |piece: &Cubic| over_parts(piece, &|time| speed(piece, time));
    let length: f64 = pieces.iter().map(length_of).sum();
    // Negated on purpose: a NaN has no length either.
    if !(length > 0.0) {
        return f64::NAN;
    }
    let mut run = 0.0;
    let mut sum = 0.0;
    for piece in pieces {
        sum += over_parts(piece, &|time| {
            let way = smooth(piece.start_time, time, &|t| speed(piece, t));
            let along = (run + way) / length * desired.length();
            let legs = desired.legs();
            let index = legs.partition_point(|leg| leg.start_distance <= along);
            let leg = &legs[index.max(1) - 1];
            let there = leg.start + leg.direction * (along - leg.start_distance);
            let due = leg.start_time + (along - leg.start_distance) / leg.speed;
            let apart = piece.pose_at(time).position - there;
            (apart.norm_squared() + q * (time - due) * (time - due)) * speed(piece, time) / length
        });
        run += length_of(piece);
    }
    sum
}

fn over_parts(piece: &Cubic, value: &dyn Fn(f64) -> f64) -> f64 {
    let at = |k: usize| piece.start_time + piece.duration * k as f64 / PARTS as f64;
    (0..PARTS)
        .map(|k| smooth(at(k), at(k + 1), &|time| value(time)))
        .sum()
}
