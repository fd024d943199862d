//! Wrong statements on risk, and sets that are too small, are detected.

use searoom::evaluation::Violation;
use searoom::geometry::{ConvexPolygon, outer_disc};
use searoom::obstacle::Obstacle;
use searoom::scenario::{Compliance, Scenario};
use searoom::target::{Motion, ShipTrack};
use serde_json::{Value, json};

use crate::alter::{assert_word, at, list};
use crate::documents::{barred, checked, document, give_way_at_risk, inside, is_caught, scenario};

/// Checks level sets millions of times smaller than the sets, and sets that hardly spread. The risk
/// depends on the last digits there, and the document must not report less than the check finds.
#[test]
fn plans_at_a_risk_pass_however_small_the_level_sets() {
    let plan = |max_risk: f64, target: &str| {
        let text = format!(
            r#"title = "risk"
            horizon_s = 400.0
            own_ship = {{ position = {{ east_m = 0.0, north_m = 0.0 }}, course_deg = 90.0, speed_mps = 5.0, length_m = 30.0,
                beam_m = 8.0, turning_radius_m = 0.001 }}
            mission = {{ waypoints = [{{ east_m = 0.0, north_m = 0.0 }}, {{ east_m = 1500.0, north_m = 0.0 }}] }}
            planner = {{ max_risk = {max_risk} }}
            [[targets]]
            name = "target"
            {target}"#
        );
        let written = document(Scenario::parse(&text).expect("a scenario"));
        let found = checked(&written);
        assert!(found.violations.is_empty(), "{:?}", found.violations);
        written["cost"]["max_risk"].as_f64().expect("a number")
    };
    // velocities from rest to twice the speed, along the hull
    let risk = plan(
        0.999999,
        r#"position = { east_m = 750.0, north_m = 0.0 }
        course_deg = 144.76848081611433
        speed_mps = 9.201127151574104
        length_m = 269.03333503864656
        beam_m = 1.3089970633978214
        speed_spread_mps = 32.28479795338985
        domain = "hull""#,
    );
    assert!((risk - 0.059130838).abs() < 1e-6, "{risk}");
    // sets that grow by a nanometre per second
    let risk = plan(
        0.5,
        r#"initial_set = { vertices_m = [[1399.7335538893385, -100.26644611066152], [1600.2664461106615, -100.26644611066152],
            [1600.2664461106615, 100.26644611066152], [1399.7335538893385, 100.26644611066152]] }
        velocity_sets = [{ until_s = 0.07809908373380123, vertices_mps = [[-0.8394706159325942, 0.0], [-0.8393040782734484, 0.0],
            [-0.8394706159325942, 2.9215047979011405e-11]] }, { vertices_mps = [[-0.8394706159325942, 0.0], [-0.8394706149325942, 0.0]] }]"#,
    );
    assert!(risk <= 0.5, "{risk}");
}

