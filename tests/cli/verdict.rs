//! Every view of a plan agrees: whether it is verified and safe, and the word of its outcome.

use std::fs;

use super::program::{Folder, HEAD_ON, document, json, list, number, run, says, searoom, stdout};
use predicates::str::contains;
use serde_json::{Value, json};

/// The head-on scenario with its target in another place.
fn with_target_at(place: &str) -> String {
    let here = "position = { east_m = 1500.0, north_m = 0.0 }\n";
    HEAD_ON.replace(here, &format!("position = {{ east_m = {place} }}\n"))
}

/// Own ship and a target whose hulls overlap at the start.
fn overlapping() -> String {
    with_target_at("30.0, north_m = 0.0")
}

/// A target abeam on the same course at the same speed, nearer than the margin, and nothing unknown
/// of her.
fn abeam() -> String {
    let text =
        with_target_at("0.0, north_m = 25.0").replace("course_deg = 270.0", "course_deg = 90.0");
    let is_spread = |l: &&str| l.starts_with("speed_spread") || l.starts_with("course_spread");
    let lines: Vec<&str> = text.lines().filter(|l| !is_spread(l)).collect();
    lines.join("\n")
}

/// One word for one plan in every view, and never "verified" without what else is so.
#[test]
fn a_plan_that_is_not_safe_says_so_in_every_view() {
    for (name, scene, word) in [
        ("overlapping", overlapping(), "COLLIDES"),
        ("abeam", abeam(), "NOT SAFE"),
    ] {
        let folder = Folder::new();
        let at = |name: &str| folder.at(name);
        let file = folder.write(&format!("{name}.toml"), scene);
        // what it breaks may follow
        let both = format!("{word} (verified, not safe");

        let (page, figure) = (at("page"), at("figure.svg"));
        let said = searoom(&["plan", &file, "--report", &page, "--figure", &figure]).code(1);
        let said = stdout(&said);
        assert!(said.starts_with(&format!("Head-on: {both}")), "{said}");
        assert!(!said.contains("relaxed"), "{said}");
        let page = fs::read_to_string(format!("{page}/index.html")).expect("a page");
        says(&page, &format!("<h2>Head-on: {both}"));
        says(&fs::read_to_string(&figure).expect("a figure"), &both);

        let plan = searoom(&["plan", &file, "--json"]).code(1);
        let plan_file = folder.write("plan.json", stdout(&plan));
        let plan = document(&plan);
        let facts = |d: &Value| ["outcome", "verdict", "verified", "safe"].map(|k| d[k].clone());
        let expected = [json!("relaxed"), json!(word), json!(true), json!(false)];
        assert_eq!(facts(&plan), expected);
        let checked = searoom(&["verify", &plan_file]).success();
        let first = format!("Head-on: verified, not safe: {word}\n");
        assert!(stdout(&checked).starts_with(&first), "{}", stdout(&checked));
        let checked = document(&searoom(&["verify", "--json", &plan_file]).success());
        let found = |d: &Value| ["verified", "safe"].map(|k| d[k].clone());
        assert_eq!(found(&checked), [json!(1), json!(0)]);
        assert_eq!(found(&checked["plans"][0]), expected[2..]);

        let suite = stdout(&searoom(&["suite", &file]).code(1));
        let row = suite.lines().find(|line| line.contains(".toml "));
        let row = row.expect("a row").trim_end();
        assert!(row.contains(word) && row.ends_with("NO"), "{suite}");
        says(&suite, "0 solved, 1 not safe; 1 verified, 0 safe");
        let suite = document(&searoom(&["suite", &file, "--json"]).code(1));
        assert_eq!(facts(&suite["runs"][0]), expected);
        let given_up = &suite["runs"][0]["relaxations"];
        assert_eq!(given_up, &plan["relaxations"]);
        assert_eq!(given_up[0]["kind"], "risk");
        assert_eq!(suite["summary"]["safe"], 0);
        assert_eq!(suite["summary"]["not_safe"], 1);

        let asked = ["--planner", "space-time", "--search", "a-star"];
        let args = [&["compare", file.as_str()], asked.as_slice()].concat();
        let table = stdout(&searoom(&args).code(1));
        let row = table
            .lines()
            .find(|line| line.contains("space-time, A*, least harm "));
        let row = row.expect("a row");
        assert!(row.contains(word) && row.contains(" NO "), "{table}");
        let compared = document(&searoom(&[args.as_slice(), &["--json"]].concat()).code(1));
        assert_eq!(facts(&compared["comparisons"][0]["entries"][0]), expected);
    }
}

