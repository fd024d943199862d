//! Encounter with each target, and the rules in words.

use searoom_document::{ConductDocument, EncounterDocument, RoleDocument, finite};

use crate::colregs::compliance::Monitor;
use crate::colregs::{Role, Situation};
use crate::pipeline::Run;
use crate::target::ShipTrack;
use crate::trajectory::Trajectory;

/// Time step in seconds for the search of a track crossing.
const CROSSING_STEP: f64 = 1.0;
const MOST_CROSSINGS: u32 = 1_000_000;

/// A compliance monitor in words.
pub(crate) struct MonitorWords {
    pub(crate) monitor: Monitor,
    name: &'static str,
    /// The fault of own ship, in the present tense.
    pub(crate) breaks: &'static str,
    /// The fault in the past tense, with TURN, HOLD and TIME in place of the limits.
    pub(crate) violated: &'static str,
}

pub(crate) const MONITORS: [MonitorWords; 6] = [
    MonitorWords {
        monitor: Monitor::Contact,
        name: "contact",
        breaks: "the hulls touch",
        violated: "did not keep the hulls apart",
    },
    MonitorWords {
        monitor: Monitor::CollisionCourse,
        name: "collision course",
        breaks: "holds a collision course until the hulls meet",
        violated: "held a collision course until the hulls met",
    },
    MonitorWords {
        monitor: Monitor::Crossing,
        name: "crossing",
        breaks: "in a crossing, alters too little or too late",
        violated: "did not turn TURN to starboard or halve its speed TIME",
    },
    MonitorWords {
        monitor: Monitor::HeadOn,
        name: "head-on",
        breaks: "head-on, turns to starboard too little or too late",
        violated: "did not turn TURN to starboard TIME",
    },
    MonitorWords {
        monitor: Monitor::Overtaking,
        name: "overtaking",
        breaks: "overtaking, alters too little or too late",
        violated: "did not turn TURN or halve its speed TIME",
    },
    MonitorWords {
        monitor: Monitor::StandOn,
        name: "stand-on",
        breaks: "does not stand on",
        violated: "did not hold its courseHOLD",
    },
];

/// Rules and monitors in words: a monitor has its name before its number, as in `overtaking (R5)`.
pub(crate) fn rules_in_words<'a>(broken: impl IntoIterator<Item = &'a str>) -> String {
    let word = |number: &str| match MONITORS.iter().find(|known| known.monitor.word() == number) {
        Some(known) => format!("{} ({number})", known.name),
        None => number.to_owned(),
    };
    broken.into_iter().map(word).collect::<Vec<_>>().join(", ")
}

/// The part of a headline that names what is broken; `None` where nothing is.
pub(crate) fn breaks_in_words<'a>(broken: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let words = rules_in_words(broken);
    (!words.is_empty()).then(|| format!("breaks {words}"))
}

/// Own ship's role toward a target in the words of a chart: its roles along the motion, or the one
/// on the desired trajectory in brackets. `None` without one.
pub(crate) fn chart_role(along: &[RoleDocument], desired: Role) -> Option<String> {
    let mut roles: Vec<&str> = along.iter().map(|state| state.role.word()).collect();
    roles.dedup();
    match roles.is_empty() {
        false => Some(format!("own ship: {}", roles.join(", "))),
        true => has_role(desired).then(|| format!("own ship: {desired} (desired)")),
    }
}

/// True for roles, not for other states.
pub(crate) fn has_role(role: Role) -> bool {
    !matches!(role, Role::None | Role::Static)
}

/// Lists every target of a run, in the order of the scenario. O(targets × seconds of the plan).
pub(crate) fn encounters(run: &Run) -> Vec<EncounterDocument> {
    let passages = run.evaluation.as_ref().map(|e| e.passages.as_slice());
    let trajectory = run.planned.outcome.plan().map(|plan| &plan.trajectory);
    let conduct = run.judged_compliance();
    (run.scenario.targets.iter().zip(&run.targets).enumerate())
        .map(|(index, (target, outcome))| {
            let passage = passages.and_then(|passages| passages.get(index));
            let peak = &outcome.peak;
            let encounter = &outcome.sets.encounter;
            let crossing = passage
                .zip(trajectory)
                .filter(|_| is_crossing(encounter.role));
            EncounterDocument {
                target: target.name.clone(),
                role: encounter.role,
                dcpa_m: passage.and_then(|p| finite(p.dcpa)),
                tcpa_s: passage.and_then(|p| finite(p.tcpa)),
                undisturbed_dcpa_m: finite(encounter.undisturbed_dcpa),
                undisturbed_tcpa_s: finite(encounter.undisturbed_tcpa),
                passing_side: passage.map(|p| p.passing_side),
                crosses_astern: crossing
                    .zip(target.ship())
                    .and_then(|((p, t), ship)| crosses_astern(t, ship, p.tcpa)),
                max_risk: peak.map(|peak| peak.risk),
                max_risk_t_s: peak.filter(|peak| peak.risk > 0.0).map(|peak| peak.time),
                met_at_rest_s: passage.and_then(|p| p.met_at_rest),
                conduct: (conduct.get(index))
                    .and_then(Option::as_ref)
                    .map(ConductDocument::of),
            }
        })
        .collect()
}

/// True for the roles in a crossing.
pub(crate) fn is_crossing(role: Role) -> bool {
    role.duties().situation == Some(Situation::Crossing)
}

/// True when own ship crosses the nominal target's centre line abaft its centre, false when ahead.
/// Among several crossings, the one nearest in time to `tcpa` counts.
pub(crate) fn crosses_astern(trajectory: &Trajectory, ship: &ShipTrack, tcpa: f64) -> Option<bool> {
    let relative = |ship: &ShipTrack, time: f64| {
        ship.pose_at(time)
            .body_coordinates(trajectory.pose_at(time).position)
    };
    let times = trajectory.sample_times(CROSSING_STEP, MOST_CROSSINGS);
    let mut nearest: Option<(f64, bool)> = None;
    for pair in times.windows(2) {
        let (a, b) = (relative(ship, pair[0]), relative(ship, pair[1]));
        if (a.y > 0.0) == (b.y > 0.0) {
            continue;
        }
        let fraction = a.y / (a.y - b.y);
        let ahead = a.x + fraction * (b.x - a.x);
        let away = (pair[0] + fraction * (pair[1] - pair[0]) - tcpa).abs();
        if nearest.is_none_or(|(best, _)| away < best) {
            nearest = Some((away, ahead < 0.0));
        }
    }
    nearest.map(|(_, astern)| astern)
}
