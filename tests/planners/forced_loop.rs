//! The closed loop of the optimal-control planner: its own vessel, driven by the planned forces.

use searoom::document::{Alarm, PlanDocument, SimulationDocument};
use searoom::frame::{Pose, Vector};
use searoom::scenario::{Behaviour, Scenario, Sensor, SensorKind, VesselModel};
use searoom::simulation::Simulation;
use searoom::target::Motion;
use searoom::verification::{verify, verify_simulations};

use crate::campaigns::documents::scenario;

const SCENES: [&str; 2] = ["forces/give-way.toml", "paper/figure_9.toml"];

fn sailed(scenario: Scenario) -> (SimulationDocument, Vec<PlanDocument>) {
    let simulation = Simulation::keeping_plans(scenario, false);
    let mut simulation = simulation.expect("a scenario for the loop");
    while !simulation.finished() {
        simulation.step();
    }
    (simulation.record(), simulation.plans().to_vec())
}

fn untimed(mut document: SimulationDocument) -> SimulationDocument {
    document.timing.plan_s.clear();
    document
}

fn json(document: &impl serde::Serialize) -> String {
    serde_json::to_string(document).expect("a document")
}

#[test]
fn the_scenes_under_forces_are_sailed_as_planned_and_verified() {
    for (file, nodes) in SCENES.into_iter().zip([45, 50]) {
        let (document, plans) = sailed(scenario(file));
        assert!(
            document.safe && document.arrived && !document.contact,
            "{file}"
        );
        assert_eq!((document.replans.len(), plans.len()), (nodes, nodes));
        assert!(document.alarms.is_empty(), "{:?}", document.alarms);
        for target in &document.targets {
            assert!(target.least_clearance_m > Some(0.0), "{file}: {target:?}");
        }
        // the vessel is integrated apart from the plan, and is near it
        let length = document.settings.own_length_m;
        let off = document.conduct.largest_off_plan_m / length;
        assert!(off > 1e-9 && off < 1e-4, "{file}: {off} lengths");
        let checked = verify_simulations(&json(&document)).expect("a document");
        assert!(
            checked[0].violations.is_empty(),
            "{:?}",
            checked[0].violations
        );
        for (index, plan) in plans.iter().enumerate() {
            let checked = verify(&json(plan)).expect("a plan");
            assert!(checked.verified(), "{file} {index}: {checked:?}");
            let control = plan.optimal_control.as_ref().expect("forces");
            let starts: Vec<&str> = control.starts.iter().map(|s| s.start.as_str()).collect();
            // the first plan tries many guesses, every other one the last plan alone
            match control.start {
                None => assert!(index == 0 && starts.len() > 5, "{file} {index}: {starts:?}"),
                Some(_) => assert_eq!(starts, ["previous"], "{file} {index}"),
            }
            assert_eq!(control.start.is_some(), index > 0);
        }
        let again = sailed(scenario(file)).0;
        assert_eq!(untimed(again), untimed(document), "{file}");
    }
}

/// A plan that claims to start with another velocity than its motion has.
#[test]
fn the_velocity_at_the_start_of_a_plan_is_checked() {
    let mut short = scenario(SCENES[0]);
    short.simulation.duration = Some(330.0);
    let (_, mut plans) = sailed(short);
    let plan = plans.last_mut().expect("plans");
    let control = plan.optimal_control.as_mut().expect("forces");
    let start = control.start.as_mut().expect("a ship that turns");
    assert!(start.yaw_rate_deg_per_s.abs() > 1e-3, "{start:?}");
    start.sway_mps += 0.01;
    let checked = verify(&json(plan)).expect("a plan");
    let words = format!("{:?}", checked.violations);
    assert!(
        !checked.verified() && words.contains("start velocity"),
        "{words}"
    );
}

fn assert_verifies(document: &SimulationDocument) {
    let checked = verify_simulations(&json(document)).expect("a document");
    let violations = &checked[0].violations;
    assert!(violations.is_empty(), "{violations:?}");
}

/// Nobody knows what is free of a set without corners.
#[test]
fn a_set_that_is_no_polygon_is_everywhere() {
    let mut short = scenario(SCENES[1]);
    short.simulation.duration = Some(10.0);
    let (mut document, _) = sailed(short);
    document.targets[0].set_m = Some(Vec::new());
    let checked = verify_simulations(&json(&document)).expect("a document");
    assert!(checked[0].contact && !checked[0].violations.is_empty());
}

