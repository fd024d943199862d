//! Checks a simulation document alone: contacts and least distances from the motions in it.

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::claim::{ClaimError, fault};
use super::mismatch;
use super::motion::segment;
use crate::document::{
    SIMULATION_FORMAT, SailedLandDocument, SimulatedTargetDocument, SimulationDocument,
    SimulationsDocument, StateDocument,
};
use crate::evaluation::{Body, MovingSlabs, Violation, least_land_distance};
use crate::frame::{Pose, Vector};
use crate::geometry::{ConvexPolygon, Polygon};
use crate::target::Uncertainty;
use crate::trajectory::Segment;
use crate::vessel::{Hull, VesselKind};

/// Metres beside the gaps of a motion that is given step by step.
const DISTANCE_M: f64 = 1e-3;

/// Standard deviations of a current that are not exceeded.
const CURRENT_SIGMAS: f64 = 6.0;

/// Fraction of its way by which a ship under forces may be off the course of its heading: it may even
/// go astern.
const DRIFT_SHARE: f64 = 2.0;

/// Fraction of its way by which a ship may be off the arc of its mean turn rate in a step.
const MEAN_SHARE: f64 = 0.05;

/// Seconds: a later time of the same distance.
const TIME_S: f64 = 1e-6;

/// Result of the check of a simulation document.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationVerification {
    /// Title of the scenario.
    pub scenario: String,
    /// True where hulls met, by the motions in the document.
    pub contact: bool,
    /// True without a contact, where every plan was safe and in time.
    pub safe: bool,
    /// Least distance of the hulls over all targets, metres; infinite without any.
    pub least_clearance: f64,
    /// All statements that the motions contradict.
    pub violations: Vec<Violation>,
}

impl SimulationVerification {
    /// How the simulation ended, in a word.
    pub fn outcome(&self) -> &'static str {
        if self.contact {
            "contact"
        } else {
            "no contact"
        }
    }
}

/// The kind of document that a text is. A list has no format of its own.
#[derive(Default, Deserialize)]
struct Kind {
    format: Option<String>,
    simulations: Option<IgnoredAny>,
}

impl Kind {
    fn of(text: &str) -> Self {
        serde_json::from_str(text).unwrap_or_default()
    }

    fn is_list(&self) -> bool {
        self.format.is_none() && self.simulations.is_some()
    }
}

/// True for the text of a simulation document, or of a list of them.
pub fn is_simulation(text: &str) -> bool {
    let kind = Kind::of(text);
    kind.is_list() || kind.format.as_deref() == Some(SIMULATION_FORMAT)
}

/// Checks the text of a simulation document, or of each in a list: that own ship's motion and the
/// targets' tracks are without a gap, and that contacts and least distances are those of the
/// motions.
///
/// A ship that was steered is given by a segment per step. The gap after a segment bounds by how
/// much a distance on it may differ. Plans are documents of their own. O(segments × targets).
pub fn verify_simulations(text: &str) -> Result<Vec<SimulationVerification>, ClaimError> {
    let documents = if Kind::of(text).is_list() {
        super::claim::parse::<SimulationsDocument>(text)?.simulations
    } else {
        vec![super::claim::parse(text)?]
    };
    if documents.is_empty() {
        return Err(ClaimError::at("simulations", "an empty list"));
    }
    let other = |d: &&SimulationDocument| d.format != SIMULATION_FORMAT;
    if let Some(other) = documents.iter().find(other) {
        return Err(fault("format", &other.format, SIMULATION_FORMAT));
    }
    Ok(documents.iter().map(verified).collect())
}

