//! The JSON documents of the contract, sections 3 and 5: mirrors of what is written, nothing more.
//!
//! A number that is not finite is written as null. Keys of what does not exist yet are absent.

use serde::{Deserialize, Serialize};

use super::summary::Verdict;
use super::words;
use crate::frame::{Pose, Vector, clockwise_deg_per_s, course_deg_from_heading};
use crate::geometry::ConvexPolygon;
use crate::obstacle::PolytopeObstacle;
use crate::pipeline::{Relaxation, Run};
use crate::planner::{Outcome, Plan};
use crate::trajectory::Trajectory;

/// The name of the plan document's format.
pub const PLAN_FORMAT: &str = "searoom-plan/1";

/// The outcome of a file that is no scenario.
pub const UNREADABLE: &str = "unreadable";

/// The outcome of a run that ended in a fault of the program.
pub const INTERNAL_FAULT: &str = "internal-fault";

/// Seconds between two samples of a trajectory.
const SAMPLE_STEP: f64 = 1.0;

/// One plan, alone: everything that is needed to check it again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "the contract, section 3, says what each key means"
)]
pub struct PlanDocument {
    pub format: String,
    pub scenario: String,
    pub planner: String,
    pub search: String,
    pub compliance: String,
    pub objective: String,
    pub time_weight_m2_per_s2: f64,
    pub horizon_s: f64,
    pub own_ship: OwnShipDocument,
    pub mission: MissionDocument,
    pub land: Vec<Vec<[f64; 2]>>,
    pub outcome: String,
    /// Why there is no plan, or none that was finished.
    pub reason: Option<String>,
    pub relaxation: Option<RelaxationDocument>,
    /// All of what was given up, the most important first.
    pub relaxations: Vec<RelaxationDocument>,
    pub verified: bool,
    /// What the independent checker found wrong.
    pub violations: Vec<ViolationDocument>,
    pub cost: Option<CostDocument>,
    pub search_stats: SearchStatsDocument,
    pub timing: TimingDocument,
    pub trajectory: Option<TrajectoryDocument>,
    pub obstacles: Vec<ObstacleDocument>,
    pub encounters: Vec<EncounterDocument>,
}

/// A point of the plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct PositionDocument {
    pub east_m: f64,
    pub north_m: f64,
}

/// Own ship and her limits, in the keys of the scenario file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "the contract, section 1, says what each key means"
)]
pub struct OwnShipDocument {
    pub position: PositionDocument,
    pub course_deg: f64,
    pub speed_mps: f64,
    pub length_m: f64,
    pub beam_m: f64,
    pub turning_radius_m: f64,
    pub speeds_mps: Vec<f64>,
    pub safety_margin_m: f64,
}

/// The desired trajectory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "the contract, section 1, says what each key means"
)]
pub struct MissionDocument {
    pub waypoints: Vec<PositionDocument>,
    pub leg_speeds_mps: Vec<f64>,
    /// Desired end.
    pub duration_s: f64,
    pub length_m: f64,
}

/// Something that was given up.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "the contract, section 3, says what each key means"
)]
pub struct RelaxationDocument {
    pub kind: String,
    pub target: String,
    pub amount: f64,
    pub unit: String,
}

/// Something that the independent checker found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct ViolationDocument {
    pub what: String,
    pub t_s: Option<f64>,
}

/// The figures of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "the contract, section 3, says what each key means"
)]
pub struct CostDocument {
    pub objective: f64,
    pub space_time_error_m2: f64,
    pub space_time_error_arc_length_m2: f64,
    pub arrived: bool,
    pub duration_s: f64,
    pub length_m: f64,
    pub delay_s: f64,
    /// Zero for a plan that was found clear of its sets, null for one that was not.
    pub max_risk: Option<f64>,
    /// Null without targets.
    pub min_clearance_m: Option<f64>,
}

/// What the search did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct SearchStatsDocument {
    pub expanded: usize,
    pub generated: usize,
    pub edges_checked: usize,
}

/// The only figure that differs between two runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the name says it")]
pub struct TimingDocument {
    pub plan_s: f64,
}

/// A pose at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct StartDocument {
    pub t_s: f64,
    pub east_m: f64,
    pub north_m: f64,
    pub course_deg: f64,
}

