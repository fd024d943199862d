//! Commands that check and plan.

use std::fs;

use super::program::{
    Folder, HEAD_ON, assert_values, document, head_on_without_planner, json, list, number, rows,
    run, says, searoom, stdout, text, untimed,
};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};
use serde_json::Value;

#[test]
fn the_scenarios_of_the_project_are_good() {
    let checked = searoom(&["check", "scenarios"])
        .success()
        .stdout(contains("scenarios/colregs/head-on.toml: ok"))
        .stdout(contains("scenarios/imazu/imazu.json: imazu-22: ok"));
    // the only messages are notes on what imported files leave out
    let messages = String::from_utf8_lossy(&checked.get_output().stderr).into_owned();
    let foreign = ["dnv", "imazu", "commonocean"].map(|f| format!("note: scenarios/{f}/"));
    for line in messages.lines() {
        assert!(foreign.iter().any(|f| line.starts_with(f)), "{line}");
    }
}

#[test]
fn every_fault_of_a_file_is_reported_at_once() {
    let folder = Folder::new();
    let file = folder.write(
        "bad.toml",
        HEAD_ON
            .replace("horizon_s = 400.0", "horizon_s = -1")
            .replace("course_deg = 90.0", "course_deg = \"east\"")
            .replace("length_m = 30.0", "length_m = nan")
            .replace("turning_radius_m = 100.0", "turning_radius_m = 0")
            .replace("safety_margin_m", "safty_margin_m")
            .replace("spread_mps = 0.5", "spread_mps = -0.5\nspeed_kn = 3")
            .replace("1500.0, north_m = 0.0 }]", "0, north_m = 0 }]"),
    );
    let mut assert = searoom(&["check", &file]).code(2).stdout(is_empty());
    for expected in [
        "bad.toml: 8 faults",
        "line 3: horizon_s: found -1; allowed: a number from 0.001 to 1000000",
        "line 7: own_ship.course_deg: found the text \"east\"; allowed: a number from -360 to 360",
        "own_ship.length_m: found nan",
        "own_ship.turning_radius_m: found 0; allowed: a number from 0.001",
        "own_ship.safty_margin_m: found an unknown key, perhaps for 'safety_margin_m'; allowed: one of ",
        "mission.waypoints[1]: found the waypoint before it again",
        "targets[0].speed_spread_mps: found -0.5; allowed: a number from 0 to 100",
        "targets[0].speed_kn: found speed_kn beside speed_mps; allowed: one of the two, not both",
    ] {
        assert = assert.stderr(contains(expected));
    }
}

#[test]
fn rules_are_kept_by_the_space_time_planner_alone() {
    let folder = Folder::new();
    let file = folder.write("ruled.toml", HEAD_ON);
    searoom(&["plan", &file])
        .code(0)
        .stdout(contains("relaxed").not());
    // another planner on the command line keeps the domains in their place
    let other = searoom(&["plan", &file, "--planner", "path-time", "--json"]);
    assert_eq!(document(&other)["compliance"], "shape");
    let asked = HEAD_ON.replacen("[planner]", "[planner]\nkind = \"path-time\"", 1);
    let asked = folder.write("asked.toml", asked);
    searoom(&["plan", &asked])
        .code(2)
        .stdout(is_empty())
        .stderr(contains("planner.compliance").and(contains("path-time")));
    let unknown = folder.write("unknown.toml", HEAD_ON.replacen("rules", "rule", 1));
    searoom(&["plan", &unknown])
        .code(2)
        .stderr(contains("planner.compliance").and(contains("\"none\", \"shape\", \"rules\"")));
}

/// Requests that the path-time planner or another planner refuses: the lines before the mission,
/// its alternatives, and the message. `TIME` is the table of the path-time planner.
const UNFIT: &str = r#"
TIME\nobjective = "length-risk" | | planner.risk_weight_m: found nothing
TIME\nrisk_weight_m = 5 | | only the objective "length-risk"
[planner]\nobjective = "time" | | planner.objective: found "time" for the space-time planner
 | 0, 0; 9, 9 | mission.alternatives: found other paths for the space-time planner
