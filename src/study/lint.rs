//! Detection of what is probably wrong with a scenario, without planning: own ship among its
//! targets, impossible speeds, a mission that own ship cannot begin, targets that never matter,
//! missing ships and mirrored geometry.
//!
//! A finding is no fault: the scenario can be planned, and may be meant as it is.

mod mistakes;

use mistakes::mistakes;

use crate::document::{LintScenarioDocument, LintTargetDocument, Matters, finite};
use crate::frame::{Pose, Side, heading_of, relative_bearing};
use crate::obstacle::SpaceTimeObstacle;
use crate::pipeline::{TargetSets, planned_sets};
use crate::scenario::Scenario;
use crate::scenario::import::Declared;
use crate::target::{Motion, Target};
use crate::text::counted;
use crate::trajectory::Segment;

const INSTANTS: usize = 400;

/// Angle in radians (2°): a target closer to dead ahead or dead astern is on neither side.
const ON_NO_SIDE: f64 = std::f64::consts::PI / 90.0;

/// Checks a scenario for consistency, and against the declarations of its file. O(targets ×
/// instants).
pub fn lint(
    file: String,
    scenario: &Scenario,
    declared: &Declared,
    notes: Vec<String>,
) -> LintScenarioDocument {
    let targets = targets(scenario, &planned_sets(scenario));
    LintScenarioDocument {
        file,
        scenario: Some(scenario.title.clone()),
        error: None,
        findings: all(scenario, declared, &targets),
        targets,
        notes,
    }
}

/// The findings of [`lint`] alone: who is concerned, what was found, and what it probably means.
/// Many targets out of reach are one finding, without an examination of each. Those that the
/// scenario lists as such already are none.
pub fn findings(scenario: &Scenario, declared: &Declared) -> Vec<String> {
    let mut near = scenario.clone();
    near.set_aside_out_of_reach();
    let mut findings = all(scenario, declared, &targets(&near, &planned_sets(&near)));
    let distant = &near.out_of_reach.targets;
    if let (Some(first), true) = (distant.first(), scenario.out_of_reach.targets.is_empty()) {
        findings.push(format!(
            "{}, the first of them '{}': never matter, out of reach within the horizon",
            counted(distant.len(), "target"),
            first.name
        ));
    }
    findings
}

fn targets(scenario: &Scenario, sets: &[TargetSets]) -> Vec<LintTargetDocument> {
    let fastest = scenario.own_ship.max_speed();
    let start = scenario.own_ship.pose.position;
    let step = scenario.horizon / INSTANTS as f64;
    let targets = scenario.targets.iter().zip(sets);
    let checked = targets.map(|(target, sets)| {
        let (mut to_set, mut to_reach) = (f64::INFINITY, f64::INFINITY);
        for instant in 0..=INSTANTS {
            let time = step * instant as f64;
            let distance = |place| sets.hard.signed_distance(place, time).distance;
            to_reach = to_reach.min(distance(start) - fastest * time);
            // nothing is claimed after arrival
            if time <= scenario.desired.duration() {
                to_set = to_set.min(distance(scenario.desired.position_at(time)));
            }
        }
        let mut legs = scenario.desired.legs().iter();
        let is_met = legs.any(|leg| {
            let pose = Pose::new(leg.start, heading_of(leg.direction));
            let duration = leg.end_time() - leg.start_time;
            let along = Segment::straight(pose, leg.start_time, duration, leg.speed);
            sets.hard.first_contact(&along, 0.0).is_some()
        });
        // negated on purpose: a NaN matters
        let matters = if is_met || !(to_set > 0.0) {
            Matters::Meets
        } else if !(to_reach > (fastest + top_speed(target)) * step) {
            Matters::Clear
        } else {
            Matters::Never
        };
        LintTargetDocument {
            name: target.name.clone(),
            role: sets.encounter.role,
            undisturbed_dcpa_m: finite(sets.encounter.undisturbed_dcpa),
            undisturbed_tcpa_s: finite(sets.encounter.undisturbed_tcpa),
            to_set_m: finite(to_set),
            matters,
        }
    });
    checked.collect()
}

fn all(scenario: &Scenario, declared: &Declared, targets: &[LintTargetDocument]) -> Vec<String> {
    let mut findings = against_declared(scenario, declared);
    findings.extend(mistakes(scenario));
    for target in targets.iter().filter(|t| t.matters == Matters::Never) {
        findings.push(format!(
            "{}: never matters, out of reach within the horizon",
            target.name
        ));
    }
    let met = met_at_rest(scenario);
    let is_met = !met.is_empty();
    findings.extend(met);
    if scenario.targets.is_empty() && scenario.out_of_reach.targets.is_empty() {
        findings.push("no targets".to_owned());
    } else if !is_met
        && scenario.stay.is_none()
        && targets.iter().all(|t| t.matters != Matters::Meets)
    {
        findings.push(
            "no hard set in the way: with hulls alone own ship may keep to its route".to_owned(),
        );
    }
    findings
}

/// Targets that meet own ship where it lies, on their nominal motion, after it has arrived as its
/// mission says and before the horizon. The verdict of a plan says so for the arrival of the plan.
pub fn met_at_rest(scenario: &Scenario) -> Vec<String> {
    let desired = &scenario.desired;
    let last = desired
        .legs()
        .iter()
        .map(|leg| heading_of(leg.direction))
        .next_back();
    let lies = Pose::new(
        desired.end(),
        last.unwrap_or(scenario.own_ship.pose.heading),
    );
    // a plan keeps clear until the stay ends
    let ends = desired.duration().max(scenario.stay.unwrap_or(0.0));
    let time = [ends, scenario.horizon];
    let met = scenario.targets.iter().filter_map(|target| {
        let met = target.first_meets(&scenario.own_ship.hull, &lies, time)?;
        let name = &target.name;
        (met > time[0]).then(|| {
            let end = time[0];
            format!(
                "{name}: meets own ship at {met:.0} s where it lies after its mission, which ends at \
                 {end:.0} s"
            )
        })
    });
    met.collect()
}

/// Upper bound of the target's speed, m/s.
fn top_speed(target: &Target) -> f64 {
    match &target.motion {
        Motion::Ship(ship) => ship.greatest_speed() + ship.speed_half_width(),
        Motion::Sets(sets) => sets.top_speed(),
    }
}

fn against_declared(scenario: &Scenario, declared: &Declared) -> Vec<String> {
    let mut findings = Vec::new();
    let distant = &scenario.out_of_reach.targets;
    let found = scenario.targets.len() + distant.len();
    if let Some(ships) = declared.ships
        && ships != found
    {
        let what = if found < ships {
            "ships are missing"
        } else {
            "more ships than declared"
        };
        findings.push(format!("{what}: {ships} declared, {found} found"));
    }
    let planned_for = |index: &usize| !distant.iter().any(|target| target.index == *index);
    let sides = declared.sides.iter().enumerate();
    let sides = sides.filter(|(index, _)| planned_for(index));
    for (target, (_, stated)) in scenario.targets.iter().zip(sides) {
        let bearing = relative_bearing(&scenario.own_ship.pose, target.position_at(0.0));
        let off = bearing.abs().min(std::f64::consts::PI - bearing.abs());
        let side = if bearing > 0.0 {
            Side::Starboard
        } else {
            Side::Port
        };
        if let Some(stated) = stated
            && off > ON_NO_SIDE
            && side != *stated
        {
            findings.push(format!(
                "{}: declared to {stated}, found to {side}: mirrored?",
                target.name
            ));
        }
    }
    findings
}