fn verified(document: &SimulationDocument) -> SimulationVerification {
    let sailed: Vec<Segment> = document.sailed.iter().map(segment).collect();
    let mut violations = Vec::new();
    if !sailed.iter().all(Segment::is_valid) || sailed.is_empty() {
        let what = "sailed: no motion of finite numbers and times that increase";
        violations.push(Violation::new(what.to_owned(), 0.0));
        // what was sailed is unknown
        return SimulationVerification {
            scenario: document.scenario.clone(),
            contact: true,
            safe: false,
            least_clearance: f64::NAN,
            violations,
        };
    }
    // what the motion leaves open on and after each segment, metres
    let share = if is_steered(document) {
        MEAN_SHARE
    } else {
        0.0
    };
    let within = sailed.iter().map(|s| share * s.speed * s.duration);
    let mut gaps: Vec<f64> = within.collect();
    for (index, pair) in sailed.windows(2).enumerate() {
        let jump = (pair[0].end().position - pair[1].start.position).norm();
        gaps[index] += jump;
        let late = (pair[0].end_time() - pair[1].start_time).abs();
        // negated so that a NaN is a gap
        if !(late <= TIME_S && jump <= most_gap(document)) {
            let what = format!(
                "sailed: a gap of {jump} m, {late} s before segment {}",
                index + 1
            );
            violations.push(Violation::new(what, pair[1].start_time));
        }
    }
    // what the current does in the last step is in no gap
    if is_steered(document)
        && let Some(last) = gaps.last_mut()
    {
        *last += most_gap(document);
    }
    let covered = sailed.first().map_or(f64::NAN, |s| s.start_time.abs())
        + (sailed.last().map_or(f64::NAN, Segment::end_time) - document.duration_s).abs();
    if !(covered <= TIME_S * (1.0 + document.duration_s)) {
        violations.push(mismatch("sailed", "the whole duration", "another time"));
    }
    violations.extend(contradictions(document));
    let own = Hull::new(document.settings.own_length_m, document.settings.own_beam_m);
    let (mut contact, mut least_clearance) = (false, f64::INFINITY);
    for target in &document.targets {
        let name = &target.name;
        let track = &target.track;
        if !(track.first().is_some_and(|state| state.at.t_s == 0.0)) {
            violations.push(mismatch(
                &format!("track of '{name}'"),
                "from 0 s",
                "from later",
            ));
        }
        for pair in track.windows(2) {
            let jump = (at(&pair[0], pair[1].at.t_s).position - pair[1].at.pose().position).norm();
            if !(pair[1].at.t_s > pair[0].at.t_s && jump <= DISTANCE_M) {
                let what = format!("track of '{name}': a gap of {jump} m");
                violations.push(Violation::new(what, pair[1].at.t_s));
            }
        }
        let (least, allowed) = least_distance((&sailed, &gaps), &own, target);
        // a NaN is a contact
        let met = !(least > 0.0);
        let near_touch = least.abs() <= allowed;
        // what cannot be told apart is a contact
        let met = met || near_touch;
        if met != target.contact_t_s.is_some() && !(near_touch && target.contact_t_s.is_some()) {
            let word = |met: bool| if met { "a contact" } else { "none" };
            let claimed = word(target.contact_t_s.is_some());
            violations.push(mismatch(
                &format!("contact with '{name}'"),
                claimed,
                word(met),
            ));
        }
        let claimed = target.least_clearance_m.unwrap_or(f64::NAN);
        // the depth of an overlap depends on where each step begins
        let same = met && claimed <= allowed || (claimed - least).abs() <= allowed;
        if !same {
            let what = format!("least distance from '{name}'");
            violations.push(mismatch(
                &what,
                format_args!("{claimed} m"),
                format_args!("{least} m"),
            ));
        }
        contact |= target.contact_t_s.is_some() || met;
        least_clearance = least_clearance.min(least);
    }
    if let Some(land) = &document.land {
        let (least, allowed) = land_distance((&sailed, &gaps), &own, land);
        // a NaN is a contact, and what cannot be told apart is one
        let grounded = !(least > allowed);
        let is_wrong = match land.grounded {
            true => least > 2.0 * allowed,
            false => grounded,
        };
        if is_wrong {
            violations.push(mismatch("land.grounded", land.grounded, grounded));
        }
        let claimed = land.least_m.unwrap_or(f64::INFINITY);
        let touches = grounded && land.grounded && land.least_m.is_none_or(|m| m <= allowed);
        let same = touches || claimed == least || (claimed - least).abs() <= allowed;
        if !same {
            let (claimed, least) = (format!("{claimed} m"), format!("{least} m"));
            violations.push(mismatch("land.least_m", claimed, least));
        }
        contact |= land.grounded || grounded;
    }
    if contact != document.contact {
        violations.push(mismatch("contact", document.contact, contact));
    }
    let is_safe = |replan: &crate::document::ReplanDocument| replan.safe && replan.followed;
    let within = document.conduct.within_tracking_margin;
    let safe = !contact && within && document.replans.iter().all(is_safe);
    if safe != document.safe {
        violations.push(mismatch("safe", document.safe, safe));
    }
    violations.sort_by(|a, b| a.time.total_cmp(&b.time));
    SimulationVerification {
        scenario: document.scenario.clone(),
        contact,
        safe,
        least_clearance,
        violations,
    }
}

