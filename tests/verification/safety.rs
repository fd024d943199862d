//! The safety of a motion that the evaluation finds.

use searoom::evaluation::{Evaluation, Freedom, Request, Safety, SpaceTimeSet, evaluate};
use searoom::frame::Vector;
use searoom::geometry::{ConvexPolygon, Polygon};
use searoom::scenario::Scenario;
use searoom::target::{Motion, Uncertainty};
use searoom::trajectory::Segment;

/// Scenario in which own ship moves 1500 m along the path and passes a target at rest half-way.
/// The centres are `north` metres apart there. The half-beams are 4 m and 6 m, half of own
/// diagonal is 15.524 m, and the margin is 20 m.
struct Scene {
    scenario: Scenario,
    held: Segment,
}

fn scene(north: f64, spread_m: f64) -> Scene {
    let text = format!(
        r#"title = "abeam"
        horizon_s = 400.0
        own_ship = {{ position = {{ east_m = 0, north_m = 0 }}, course_deg = 90, speed_mps = 5, length_m = 30, beam_m = 8,
            turning_radius_m = 100, safety_margin_m = 20 }}
        mission = {{ waypoints = [{{ east_m = 0, north_m = 0 }}, {{ east_m = 1500, north_m = 0 }}] }}
        targets = [{{ name = "t", position = {{ east_m = 750, north_m = {north} }}, course_deg = 90, speed_mps = 0,
            length_m = 60, beam_m = 12, position_std_m = {spread_m} }}]"#
    );
    let scenario = Scenario::parse(&text).expect("valid");
    let held = Segment::straight(scenario.own_ship.pose, 0.0, 300.0, 5.0);
    Scene { scenario, held }
}

fn box_around(half: f64) -> ConvexPolygon {
    ConvexPolygon::rectangle(Vector::new(750.0, 60.0), half, half)
}

/// Evaluates the motion with these sets, risk, land and land margin.
fn judged(
    scene: &Scene,
    sets: &[SpaceTimeSet],
    max_risk: f64,
    land: &[Polygon],
    land_margin: f64,
) -> Evaluation {
    let Scene { scenario, held } = scene;
    evaluate(&Request {
        freedom: Freedom::Any,
        targets: &scenario.targets,
        sets,
        land,
        land_margin,
        max_risk,
        ..Request::new(
            std::slice::from_ref(held),
            &scenario.own_ship,
            &scenario.desired,
            scenario.horizon,
        )
    })
}

/// The limits do not depend on the sets. They are 10 m for the nominal hull, 10 m plus three
/// standard deviations for any hull, and 41.524 m for the hard set.
#[test]
fn what_is_entered_is_told_to_the_millimetre() {
    for (north, spread_m, expected) in [
        (9.999, 0.0, Safety::Collides),
        (10.001, 0.0, Safety::Unsafe),
        (10.001, 5.0, Safety::Unsafe),
        (41.523, 0.0, Safety::Unsafe),
        (41.525, 0.0, Safety::Safe),
        (41.525, 0.1, Safety::Unsafe),
        (41.850, 0.1, Safety::Safe),
    ] {
        let found = judged(&scene(north, spread_m), &[], 0.0, &[], 0.0);
        assert_eq!(found.safety, expected, "{north} m, {spread_m} m");
        assert_eq!(found.safe(), expected == Safety::Safe);
    }
}

/// At an accepted risk, the hard set may be entered if its level set is retained. A released
/// set is never retained.
#[test]
fn an_accepted_risk_is_told_from_a_set_of_which_nothing_is_kept() {
    let scene = scene(30.0, 0.0);
    let far = box_around(10.0);
    let near = box_around(70.0);
    let still = ConvexPolygon::point(Vector::zeros());
    for (set, max_risk, from, expected) in [
        (&far, 0.3, 0.0, Safety::AtRisk),
        (&near, 0.3, 0.0, Safety::Unsafe),
        (&far, 0.3, 10.0, Safety::Unsafe),
    ] {
        let sets = [SpaceTimeSet {
            from,
            ..SpaceTimeSet::constant("t", set.clone(), still.clone())
        }];
        let found = judged(&scene, &sets, max_risk, &[], 0.0);
        assert_eq!(found.safety, expected, "{max_risk}, {from}");
    }
}

/// An explicit set is the hard set.
#[test]
fn a_set_that_is_given_is_entered_or_not() {
    for (half, expected) in [(59.0, Safety::Safe), (61.0, Safety::Unsafe)] {
        let mut scene = scene(60.0, 0.0);
        let still = ConvexPolygon::point(Vector::zeros());
        let sets = Uncertainty::constant(box_around(half), still);
        scene.scenario.targets[0].motion = Motion::Sets(sets);
        let found = judged(&scene, &[], 0.0, &[], 0.0);
        assert_eq!(found.safety, expected, "{half} m");
    }
}

/// Land or its margin is entered. A motion outside own ship's limits, or with a NaN, is never
/// safe.
#[test]
fn land_and_motions_that_are_none_are_told() {
    let mut scene = scene(500.0, 0.0);
    let corners = [(700.0, 14.0), (800.0, 14.0), (750.0, 90.0)];
    let outline = corners.map(|(x, y)| Vector::new(x, y)).to_vec();
    let land = [Polygon::new(&[outline]).expect("a polygon")];
    for (margin, expected) in [(9.9, Safety::Safe), (10.1, Safety::Unsafe)] {
        let found = judged(&scene, &[], 0.0, &land, margin);
        assert_eq!(found.safety, expected, "{margin} m");
    }
    scene.scenario.own_ship.pose.position.y = 12.0;
    scene.held.start.position.y = 12.0;
    let aground = judged(&scene, &[], 0.0, &land, 0.0);
    assert_eq!(aground.safety, Safety::Collides);
    scene.held.start.position.x += 1.0;
    let elsewhere = judged(&scene, &[], 0.0, &[], 0.0);
    assert_eq!(elsewhere.safety, Safety::Unsafe);
    scene.held.duration = f64::NAN;
    assert!(!judged(&scene, &[], 0.0, &[], 0.0).safe());
}
