//! `searoom simulate` as a user runs it.

mod verified;

use crate::program::{
    Folder, HEAD_ON, document, json, list, number, rows, run, says, searoom, stderr, stdout, text,
    untimed,
};

const HEAD_ON_FILE: &str = "scenarios/colregs/head-on.toml";

/// The head-on scenario with more keys of its target, and more tables.
fn head_on(target: &str, tables: &str) -> String {
    format!("{HEAD_ON}\n{target}\n{tables}\n")
}

#[test]
fn a_simulation_says_first_whether_ships_met_and_ends_with_status_0() {
    let sailed = run(&format!("simulate {HEAD_ON_FILE}")).success();
    let shown = stdout(&sailed);
    let first = shown.lines().next().expect("a line");
    let verdict = "Head-on: no contact, every plan safe; arrived after 3";
    assert!(first.starts_with(verdict), "{first}");
    says(
        &shown,
        "clearance | head-on | Sailed: J | Plans: 1 | Off the plan | Planning",
    );
}

#[test]
fn a_contact_ends_with_status_1_and_is_named() {
    let folder = Folder::new();
    let ram = "behaviour = { kind = \"track\", points = [\
               { t_s = 12, position = { east_m = 62, north_m = 0 } }, \
               { t_s = 19, position = { east_m = 62, north_m = 0 } }] }";
    let file = folder.write("ram.toml", head_on(ram, ""));
    let shown = stdout(&searoom(&["simulate", &file]).code(1));
    let verdict = "Head-on: CONTACT with target ('target' left its set); ";
    assert!(shown.starts_with(verdict), "{shown}");
    let found = document(&searoom(&["simulate", &file, "--json"]).code(1));
    assert_eq!(found["contact"], true);
    assert_eq!(found["safe"], false);
    let target = &found["targets"][0];
    let time = number(&target["contact_t_s"]);
    assert!((5.0..19.0).contains(&time), "{time}");
    assert!(target["least_clearance_m"].as_f64() < Some(0.0));
}

/// Own ship cannot pass the coaster within a horizon of two minutes, and waits behind it until a plan
/// ends at an intermediate end.
#[test]
fn a_mission_in_parts_that_is_not_finished_is_no_success() {
    let folder = Folder::new();
    let parts = std::fs::read_to_string("tests/faults/longer-than-its-horizon.toml");
    let parts = parts.expect("a scenario");
    let parts = parts.replace("horizon_s = 900.0", "horizon_s = 120");
    let file = folder.write("parts.toml", parts);
    let ended = searoom(&["simulate", &file]).code(1);
    says(&stderr(&ended), "so it is sailed in parts");
    let first = stdout(&ended).lines().next().map(str::to_owned);
    let first = first.expect("a line");
    says(&first, "no contact, every plan safe; ENDED ");
    says(&first, " m from the last waypoint after ");
    let moored = "tests/faults/moored-at-the-end.toml";
    let moored = stdout(&searoom(&["simulate", moored]).code(1));
    says(&moored, "no contact, every plan safe; ENDED ");
}

/// A set covers the last waypoint until own ship is nearer.
#[test]
fn an_alarm_that_goes_on_is_one_line_with_its_reason() {
    let file = "tests/faults/wide-ellipse-at-risk.toml";
    let shown = stdout(&searoom(&["simulate", file]).code(1));
    says(
        &shown,
        "alarm at 0 s, 8 more until 160 s: unsafe plan: t; NOT SAFE, the last waypoint is inside sets",
    );
}

/// A mission of 300 s with a horizon of 340 s.
#[test]
fn plans_say_what_they_leave_out_of_the_mission() {
    let folder = Folder::new();
    let near = HEAD_ON.replace("horizon_s = 400.0", "horizon_s = 340.0");
    let file = folder.write("near.toml", near);
    run(&format!("check {file}")).success().stderr("");
    let sailed = run(&format!("simulate {file} --json --plans {folder}/plans")).success();
    let note = "horizon_s: 340 s are too few for the 300 s of the mission";
    says(&stderr(&sailed), note);
    let sailed = document(&sailed);
    let left_out: Vec<f64> = list(&sailed["replans"])
        .iter()
        .map(|plan| number(&plan["left_out_m"]))
        .collect();
    assert!(
        left_out[0] > 100.0 && left_out.ends_with(&[0.0]),
        "{left_out:?}"
    );
    let plans = folder.names("plans");
    assert_eq!(plans.len(), left_out.len());
    for (name, metres) in plans.iter().zip(left_out) {
        let plan = std::fs::read_to_string(folder.at(&format!("plans/{name}")));
        let plan: serde_json::Value = serde_json::from_str(&plan.expect("a plan")).expect("JSON");
        let said = plan["mission"]["left_out_m"].as_f64();
        assert_eq!(said.unwrap_or_default(), metres, "{name}");
    }
    let whole = stderr(&run(&format!("simulate {HEAD_ON_FILE}")));
    assert_eq!(whole, "");
}

