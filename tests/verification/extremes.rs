//! Plans at the ends of the numbers that are verified as planned: coordinates of 10,000 km, lengths
//! of millimetres, sets without width.

use searoom::scenario::Scenario;
use serde_json::{Value, json};

use crate::alter::at;
use crate::documents::{checked, document, fault};

/// Plan document of a scenario, which the check accepts.
fn verified(text: &str) -> Value {
    let plan = document(Scenario::parse(text).expect("a scenario"));
    let found = checked(&plan);
    assert!(found.verified(), "{text}\n{:#?}", found.violations);
    plan
}

/// Plan document of a scenario in `tests/faults`, which the check accepts.
fn verified_file(name: &str) -> Value {
    verified(&fault(&format!("{name}.toml")))
}

/// Plans that are what they say: something given up when the time was out, a node at a rounding
/// past a whole second, ellipses and sets at the ends of the numbers, an arc of a millimetre at the
/// end of a long way; a ship that stands on from beside its leg by a rounding; one that has arrived
/// within a set; a plan until the horizon near a ship that turns; places 10,000 km from the origin.
#[test]
fn sound_plans_at_the_ends_of_the_numbers_are_verified() {
    for name in [
        "deadline-without-relaxation",
        "stays-without-domains",
        "forces-node",
        "ellipse-1e-300",
        "left-set",
        "millimetre-radius",
        "millimetre-arcs",
        "hold-with-a-rounding",
        "arrived-inside",
        "horizon-at-a-turn",
        "known-route-entered",
        "leg-ends-at-the-horizon",
        "far-set",
        "far-path",
        "needle",
        "long-ellipse",
        "omitted-corners",
        "no-depth",
        "explicit-sliver",
        // its centre is found again from the numbers of the document
        "wide-ellipse-at-risk",
    ] {
        verified_file(name);
    }
}

/// The path of 1 cm starts 5e-8 rad off own ship's course, which is an arc of 0.15 nm.
#[test]
fn an_arc_below_a_nanometre_is_no_jump_of_the_heading() {
    let mut turned = verified_file("arc-below-a-nanometre");
    *at(&mut turned, "/own_ship/course_deg") = json!(45.0001);
    assert!(!checked(&turned).verified());
}

/// The velocities of one interval lie on a line to one rounding, so that a level set of a hundredth
/// is a segment with another centre.
#[test]
fn the_level_set_of_a_sliver_is_held_against_the_set_that_was_given() {
    let mut small = verified_file("sliver");
    *at(&mut small, "/obstacles/0/velocity_set/vertices_mps") = json!([[0.4551, 1.0765266]]);
    assert!(!checked(&small).verified());
}

/// Own ship starts on a set that has no inside then. The plan leaves it, and is not called safe.
#[test]
fn a_start_on_a_point_or_a_segment_is_a_start_inside() {
    let still = "velocity_set = { vertices_mps = [[0, 0]] }";
    let growing = "velocity_set = { vertices_mps = [[0, 0], [0.3, 0], [0, 0.3]] }";
    let round = "center_mps = [0.1, 0.2], shape_m2_per_s2 = [[0.1, 0], [0, 0.1]]";
    let rounds = format!("velocity_sets = [{{ until_s = 50, {round} }}, {{ {round} }}]");
    let round = format!("velocity_set = {{ {round} }}");
    for (planner, [initial, velocity]) in [
        ("space-time", ["vertices_m = [[0, 0]]", growing]),
        ("path-time", ["vertices_m = [[0, -30], [0, 30]]", growing]),
        ("space-time", ["vertices_m = [[-30, 0], [30, 1e-6]]", still]),
        (
            "space-time",
            ["center_m = [0, 0], shape_m2 = [[0, 0], [0, 0]]", &rounds],
        ),
        (
            "path-time",
            ["center_m = [0, 0], shape_m2 = [[0, 0], [0, 900]]", &round],
        ),
    ] {
        let plan = verified(&format!(
            r#"title = "on a point"
            horizon_s = 300
            own_ship = {{ position = {{ east_m = 0, north_m = 0 }}, course_deg = 90, speed_mps = 4,
                length_m = 30, beam_m = 8, turning_radius_m = 100 }}
            planner = {{ kind = "{planner}" }}
            mission = {{ waypoints = [{{ east_m = 0, north_m = 0 }}, {{ east_m = 800, north_m = 0 }}] }}
            targets = [{{ name = "t", initial_set = {{ {initial} }}, {velocity} }}]"#
        ));
        let reason = plan["reason"].as_str().expect("a reason");
        assert!(reason.starts_with("own ship starts inside the set of 't'"));
        let words = [&plan["outcome"], &plan["verdict"], &plan["safe"]];
        assert_eq!(
            words,
            [&json!("relaxed"), &json!("NOT SAFE"), &json!(false)]
        );
    }
}

/// The ellipse around a needle and a disc is wider than both. A plan beside the needle takes no risk.
#[test]
fn a_needle_that_is_passed_is_no_risk() {
    let plan = verified_file("needle-without-risk");
    assert_eq!(plan["cost"]["max_risk"], json!(0.0));
}

/// A set that is flat for two seconds was enlarged for the planner, also when it has grown.
#[test]
fn a_risk_in_a_set_that_was_flat_is_accepted() {
    let plan = verified_file("flat-interval-risk");
    assert!(plan["encounters"][1]["max_risk"].as_f64() > Some(0.0));
}

/// Half a turn is 36 times 5° or 37 times a little less: 12° are read as they were written.
#[test]
fn a_turn_rate_is_written_as_it_is_read() {
    let plan = verified_file("turn-rate");
    assert_eq!(
        plan["targets"][0]["ship"]["turn_rate_deg_per_s"],
        json!(12.0)
    );
}

/// The planner adds up the error of its motion in other units and about another origin.
#[test]
fn the_objective_is_that_of_the_motion_in_the_document() {
    let plan = verified_file("objective");
    let cost = &plan["cost"];
    assert_eq!(cost["objective"], cost["space_time_error_m2"]);
}

/// The horizon ends with the mission, to a rounding: the path is sailed in changing speeds, and
/// nobody calls this holding course and speed.
#[test]
fn a_ship_in_a_hurry_holds_no_speed() {
    let plan = verified_file("hurry");
    assert_eq!(plan["escape"], Value::Null);
}
