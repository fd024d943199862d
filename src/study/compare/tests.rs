//! Tests of baselines against closed-form results, and of candidates against single runs.

use super::*;
use crate::document::ScenarioComparisonDocument;
use crate::evaluation::{counted_error, least_land_distance};
use crate::frame::{Side, wrap};
use crate::obstacle::SpaceTimeObstacle;
use crate::planner::optimal_control::OptimalControlPlanner;
use crate::planner::{DEFAULT_PLANNER, PLANNERS, Planner, SearchKind};
use crate::target::Representation;

fn scenario(name: &str) -> Scenario {
    Scenario::read(format!("scenarios/{name}.toml").as_ref()).expect(name)
}

#[test]
fn holding_course_arrives_where_the_course_leads_and_meets_the_target() {
    let scenario = scenario("colregs/head-on");
    let held = hold_course(&scenario);
    assert!(held.arrived);
    assert!((held.evaluation.duration - 300.0).abs() < 1e-9);
    assert!(held.evaluation.space_time_error < 1e-9);
    assert!(!held.evaluation.verified());
    assert_eq!(held.risks[0].risk, 1.0);
    let mut aside = scenario;
    aside.own_ship.pose.heading += 0.2;
    let held = hold_course(&aside);
    assert!(!held.arrived && held.evaluation.duration == 400.0);
    assert!(held.evaluation.space_time_error > 1e3);
}

/// The deepest place on land is reached later than the shore.
#[test]
fn the_first_contact_with_land_is_told() {
    let scenario = scenario("harbour/canal-transit");
    let found = methods(&scenario);
    let candidate = Candidate {
        method: Method::HoldCourse,
        max_risk: 0.0,
    };
    let entries = [candidate.run(&scenario)];
    let file = String::new();
    let document = ScenarioComparisonDocument::of(file, &scenario, &entries, &found.inapplicable);
    let told = document.entries[0].collision.as_ref().expect("aground");
    assert_eq!(told.with, crate::obstacle::LAND);
    let motion = entries[0].motion.as_ref().expect("a motion");
    let deepest = motion.evaluation.min_land_distance_time;
    assert!(told.t_s < deepest - 100.0, "{told:?}, {deepest}");
    let land = scenario.land.as_ref().expect("land").map.polygons();
    let until = |time: f64| {
        let held = motion.trajectory.segments()[0].between(0.0, time);
        least_land_distance(land, &[held], &scenario.own_ship.hull).0
    };
    assert!(until(told.t_s) < 0.0 && until(told.t_s - 1.0) >= 0.0);
}

/// Tests that the velocity lies on the edge of the velocity obstacle: it is clear, and any smaller
/// alteration is not.
#[test]
fn the_constant_velocity_is_clear_and_any_less_alteration_is_not() {
    for name in [
        "colregs/head-on",
        "colregs/overtaking",
        "uncertainty/turning",
    ] {
        let scenario = scenario(name);
        let found = constant_velocity(&scenario).expect("one");
        let violations = &found.evaluation.violations;
        assert!(found.evaluation.verified(), "{name}: {violations:?}");
        let segment = found.trajectory.segments()[0];
        let own = &scenario.own_ship;
        let turn = wrap(segment.start.heading - own.pose.heading);
        assert!(turn.abs() > 0.05, "{name}");
        // no velocity of a grid is better
        let (start, least) = (own.pose.position, found.evaluation.space_time_error);
        let meets = |velocity| {
            let mut sets = found.obstacles.iter();
            sets.any(|o| o.in_velocity_obstacle(start, velocity, scenario.horizon))
        };
        for k in 0..720 {
            for &speed in &own.speeds {
                let heading = own.pose.heading + f64::from(k) * std::f64::consts::TAU / 720.0;
                let meets = meets(crate::frame::direction(heading) * speed);
                let sets = baseline::Sets::of(&scenario);
                let clear = || baseline::baseline(&scenario, &sets, heading, speed).evaluation;
                let dearer = || clear().space_time_error >= least - 1e-6;
                assert!(meets || dearer(), "{name} {heading} {speed}");
            }
        }
        let less = Side::of_turn(turn).map_or(0.0, Side::turn_sign) * 1e-6;
        let velocity = crate::frame::direction(segment.start.heading - less) * segment.speed;
        assert!(meets(velocity), "{name}");
    }
    let mut inside = scenario("colregs/head-on");
    let ship = inside.targets[0].clone();
    let crate::target::Motion::Ship(mut track) = ship.motion.clone() else {
        panic!("a ship");
    };
    track.pose.position = inside.own_ship.pose.position;
    inside.targets[0].motion = crate::target::Motion::Ship(track);
    assert!(constant_velocity(&inside).is_none());
}

