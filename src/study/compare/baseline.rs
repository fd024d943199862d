//! Two baselines without a planner: constant course and speed, and one constant velocity outside
//! every velocity obstacle.

use crate::evaluation::{Evaluation, Safety, counted_error};
use crate::frame::{Pose, direction};
use crate::obstacle::{Obstacle, PeakRisk, level_sets};
use crate::pipeline::{self, Run, TargetSets};
use crate::scenario::{Compliance, Scenario};
use crate::study::assess::{OwnSituation, least_alteration};
use crate::tolerance;
use crate::trajectory::{Segment, Trajectory};

/// Motion of a plan or of a baseline. A baseline is one segment from t = 0, up to the last waypoint
/// if it leads there, else to the horizon.
#[derive(Debug, Clone)]
pub struct ComparedMotion {
    /// The motion.
    pub trajectory: Trajectory,
    /// Level sets of the accepted risk, in the order of the targets.
    pub obstacles: Vec<Obstacle>,
    /// Evaluation. Own limits of a baseline are not checked, because its velocity changes at once.
    pub evaluation: Evaluation,
    /// Whether the motion enters sets, hulls or land.
    pub safety: Safety,
    /// Largest risk per target.
    pub risks: Vec<PeakRisk>,
    /// True if the motion ends at the last waypoint.
    pub arrived: bool,
}

impl ComparedMotion {
    pub(super) fn of(run: &Run) -> Option<Self> {
        Some(Self {
            trajectory: run.planned.outcome.plan()?.trajectory.clone(),
            obstacles: run.obstacles().cloned().collect(),
            evaluation: run.evaluation.clone()?,
            safety: run.safety()?,
            risks: run.risks(),
            arrived: run.arrives(),
        })
    }
}

/// Baseline with own course and speed, regardless of obstacles.
pub fn hold_course(scenario: &Scenario) -> ComparedMotion {
    let own = &scenario.own_ship;
    baseline(scenario, &Sets::of(scenario), own.pose.heading, own.speed)
}

/// Selects the constant velocity with the least space-time error that meets no set within the
/// horizon.
///
/// The candidates use own ship's speeds and the speed at t = 0. At each speed they are the least
/// turns out of every velocity obstacle to either side, and on own course the least change of
/// speed. They are exact to [`tolerance::ALTERATION_RAD`]. Turns start from own course and from the
/// course to the last waypoint, to cover missions off the course. Returns `None` when no such
/// velocity exists, for example inside a set. A velocity that runs aground is selected only if all
/// do.
pub fn constant_velocity(scenario: &Scenario) -> Option<ComparedMotion> {
    let own = &scenario.own_ship;
    let sets = Sets::of(scenario);
    let away = scenario.desired.end() - own.pose.position;
    let mut headings = vec![own.pose.heading];
    if away.norm() > tolerance::LENGTH_M {
        headings.push(crate::frame::heading_of(away));
    }
    let mut speeds: Vec<f64> = own.speeds.clone();
    speeds.push(own.speed);
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    let mut candidates: Vec<(f64, f64)> = Vec::new();
    for &heading in &headings {
        for &speed in &speeds {
            let situation = OwnSituation {
                pose: Pose::new(own.pose.position, heading),
                speed,
                ..OwnSituation::of(scenario, &sets.level)
            };
            let least = least_alteration(&situation);
            candidates.extend(least.starboard.map(|turn| (heading - turn, speed)));
            candidates.extend(least.port.map(|turn| (heading + turn, speed)));
            candidates.extend(least.speed.map(|change| (heading, speed + change)));
        }
    }
    candidates
        .into_iter()
        .map(|(heading, speed)| baseline(scenario, &sets, heading, speed))
        .filter(|b| b.evaluation.space_time_error.is_finite())
        // first of equal candidates: own course before others, starboard before port
        .min_by(|a, b| {
            let cost = |b: &ComparedMotion| b.evaluation.space_time_error;
            let bad = |b: &ComparedMotion| !b.evaluation.verified();
            bad(a).cmp(&bad(b)).then(cost(a).total_cmp(&cost(b)))
        })
}

/// Obstacles at the accepted risk, and the whole sets that define the risk.
pub(super) struct Sets {
    level: Vec<Obstacle>,
    whole: Vec<Obstacle>,
}

impl Sets {
    pub fn of(scenario: &Scenario) -> Self {
        let used = |sets: TargetSets| match scenario.compliance {
            Compliance::Shape | Compliance::Rules => sets.with_domain,
            Compliance::None => sets.hard,
        };
        let whole: Vec<Obstacle> = pipeline::sets(scenario).into_iter().map(used).collect();
        let level = level_sets(&whole, scenario.max_risk);
        Self { level, whole }
    }
}

/// Evaluates a velocity held from t = 0.
pub(super) fn baseline(
    scenario: &Scenario,
    sets: &Sets,
    heading: f64,
    speed: f64,
) -> ComparedMotion {
    let own = &scenario.own_ship;
    let along = direction(heading).dot(&(scenario.desired.end() - own.pose.position));
    let least = (scenario.desired.end() - own.pose.position - direction(heading) * along).norm();
    let arrival = if speed > 0.0 { along / speed } else { -1.0 };
    let arrived = least <= tolerance::ARRIVAL_M && arrival > 0.0 && arrival <= scenario.horizon;
    let segment = Segment::straight(
        Pose::new(own.pose.position, heading),
        0.0,
        if arrived { arrival } else { scenario.horizon },
        speed,
    );
    let trajectory = Trajectory::from(segment);
    let mut evaluation = pipeline::judge_free(scenario, &sets.level, &trajectory);
    if !evaluation.counted.arrived {
        // as for motions under forces, which need not end at the last waypoint either
        let (desired, within) = (&scenario.desired, own.hull.length);
        (evaluation.space_time_error, evaluation.counted) =
            counted_error(&trajectory, desired, scenario.time_weight, within);
    }
    let risk = |set| pipeline::peak_risk(set, &trajectory, scenario.max_risk);
    let risks = sets.whole.iter().map(risk).collect();
    ComparedMotion {
        trajectory,
        obstacles: sets.level.clone(),
        safety: evaluation.safety,
        evaluation,
        risks,
        arrived,
    }
}
