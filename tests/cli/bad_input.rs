//! Regressions with unusual files and options, run as a user runs them. Each test is named after
//! the behaviour that holds now.

use super::program::{
    Folder, HEAD_ON, document, json, list, number, rows, run, says, searoom, stderr, text,
};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};

/// Head-on with its route cut into `count` legs of one line.
fn in_legs(count: u32) -> String {
    let east = |i: u32| 1500.0 * f64::from(i) / f64::from(count);
    let places: Vec<String> = (0..=count)
        .map(|i| format!("{{ east_m = {:?}, north_m = 0.0 }}", east(i)))
        .collect();
    let line = HEAD_ON
        .lines()
        .find(|l| l.starts_with("waypoints"))
        .expect("a route");
    HEAD_ON.replace(line, &format!("waypoints = [{}]", places.join(", ")))
}

#[test]
fn waypoints_on_a_line_change_nothing() {
    let folder = Folder::new();
    let mut costs = Vec::new();
    for count in [1, 2, 99] {
        let file = folder.write("legs.toml", in_legs(count));
        let plan = json(&format!("plan {file} --json"));
        // the document has the route as it was given
        assert_eq!(
            list(&plan["mission"]["waypoints"]).len(),
            count as usize + 1
        );
        let cost = &plan["cost"];
        costs.push((
            number(&cost["objective"]),
            number(&cost["space_time_error_m2"]),
        ));
    }
    for (found, judged) in &costs {
        assert!((found - costs[0].0).abs() < 1e-6, "{costs:?}");
        assert!((judged - costs[0].0).abs() < 1e-6, "{costs:?}");
    }
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
    assert_eq!(plan["safe"] == true, ended.get_output().status.success());
    let took = number(&plan["timing"]["plan_s"]);
    // a wide bound, for a machine with other things to do
    assert!((0.4..1.2).contains(&took), "{took}");
}

#[test]
fn the_first_error_of_the_grammar_is_the_only_fault() {
    let folder = Folder::new();
    for value in ["[".repeat(2000), "{a=".repeat(2000), "[".repeat(50)] {
        let file = folder.write("deep.toml", format!("title = \"x\"\na = {value}\n"));
        let said = stderr(&searoom(&["check", &file]).code(2));
        says(&said, "1 fault\n");
    }
    let open = HEAD_ON.replacen("]", "", 1);
    for text in [format!("= 1\na = {}\n", "[".repeat(200)), open] {
        let file = folder.write("open.toml", text);
        let said = stderr(&searoom(&["check", &file]).code(2));
        says(&said, "1 fault\n");
        says(&said, "left open above");
    }
}

#[test]
fn a_file_that_is_given_twice_is_planned_once_and_that_is_said() {
    let folder = Folder::new();
    let file = folder.write("one.toml", HEAD_ON);
    run(&format!(
        "suite {file} {file} {folder} --plans {folder}/plans"
    ))
    .success()
    .stdout(contains("1 scenario: 1 solved"))
    .stderr(contains("one.toml: given more than once, taken once"));
    searoom(&["check", &file, &file])
        .success()
        .stdout(predicates::str::diff(format!("{file}: ok\n")));
}

#[test]
fn no_folder_is_made_of_the_name_of_a_file() {
    let folder = Folder::new();
    let file = folder.write("one.toml", HEAD_ON);
    let mut options = vec![("--figure", "foo.txt"), ("--plans", "foo.json")];
    if cfg!(feature = "recording") {
        options.extend([("--rrd", "foo.txt"), ("--rrd", "foo.svg")]);
    }
    for (option, name) in options {
        let path = folder.path().join(name);
        searoom(&["suite", &file, option, text(&path)])
            .code(2)
            .stdout(is_empty())
            .stderr(contains(name).and(contains(option)));
        assert!(!path.exists(), "{option}");
    }
    // a slash asks for it
    run(&format!("suite {file} --plans {folder}/v1.2/")).success();
    assert!(folder.path().join("v1.2/one.json").is_file());
}

/// One metre of way, a turning radius of 1,000 km: the plan ended 0.04 mm short and failed its own
/// verification.
#[test]
fn a_short_way_of_a_ship_that_hardly_turns_is_planned() {
    let folder = Folder::new();
    let scenario = HEAD_ON
        .replace("turning_radius_m = 100.0", "turning_radius_m = 1e6")
        .replace("1500.0, north_m = 0.0 }]", "1.0, north_m = 0.0 }]");
    let file = folder.write("short.toml", scenario);
    let planned = searoom(&["plan", &file]).success();
    planned.stdout(contains("verified"));
}

/// A replacement of the intervals of figure 9, and the message.
const INTERVALS: &str = r#"
intervals = 1.5 | found 1.5; allowed: a whole number from 1 to 2000
intervals = 50\ncontrol_weights = [0, 1, 1] | found 0; allowed: a number from 1e-24 to
intervals = 50\nstate_weights = [1] | found 1 number; allowed: 6 numbers
intervals = 50\nstate_weights = [0, 0, 0, 0, 0, 0] | found only zeros, with which the mission counts for nothing; allowed: at least one number above 0
"#;

#[test]
fn what_was_found_is_said_in_few_words() {
    run("assess scenarios/colregs/head-on.toml --velocity 1e308,0")
        .code(2)
        .stderr(contains("found 1e308;"));
    let folder = Folder::new();
    let figure = include_str!("../../scenarios/paper/figure_9.toml");
    for [change, said] in rows(INTERVALS) {
        folder.write("words.toml", figure.replace("intervals = 50", &change));
        folder.refuses(&format!("check DIR/words.toml | {said}"));
    }
}
