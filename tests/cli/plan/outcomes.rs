//! What a plan says: its outcome, its document, and options of the command line.

use std::fs;

use crate::program::{
    Folder, HEAD_ON, assert_values, document, json, list, number, run, says, searoom, stdout,
    untimed,
};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

/// Values of the plan document of the head-on scenario.
const PLAN: &str = r#"
/format "searoom-plan/1"
/scenario "Head-on"
/planner "space-time"
/search "a-star"
/compliance "rules"
/outcome "solved"
/encounters/0/target "target"
/encounters/0/role "head-on"
/encounters/0/passing_side "port"
/obstacles/0/name "target"
/encounters/0/roles/0/role "head-on"
/verified true
/cost/arrived true
/relaxations []
/departure/side "starboard"
/land []
"#;

#[test]
fn a_plan_document_has_what_the_contract_names() {
    let plan = json("plan scenarios/colregs/head-on.toml --json");
    assert_values(&plan, PLAN);
    assert_eq!(plan["encounters"][0]["scores"].get("rule_15"), None);
    // own ship goes east and turns to starboard first: positive, toward the south
    let segments = list(&plan["trajectory"]["segments"]);
    let rates = segments
        .iter()
        .filter_map(|s| s["turn_rate_deg_per_s"].as_f64());
    let first = rates.into_iter().find(|rate| *rate != 0.0);
    assert!(first.is_some_and(|rate| rate > 0.0), "{first:?}");
    let samples = list(&plan["trajectory"]["samples"]);
    let north = |s: &Value| number(&s["north_m"]);
    assert!(samples.iter().map(north).fold(0.0, f64::min) < -10.0);
    let course = |s: &Value| number(&s["course_deg"]);
    assert!(samples.iter().map(course).fold(0.0, f64::max) > 95.0);
}

#[test]
fn the_same_scenario_gives_the_same_document() {
    let args = ["suite", "scenarios/colregs", "--json"];
    let (one, two) = (searoom(&args).success(), searoom(&args).success());
    assert!(untimed(document(&one)) == untimed(document(&two)));
}

#[test]
fn options_replace_what_the_scenario_says() {
    let file = "scenarios/colregs/head-on.toml";
    let args = ["--json", "--search", "dijkstra", "--compliance", "none"];
    let plan = document(&searoom(&[&["plan", file], args.as_slice()].concat()).success());
    assert_eq!(plan["search"], "dijkstra");
    assert_eq!(plan["compliance"], "none");
    searoom(&["plan", file, "--search", "best"])
        .code(2)
        .stderr(contains("a-star, dijkstra"));
}

#[test]
fn no_plan_is_an_answer() {
    let folder = Folder::new();
    let inside = folder.write(
        "inside.toml",
        HEAD_ON.replace("position = { east_m = 1500.0", "position = { east_m = 30.0"),
    );
    let late = HEAD_ON.replace("horizon_s = 400.0", "horizon_s = 40.0");
    let late = folder.write("late.toml", late);
    let plan = document(&searoom(&["plan", &late, "--json"]).code(1));
    assert_eq!(plan["outcome"], "infeasible");
    assert!(plan["cost"].is_null() && plan["trajectory"].is_null());
    assert_eq!(plan["verified"], false);
    assert!(plan["reason"].is_string());
    assert!(plan["encounters"][0]["dcpa_m"].is_null());
    searoom(&["plan", &late])
        .code(1)
        .stdout(contains("infeasible"));
    searoom(&["suite", &late, "scenarios/colregs/head-on.toml"])
        .code(1)
        .stdout(contains(
            "2 scenarios: 1 solved, 1 infeasible; 1 verified, 1 safe",
        ));
    // from within a set there is a way out, and it is not said to be more
    let plan = searoom(&["plan", &inside, "--json"]).code(1);
    let file = folder.write("plan.json", stdout(&plan));
    let plan = document(&plan);
    let given_up = &plan["relaxations"][0];
    assert_eq!(given_up["kind"], "risk");
    assert_eq!(given_up["amount"], 1.0);
    let valid = &plan["obstacles"][0]["valid_s"];
    assert_eq!(valid[0], given_up["until_s"]);
    says(plan["reason"].as_str().expect("a text"), "starts inside");
    searoom(&["verify", &file])
        .success()
        .stdout(contains("nothing is claimed of it before"));
}

/// Behind a slower ship, on a path without a way past: clear up to the horizon, which is no plan to
/// the end.
#[test]
fn a_plan_that_does_not_arrive_says_so() {
    let along = "plan scenarios/colregs/overtaking.toml --planner path-time";
    run(along)
        .code(1)
        .stdout(contains("does not arrive").and(contains("m are left at the end of the plan")))
        .stdout(contains("COLLIDES").not().and(contains("NOT SAFE").not()))
        .stdout(contains("J is counted until 300.0 s"));
    // a comparison counts it alike
    let file = "scenarios/colregs/overtaking.toml --planner path-time --json";
    let compared = document(&run(&format!("compare {file}")).code(1));
    let [entry, ..] = list(&compared["comparisons"][0]["entries"]) else {
        panic!("{compared}");
    };
    let planned = document(&run(&format!("plan {file}")).code(1));
    for key in ["space_time_error_m2", "space_time_error_until_s"] {
        assert_eq!(entry["cost"][key], planned["cost"][key], "{key}");
    }
}

