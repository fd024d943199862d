//! The arrows in one place: Scenario → obstacles → Plan → Evaluation = Run.

use std::time::Duration;

use crate::colregs::Encounter;
use crate::evaluation::Evaluation;
use crate::obstacle::PolytopeObstacle;
use crate::planner::Planned;
use crate::scenario::Scenario;

/// The sets of one target, own ship's footprint folded in.
#[derive(Debug, Clone)]
pub struct TargetSets {
    /// Hulls, margin and position uncertainty: safety is claimed on this one.
    pub hard: PolytopeObstacle,
    /// With the domain's shape around it: what the planner keeps out of when shapes are asked for.
    pub shaped: PolytopeObstacle,
    /// The encounter that the shape is for, judged along the undisturbed desired trajectory.
    pub encounter: Encounter,
    /// Metres that the shape was drawn back to let own ship start outside; 0 when it was not.
    pub shape_reduced: f64,
}

/// What a plan gave up.
#[derive(Debug, Clone, PartialEq)]
pub enum Relaxation {
    /// A shape was drawn back toward its hard set.
    Domain {
        /// Name of the target.
        target: String,
        /// Metres, the largest cut.
        amount: f64,
    },
}

/// One scenario, planned and judged.
#[derive(Debug, Clone)]
pub struct Run {
    /// What was asked.
    pub scenario: Scenario,
    /// The sets, in the order of the scenario's targets.
    pub sets: Vec<TargetSets>,
    /// The obstacles that the plan was made against, in the same order.
    pub obstacles: Vec<PolytopeObstacle>,
    /// The planner's answer.
    pub planned: Planned,
    /// What had to be given up, most important first; empty when nothing.
    pub relaxations: Vec<Relaxation>,
    /// The independent judgement of the plan; `None` when there is no plan.
    pub evaluation: Option<Evaluation>,
    /// Wall-clock time of planning alone.
    pub plan_time: Duration,
}
