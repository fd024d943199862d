//! Parses and validates a plan document; the result has no invalid state.

use super::motion;
use super::sets;
use searoom_document::{
    InitialSetDocument, OwnShipDocument, PLAN_FORMAT, PlanDocument, PositionDocument,
    RelaxationKind, TargetDocument,
};
use searoom_evaluation::{SpaceTimeSet, StageWeights, Violation};
use searoom_geometry::Polygon;
use searoom_geometry::frame::{Pose, Vector, heading_from_course_deg, wrap};
use searoom_geometry::tolerance;
use searoom_input::Fault;
use searoom_input::text::short_numbers;
use searoom_model::PlannerKind;
use searoom_model::target::{Motion, ShipTrack, Target, TimedVelocitySet, Uncertainty};
use searoom_model::trajectory::{DesiredTrajectory, Segment, Steered};
use searoom_model::vessel::{ForceVector, Hull, OwnShip, VesselKind};

/// Metres; the least leg of a scenario file.
const SHORTEST_LEG_M: f64 = 1e-3;

/// Most legs of a target's known route.
const MOST_LEGS: usize = 12;

/// Most keys listed in the error for a document of another format.
const KEYS: usize = 5;

/// Reason why a text is not a plan document that can be checked: the field, what was found, and
/// what is allowed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct ClaimError(String);

impl ClaimError {
    pub(super) fn at(path: &str, reason: impl std::fmt::Display) -> Self {
        match path {
            // the whole document
            "." | "?" => Self(reason.to_string()),
            path => Self(format!("{path}: {reason}")),
        }
    }
}

/// Parses a document; the error names the field that is unreadable.
pub(super) fn parse<T: serde::de::DeserializeOwned>(text: &str) -> Result<T, ClaimError> {
    let mut json = serde_json::Deserializer::from_str(text);
    let file = serde_path_to_error::deserialize(&mut json).map_err(|error| unread(text, &error))?;
    json.end().map_err(|error| ClaimError::at(".", error))?;
    Ok(file)
}

/// Motion of a document.
#[derive(Debug, Clone)]
pub(super) enum ClaimedMotion {
    /// Lines and arcs, without prior validation.
    Segments(Vec<Segment>),
    /// Nodes with forces.
    Steered {
        motion: Steered,
        vessel: VesselKind,
        force_limits: ForceVector,
        /// Surge, sway and yaw rate at the start: m/s, m/s, rad/s.
        start_velocity: [f64; 3],
        weights: StageWeights,
    },
}

/// Content of a document.
#[derive(Debug)]
pub(super) struct Claim<'a> {
    pub file: &'a PlanDocument,
    pub planner: PlannerKind,
    pub own: OwnShip,
    pub desired: DesiredTrajectory,
    /// Paths to which own ship is restricted, if any.
    pub paths: Option<Vec<Vec<Vector>>>,
    pub targets: Vec<Target>,
    pub sets: Vec<SpaceTimeSet>,
    pub land: Vec<Polygon>,
    pub motion: Option<ClaimedMotion>,
    /// Contradictions between the parts of the document.
    pub faults: Vec<Violation>,
}

impl<'a> Claim<'a> {
    /// Returns true where the document reports that the plan gives up this.
    pub fn gives_up(&self, kind: RelaxationKind) -> bool {
        self.file.relaxations.iter().any(|r| r.kind == kind)
    }

    /// Returns true where the document reports that the plan does not arrive.
    pub fn gives_up_arrival(&self) -> bool {
        self.gives_up(RelaxationKind::Arrival)
    }

    /// Time after the end of the motion over which a clearance is reported, seconds.
    pub fn arrival_hold(&self) -> f64 {
        let cost = self.file.cost.as_ref();
        cost.map_or(0.0, |cost| cost.arrival_hold_s)
    }