/// Times of the hulls deepest in each other, of their first contact and of entry into the set.
#[test]
fn each_command_says_of_what_its_time_of_a_collision_is() {
    for (command, told) in [
        (
            "plan",
            "on the desired trajectory the hulls overlap by 21.0 m at 150 s",
        ),
        (
            "compare",
            "collides with 'target' at 146 s, when the hulls first touch",
        ),
        ("assess", "at dCPA 0.0 it enters the set at tCPA"),
    ] {
        run(&format!("{command} scenarios/colregs/give-way.toml")).stdout(contains(told));
    }
    // nothing is entered 400 m abeam
    let folder = Folder::new();
    let scenario = fs::read_to_string("scenarios/colregs/give-way.toml").expect("a scenario");
    let away = scenario.replace("north_m = -750.0", "north_m = -1750.0");
    let file = folder.write("away.toml", away);
    run(&format!("assess {file}")).stdout(contains("to the hard sets\n"));
}

#[test]
fn a_distance_to_a_set_is_no_distance_of_hulls() {
    run("plan scenarios/paper/figure_1.toml")
        .success()
        .stdout(contains("closest: 0.0016 m to its set at "))
        .stdout(contains(
            "on the desired trajectory 17.5 m deep in its set at 50 s",
        ))
        .stdout(contains("0.0016 m to the hard sets; after arrival"));
}

#[test]
fn without_targets_there_is_no_clearance() {
    let folder = Folder::new();
    let alone = HEAD_ON.split("[[targets]]").next().expect("a part");
    let file = folder.write("alone.toml", alone);
    let plan = json(&format!("plan {file} --json"));
    assert!(plan["cost"]["min_clearance_m"].is_null());
    assert_eq!(plan["encounters"], Value::Array(Vec::new()));
    searoom(&["plan", &file]).success().stdout(contains("none"));
}

#[test]
fn sets_are_of_the_kind_that_was_asked_for() {
    let folder = Folder::new();
    let file = folder.write("risk.toml", HEAD_ON);
    searoom(&["plan", &file, "--max-risk", "1"])
        .code(2)
        .stderr(contains("0 to 0.999999"));
    for (change, key, entries) in [
        ("representation = \"ellipsoid\"", "shape_m2", 1),
        ("turn_rate_deg_per_s = 0.05", "vertices_m", 4),
    ] {
        let text = HEAD_ON.replacen("beam_m = 12.0", &format!("beam_m = 12.0\n{change}"), 1);
        let file = folder.write("kind.toml", text);
        let plan = json(&format!("plan {file} --json"));
        let obstacles = list(&plan["obstacles"]);
        assert_eq!(obstacles.len(), entries, "{change}");
        assert!(obstacles.iter().all(|o| o["initial_set"][key].is_array()));
        assert_eq!(plan["cost"]["max_risk"], 0.0);
    }
}

