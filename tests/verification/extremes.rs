//! Plans at the ends of the numbers that are verified as planned: coordinates of 10,000 km, lengths
//! of millimetres, sets without width.

use searoom::scenario::Scenario;
use serde_json::{Value, json};

use crate::alter::at;
use crate::documents::{checked, document};

/// Plan document of a scenario, which the check accepts.
fn verified(text: &str) -> Value {
    let plan = document(Scenario::parse(text).expect("a scenario"));
    let found = checked(&plan);
    assert!(found.verified(), "{text}\n{:#?}", found.violations);
    plan
}

/// The target may head anywhere. Its set, moved 10,000 km away, lost an edge of 32 m, and own ship
/// was told 5 m too early that it had left it.
#[test]
fn a_set_far_from_the_origin_keeps_its_edges() {
    verified(
        r#"title = "far"
        horizon_s = 166
        own_ship = { position = { east_m = -9.9e6, north_m = 9.9e6 }, course_deg = 90, speed_mps = 5,
            length_m = 30, beam_m = 30, turning_radius_m = 90 }
        mission = { waypoints = [{ east_m = -9.9e6, north_m = 9.9e6 },
            { east_m = -9899500, north_m = 9.9e6 }, { east_m = -9899500, north_m = 9899862 }] }
        targets = [{ name = "t", position = { east_m = -9899500, north_m = 9899862 }, course_deg = 90,
            speed_mps = 10, length_m = 60, beam_m = 12, course_spread_deg = 180 }]"#,
    );
}

/// On a path 10,000 km away, a target turns. Own ship entered its hull by 0.9 mm.
#[test]
fn a_path_far_from_the_origin_is_clear_of_a_target_that_turns() {
    verified(
        r#"title = "far path"
        horizon_s = 860
        own_ship = { position = { east_m = -9.9e6, north_m = 9.9e6 }, course_deg = 0, speed_mps = 5,
            length_m = 0.1, beam_m = 0.001, turning_radius_m = 0.3, safety_margin_m = 1e-6 }
        planner = { kind = "path-time" }
        mission = { waypoints = [{ east_m = -9.9e6, north_m = 9.9e6 },
            { east_m = -9.9e6, north_m = 9900150 }, { east_m = -9899881.053, north_m = 9901645.276 },
            { east_m = -9900379.479, north_m = 9901684.925 }] }
        targets = [{ name = "t", position = { east_m = -9899940.527, north_m = 9901797.245 },
            course_deg = 180, speed_mps = 5, length_m = 0.001, beam_m = 0.001, course_spread_deg = 90,
            turn_rate_deg_per_s = 0.05 }]"#,
    );
}

/// The path of 1 cm starts 5e-8 rad off own ship's course, which is an arc of 0.15 nm.
#[test]
fn an_arc_below_a_nanometre_is_no_jump_of_the_heading() {
    let plan = verified(
        r#"title = "1 cm"
        horizon_s = 0.013
        own_ship = { position = { east_m = 9997000, north_m = 0 }, course_deg = 45, speed_mps = 1,
            length_m = 30, beam_m = 0.3, turning_radius_m = 0.003 }
        mission = { waypoints = [{ east_m = 9997000, north_m = 0 },
            { east_m = 9997000.007071069, north_m = 0.007071067811865476 }] }
        targets = [{ name = "t",
            initial_set = { center_m = [9997000.007, 0.007], shape_m2 = [[1e-12, 0], [0, 1e-12]] },
            velocity_set = { center_mps = [0, 0], shape_m2_per_s2 = [[1, 0], [0, 1]] } }]"#,
    );
    let mut turned = plan;
    *at(&mut turned, "/own_ship/course_deg") = json!(45.00001);
    assert!(!checked(&turned).verified());
}

/// The velocities of one interval lie on a line to one rounding, so that a level set of a hundredth
/// is a segment with another centre.
#[test]
fn the_level_set_of_a_sliver_is_held_against_the_set_that_was_given() {
    let plan = verified(
        r#"title = "sliver"
        horizon_s = 1000
        own_ship = { position = { east_m = 0, north_m = 0 }, course_deg = 90, speed_mps = 5,
            length_m = 30, beam_m = 8, turning_radius_m = 100 }
        planner = { max_risk = 0.97 }
        mission = { waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 1500, north_m = 0 }] }
        targets = [{ name = "t",
            initial_set = { vertices_m = [[700, 900], [800, 900], [750, 950]] },
            velocity_set = { vertices_mps = [[0.455, 1.076526665820302],
                [0.455206, 1.0765266658203023], [0.455207, 1.0765266658203037]] } }]"#,
    );
    let mut small = plan;
    *at(&mut small, "/obstacles/0/velocity_set/vertices_mps") = json!([[0.4551, 1.0765266]]);
    assert!(!checked(&small).verified());
}