#[test]
fn what_applies_depends_on_targets_start_land_and_ship() {
    let names = |s: &Scenario| -> Vec<String> {
        methods(s).methods.iter().map(ToString::to_string).collect()
    };
    let ships = scenario("colregs/head-on");
    let all = "space-time, A*; space-time, Dijkstra; space-time, A*, ellipsoids; \
               space-time, Dijkstra, ellipsoids; path-time; path-time, ellipsoids; \
               optimal control; hold course; constant velocity";
    assert_eq!(names(&ships).join("; "), all);
    let with_one = methods(&ships).inapplicable;
    assert!(
        with_one
            .iter()
            .all(|m| m.method.to_string().contains("thorough"))
    );
    assert_eq!(with_one.len(), 2);
    let mut off = ships.clone();
    off.own_ship.pose.position.y = 3.0;
    assert!(!names(&off).iter().any(|n| n.starts_with("path-time")));
    // targets given as ellipses or by several velocity sets leave no choice
    assert_eq!(names(&scenario("uncertainty/changing-velocities")).len(), 6);
    assert!(names(&scenario("paper/figure_9")).contains(&"optimal control".to_owned()));
    let land = methods(&scenario("harbour/munkholmen"));
    let other = land
        .inapplicable
        .iter()
        .find(|o| o.method.to_string() == "optimal control");
    assert!(other.is_some_and(|o| o.reason.starts_with("map:")));
}

/// A plan has one J, whichever command reports it. That of a baseline that does not end at the last
/// waypoint is counted as that of a motion under forces.
#[test]
fn a_plan_has_the_error_that_it_has_alone() {
    for name in ["head-on", "give-way", "overtaking", "stand-on"] {
        let scenario = scenario(&format!("colregs/{name}"));
        let methods = methods(&scenario).methods;
        let first = |wanted: &'static dyn Planner| {
            let is =
                |m: &&Method| matches!(m, Method::Planner { planner, .. } if *planner == wanted);
            *methods.iter().find(is).expect("applies")
        };
        let baselines = [Method::HoldCourse, Method::ConstantVelocity];
        for method in PLANNERS.map(first).into_iter().chain(baselines) {
            let candidate = Candidate {
                method,
                max_risk: 0.0,
            };
            let entry = candidate.run(&scenario);
            let motion = entry.motion.expect("a motion");
            let (found, trajectory) = (&motion.evaluation, &motion.trajectory);
            let (desired, q) = (&scenario.desired, scenario.time_weight);
            let judged = (found.space_time_error, found.counted);
            if let Method::Planner { .. } = method {
                let alone = pipeline::run(method.asked(&scenario)).evaluation;
                let alone = alone.expect("a plan");
                let of = (alone.space_time_error, alone.counted);
                assert_eq!(judged, of, "{name} {method}");
            }
            let is_steered = trajectory.steered().is_some();
            let ends_there = !is_steered && motion.arrived;
            if is_steered || !ends_there && baselines.contains(&method) {
                let counted = counted_error(trajectory, desired, q, 30.0);
                assert_eq!(judged, counted, "{name} {method}");
            }
            let until = found.counted.until;
            assert!(
                !ends_there || until >= trajectory.end_time(),
                "{name} {method}: {until}"
            );
            assert!(judged.0 < 1e5, "{name} {method}: {}", judged.0);
            if method == first(&OptimalControlPlanner) {
                assert!(found.verified(), "{name}: {:?}", found.violations);
            }
        }
    }
}

#[test]
fn a_contender_is_what_a_run_of_its_own_is() {
    let scenario = scenario("colregs/give-way");
    let risks = [0.0, 0.3];
    let entries = compare(&scenario, &risks);
    assert_eq!(entries.len(), 6 * 2 + 1);
    let method = Method::Planner {
        planner: DEFAULT_PLANNER,
        search: SearchKind::AStar,
        representation: Some(Representation::Ellipsoid),
    };
    let max_risk = 0.3;
    let wanted = Candidate { method, max_risk };
    let entry = entries.iter().find(|e| e.candidate == wanted);
    let entry = entry.expect("there");
    let mut alone = scenario.clone();
    // no graph is searched
    alone.search = SearchKind::Dijkstra;
    alone.targets[0].representation = Representation::Ellipsoid;
    alone.max_risk = 0.3;
    let alone = pipeline::run(alone);
    let plan = alone.planned.outcome.plan();
    assert_eq!(entry.trajectory(), plan.map(|p| &p.trajectory));
    assert!((entry.motion.as_ref()).is_some_and(|m| m.arrived && m.evaluation.verified()));
    // a higher accepted risk never increases the cost
    for pair in entries.chunks(2).take(4) {
        let cost = |e: &Entry| {
            let motion = e.motion.as_ref();
            motion.map_or(f64::INFINITY, |m| m.evaluation.space_time_error)
        };
        assert!(
            cost(&pair[1]) <= cost(&pair[0]) * 1.001,
            "{}",
            pair[0].candidate.method
        );
    }
}
