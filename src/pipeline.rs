//! The arrows in one place: Scenario → obstacles → Plan → Evaluation = Run.

use std::time::{Duration, Instant};

use crate::colregs::{self, Encounter};
use crate::evaluation::{Evaluation, Request, SpaceTimeSet, evaluate};
use crate::obstacle::PolytopeObstacle;
use crate::planner::{NoPlan, Outcome, Planned, Problem, space_time};
use crate::scenario::{Compliance, Scenario};
use crate::target::{Motion, Target};
use crate::trajectory::Trajectory;

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
    /// Metres from the hard set to the farthest point of the full shape.
    pub shape_reach: f64,
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
    let velocity = target.velocity_set();
    let obstacle = |initial| PolytopeObstacle::new(target.name.clone(), initial, velocity.clone());
    match &target.motion {
        Motion::Ship(ship) => {
            let risk = colregs::first_risk(own, desired, ship, horizon);
            let shapes = colregs::shapes(own, ship, risk.as_ref());
            TargetSets {
                hard: obstacle(shapes.hard),
                shaped: obstacle(shapes.shaped),
                encounter,
                shape_reduced: shapes.reduced,
                shape_reach: shapes.reach,
            }
        }
        // taken as they are: own ship is a point, nothing is added
        Motion::Sets { initial, .. } => {
            let hard = obstacle(initial.clone());
            TargetSets {
                shaped: hard.clone(),
                hard,
                encounter,
                shape_reduced: 0.0,
                shape_reach: 0.0,
            }
        }
    }
}

/// Plans a scenario and judges the plan. Where no plan keeps clear of the shapes, one that keeps clear of the
/// hard sets alone is looked for, and what was given up is said. The clock is read around planning alone
/// and enters no result but `plan_time`, unless the deadline ends the search.
pub fn run(scenario: Scenario) -> Run {
    let sets = sets(&scenario);
    let shaped = scenario.compliance == Compliance::Shape;
    let deadline = Duration::try_from_secs_f64(scenario.deadline).unwrap_or(Duration::MAX);
    let begun = Instant::now();
    let plan = |obstacles: &[PolytopeObstacle]| {
        space_time::plan(&Problem {
            own: &scenario.own_ship,
            desired: &scenario.desired,
            obstacles,
            horizon: scenario.horizon,
            time_weight: scenario.time_weight,
            search: scenario.search,
            deadline: deadline.saturating_sub(begun.elapsed()),
        })
    };
    let hard = || -> Vec<PolytopeObstacle> { sets.iter().map(|s| s.hard.clone()).collect() };
    let mut obstacles = if shaped {
        sets.iter().map(|s| s.shaped.clone()).collect()
    } else {
        hard()
    };
    let mut relaxations = if shaped {
        relaxations(&sets, |s| s.shape_reduced)
    } else {
        Vec::new()
    };
    let mut planned = plan(&obstacles);
    let stuck = matches!(
        planned.outcome,
        Outcome::Infeasible(NoPlan::NoCandidate { .. })
    );
    if shaped && stuck && sets.iter().any(|s| s.shape_reach > 0.0) {
        let obstacles_left = hard();
        let again = plan(&obstacles_left);
        if again.outcome.plan().is_some() {
            (obstacles, planned) = (obstacles_left, again);
            relaxations = self::relaxations(&sets, |s| s.shape_reach);
        }
    }
    let plan_time = begun.elapsed();
    let evaluation = planned
        .outcome
        .plan()
        .map(|plan| judge(&scenario, &obstacles, &plan.trajectory));
    Run {
        scenario,
        sets,
        obstacles,
        planned,
        relaxations,
        evaluation,
        plan_time,
    }
}

/// The independent judgement of a trajectory against the obstacles that it was planned against.
pub fn judge(
    scenario: &Scenario,
    obstacles: &[PolytopeObstacle],
    trajectory: &Trajectory,
) -> Evaluation {
    let sets: Vec<SpaceTimeSet> = obstacles
        .iter()
        .map(|o| SpaceTimeSet {
            name: o.name().to_owned(),
            initial: o.initial().clone(),
            velocity: o.velocity().clone(),
        })
        .collect();
    evaluate(&Request {
        segments: trajectory.segments(),
        own: &scenario.own_ship,
        desired: &scenario.desired,
        targets: &scenario.targets,
        sets: &sets,
        horizon: scenario.horizon,
        time_weight: scenario.time_weight,
    })
}