TIME | 0, 900; 9, 900 | mission.alternatives[0]: found a path that shares no point
TIME | 0, 0; 9, 900 | mission.alternatives[0]: found a path on no way
TIME | 0, 0; 0, 0 | mission.alternatives[0][1]: found the waypoint before it again
"#;

#[test]
fn what_does_not_fit_the_planner_is_named() {
    let folder = Folder::new();
    let path_time = "[planner]\nkind = \"path-time\"\n";
    let refused = |contents: &str, expected: &str| {
        let file = folder.write("unfit.toml", contents);
        for command in ["check", "plan", "suite"] {
            searoom(&[command, &file])
                .code(2)
                .stderr(contains(expected).and(contains("line ")));
        }
    };
    let head_on = head_on_without_planner();
    let with = |before: &str| head_on.replacen("[mission]", &format!("{before}\n[mission]"), 1);
    for [planner, others, said] in rows(UNFIT) {
        let scenario = with(&planner.replace("TIME", path_time));
        let places = others
            .split("; ")
            .filter_map(|place| place.split_once(", "));
        let places: Vec<String> = places
            .map(|(east, north)| format!("{{ east_m = {east}, north_m = {north} }}"))
            .collect();
        let others = format!("[mission]\nalternatives = [[{}]]", places.join(", "));
        let scenario = match &places[..] {
            [] => scenario,
            _ => scenario.replacen("[mission]", &others, 1),
        };
        refused(&scenario, &said);
    }
    let start = "position = { east_m = 0.0, north_m = ";
    refused(
        &with(path_time).replacen(&format!("{start}0.0"), &format!("{start}3.0"), 1),
        "own_ship.position: found a start 3 m from the first waypoint",
    );
    // the command line asks for what the file is not for
    let scenario = with(&format!("{path_time}objective = \"time\""));
    let file = folder.write("unfit.toml", scenario);
    // head-on on one path there is no way past each other
    searoom(&["plan", &file])
        .code(1)
        .stdout(contains("meets the set of 'target'"));
    searoom(&["plan", &file, "--planner", "space-time"])
        .code(2)
        .stdout(is_empty())
        .stderr(contains("unfit.toml: 1 fault").and(contains("planner.objective")));
}

#[test]
fn files_that_are_none_are_named() {
    let folder = Folder::new();
    folder.write("bytes.toml", [0x74, 0xff, 0x00]);
    folder.refuses(
        "
        check DIR/missing.toml | missing.toml: cannot be read
        plan DIR/missing.toml | missing.toml: cannot be read
        plan DIR | a folder | suite
        check DIR/bytes.toml | found bytes that are not text at byte 1
        plan | Usage
        suite --json --figure x.svg | --figure x.svg: a file, but there are
        suite --figure x.pdf | --figure: x.pdf | .svg
        ",
    );
    let empty = Folder::new();
    for (name, said) in [("", "without scenarios"), ("x.toml", "cannot be read")] {
        let suite = searoom(&["suite", &empty.at(name)]).code(2);
        suite.stderr(contains(said));
    }
}

/// Values of the document of a suite with a broken file.
const BROKEN_SUITE: &str = r#"
/runs/0/outcome "solved"
/runs/1/outcome "unreadable"
/runs/2/scenario "Last"
/summary/scenarios 3
/summary/solved 2
/summary/unreadable 1
/summary/verified 2
"#;

#[test]
fn a_suite_goes_on_after_a_broken_file() {
    let folder = Folder::new();
    folder.write("a/good.toml", HEAD_ON);
    folder.write("a.toml", "title = 3");
    folder.write("z.toml", HEAD_ON.replace("Head-on", "Last"));
    folder.write(".hidden/x.toml", "");
    folder.write("notes.txt", "");
    let plans = Folder::new();
    let assert = run(&format!("suite {folder} --json --plans {plans}"))
        .code(2)
        .stderr(contains("a.toml: ").and(contains("title: found 3")));
    let suite = document(&assert);
    let runs = list(&suite["runs"]);
    let files: Vec<_> = runs.iter().map(|run| run["file"].as_str()).collect();
    let expected = ["a/good.toml", "a.toml", "z.toml"].map(|name| folder.at(name));
    assert_eq!(files, expected.each_ref().map(|file| Some(file.as_str())));
    assert_values(&suite, BROKEN_SUITE);
    assert_eq!(plans.names(""), ["a__good.json", "z.json"]);
    searoom(&["suite", text(folder.path())])
        .code(2)
        .stdout(contains("unreadable").and(contains("3 scenarios: 2 solved, 1 unreadable")));
}

