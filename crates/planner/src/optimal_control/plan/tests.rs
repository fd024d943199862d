//! Results after the deadline.

use std::time::Duration;

use super::super::defect::largest_defect;
use super::*;
use searoom_geometry::Ellipse;
use searoom_geometry::frame::{Pose, Vector};
use searoom_model::trajectory::DesiredTrajectory;
use searoom_model::vessel::{ForceVector, Hull, OwnShip, VesselKind};
use searoom_sets::{EllipsoidObstacle, Obstacle};

/// An ellipsoid from its centre and variances at t = 0, and those of its velocity.
fn ellipsoid(initial: [f64; 4], velocity: [f64; 4]) -> Obstacle {
    let ellipse = |[x, y, a, b]: [f64; 4]| {
        let columns = [Vector::new(a.sqrt(), 0.0), Vector::new(0.0, b.sqrt())];
        Ellipse::from_axes(Vector::new(x, y), columns)
    };
    EllipsoidObstacle::new("set", ellipse(initial), ellipse(velocity)).into()
}

#[test]
fn after_the_deadline_a_costlier_plan_on_a_fine_grid_is_returned() {
    // scenarios/paper/figure_9.toml
    let own = OwnShip {
        pose: Pose::new(Vector::zeros(), 0.0),
        speed: 0.2,
        hull: Hull::new(1.255, 0.29),
        turning_radius: 2.0,
        speeds: vec![0.1, 0.2, 0.24],
        safety_margin: 1.255,
        tracking_margin: 0.01,
    };
    let route = [Vector::zeros(), Vector::new(20.0, 10.0)];
    let desired = DesiredTrajectory::new(&route, &[0.05_f64.sqrt()]).expect("valid");
    let obstacles = [
        ellipsoid([9.0, -3.0, 1.0, 0.36], [-0.1, 0.2, 4e-4, 4e-4]),
        ellipsoid([20.0, 8.0, 1.0, 0.36], [-0.15, -0.04, 4e-4, 1e-4]),
        ellipsoid([13.0, 6.5, 0.64, 0.64], [0.03, 0.02, 2.25e-4, 2.25e-4]),
    ];
    let settings = ControlSettings {
        force_limits: ForceVector::new(2.0, 1.5, 1.5),
        ..ControlSettings::of(VesselKind::CyberShip2)
    };
    let problem = Problem {
        deadline: Duration::ZERO,
        ..Problem::new(&own, &desired, &obstacles, 100.0)
    };
    let exact = CyberShip2::EXACT;
    let planner = Planning::new(&problem, &settings, CyberShip2::SMOOTH, exact);
    let task = planner.task(planner.intervals);
    let attempts: Vec<StartAttempt> = family(&task)
        .into_iter()
        .map(|(_, guess)| attempt(&task, &guess, &Settings::default(), &|| true))
        .collect();
    let is_fine =
        |a: &StartAttempt| largest_defect(&exact, &a.profile, task.step()) <= tolerance::DEFECT;
    let ordered = cheapest_first(&attempts);
    assert!(!is_fine(ordered[0]));
    let fine = ordered.iter().find(|a| is_fine(a)).expect("one of many");
    let mut report = *planner.plan().control.expect("forces");
    let Outcome::Solved(plan) = planner.cheapest_on_fine_grid(&attempts, &mut report) else {
        panic!("no plan");
    };
    assert_eq!(plan.cost, fine.objective);
    assert!(report.intervals == planner.intervals && report.defect <= tolerance::DEFECT);
    // this one needs a finer grid, and there is no time
    let coarse: Vec<StartAttempt> = ordered.into_iter().take(1).cloned().collect();
    assert!(matches!(
        planner.cheapest_on_fine_grid(&coarse, &mut report),
        Outcome::Infeasible(NoPlan::Coarse { .. })
    ));
}
