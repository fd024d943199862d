//! Which sets are used, what is given up, what the judge sees.

use super::*;
use crate::colregs::Role;
use crate::frame::{Pose, Vector};
use crate::planner::{ControlSettings, SearchKind};
use crate::target::{DomainKind, ShipTrack};
use crate::trajectory::{DesiredTrajectory, Segment};
use crate::vessel::{Hull, OwnShip, VesselKind};
use std::f64::consts::{FRAC_PI_2, PI};

fn polytope(o: &Obstacle) -> &PolytopeObstacle {
    o.as_polytope().expect("a polytope")
}

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
        alternatives: Vec::new(),
        planner: PlannerKind::SpaceTime,
        objective: Objective::SpaceTimeError,
        control: ControlSettings::of(VesselKind::CyberShip2),
        targets: vec![Target {
            name: "other".to_owned(),
            motion: Motion::Ship(target),
            representation: Representation::Polytope,
        }],
        search: SearchKind::AStar,
        compliance,
        time_weight: 25.0,
        max_risk: 0.0,
        deadline: 5.0,
        earth: None,
        land: None,
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
        turn_rate: 0.0,
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
    let areas = |run: &Run| polytope(&run.obstacles[0]).initial().area();
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
    assert!(polytope(&relaxed.obstacles[0]).slack(start, 0.0).value > 0.0);
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
