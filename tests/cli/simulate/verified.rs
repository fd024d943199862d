//! Plans and documents of simulations, verified; altered ones are rejected.

use super::HEAD_ON_FILE;
use crate::program::{Folder, HEAD_ON, document, json, number, run, says, searoom, stderr, stdout};

#[test]
fn every_plan_that_was_followed_verifies() {
    let folder = Folder::new();
    run(&format!("simulate {HEAD_ON_FILE} --plans {folder}/plans")).success();
    let files = folder.names("plans");
    assert!(files.len() > 10, "{files:?}");
    let files = files.iter().map(|name| format!(" {folder}/plans/{name}"));
    run(&format!("verify{}", files.collect::<String>())).success();
}

/// Plans that are kept after no set is over the last waypoint, and plans that are safe and at risk.
#[test]
fn what_the_closed_loop_says_of_its_plans_verifies() {
    for name in ["parts-arrival", "at-risk-and-safe"] {
        let folder = Folder::new();
        let file = format!("tests/faults/{name}.toml");
        let plans = folder.at("plans");
        let sailed = searoom(&["simulate", &file, "--json", "--plans", &plans]);
        let sailed = folder.write("sailed.json", stdout(&sailed));
        searoom(&["verify", &sailed]).success();
        let found = document(&searoom(&["verify", &plans, "--json"]).success());
        let verified: Vec<bool> = (found["plans"].as_array().expect("plans").iter())
            .map(|plan| plan["verified"] == true)
            .collect();
        assert!(
            verified.len() > 10 && verified.iter().all(|v| *v),
            "{name}: {verified:?}"
        );
        for plan in folder.names("plans") {
            let text = std::fs::read_to_string(folder.path().join("plans").join(&plan));
            let plan: serde_json::Value =
                serde_json::from_str(&text.expect("a plan")).expect("JSON");
            assert_eq!(plan["verified"], true, "{name}: {plan}");
        }
    }
}

/// An alarm says that own ship left its tracking margin, so that the claim that it did not makes nothing safe.
#[test]
fn an_alarm_outweighs_what_the_conduct_claims() {
    let folder = Folder::new();
    let mut sailed = json(&format!("simulate {HEAD_ON_FILE} --json"));
    assert_eq!(sailed["safe"], true);
    let alarm = serde_json::json!({ "t_s": 40.0, "alarm": "beyond the tracking margin" });
    sailed["alarms"].as_array_mut().expect("a list").push(alarm);
    let file = folder.write("sailed.json", sailed.to_string());
    let said = stdout(&searoom(&["verify", &file]).code(1));
    for what in [
        "conduct.within_tracking_margin: the document says true, it is false",
        "safe: the document says true, it is false",
    ] {
        assert!(said.contains(what), "{said}");
    }
}

/// Own ship jumps to and fro by 0.9 mm at each of 20 joints; and a joint beside a segment of no time.
#[test]
fn small_gaps_of_a_simulation_count_together() {
    let folder = Folder::new();
    let sailed = json(&format!("simulate {HEAD_ON_FILE} --json"));
    let check = |cut: &dyn Fn(&serde_json::Value) -> Vec<serde_json::Value>| {
        let mut changed = sailed.clone();
        let all = changed["sailed"].as_array_mut().expect("segments");
        let straight = all.iter().position(|s| s["turn_rate_deg_per_s"] == 0.0);
        let straight = straight.expect("a straight segment");
        let pieces = cut(&all[straight]);
        all.splice(straight..=straight, pieces);
        let name = folder.write("sailed.json", changed.to_string());
        searoom(&["verify", &name])
    };
    let pieces = |whole: &serde_json::Value, gap: f64| -> Vec<serde_json::Value> {
        let of = |value: &serde_json::Value| number(value);
        let (start, duration) = (&whole["start"], of(&whole["duration_s"]) / 20.0);
        let course = of(&start["course_deg"]).to_radians();
        let way = of(&whole["speed_mps"]) * duration;
        let piece = |k: u32| {
            let (mut piece, sailed) = (whole.clone(), way * f64::from(k));
            let aside = gap * f64::from(k % 2);
            piece["duration_s"] = duration.into();
            piece["start"]["t_s"] = (of(&start["t_s"]) + duration * f64::from(k)).into();
            let [east, north] = ["east_m", "north_m"].map(|key| of(&start[key]));
            piece["start"]["east_m"] = (east + course.sin() * sailed + course.cos() * aside).into();
            piece["start"]["north_m"] =
                (north + course.cos() * sailed - course.sin() * aside).into();
            piece
        };
        (0..20).map(piece).collect()
    };
    check(&|whole| pieces(whole, 0.0)).success();
    let shown = stdout(&check(&|whole| pieces(whole, 9e-4)).code(1));
    says(&shown, "REJECTED | sailed: gaps of | in all");
    let shown = stdout(
        &check(&|whole| {
            let mut none = whole.clone();
            none["duration_s"] = 0.0.into();
            vec![none, whole.clone()]
        })
        .code(1),
    );
    says(&shown, "REJECTED | lasts no time");
}