    /// Validates a document; the error is the first field that is invalid.
    pub fn of(file: &'a PlanDocument) -> Result<Self, ClaimError> {
        if file.format != PLAN_FORMAT {
            return Err(fault("format", format!("'{}'", file.format), PLAN_FORMAT));
        }
        let planner = word("planner", &file.planner, PlannerKind::WORDS)?;
        positive("horizon_s", file.horizon_s)?;
        let hold = (file.cost.as_ref()).map_or(0.0, |cost| cost.arrival_hold_s);
        within("cost.arrival_hold_s", hold, 0.0, LONGEST_HOLD_S)?;
        within("max_risk", file.max_risk, 0.0, 1.0 - f64::EPSILON)?;
        not_negative("time_weight_m2_per_s2", file.time_weight_m2_per_s2)?;
        let own = own_ship(&file.own_ship)?;
        let mission = &file.mission;
        not_negative("mission.left_out_m", mission.left_out_m)?;
        if mission.left_out_m > 0.0 && mission.stay_until_s.is_some() {
            let allowed = "0 with stay_until_s: own ship stays at the last waypoint alone";
            return Err(fault("mission.left_out_m", mission.left_out_m, allowed));
        }
        let points = |path: &[PositionDocument]| path.iter().map(PositionDocument::point).collect();
        let waypoints: Vec<Vector> = points(&mission.waypoints);
        let speeds = mission.leg_speeds_mps.len();
        if speeds + 1 != waypoints.len() {
            let found = format!("{speeds} speeds for {} waypoints", waypoints.len());
            let allowed = "a speed for each leg";
            return Err(fault("mission.leg_speeds_mps", found, allowed));
        }
        let desired = DesiredTrajectory::new(&waypoints, &mission.leg_speeds_mps);
        let desired = desired.map_err(|e| {
            let allowed = "at least two waypoints, with a speed for each leg";
            fault("mission", format!("what makes no way ({e})"), allowed)
        })?;
        if let Some(stay) = mission.stay_until_s {
            within("mission.stay_until_s", stay, 0.0, file.horizon_s)?;
        }
        let paths = (planner == PlannerKind::PathTime).then(|| {
            let others = mission.alternatives.iter();
            let others = others.map(|path| points(path));
            std::iter::once(waypoints).chain(others).collect()
        });
        let targets = (file.targets.iter().enumerate())
            .map(|(index, t)| target(&format!("targets[{index}]"), t))
            .collect::<Result<Vec<_>, _>>()?;
        let names: Vec<_> = targets.iter().map(|t| (t.name.as_str(), ())).collect();
        for (index, relaxation) in file.relaxations.iter().enumerate() {
            let at = |key: &str| format!("relaxations[{index}].{key}");
            word(&at("target"), &relaxation.target, &names)?;
            not_negative(&at("amount"), relaxation.amount)?;
        }
        let (sets, mut faults) = sets::read(&file.obstacles, &file.relaxations, file.horizon_s)?;
        let land = (file.land.iter().enumerate())
            .map(|(index, ring)| {
                let ring: Vec<Vector> = ring.iter().copied().map(Vector::from).collect();
                Polygon::new(&[ring]).map_err(|e| fault(&format!("land[{index}]"), e, "a polygon"))
            })
            .collect::<Result<Vec<_>, _>>()?;
        let motion = motion::read(file, &mut faults)?;
        Ok(Self {
            planner,
            own,
            desired,
            paths,
            targets,
            sets,
            land,
            motion,
            faults,
            file,
        })
    }
}

/// Greatest speed of own ship at the start in m/s, equal to that of scenarios.
const FASTEST_MPS: f64 = 100.0;

/// Longest arrival hold in seconds, equal to that of scenarios.
const LONGEST_HOLD_S: f64 = 1e6;

/// Explains why a text was not parsed: invalid JSON, another kind of document, or a plan document
/// with a broken field.
fn unread(text: &str, error: &serde_path_to_error::Error<serde_json::Error>) -> ClaimError {
    let shape = |reason: String| ClaimError::at(&error.path().to_string(), reason);
    let document: serde_json::Value = match serde_json::from_str(text) {
        Ok(document) => document,
        Err(error) => {
            return shape(format!("found no JSON ({error}); allowed: a plan document"));
        }
    };
    let named = document.get("format").or(document.get("simulations"));
    match (document.as_object(), named) {
        (_, Some(_)) => shape(error.inner().to_string()),
        (Some(object), None) => {
            let keys: Vec<&str> = object.keys().take(KEYS).map(String::as_str).collect();
            let found = match keys.is_empty() {
                true => "none in an empty document".to_owned(),
                false => format!("none in a document with the keys {}", keys.join(", ")),
            };
            fault("format", found, PLAN_FORMAT)
        }
        (None, None) => shape("found no JSON object; allowed: a plan document".to_owned()),
    }
}