/// Statements of a document that contradict one another.
fn contradictions(document: &SimulationDocument) -> Vec<Violation> {
    let mut found = Vec::new();
    let mut require = |holds: bool, what: &str, time: f64| {
        if !holds {
            found.push(Violation::new(what.to_owned(), time));
        }
    };
    let (settings, end) = (&document.settings, document.duration_s);
    // own ship off its plan does not arrive at its end
    let is_off = !document.conduct.within_tracking_margin;
    let ends = match document.interrupted {
        true => !document.arrived && end < settings.duration_s,
        false => {
            document.arrived != document.ends_short
                || is_off
                || (end - settings.duration_s).abs() <= TIME_S * (1.0 + end)
        }
    };
    require(
        ends,
        "it ends neither at the arrival nor at its duration",
        end,
    );
    let hulls = [settings.own_length_m, settings.own_beam_m].into_iter();
    let hulls = hulls.chain(
        (document.targets.iter())
            .filter(|t| t.set_m.is_none())
            .flat_map(|t| [t.length_m, t.beam_m]),
    );
    require(
        hulls.into_iter().all(|size| size > 0.0),
        "a hull without size",
        0.0,
    );
    let has_land = document.land.is_some();
    require(
        has_land == settings.map,
        "land and its map, one without the other",
        0.0,
    );
    let within = |time: f64| (0.0..=end + TIME_S * (1.0 + end)).contains(&time);
    let nearest = document.land.iter().all(|land| within(land.least_t_s));
    require(nearest, "a time outside the simulation", end);
    let names: Vec<&str> = document.targets.iter().map(|t| t.name.as_str()).collect();
    for target in &document.targets {
        let times = target
            .contact_t_s
            .into_iter()
            .chain([target.least_clearance_t_s]);
        require(
            times.into_iter().all(within),
            "a time outside the simulation",
            end,
        );
    }
    let mut last = 0.0;
    for replan in &document.replans {
        let due = last + settings.replan_s + settings.step_s;
        require(
            replan.t_s <= due.min(end) + TIME_S * (1.0 + end),
            "a plan at another time",
            replan.t_s,
        );
        last = replan.t_s;
        let bad = ["NOT SAFE", "COLLIDES"].contains(&replan.verdict.as_str());
        require(
            !(bad && replan.safe),
            "a plan that is not safe and is said to be",
            last,
        );
        let planned: Vec<&str> = replan.estimates.iter().map(|e| e.target.as_str()).collect();
        require(planned == names, "a plan for other targets", last);
    }
    // the last plan ends within one period, or another would have been due
    let due = last + settings.replan_s + settings.delay_s + settings.step_s;
    let is_complete = !document.replans.is_empty() && end <= due + TIME_S * (1.0 + end);
    require(is_complete, "plans are missing", end);
    let unsafe_plans = document
        .replans
        .iter()
        .filter(|r| r.cost_m2.is_some() && !r.safe)
        .count();
    require(
        unsafe_plans == document.conduct.unsafe_plans,
        "another number of plans that are not safe",
        end,
    );
    found
}