/// A baseline is called what a plan is called that does the same.
#[test]
fn a_baseline_and_a_plan_that_ram_have_the_same_word() {
    let folder = Folder::new();
    let file = folder.write("a.toml", overlapping());
    let table = stdout(&searoom(&["compare", &file]).code(1));
    for method in ["space-time, A*, ", "path-time, least harm ", "hold course "] {
        let row = table.lines().find(|line| line.contains(method));
        assert!(row.expect("a row").contains("COLLIDES"), "{table}");
    }
    // the shape about a target that lies still is entered, nothing else
    let lying = with_target_at("700.0, north_m = 100.0").replace(
        "speed_mps = 5.0\nlength_m = 60.0",
        "speed_mps = 0.0\nlength_m = 60.0",
    );
    let domain = "{ fore_m = 200.0, aft_m = 200.0, port_m = 200.0, starboard_m = 200.0 }";
    let file = folder.write("wide.toml", format!("{lying}domain = {domain}\n"));
    let compared = json(&format!("compare {file} --json"));
    let mut entries = list(&compared["comparisons"][0]["entries"]).iter();
    let held = entries.find(|e| e["method"] == "hold course");
    let held = held.expect("it is there");
    assert_eq!(held["verdict"], "relaxed");
    assert_eq!(held["safe"], true);
    assert_eq!(held["outcome"], "collides", "the key keeps its values");
}

#[test]
fn a_figure_says_that_a_plan_is_safe() {
    let folder = Folder::new();
    let figure = folder.at("a.svg");
    run(&format!(
        "plan scenarios/colregs/head-on.toml --figure {figure}"
    ))
    .success()
    .stdout(contains("(verified, safe)"));
    let svg = fs::read_to_string(&figure).expect("a figure");
    says(&svg, ">solved (verified, safe): starboard 30° from 0:20<");
}

/// A risk that is taken of the shape alone is safe, one of the hard set is not; both are told with
/// their figure.
#[test]
fn a_risk_that_is_taken_is_told_with_its_figure() {
    let folder = Folder::new();
    let file = folder.write("a.toml", HEAD_ON);
    for (compliance, safe, facts) in [("shape", true, "safe"), ("none", false, "not safe")] {
        let asked = format!("plan {file} --max-risk 0.2 --compliance {compliance}");
        let said = stdout(&run(&asked).code(1));
        // what it breaks may follow
        let head = format!("Head-on: at risk 0.20 (verified, {facts}");
        assert!(said.starts_with(&head), "{said}");
        let plan = run(&format!("{asked} --json")).code(1);
        let plan_file = folder.write("plan.json", stdout(&plan));
        let plan = document(&plan);
        assert_eq!(plan["safe"], safe);
        searoom(&["verify", &plan_file])
            .success()
            .stdout(contains(format!(
                "Head-on: verified, {facts}: at risk 0.20"
            )));
    }
}

/// A plan that passes a waypoint from afar says so, and so does its verification.
#[test]
fn skipped_waypoints_are_told() {
    let folder = Folder::new();
    let skips = "waypoint 2 by 175 m";
    run("plan tests/faults/near-round-trip.toml").stdout(contains(format!("skips        {skips}")));
    let plan = run("plan tests/faults/near-round-trip.toml --json");
    let file = folder.write("plan.json", stdout(&plan));
    searoom(&["verify", &file])
        .success()
        .stdout(contains(format!("Skips {skips}")));
}

/// Three targets at rest beside a straight path, the nearest in the middle of the list; hulls of
/// own ship and of each are 4 and 6 m to a side.
const ABEAM_M: [f64; 3] = [500.0, -300.0, 400.0];

/// Every view tells each target's own clearance, and the least of all, to the decimals that it has.
#[test]
fn every_view_tells_the_clearance_of_the_right_target() {
    let folder = Folder::new();
    let (own, _) = HEAD_ON.split_once("[[targets]]").expect("a target");
    let mut scene = own.to_owned();
    for (index, north) in ABEAM_M.iter().enumerate() {
        scene += &format!(
            "[[targets]]\nname = \"t{index}\"\nposition = {{ east_m = {}, north_m = {north} }}\ncourse_deg = 90.0\n\
             speed_mps = 0.0\nlength_m = 60.0\nbeam_m = 12.0\n",
            400 + 300 * index
        );
    }
    let clearances = ABEAM_M.map(|north| north.abs() - 10.0);
    let file = folder.write("three.toml", scene);
    let near = |found: &Value, so: f64| {
        let value = number(found);
        assert!((value - so).abs() < 1e-6, "{value} for {so}");
    };

    let said = stdout(&run(&format!("plan {file}")).success());
    says(
        &said,
        "clearance    290.0 m to any hull that a target may have;",
    );
    let plan = run(&format!("plan {file} --json")).success();
    let plan_file = folder.write("plan.json", stdout(&plan));
    let plan = document(&plan);
    near(&plan["cost"]["min_clearance_m"], 290.0);
    let table = stdout(&run(&format!("verify {plan_file}")).success());
    let checked = json(&format!("verify --json {plan_file}"));
    let checked = &checked["plans"][0]["targets"];
    for (index, so) in clearances.into_iter().enumerate() {
        let (met, target) = (&plan["encounters"][index], &checked[index]);
        assert_eq!(met["target"], format!("t{index}"));
        assert_eq!(target["target"], met["target"]);
        for key in ["dcpa_m", "undisturbed_dcpa_m"] {
            near(&met[key], so);
        }
        for key in ["dcpa_m", "min_clearance_m"] {
            near(&target[key], so);
        }
        let mut lines = table.lines();
        let row = lines.find(|line| line.starts_with(&format!("t{index} ")));
        let words: Vec<&str> = row.expect("a row").split_whitespace().collect();
        let so = format!("{so:.1}");
        assert_eq!(words[3..5], [so.as_str(), so.as_str()], "{table}");
    }

    let csv = folder.at("rows.csv");
    let compared = json(&format!("compare {file} --json --csv {csv}"));
    for entry in list(&compared["comparisons"][0]["entries"]) {
        // these keep to the path
        let kept = ["hold course", "space-time", "path-time"];
        let method = entry["method"].as_str().expect("a name");
        if kept.iter().any(|kept| method.starts_with(kept)) {
            near(&entry["cost"]["min_clearance_m"], 290.0);
        }
    }
    let mut rows = csv::Reader::from_path(&csv).expect("rows");
    let names = rows.headers().expect("names").clone();
    let column = names.iter().position(|n| n == "min_clearance_m");
    let mut records = rows.records().flatten();
    let held = records.find(|row| &row[2] == "hold course");
    let held = held.expect("a row");
    let value: f64 = held[column.expect("a column")].parse().expect("a number");
    near(&value.into(), 290.0);
}