/// A line or an arc; starboard turns are positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct SegmentDocument {
    pub start: StartDocument,
    pub duration_s: f64,
    pub speed_mps: f64,
    pub turn_rate_deg_per_s: f64,
}

/// A pose at a time, with the speed from then on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct SampleDocument {
    pub t_s: f64,
    pub east_m: f64,
    pub north_m: f64,
    pub course_deg: f64,
    pub speed_mps: f64,
}

/// A trajectory, exact and sampled: every second, and wherever a segment starts or ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct TrajectoryDocument {
    pub segments: Vec<SegmentDocument>,
    pub samples: Vec<SampleDocument>,
}

/// A convex set of positions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InitialSetDocument {
    /// `[east, north]`, counter-clockwise.
    pub vertices_m: Vec<[f64; 2]>,
}

/// A convex set of velocities.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VelocitySetDocument {
    /// `[east, north]`, counter-clockwise.
    pub vertices_mps: Vec<[f64; 2]>,
}

/// A space-time obstacle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "the contract, section 3, says what each key means"
)]
pub struct ObstacleDocument {
    pub name: String,
    pub valid_s: [f64; 2],
    pub initial_set: InitialSetDocument,
    pub velocity_set: VelocitySetDocument,
}

/// A target as it is met. Figures of the plan are null without one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "the contract, section 3, says what each key means"
)]
pub struct EncounterDocument {
    pub target: String,
    pub role: String,
    pub dcpa_m: Option<f64>,
    pub tcpa_s: Option<f64>,
    pub undisturbed_dcpa_m: Option<f64>,
    pub undisturbed_tcpa_s: Option<f64>,
    pub passing_side: Option<String>,
}

impl PlanDocument {
    /// The document of a run.
    pub fn of(run: &Run) -> Self {
        let scenario = &run.scenario;
        let verdict = Verdict::of(run);
        let relaxations: Vec<_> = run.relaxations.iter().map(relaxation).collect();
        Self {
            format: PLAN_FORMAT.to_owned(),
            scenario: scenario.title.clone(),
            planner: words::PLANNER.to_owned(),
            search: words::search(scenario.search).to_owned(),
            compliance: scenario.compliance.word().to_owned(),
            objective: words::OBJECTIVE.to_owned(),
            time_weight_m2_per_s2: scenario.time_weight,
            horizon_s: scenario.horizon,
            own_ship: own_ship(run),
            mission: mission(run),
            land: Vec::new(),
            outcome: verdict.word().to_owned(),
            reason: match &run.planned.outcome {
                Outcome::Infeasible(reason) => Some(reason.to_string()),
                Outcome::Deadline(_) => {
                    Some(format!("the budget of {} s ran out", scenario.deadline))
                }
                Outcome::Solved(_) => None,
            },
            relaxation: match verdict {
                Verdict::Relaxed => relaxations.first().cloned(),
                _ => None,
            },
            relaxations,
            verified: verified(run),
            violations: run
                .evaluation
                .iter()
                .flat_map(|evaluation| &evaluation.violations)
                .map(|violation| ViolationDocument {
                    what: violation.what.clone(),
                    t_s: finite(violation.time),
                })
                .collect(),
            cost: cost(run),
            search_stats: SearchStatsDocument {
                expanded: run.planned.stats.expanded,
                generated: run.planned.stats.generated,
                edges_checked: run.planned.stats.edges_checked,
            },
            timing: timing(run),
            trajectory: plan(run).map(|plan| trajectory(&plan.trajectory)),
            obstacles: run
                .obstacles
                .iter()
                .map(|set| obstacle(set, scenario.horizon))
                .collect(),
            encounters: encounters(run),
        }
    }
}

/// Many runs in one document.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "the contract, section 5, says what each key means"
)]
pub struct SuiteDocument {
    pub runs: Vec<SuiteRunDocument>,
    pub summary: SuiteSummaryDocument,
}

