//! The arrows in one place: Scenario → obstacles → Plan → Evaluation = Run.

mod conduct;
mod duty;
mod shore;

pub use shore::{coast, land_within_reach};

use duty::{encountered, first_turn, relaxations, rules_given_up};
use std::time::{Duration, Instant};

use crate::colregs::{self, Encounter, Role};
use crate::evaluation::{
    Evaluation, Freedom, Request, SetShape, SpaceTimeSet, Steering, evaluate, evaluate_steered,
};
use crate::geometry::ConvexPolygon;
use crate::obstacle::{
    Coast, EllipsoidObstacle, Obstacle, PeakRisk, PolytopeObstacle, SlabObstacle, SpaceTimeObstacle,
};
use crate::planner::optimal_control::{self, ControlReport, Controlled};
use crate::planner::{
    NoPlan, Objective, Outcome, Planned, PlannerKind, Problem, path_time, space_time,
};
use crate::scenario::{Compliance, Scenario};
use crate::target::{Motion, Representation, ShipTrack, Target, VelocitySpell};
use crate::tolerance;
use crate::trajectory::Trajectory;

/// The sets of one target, own ship's footprint folded in.
#[derive(Debug, Clone)]
pub struct TargetSets {
    /// Hulls, margin and position uncertainty: safety is claimed on this one.
    pub hard: Obstacle,
    /// With the domain's shape around it: what the planner keeps out of when shapes are asked for.
    pub shaped: Obstacle,
    /// The encounter that the shape is for, judged along the undisturbed desired trajectory.
    pub encounter: Encounter,
    /// Metres that the shape was drawn back to let own ship start outside; 0 when it was not.
    pub shape_reduced: f64,
    /// Metres from the hard set to the farthest point of the full shape.
    pub shape_reach: f64,
}

impl TargetSets {
    /// The shaped or the hard set.
    pub fn either(&self, shaped: bool) -> &Obstacle {
        if shaped { &self.shaped } else { &self.hard }
    }
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
    /// The plan enters the set of a target, at a risk that was accepted.
    Risk {
        /// Name of the target.
        target: String,
        /// The largest risk along the plan, eq. (25), in `(0, 1)`.
        amount: f64,
    },
    /// The plan keeps clear of the shapes, but not to the rules.
    Compliance {
        /// Name of a target that asks something of own ship.
        target: String,
        /// Her role toward it.
        role: Role,
    },
}

/// One scenario, planned and judged.
#[derive(Debug, Clone)]
pub struct Run {
    /// What was asked.
    pub scenario: Scenario,
    /// The sets, in the order of the scenario's targets.
    pub sets: Vec<TargetSets>,
    /// True where the plan was made against the shaped sets, false where against the hard ones.
    pub shaped: bool,
    /// The obstacles that the plan was made against, in the same order: the level sets `O_alpha`,
    /// `alpha = 1 - max_risk`.
    pub obstacles: Vec<Obstacle>,
    /// The convex pieces of land that the plan was made against: all that own ship could reach.
    pub land: Vec<ConvexPolygon>,
    /// The planner's answer.
    pub planned: Planned,
    /// How the optimal-control planner found it; `None` for another planner.
    pub control: Option<ControlReport>,
    /// Targets whose obstacles are ellipsoids around sets of another kind.
    pub enclosed: Vec<String>,
    /// What had to be given up, most important first; empty when nothing.
    pub relaxations: Vec<Relaxation>,
    /// The largest risk along the plan, per target in the same order, against the sets of which `obstacles` are the
    /// level sets; empty when there is no plan.
    pub risks: Vec<PeakRisk>,
    /// The independent judgement of the plan; `None` when there is no plan.
    pub evaluation: Option<Evaluation>,
    /// Wall-clock time of planning alone.
    pub plan_time: Duration,
}

impl Run {
    /// The whole sets, in the order of the targets, of which `obstacles` are the level sets: those that [`Run::risks`]
    /// are against.
    pub fn whole_sets(&self) -> impl Iterator<Item = &Obstacle> {
        self.sets.iter().map(|sets| sets.either(self.shaped))
    }

    /// Why there is no plan, or none that was finished; `None` with a plan.
    pub fn reason(&self) -> Option<String> {
        match &self.planned.outcome {
            Outcome::Infeasible(reason) => Some(reason.to_string()),
            Outcome::Deadline(_) => Some(format!(
                "the budget of {} s ran out",
                self.scenario.deadline
            )),
            Outcome::Solved(_) => None,
        }
    }
}

/// The sets and the encounter of every target, in the scenario's order.
pub fn sets(scenario: &Scenario) -> Vec<TargetSets> {
    scenario
        .targets
        .iter()
        .map(|target| target_sets(scenario, target))
        .collect()
}