#[test]
fn settings_of_the_command_line_replace_those_of_the_file() {
    run(&format!(
        "simulate {HEAD_ON_FILE} --search dijkstra --duration-s 20"
    ))
    .success();
    let refused = run(&format!("simulate {HEAD_ON_FILE} --planner path-time")).code(2);
    says(
        &stderr(&refused),
        "the closed loop goes on from their plans alone",
    );
    let file = "scenarios/closed-loop/head-on-radar.toml";
    let sail = |words: &str| {
        let sailed = json(&format!("simulate {file} --json --duration-s 20 {words}"));
        sailed["replans"][0]["cost_m2"].clone()
    };
    assert_ne!(sail("--compliance none"), sail(""));
}

#[test]
fn the_same_run_gives_the_same_document_and_another_seed_another() {
    let folder = Folder::new();
    let tables = "[simulation]\nsensor = { kind = \"ais\" }\nvessel = { kind = \"nomoto\" }\n\
                  current = { speed_mps = 0.4, toward_deg = 40, std_mps = 0.1 }";
    let scene = head_on("behaviour = { kind = \"random\" }", tables);
    let file = folder.write("a.toml", scene);
    let sail = |seed: u32| {
        // the current carries own ship out of its tracking margin of 0 m
        let sailed = run(&format!("simulate {file} --json --seed {seed}")).code(1);
        untimed(document(&sailed))
    };
    let first = sail(7);
    assert_eq!(first["settings"]["seed"], 7);
    assert_eq!(first, sail(7));
    assert_ne!(first, sail(8));
}

#[test]
fn a_figure_shows_the_closest_approach_and_ships_at_round_times() {
    let folder = Folder::new();
    let file = folder.at("sailed.svg");
    let sailed = json(&format!("simulate {HEAD_ON_FILE} --json --figure {file}"));
    let drawn = std::fs::read_to_string(&file).expect("written");
    let least = &sailed["targets"][0];
    let apart = number(&least["least_clearance_m"]);
    let time = number(&least["least_clearance_t_s"]);
    let whole = time.round() as u32;
    let at = format!("{}:{:02}", whole / 60, whole % 60);
    let closest = format!(">{apart:.0} m, {at}<");
    let words = [">sailed<", ">own ship, 0:00<", ">target, 0:00<", ">3:00<"];
    for label in words
        .into_iter()
        .chain([&closest[..], ">closest approach<"])
    {
        assert!(drawn.contains(label), "{label}: {drawn}");
    }
    searoom(&["simulate", "scenarios/colregs", "--figure", &file])
        .code(2)
        .stderr(predicates::str::contains("4 scenarios; name a folder"));
}

#[test]
fn a_report_shows_every_simulation_and_why_one_was_refused() {
    let folder = Folder::new();
    let sail = |name: &str| {
        let report = folder.path().join(name);
        let refused = "scenarios/paper/figure_5.toml";
        searoom(&["simulate", HEAD_ON_FILE, refused, "--report", text(&report)]).code(2);
        assert!(report.join("head-on-1.svg").is_file());
        std::fs::read_to_string(report.join("index.html")).expect("written")
    };
    let page = sail("a");
    for shown in [
        "Head-on: no contact, every plan safe; arrived after 300 s",
        "src=\"./head-on-1.svg\"",
        "Plans that differ from the one before",
        "not applicable",
        "the closed loop goes on from their plans alone",
    ] {
        assert!(page.contains(shown), "{shown}: {page}");
    }
    assert_eq!(page, sail("b"));
}

#[test]
fn a_shorter_time_ends_the_simulation_before_arrival() {
    let found = json(&format!("simulate {HEAD_ON_FILE} --json --duration-s 45"));
    assert_eq!(found["duration_s"], 45.0);
    assert_eq!(found["arrived"], false);
    // nothing is counted for the time after the simulation
    let cost = number(&found["conduct"]["cost_m2"]);
    assert!(cost < 1000.0, "{cost}");
    assert_eq!(found["replans"].as_array().map(Vec::len), Some(3));
}

