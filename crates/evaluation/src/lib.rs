#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

#[cfg(test)]
#[path = "../../geometry/src/geometry_fixtures.rs"]
mod geometry_fixtures;
#[cfg(test)]
#[path = "../../model/src/ship_fixtures.rs"]
mod ship_fixtures;

mod along;
mod cost;
mod distance;
mod land;
mod least;
mod met;
mod motion;
mod moving_set;
mod piece;
mod request;
mod safety;
mod sets;
mod steered;
mod turn;
mod words;

pub use cost::counted::counted_error_of_segments;
pub use cost::counted::{Counted, counted_error};
pub use cost::stage_cost::{StageWeights, stage_costs};
pub use distance::clearance::Body;
pub use distance::turned_hull::TurnedHull;
pub use distance::waypoints::ACCURACY_M as WAYPOINT_ACCURACY_M;
use distance::waypoints::waypoint_distances;
pub use least::Least;
pub use piece::Piece;
pub use request::{Freedom, Request};
pub use safety::Safety;
pub use sets::moving_ellipse::shape_rounding;
pub use sets::moving_slabs::MovingSlabs;
pub use sets::space_time_set::SpaceTimeSet;
pub use steered::{Steering, evaluate_steered};
pub use words::{
    CandidateOutcome, NOT_BY_THE_RULES, PlanOutcome, facts, outcome_word, skipped_waypoints,
    without_rules,
};
pub use words::{risk_figure, said_risk};

use land::LandBodies;
use met::passage;
use safety::{Claim, collision, grounding};
use turn::{Turn, turns};

use std::collections::HashMap;

use searoom_geometry::Polygon;
use searoom_geometry::frame::Side;
use searoom_geometry::tolerance;
use searoom_model::trajectory::{Segment, before_stay};
use searoom_model::vessel::Hull;
use searoom_parallel as parallel;

/// One violated requirement.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// Description of the violation: the quantity, the value found, and the allowed value.
    pub what: String,
    /// Time of the violation, seconds.
    pub time: f64,
}

impl Violation {
    /// A violation at a time, seconds.
    pub fn new(what: String, time: f64) -> Self {
        Self { what, time }
    }
}

/// Encounter of own ship with one target along the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Least distance between own hull and the target's nominal hull, metres; negative in overlap.
    /// For explicit sets: distance from own position to the set.
    pub dcpa: f64,
    /// Time of the closest approach, seconds.
    pub tcpa: f64,
    /// Side of own ship on which the target lies at `tcpa`. Dead ahead and astern, to
    /// [`tolerance::DEPTH_M`], count as starboard.
    pub passing_side: Side,
    /// Least distance between own hull and any hull that the target may have, metres; negative in
    /// overlap. For explicit sets: distance from own position to the set.
    pub min_clearance: f64,
    /// Like `min_clearance`, but after the end of the motion, with own ship at rest at its final
    /// pose.
    pub hold_clearance: f64,
    /// First time after the end of the motion, until the horizon, at which the nominal target meets
    /// own hull where it lies, seconds. Nothing is claimed of it: own ship is free to move.
    pub met_at_rest: Option<f64>,
    /// Least signed distance to the set against which the plan was made, metres. Infinite for a
    /// target without a set.
    pub min_margin: f64,
    /// Time of `min_margin`, seconds.
    pub min_margin_time: f64,
}

/// Figures and violations of a plan, independent of the planner that found it.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// All violations; a plan is verified when this is empty.
    pub violations: Vec<Violation>,
    /// Safety from start to arrival.
    pub safety: Safety,
    /// Space-time error, docs/reference/theory.md section 7, m².
    pub space_time_error: f64,
    /// Time until which the space-time error is counted.
    pub counted: Counted,
    /// Eq. (30) read literally over the whole motion, m².
    pub arc_length_error: f64,
    /// Duration of the motion, seconds.
    pub duration: f64,
    /// Length of the motion, metres.
    pub length: f64,
    /// Arrival time minus desired end, seconds; NaN where no arrival is required.
    pub delay: f64,
    /// Least distance of the motion from each waypoint between the first and the last, metres, at
    /// most 0.01 m too large.
    pub waypoint_distances: Vec<f64>,
    /// Least clearance over all targets, metres; infinite without targets.
    pub min_clearance: f64,
    /// Like `min_clearance`, but over `arrival_hold` after the end of the motion, with own ship at
    /// rest at its final pose. It is reported, but it does not affect the verdict.
    pub hold_clearance: f64,
    /// Time after arrival that `hold_clearance` covers, seconds.
    pub arrival_hold: f64,
    /// Least distance between own hull and land, metres; infinite without land, negative on land.
    pub min_land_distance: f64,
    /// Time of `min_land_distance`, seconds.
    pub min_land_distance_time: f64,
    /// Encounters, one per target, in the scenario's order.
    pub passages: Vec<Passage>,
}

impl Evaluation {
    /// Returns true when the independent check found no violation.
    pub fn verified(&self) -> bool {
        self.violations.is_empty()
    }

    /// Returns true when no hard set, hull or land is entered from start to arrival.
    pub fn safe(&self) -> bool {
        self.safety == Safety::Safe
    }
}