fn target_sets(scenario: &Scenario, target: &Target) -> TargetSets {
    let own = &scenario.own_ship;
    let (desired, horizon) = (&scenario.desired, scenario.horizon);
    let encounter = colregs::encounter(own, desired, target, horizon);
    // taken as they are: own ship is a point, nothing is added
    let outright = |obstacle: Obstacle| TargetSets {
        shaped: obstacle.clone(),
        hard: obstacle,
        encounter,
        shape_reduced: 0.0,
        shape_reach: 0.0,
    };
    match &target.motion {
        Motion::Ship(ship) => {
            let risk = colregs::first_risk(own, desired, ship, horizon);
            let shapes = colregs::shapes(own, ship, risk.as_ref());
            let hard = ship_obstacle(target, ship, shapes.hard, horizon);
            let shaped = ship_obstacle(target, ship, shapes.shaped, horizon);
            // the ellipse around a shape that was drawn back may contain own ship again
            let start = own.pose.position;
            if shaped.contains(start, 0.0) && !hard.contains(start, 0.0) {
                return TargetSets {
                    shape_reduced: shapes.reach,
                    shape_reach: shapes.reach,
                    ..outright(hard)
                };
            }
            TargetSets {
                hard,
                shaped,
                encounter,
                shape_reduced: shapes.reduced,
                shape_reach: shapes.reach,
            }
        }
        Motion::Sets { initial, velocity } => outright(represented(
            target.representation,
            PolytopeObstacle::new(target.name.clone(), initial.clone(), velocity.clone()),
        )),
        Motion::Ellipses { initial, velocity } => {
            outright(EllipsoidObstacle::new(target.name.clone(), *initial, *velocity).into())
        }
        Motion::Spells { initial, spells } => {
            outright(one_after_another(target, initial.clone(), spells.clone()))
        }
    }
}

fn represented(representation: Representation, polytope: PolytopeObstacle) -> Obstacle {
    match representation {
        Representation::Polytope => polytope.into(),
        Representation::Ellipsoid => EllipsoidObstacle::outer_of(&polytope).into(),
    }
}

fn ship_obstacle(
    target: &Target,
    ship: &ShipTrack,
    initial: ConvexPolygon,
    horizon: f64,
) -> Obstacle {
    if ship.turn_rate > 0.0 {
        let spells = ship.outer_velocity_spells(ship.turn_rate, horizon);
        return one_after_another(target, initial, spells);
    }
    let polytope = PolytopeObstacle::new(target.name.clone(), initial, ship.outer_velocity_set());
    represented(target.representation, polytope)
}

fn one_after_another(
    target: &Target,
    initial: ConvexPolygon,
    spells: Vec<VelocitySpell>,
) -> Obstacle {
    // one polytope of all velocities together contains the slabs: should their ends ever not increase
    let all: Vec<_> = spells
        .iter()
        .flat_map(|s| s.velocities.vertices().iter().copied())
        .collect();
    match SlabObstacle::new(target.name.clone(), initial.clone(), spells) {
        Ok(slabs) => slabs.into(),
        Err(_) => {
            let velocity = ConvexPolygon::hull(&all)
                .unwrap_or_else(|_| ConvexPolygon::point(crate::frame::Vector::zeros()));
            PolytopeObstacle::new(target.name.clone(), initial, velocity).into()
        }
    }
}

/// What a scenario asks of a planner, against the given obstacles and the land.
pub fn problem<'a>(
    scenario: &'a Scenario,
    obstacles: &'a [Obstacle],
    coast: &'a Coast,
) -> Problem<'a> {
    Problem {
        own: &scenario.own_ship,
        desired: &scenario.desired,
        alternatives: &scenario.alternatives,
        objective: scenario.objective,
        obstacles,
        coast,
        horizon: scenario.horizon,
        time_weight: scenario.time_weight,
        search: scenario.search,
        deadline: deadline(scenario),
        first_turn: None,
        encountered: &[],
    }
}

fn deadline(scenario: &Scenario) -> Duration {
    Duration::try_from_secs_f64(scenario.deadline).unwrap_or(Duration::MAX)
}

