//! Plan document, see docs/documents.md.

pub(super) mod control;
pub(super) mod departure;
pub(super) mod legs;
pub(super) mod path_time;
pub(super) mod phases;
mod reasons;
pub(super) mod stay;

use control::{ControlDocument, control};
use path_time::{PathTimeDocument, path_time_document};
use phases::PhaseDocument;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::encounter::{EncounterDocument, encounters};
use super::memory::{MemoryDocument, PlannedManoeuvreDocument};
use super::out_of_reach::OutOfReachDocument;
use super::parts::{
    CostDocument, EscapeDocument, ImprovementDocument, LowerBoundDocument, MissionDocument,
    NodeDocument, ObstacleDocument, OwnShipDocument, PlanMethod, RelaxationDocument,
    SampleDocument, SearchStatsDocument, SegmentDocument, StartDocument, TimingDocument,
    TrajectoryDocument, ViolationDocument, position,
};
use super::targets::sets::vertices;
use super::targets::{TargetDocument, target};
use crate::evaluation::{Evaluation, Violation};
use crate::frame::{Pose, clockwise_deg, clockwise_deg_per_s, course_deg_from_heading, heading_of};
use crate::obstacle::{Obstacle, PeakRisk, SpaceTimeObstacle};
use crate::pipeline::{Relaxation, Run, Verdict};
use crate::planner::{Minimises, Objective, PLANNERS, Plan, planner_words};
use crate::scenario::Scenario;
use crate::tolerance;
use crate::trajectory::{Segment, Steered, Trajectory};
use departure::Departure;

/// Format name of the plan document.
pub const PLAN_FORMAT: &str = "searoom-plan/1";

/// Maximum size of a plan document in mebibytes; one with a hundred targets needs less than 1 MiB.
pub const PLAN_MEBIBYTES: u64 = 64;

/// Time step of a sampled trajectory in seconds, and the maximum number of samples besides its
/// joints.
const SAMPLE_STEP: f64 = 1.0;
const MOST_SAMPLES: u32 = 20_000;

/// Self-contained plan: everything needed to verify it again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PlanDocument {
    pub format: String,
    pub scenario: String,
    pub planner: String,
    pub search: String,
    /// Method that made the plan; null without one, absent in an old document.
    #[serde(default)]
    pub method: Option<PlanMethod>,
    pub compliance: String,
    #[serde(default)]
    pub thresholds: String,
    pub objective: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub risk_weight_m: Option<f64>,
    pub time_weight_m2_per_s2: f64,
    pub max_risk: f64,
    /// The present on the clock of the scenario file. All other times count from it.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub time_s: f64,
    pub horizon_s: f64,
    pub own_ship: OwnShipDocument,
    pub mission: MissionDocument,
    pub land: Vec<Vec<[f64; 2]>>,
    /// Number of the map's pieces that `land` holds, where it is an outer approximation of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub land_outer_of: Option<usize>,
    pub outcome: String,
    /// Empty in an old document.
    #[serde(default)]
    pub verdict: String,
    pub reason: Option<String>,
    pub relaxations: Vec<RelaxationDocument>,
    pub verified: bool,
    /// `None` in a document that does not say so, which `verify` rejects.
    #[serde(default)]
    pub safe: Option<bool>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_of_no_return_s: Option<Option<f64>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_bound: Option<LowerBoundDocument>,
    pub violations: Vec<ViolationDocument>,
    /// Input that the plan ignores and that bears on safety.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cautions: Vec<String>,
    /// Other input of the scenario's files that the plan ignores.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    pub cost: Option<CostDocument>,
    pub search_stats: SearchStatsDocument,
    pub timing: TimingDocument,
    pub trajectory: Option<TrajectoryDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub escape: Option<EscapeDocument>,
    #[serde(default)]
    pub departure: Option<Departure>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub manoeuvres: Vec<PlannedManoeuvreDocument>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub phases: Vec<PhaseDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory: Option<MemoryDocument>,
    pub targets: Vec<TargetDocument>,
    pub obstacles: Vec<ObstacleDocument>,
    pub encounters: Vec<EncounterDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub out_of_reach: Option<OutOfReachDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path_time: Option<PathTimeDocument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimal_control: Option<ControlDocument>,
}

