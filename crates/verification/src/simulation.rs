//! Checks a simulation document alone: contacts and least distances from the motions in it.

use std::collections::BTreeSet;

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use super::claim::{ClaimError, fault};
use super::comparison::{Rounding, differences};
use super::cycles::{Cycles, TIME_S, arrives};
use super::mismatch;
use super::outcome::outcomes;
use searoom_document::{
    Alarm, AlarmDocument, GroundSegmentDocument, ManoeuvreDocument, RelaxationKind, ReplanDocument,
    SIMULATION_FORMAT, SailedDocument, SailedLandDocument, SimulatedTargetDocument,
    SimulationDocument, SimulationsDocument, StateDocument, VerifiedOutcome, conduct_breaks,
};
use searoom_evaluation::{
    Body, MovingSlabs, Safety, Violation, least_land_distance, outcome_word, said_risk,
    without_rules,
};
use searoom_geometry::frame::{Pose, Vector, deg_from_radians, wrap};
use searoom_geometry::{ConvexPolygon, Polygon};
use searoom_model::SailedVessel;
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
    let cycles = Cycles::of(document);
    violations.extend(cycles.check());
    violations.extend(contradictions(document, &cycles));
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
    let targets = document.targets.iter();
    let claimed = Results {
        safe: document.safe,
        contact: document.contact,
        arrived: document.arrived,
        conduct: document.conduct.clone(),
        alarms: document.alarms.iter().filter_map(PlanAlarm::of).collect(),
        outside_sets: targets.clone().map(|target| target.outside_sets).collect(),
    };
    let proven = Results {
        safe,
        contact,
        arrived: arrived(document, &cycles, within),
        conduct,
        alarms: document.replans.iter().flat_map(alarms_of).collect(),
        outside_sets: targets
            .map(|target| outside_sets(document, &target.name))
            .collect(),
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
fn contradictions(document: &SimulationDocument, cycles: &Cycles) -> Vec<Violation> {
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
    let alarms = document.alarms.iter();
    let mut names = alarms.filter_map(|alarm| alarm.target.as_ref());
    let plans = document.replans.iter();
    let mut outside = plans.flat_map(|p| p.outside_velocities.iter().chain(&p.outside_places));
    let is_target = |name: &String| document.targets.iter().any(|t| t.name == *name);
    require(
        end == 0.0 || names.all(is_target) && outside.all(is_target),
        "a plan or an alarm that names no target",
        0.0,
    );
    for (index, replan) in document.replans.iter().enumerate() {
        let time = replan.t_s;
        let left_out = replan.left_out_m;
        require(
            left_out >= 0.0 && left_out.is_finite(),
            "a plan that leaves out no length",
            time,
        );
        require(
            has_its_verdict(replan),
            "a plan with a verdict that does not fit what it gives up and whether it is safe",
            time,
        );
        let reasons = match index {
            0 => vec![ReplanDocument::START.to_owned()],
            _ => reasons(document, index),
        };
        // the distance is that from a plan which has just taken effect
        let begins = |p: &ReplanDocument| p.followed && cycles.is_same(p.start_t_s, time);
        let begins = document.replans[..index].iter().any(begins);
        require(
            begins || replan.off_plan_m <= document.conduct.largest_off_plan_m,
            "a plan when own ship is farther off its plan than ever",
            time,
        );
        let what = format!(
            "replans[{index}].reason: found '{}'; allowed: {}",
            replan.reason,
            reasons.join(", ")
        );
        require(reasons.contains(&replan.reason), &what, time);
        // a plan knows of the targets that own ship has seen
        let known = || known(document, time);
        let planned = replan.estimates.iter().map(|e| e.target.as_str());
        let of_others = !planned.eq(known().map(|t| t.name.as_str())) && end > 0.0;
        require(!of_others, "a plan for other targets", time);
        let mut seen = replan.estimates.iter().zip(known());
        require(
            seen.all(|(seen, target)| {
                let there = target.at(time).map(|ship| ship.pose.position);
                let off = there.map(|there| (there - seen.true_position.point()).norm());
                off.is_some_and(|off| off <= DISTANCE_M)
            }),
            "a target that a plan has off its track",
            time,
        );
    }
    let conduct = &document.conduct;
    let plans = document.replans.len();
    let turns = document.replans.iter().filter(|p| p.turn_deg.is_some());
    require(
        conduct.lost_remainders.max(conduct.replaced_manoeuvres) <= plans
            && conduct.side_switches <= conduct.replaced_manoeuvres.min(turns.count()),
        "more plans with another manoeuvre, to the other side or without a remainder than there are",
        0.0,
    );
    let sailed = conduct.manoeuvres.iter();
    let times = sailed.flat_map(|m| [Some(m.departure.begins_s()), m.returns_s]);
    let mut times = times.flatten().chain([conduct.largest_off_plan_t_s]);
    require(
        times.all(within),
        "a time of the conduct outside the simulation",
        end,
    );
    let begins = conduct.manoeuvres.iter().map(|m| m.departure.begins_s());
    require(
        begins.is_sorted(),
        "manoeuvres in another order than that of time",
        0.0,
    );
    let largest = conduct.largest_off_plan_m;
    let is_off = largest > 0.0 || conduct.largest_off_plan_t_s == 0.0;
    require(
        is_off,
        "a time at which own ship is off its plan by nothing",
        0.0,
    );
    let plans = document.timing.plan_s.len();
    require(
        plans == document.replans.len(),
        "other times of planning than plans",
        0.0,
    );
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
    arrived: bool,
    conduct: SailedDocument,
    alarms: Vec<PlanAlarm>,
    /// Per target.
    outside_sets: Vec<usize>,
}

/// An alarm that a plan raises when it is made. That it is unsafe may name any target.
#[derive(Serialize)]
struct PlanAlarm {
    t_s: f64,
    alarm: Alarm,
    target: Option<String>,
}

impl PlanAlarm {
    fn of(alarm: &AlarmDocument) -> Option<Self> {
        let target = match alarm.alarm {
            Alarm::AnotherVelocity | Alarm::AnotherPlace => alarm.target.clone(),
            Alarm::NoPlan | Alarm::PlanTooLate | Alarm::UnsafePlan => None,
            _ => return None,
        };
        let (t_s, alarm) = (alarm.t_s, alarm.alarm);
        Some(Self { t_s, alarm, target })
    }
}

/// The alarms of a plan.
fn alarms_of(replan: &ReplanDocument) -> Vec<PlanAlarm> {
    let velocities = replan.outside_velocities.iter();
    let outside = velocities.map(|name| (Alarm::AnotherVelocity, Some(name)));
    let places = replan.outside_places.iter();
    let outside = outside.chain(places.map(|name| (Alarm::AnotherPlace, Some(name))));
    let of_plan = match (replan.cost_m2, replan.followed, replan.safe) {
        (None, ..) => Some(Alarm::NoPlan),
        (_, false, _) => Some(Alarm::PlanTooLate),
        (.., false) => Some(Alarm::UnsafePlan),
        _ => None,
    };
    let all = outside.chain(of_plan.map(|alarm| (alarm, None)));
    let alarm = |(alarm, target): (Alarm, Option<&String>)| PlanAlarm {
        t_s: replan.t_s,
        alarm,
        target: target.cloned(),
    };
    all.map(alarm).collect()
}

/// Number of plans that find a target outside the sets of the plan before, and of alarms that it is
/// outside those of a plan which begins.
fn outside_sets(document: &SimulationDocument, name: &String) -> usize {
    let is_outside = |p: &&ReplanDocument| {
        p.outside_velocities.contains(name) || p.outside_places.contains(name)
    };
    let is_left =
        |a: &&AlarmDocument| a.alarm == Alarm::OutsideSet && a.target.as_ref() == Some(name);
    document.replans.iter().filter(is_outside).count()
        + document.alarms.iter().filter(is_left).count()
}

/// True at the end of a plan to the last waypoint, no farther from it than off the plan; under
/// forces, within own length of it. A ship that was beyond its tracking margin may have been so at
/// the end, which is taken as given.
fn arrived(document: &SimulationDocument, cycles: &Cycles, within_margin: bool) -> bool {
    let off_plan = document.conduct.largest_off_plan_m + DISTANCE_M;
    match document.settings.vessel {
        SailedVessel::CyberShip2 => document.to_go_m <= document.settings.own_length_m,
        _ if !cycles.ends_at_last_waypoint() => false,
        _ => document.to_go_m <= off_plan && (within_margin || document.arrived),
    }
}

/// The conduct, with what follows from the plans, the alarms and the conduct toward each target. The
/// rest is taken as given.
fn conduct_of(document: &SimulationDocument) -> SailedDocument {
    let plans = |is_one: fn(&ReplanDocument) -> bool| {
        let replans = document.replans.iter();
        replans.filter(|replan| is_one(replan)).count()
    };
    let mut alarms = document.alarms.iter();
    let said = &document.conduct;
    let conducts = || document.targets.iter().map(|target| &target.conduct);
    let most = |of: fn(&ManoeuvreDocument) -> usize| {
        let manoeuvres = conducts().filter_map(|conduct| conduct.manoeuvre.as_ref());
        manoeuvres.map(of).max().unwrap_or(0)
    };
    let breaks: BTreeSet<&str> = conducts().flat_map(conduct_breaks).collect();
    let first = document.replans.first().filter(|first| arrives(first));
    // every field is named, so that a new one is not compared with itself unseen
    SailedDocument {
        without_plan: plans(|replan| replan.cost_m2.is_none()),
        unsafe_plans: plans(|replan| replan.cost_m2.is_some() && !replan.safe),
        within_tracking_margin: !alarms.any(|alarm| alarm.alarm == Alarm::BeyondMargin),
        cost_m2: said.cost_m2,
        first_plan_cost_m2: first.and_then(|first| first.cost_m2),
        breaks: breaks.into_iter().map(str::to_owned).collect(),
        turns: most(|manoeuvre| manoeuvre.turns),
        speed_changes: most(|manoeuvre| manoeuvre.speed_changes),
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

/// Why a plan after the first one may be made: for its period, or for an event that the document
/// has.
fn reasons(document: &SimulationDocument, index: usize) -> Vec<String> {
    let mut reasons = vec![ReplanDocument::PERIOD.to_owned()];
    if !document.settings.replan_on_events {
        return reasons;
    }
    let (before, replan) = (&document.replans[..index], &document.replans[index]);
    let raised = |kind: Alarm, name: Option<&String>| {
        let mut earlier = document
            .alarms
            .iter()
            .filter(|alarm| alarm.t_s <= replan.t_s);
        earlier.any(|a| a.alarm == kind && a.target.as_ref() == name)
    };
    let last = before.last().map_or(0.0, |plan| plan.t_s);
    // without a plan, or under forces, no set of the one before is remembered
    let is_remembered = document.settings.vessel != SailedVessel::CyberShip2
        && before.iter().any(|plan| plan.followed);
    for target in known(document, replan.t_s) {
        let name = &target.name;
        let mut outside = replan
            .outside_velocities
            .iter()
            .chain(&replan.outside_places);
        if outside.any(|other| other == name) || !is_remembered {
            reasons.push(format!("{}: {name}", ReplanDocument::ANOTHER_VELOCITY));
        }
        if target.unknown_until_s > last || raised(Alarm::Stale, Some(name)) {
            reasons.push(format!("{}: {name}", ReplanDocument::ACQUIRED));
        }
    }
    if raised(Alarm::BeyondMargin, None) {
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