/// Plans a scenario and judges the plan. Where no plan keeps clear of the shapes, one that keeps clear of the
/// hard sets alone is looked for, and what was given up is said. The clock is read around planning alone
/// and enters no result but `plan_time`, unless the deadline ends the search.
pub fn run(scenario: Scenario) -> Run {
    let sets = sets(&scenario);
    let shaped = scenario.compliance.shapes();
    let encountered = encountered(&scenario, &sets);
    let ruled = scenario.compliance == Compliance::Rules && !encountered.is_empty();
    let begun = Instant::now();
    let forces = scenario.planner == PlannerKind::OptimalControl;
    let land = land_within_reach(&scenario);
    let shore;
    let coast: &Coast = match scenario.planner {
        PlannerKind::SpaceTime | PlannerKind::OptimalControl => {
            shore = coast(&scenario, &land);
            &shore
        }
        // the paths are kept off land when the scenario is read
        PlannerKind::PathTime => Coast::none(),
    };
    let plan = |kept: bool, ruled: bool| -> (Vec<Obstacle>, Planned, Option<ControlReport>) {
        let whole: Vec<Obstacle> = sets.iter().map(|s| s.either(kept).clone()).collect();
        let risk = scenario.max_risk;
        let level_sets: Vec<Obstacle> = if risk > 0.0 {
            whole.iter().map(|set| set.at_risk(risk)).collect()
        } else {
            whole.clone()
        };
        let level_sets = if forces {
            optimal_control::outer_sets(&level_sets)
        } else {
            level_sets
        };
        let asked = Problem {
            deadline: deadline(&scenario).saturating_sub(begun.elapsed()),
            first_turn: shaped.then(|| first_turn(&sets)).flatten(),
            encountered: if ruled { &encountered } else { &[] },
            ..problem(&scenario, &level_sets, coast)
        };
        let planned = match (scenario.planner, scenario.objective) {
            (PlannerKind::SpaceTime, _) => space_time::plan(&asked),
            (PlannerKind::PathTime, Objective::LengthRisk { weight }) => {
                let asked = Problem {
                    obstacles: &whole,
                    ..asked
                };
                path_time::plan_weighing_risk(&asked, weight, risk)
            }
            (PlannerKind::PathTime, _) => path_time::plan(&asked),
            (PlannerKind::OptimalControl, _) => {
                let Controlled { planned, report } =
                    optimal_control::plan(&asked, &scenario.control);
                return (level_sets, planned, Some(report));
            }
        };
        (level_sets, planned, None)
    };
    let mut kept_shapes = shaped;
    let mut relaxations = if shaped {
        relaxations(&sets, |s| s.shape_reduced)
    } else {
        Vec::new()
    };
    let (mut obstacles, mut planned, mut control) = plan(shaped, ruled);
    let unruly = ruled
        && matches!(&planned.outcome, Outcome::Infeasible(reason) if reason.is_for_the_sets());
    if unruly {
        (obstacles, planned, control) = plan(shaped, false);
        relaxations.splice(0..0, rules_given_up(&scenario, &sets));
    }
    let stuck = match &planned.outcome {
        // the ellipse around a shape may hold own ship where the shape does not
        Outcome::Infeasible(NoPlan::StartInside { .. }) => forces,
        Outcome::Infeasible(reason) => reason.is_for_the_sets(),
        Outcome::Solved(_) | Outcome::Deadline(_) => false,
    };
    if shaped && stuck && sets.iter().any(|s| s.shape_reach > 0.0) {
        let (obstacles_left, again, report) = plan(false, false);
        if again.outcome.plan().is_some() {
            (obstacles, planned, control) = (obstacles_left, again, report);
            relaxations.retain(|r| matches!(r, Relaxation::Compliance { .. }));
            relaxations.extend(duty::relaxations(&sets, |s| s.shape_reach));
            kept_shapes = false;
        } else if matches!(again.outcome, Outcome::Deadline(_)) {
            // there may be a way, which was not found in time
            planned.outcome = again.outcome;
            // starts and sets are those of the pass that ended so
            if forces {
                (obstacles, control, kept_shapes) = (obstacles_left, report, false);
            }
        }
    }
    let plan_time = begun.elapsed();
    let risks: Vec<PeakRisk> = planned.outcome.plan().map_or_else(Vec::new, |plan| {
        sets.iter()
            .map(|s| peak_risk(s.either(kept_shapes), &plan.trajectory, scenario.max_risk))
            .collect()
    });
    if scenario.max_risk > 0.0 {
        relaxations.extend(risks_taken(&sets, &risks));
    }
    let is_ellipsoid = |s: &&TargetSets| matches!(s.either(kept_shapes), Obstacle::Ellipsoid(_));
    let enclosed = sets.iter().filter(|s| forces && !is_ellipsoid(s));
    let enclosed = enclosed.map(|s| s.hard.name().to_owned()).collect();
    let evaluation = planned
        .outcome
        .plan()
        .map(|plan| judge(&scenario, &obstacles, &plan.trajectory));
    Run {
        scenario,
        sets,
        shaped: kept_shapes,
        obstacles,
        land,
        planned,
        control,
        enclosed,
        relaxations,
        risks,
        evaluation,
        plan_time,
    }
}