/// One run of a suite. Where there was none, `outcome` is [`UNREADABLE`] or [`INTERNAL_FAULT`], `error`
/// says why, and the keys that have no meaning are null.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "the contract, section 5, says what each key means"
)]
pub struct SuiteRunDocument {
    pub file: String,
    pub scenario: Option<String>,
    pub planner: Option<String>,
    pub outcome: String,
    pub error: Option<String>,
    pub verified: bool,
    pub cost: Option<CostDocument>,
    pub encounters: Vec<EncounterDocument>,
    pub targets: Option<usize>,
    pub timing: Option<TimingDocument>,
}

/// How many of which.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SuiteSummaryDocument {
    /// All of them: the sum of the six outcomes below.
    pub scenarios: usize,
    /// Plans that give up nothing.
    pub solved: usize,
    /// Plans that give something up.
    pub relaxed: usize,
    /// No plan.
    pub infeasible: usize,
    /// Budget ran out.
    pub deadline: usize,
    /// Files that are no scenario.
    pub unreadable: usize,
    /// Runs that ended in a fault of the program.
    pub internal_faults: usize,
    /// Plans in which the independent checker found nothing wrong.
    pub verified: usize,
}

impl SuiteDocument {
    /// The document of these runs, with their summary.
    pub fn of(runs: Vec<SuiteRunDocument>) -> Self {
        let ended = |word: &str| runs.iter().filter(|run| run.outcome == word).count();
        let summary = SuiteSummaryDocument {
            scenarios: runs.len(),
            solved: ended(Verdict::Solved.word()),
            relaxed: ended(Verdict::Relaxed.word()),
            infeasible: ended(Verdict::Infeasible.word()),
            deadline: ended(Verdict::Deadline.word()),
            unreadable: ended(UNREADABLE),
            internal_faults: ended(INTERNAL_FAULT),
            verified: runs.iter().filter(|run| run.verified).count(),
        };
        Self { runs, summary }
    }
}

impl std::fmt::Display for SuiteSummaryDocument {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let plural = if self.scenarios == 1 { "" } else { "s" };
        write!(
            f,
            "{} scenario{plural}: {} solved",
            self.scenarios, self.solved
        )?;
        for (count, name) in [
            (self.relaxed, "relaxed"),
            (self.infeasible, "infeasible"),
            (self.deadline, "out of time"),
            (self.unreadable, UNREADABLE),
            (self.internal_faults, "failed inside"),
        ] {
            if count > 0 {
                write!(f, ", {count} {name}")?;
            }
        }
        write!(f, "; {} verified", self.verified)
    }
}

impl SuiteRunDocument {
    /// The entry of a run.
    pub fn of(file: String, run: &Run) -> Self {
        Self {
            file,
            scenario: Some(run.scenario.title.clone()),
            planner: Some(words::PLANNER.to_owned()),
            outcome: Verdict::of(run).word().to_owned(),
            error: None,
            verified: verified(run),
            cost: cost(run),
            encounters: encounters(run),
            targets: Some(run.scenario.targets.len()),
            timing: Some(timing(run)),
        }
    }

    /// The entry of a file that gave no run.
    pub fn failed(file: String, outcome: &str, error: String) -> Self {
        Self {
            file,
            scenario: None,
            planner: None,
            outcome: outcome.to_owned(),
            error: Some(error),
            verified: false,
            cost: None,
            encounters: Vec::new(),
            targets: None,
            timing: None,
        }
    }
}

fn plan(run: &Run) -> Option<&Plan> {
    run.planned.outcome.plan()
}

fn verified(run: &Run) -> bool {
    run.evaluation.as_ref().is_some_and(|e| e.verified())
}

fn finite(value: f64) -> Option<f64> {
    // +0.0 turns a negative zero into zero
    value.is_finite().then_some(value + 0.0)
}

fn position(p: Vector) -> PositionDocument {
    PositionDocument {
        east_m: p.x + 0.0,
        north_m: p.y + 0.0,
    }
}

fn vertices(polygon: &ConvexPolygon) -> Vec<[f64; 2]> {
    let plain = |p: &Vector| [p.x + 0.0, p.y + 0.0];
    polygon.vertices().iter().map(plain).collect()
}

fn timing(run: &Run) -> TimingDocument {
    TimingDocument {
        plan_s: run.plan_time.as_secs_f64(),
    }
}

