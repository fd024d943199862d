//! Clearances and safety of own ship with respect to one target.

use super::safety::{Claim, entered};
use super::{Passage, Request, Safety, TurnedHull};
use crate::distance::clearance::Body;
use crate::least::Least;
use crate::piece::{Piece, at_rest, end_of, since};
use crate::sets::moving_slabs::MovingSlabs;
use crate::turn::{Turn, least_while_turning};
use searoom_geometry::frame::{Pose, Side, cross, direction};
use searoom_geometry::tolerance;
use searoom_geometry::{ConvexSet, outer_enclosing_ellipse};
use searoom_model::target::{Motion, Representation, Target, TimedVelocitySet, Uncertainty};

/// Scales a ship's velocities by `1 - risk` about their centre. The centre is the centroid of the
/// polygon, or the centre of the smallest enclosing ellipse, according to the target's
/// representation.
fn at_risk(sets: &[TimedVelocitySet], target: &Target, risk: f64) -> Vec<TimedVelocitySet> {
    let scaled = |timed: &TimedVelocitySet| {
        let scaled = match (&timed.velocities, target.representation) {
            (ConvexSet::Polygon(set), Representation::Ellipsoid) => {
                let center = outer_enclosing_ellipse(set).center();
                let about = set.translated(-center).scaled(1.0 - risk);
                about.translated(center).into()
            }
            (set, _) => set.scaled_about_center(1.0 - risk),
        };
        TimedVelocitySet::new(timed.until, scaled)
    };
    sets.iter().map(scaled).collect()
}

/// Returns the encounter with a target, the least clearance that is judged, and the safety.
///
/// The judged clearance is the distance to every hull that the target may have at the accepted
/// risk, from the time at which its set becomes valid.
pub(super) fn passage<P: Piece>(
    request: &Request,
    pieces: &[P],
    turns: &[Turn],
    target: &Target,
    claim: &Claim,
) -> (Passage, Least, Safety) {
    let (margin, from) = (&claim.margin, claim.from);
    let lying = at_rest(pieces, request.arrival_hold);
    // the pieces of a document need not end in order
    let end = end_of(pieces).max(end_of(&lying));
    let (closest, worst, kept, hold, safety) = match &target.motion {
        Motion::Ship(ship) => {
            let body = Body::hull(&request.own.hull);
            let along = |slabs: &MovingSlabs, pieces: &[P], turns: &[Turn]| {
                let mut least = slabs.least_distance(pieces, body);
                let turning = least_while_turning(turns, body, slabs);
                least.see(turning.value, turning.time);
                least.certified &= turning.certified;
                least
            };
            // on each run of a known route the hull has the heading of the run
            let runs: Vec<_> = ship.runs().collect();
            let hull_until = |until: f64| {
                let begun = runs.iter().take_while(|(since, ..)| *since < until);
                let heading = begun
                    .last()
                    .map_or(ship.pose.heading, |(_, pose, _)| pose.heading);
                ship.hull.polygon(&Pose::new(ship.pose.position, heading))
            };
            let velocities = ship.nominal_velocities();
            let nominal = match velocities.len() {
                1 => MovingSlabs::new(&Uncertainty::new(hull_until(f64::INFINITY), velocities)),
                _ => MovingSlabs::growing(hull_until, &velocities, end),
            };
            let unknown = ship.outer_positions();
            let turned = |until: f64| {
                let hull = TurnedHull::of(ship, until).outer_polygon();
                hull.minkowski_sum(&unknown)
            };
            let velocities = ship.outer_velocity_sets(ship.turn_rate, request.horizon);
            let whole = MovingSlabs::growing(turned, &velocities, end);
            let worst = along(&whole, pieces, turns);
            let hold = whole.least_distance(&lying, body);
            let kept = if from > 0.0 || request.max_risk > 0.0 {
                let velocities = at_risk(&velocities, target, request.max_risk);
                let later = turns.iter().filter(|turn| turn.time >= from).copied();
                let later: Vec<Turn> = later.collect();
                let slabs = MovingSlabs::growing(turned, &velocities, end);
                along(&slabs, &since(pieces, from, 0.0), &later)
            } else {
                worst
            };
            let closest = along(&nominal, pieces, turns);
            let safety = claim.of_ship(request, [&closest, &worst], || {
                whole.least_distance(pieces, Body::POINT)
            });
            (closest, worst, kept, hold, safety)
        }
        Motion::Sets(sets) => {
            let slabs = MovingSlabs::until(sets, end);
            let least = slabs.least_distance(pieces, Body::POINT);
            let hold = slabs.least_distance(&lying, Body::POINT);
            // An explicit set is its hard set.
            let clear = || entered("", &slabs, pieces, &least).is_none();
            let safety = claim.of_hard_set(request, clear);
            (least, least, least, hold, safety)
        }
    };
    let passing_side = pieces
        .iter()
        .find(|s| closest.time <= s.end_time())
        // The closest approach is at the end of the motion, up to rounding.
        .or(pieces.last())
        .map_or(Side::Starboard, |s| {
            let pose = s.pose_at(closest.time);
            let off = target.position_at(closest.time) - pose.position;
            // Within this offset to port, rounding would decide the side.
            if cross(direction(pose.heading), off) > tolerance::DEPTH_M {
                Side::Port
            } else {
                Side::Starboard
            }
        });
    let passage = Passage {
        dcpa: closest.value,
        tcpa: closest.time,
        passing_side,
        min_clearance: worst.value,
        hold_clearance: hold.value,
        met_at_rest: pieces.last().and_then(|last| {
            let (end, hull) = (last.end_time(), &request.own.hull);
            let met = target.first_meets(hull, &last.pose_at(end), [end, request.horizon]);
            // who is met at the end is met by the motion
            met.filter(|time| *time > end)
        }),
        min_margin: margin.value,
        min_margin_time: margin.time,
    };
    (passage, kept, safety)
}