/// Evaluates a trajectory of lines and arcs.
///
/// Checks
///
/// - start, joints, turning radius and speeds or paths, and arrival;
/// - every set in continuous time, to [`tolerance::DEPTH_M`];
/// - every hull that a target may have, independently of the sets;
/// - own hull against the edges of the land.
///
/// Distances are certified least values ([`tolerance::MARGIN_M`]). The
/// costs are integrated by a separate quadrature. A segment with a non-finite value is a violation,
/// and the figures are then NaN.
pub fn evaluate(request: &Request) -> Evaluation {
    let segments = request.segments;
    let mut violations = motion::check(request);
    let judged = !segments.is_empty() && segments.iter().all(Segment::is_valid);
    let sound = Safety::of_motion(judged && violations.is_empty());
    let segments = if judged { segments } else { &[] };
    let turns = turns(segments);
    let (passages, met) = meetings(request, segments, &turns, judged, &mut violations);
    let land_distance = land_distance(request, segments, &turns, judged, &mut violations);
    let end = segments.last().map_or(f64::NAN, Segment::end_time);
    let or_nan = |value: f64| if judged { value } else { f64::NAN };
    let lies = segments.first().map(|first| first.between(0.0, 0.0));
    let before = match request.stay {
        None => segments,
        Some(_) => match before_stay(request.desired, segments) {
            // it lies there from the start
            [] => lies.as_slice(),
            before => before,
        },
    };
    let arrival = before.last().map_or(f64::NAN, Segment::end_time);
    let (space_time_error, counted) =
        cost::counted::error_to_end(before, request.desired, request.time_weight);
    Evaluation {
        violations,
        safety: sound.max(met).max(Safety::of_land(&land_distance, request)),
        counted,
        space_time_error: or_nan(space_time_error),
        arc_length_error: or_nan(cost::arc_length_error(
            before,
            request.desired,
            request.time_weight,
        )),
        duration: end - segments.first().map_or(f64::NAN, |s| s.start_time),
        length: or_nan(segments.iter().map(Segment::length).sum()),
        delay: match request.freedom {
            Freedom::PathsToHorizon(_) | Freedom::LimitsWithoutArrival => f64::NAN,
            Freedom::Limits | Freedom::Paths(_) | Freedom::Any => {
                arrival - request.desired.duration()
            }
        },
        waypoint_distances: waypoint_distances(segments, request.desired),
        min_clearance: or_nan(least_of(&passages, |p| p.min_clearance)),
        hold_clearance: or_nan(least_of(&passages, |p| p.hold_clearance)),
        arrival_hold: request.arrival_hold,
        min_land_distance: or_nan(land_distance.value),
        min_land_distance_time: land_distance.time,
        passages,
    }
}

/// Least value of one figure over all encounters; infinite without any.
fn least_of(passages: &[Passage], figure: impl Fn(&Passage) -> f64) -> f64 {
    passages.iter().map(figure).fold(f64::INFINITY, f64::min)
}

/// Least signed distance to each set of a request along its segments, metres, certified. Minus
/// infinity where the search did not prove the value.
pub fn least_margins(request: &Request) -> Vec<f64> {
    let sets = request.sets.iter();
    sets.map(|set| set.least_distance(request.segments))
        .map(|least| match least.certified {
            true => least.value,
            false => f64::NEG_INFINITY,
        })
        .collect()
}

/// Evaluates every set and every target along a chain of pieces. Returns the encounters and the
/// worst safety; violations are added only if `judged` is true.
fn meetings<P: Piece>(
    request: &Request,
    pieces: &[P],
    turns: &[Turn],
    judged: bool,
    violations: &mut Vec<Violation>,
) -> (Vec<Passage>, Safety) {
    let margins = parallel::map(request.sets, |_, set| {
        set.judged(&format!("set of '{}'", set.name), pieces)
    });
    let mut by_name: HashMap<&str, Claim> = HashMap::new();
    for (set, (least, entered)) in request.sets.iter().zip(margins) {
        let claim = by_name.entry(&set.name).or_insert_with(Claim::new);
        claim.see(&least, entered.is_none(), set.from);
        violations.extend(entered.filter(|_| judged));
    }
    let mut worst = Safety::Safe;
    let mut passages = Vec::with_capacity(request.targets.len());
    let unclaimed = Claim::new();
    let found = parallel::map(request.targets, |_, target| {
        let claim = by_name.get(target.name.as_str()).unwrap_or(&unclaimed);
        passage(request, pieces, turns, target, claim)
    });
    for (target, (passage, clearance, safety)) in request.targets.iter().zip(found) {
        worst = worst.max(safety);
        // Explicit sets are already judged above, as sets.
        if judged && target.ship().is_some() {
            let label = format!("hull of '{}'", target.name);
            violations.extend(collision(&label, &clearance, tolerance::DEPTH_M));
        }
        passages.push(passage);
    }
    (passages, worst)
}

/// Least signed distance between a hull and land along a motion, metres, and when. It is negative
/// on land, infinite without land, and negatively infinite where it is not proven. O(edges log
/// edges), and O(polygons + log edges) per segment.
pub fn least_land_distance<P: Piece>(land: &[Polygon], motion: &[P], own: &Hull) -> (f64, f64) {
    let (body, reach) = (Body::hull(own), own.half_diagonal());
    let least = LandBodies::new(land).least_distance(motion, body, reach);
    let value = match least.certified {
        true => least.value,
        false => f64::NEG_INFINITY,
    };
    (value, least.time)
}

/// Least distance to land along a chain of pieces. Violations are added only if `judged` is true.
fn land_distance<P: Piece>(
    request: &Request,
    pieces: &[P],
    turns: &[Turn],
    judged: bool,
    violations: &mut Vec<Violation>,
) -> Least {
    let own = &request.own.hull;
    let (body, reach) = (Body::hull(own), own.half_diagonal());
    let land = LandBodies::new(request.land);
    let mut least = land.least_distance(pieces, body, reach);
    for turn in turns {
        let here = land.least_distance(std::slice::from_ref(&turn.sweep), body, reach);
        least.see(here.value, turn.time);
        least.certified &= here.certified;
    }
    if judged {
        violations.extend(grounding(&least, request.land_margin));
    }
    least
}

#[cfg(test)]
mod tests;