/// One ellipse of 1 nm grows in one direction, another of 50 km is half a metre wide. Their
/// distances depend on the digits of the shape matrices.
#[test]
fn distances_from_narrow_ellipses_are_those_of_the_document() {
    verified(
        r#"title = "needle"
        horizon_s = 1300
        own_ship = { position = { east_m = 123456.789, north_m = -7654321.25 }, course_deg = 90,
            speed_mps = 1, length_m = 30, beam_m = 7.5, turning_radius_m = 30 }
        planner = { kind = "path-time" }
        mission = { waypoints = [{ east_m = 123456.789, north_m = -7654321.25 },
            { east_m = 124456.8, north_m = -7654321.25 }, { east_m = 124457, north_m = -7654321.25 }] }
        targets = [{ name = "t",
            initial_set = { center_m = [123486, -7654321.25], shape_m2 = [[1e-18, 0], [0, 1e-20]] },
            velocity_set = { center_mps = [1, 0], shape_m2_per_s2 = [[9, 0], [0, 0]] } }]"#,
    );
    verified(
        r#"title = "long"
        horizon_s = 7428
        own_ship = { position = { east_m = 0, north_m = 0 }, course_deg = -339, speed_mps = 15,
            length_m = 10000, beam_m = 2500, turning_radius_m = 1000 }
        mission = { waypoints = [{ east_m = 0, north_m = 0 }, { east_m = -673, north_m = 2247 },
            { east_m = -4975, north_m = 16617 }, { east_m = -3559, north_m = 11887 }] }
        targets = [{ name = "t",
            initial_set = { center_m = [19871, 24055], shape_m2 = [
                [2421808881.864566, -435159676.8809365], [-435159676.8809365, 78191118.1379344]] },
            velocity_set = { center_mps = [-21.5, -6.433], shape_m2_per_s2 = [[0, 0], [0, 0]] } }]"#,
    );
}

/// A set of 5,000 km has corners at which the boundary turns by less than a nanoradian.
#[test]
fn corners_that_a_sum_omits_do_not_decide_a_distance() {
    verified(
        r#"title = "5,000 km"
        horizon_s = 45.54884651286998
        own_ship = { position = { east_m = 381435.9998617235, north_m = 5296736.1744884895 },
            course_deg = 30.53694536610714, speed_mps = 9.33652641445461, length_m = 10, beam_m = 1.7,
            turning_radius_m = 80, safety_margin_m = 10,
            speeds_mps = [0, 4.668263207227305, 9.33652641445461] }
        planner = { max_risk = 0.8, compliance = "none" }
        mission = { waypoints = [{ east_m = 381435.9998617235, north_m = 5296736.1744884895 },
            { east_m = 381469.0888383011, north_m = 5296792.265683994 },
            { east_m = 381603.83514155855, north_m = 5296852.288258125 }] }
        targets = [{ name = "t", initial_set = { vertices_m = [
                [381547.6240484204, 5296634.251012713], [381545.7965539156, 5296635.729237435],
                [381538.7626457647, 5296600.005412816], [381545.07525811926, 1e-12]] },
            velocity_set = { vertices_mps = [[-0.03407662709903455, 13.397882331066501],
                [-0.03407556744089834, 13.397882796525515],
                [-0.03407547825628056, 13.397883042506267]] } }]"#,
    );
}