impl PlanDocument {
    /// True where the document says that no hard set, hull or land is entered.
    pub fn is_safe(&self) -> bool {
        self.safe == Some(true)
    }

    /// Number of the scenario's targets, with those out of reach.
    pub fn all_targets(&self) -> usize {
        let listed = self.out_of_reach.as_ref();
        self.targets.len() + listed.map_or(0, |listed| listed.rows.len())
    }

    /// The document of a run before its verification: nothing is verified, and `violations` is empty.
    pub(crate) fn unverified(run: &Run) -> Self {
        let scenario = &run.scenario;
        let verdict = Verdict::of(run);
        let mut document = Self {
            format: PLAN_FORMAT.to_owned(),
            scenario: scenario.title.clone(),
            planner: scenario.planner.facts().name.to_owned(),
            search: scenario.search.word().to_owned(),
            method: run.planned.method(),
            compliance: scenario.compliance.word().to_owned(),
            thresholds: scenario.judged_by().name.to_string(),
            objective: objective(scenario).to_owned(),
            risk_weight_m: match scenario.objective {
                Objective::LengthRisk { weight } => Some(weight),
                _ => None,
            },
            time_weight_m2_per_s2: scenario.time_weight,
            max_risk: run.max_risk,
            time_s: scenario.time,
            horizon_s: scenario.horizon,
            own_ship: own_ship(run),
            mission: mission(run),
            land: run.land.pieces.iter().map(vertices).collect(),
            land_outer_of: run.land.simplified,
            outcome: verdict.word().to_owned(),
            verdict: run.word(),
            reason: run.reason(),
            relaxations: run.relaxations.iter().map(relaxation).collect(),
            verified: false,
            safe: Some(run.safe()),
            time_of_no_return_s: None,
            lower_bound: None,
            violations: Vec::new(),
            cautions: scenario.cautions(plan(run).map(|plan| &plan.trajectory)),
            notes: scenario.remarks.notes.clone(),
            cost: cost(run),
            search_stats: SearchStatsDocument::of(run.planned.stats),
            timing: timing(run),
            trajectory: plan(run).map(|plan| trajectory(&plan.trajectory)),
            escape: escape(run),
            departure: None,
            manoeuvres: run.planned.manoeuvres.iter().map(Into::into).collect(),
            phases: Vec::new(),
            memory: MemoryDocument::of(run),
            targets: scenario.targets.iter().map(target).collect(),
            obstacles: (run.targets.iter())
                .flat_map(|target| {
                    let from = target.released.unwrap_or(0.0);
                    obstacles(&target.obstacle, from, scenario.horizon)
                })
                .collect(),
            encounters: encounters(run),
            out_of_reach: OutOfReachDocument::of(scenario),
            path_time: (run.planned.path_time.as_deref())
                .map(|diagram| path_time_document(run, diagram)),
            optimal_control: control(run),
        };
        document.departure = document.departure_of_motion();
        document.phases = document.phases_of_motion();
        document
    }
}

/// Name of the minimised quantity.
pub(crate) fn objective(scenario: &Scenario) -> &'static str {
    match scenario.planner.facts().minimises {
        Minimises::Own(name) => name,
        Minimises::SpaceTimeError | Minimises::Objective => scenario.objective.word(),
    }
}

/// Names that `planner` may have.
pub(crate) fn planner_names() -> [&'static str; PLANNERS.len()] {
    planner_words().map(|(name, _)| name)
}

fn plan(run: &Run) -> Option<&Plan> {
    run.planned.outcome.plan()
}

pub(crate) fn finite(value: f64) -> Option<f64> {
    // adding +0.0 converts a negative zero to zero
    value.is_finite().then_some(value + 0.0)
}

