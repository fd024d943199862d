//! Checks a simulation document alone: contacts and least distances from the motions in it.

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use super::claim::{ClaimError, fault};
use super::comparison::{Rounding, differences};
use super::mismatch;
use super::outcome::outcomes;
use searoom_document::{
    Alarm, GroundSegmentDocument, RelaxationKind, ReplanDocument, SIMULATION_FORMAT,
    SailedDocument, SailedLandDocument, SimulatedTargetDocument, SimulationDocument,
    SimulationsDocument, StateDocument, VerifiedOutcome,
};
use searoom_evaluation::{
    Body, MovingSlabs, Safety, Violation, least_land_distance, outcome_word, said_risk,
    without_rules,
};
use searoom_geometry::frame::{Pose, Vector, deg_from_radians, wrap};
use searoom_geometry::{ConvexPolygon, Polygon};
use searoom_model::target::Uncertainty;
use searoom_model::trajectory::GroundSegment;
use searoom_model::vessel::Hull;

/// Metres: a gap, or another least distance.
const DISTANCE_M: f64 = 1e-3;

/// Rounding of a cost, m².
const COST_ROUNDING_M2: f64 = 1e-6;

/// Radians: a turn at once.
const TURNED_RAD: f64 = 1e-6;

/// Degrees: the largest angle of an estimate.
const HALF_TURN_DEG: f64 = 180.0;

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
    /// Whether hulls met, and whether every plan was safe.
    pub fn outcome(&self) -> VerifiedOutcome {
        match (self.contact, self.safe) {
            (true, _) => VerifiedOutcome::Contact,
            (false, true) => VerifiedOutcome::Safe,
            (false, false) => VerifiedOutcome::NotSafe,
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
/// Plans are documents of their own. O(segments × targets).
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
    let sailed = document.sailed.iter().map(GroundSegmentDocument::segment);
    let sailed: Vec<GroundSegment> = sailed.collect();
    let mut violations = Vec::new();
    let is_valid = |s: &GroundSegment| s.track.is_valid() && s.crab.is_finite();
    // a plan that ends at once is not sailed
    let is_at_once = sailed.is_empty() && document.targets.is_empty() && document.duration_s == 0.0;
    if !sailed.iter().all(is_valid) || sailed.is_empty() && !is_at_once {
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
    if sailed.len() > 1
        && let Some(index) = sailed.iter().position(|s| !(s.track.duration > 0.0))
    {
        let what = format!("sailed: segment {index} lasts no time");
        violations.push(Violation::new(what, sailed[index].track.start_time));
    }
    // of all joints so far: each of many gaps may be a rounding, and together they are a motion
    let [mut jumps, mut lates, mut turns] = [0.0; 3];
    for (index, pair) in sailed.windows(2).enumerate() {
        let [before, after] = [pair[0].track, pair[1].track];
        jumps += (before.end().position - after.start.position).norm();
        lates += (before.end_time() - after.start_time).abs();
        let heading = pair[0].pose_at(before.end_time()).heading;
        turns += wrap(heading - pair[1].pose_at(after.start_time).heading).abs();
        // negated so that a NaN is a gap
        if !(lates <= TIME_S && jumps <= DISTANCE_M && turns <= TURNED_RAD) {
            let what = format!(
                "sailed: gaps of {jumps} m, {lates} s, {}° in all up to segment {}",
                deg_from_radians(turns),
                index + 1
            );
            violations.push(Violation::new(what, after.start_time));
            break;
        }
    }
    let covered = sailed.first().map_or(0.0, |s| s.track.start_time.abs())
        + (sailed.last().map_or(0.0, |s| s.track.end_time()) - document.duration_s).abs();
    if !(covered <= TIME_S * (1.0 + document.duration_s)) {
        violations.push(mismatch("sailed", "the whole duration", "another time"));
    }
    violations.extend(contradictions(document));
    violations.extend(impossible_numbers(document));
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
        let mut jumps = 0.0;
        for pair in track.windows(2) {
            jumps += (at(&pair[0], pair[1].at.t_s).position - pair[1].at.pose().position).norm();
            if !(pair[1].at.t_s > pair[0].at.t_s && jumps <= DISTANCE_M) {
                let what = format!("track of '{name}': gaps of {jumps} m in all");
                violations.push(Violation::new(what, pair[1].at.t_s));
                break;
            }
        }
        let least = least_distance(&sailed, &own, target);
        // a NaN is a contact, and what cannot be told apart is one
        let met = !(least > DISTANCE_M);
        if met != target.contact_t_s.is_some() {
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
        let same = met && claimed <= DISTANCE_M || (claimed - least).abs() <= DISTANCE_M;
        if !same {
            let what = format!("least distance from '{name}'");
            violations.push(mismatch(
                &what,
                format_args!("{claimed} m"),
                format_args!("{least} m"),
            ));
        }
        let then = distance_at(&sailed, &own, target, target.least_clearance_t_s);
        if same && !((claimed - then).abs() <= DISTANCE_M) {
            let what = format!("least distance from '{name}' at its time");
            violations.push(mismatch(
                &what,
                format_args!("{claimed} m"),
                format_args!("{then} m"),
            ));
        }
        if let Some(time) = target.contact_t_s
            && distance_at(&sailed, &own, target, time) > DISTANCE_M
        {
            let what = format!("contact with '{name}' at {time} s");
            violations.push(mismatch(&what, "a contact", "none"));
        }
        contact |= target.contact_t_s.is_some() || met;
        least_clearance = least_clearance.min(least);
    }
    if let Some(land) = &document.land {
        let least = land_distance(&sailed, &own, land);
        // a NaN is a contact, and what cannot be told apart is one
        let grounded = !(least > DISTANCE_M);
        if grounded != land.grounded {
            violations.push(mismatch("land.grounded", land.grounded, grounded));
        }
        let claimed = land.least_m.unwrap_or(f64::INFINITY);
        let touches = grounded && land.grounded && land.least_m.is_none_or(|m| m <= DISTANCE_M);
        let same = touches || claimed == least || (claimed - least).abs() <= DISTANCE_M;
        if !same {
            let (claimed, least) = (format!("{claimed} m"), format!("{least} m"));
            violations.push(mismatch("land.least_m", claimed, least));
        }
        contact |= land.grounded || grounded;
    }
    let is_safe = |replan: &ReplanDocument| replan.safe && replan.followed;
    let conduct = conduct_of(document);
    let within = conduct.within_tracking_margin && document.conduct.within_tracking_margin;
    let safe = !contact && within && document.replans.iter().all(is_safe);
    let claimed = Results {
        safe: document.safe,
        contact: document.contact,
        conduct: document.conduct.clone(),
    };
    let proven = Results {
        safe,
        contact,
        conduct,
    };
    violations.extend(differences(&claimed, &proven, &Rounding::new()));
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
    let at_its_time = (end - settings.duration_s).abs() <= TIME_S * (1.0 + end);
    let ends = match (document.interrupted, document.ends_short) {
        (true, false) => !document.arrived && end < settings.duration_s,
        (false, true) => !document.arrived && end < settings.duration_s,
        (false, false) => document.arrived || at_its_time,
        (true, true) => false,
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
    for target in &document.targets {
        let times = target
            .contact_t_s
            .into_iter()
            .chain([target.least_clearance_t_s, target.unknown_until_s]);
        require(
            times.into_iter().all(within),
            "a time outside the simulation",
            end,
        );
    }
    let mut last = 0.0;
    for (index, replan) in document.replans.iter().enumerate() {
        let due = last + settings.replan_s + settings.step_s;
        require(
            replan.t_s >= last && replan.t_s <= due.min(end) + TIME_S * (1.0 + end),
            "a plan at another time",
            replan.t_s,
        );
        last = replan.t_s;
        let left_out = replan.left_out_m;
        require(
            left_out >= 0.0 && left_out.is_finite(),
            "a plan that leaves out no length",
            last,
        );
        require(
            has_its_verdict(replan),
            "a plan with a verdict that does not fit what it gives up and whether it is safe",
            last,
        );
        let reasons = match index {
            0 => vec![ReplanDocument::START.to_owned()],
            _ => reasons(document, last),
        };
        let what = format!(
            "replans[{index}].reason: found '{}'; allowed: {}",
            replan.reason,
            reasons.join(", ")
        );
        require(reasons.contains(&replan.reason), &what, last);
        // a plan knows of the targets that own ship has seen
        let known = || known(document, last);
        let planned = replan.estimates.iter().map(|e| e.target.as_str());
        let of_others = !planned.eq(known().map(|t| t.name.as_str())) && end > 0.0;
        require(!of_others, "a plan for other targets", last);
        let starts = last..=last + settings.delay_s + TIME_S * (1.0 + end);
        require(
            starts.contains(&replan.start_t_s),
            "a plan that begins at another time",
            last,
        );
        let mut seen = replan.estimates.iter().zip(known());
        require(
            seen.all(|(seen, target)| {
                let there = target.at(last).map(|ship| ship.pose.position);
                let off = there.map(|there| (there - seen.true_position.point()).norm());
                off.is_some_and(|off| off <= DISTANCE_M)
            }),
            "a target that a plan has off its track",
            last,
        );
    }
    // the last plan ends within one period, or another would have been due
    let due = last + settings.replan_s + settings.delay_s + settings.step_s;
    let is_complete = !document.replans.is_empty() && end <= due + TIME_S * (1.0 + end);
    require(is_complete, "plans are missing", end);
    let first = document.replans.first();
    let from_start = first.is_some_and(|first| first.t_s == 0.0);
    require(from_start, "the first plan is missing", 0.0);
    let moves_ahead =
        |target: &SimulatedTargetDocument| target.track.iter().all(|s| s.speed_mps >= 0.0);
    require(
        document.targets.iter().all(moves_ahead),
        "a target that moves astern",
        0.0,
    );
    require(
        end <= settings.duration_s + TIME_S * (1.0 + end),
        "it lasts longer than its duration",
        end,
    );
    found
}

/// Results that follow from the motions, the plans and the alarms of a document.
#[derive(Serialize)]
struct Results {
    safe: bool,
    contact: bool,
    conduct: SailedDocument,
}

/// The conduct, with what follows from the plans and the alarms. The rest is taken as given.
fn conduct_of(document: &SimulationDocument) -> SailedDocument {
    let plans = |is_one: fn(&ReplanDocument) -> bool| {
        let replans = document.replans.iter();
        replans.filter(|replan| is_one(replan)).count()
    };
    let mut alarms = document.alarms.iter();
    let said = &document.conduct;
    // every field is named, so that a new one is not compared with itself unseen
    SailedDocument {
        without_plan: plans(|replan| replan.cost_m2.is_none()),
        unsafe_plans: plans(|replan| replan.cost_m2.is_some() && !replan.safe),
        within_tracking_margin: !alarms.any(|alarm| alarm.alarm == Alarm::BeyondMargin),
        cost_m2: said.cost_m2,
        first_plan_cost_m2: said.first_plan_cost_m2,
        breaks: said.breaks.clone(),
        turns: said.turns,
        speed_changes: said.speed_changes,
        manoeuvres: said.manoeuvres.clone(),
        replaced_manoeuvres: said.replaced_manoeuvres,
        side_switches: said.side_switches,
        lost_remainders: said.lost_remainders,
        largest_off_plan_m: said.largest_off_plan_m,
        largest_off_plan_t_s: said.largest_off_plan_t_s,
    }
}

/// The targets that own ship has seen by a time, seconds.
fn known(
    document: &SimulationDocument,
    time: f64,
) -> impl Iterator<Item = &SimulatedTargetDocument> {
    let targets = document.targets.iter();
    targets.filter(move |target| target.unknown_until_s <= time)
}

/// Why a plan may be made at a time, seconds, after the first one.
fn reasons(document: &SimulationDocument, time: f64) -> Vec<String> {
    let mut reasons = vec![ReplanDocument::PERIOD.to_owned()];
    if document.settings.replan_on_events {
        let events = [ReplanDocument::ANOTHER_VELOCITY, ReplanDocument::ACQUIRED];
        reasons.extend(known(document, time).flat_map(|target| {
            let name = &target.name;
            events.map(|event| format!("{event}: {name}"))
        }));
        reasons.push(Alarm::BeyondMargin.to_string());
    }
    reasons
}

/// Numbers outside their range: costs, distances, ages, sizes and deviations below zero, and angles beyond half
/// a turn.
fn impossible_numbers(document: &SimulationDocument) -> Vec<Violation> {
    let mut found = Vec::new();
    let mut within = |time: f64, place: String, numbers: &[(&str, Option<f64>, f64, f64)]| {
        for (key, number, least, most) in numbers {
            // negated on purpose: a NaN is in no range
            if let Some(number) = number.filter(|number| !(*number >= *least && number <= most)) {
                let allowed = match most.is_finite() {
                    true => format!("from {least} to {most}"),
                    false => "a number that is not negative".to_owned(),
                };
                let what = format!("{place}{key}: found {number}; allowed: {allowed}");
                found.push(Violation::new(what, time));
            }
        }
    };
    let not_negative = |key, number: f64| (key, Some(number), 0.0, f64::INFINITY);
    // an integral of squares that is zero may have a sign by rounding
    let cost = |key, number: Option<f64>| (key, number, -COST_ROUNDING_M2, f64::INFINITY);
    let (settings, conduct) = (&document.settings, &document.conduct);
    within(
        0.0,
        String::new(),
        &[
            not_negative("to_go_m", document.to_go_m),
            not_negative("settings.current_std_mps", settings.current_std_mps),
            not_negative("settings.delay_s", settings.delay_s),
            cost("conduct.cost_m2", Some(conduct.cost_m2)),
            cost("conduct.first_plan_cost_m2", conduct.first_plan_cost_m2),
            not_negative("conduct.largest_off_plan_m", conduct.largest_off_plan_m),
        ],
    );
    for (index, replan) in document.replans.iter().enumerate() {
        let place = format!("replans[{index}].");
        let numbers = [
            not_negative("off_plan_m", replan.off_plan_m),
            cost("cost_m2", replan.cost_m2),
        ];
        within(replan.t_s, place.clone(), &numbers);
        for (index, seen) in replan.estimates.iter().enumerate() {
            let numbers = [
                not_negative("age_s", seen.age_s),
                not_negative("speed_mps", seen.speed_mps),
                not_negative("length_m", seen.length_m),
                not_negative("beam_m", seen.beam_m),
                not_negative("position_std_m", seen.position_std_m),
                not_negative("speed_spread_mps", seen.speed_spread_mps),
                (
                    "course_spread_deg",
                    Some(seen.course_spread_deg),
                    0.0,
                    HALF_TURN_DEG,
                ),
                (
                    "starboard_turn_deg",
                    Some(seen.starboard_turn_deg),
                    -HALF_TURN_DEG,
                    HALF_TURN_DEG,
                ),
            ];
            within(replan.t_s, format!("{place}estimates[{index}]."), &numbers);
        }
    }
    found
}

/// True where a plan with this cost, these relaxations and this safety may have its verdict.
fn has_its_verdict(replan: &ReplanDocument) -> bool {
    let given_up = &replan.relaxations;
    let has_plan = replan.cost_m2.is_some();
    let safeties: &[Option<Safety>] = match (has_plan, replan.safe) {
        (false, false) => &[None],
        (true, true) => &[Some(Safety::Safe)],
        (true, false) => &[Safety::AtRisk, Safety::Unsafe, Safety::Collides].map(Some),
        (false, true) => &[],
    };
    let risk = said_risk(&replan.verdict);
    let words = outcomes(has_plan, given_up.is_empty())
        .into_iter()
        .flat_map(|outcome| safeties.iter().map(move |safety| (outcome, *safety)))
        .map(|(outcome, safety)| outcome_word(outcome, safety, risk.unwrap_or(0.0)))
        .map(|word| without_rules(word, given_up.contains(&RelaxationKind::Compliance)));
    words.into_iter().any(|word| word == replan.verdict)
        && (!risk.is_some_and(|risk| risk > 0.0) || given_up.contains(&RelaxationKind::Risk))
}

/// The least distance of the hulls, metres. A set that is no polygon is everywhere.
fn least_distance(sailed: &[GroundSegment], own: &Hull, target: &SimulatedTargetDocument) -> f64 {
    let (track, own) = (&target.track, target.own_hull(*own));
    let mut least = f64::INFINITY;
    for (index, state) in track.iter().enumerate() {
        let until = track
            .get(index + 1)
            .map_or(f64::INFINITY, |next| next.at.t_s);
        let from = state.at.t_s;
        let there = state.at.pose();
        let velocity = ConvexPolygon::point(there.ahead() * state.speed_mps);
        let Some(outline) = target.outline(&there) else {
            return f64::NAN;
        };
        let set = MovingSlabs::new(&Uncertainty::constant(outline, velocity));
        let meanwhile =
            |s: &&GroundSegment| s.track.end_time() >= from && s.track.start_time <= until;
        let parts = sailed.iter().filter(meanwhile);
        let parts: Vec<GroundSegment> = parts.map(|s| s.part(from, until, from)).collect();
        let found = set.least_distance(&parts, Body::hull(&own)).value;
        // negated on purpose: a NaN stays
        if !(found >= least) && !least.is_nan() {
            least = found;
        }
    }
    least
}

/// The distance of the hulls at a time, metres; infinite where nothing was sailed then.
fn distance_at(
    sailed: &[GroundSegment],
    own: &Hull,
    target: &SimulatedTargetDocument,
    time: f64,
) -> f64 {
    let meanwhile =
        |s: &&GroundSegment| s.track.start_time <= time && time <= s.track.end_time() + TIME_S;
    let now = sailed.iter().filter(meanwhile);
    let now: Vec<GroundSegment> = now.map(|s| s.part(time, time, 0.0)).collect();
    least_distance(&now, own, target)
}

/// The least distance of own hull from the land of a document, metres. A piece that is no polygon is
/// everywhere.
fn land_distance(sailed: &[GroundSegment], own: &Hull, land: &SailedLandDocument) -> f64 {
    let ring = |ring: &Vec<[f64; 2]>| -> Vec<Vector> {
        ring.iter().map(|[x, y]| Vector::new(*x, *y)).collect()
    };
    let pieces = land
        .polygons_m
        .iter()
        .map(|piece| Polygon::new(&[ring(piece)]));
    match pieces.collect::<Result<Vec<Polygon>, _>>() {
        Ok(pieces) => least_land_distance(&pieces, sailed, own).0,
        Err(_) => f64::NAN,
    }
}

/// Where a target is that has kept its course and speed since a state.
fn at(state: &StateDocument, time: f64) -> Pose {
    let then = state.at.pose();
    let way = then.ahead() * (state.speed_mps * (time - state.at.t_s));
    Pose::new(then.position + way, then.heading)
}