/// The shapes that were drawn back, the largest cut first.
fn relaxations(sets: &[TargetSets], cut: impl Fn(&TargetSets) -> f64) -> Vec<Relaxation> {
    let mut drawn: Vec<&TargetSets> = sets.iter().filter(|s| cut(s) > 0.0).collect();
    drawn.sort_by(|a, b| cut(b).total_cmp(&cut(a)));
    drawn
        .into_iter()
        .map(|s| Relaxation::Domain {
            target: s.shaped.name().to_owned(),
            amount: cut(s),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colregs::Role;
    use crate::frame::{Pose, Vector};
    use crate::planner::SearchKind;
    use crate::target::{DomainKind, ShipTrack};
    use crate::trajectory::{DesiredTrajectory, Segment};
    use crate::vessel::{Hull, OwnShip};
    use std::f64::consts::{FRAC_PI_2, PI};

    fn scenario(target: ShipTrack, compliance: Compliance) -> Scenario {
        let points = [Vector::zeros(), Vector::new(1500.0, 0.0)];
        Scenario {
            title: "one target".to_owned(),
            horizon: 400.0,
            own_ship: OwnShip {
                pose: Pose::new(Vector::zeros(), 0.0),
                speed: 5.0,
                hull: Hull {
                    length: 30.0,
                    beam: 8.0,
                },
                turning_radius: 100.0,
                speeds: vec![2.5, 5.0, 6.0],
                safety_margin: 20.0,
            },
            desired: DesiredTrajectory::new(&points, &[5.0]).expect("valid"),
            targets: vec![Target {
                name: "other".to_owned(),
                motion: Motion::Ship(target),
            }],
            search: SearchKind::AStar,
            compliance,
            time_weight: 25.0,
            deadline: 5.0,
        }
    }

    fn track(x: f64, y: f64, heading: f64, speed: f64) -> ShipTrack {
        ShipTrack {
            pose: Pose::new(Vector::new(x, y), heading),
            speed,
            hull: Hull {
                length: 60.0,
                beam: 12.0,
            },
            position_std: 0.0,
            speed_spread: 0.5,
            course_spread: 0.08,
            domain: DomainKind::Colregs,
        }
    }

    #[test]
    fn compliance_chooses_the_sets() {
        let target = track(1500.0, 0.0, PI, 5.0);
        let shaped = run(scenario(target.clone(), Compliance::Shape));
        let hard = run(scenario(target, Compliance::None));
        assert_eq!(shaped.sets[0].encounter.role, Role::HeadOn);
        assert_eq!(shaped.obstacles[0], shaped.sets[0].shaped);
        assert_eq!(hard.obstacles[0], hard.sets[0].hard);
        assert!(shaped.relaxations.is_empty() && hard.relaxations.is_empty());
        let areas = |run: &Run| run.obstacles[0].initial().area();
        assert!(areas(&shaped) > 2.0 * areas(&hard));
    }

    #[test]
    fn a_shape_over_the_start_is_drawn_back_and_said_so() {
        let target = track(100.0, -50.0, FRAC_PI_2, 5.0);
        let relaxed = run(scenario(target.clone(), Compliance::Shape));
        assert!(matches!(
            relaxed.relaxations.as_slice(),
            [Relaxation::Domain { target, amount }] if target == "other" && *amount > 1.0
        ));
        let start = relaxed.scenario.own_ship.pose.position;
        assert!(relaxed.obstacles[0].slack(start, 0.0).value > 0.0);
        // the hard sets were never shaped
        assert!(
            run(scenario(target, Compliance::None))
                .relaxations
                .is_empty()
        );
    }

    #[test]
    fn the_judge_sees_the_undisturbed_trajectory_hit_the_set() {
        let scenario = scenario(track(1500.0, 0.0, PI, 5.0), Compliance::Shape);
        let sets = sets(&scenario);
        let straight = Trajectory::new(vec![Segment {
            start: scenario.own_ship.pose,
            start_time: 0.0,
            duration: 300.0,
            speed: 5.0,
            turn_rate: 0.0,
        }])
        .expect("valid");
        let judged = judge(&scenario, &[sets[0].shaped.clone()], &straight);
        assert!(!judged.verified());
        assert!(
            judged
                .violations
                .iter()
                .any(|v| v.what.starts_with("set of 'other'"))
        );
        assert!(
            judged
                .violations
                .iter()
                .any(|v| v.what.starts_with("hull of 'other'"))
        );
        assert!(judged.space_time_error.abs() < 1e-9 && judged.delay.abs() < 1e-9);
    }

    /// Own ship starts at the edge of a shape that then grows over her: no plan is clear of it, one is clear of
    /// the hard set, and the run says what was given up.
    #[test]
    fn where_no_plan_clears_the_shapes_one_that_clears_the_hard_sets_is_relaxed() {
        use crate::simulation::{EncounterKind, Placement, random_encounter};
        let drawn = random_encounter(EncounterKind::GiveWay, 104, Placement::Origin);
        let run = run(drawn.expect("drawn").scenario);
        assert!(run.sets[0].shape_reduced > 0.0 && run.planned.outcome.plan().is_some());
        assert_eq!(run.obstacles[0], run.sets[0].hard);
        let [Relaxation::Domain { amount, .. }] = &run.relaxations[..] else {
            panic!("{:?}", run.relaxations);
        };
        assert!(*amount > run.sets[0].shape_reduced);
        assert!(run.evaluation.is_some_and(|e| e.verified()));
    }
}
