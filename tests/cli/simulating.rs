//! `searoom simulate` as a user runs it.

use super::program::{
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
fn every_plan_that_was_followed_verifies() {
    let folder = Folder::new();
    run(&format!("simulate {HEAD_ON_FILE} --plans {folder}/plans")).success();
    let files = folder.names("plans");
    assert!(files.len() > 10, "{files:?}");
    let files = files.iter().map(|name| format!(" {folder}/plans/{name}"));
    run(&format!("verify{}", files.collect::<String>())).success();
}

#[cfg(feature = "recording")]
#[test]
fn a_recording_tells_what_simulate_tells() {
    let folder = Folder::new();
    let file = folder.at("sailed.rrd");
    let sailed = stdout(&searoom(&["simulate", HEAD_ON_FILE, "--rrd", &file]).success());
    let inspected = stdout(&searoom(&["inspect", &file]).success());
    assert!(inspected.contains(sailed.trim_end()), "{inspected}");
    let found = document(&searoom(&["inspect", "--json", &file]).success());
    assert_eq!(found["scenario"], "Head-on");
    assert_eq!(found["simulation"]["format"], "searoom-simulation/1");
    for command in [&["inspect", "--plan", &file][..], &["verify", &file]] {
        let refused = stderr(&searoom(command).code(2));
        says(&refused, "the recording of a simulation");
    }
    searoom(&["simulate", "scenarios/colregs", "--rrd", &file])
        .code(2)
        .stderr(predicates::str::contains("4 scenarios; name a folder"));
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
    let closest = format!("closest approach: {apart:.1} m to target at {time:.0} s");
    for label in [
        &closest,
        "own ship, sailed",
        "target: hull and track",
        ">180 s<",
    ] {
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
        let refused = "scenarios/paper/figure_9.toml";
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
        "the closed loop goes on from its plans alone",
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
    let tables = "[simulation]\nstep_s = 0\nseed = 1.5\nwater = 1\n\
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
fn what_the_loop_cannot_sail_is_refused_and_the_others_are_sailed() {
    let folder = Folder::new();
    let long = folder.write("long.toml", head_on("", "[simulation]\nreplan_s = 5000"));
    let files = format!("scenarios/paper/figure_9.toml {long} {HEAD_ON_FILE}");
    let sailed = run(&format!("simulate {files}")).code(2);
    let said = stderr(&sailed);
    says(
        &said,
        "figure_9.toml: 1 fault\n  planner.kind: found \"optimal-control\"",
    );
    says(
        &said,
        "simulation.replan_s: found 5000; allowed: at most 400",
    );
    assert!(stdout(&sailed).starts_with("Head-on: no contact"));
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
    let file = folder.write("b.toml", head_on("", "[simulation]\nreplan = \"often\""));
    let refused = stderr(&searoom(&["simulate", &file]).code(2));
    let fault = "simulation.replan: found the text \"often\"; allowed: \"period\", \"events\"";
    assert!(refused.contains(fault), "{refused}");
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

/// The closest approach is in the last step, in which the current is in no gap.
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
        let verdict = "Head-on: verified: no contact, least distance ";
        assert!(shown.starts_with(verdict), "{shown}");
        for (pointer, value) in [
            ("/contact", true.into()),
            ("/safe", false.into()),
            ("/targets/0/least_clearance_m", 400.0.into()),
            ("/targets/0/contact_t_s", 100.0.into()),
            ("/targets/0/track/0/north_m", 170.0.into()),
            ("/sailed/0/start/north_m", 20.0.into()),
            ("/sailed/1/duration_s", (-27.4).into()),
            ("/duration_s", 900.0.into()),
            ("/replans/1/safe", false.into()),
            ("/replans/1/verdict", "NOT SAFE".into()),
            ("/replans/1/estimates", serde_json::json!([])),
            ("/replans", serde_json::json!([])),
            ("/targets", serde_json::json!([])),
            ("/targets/0/beam_m", 0.0.into()),
            ("/targets/0/least_clearance_t_s", (-1e9).into()),
            ("/conduct/unsafe_plans", 2.into()),
        ] {
            let altered = check(&|document| {
                *document.pointer_mut(pointer).expect(pointer) = serde_json::Value::clone(&value);
            });
            let shown = stdout(&altered.code(1));
            assert!(shown.contains("REJECTED"), "{pointer}: {shown}");
        }
        check(&|document| document["sailed"] = 3.into()).code(2);
    }
}