/// The largest risk along a trajectory. One that is nowhere deeper than [`tolerance::DEPTH_M`] in the set, which it may
/// touch, is at none: a set without spread is at risk 1 on its very boundary. For the same reason one that is nowhere
/// deeper in the set of the `accepted` risk, in `[0, 1)`, is at no more than that.
pub fn peak_risk(set: &Obstacle, trajectory: &Trajectory, accepted: f64) -> PeakRisk {
    // a motion under forces is looked at instant by instant, there the depth is asked for
    if trajectory.steered().is_some() {
        return set.peak_risk_along(trajectory);
    }
    let clear_of = |set: &Obstacle| {
        let enters = |s| set.first_contact(s, tolerance::DEPTH_M).is_some();
        !trajectory.segments().iter().any(enters)
    };
    if clear_of(set) {
        return PeakRisk {
            risk: 0.0,
            time: trajectory.start_time(),
        };
    }
    let peak = set.peak_risk_along(trajectory);
    if peak.risk > accepted && accepted > 0.0 && clear_of(&set.at_risk(accepted)) {
        return PeakRisk {
            risk: accepted,
            ..peak
        };
    }
    peak
}

/// The targets whose sets a plan enters, the greatest risk first.
fn risks_taken(sets: &[TargetSets], risks: &[PeakRisk]) -> Vec<Relaxation> {
    let mut taken: Vec<(&TargetSets, &PeakRisk)> = sets
        .iter()
        .zip(risks)
        .filter(|(_, peak)| peak.risk > 0.0)
        .collect();
    taken.sort_by(|a, b| b.1.risk.total_cmp(&a.1.risk));
    taken
        .into_iter()
        .map(|(s, peak)| Relaxation::Risk {
            target: s.hard.name().to_owned(),
            amount: peak.risk,
        })
        .collect()
}

/// The independent judgement of a trajectory against the obstacles that it was planned against.
pub fn judge(scenario: &Scenario, obstacles: &[Obstacle], trajectory: &Trajectory) -> Evaluation {
    let mut paths = vec![scenario.desired.waypoints()];
    paths.extend_from_slice(&scenario.alternatives);
    let freedom = match scenario.planner {
        PlannerKind::SpaceTime | PlannerKind::OptimalControl => Freedom::Limits,
        PlannerKind::PathTime => Freedom::Paths(&paths),
    };
    judged(scenario, obstacles, trajectory, freedom)
}

/// The same for what is no plan: its start, every set, every hull, the land and the figures, whatever own ship's limits are and
/// whether it arrives or not.
pub fn judge_free(
    scenario: &Scenario,
    obstacles: &[Obstacle],
    trajectory: &Trajectory,
) -> Evaluation {
    judged(scenario, obstacles, trajectory, Freedom::Any)
}

fn judged(
    scenario: &Scenario,
    obstacles: &[Obstacle],
    trajectory: &Trajectory,
    freedom: Freedom,
) -> Evaluation {
    let shape = |o: &Obstacle| match o {
        Obstacle::Polytope(o) => SetShape::Polygons {
            initial: o.initial().clone(),
            spells: vec![VelocitySpell {
                until: f64::INFINITY,
                velocities: o.velocity().clone(),
            }],
        },
        Obstacle::Ellipsoid(o) => SetShape::Ellipses {
            initial: *o.initial(),
            velocity: *o.velocity(),
        },
        Obstacle::Slabs(o) => SetShape::Polygons {
            initial: o.initial().clone(),
            spells: o.spells().to_vec(),
        },
    };
    let sets: Vec<SpaceTimeSet> = obstacles
        .iter()
        .map(|o| SpaceTimeSet {
            name: o.name().to_owned(),
            shape: shape(o),
        })
        .collect();
    let request = Request {
        freedom,
        segments: trajectory.segments(),
        own: &scenario.own_ship,
        desired: &scenario.desired,
        targets: &scenario.targets,
        sets: &sets,
        land: scenario.land.as_ref().map_or(&[], |l| l.map.polygons()),
        land_margin: scenario.land.as_ref().map_or(0.0, |l| l.margin),
        horizon: scenario.horizon,
        time_weight: scenario.time_weight,
        max_risk: scenario.max_risk,
    };
    match trajectory.steered() {
        Some(motion) => {
            let vessel = scenario.control.vessel.exact();
            let steering = Steering {
                motion,
                vessel: vessel.as_ref(),
                force_limits: scenario.control.force_limits,
            };
            evaluate_steered(&request, &steering)
        }
        None => evaluate(&request),
    }
}

#[cfg(test)]
mod tests;
