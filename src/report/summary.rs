//! A run in the few figures that a navigator asks for first.

use crate::colregs::Role;
use crate::document::alteration::first_alteration;
use crate::evaluation::{Safety, Tone, outcome};
use crate::frame::Side;
use crate::pipeline::{Run, Verdict};
use crate::target::{ShipTrack, Target};
use crate::trajectory::Trajectory;

/// Seconds between the positions among which the crossing of a track is looked for.
const CROSSING_STEP: f64 = 1.0;
const MOST_CROSSINGS: u32 = 1_000_000;

/// An alteration of course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// To which side.
    pub side: Side,
    /// By how much, degrees, positive.
    pub degrees: f64,
}

/// How one target was met.
#[derive(Debug, Clone, PartialEq)]
pub struct Meeting {
    /// Its name.
    pub target: String,
    /// Own ship's role, in the word of the documents.
    pub role: &'static str,
    /// Seconds at which own ship would come closest, undisturbed.
    pub undisturbed_tcpa: f64,
    /// Metres between the hulls then.
    pub undisturbed_dcpa: f64,
    /// Where the target lies at the closest approach of the plan; `None` without a plan.
    pub side: Option<Side>,
    /// Metres between the hulls at the closest approach of the plan.
    pub dcpa: Option<f64>,
    /// Seconds of the closest approach of the plan.
    pub tcpa: Option<f64>,
    /// In a crossing, on which side of the target her track is cut; `None` elsewhere, and where the
    /// track is not cut.
    pub cuts_astern: Option<bool>,
}

/// A run in a few figures. Figures of the plan are `None` without one.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// The scenario's title.
    pub title: String,
    /// How it ended.
    pub verdict: Verdict,
    /// What the independent checker found; `None` without a plan.
    pub verified: Option<bool>,
    /// What the plan enters from start to arrival; `None` without one.
    pub safety: Option<Safety>,
    /// Targets with a role, in order of undisturbed closest approach.
    pub meetings: Vec<Meeting>,
    /// Targets in all.
    pub targets: usize,
    /// The first alteration; `None` when there is none, or no plan.
    pub turn: Option<Turn>,
    /// Space-time error, m².
    pub space_time_error: Option<f64>,
    /// Arrival minus desired end, seconds.
    pub delay: Option<f64>,
    /// Least distance to any hull a target may have, metres; `None` without targets.
    pub clearance: Option<f64>,
    /// The largest risk along the plan, of any target; `None` without targets.
    pub max_risk: Option<f64>,
    /// Nodes expanded.
    pub expanded: usize,
    /// Wall-clock milliseconds of planning.
    pub milliseconds: f64,
}

impl Summary {
    /// The figures of a run. O(targets x seconds of the plan).
    pub fn of(run: &Run) -> Self {
        let trajectory = run.planned.outcome.plan().map(|plan| &plan.trajectory);
        let evaluation = run.evaluation.as_ref();
        let mut meetings: Vec<Meeting> = run
            .scenario
            .targets
            .iter()
            .zip(&run.sets)
            .enumerate()
            .filter(|(_, (_, sets))| sets.encounter.role != Role::None)
            .map(|(index, (target, sets))| {
                let passage = evaluation.and_then(|e| e.passages.get(index));
                Meeting {
                    target: target.name.clone(),
                    role: sets.encounter.role.name(),
                    undisturbed_tcpa: sets.encounter.undisturbed_tcpa,
                    undisturbed_dcpa: sets.encounter.undisturbed_dcpa,
                    side: passage.map(|p| p.passing_side),
                    dcpa: passage.map(|p| p.dcpa),
                    tcpa: passage.map(|p| p.tcpa),
                    cuts_astern: match sets.encounter.role {
                        Role::GiveWay | Role::StandOn | Role::BothGiveWay => passage
                            .zip(trajectory)
                            .and_then(|(p, t)| cuts_astern(t, target, p.tcpa)),
                        _ => None,
                    },
                }
            })
            .collect();
        meetings.sort_by(|a, b| a.undisturbed_tcpa.total_cmp(&b.undisturbed_tcpa));
        Self {
            title: run.scenario.title.clone(),
            verdict: Verdict::of(run),
            verified: evaluation.map(|e| e.verified()),
            safety: run.safety(),
            meetings,
            targets: run.scenario.targets.len(),
            turn: trajectory.and_then(first_alteration),
            space_time_error: evaluation.map(|e| e.space_time_error),
            delay: evaluation.map(|e| e.delay).filter(|delay| !delay.is_nan()),
            clearance: evaluation
                .map(|e| e.min_clearance)
                .filter(|clearance| clearance.is_finite()),
            max_risk: run
                .risks
                .iter()
                .map(|peak| peak.risk)
                .max_by(f64::total_cmp),
            expanded: run.planned.stats.expanded,
            milliseconds: run.plan_time.as_secs_f64() * 1e3,
        }
    }

    /// True of a plan that enters no hard set, hull or land from start to arrival; `None` without a plan.
    pub fn safe(&self) -> Option<bool> {
        self.safety.map(|safety| safety == Safety::Safe)
    }

    /// The word that people see for how it ended, and what it says.
    pub(super) fn outcome(&self) -> (String, Tone) {
        let risk = self.max_risk.unwrap_or(0.0);
        outcome(self.verdict.word(), self.safety, risk)
    }
}

/// True when own ship crosses the nominal target's centre line abaft her centre, false when ahead;
/// of several crossings the one nearest in time to `tcpa`.
fn cuts_astern(trajectory: &Trajectory, target: &Target, tcpa: f64) -> Option<bool> {
    let ship = target.ship()?;
    let seen = |ship: &ShipTrack, time: f64| {
        ship.pose_at(time)
            .body_coordinates(trajectory.pose_at(time).position)
    };
    let times = trajectory.sample_times(CROSSING_STEP, MOST_CROSSINGS);
    let mut nearest: Option<(f64, bool)> = None;
    for pair in times.windows(2) {
        let (a, b) = (seen(ship, pair[0]), seen(ship, pair[1]));
        if (a.y > 0.0) == (b.y > 0.0) {
            continue;
        }
        let share = a.y / (a.y - b.y);
        let ahead = a.x + share * (b.x - a.x);
        let away = (pair[0] + share * (pair[1] - pair[0]) - tcpa).abs();
        if nearest.is_none_or(|(best, _)| away < best) {
            nearest = Some((away, ahead < 0.0));
        }
    }
    nearest.map(|(_, astern)| astern)
}