/// Contacts and distances are computed again from the motions alone.
#[test]
fn every_simulation_of_a_list_is_verified() {
    let folder = Folder::new();
    let two = format!("{HEAD_ON_FILE} scenarios/colregs/give-way.toml");
    let mut sailed = json(&format!("simulate {two} --json"));
    let list = folder.write("list.json", sailed.to_string());
    let shown = stdout(&searoom(&["verify", &list]).success());
    assert_eq!(shown.matches(": verified: no contact").count(), 2);
    let summary = "\n2 documents: 2 verified, 2 safe\n";
    assert!(shown.ends_with(summary), "{shown}");
    sailed["simulations"][1]["contact"] = true.into();
    let altered = folder.write("altered.json", sailed.to_string());
    let found = document(&searoom(&["verify", &altered, "--json"]).code(1));
    assert_eq!(found["verified"], 1);
    assert_eq!(found["plans"][1]["verified"], false);
    // what stands beside a list is not passed over
    let mut beside = sailed.clone();
    for key in ["format", "trajectory"] {
        beside[key] = "searoom-simulation/1".into();
        let file = folder.write("beside.json", beside.to_string());
        searoom(&["verify", &file]).code(2);
        beside.as_object_mut().expect("an object").remove(key);
    }
    sailed["simulations"][1]["format"] = "searoom-simulation/0".into();
    let old = folder.write("old.json", sailed.to_string());
    searoom(&["verify", &old]).code(2);
    let empty = folder.write("empty.json", "{\"simulations\": []}");
    let refused = searoom(&["verify", &empty]).code(2);
    says(&stderr(&refused), "empty.json: simulations: an empty list");
}

#[test]
fn the_land_of_a_simulation_is_checked_again() {
    let folder = Folder::new();
    let file = "scenarios/closed-loop/harbour-ferries.toml";
    let sailed = json(&format!("simulate {file} --json"));
    let check = |pointer: &str, value: serde_json::Value| {
        let mut changed = sailed.clone();
        *changed.pointer_mut(pointer).expect(pointer) = value;
        let name = folder.write("sailed.json", changed.to_string());
        searoom(&["verify", &name])
    };
    check("/duration_s", sailed["duration_s"].clone()).success();
    let near = sailed["sailed"][1]["start"].clone();
    let [x, y] = ["east_m", "north_m"].map(|key| number(&near[key]));
    let rock = serde_json::json!([[[x, y], [x + 9.0, y], [x, y + 9.0]]]);
    for (pointer, value) in [
        ("/land/least_m", 400.0.into()),
        ("/land/least_m", serde_json::Value::Null),
        ("/land/grounded", true.into()),
        ("/land/least_t_s", 12345.0.into()),
        ("/land", serde_json::Value::Null),
        ("/settings/map", false.into()),
        ("/land/polygons_m", serde_json::json!([])),
        ("/land/polygons_m", serde_json::json!([[[0.0, 0.0]]])),
        ("/land/polygons_m", rock),
    ] {
        let shown = stdout(&check(pointer, value).code(1));
        assert!(shown.contains("REJECTED"), "{pointer}: {shown}");
    }
}

/// The closest approach is in the last step.
#[test]
fn a_simulation_in_a_current_verifies_at_its_end() {
    let folder = Folder::new();
    let file = "scenarios/closed-loop/overtaking-rudder.toml";
    let sailed = searoom(&["simulate", file, "--duration-s", "150", "--json"]);
    let sailed = folder.write("sailed.json", stdout(&sailed.success()));
    searoom(&["verify", &sailed]).success();
}