#[test]
fn two_results_never_share_a_file() {
    let folder = Folder::new();
    let a = folder.write("a/same.toml", HEAD_ON);
    let b = folder.write("b/same.toml", HEAD_ON);
    searoom(&["suite", &a, &b, "--plans", &folder.at("plans")])
        .code(2)
        .stdout(is_empty())
        .stderr(contains("'same'"));
    assert!(!folder.path().join("plans").exists());
}

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
/relaxation null
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
    // from within a set there is a way out, and the document claims no more
    let plan = searoom(&["plan", &inside, "--json"]).code(1);
    let text = stdout(&plan);
    let plan = document(&plan);
    assert_eq!(plan["outcome"], "relaxed");
    let given_up = &plan["relaxation"];
    assert_eq!(given_up["kind"], "risk");
    assert_eq!(given_up["amount"], 1.0);
    let until = number(&given_up["until_s"]);
    let valid = &plan["obstacles"][0]["valid_s"];
    assert_eq!(valid[0].as_f64(), Some(until));
    says(plan["reason"].as_str().expect("a text"), "starts inside");
    let check = |text: &str| {
        let file = folder.write("plan.json", text);
        searoom(&["verify", &file])
    };
    check(&text)
        .success()
        .stdout(contains("verified, not safe: COLLIDES"))
        .stdout(contains("nothing is claimed of it before"));
    // claimed from too early, never claimed, not reported, or of a set that has shrunk
    let earlier = text.replace(&until.to_string(), &(until - 1.0).to_string());
    check(&earlier).code(1).stdout(contains("set of"));
    let never = text.replace(&until.to_string(), "1000000");
    check(&never).code(2).stderr(contains("valid_s"));
    check(&text.replace("\"relaxed\"", "\"solved\""))
        .code(1)
        .stdout(contains("outcome"));
    let mut small = plan.clone();
    let vertices = &mut small["obstacles"][0]["initial_set"]["vertices_m"];
    for p in vertices.as_array_mut().expect("vertices") {
        p[0] = Value::from(number(&p[0]) + 1.0);
    }
    check(&small.to_string())
        .code(1)
        .stdout(contains("the positions possible"));
}