fn relaxation(given_up: &Relaxation) -> RelaxationDocument {
    match given_up {
        Relaxation::Domain { target, amount } => RelaxationDocument {
            kind: "domain".to_owned(),
            target: target.clone(),
            amount: *amount,
            unit: "m".to_owned(),
        },
    }
}

fn own_ship(run: &Run) -> OwnShipDocument {
    let own = &run.scenario.own_ship;
    OwnShipDocument {
        position: position(own.pose.position),
        course_deg: course_deg_from_heading(own.pose.heading),
        speed_mps: own.speed,
        length_m: own.hull.length,
        beam_m: own.hull.beam,
        turning_radius_m: own.turning_radius,
        speeds_mps: own.speeds.clone(),
        safety_margin_m: own.safety_margin,
    }
}

fn mission(run: &Run) -> MissionDocument {
    let desired = &run.scenario.desired;
    MissionDocument {
        waypoints: desired.waypoints().into_iter().map(position).collect(),
        leg_speeds_mps: desired.legs().iter().map(|leg| leg.speed).collect(),
        duration_s: desired.duration(),
        length_m: desired.length(),
    }
}

fn cost(run: &Run) -> Option<CostDocument> {
    let (plan, evaluation) = plan(run).zip(run.evaluation.as_ref())?;
    Some(CostDocument {
        objective: plan.cost,
        space_time_error_m2: evaluation.space_time_error,
        space_time_error_arc_length_m2: evaluation.arc_length_error,
        arrived: true,
        duration_s: evaluation.duration,
        length_m: evaluation.length,
        delay_s: evaluation.delay,
        // outside of a set the risk is zero; inside it is not computed
        max_risk: evaluation.verified().then_some(0.0),
        min_clearance_m: finite(evaluation.min_clearance),
    })
}

fn trajectory(trajectory: &Trajectory) -> TrajectoryDocument {
    let start = |pose: Pose, time: f64| StartDocument {
        t_s: time,
        east_m: pose.position.x + 0.0,
        north_m: pose.position.y + 0.0,
        course_deg: course_deg_from_heading(pose.heading),
    };
    TrajectoryDocument {
        segments: trajectory
            .segments()
            .iter()
            .map(|segment| SegmentDocument {
                start: start(segment.start, segment.start_time),
                duration_s: segment.duration,
                speed_mps: segment.speed,
                turn_rate_deg_per_s: clockwise_deg_per_s(segment.turn_rate),
            })
            .collect(),
        samples: trajectory
            .sample_times(SAMPLE_STEP)
            .into_iter()
            .map(|time| {
                let at = start(trajectory.pose_at(time), time);
                SampleDocument {
                    t_s: at.t_s,
                    east_m: at.east_m,
                    north_m: at.north_m,
                    course_deg: at.course_deg,
                    speed_mps: trajectory.segment_at(time).speed,
                }
            })
            .collect(),
    }
}

fn obstacle(set: &PolytopeObstacle, horizon: f64) -> ObstacleDocument {
    ObstacleDocument {
        name: set.name().to_owned(),
        valid_s: [0.0, horizon],
        initial_set: InitialSetDocument {
            vertices_m: vertices(set.initial()),
        },
        velocity_set: VelocitySetDocument {
            vertices_mps: vertices(set.velocity()),
        },
    }
}

fn encounters(run: &Run) -> Vec<EncounterDocument> {
    let passages = run.evaluation.as_ref().map(|e| e.passages.as_slice());
    run.scenario
        .targets
        .iter()
        .zip(&run.sets)
        .enumerate()
        .map(|(index, (target, sets))| {
            let passage = passages.and_then(|passages| passages.get(index));
            EncounterDocument {
                target: target.name.clone(),
                role: words::role(sets.encounter.role).to_owned(),
                dcpa_m: passage.and_then(|p| finite(p.dcpa)),
                tcpa_s: passage.and_then(|p| finite(p.tcpa)),
                undisturbed_dcpa_m: finite(sets.encounter.undisturbed_dcpa),
                undisturbed_tcpa_s: finite(sets.encounter.undisturbed_tcpa),
                passing_side: passage.map(|p| p.passing_side.to_string()),
            }
        })
        .collect()
}