pub(super) fn fault(path: &str, found: impl std::fmt::Display, allowed: &str) -> ClaimError {
    let found = short_numbers(&found.to_string());
    ClaimError::at(path, format_args!("found {found}; allowed: {allowed}"))
}

/// The value of an allowed word.
fn word<T: Copy>(path: &str, found: &str, allowed: &[(&str, T)]) -> Result<T, ClaimError> {
    if let Some((_, value)) = allowed.iter().find(|(word, _)| *word == found) {
        return Ok(*value);
    }
    let words: Vec<&str> = allowed.iter().map(|(word, _)| *word).collect();
    let allowed = match words.is_empty() {
        true => "nothing".to_owned(),
        false => words.join(", "),
    };
    Err(fault(path, format!("'{found}'"), &allowed))
}

fn within(path: &str, value: f64, least: f64, most: f64) -> Result<f64, ClaimError> {
    if value >= least && value <= most {
        return Ok(value);
    }
    let allowed = if most.is_finite() {
        format!("a number from {least} to {most}")
    } else if least > 0.0 {
        "a positive number".to_owned()
    } else {
        "a number that is not negative".to_owned()
    };
    Err(fault(path, value, &allowed))
}

fn positive(path: &str, value: f64) -> Result<f64, ClaimError> {
    within(path, value, f64::MIN_POSITIVE, f64::INFINITY)
}

pub(super) fn not_negative(path: &str, value: f64) -> Result<f64, ClaimError> {
    within(path, value, 0.0, f64::INFINITY)
}

fn own_ship(own: &OwnShipDocument) -> Result<OwnShip, ClaimError> {
    let mut least = 0.0;
    for (index, speed) in own.speeds_mps.iter().enumerate() {
        let path = format!("own_ship.speeds_mps[{index}]");
        least = within(&path, *speed, least, f64::INFINITY)?;
    }
    if !(least > 0.0) {
        let allowed = "increasing speeds, the last one positive";
        return Err(fault("own_ship.speeds_mps", "no speed above 0", allowed));
    }
    not_negative("own_ship.land_margin_m", own.land_margin_m)?;
    Ok(OwnShip {
        pose: Pose::new(
            own.position.point(),
            heading_from_course_deg(own.course_deg),
        ),
        speed: within("own_ship.speed_mps", own.speed_mps, 0.0, FASTEST_MPS)?,
        hull: Hull::new(
            not_negative("own_ship.length_m", own.length_m)?,
            not_negative("own_ship.beam_m", own.beam_m)?,
        ),
        turning_radius: positive("own_ship.turning_radius_m", own.turning_radius_m)?,
        speeds: own.speeds_mps.clone(),
        safety_margin: not_negative("own_ship.safety_margin_m", own.safety_margin_m)?,
        tracking_margin: 0.0,
    })
}

/// A value read from the document, or the place at which it is wrong.
pub(super) fn placed<T>(path: &str, read: Result<T, Fault>) -> Result<T, ClaimError> {
    read.map_err(|wrong| {
        let path = match wrong.path.as_str() {
            "" => path.to_owned(),
            key => format!("{path}.{key}"),
        };
        fault(&path, wrong.found, &wrong.allowed)
    })
}