#[test]
fn every_fault_of_the_tables_is_named_by_check_and_simulate() {
    let folder = Folder::new();
    let target = "behaviour = { kind = \"swims\" }";
    let tables = "[simulation]\nstep_s = 0\nseed = 1.5\nwater = 1\nreplan = \"often\"\n\
                  vessel = { kind = \"nomoto\", rudder_deg = 200 }\n\
                  sensor = { kind = \"radar\", detection = 0 }\n\
                  current = { speed_mps = -1 }";
    let file = folder.write("bad.toml", head_on(target, tables));
    for command in ["check", "simulate", "plan"] {
        let said = stderr(&searoom(&[command, &file]).code(2));
        for fault in [
            "targets[0].behaviour.kind: found the text \"swims\"; allowed: \"constant\"",
            "simulation.step_s: found 0; allowed: a number from 0.01 to 10",
            "simulation.seed: found 1.5",
            "simulation.replan: found the text \"often\"; allowed: \"period\", \"events\"",
            "simulation.water: found an unknown key",
            "simulation.vessel.rudder_deg: found 200",
            "simulation.sensor.detection: found 0; allowed: a number from 0.01 to 1",
            "simulation.current.speed_mps: found -1",
        ] {
            assert!(said.contains(fault), "{command}: {fault}: {said}");
        }
    }
}

#[test]
fn plans_do_not_depend_on_the_tables_of_the_simulation() {
    let folder = Folder::new();
    let tables = "[simulation]\nseed = 3\nsensor = { kind = \"ais\" }";
    let scene = head_on("behaviour = { kind = \"pursuit\" }", tables);
    let file = folder.write("a.toml", scene);
    let plan = |file: &str| untimed(json(&format!("plan {file} --json")));
    assert_eq!(plan(&file), plan(HEAD_ON_FILE));
}

#[test]
fn the_shipped_closed_loops_are_sailed_without_contact() {
    let found = json("simulate scenarios/closed-loop --json");
    let all = list(&found["simulations"]);
    assert_eq!(all.len(), 7);
    for sailed in all {
        let title = &sailed["scenario"];
        assert_eq!(sailed["safe"], true, "{title}");
        assert_eq!(sailed["arrived"], true, "{title}");
        assert_eq!(sailed["conduct"]["side_switches"], 0, "{title}");
        assert_eq!(sailed["conduct"]["within_tracking_margin"], true, "{title}");
    }
}

#[test]
fn a_plan_is_asked_for_when_a_target_is_reported_again() {
    let folder = Folder::new();
    let tables = "[simulation]\nreplan = \"events\"\nreplan_s = 300\n\
                  sensor = { kind = \"ais\", interval_s = 2, silent_s = [[20, 60]], stale_s = 30 }";
    let file = folder.write("a.toml", head_on("", tables));
    let found = json(&format!("simulate {file} --json"));
    assert_eq!(found["settings"]["replan_on_events"], true);
    let replans = list(&found["replans"]);
    let again = replans.iter().find(|r| r["reason"] == "acquired: target");
    let time = again.expect("an event")["t_s"].as_f64().expect("a time");
    assert!((60.0..63.0).contains(&time), "{time}");
    let name = folder.write("sailed.json", found.to_string());
    searoom(&["verify", &name]).success();
    let other = found
        .to_string()
        .replace("acquired: target", "acquired: nobody");
    let name = folder.write("sailed.json", other);
    let shown = stdout(&searoom(&["verify", &name]).code(1));
    says(
        &shown,
        "found 'acquired: nobody'; allowed: period, acquired: target",
    );
}