/// At 100 and 120 s a ship lies so near that own ship is inside its set.
#[test]
fn without_a_plan_own_ship_goes_on_along_the_last_one() {
    let mut scene = scenario(SCENES[0]);
    let [far, near] = [(900.0, -900.0), (250.0, -130.0)].map(|(x, y)| Vector::new(x, y));
    let track = vec![(95.0, far), (99.0, near), (125.0, near), (130.0, far)];
    scene.simulation.behaviours = vec![Behaviour::Track(track)];
    scene.simulation.duration = Some(200.0);
    let (document, plans) = sailed(scene);
    let none = |r: &&searoom::document::ReplanDocument| r.cost_m2.is_none();
    let missing: Vec<_> = document.replans.iter().filter(none).collect();
    let times: Vec<f64> = missing.iter().map(|r| r.t_s).collect();
    assert_eq!(times, [100.0, 120.0]);
    let alarms = document.alarms.iter().filter(|a| a.alarm == Alarm::NoPlan);
    assert_eq!(alarms.map(|a| a.t_s).collect::<Vec<_>>(), times);
    assert!(missing.iter().all(|r| !r.followed) && document.conduct.without_plan == 2);
    assert!(!document.safe && plans.len() == document.replans.len() - 2);
    // it keeps to the plan of 80 s until 141 s, and there are plans again
    assert!(
        document.conduct.within_tracking_margin,
        "{:?}",
        document.conduct
    );
    assert!(document.replans.last().expect("plans").followed);
    assert_verifies(&document);
}

/// Own ship begins inside the set of a ship that sails away from it.
#[test]
fn before_its_first_plan_own_ship_holds_course_and_speed() {
    let mut scene = scenario(SCENES[0]);
    let Motion::Ship(ship) = &mut scene.targets[0].motion else {
        panic!("a ship");
    };
    ship.pose = Pose::new(Vector::new(60.0, -100.0), -std::f64::consts::FRAC_PI_2);
    scene.simulation.duration = Some(150.0);
    let (document, plans) = sailed(scene);
    let first = document
        .replans
        .iter()
        .position(|r| r.followed)
        .expect("a plan");
    assert!(first > 0 && plans.len() == document.replans.len() - first);
    let at = document
        .own_at(document.replans[first].start_t_s - 0.1)
        .expect("sailed")
        .0;
    let held = 2.0 * (document.replans[first].start_t_s - 0.1);
    assert!(
        (at.position - Vector::new(held, 0.0)).norm() < 0.01,
        "{at:?}"
    );
    assert!(document.conduct.within_tracking_margin && !document.safe);
    assert_verifies(&document);
}

#[test]
fn what_the_loop_cannot_sail_under_forces_is_named() {
    let refused = |file: &str, change: &dyn Fn(&mut Scenario)| -> String {
        let mut scene = scenario(file);
        change(&mut scene);
        let faults = Simulation::new(scene, false).expect_err("refused");
        let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
        faults.join("; ")
    };
    type Change = fn(&mut Scenario);
    let [ship, sets] = SCENES;
    let cases: [(&str, Change, &str); 8] = [
        (
            ship,
            |s| s.simulation.replan = 901.0,
            "simulation.replan_s: found 901; allowed: at most 900, the horizon",
        ),
        (
            ship,
            |s| s.simulation.vessel = Some(VesselModel::Kinematic),
            "simulation.vessel: found another ship than the planner's; allowed: nothing",
        ),
        (
            ship,
            |s| s.simulation.current.std = 0.1,
            "simulation.current: found a current; allowed: nothing",
        ),
        (
            ship,
            |s| s.own_ship.tracking_margin = 0.0,
            "own_ship.tracking_margin_m: found 0; allowed: above 0",
        ),
        (
            ship,
            |s| s.simulation.behaviours = vec![Behaviour::Mutual],
            "targets[0].behaviour: found a ship that plans",
        ),
        (
            sets,
            |s| s.simulation.behaviours = vec![Behaviour::Pursuit { every: 5.0 }],
            "targets[0]: found explicit sets that act",
        ),
        (
            sets,
            |s| {
                s.simulation.sensor = Sensor {
                    kind: SensorKind::Radar,
                    ..Sensor::EXACT
                }
            },
            "targets[2]: found explicit sets that are measured",
        ),
        (
            "uncertainty/ellipse.toml",
            |_| {},
            "targets[0]: found explicit sets; allowed: a tracked ship, or plans under forces",
        ),
    ];
    for (file, change, words) in cases {
        let found = refused(file, &change);
        assert!(found.contains(words), "{words}: {found}");
    }
    let commanded = Simulation::commanded(scenario(ship)).expect_err("forces");
    assert_eq!(commanded[0].path, "planner.kind");
}