/// True for a ship that does not follow its plan exactly.
fn is_steered(document: &SimulationDocument) -> bool {
    let settings = &document.settings;
    settings.vessel != "kinematic"
        || settings.current_mps != [0.0, 0.0]
        || settings.current_std_mps > 0.0
}

/// Gaps of a motion: none where own ship follows its plan, else what the current moves it in a
/// step, and what the mean of a step leaves out.
fn most_gap(document: &SimulationDocument) -> f64 {
    if is_steered(document) {
        let [east, north] = document.settings.current_mps;
        let drift = east.hypot(north) + CURRENT_SIGMAS * document.settings.current_std_mps;
        let fastest = document
            .sailed
            .iter()
            .map(|s| s.speed_mps)
            .fold(0.0, f64::max);
        let drifts = VesselKind::WORDS
            .iter()
            .any(|(word, _)| *word == document.settings.vessel);
        let share = if drifts { DRIFT_SHARE } else { MEAN_SHARE };
        (drift + share * fastest) * document.settings.step_s + DISTANCE_M
    } else {
        DISTANCE_M
    }
}

/// The least distance of the hulls, metres, and by how much it may differ where it is. A set that is
/// no polygon is everywhere.
fn least_distance(
    (sailed, gaps): (&[Segment], &[f64]),
    own: &Hull,
    target: &SimulatedTargetDocument,
) -> (f64, f64) {
    let (track, own) = (&target.track, target.own_hull(*own));
    let mut least = (f64::INFINITY, DISTANCE_M);
    for (index, state) in track.iter().enumerate() {
        let until = track
            .get(index + 1)
            .map_or(f64::INFINITY, |next| next.at.t_s);
        let from = state.at.t_s;
        let there = state.at.pose();
        let velocity = ConvexPolygon::point(there.ahead() * state.speed_mps);
        let Some(outline) = target.outline(&there) else {
            return (f64::NAN, DISTANCE_M);
        };
        let set = MovingSlabs::new(&Uncertainty::constant(outline, velocity));
        for (s, gap) in sailed.iter().zip(gaps) {
            if !(s.end_time() > from && s.start_time < until) {
                continue;
            }
            let part = s.between(from, until);
            let piece = Segment {
                start_time: part.start_time - from,
                ..part
            };
            let found = set.least_distance(&[piece], Body::hull(&own)).value;
            // negated on purpose: a NaN stays
            if !(found >= least.0) && !least.0.is_nan() {
                least = (found, gap + DISTANCE_M);
            }
        }
    }
    least
}

/// The least distance of own hull from the land of a document, metres, and by how much it may
/// differ. A piece that is no polygon is everywhere.
fn land_distance(
    (sailed, gaps): (&[Segment], &[f64]),
    own: &Hull,
    land: &SailedLandDocument,
) -> (f64, f64) {
    let ring = |ring: &Vec<[f64; 2]>| -> Vec<Vector> {
        ring.iter().map(|[x, y]| Vector::new(*x, *y)).collect()
    };
    let pieces = land
        .polygons_m
        .iter()
        .map(|piece| Polygon::new(&[ring(piece)]));
    let allowed = DISTANCE_M + gaps.iter().copied().fold(0.0, f64::max);
    match pieces.collect::<Result<Vec<Polygon>, _>>() {
        Ok(pieces) => (least_land_distance(&pieces, sailed, own).0, allowed),
        Err(_) => (f64::NAN, allowed),
    }
}

/// Where a target is that has kept its course and speed since a state.
fn at(state: &StateDocument, time: f64) -> Pose {
    let then = state.at.pose();
    let way = then.ahead() * (state.speed_mps * (time - state.at.t_s));
    Pose::new(then.position + way, then.heading)
}