/// Text, document and check agree on a target that is seen late; a plan knows of it and says so.
#[test]
fn a_target_seen_late_is_named_by_simulate_and_plan() {
    let folder = Folder::new();
    let file = folder.write("late.toml", head_on("seen_from_s = 90", ""));
    let shown = stdout(&searoom(&["simulate", &file]));
    says(&shown, "Seen: target from 90 s on");
    let sailed = document(&searoom(&["simulate", &file, "--json"]));
    assert_eq!(sailed["targets"][0]["unknown_until_s"], 90.0);
    let estimates = |index: usize| list(&sailed["replans"][index]["estimates"]).len();
    assert_eq!([4, 5].map(estimates), [0, 1]);
    let name = folder.write("sailed.json", sailed.to_string());
    says(&stdout(&searoom(&["verify", &name])), "verified");
    for until in [10.0, 150.0, -1.0] {
        let mut altered = sailed.clone();
        altered["targets"][0]["unknown_until_s"] = until.into();
        let name = folder.write("altered.json", altered.to_string());
        says(&stdout(&searoom(&["verify", &name]).code(1)), "REJECTED");
    }
    let planned = run(&format!("plan {file} --json")).success();
    says(
        &stderr(&planned),
        "seen_from_s: the plan knows of every target; in `simulate` own ship sees 'target' from \
         90 s on",
    );
    assert_eq!(
        untimed(document(&planned)),
        untimed(json(&format!("plan {HEAD_ON_FILE} --json")))
    );
    let never = folder.write("never.toml", head_on("seen_from_s = 900", ""));
    let blind = stdout(&searoom(&["simulate", &never]).code(1));
    says(&blind, "CONTACT with target | Seen: target never");
}

/// Fields that a target does not report, a sensor, and the fault.
const NOT_REPORTED: &str = r#"
"heading", "size" | kind = "radar" | : found a sensor of kind "radar"
"heading", "size" | kind = "ais", default_length_m = 50 | : found a larger ship than the default of 50 × 20 m
"name" | kind = "ais" | [0]: found the text "name"; allowed: "heading", "size"
"#;

#[test]
fn a_target_without_size_in_its_reports_has_the_default_size() {
    let folder = Folder::new();
    let sail = |target: &str, sensor: &str, code: i32| {
        let tables = format!("[simulation]\nsensor = {{ {sensor} }}");
        let file = folder.write("a.toml", head_on(target, &tables));
        searoom(&["simulate", &file, "--json"]).code(code)
    };
    let both = "not_reported = [\"heading\", \"size\"]";
    let found = document(&sail(both, "kind = \"ais\", default_beam_m = 75", 0));
    let assumed = &found["replans"][0]["estimates"][0];
    assert_eq!(
        [number(&assumed["length_m"]), number(&assumed["beam_m"])],
        [125.0; 2]
    );
    assert_eq!(found["targets"][0]["length_m"], 60.0);
    for [not_reported, sensor, fault] in rows(NOT_REPORTED) {
        let target = format!("not_reported = [{not_reported}]");
        let refused = stderr(&sail(&target, &sensor, 2));
        says(&refused, &format!("targets[0].not_reported{fault}"));
    }
}

/// The time of Ctrl-C depends on the machine; a step of 0.01 s makes the simulation long.
#[cfg(unix)]
#[test]
fn ctrl_c_writes_what_was_sailed_so_far() {
    use std::process::{Command, Stdio};
    let folder = Folder::new();
    let far = HEAD_ON.replace("horizon_s = 400.0", "horizon_s = 900000.0");
    let far = far.replace("east_m = 1500.0", "east_m = 4000000.0");
    let far = format!("{far}\n[simulation]\nstep_s = 0.01\nreplan_s = 900000.0\n");
    let file = folder.write("far.toml", far);
    let plans = folder.path().join("plans");
    let sailing = Command::new(env!("CARGO_BIN_EXE_searoom"))
        .args(["simulate", &file, HEAD_ON_FILE, "--json", "--plans"])
        .arg(&plans)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    // the folder is made after Ctrl-C is caught
    while !plans.is_dir() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let kill = Command::new("kill")
        .args(["-INT", &sailing.id().to_string()])
        .status();
    assert!(kill.expect("kill").success());
    let ended = sailing.wait_with_output().expect("ended");
    assert_eq!(ended.status.code(), Some(130));
    let note = String::from_utf8(ended.stderr).expect("text");
    assert!(note.contains("no more scenarios are sailed"), "{note}");
    let sailed = String::from_utf8(ended.stdout).expect("text");
    let found: serde_json::Value = serde_json::from_str(&sailed).expect("a list");
    let found = &found["simulations"][0];
    assert_eq!(found["interrupted"], true);
    assert_eq!(found["arrived"], false);
    let time = number(&found["duration_s"]);
    assert!(time > 0.0 && time < 800_000.0, "{time}");
    let file = folder.write("sailed.json", found.to_string());
    let shown = stdout(&searoom(&["verify", &file]).success());
    assert!(shown.contains("verified: no contact"), "{shown}");
    let altered = found.to_string();
    let altered = altered.replace("\"interrupted\":true", "\"interrupted\":false");
    let file = folder.write("altered.json", altered);
    searoom(&["verify", &file]).code(1);
}