fn target(path: &str, target: &TargetDocument) -> Result<Target, ClaimError> {
    let motion = match (&target.ship, &target.initial_set) {
        (Some(ship), None) if target.velocity_sets.is_empty() => {
            let at = |key: &str| format!("{path}.ship.{key}");
            for (key, value) in [
                ("speed_mps", ship.speed_mps),
                ("length_m", ship.length_m),
                ("beam_m", ship.beam_m),
                ("position_std_m", ship.position_std_m),
                ("speed_std_mps", ship.speed_std_mps),
                ("course_std_deg", ship.course_std_deg),
                ("speed_spread_mps", ship.speed_spread_mps),
                ("turn_rate_deg_per_s", ship.turn_rate_deg_per_s),
                ("time_spread_s", ship.time_spread_s),
                ("cpa_limit_m", ship.cpa_limit_m),
            ] {
                not_negative(&at(key), value)?;
            }
            let course_spread = at("course_spread_deg");
            within(&course_spread, ship.course_spread_deg, 0.0, 180.0)?;
            let heading_spread = at("heading_spread_deg");
            within(
                &heading_spread,
                ship.heading_spread_deg.unwrap_or(0.0),
                0.0,
                180.0,
            )?;
            let turn = at("starboard_turn_deg");
            within(&turn, ship.starboard_turn_deg, -180.0, 180.0)?;
            let track = placed(&format!("{path}.ship"), ship.track())?;
            known_route(&at("route"), &track)?;
            Motion::Ship(track)
        }
        (None, Some(initial)) if !target.velocity_sets.is_empty() => {
            explicit(path, initial, target)?
        }
        _ => {
            let found = "neither a ship alone nor an initial set with velocity sets";
            return Err(fault(path, found, "one of the two"));
        }
    };
    Ok(Target {
        name: target.name.clone(),
        motion,
        representation: target.representation,
        status: target.status,
    })
}

/// A known route goes from place to place, and begins with the course and the speed of the ship.
fn known_route(path: &str, ship: &ShipTrack) -> Result<(), ClaimError> {
    let (found, most) = (ship.route.len(), MOST_LEGS);
    if found > most {
        let allowed = format!("at most {most}");
        return Err(fault(path, format!("{found} legs"), &allowed));
    }
    if !ship.route.is_empty() && (ship.turn_rate != 0.0 || ship.starboard_turn != 0.0) {
        let found = "a route of a ship that turns elsewhere too";
        return Err(fault(path, found, "no turn beside the route"));
    }
    let mut place = ship.pose.position;
    for (index, leg) in ship.route.iter().enumerate() {
        positive(&format!("{path}[{index}].speed_mps"), leg.speed)?;
        // negated on purpose: a NaN is no way
        if !((leg.to - place).norm() >= SHORTEST_LEG_M) {
            let found = "the place before it again";
            return Err(fault(
                &format!("{path}[{index}].to"),
                found,
                "another place",
            ));
        }
        place = leg.to;
    }
    let begun = ship.clone().with_route(ship.route.clone());
    let turned = wrap(begun.pose.heading - ship.pose.heading).abs();
    if turned <= tolerance::JOINT_RAD && begun.speed == ship.speed {
        return Ok(());
    }
    let found = "a first leg with another course or speed";
    Err(fault(path, found, "those of the ship"))
}

fn explicit(
    path: &str,
    initial: &InitialSetDocument,
    target: &TargetDocument,
) -> Result<Motion, ClaimError> {
    let initial = placed(&format!("{path}.initial_set"), initial.set())?;
    let mut velocities = Vec::new();
    for (index, timed) in target.velocity_sets.iter().enumerate() {
        let field = format!("{path}.velocity_sets[{index}]");
        let last = index + 1 == target.velocity_sets.len();
        if timed.until_s.is_none() != last {
            let (path, found) = (format!("{field}.until_s"), ["null", "a time"]);
            let found = found[usize::from(last)];
            return Err(fault(&path, found, "a time, and null for the last"));
        }
        let set = placed(&field, timed.set.set())?;
        if set.as_polygon().is_some() != initial.as_polygon().is_some() {
            return Err(fault(path, "a polygon with an ellipse", "sets of one kind"));
        }
        let until = timed.until_s.unwrap_or(f64::INFINITY);
        velocities.push(TimedVelocitySet::new(until, set));
    }
    let ends = std::iter::once(0.0).chain(velocities.iter().map(|timed| timed.until));
    if !ends.is_sorted_by(|before, after| before < after) {
        let path = format!("{path}.velocity_sets");
        let found = "ends that do not increase";
        return Err(fault(&path, found, "one set after another"));
    }
    Ok(Motion::Sets(Uncertainty::new(initial, velocities)))
}
