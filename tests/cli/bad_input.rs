//! Files and options that are refused, run as a user runs them: what is named, and where.

use std::fs;

use super::program::{
    Folder, HEAD_ON, head_on_without_planner, rows, run, says, searoom, stderr, text,
};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};

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
fn a_horizon_before_the_end_of_the_mission_is_noted() {
    let folder = Folder::new();
    let scenario = fs::read_to_string("scenarios/colregs/give-way.toml").expect("a scenario");
    let with = |horizon: &str| scenario.replace("horizon_s = 400.0", horizon);
    let short = folder.write("short.toml", with("horizon_s = 280.0"));
    let just = folder.write("just.toml", with("horizon_s = 300.0"));
    let note = "horizon_s: 280 s are less than the 300 s of the mission at its speeds";
    for command in ["check", "plan"] {
        run(&format!("{command} {short}")).stderr(contains(note));
        run(&format!("{command} {just}")).stderr("");
    }
    // no arrival is asked for
    let forces = fs::read_to_string("scenarios/paper/figure_9.toml").expect("a scenario");
    let file = folder.write(
        "forces.toml",
        forces.replace("horizon_s = 100", "horizon_s = 20"),
    );
    let few = run(&format!("check {file}")).success();
    few.stderr(contains("horizon_s").not());
}

#[test]
fn a_hull_that_is_wider_than_long_is_noted() {
    let folder = Folder::new();
    let file = folder.write(
        "wide.toml",
        HEAD_ON.replacen("length_m = 30.0", "length_m = 3.0", 1),
    );
    let note = "wide.toml: own_ship: beam_m, 8, is greater than length_m, 3: exchanged?\n";
    searoom(&["check", &file]).success().stderr(contains(note));
}

/// Requests that the path-time planner or another planner refuses: the lines before the mission, its
/// alternatives, and the message. `TIME` is the table of the path-time planner.
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
        suite --figure x.eps | --figure: x.eps | .svg
        ",
    );
    let empty = Folder::new();
    for (name, said) in [("", "without scenarios"), ("x.toml", "cannot be read")] {
        let suite = searoom(&["suite", &empty.at(name)]).code(2);
        suite.stderr(contains(said));
    }
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
    for (old, new, hint) in [
        (
            "[[targets]]",
            "[targets]\n[targets]",
            "each begins like [[targets]]",
        ),
        (
            "[[targets]]",
            "[[targets]]\nname = \"a\"",
            "the key is given before",
        ),
        ("title", "a = 11,0\ntitle", "the decimal sign is a point"),
        (
            "title",
            "a = -11,05 # m\ntitle",
            "the decimal sign is a point",
        ),
        (
            "title",
            "a = { lat_deg = 58, lon_deg = 10,60 }\ntitle",
            "the decimal sign is a point",
        ),
        ("title", "a = [10,60\ntitle", "left open above"),
    ] {
        let file = folder.write("hint.toml", HEAD_ON.replacen(old, new, 1));
        says(&stderr(&searoom(&["check", &file]).code(2)), hint);
    }
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

/// Faults that a command finds later than the reader have the line of the file and its unit.
#[test]
fn later_faults_have_their_line() {
    let folder = Folder::new();
    let text = HEAD_ON.replace(
        "safety_margin_m = 20.0",
        "safety_margin_cbl = 0.1\ntracking_margin_cbl = 2.1",
    );
    let file = folder.write("units.toml", text);
    let said = stderr(&run(&format!("check {file}")).code(2));
    let fault = "line 14: own_ship.tracking_margin_cbl: found 388.92 m; allowed: at most 18.52 m: ";
    assert!(said.contains(fault), "{said}");
    let file = folder.write(
        "sail.toml",
        format!("{HEAD_ON}\n[simulation]\nstep_s = 9.0\nreplan_s = 5.0\n"),
    );
    let said = stderr(&run(&format!("simulate {file}")).code(2));
    let line = HEAD_ON.lines().count() + 3;
    let fault = format!("line {line}: simulation.step_s: found 9; allowed: at most 5");
    assert!(said.contains(&fault), "{said}");
    let said = stderr(&run(
        "plan scenarios/harbour/munkholmen.toml --planner optimal-control",
    ));
    assert!(said.contains(": map: found land for"), "{said}");
    assert!(said.contains("line "), "{said}");
}