#[test]
fn a_simulation_verifies_and_one_with_an_altered_verdict_or_motion_does_not() {
    let folder = Folder::new();
    let tables = "[simulation]\nvessel = { kind = \"nomoto\" }\n\
                  current = { speed_mps = 0.3, toward_deg = 10 }";
    let margins = "tracking_margin_m = 20.0\nsafety_margin_m";
    let steered = HEAD_ON.replace("safety_margin_m", margins);
    let steered = format!("{steered}\nbehaviour = {{ kind = \"mutual\" }}\n{tables}\n");
    let steered = folder.write("steered.toml", steered);
    for file in [HEAD_ON_FILE, &steered] {
        let sailed = json(&format!("simulate {file} --json"));
        let check = |change: &dyn Fn(&mut serde_json::Value)| {
            let mut changed = sailed.clone();
            change(&mut changed);
            let name = folder.write("sailed.json", changed.to_string());
            searoom(&["verify", &name])
        };
        let shown = stdout(&check(&|_| {}).success());
        let verdict = "Head-on: verified: no contact, safe, least distance ";
        assert!(shown.starts_with(verdict), "{shown}");
        for (pointer, value) in [
            ("/contact", true.into()),
            ("/safe", false.into()),
            ("/targets/0/least_clearance_m", 400.0.into()),
            ("/targets/0/contact_t_s", 100.0.into()),
            ("/targets/0/track/0/north_m", 170.0.into()),
            ("/sailed/0/start/north_m", 20.0.into()),
            ("/sailed/1/start/east_m", 45.3.into()),
            ("/sailed/1/start/course_deg", 91.7.into()),
            ("/sailed/1/duration_s", (-27.4).into()),
            ("/duration_s", 900.0.into()),
            ("/replans/1/safe", false.into()),
            ("/replans/1/verdict", "NOT SAFE".into()),
            ("/replans/1/verdict", "COLLIDES, deadline".into()),
            ("/replans/1/verdict", "at risk 0.90".into()),
            ("/replans/1/verdict", "relaxed".into()),
            ("/replans/1/verdict", "infeasible".into()),
            ("/replans/1/verdict", "fine".into()),
            ("/replans/1/verdict", "".into()),
            ("/replans/1/relaxations", serde_json::json!(["domain"])),
            ("/replans/1/cost_m2", serde_json::Value::Null),
            ("/replans/1/estimates", serde_json::json!([])),
            ("/replans", serde_json::json!([])),
            ("/targets", serde_json::json!([])),
            ("/targets/0/beam_m", 0.0.into()),
            ("/targets/0/least_clearance_t_s", (-1e9).into()),
            ("/conduct/unsafe_plans", 2.into()),
            ("/conduct/cost_m2", (-1.0).into()),
            ("/to_go_m", (-1.0).into()),
            ("/replans/0/reason", "period".into()),
            ("/replans/1/reason", "start".into()),
            ("/replans/1/reason", "why not".into()),
            ("/replans/1/reason", "acquired: target".into()),
            ("/replans/1/off_plan_m", (-1.0).into()),
            ("/replans/1/estimates/0/age_s", (-1.0).into()),
            ("/replans/1/estimates/0/speed_mps", (-1.0).into()),
            ("/replans/1/estimates/0/length_m", (-1.0).into()),
            ("/replans/1/estimates/0/beam_m", (-1.0).into()),
            ("/replans/1/estimates/0/position_std_m", (-1.0).into()),
            ("/replans/1/estimates/0/speed_spread_mps", (-1.0).into()),
            ("/replans/1/estimates/0/course_spread_deg", (-1.0).into()),
            ("/replans/1/estimates/0/starboard_turn_deg", (-181.0).into()),
        ] {
            let altered = check(&|document| {
                *document.pointer_mut(pointer).expect(pointer) = serde_json::Value::clone(&value);
            });
            let shown = stdout(&altered.code(1));
            assert!(shown.contains("REJECTED"), "{pointer}: {shown}");
        }
        let shown = stdout(&check(&|document| {
            document["replans"][1]["reason"] = "acquired: nobody".into();
            document["replans"][1]["estimates"][0]["age_s"] = (-2.0).into();
        }));
        says(
            &shown,
            "replans[1].reason: found 'acquired: nobody'; allowed: period | \
             replans[1].estimates[0].age_s: found -2; allowed: a number that is not negative",
        );
        check(&|document| document["sailed"][1]["crab_angle_deg"] = 3.3.into()).code(1);
        check(&|document| document["sailed"] = 3.into()).code(2);
        for (pointer, value, said) in [
            (
                "/replans/1/relaxations",
                serde_json::json!(["speed"]),
                "allowed: compliance, domain",
            ),
            (
                "/settings/sensor",
                "eyes".into(),
                "settings.sensor: found 'eyes'; allowed: exact, ais",
            ),
            (
                "/settings/vessel",
                "boat".into(),
                "settings.vessel: found 'boat'; allowed: kinematic, first-order, nomoto",
            ),
            (
                "/settings/vessel",
                serde_json::Value::Null,
                "settings.vessel: found null; allowed: kinematic, first-order, nomoto",
            ),
            (
                "/targets/0/behaviour",
                "wild".into(),
                "allowed: constant, random, extremes",
            ),
        ] {
            let unknown = check(&|document| {
                *document.pointer_mut(pointer).expect(pointer) = serde_json::Value::clone(&value);
            });
            let shown = stderr(&unknown.code(2));
            assert!(shown.contains(said), "{pointer}: {shown}");
        }
    }
}