/// A set of 3 m by a hundredth of a nanometre has no depth, for the planner as for the check.
#[test]
fn a_set_thinner_than_its_shape_matrix_tells_is_left_for_good() {
    verified(
        r#"title = "no depth"
        horizon_s = 559
        own_ship = { position = { east_m = 0, north_m = 0 }, course_deg = 90, speed_mps = 0.01,
            length_m = 0.1, beam_m = 0.025, turning_radius_m = 0.01 }
        mission = { waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 1, north_m = 0 },
            { east_m = 4, north_m = 0 }, { east_m = 4.3, north_m = 0 }] }
        targets = [
            { name = "point", initial_set = { vertices_m = [[4, 0]] },
                velocity_set = { vertices_mps = [[0, 0]] } },
            { name = "sliver", initial_set = { vertices_m = [[4, 0]] }, representation = "ellipsoid",
                velocity_set = { vertices_mps = [[0, 0], [0, 9.95030017433486e-12], [-0.01, 0]] } }]"#,
    );
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
    let plan = verified(
        r#"title = "no risk"
        horizon_s = 200
        own_ship = { position = { east_m = 0, north_m = 0 }, course_deg = 283.00345941932255,
            speed_mps = 5, length_m = 5, beam_m = 1.25, turning_radius_m = 0.001, safety_margin_m = 5 }
        planner = { compliance = "rules", max_risk = 0.5 }
        mission = { waypoints = [{ east_m = 0, north_m = 0 },
            { east_m = -487.17824042826777, north_m = 112.50494235017821 }] }
        targets = [{ name = "t", representation = "ellipsoid",
            initial_set = { vertices_m = [[-725.7673606424016, 168.75741352526728]] },
            velocity_set = { vertices_mps = [[3.4517398813529097, -0.5625247166466086],
                [7.331608867708269, -0.5625247107350423], [1.4200425229297688, -0.5625247068551732],
                [-2.459826463425591, -0.5625247127667395]] } }]"#,
    );
    assert_eq!(plan["cost"]["max_risk"], json!(0.0));
}

/// Half a turn is 36 times 5° or 37 times a little less: 12° are read as they were written.
#[test]
fn a_turn_rate_is_written_as_it_is_read() {
    let plan = verified(
        r#"title = "turns"
        horizon_s = 30
        own_ship = { position = { east_m = 0, north_m = 0 }, course_deg = 0, speed_mps = 3,
            length_m = 3000, beam_m = 750, turning_radius_m = 9000 }
        mission = { waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 0, north_m = 90 }] }
        targets = [{ name = "t", position = { east_m = -3858, north_m = 0 }, course_deg = 107,
            speed_mps = 5, length_m = 300, beam_m = 60, turn_rate_deg_per_s = 12 }]"#,
    );
    assert_eq!(
        plan["targets"][0]["ship"]["turn_rate_deg_per_s"],
        json!(12.0)
    );
}

/// The planner adds up the error of its motion in other units and about another origin.
#[test]
fn the_objective_is_that_of_the_motion_in_the_document() {
    let plan = verified(
        r#"title = "objective"
        horizon_s = 260
        own_ship = { position = { east_m = 760725, north_m = 7090795 }, course_deg = 269.99999978740294,
            speed_mps = 11, length_m = 10, beam_m = 2, turning_radius_m = 40 }
        mission = { waypoints = [{ east_m = 760725, north_m = 7090794.7 },
            { east_m = 760233.6, north_m = 7090794.7 }, { east_m = 759858, north_m = 7090525 }] }"#,
    );
    let cost = &plan["cost"];
    assert_eq!(cost["objective"], cost["space_time_error_m2"]);
}

/// The horizon ends with the mission, to a rounding: the path is sailed in changing speeds, and
/// nobody calls this holding course and speed.
#[test]
fn a_ship_in_a_hurry_holds_no_speed() {
    let plan = verified(
        r#"title = "hurry"
        horizon_s = 1724.6007952942944
        own_ship = { position = { east_m = 1743.3424886686007, north_m = 9921.694137605988 },
            course_deg = 288.50378808286035, speed_mps = 8.314572191039607, length_m = 300, beam_m = 50,
            turning_radius_m = 2400, safety_margin_m = 300 }
        planner = { compliance = "rules", max_risk = 0.05 }
        mission = { waypoints = [{ east_m = 1743.3424886686007, north_m = 9921.694137605988 },
            { east_m = -11854.670946804734, north_m = 14472.525485459377 }] }
        targets = [{ name = "t", position = { east_m = -1741, north_m = 10244.6 }, course_deg = 348.06,
            speed_mps = 2.165, length_m = 449, beam_m = 75, speed_spread_mps = 0.5,
            course_spread_deg = 5 }]"#,
    );
    assert_eq!(plan["escape"], Value::Null);
}