/// Where a file is not there, one of a similar name in its folder is offered.
#[test]
fn a_missing_file_is_perhaps_another() {
    let folder = Folder::new();
    let file = folder.write("head-on.toml", HEAD_ON);
    for (wrong, near) in [
        ("head_on.toml", true),
        ("Head-on.tml", true),
        ("x.toml", false),
    ] {
        let wrong = folder.at(wrong);
        let said = stderr(&run(&format!("plan {wrong}")).code(2));
        assert_eq!(said.contains(&format!("; perhaps {file}?")), near, "{said}");
    }
    let said = stderr(&run("suite scenario").code(2));
    assert!(said.contains("; perhaps scenarios?"), "{said}");
    // of a folder too, on the way to a file
    for (wrong, right) in [
        ("scenarios/colreg", "scenarios/colregs"),
        (
            "scenarios/colreg/give-way.toml",
            "scenarios/colregs/give-way.toml",
        ),
        (
            "scenario/colreg/give-wey.toml",
            "scenarios/colregs/give-way.toml",
        ),
    ] {
        let said = stderr(&run(&format!("suite {wrong}")).code(2));
        assert!(said.contains(&format!("; perhaps {right}?")), "{said}");
    }
    let text =
        format!("origin = {{ lat_deg = 63.0, lon_deg = 10.0 }}\nmap = \"isl.geojson\"\n{HEAD_ON}");
    folder.write("isle.geojson", "");
    let said = stderr(&run(&format!("check {}", folder.write("a.toml", text))).code(2));
    assert!(said.contains("isle.geojson?"), "{said}");
}

/// Reports of AIS and other rows are no scenario: the message says what they are, and what is read.
#[test]
fn rows_and_sentences_are_known() {
    let folder = Folder::new();
    let sentence = "!AIVDM,1,1,,A,15M67FC000G?ufbE`FepT@3n00Sa,0*5C\n";
    for (name, text, kind) in [
        ("a.nmea", sentence.to_owned(), "NMEA sentences"),
        (
            "b.nm4",
            format!("\\s:2573135,c:1454025600*0A\\{sentence}"),
            "NMEA sentences",
        ),
        (
            "c.txt",
            "$GPGGA,123519,4807.038,N,01131.000,E,1*47\n".to_owned(),
            "NMEA sentences",
        ),
        (
            "d.csv",
            "MMSI,BaseDateTime,LAT,LON\n367390380,2022-01-03T00:00:00,40.6,-74.0\n".to_owned(),
            "rows of AIS reports (CSV)",
        ),
        (
            "e.csv",
            "# Timestamp,Type of mobile,MMSI\n27/02/2024 00:00:00,Class A,219000\n".to_owned(),
            "rows of AIS reports (CSV)",
        ),
        (
            "f.csv",
            "east_m,north_m,t_s\n1,2,3\n".to_owned(),
            "rows of values (CSV)",
        ),
        (
            "h.csv",
            "MMSI;BaseDateTime;LAT;LON\n1;2,5;3,5;4\n".to_owned(),
            "rows of AIS reports (CSV with semicolons)",
        ),
        (
            "i.tsv",
            "MMSI\tLAT\tLON\n1\t2\t3\n".to_owned(),
            "rows of AIS reports (TSV)",
        ),
        (
            "j.json",
            "{\"class\": \"VERSION\"}\n{\"class\": \"AIS\", \"mmsi\": 1}\n".to_owned(),
            "reports of gpsd (JSON)",
        ),
        (
            "k.json",
            "{\"mmsi\": 1}\n{\"mmsi\": 2}\n".to_owned(),
            "rows of AIS reports (JSON)",
        ),
        (
            "l.json",
            "[\n{\"mmsi\": 1},\n{\"mmsi\": 2}]\n".to_owned(),
            "rows of AIS reports (JSON)",
        ),
        (
            "m.gpx",
            "<gpx version=\"1.1\"></gpx>".to_owned(),
            "XML that begins with gpx",
        ),
        (
            "n.kml",
            "<kml></kml>".to_owned(),
            "XML that begins with kml",
        ),
    ] {
        let file = folder.write(name, text);
        let out = format!("import --out {folder}/out");
        for command in ["check", "plan", "suite", &out] {
            let said = stderr(&run(&format!("{command} {file}")).code(2));
            let whole = format!("found {kind}");
            assert!(
                said.contains(&whole) && said.contains("a scenario file (TOML)"),
                "{said}"
            );
        }
    }
    // a broken scenario is still one
    let file = folder.write("g.toml", HEAD_ON.replacen("title", "title, a, b", 1));
    let said = stderr(&run(&format!("check {file}")).code(2));
    assert!(said.contains("line 2: ") && !said.contains("CSV"), "{said}");
    let file = folder.write("o.json", "{\"own_ship\": {},\n\"cases\": [}\n");
    let said = stderr(&run(&format!("check {file}")).code(2));
    assert!(
        said.contains("line 2: ") && !said.contains("rows"),
        "{said}"
    );
}