pub(crate) fn violations(found: &[Violation]) -> Vec<ViolationDocument> {
    let document = |violation: &Violation| ViolationDocument {
        what: violation.what.clone(),
        t_s: finite(violation.time),
    };
    found.iter().map(document).collect()
}

pub(crate) fn timing(run: &Run) -> TimingDocument {
    let improvements = run.planned.improvements.iter();
    let improvements = improvements.map(|improvement| ImprovementDocument {
        after_s: improvement.after.as_secs_f64(),
        cost_m2: improvement.cost,
    });
    TimingDocument {
        plan_s: run.plan_time.as_secs_f64(),
        improvements: improvements.collect(),
    }
}

pub(crate) fn relaxation(relaxation: &Relaxation) -> RelaxationDocument {
    let (kind, target, amount, unit, until_s) = match relaxation {
        Relaxation::Domain { target, amount } => ("domain", target, *amount, "m", None),
        Relaxation::Risk {
            target,
            amount,
            until,
        } => ("risk", target, *amount, "1", *until),
        Relaxation::Arrival { target, amount } => ("arrival", target, *amount, "m", None),
        Relaxation::Compliance { target, .. } => ("compliance", target, 1.0, "1", None),
    };
    RelaxationDocument {
        kind: kind.to_owned(),
        target: target.clone(),
        amount,
        unit: unit.to_owned(),
        until_s,
    }
}

fn escape(run: &Run) -> Option<EscapeDocument> {
    let (escape, plan) = (run.planned.escape?, run.planned.outcome.plan()?);
    let held = |s: &&Segment| s.start_time < escape.held_until - tolerance::TIME_S;
    Some(EscapeDocument {
        policy: "stand-on-hold".to_owned(),
        held_until_s: escape.held_until,
        first_segment: plan.trajectory.segments().iter().take_while(held).count(),
        turn_deg: clockwise_deg(escape.turn),
        speed_mps: escape.speed,
    })
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
        tracking_margin_m: own.tracking_margin,
        land_margin_m: run.scenario.land.as_ref().map_or(0.0, |land| land.margin),
    }
}

fn mission(run: &Run) -> MissionDocument {
    let desired = &run.scenario.desired;
    MissionDocument {
        waypoints: desired.waypoints().into_iter().map(position).collect(),
        leg_speeds_mps: desired.legs().iter().map(|leg| leg.speed).collect(),
        duration_s: desired.duration(),
        length_m: desired.length(),
        left_out_m: 0.0,
        stay_until_s: run.scenario.stay,
        alternatives: (run.scenario.alternatives.iter())
            .map(|path| path.iter().copied().map(position).collect())
            .collect(),
    }
}

fn cost(run: &Run) -> Option<CostDocument> {
    let (plan, evaluation) = plan(run).zip(run.evaluation.as_ref())?;
    let minimised = minimised(&run.scenario, plan, evaluation);
    let (arrived, risks) = (run.arrives(), run.risks());
    Some(cost_of(evaluation, minimised, arrived, &risks))
}

/// Minimised quantity. Where it is a property of the motion, it is that of the evaluation: the
/// planner sums it in other coordinates, so the last digits differ.
pub(crate) fn minimised(scenario: &Scenario, plan: &Plan, evaluation: &Evaluation) -> f64 {
    match (scenario.planner.facts().minimises, scenario.objective) {
        (Minimises::Own(_), _) | (_, Objective::LengthRisk { .. }) => plan.cost,
        (_, Objective::SpaceTimeError) => evaluation.space_time_error,
        (_, Objective::Time) => evaluation.duration,
        (_, Objective::Length) => evaluation.length,
    }
}

pub(crate) fn cost_of(
    evaluation: &Evaluation,
    objective: f64,
    arrived: bool,
    risks: &[PeakRisk],
) -> CostDocument {
    CostDocument {
        objective,
        space_time_error_m2: evaluation.space_time_error,
        space_time_error_arc_length_m2: finite(evaluation.arc_length_error),
        space_time_error_until_s: evaluation.counted.until,
        arrived,
        duration_s: evaluation.duration,
        length_m: evaluation.length,
        delay_s: finite(evaluation.delay),
        waypoint_distances_m: evaluation.waypoint_distances.clone(),
        max_risk: risks.iter().map(|peak| peak.risk).fold(0.0, f64::max),
        min_clearance_m: finite(evaluation.min_clearance),
        hold_clearance_m: finite(evaluation.hold_clearance),
        arrival_hold_s: evaluation.arrival_hold,
        min_land_distance_m: finite(evaluation.min_land_distance),
    }
}