/// Behind a slower ship, on a path without a way past: clear up to the horizon, which is no plan to
/// the end.
#[test]
fn a_plan_that_does_not_arrive_says_so() {
    let folder = Folder::new();
    let along = "plan scenarios/colregs/overtaking.toml --planner path-time";
    run(along)
        .code(1)
        .stdout(contains("does not arrive").and(contains("m are left at the horizon")))
        .stdout(contains("COLLIDES").not().and(contains("NOT SAFE").not()));
    let text = stdout(&run(&format!("{along} --json")).code(1));
    let plan: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(plan["relaxation"]["kind"], "arrival");
    assert_eq!(plan["cost"]["arrived"], false);
    assert_eq!(plan["cost"]["delay_s"], Value::Null);
    let file = folder.write("plan.json", &text);
    searoom(&["verify", &file]).success();
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
fn the_legs_of_a_plan_are_printed_and_written_as_a_route() {
    let folder = Folder::new();
    let file = folder.write("plan.toml", HEAD_ON);
    let placed = format!("origin = {{ lat_deg = 59.0, lon_deg = 10.5 }}\n{HEAD_ON}");
    let placed = folder.write("placed.toml", placed);
    let route = |name: &str| folder.path().join(name);
    let csv = route("route.csv");
    searoom(&["plan", &file, "--route", text(&csv)])
        .success()
        .stdout(contains("what happens").and(contains("closest to 'target'")));
    let rows = fs::read_to_string(&csv).expect("written");
    assert!(rows.starts_with("leg,from_s,to_s,from_east_m"), "{rows}");
    for name in ["route.geojson", "route.rtz"] {
        let written = route(name);
        searoom(&["plan", &file, "--route", text(&written)])
            .code(2)
            .stderr(contains("found a scenario without 'origin'"));
        assert!(!written.exists());
        searoom(&["plan", &placed, "--route", text(&written)]).success();
        assert!(written.exists());
    }
    // a wait on the path is a stay
    let waits = "scenarios/dnv/traffic_situation_05.json";
    let written = route("waits.rtz");
    let asked = ["--planner", "path-time", "--compliance", "none"];
    searoom(&[&["plan", waits, "--route", text(&written)], &asked[..]].concat()).success();
    let rtz = fs::read_to_string(&written).expect("written");
    assert!(rtz.contains("stay=\"00:06:37\""), "{rtz}");
    let other = route("route.txt");
    searoom(&["plan", &file, "--route", text(&other)])
        .code(2)
        .stdout(is_empty())
        .stderr(contains(
            "allowed: a file that ends in .csv, .geojson or .rtz",
        ));
    let forces = [
        "plan",
        "scenarios/forces/give-way.toml",
        "--route",
        text(&csv),
    ];
    searoom(&forces)
        .code(2)
        .stderr(contains("there are no legs"));
}

/// Level sets shrink about the middle of the velocities, which is not the expected one here.
#[test]
fn a_starboard_turn_and_an_accepted_risk_exclude_each_other() {
    let folder = Folder::new();
    let turning = HEAD_ON.replace("beam_m = 12.0", "beam_m = 12.0\nstarboard_turn_deg = 30.0");
    let file = folder.write("turning.toml", turning);
    searoom(&["plan", &file]).success();
    searoom(&["plan", &file, "--max-risk", "0.2"])
        .code(2)
        .stderr(contains("planner.max_risk: found 0.2; allowed: 0"));
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

/// A route that was written is the mission of the next scenario: its plan is as long, and its
/// speeds are those of the legs.
#[test]
fn a_route_is_a_mission() {
    let folder = Folder::new();
    let file = |name: &str| text(&folder.path().join(name)).to_owned();
    let origin = "origin = { lat_deg = 59.0, lon_deg = 10.5 }";
    let placed = folder.write("placed.toml", format!("{origin}\n{HEAD_ON}"));
    searoom(&["plan", &placed, "--route", &file("first.rtz")]).success();
    let first = json(&format!("plan {placed} --json"));
    let alone = HEAD_ON.split("[[targets]]").next().expect("a part");
    let from = alone.find("waypoints = ").expect("waypoints");
    let to = from + alone[from..].find('\n').expect("a line");
    let with = |mission: &str| format!("{origin}\n{}{mission}{}", &alone[..from], &alone[to..]);
    let routed = with("route = \"first.rtz\"");
    let routed = routed.replace("speed_mps = 5.0\n\n[planner]", "[planner]");
    let again = folder.write("again.toml", &routed);
    let plan = json(&format!("plan {again} --json"));
    let waypoints = list(&plan["mission"]["waypoints"]);
    let written = fs::read_to_string(file("first.rtz")).expect("written");
    assert_eq!(waypoints.len(), written.matches("<waypoint id").count());
    let speeds = written.split("speed=\"").skip(2);
    let speeds = speeds.map(|rest| rest.split('"').next().expect("an end"));
    let knots: Vec<f64> = speeds.map(|s| s.parse().expect("a number")).collect();
    let legs = list(&plan["mission"]["leg_speeds_mps"]);
    assert!(knots.len() == legs.len() && knots.iter().any(|k| *k != knots[0]));
    for (knots, mps) in knots.iter().zip(legs) {
        assert!((knots * 1852.0 / 3600.0 - number(mps)).abs() < 1e-9);
    }
    let [first, again] = [&first, &plan].map(|plan| number(&plan["cost"]["length_m"]));
    assert!((first - again).abs() < 0.02 * first, "{first} {again}");
    for (mission, found) in [
        ("route = \"none.rtz\"", "none.rtz, which cannot be read"),
        ("route = \"placed.toml\"", "placed.toml: line 1: "),
        ("route = 5", "mission.route: found 5"),
        (
            "route = \"first.rtz\"\nwaypoints = []",
            "nothing: the route has them",
        ),
    ] {
        let bad = folder.write("bad.toml", with(mission));
        searoom(&["plan", &bad]).code(2).stderr(contains(found));
    }
    let far = with("route = \"first.rtz\"").replace("lat_deg = 59.0", "lat_deg = 49.0");
    let far = folder.write("far.toml", far);
    searoom(&["plan", &far])
        .code(2)
        .stderr(contains("mission.route: found").and(contains("km from the origin")));
}

#[cfg(not(feature = "recording"))]
#[test]
fn recordings_need_their_feature() {
    for command in ["suite", "simulate"] {
        searoom(&[command, "scenarios/colregs", "--rrd", "recordings/"])
            .code(2)
            .stdout(is_empty())
            .stderr(contains("built without recordings"));
    }
}

#[cfg(feature = "recording")]
#[test]
fn recordings_are_named_after_their_scenarios() {
    let folder = Folder::new();
    // the parent of the folder named is where names begin
    folder.write("scenes/colregs/head-on.toml", HEAD_ON);
    let below = folder.at("scenes");
    searoom(&["suite", &below, "--rrd", text(folder.path())]).success();
    let recording = folder.path().join("colregs__head-on.rrd");
    assert!(fs::metadata(recording).expect("a recording").len() > 1000);
    let file = folder.at("one.rrd");
    run(&format!("plan scenarios/colregs/head-on.toml --rrd {file}")).success();
    assert!(fs::metadata(&file).expect("a recording").is_file());
    searoom(&["suite", "scenarios/colregs", "--rrd", &file])
        .code(2)
        .stderr(contains("4 scenarios"));
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

/// HEAD_ON with another first position and the given waypoints, without its target's motion in the
/// way.
fn with_waypoints(own: &str, waypoints: &str) -> String {
    let at = HEAD_ON.find("waypoints").expect("a mission");
    let line = &HEAD_ON[at..at + HEAD_ON[at..].find('\n').expect("a line")];
    HEAD_ON
        .replacen("position = { east_m = 0.0, north_m = 0.0 }", own, 1)
        .replacen(line, waypoints, 1)
        .replacen("horizon_s = 400.0", "horizon_s = 900.0", 1)
}

#[test]
fn a_ship_at_the_last_waypoint_has_arrived() {
    let folder = Folder::new();
    let own = "position = { east_m = 700.0, north_m = 900.0 }";
    let waypoints = "waypoints = [{ east_m = 0, north_m = 900 }, { east_m = 700, north_m = 900 }]";
    let file = folder.write("there.toml", with_waypoints(own, waypoints));
    let document = json(&format!("plan {file} --json"));
    assert_eq!(document["outcome"], "solved");
    assert_eq!(document["cost"]["duration_s"], 0.0);
}

#[test]
fn legs_shorter_than_a_turn_are_cut_short_and_too_many_are_refused() {
    let folder = Folder::new();
    let own = "position = { east_m = 0.0, north_m = 900.0 }";
    let zigzag = |count: usize| {
        let points: Vec<String> = (0..count)
            .map(|i| format!("{{ east_m = {}, north_m = {} }}", 15 * i, 900 + 5 * (i % 2)))
            .collect();
        with_waypoints(own, &format!("waypoints = [{}]", points.join(", ")))
    };
    let file = folder.write("zigzag.toml", zigzag(99));
    let document = json(&format!("plan {file} --json"));
    assert_eq!(document["verified"], true);
    assert!(number(&document["cost"]["length_m"]) < 1600.0);
    let file = folder.write("many.toml", zigzag(200));
    let refused = searoom(&["check", &file]).code(2);
    refused.stderr(contains("mission.waypoints: found 200 positions"));
}

#[test]
fn sets_of_one_point_block_too() {
    let folder = Folder::new();
    let alone = HEAD_ON.split("[[targets]]").next().expect("a part");
    let text = alone.to_owned()
        + "[[targets]]\nname = \"buoy\"\ninitial_set = { vertices_m = [[700.0, 0.0]] }\n\
           velocity_set = { vertices_mps = [[-1.0, 0.0]] }\n";
    let file = folder.write("point.toml", text);
    let document = json(&format!("plan {file} --json"));
    assert_eq!(document["verified"], true);
    assert!(document["cost"]["space_time_error_m2"].as_f64() > Some(0.0));
}

#[cfg(unix)]
#[test]
fn a_pipe_is_not_waited_for() {
    let folder = Folder::new();
    let pipe = folder.path().join("pipe.toml");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    if made.is_ok_and(|status| status.success()) {
        searoom(&["suite", text(folder.path())]).code(2);
    }
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

/// The head-on scene some whole seconds later, own ship metres beside its plan.
fn later_on(plan: &Value, seconds: u32, beside: f64) -> String {
    let samples = list(&plan["trajectory"]["samples"]);
    let elapsed = f64::from(seconds) - plan["time_s"].as_f64().unwrap_or(0.0);
    let now = samples.iter().find(|s| s["t_s"] == elapsed);
    let now = now.expect("a sample");
    let place = "position = { east_m = 0.0, north_m = 0.0 }\ncourse_deg = 90.0";
    let there = format!(
        "position = {{ east_m = {}, north_m = {} }}\ncourse_deg = {}",
        number(&now["east_m"]) + beside,
        now["north_m"],
        now["course_deg"]
    );
    let target = format!("position = {{ east_m = {}.0", 1500 - 5 * seconds);
    let later = HEAD_ON
        .replace("horizon_s", &format!("time_s = {seconds}.0\nhorizon_s"))
        .replace(place, &there)
        .replace("[mission]", "[mission]\nstart_s = 0.0")
        .replace("position = { east_m = 1500.0", &target);
    assert!(later.contains(&there));
    later
}

/// The earlier velocities are kept for the same set, given about the course that the target has
/// now. They are not kept for a set of equal width to another side.
#[test]
fn velocities_are_kept_only_for_a_target_that_may_do_no_more() {
    let folder = Folder::new();
    let target = "course_deg = 270.0                   # westwards, straight at own ship";
    let with = |text: &str, course: f64, spread: f64, turn: f64| {
        let turned = format!("starboard_turn_deg = {turn:?}\ncourse_deg = {course:?}");
        let spread = format!("course_spread_deg = {spread:?}");
        text.replace(target, &turned)
            .replace("course_spread_deg = 5.0", &spread)
    };
    for (before, after, kept) in [
        ([270.0, 5.0, 10.0], [278.0, 7.0, -6.0], true),
        ([270.0, 5.0, 0.0], [270.0, 0.0, 10.0], false),
    ] {
        let scene = |text: &str, [course, spread, turn]: [f64; 3]| with(text, course, spread, turn);
        let file = folder.write("first.toml", scene(HEAD_ON, before));
        let first = json(&format!("plan {file} --json"));
        let previous = folder.write("first.json", first.to_string());
        let file = folder.write("later.toml", scene(&later_on(&first, 20, 0.0), after));
        let later =
            document(&searoom(&["plan", &file, "--previous", &previous, "--json"]).success());
        let velocities = &later["targets"][0]["ship"]["kept_velocities"];
        assert_eq!(velocities.is_object(), kept, "{after:?}: {velocities}");
    }
}

#[test]
fn a_plan_goes_on_from_the_previous_one() {
    let folder = Folder::new();
    let first = json("plan scenarios/colregs/head-on.toml --json");
    let previous = folder.write("first.json", first.to_string());
    let later = later_on(&first, 60, 0.0);
    let file = folder.write("later.toml", later.clone());
    let go_on = |file: &str| searoom(&["plan", file, "--previous", &previous, "--json"]);
    let second = document(&go_on(&file).success());
    // the same manoeuvre, not a turn back
    let begins = |plan: &Value| number(&plan["manoeuvres"][0]["begins_s"]);
    assert!((begins(&first) - 60.0 - begins(&second)).abs() < 1e-9);
    assert_eq!(second["encounters"][0]["roles"][0]["from_s"], -60.0);
    assert_eq!(second["encounters"][0]["violations"], Value::Array(vec![]));
    // without the previous plan own ship turns back at once
    let anew = json(&format!("plan {file} --json"));
    let side = |plan: &Value| plan["cost"]["first_turn"]["side"].clone();
    assert_eq!(side(&anew), "port");
    assert_ne!(anew["encounters"][0]["violations"], Value::Array(vec![]));
    let verified = folder.write("second.json", second.to_string());
    searoom(&["verify", &verified]).success();

    // a metre beside the plan its remainder is of no use, but the manoeuvre goes on
    let beside = folder.write("beside.toml", later_on(&first, 60, 1.0));
    let third = document(&go_on(&beside).success());
    assert!((begins(&first) - 60.0 - begins(&third)).abs() < 1e-9);
    assert_eq!(third["memory"]["keeps_plan"], false);
    assert_eq!(third["encounters"][0]["violations"], Value::Array(vec![]));

    // within its tracking margin own ship goes on from the plan
    let first_ship = |margin: &str, beside| {
        let text = later_on(&first, 60, beside);
        let own = format!("[own_ship]\ntracking_margin_m = {margin}");
        let text = text.replace("[own_ship]", &own);
        folder.write("near.toml", text)
    };
    let near = document(&go_on(&first_ship("1.5", 1.0)).success());
    assert_eq!(near["own_ship"]["position"], second["own_ship"]["position"]);
    assert_eq!(near["trajectory"], second["trajectory"]);
    assert_eq!(near["memory"]["off_plan_m"], 1.0);
    let far = document(&go_on(&first_ship("1.5", 1.6)).success());
    assert_eq!(far["memory"]["off_plan_m"], Value::Null);
    assert_eq!(far["memory"]["keeps_plan"], false);
    let refused = searoom(&["check", &first_ship("31.0", 1.0)]).code(2);
    let fault = "own_ship.tracking_margin_m: found 31; allowed: at most 20";
    refused.stderr(contains(fault));

    // on the way back a little beside the plan, it sails no circle
    let times = (160..=224).step_by(4);
    for (seconds, beside) in times.flat_map(|s| [3e-4, -4e-4, 0.01].map(|beside| (s, beside))) {
        let file = later_on(&second, seconds, beside);
        let file = folder.write("back.toml", file);
        let back = searoom(&["plan", &file, "--previous", &verified, "--json"]).success();
        let delay = document(&back)["cost"]["delay_s"].as_f64();
        let soon = delay.is_some_and(|delay| delay < 10.0);
        assert!(soon, "{seconds} {beside}: {delay:?}");
    }

    // a target that moved within its spread keeps to the velocities of both plans
    let moved = later.replace("course_deg = 270.0", "course_deg = 274.0");
    let moved = document(&go_on(&folder.write("moved.toml", moved)).success());
    assert!(moved["targets"][0]["ship"]["kept_velocities"].is_object());
    let moved = folder.write("moved.json", moved.to_string());
    searoom(&["verify", &moved]).success();

    // a remainder at a speed that is no longer own ship's is not kept
    let slower = later.replace("[2.5, 5.0, 6.0]", "[2.5, 6.0]");
    assert_ne!(slower, later);
    let slower = document(&go_on(&folder.write("slower.toml", slower)).success());
    assert_eq!(slower["memory"]["keeps_plan"], false);

    let turned = later.replace("course_deg = 270.0", "course_deg = 250.0");
    let turned = folder.write("turned.toml", turned);
    let turned = document(&go_on(&turned).success());
    let outside = &turned["memory"]["outside_velocities"];
    assert_eq!(*outside, serde_json::json!(["target"]));
    assert_eq!(turned["targets"][0]["ship"]["kept_velocities"], Value::Null);

    let renamed = later.replace("name = \"target\"", "name = \"other\"");
    let renamed = folder.write("renamed.toml", renamed);
    let renamed = searoom(&["plan", &renamed, "--previous", &previous]);
    let unknown = "'target' of the previous plan is not in this file";
    renamed.stdout(contains(unknown));
}

/// A text of the scenario, what replaces it, and why the previous plan does not fit.
const UNFIT_PREVIOUS: &str = r#"
time_s = 60.0 | time_s = 600.0 | time_s: found a plan from 0 s to
title = "Head-on" | title = "Other" | allowed: a plan of "Other"
course_deg = 1 | course_deg = 2 | allowed: at most 30 m, own length, and 20 degrees
"#;

#[test]
fn a_previous_plan_that_does_not_fit_is_named() {
    let folder = Folder::new();
    let first = json("plan scenarios/colregs/head-on.toml --json");
    let previous = folder.write("first.json", first.to_string());
    let mut altered = first.clone();
    altered["own_ship"]["length_m"] = 31.0.into();
    let altered = folder.write("altered.json", altered.to_string());
    let later = later_on(&first, 60, 0.0);
    for [old, new, message] in rows(UNFIT_PREVIOUS) {
        let changed = later.replace(&old, &new);
        assert_ne!(changed, later);
        let file = folder.write("changed.toml", changed);
        let refused = searoom(&["plan", &file, "--previous", &previous]).code(2);
        refused.stdout(is_empty()).stderr(contains(message));
        let ignored = ["plan", &file, "--previous", &previous, "--ignore-previous"];
        searoom(&ignored).stderr(contains("ignored"));
    }
    let file = folder.write("later.toml", later);
    let refused = searoom(&["plan", &file, "--previous", &altered]).code(2);
    refused.stderr(contains("not a plan that verifies"));
    searoom(&["plan", &file, "--previous", "none.json"]).code(2);
}

#[test]
fn limits_of_risk_and_of_ample_time_can_be_set() {
    let folder = Folder::new();
    let scenario = fs::read_to_string("scenarios/colregs/give-way.toml").expect("a scenario");
    let plan = |limit: &str| {
        let text = scenario.replace("[planner]", &format!("[planner]\n{limit}"));
        let file = folder.write("limits.toml", text);
        json(&format!("plan {file} --json"))
    };
    let lead = |plan: &Value| plan["encounters"][0]["manoeuvre"]["lead_s"].as_f64();
    let early = plan("");
    assert_eq!(early["thresholds"], "searoom");
    let late = plan("ample_time_s = 110.0");
    let limits = "searoom, with the limits of the scenario";
    assert_eq!(late["thresholds"], limits);
    assert!(lead(&early) > Some(125.0) && lead(&late) > Some(105.0));
    assert!(lead(&late) < Some(115.0));
    // collision is risk at any distance; ships that pass at 60 m are not at a limit of 50 m
    let nearest = plan("cpa_limit_m = 0.0");
    assert_eq!(nearest["encounters"][0]["role"], "give-way");
    let aside = |limit: &str| {
        let text = scenario
            .replace("[planner]", &format!("[planner]\n{limit}"))
            .replace("safety_margin_m = 20.0", "safety_margin_m = 2.0")
            .replace("north_m = -750.0", "north_m = -600.0");
        assert!(text.contains("-600.0"), "the target is moved");
        let file = folder.write("aside.toml", text);
        json(&format!("plan {file} --json"))["encounters"][0]["role"].clone()
    };
    assert_eq!(aside("cpa_limit_m = 50.0"), "none");
    assert_eq!(aside("cpa_limit_m = 150.0"), "give-way");
}

/// Keys of a target, and their fault.
const ROLE_FAULTS: &str = r#"
role = "captain" | targets[0].role: found the text "captain"
role = "stand-on"\nrole_since_s = 91.0 | a number from 0 to 90
role_since_s = 5.0 | targets[0].role_since_s: found 5
"#;

#[test]
fn roles_of_a_file_last() {
    let folder = Folder::new();
    let with = |keys: &str| {
        let text = HEAD_ON.replace("name = \"target\"", &format!("name = \"target\"\n{keys}"));
        let text = text.replace("horizon_s", "time_s = 90.0\nhorizon_s");
        folder.write("roles.toml", text)
    };
    // head-on by geometry
    let file = with("role = \"stand-on\"\nrole_since_s = 30.0\nfirst_course_deg = 85.0");
    let plan = document(&searoom(&["plan", &file, "--json"]));
    assert_eq!(plan["encounters"][0]["role"], "stand-on");
    assert_eq!(plan["encounters"][0]["roles"][0]["from_s"], -60.0);
    for [keys, message] in rows(ROLE_FAULTS) {
        let file = with(&keys);
        searoom(&["check", &file]).code(2).stderr(contains(message));
    }
}
