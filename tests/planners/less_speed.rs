//! Less speed by the rules of the road.

use searoom::pipeline;
use searoom::scenario::Scenario;

/// Less speed that is kept for some time after passing may reach a corner of the route.
#[test]
fn less_speed_is_kept_on_the_route_only() {
    let text = r#"
        title = "Less speed before a corner"
        horizon_s = 359.1
        [own_ship]
        position = { east_m = 0.0, north_m = 0.0 }
        course_deg = 90.0
        speed_mps = 5.0
        length_m = 30.0
        beam_m = 8.0
        turning_radius_m = 100.0
        speeds_mps = [2.5, 5.0, 6.0]
        safety_margin_m = 20.0
        [mission]
        waypoints = [
            { east_m = 0.0, north_m = 0.0 }, { east_m = 405.01, north_m = 0.0 },
            { east_m = 706.65, north_m = -45.04 }, { east_m = 944.59, north_m = 116.11 },
        ]
        speed_mps = 5.0
        [planner]
        compliance = "rules"
        [[targets]]
        name = "t0"
        position = { east_m = 633.181, north_m = 373.244 }
        course_deg = 165.24
        speed_mps = 2.878
        length_m = 30.0
        beam_m = 8.0
    "#;
    let run = pipeline::run(Scenario::parse(text).expect("valid"));
    assert!(run.planned.outcome.plan().is_some(), "{:?}", run.planned);
}
