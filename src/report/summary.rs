//! A run in the few figures that a navigator asks for first.

use crate::colregs::Role;
use crate::frame::{Side, deg_from_radians};
use crate::pipeline::Run;
use crate::planner::Outcome;
use crate::target::{ShipTrack, Target};
use crate::trajectory::{Steered, Trajectory};

/// Degrees. A smaller alteration is no turn: nobody would see it.
pub(super) const LEAST_TURN_DEG: f64 = 0.5;

/// Seconds between the positions among which the crossing of a track is looked for.
const CROSSING_STEP: f64 = 1.0;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// A plan that gives up nothing.
    Solved,
    /// A plan that gives something up.
    Relaxed,
    /// No plan.
    Infeasible,
    /// The budget ran out, with a plan or without.
    Deadline,
}

impl Verdict {
    /// How this run ended.
    pub fn of(run: &Run) -> Self {
        match run.planned.outcome {
            Outcome::Infeasible(_) => Self::Infeasible,
            Outcome::Deadline(_) => Self::Deadline,
            Outcome::Solved(_) if run.relaxations.is_empty() => Self::Solved,
            Outcome::Solved(_) => Self::Relaxed,
        }
    }

    /// The contract's word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Solved => "solved",
            Self::Relaxed => "relaxed",
            Self::Infeasible => "infeasible",
            Self::Deadline => "deadline",
        }
    }
}

/// An alteration of course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// To which side.
    pub side: Side,
    /// By how much, degrees, positive.
    pub degrees: f64,
}

impl Turn {
    /// The first alteration of a trajectory: arcs that follow each other to one side are one turn.
    pub fn first_of(trajectory: &Trajectory) -> Option<Self> {
        if let Some(motion) = trajectory.steered() {
            return Self::first_under_forces(motion);
        }
        let mut turn: Option<Self> = None;
        for segment in trajectory.segments() {
            let side = Side::of_turn(segment.turn_rate).filter(|_| segment.duration > 0.0);
            if let Some(done) = turn
                && side != Some(done.side)
            {
                if done.degrees >= LEAST_TURN_DEG {
                    return turn;
                }
                turn = None;
            }
            if let Some(side) = side {
                let before = turn.map_or(0.0, |turn| turn.degrees);
                let more = deg_from_radians((segment.turn_rate * segment.duration).abs());
                turn = Some(Self {
                    side,
                    degrees: before + more,
                });
            }
        }
        turn.filter(|turn| turn.degrees >= LEAST_TURN_DEG)
    }

    /// Of a motion under forces: from node to node, until the heading goes back.
    fn first_under_forces(motion: &Steered) -> Option<Self> {
        let mut turned = 0.0_f64;
        for pair in motion.nodes().windows(2) {
            let more = deg_from_radians(pair[1].pose.heading - pair[0].pose.heading);
            if turned.abs() >= LEAST_TURN_DEG && more * turned < 0.0 {
                break;
            }
            turned = if more * turned < 0.0 {
                more
            } else {
                turned + more
            };
        }
        let side = Side::of_turn(turned)?;
        (turned.abs() >= LEAST_TURN_DEG).then_some(Self {
            side,
            degrees: turned.abs(),
        })
    }
}

/// How one target was met.
#[derive(Debug, Clone, PartialEq)]
pub struct Meeting {
    /// Its name.
    pub target: String,
    /// Own ship's role, in the contract's word.
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
            meetings,
            targets: run.scenario.targets.len(),
            turn: trajectory.and_then(Turn::first_of),
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
}

/// True when own ship crosses the nominal target's centre line abaft her centre, false when ahead;
/// of several crossings the one nearest in time to `tcpa`.
fn cuts_astern(trajectory: &Trajectory, target: &Target, tcpa: f64) -> Option<bool> {
    let ship = target.ship()?;
    let seen = |ship: &ShipTrack, time: f64| {
        ship.pose_at(time)
            .body_coordinates(trajectory.pose_at(time).position)
    };
    let times = trajectory.sample_times(CROSSING_STEP);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Pose, Vector};
    use crate::trajectory::Segment;

    /// Degrees to starboard per segment of ten seconds.
    fn trajectory(turns: &[f64]) -> Trajectory {
        let mut start = Pose::new(Vector::zeros(), 0.3);
        let mut segments = Vec::new();
        for (index, degrees) in turns.iter().enumerate() {
            let segment = Segment {
                start,
                start_time: 10.0 * index as f64,
                duration: 10.0,
                speed: 5.0,
                turn_rate: -degrees.to_radians() / 10.0,
            };
            start = segment.end();
            segments.push(segment);
        }
        Trajectory::new(segments).expect("continuous")
    }

    #[test]
    fn the_first_turn_is_the_first_that_can_be_seen() {
        use Side::{Port, Starboard};
        for (turns, expected) in [
            (vec![0.0], None),
            (vec![0.2, 0.0, -0.3], None),
            (vec![0.0, 30.0, -60.0], Some((Starboard, 30.0))),
            (vec![-30.0, -15.0, 0.0, -5.0], Some((Port, 45.0))),
            (vec![0.1, -20.0], Some((Port, 20.0))),
            (vec![0.0, 40.0], Some((Starboard, 40.0))),
        ] {
            let found = Turn::first_of(&trajectory(&turns));
            let found = found.map(|turn| (turn.side, (turn.degrees * 1e6).round() / 1e6));
            assert_eq!(found, expected, "{turns:?}");
        }
    }
}