/// Tests a consistent but wrong largest risk: the level sets detect it.
#[test]
fn a_largest_risk_is_neither_more_nor_less_nor_at_another_time() {
    let mut told = 0;
    for (name, original, index) in [
        ("at a risk", give_way_at_risk(0.4), 0),
        ("inside", inside(), 0),
        ("barred", barred(), 0),
        ("barred, the other", barred(), 1),
    ] {
        assert!(!is_caught(&original), "{name}");
        let encounter = format!("/encounters/{index}");
        let risk = |d: &Value| {
            d.pointer(&format!("{encounter}/max_risk"))
                .and_then(Value::as_f64)
        };
        let said = risk(&original).expect("a risk");
        let target = original.pointer(&format!("{encounter}/target")).cloned();
        let tell = |risk: f64| {
            let mut document = original.clone();
            *at(&mut document, &format!("{encounter}/max_risk")) = json!(risk);
            for given_up in list(&mut document, "/relaxations") {
                let of_risk = given_up["kind"] == "risk";
                if of_risk && given_up.get("target") == target.as_ref() {
                    given_up["amount"] = json!(risk);
                }
            }
            let all = list(&mut document, "/encounters").iter();
            let most = all
                .filter_map(|e| e["max_risk"].as_f64())
                .fold(0.0, f64::max);
            *at(&mut document, "/cost/max_risk") = json!(most);
            document
        };
        // a risk of zero has no other value to replace it
        if said == 0.0 {
            continue;
        }
        told += 1;
        assert!(!is_caught(&tell(said)), "{name}");
        for wrong in [said * 0.999, said * 0.5, (said * 1.001).min(1.0)] {
            if wrong != said {
                assert!(is_caught(&tell(wrong)), "{name}: {wrong} instead of {said}");
            }
        }
        let mut late = original.clone();
        let time = format!("{encounter}/max_risk_t_s");
        let end = original["cost"]["duration_s"].as_f64().expect("s");
        let early = at(&mut late, &time).as_f64().expect("s") < 0.5 * end;
        *at(&mut late, &time) = json!(if early { end } else { 0.0 });
        assert!(is_caught(&late), "{name}: at another time");
        *at(&mut late, &time) = Value::Null;
        assert!(is_caught(&late), "{name}: at no time");
        let mut kept = original.clone();
        list(&mut kept, "/relaxations").retain(|r| r["kind"] != "risk");
        assert!(is_caught(&kept), "{name}: nothing given up");
        let mut clear = original.clone();
        *at(&mut clear, &format!("{encounter}/max_risk")) = Value::Null;
        assert!(is_caught(&clear), "{name}: no risk");
    }
    assert!(told >= 3, "{told}");
}

/// Tests consistent but wrong statements on a risk: it must be accepted, and must have a time.
#[test]
fn a_risk_is_within_what_was_accepted_and_has_a_time() {
    let mut risky = give_way_at_risk(0.4);
    assert!(at(&mut risky, "/encounters/0/max_risk_t_s").is_number());
    let clear = document(scenario("colregs/head-on.toml"));
    let forces = document(scenario("forces/give-way.toml"));
    let mut accepting = scenario("colregs/head-on.toml");
    accepting.max_risk = 0.4;
    accepting.targets[0].motion = {
        // far from the path
        let Motion::Ship(mut ship) = accepting.targets[0].motion.clone() else {
            panic!("a ship");
        };
        ship.pose.position.y += 5000.0;
        Motion::Ship(ship)
    };
    let accepting = document(accepting);
    let tell = |d: &mut Value, risk: f64, time: Value| {
        *at(d, "/encounters/0/max_risk") = json!(risk);
        *at(d, "/encounters/0/max_risk_t_s") = time;
        *at(d, "/cost/max_risk") = json!(risk.max(0.0));
        let target = at(d, "/encounters/0/target").clone();
        let given_up = list(d, "/relaxations");
        given_up.retain(|r| r["kind"] != "risk");
        if risk > 0.0 {
            given_up.push(json!({ "kind": "risk", "target": target, "amount": risk }));
        }
    };
    for (name, original) in [
        ("clear", &clear),
        ("forces", &forces),
        ("accepting", &accepting),
    ] {
        assert!(!is_caught(original), "{name}");
        for (risk, time, word) in [
            (0.5, json!(10.0), "max_risk: the document says 0.5, it is"),
            (-0.5, Value::Null, "max_risk: the document says -0.5, it is"),
            (
                0.0,
                json!(10.0),
                "max_risk_t_s: the document says 10, it is",
            ),
            (0.3, Value::Null, "max_risk_t_s: the document says nothing"),
        ] {
            let mut document = original.clone();
            tell(&mut document, risk, time);
            assert_word(&document, name, word);
        }
    }
    *at(&mut risky, "/encounters/0/max_risk_t_s") = Value::Null;
    let found = checked(&risky).violations;
    assert_eq!(found.len(), 1, "{found:#?}");
    assert!((found[0].what).contains("max_risk_t_s: the document says nothing"));
}