/// A new file that plans at once, and nothing over another one.
#[test]
fn a_scenario_to_begin_with_is_written_once() {
    let folder = Folder::new();
    let file = folder.at("mine.toml");
    searoom(&["init", &file])
        .success()
        .stdout(contains("next: searoom plan"));
    searoom(&["plan", &file])
        .success()
        .stdout(contains("solved (verified, safe)"));
    let written = fs::read_to_string(&file).expect("written");
    searoom(&["init", &file])
        .code(2)
        .stderr(contains("found a file; allowed: a new name"));
    assert_eq!(fs::read_to_string(&file).expect("kept"), written);
    searoom(&["init", &folder.at("no/such/folder.toml")]).code(2);
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_fault() {
    use std::process::{Command, Stdio};
    let mut child = Command::new(env!("CARGO_BIN_EXE_searoom"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["plan", "scenarios/colregs/head-on.toml", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("ended");
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty());
}

/// A time of no return that cannot be sought is no silence.
#[test]
fn a_plan_on_a_path_says_why_it_has_no_time_of_no_return() {
    let scenario = "scenarios/harbour/ferry-crossing.toml";
    let plan = searoom(&["plan", scenario, "--no-return", "--json"])
        .success()
        .stderr(contains("this one is of the path-time planner"));
    assert!(document(&plan).get("time_of_no_return_s").is_none());
}

/// Sixty targets, a hundred waypoints: one node of the search alone took half a minute.
#[test]
fn a_deadline_is_kept_among_many_targets_and_waypoints() {
    let folder = Folder::new();
    let mut scenario = String::from(
        "title = \"many\"\nhorizon_s = 6400.0\n[own_ship]\nposition = { east_m = 0.0, north_m = 0.0 }\ncourse_deg = 90.0\n\
         speed_mps = 5.0\nlength_m = 30.0\nbeam_m = 8.0\nturning_radius_m = 100.0\nspeeds_mps = [2.5, 5.0, 6.0]\n[planner]\ncompliance = \"shape\"\ndeadline_s = 0.4\n",
    );
    let zigzag: Vec<String> = (0..100)
        .map(|i| (200 * i, i * 37 % 80 - 40))
        .map(|(east, north)| format!("{{ east_m = {east}.0, north_m = {north}.0 }}"))
        .collect();
    scenario += &format!("[mission]\nwaypoints = [{}]\n", zigzag.join(", "));
    for k in 0..60 {
        // across the route from either side, so that it would be met there
        let (time, speed) = (f64::from(k) * 60.0 + 200.0, f64::from(k % 5) + 3.0);
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        scenario += &format!(
            "[[targets]]\nname = \"{k}\"\nposition = {{ east_m = {:?}, north_m = {:?} }}\ncourse_deg = {:?}\nspeed_mps = {speed:?}\n\
             length_m = 60.0\nbeam_m = 12.0\nspeed_spread_mps = 0.1\n",
            5.0 * time,
            side * speed * time,
            90.0 + 90.0 * side,
        );
    }
    let file = folder.write("many.toml", &scenario);
    // how far the search gets depends on the machine: with a plan that is clear of the ships, the
    // status is 0
    let ended = searoom(&["plan", &file, "--json"]).code(vec![0, 1]);
    let plan = document(&ended);
    assert_eq!(plan["outcome"], "deadline");
    let relaxed = list(&plan["relaxations"]).iter();
    let arrives = !relaxed.clone().any(|r| r["kind"] == "arrival");
    let is_good = plan["safe"] == true && arrives;
    assert_eq!(is_good, ended.get_output().status.success());
    let took = number(&plan["timing"]["plan_s"]);
    // far more than is left over, for a machine with other things to do
    assert!((0.4..1.2).contains(&took), "{took}");
}

/// Own ship would arrive a few nanoseconds after the horizon.
#[test]
fn an_arrival_at_the_horizon_is_no_fault_of_the_program() {
    let planned = run("plan tests/faults/arrives-at-the-horizon.toml");
    let status = planned.get_output().status.code();
    assert!(matches!(status, Some(0 | 1)), "{status:?}");
}

/// Text, document and table say what made the plan, and have nodes where a graph was searched.
#[test]
fn a_plan_says_what_made_it() {
    for (asked, method, words) in [
        (
            "scenarios/colregs/head-on.toml",
            "rules",
            "space-time, by the rules",
        ),
        (
            "scenarios/colregs/head-on.toml --search dijkstra",
            "rules",
            "space-time, by the rules",
        ),
        (
            "scenarios/colregs/head-on.toml --compliance shape",
            "a-star",
            "space-time, A*",
        ),
        (
            "scenarios/colregs/head-on.toml --compliance shape --search dijkstra",
            "dijkstra",
            "space-time, Dijkstra",
        ),
        (
            "scenarios/harbour/alternative-path.toml",
            "path-time-graph",
            "path-time, path-time graph",
        ),
        (
            "scenarios/forces/give-way.toml",
            "optimal-control",
            "optimal-control",
        ),
        (
            "tests/faults/least-harm-at-anchor.toml",
            "least-harm",
            "least harm",
        ),
    ] {
        let searched = !["optimal-control", "least-harm"].contains(&method);
        let [plan, text] = ["--json", ""].map(|json| run(&format!("plan {asked} {json}")));
        let plan = document(&plan);
        assert_eq!(plan["method"], method, "{asked}");
        let expanded = &plan["search_stats"]["expanded"];
        if method != "least-harm" {
            assert_eq!(expanded.is_number(), searched, "{asked}: {expanded}");
        }
        let text = stdout(&text);
        let planner = text.lines().find(|line| line.trim().starts_with("planner"));
        assert!(planner.expect("a line").contains(words), "{text}");
        let is_asked_of_claims = text.contains("V, which is assumed");
        assert!(
            is_asked_of_claims && text.contains("83, 57 and 45 %"),
            "{text}"
        );
        let table = stdout(&run(&format!("suite {asked}")));
        let label = words.rsplit(", ").next().expect("a word");
        let label = label.replace("optimal-", "optimal ");
        let row = table.lines().find(|line| line.contains(&label));
        assert!(row.is_some(), "{asked}: {table}");
        if method == "rules" {
            assert!(row.is_some_and(|row| !row.contains(" – ")), "{table}");
            assert!(!text.contains("A*") && !text.contains("Dijkstra"), "{text}");
        }
    }
    // nothing was searched, so no search is named
    let folder = Folder::new();
    let head_on = fs::read_to_string("scenarios/colregs/head-on.toml").expect("text");
    let short = head_on.replace("horizon_s = 400.0", "horizon_s = 100.0");
    let file = folder.write("short.toml", short);
    let plan = run(&format!("plan {file}")).code(1);
    let text = stdout(&plan);
    assert!(text.contains("planner      space-time\n"), "{text}");
    let plan = document(&run(&format!("plan {file} --json")));
    assert!(plan["method"].is_null(), "{}", plan["method"]);
}
