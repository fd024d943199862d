//! The plan document of a run.

mod control;
pub(super) mod legs;
pub(super) mod path_time;
mod reasons;
pub(super) mod stay;

use control::control;
use path_time::path_time_document;

use searoom_document::{
    CostDocument, DistantRow, EscapeDocument, EscapePolicy, ImprovementDocument, MissionDocument,
    NodeDocument, ObstacleDocument, OutOfReachDocument, OwnShipDocument, PLAN_FORMAT, PlanDocument,
    PositionDocument, RelaxationDocument, RelaxationKind, SampleDocument, SearchStatsDocument,
    SegmentDocument, StartDocument, TargetDocument, TimingDocument, TrajectoryDocument, finite,
    vertices,
};

use super::encounter::encounters;
use super::memory::{memory, planned_manoeuvre_document};
use crate::evaluation::Evaluation;
use crate::frame::{Pose, clockwise_deg, clockwise_deg_per_s, course_deg_from_heading, heading_of};
use crate::obstacle::{Obstacle, PeakRisk, SpaceTimeObstacle};
use crate::pipeline::{Relaxation, Run};
use crate::planner::{Minimises, Objective, ObjectiveKind, Plan, SearchStats};
use crate::scenario::{DistantTarget, Scenario};
use crate::tolerance;
use crate::trajectory::{Segment, Steered, Trajectory};

/// Time step of a sampled trajectory in seconds, and the maximum number of samples besides its
/// joints.
const SAMPLE_STEP: f64 = 1.0;
const MOST_SAMPLES: u32 = 20_000;

/// The document of a run before its verification: nothing is verified, and `violations` is empty.
pub(crate) fn unverified(run: &Run) -> PlanDocument {
    let scenario = &run.scenario;
    let mut document = PlanDocument {
        format: PLAN_FORMAT.to_owned(),
        scenario: scenario.title.clone(),
        planner: scenario.planner.facts().name.to_owned(),
        search: scenario.search,
        method: run.planned.method(),
        compliance: scenario.compliance,
        thresholds: scenario.judged_by().name.to_string(),
        objective: objective(scenario),
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
        outcome: run.outcome(),
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
        search_stats: search_stats(run.planned.stats),
        timing: timing(run),
        trajectory: plan(run).map(|plan| trajectory(&plan.trajectory)),
        escape: escape(run),
        departure: None,
        manoeuvres: (run.planned.manoeuvres.iter())
            .map(planned_manoeuvre_document)
            .collect(),
        phases: Vec::new(),
        memory: memory(run),
        targets: scenario.targets.iter().map(TargetDocument::of).collect(),
        obstacles: (run.targets.iter())
            .flat_map(|target| {
                let from = target.released.unwrap_or(0.0);
                obstacles(&target.obstacle, from, scenario.horizon)
            })
            .collect(),
        encounters: encounters(run),
        out_of_reach: out_of_reach(scenario),
        path_time: (run.planned.path_time.as_deref())
            .map(|diagram| path_time_document(run, diagram)),
        optimal_control: control(run),
    };
    document.departure = document.departure_of_motion();
    document.phases = document.phases_of_motion();
    document
}

/// Statistics of the search that made a plan; null where no graph was searched for it.
pub(crate) fn search_stats(stats: Option<SearchStats>) -> SearchStatsDocument {
    SearchStatsDocument {
        expanded: stats.map(|s| s.expanded),
        generated: stats.map(|s| s.generated),
        edges_checked: stats.map(|s| s.edges_checked),
        heuristic_weight: stats.map(|s| s.heuristic_weight),
    }
}

/// Targets that the plan does not consider; `None` where every target is planned for.
fn out_of_reach(scenario: &Scenario) -> Option<OutOfReachDocument> {
    let found = &scenario.out_of_reach;
    if found.targets.is_empty() {
        return None;
    }
    let row = |target: &DistantTarget| {
        let place = target.position;
        let (speed, radius) = (target.greatest_speed, target.radius);
        DistantRow(target.name.clone(), place.x, place.y, speed, radius)
    };
    Some(OutOfReachDocument {
        of_targets: scenario.targets.len() + found.targets.len(),
        until_s: found.until,
        apart_m: found.apart,
        rows: found.targets.iter().map(row).collect(),
    })
}

/// Kind of the minimised quantity.
pub(crate) fn objective(scenario: &Scenario) -> ObjectiveKind {
    match scenario.planner.facts().minimises {
        Minimises::Own(kind) => kind,
        Minimises::SpaceTimeError | Minimises::Objective => scenario.objective.kind(),
    }
}

fn plan(run: &Run) -> Option<&Plan> {
    run.planned.outcome.plan()
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
    use RelaxationKind as Kind;
    let (kind, target, amount, until_s) = match relaxation {
        Relaxation::Domain { target, amount } => (Kind::Domain, target, *amount, None),
        Relaxation::Risk {
            target,
            amount,
            until,
        } => (Kind::Risk, target, *amount, *until),
        Relaxation::Arrival { target, amount } => (Kind::Arrival, target, *amount, None),
        Relaxation::Compliance { target, .. } => (Kind::Compliance, target, 1.0, None),
    };
    RelaxationDocument {
        kind,
        target: target.clone(),
        amount,
        unit: Some(kind.unit()),
        until_s,
    }
}

fn escape(run: &Run) -> Option<EscapeDocument> {
    let (escape, plan) = (run.planned.escape?, run.planned.outcome.plan()?);
    let held = |s: &&Segment| s.start_time < escape.held_until - tolerance::TIME_S;
    Some(EscapeDocument {
        policy: EscapePolicy::StandOnHold,
        held_until_s: escape.held_until,
        first_segment: plan.trajectory.segments().iter().take_while(held).count(),
        turn_deg: clockwise_deg(escape.turn),
        speed_mps: escape.speed,
    })
}

fn own_ship(run: &Run) -> OwnShipDocument {
    let own = &run.scenario.own_ship;
    OwnShipDocument {
        position: PositionDocument::of(own.pose.position),
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
        waypoints: desired
            .waypoints()
            .into_iter()
            .map(PositionDocument::of)
            .collect(),
        leg_speeds_mps: desired.legs().iter().map(|leg| leg.speed).collect(),
        duration_s: desired.duration(),
        length_m: desired.length(),
        left_out_m: 0.0,
        stay_until_s: run.scenario.stay,
        alternatives: (run.scenario.alternatives.iter())
            .map(|path| path.iter().copied().map(PositionDocument::of).collect())
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

fn trajectory(trajectory: &Trajectory) -> TrajectoryDocument {
    let segments = trajectory.segments().iter().map(SegmentDocument::of);
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
    let at = StartDocument::of(pose, time);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// In the headline and in the legs.
    #[test]
    fn a_manoeuvre_begins_when_its_departure_does() {
        for name in ["give-way", "head-on", "overtaking", "stand-on"] {
            let file = format!("scenarios/colregs/{name}.toml");
            let scenario = crate::scenario::Scenario::read(file.as_ref()).expect("valid");
            let plan = PlanDocument::of(&crate::pipeline::run(scenario));
            let departure = plan.departure.expect("a manoeuvre");
            let from_s = departure.begins_s();
            let begins_s = plan.manoeuvres[0].begins_s;
            assert!(
                (from_s - begins_s).abs() < 1e-3,
                "{name}: {from_s} {begins_s}"
            );
        }
    }
}