/// Tests sets that contain the required region in the first directions checked, but not everywhere.
#[test]
fn sets_that_only_seem_large_enough_are_too_small() {
    // an ellipse much longer than the true one and very thin, between two directions
    let mut needle = document(scenario("uncertainty/ellipse.toml"));
    let (sin, cos) = 0.0043_f64.sin_cos();
    let length: f64 = 1e10;
    *at(&mut needle, "/obstacles/0/initial_set/shape_m2") = json!([
        [length * cos * cos, length * cos * sin],
        [length * cos * sin, length * sin * sin]
    ]);
    assert_word(&needle, "needle", "too small for the initial set");
    // one-sided velocities: scaled about their own centre they contain all, but not about that of
    // the ship's velocities, nor those of half the risk
    let mut lopsided = give_way_at_risk(0.5);
    let corners: Vec<[f64; 2]> =
        serde_json::from_value(lopsided["obstacles"][0]["velocity_set"]["vertices_mps"].clone())
            .expect("corners");
    let [low, high] = [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| {
        [0, 1].map(|k| corners.iter().map(|c| c[k]).reduce(pick).expect("some"))
    });
    let middle = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
    // of the whole set, twice that of the level set
    let reach = (high[0] - low[0]).max(high[1] - low[1]);
    let (east, half) = (middle[0] + 1.6 * reach, 1.4 * reach);
    *at(&mut lopsided, "/obstacles/0/velocity_set/vertices_mps") = json!([
        [east - half, middle[1] - half],
        [east + half, middle[1] - half],
        [east + half, middle[1] + half],
        [east - half, middle[1] + half]
    ]);
    let small = "too small for the velocities of the target";
    for word in [small, "the velocities at the accepted risk"] {
        assert_word(&lopsided, "lopsided", word);
    }
}

/// Tests sets around the hull on the expected heading, and for a turning ship on those of its
/// course spread at the start. On another course, its bow is outside them.
#[test]
fn sets_around_a_hull_that_does_not_turn_with_its_course_are_too_small() {
    let around = |ship: &ShipTrack, hull: ConvexPolygon| {
        let own = scenario("colregs/head-on.toml").own_ship;
        let reach = own.hull.half_diagonal() + own.safety_margin + 3.0 * ship.position_std;
        hull.minkowski_sum(&outer_disc(reach, ship.pose.heading))
    };
    let plain = |set: &ConvexPolygon| {
        let corners: Vec<[f64; 2]> = set.vertices().iter().map(|p| [p.x, p.y]).collect();
        json!(corners)
    };
    let rejected = |document: &Value| {
        let found = checked(document).violations;
        assert!(!found.is_empty());
        for Violation { what, .. } in found {
            assert!(what.contains("too small for the hull"), "{what}");
        }
    };
    let mut straight = scenario("colregs/head-on.toml");
    straight.compliance = Compliance::None;
    let ship = straight.targets[0].ship().expect("a ship").clone();
    let mut altered = document(straight);
    let vertices = at(&mut altered, "/obstacles/0/initial_set/vertices_m");
    *vertices = plain(&around(&ship, ship.hull.polygon(&ship.pose)));
    rejected(&altered);

    let mut turning = scenario("uncertainty/turning.toml");
    turning.compliance = Compliance::None;
    let ship = turning.targets[0].ship().expect("a ship").clone();
    let velocities = ship.outer_velocity_sets(ship.turn_rate, turning.horizon);
    let initial = around(&ship, ship.outer_hull(0.0));
    let slabs = Obstacle::new("x", searoom::target::Uncertainty::new(initial, velocities))
        .expect("in order");
    let mut altered = document(turning);
    let entries = list(&mut altered, "/obstacles").iter_mut();
    for (entry, slab) in entries.zip(slabs.slabs()) {
        entry["initial_set"]["vertices_m"] = plain(&slab.obstacle().initial().outer_polygon(3));
    }
    rejected(&altered);
}