pub(super) fn start(pose: Pose, time: f64) -> StartDocument {
    StartDocument {
        t_s: time,
        east_m: pose.position.x + 0.0,
        north_m: pose.position.y + 0.0,
        course_deg: course_deg_from_heading(pose.heading),
    }
}

pub(crate) fn segment_document(segment: &Segment) -> SegmentDocument {
    SegmentDocument {
        start: start(segment.start, segment.start_time),
        duration_s: segment.duration,
        speed_mps: segment.speed,
        turn_rate_deg_per_s: clockwise_deg_per_s(segment.turn_rate),
    }
}

fn trajectory(trajectory: &Trajectory) -> TrajectoryDocument {
    let segments = trajectory.segments().iter().map(segment_document);
    TrajectoryDocument {
        segments: trajectory.steered().is_none().then(|| segments.collect()),
        samples: samples(trajectory),
    }
}

pub(crate) fn samples(trajectory: &Trajectory) -> Vec<SampleDocument> {
    trajectory
        .sample_times(SAMPLE_STEP, MOST_SAMPLES)
        .into_iter()
        .map(|time| {
            let mut pose = trajectory.pose_at(time);
            if let Some(motion) = trajectory.steered() {
                pose.heading = course(motion, time);
            }
            SampleDocument {
                node: trajectory.steered().and_then(|motion| node(motion, time)),
                ..sample(pose, time, trajectory.speed_at(time))
            }
        })
        .collect()
}

pub(crate) fn sample(pose: Pose, time: f64, speed_mps: f64) -> SampleDocument {
    let at = start(pose, time);
    SampleDocument {
        t_s: at.t_s,
        east_m: at.east_m,
        north_m: at.north_m,
        course_deg: at.course_deg,
        speed_mps,
        node: None,
    }
}

fn node(motion: &Steered, time: f64) -> Option<NodeDocument> {
    let node = motion.node_at(time);
    (node.time == time).then(|| NodeDocument {
        heading_deg: course_deg_from_heading(node.pose.heading),
        surge_mps: node.velocity.x + 0.0,
        sway_mps: 0.0 - node.velocity.y,
        yaw_rate_deg_per_s: clockwise_deg_per_s(node.yaw_rate),
        surge_n: node.force.x + 0.0,
        sway_n: 0.0 - node.force.y,
        yaw_nm: 0.0 - node.moment,
    })
}

/// Course over ground in radians; the heading if there is no motion.
fn course(motion: &Steered, time: f64) -> f64 {
    let piece = motion.piece_at(time);
    let velocity = piece.velocity(piece.part(time));
    if velocity.norm() > tolerance::LENGTH_M {
        heading_of(velocity)
    } else {
        piece.pose_at(time).heading
    }
}

/// Exports a set as one entry, or one per slab. The initial set of a slab is the section at its
/// start, and its time counts from there. A set that the plan enters appears after the plan has
/// left it.
fn obstacles(set: &Obstacle, from: f64, horizon: f64) -> Vec<ObstacleDocument> {
    let from = from.min(horizon);
    let set = &set.remainder(from);
    let left = horizon - from;
    let slabs = set.slabs().iter();
    slabs
        .filter(|slab| slab.start() < left || slab.start() == 0.0)
        .map(|slab| ObstacleDocument {
            name: set.name().to_owned(),
            valid_s: [slab.start(), slab.end().min(left)].map(|time| from + time),
            initial_set: (&slab.obstacle().initial()).into(),
            velocity_set: (&slab.obstacle().velocity()).into(),
        })
        .collect()
}