/// A ship at anchor has arrived at once, and nothing is claimed of what comes later. Whoever comes is
/// named, whichever planner answers, and long after the time for which the clearance is reported.
#[test]
fn a_ship_that_is_met_at_rest_is_warned() {
    let file = "tests/faults/own-ship-at-anchor.toml";
    let met = "; met at rest by 'coaster' at 953 s)";
    let planners = ["space-time", "path-time"];
    for planner in planners {
        let said = stdout(&run(&format!("plan {file} --planner {planner}")).success());
        assert!(
            said.lines().next().is_some_and(|line| line.contains(met)),
            "{said}"
        );
        says(
            &said,
            "  warning      'coaster' runs into own ship where it lies, at 953 s",
        );
    }
    let folder = Folder::new();
    let plan = run(&format!("plan {file} --json")).success();
    let time = number(&document(&plan)["encounters"][0]["met_at_rest_s"]);
    // own hull is 10 m farther north; both are 85 m long from the middles
    let expected = (5000.0 - 10.0 - 85.0) / (10.0 * 1852.0 / 3600.0);
    assert!((time - expected).abs() < 1e-6, "{time}");
    let text = stdout(&plan);
    run(&format!("verify {}", folder.write("plan.json", &text))).success();
    let early = text.replacen(&format!("{time}"), "900.5", 1);
    assert_ne!(early, text);
    let refused = run(&format!("verify {}", folder.write("early.json", early))).code(1);
    refused.stdout(contains("encounter with 'coaster', met_at_rest_s"));
    // one that passes by, and one that comes after the horizon
    let scenario = fs::read_to_string(file).expect("a scenario");
    for (old, new) in [
        (
            "east_m = 0.0, north_m = 5000.0",
            "east_m = 15.0, north_m = 5000.0",
        ),
        ("horizon_s = 1800.0", "horizon_s = 900.0"),
    ] {
        let other = folder.write("a.toml", scenario.replacen(old, new, 1));
        let said = stdout(&run(&format!("plan {other}")).success());
        assert!(!said.contains("met at rest"), "{said}");
    }
}

/// At the size at which it is planned this trip is shorter than the tolerance of an arrival, but own
/// ship has not arrived.
#[test]
fn a_round_trip_that_is_too_short_to_be_turned_is_infeasible() {
    for compliance in ["none", "shape", "rules"] {
        let plan = "plan tests/faults/round-trip-below-its-turn.toml --compliance";
        let said = stdout(&run(&format!("{plan} {compliance}")).code(1));
        says(&said, "round trip: infeasible | the horizon is 60.0 s");
    }
}

/// A step of the refinement is some metres: with a turning radius of a millimetre that were
/// thousands of turns, each with its closest approaches, and gigabytes of them.
#[cfg(unix)]
#[test]
fn turns_of_a_millimetre_take_little_memory() {
    let program = env!("CARGO_BIN_EXE_searoom");
    let plan = "plan tests/faults/turns-of-a-millimetre.toml";
    // 200 MB, with the address space of the program and of one thread
    let limited = format!("ulimit -v 200000; exec {program} {plan}");
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", &limited]);
    shell
        .env("RAYON_NUM_THREADS", "1")
        .env("MALLOC_ARENA_MAX", "1");
    let output = shell.output().expect("sh");
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(said.contains("verified, not safe"), "{said}");
}
