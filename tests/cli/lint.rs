//! Probable mistakes of a scenario that can be planned: one list for three commands.

use super::program::{Folder, HEAD_ON, document, list, run, stderr, stdout};

/// A name, what is replaced in the head-on scenario, and the finding. `|` separates.
const MISTAKES: &str = "
wide | length_m = 30.0 | length_m = 3.0 | own_ship: beam_m, 8, is greater than length_m, 3: exchanged?
short | horizon_s = 400.0 | horizon_s = 280.0 | horizon_s: 280 s are less than the 300 s of the mission
touching | 1500.0, north_m = 0.0 }\\ncourse | 30.0, north_m = 0.0 }\\ncourse | target: overlaps own ship at the start\\n
deeper later | 1500.0, north_m = 0.0 }\\ncourse | 44.0, north_m = 0.0 }\\ncourse | target: overlaps own ship at the start\\n
echo | 1500.0, north_m = 0.0 }\\ncourse_deg = 270.0 | 5.0, north_m = 2.0 }\\ncourse_deg = 91.0 | target: overlaps own ship at the start, at its course and speed: own ship's own report
no AIS speed | 270.0                   # westwards, straight at own ship\\nspeed_mps = 5.0 | 270.0\\nspeed_kn = 102.3 | target: speed, 102.3 kn (52.6 m/s): what AIS reports where it is not available?
too fast | 270.0                   # westwards, straight at own ship\\nspeed_mps = 5.0 | 270.0\\nspeed_kn = 90.0 | target: speed, 90.0 kn (46.3 m/s), is more than ships of 60 m make
no reachable speed | [2.5, 5.0, 6.0] | [1.0, 2.5] | own_ship: speed, 9.7 kn (5.00 m/s), and the greatest of its speeds, 4.9 kn (2.50 m/s): m/s and knots exchanged?
mission in knots | }]\\nspeed_mps = 5.0 | }]\\nspeed_mps = 12.0 | mission: speed, 23.3 kn (12.0 m/s), and the greatest that own ship makes, 11.7 kn (6.00 m/s)
reversed | course_deg = 90.0 | course_deg = 260.0 | own_ship: course_deg, 260.0, is 170° from the first leg, 90.0: waypoints in the wrong order?
elsewhere | position = { east_m = 0.0, | position = { east_m = -500000.0, | mission: begins 500000 m from own ship, which sails at most 2400 m within horizon_s
passed | position = { east_m = 0.0, | position = { east_m = 600.0, | mission: begins 600 m astern of own ship
moored | 270.0                   # westwards, straight at own ship\\nspeed_mps = 5.0 | 270.0\\nspeed_mps = 0.0 | target: lies at rest over the last waypoint
far | 1500.0, north_m = 0.0 }\\ncourse | 90000.0, north_m = 0.0 }\\ncourse | target: never matters, out of reach within the horizon
";

/// `check`, `plan` and `suite --lint` find the same, each of it once, and the file is planned.
#[test]
fn probable_mistakes_are_one_list_of_three_commands() {
    let folder = Folder::new();
    for row in MISTAKES.lines().filter(|row| !row.is_empty()) {
        let row = row.replace("\\n", "\n");
        let [name, old, new, note] = row.splitn(4, " | ").collect::<Vec<_>>()[..] else {
            panic!("{row}");
        };
        let text = HEAD_ON.replacen(old, new, 1);
        assert_ne!(text, HEAD_ON, "{name}");
        assert_found_once(&folder.write("a.toml", text), note);
    }
    for (file, note) in [
        (
            "own-ship-among-targets",
            "MY SHIP: overlaps own ship at the start, at its course and speed: own ship's own report",
        ),
        (
            "current-faster-than-ship",
            "simulation.current: speed, 5.8 kn (3.00 m/s), is as much as own ship makes, 5.0 kn (2.57 m/s), or more",
        ),
        (
            "first-waypoint-passed",
            "mission: begins 1500 m astern of own ship, which slows down to keep to its schedule",
        ),
    ] {
        assert_found_once(&format!("tests/faults/{file}.toml"), note);
    }
    // nothing is found where the targets are apart by a hair, or ahead of the schedule by little
    for (old, new) in [
        (
            "1500.0, north_m = 0.0 }\ncourse",
            "45.1, north_m = 0.0 }\ncourse",
        ),
        ("position = { east_m = 0.0,", "position = { east_m = 290.0,"),
        ("course_deg = 90.0", "course_deg = 1.0"),
    ] {
        let text = HEAD_ON.replacen(old, new, 1);
        assert_ne!(text, HEAD_ON);
        let file = folder.write("a.toml", text);
        assert_eq!(stderr(&run(&format!("check {file}")).success()), "");
    }
}

/// However long the mission is. `plan` has its own arrival, and says it in its verdict.
#[test]
fn a_ship_that_is_met_at_rest_is_found_by_each_command() {
    let folder = Folder::new();
    let late = HEAD_ON
        .replacen("horizon_s = 400.0", "horizon_s = 900.0", 1)
        .replacen(
            "1500.0, north_m = 0.0 }\ncourse",
            "4500.0, north_m = 0.0 }\ncourse",
            1,
        );
    assert!(late.contains("4500.0") && late.contains("900.0"));
    let late = folder.write("late.toml", late);
    let anchored = "tests/faults/own-ship-at-anchor.toml".to_owned();
    for (file, note, verdict) in [
        (
            late,
            "target: meets own ship at 591 s where it lies",
            "met at rest by 'target' at 591 s",
        ),
        (
            anchored,
            "coaster: meets own ship at 953 s where it lies",
            "met at rest by 'coaster'",
        ),
    ] {
        let linted = document(&run(&format!("suite --lint --json {file}")).success());
        let findings = list(&linted["scenarios"][0]["findings"]);
        let found = findings.iter().filter_map(|f| f.as_str());
        assert_eq!(
            found.filter(|f| f.contains(note)).count(),
            1,
            "{findings:?}"
        );
        for command in ["check", "simulate"] {
            let said = stderr(&run(&format!("{command} {file}")));
            assert_eq!(said.matches(note).count(), 1, "{command}: {said}");
        }
        let planned = run(&format!("plan {file}")).success();
        let [said, notes] = [stdout(&planned), stderr(&planned)];
        assert!(
            said.lines()
                .next()
                .is_some_and(|line| line.contains(verdict)),
            "{said}"
        );
        assert!(!notes.contains("where it lies"), "{notes}");
    }
}

fn assert_found_once(file: &str, note: &str) {
    let checked = run(&format!("check {file}")).success();
    let note = note.trim_end();
    let of_check = stderr(&checked);
    assert_eq!(of_check.matches(note).count(), 1, "{note}\n{of_check}");
    let of_plan = stderr(&run(&format!("plan {file}")));
    assert_eq!(of_plan.matches(note).count(), 1, "{note}\n{of_plan}");
    let linted = document(&run(&format!("suite --lint --json {file}")).success());
    let findings = list(&linted["scenarios"][0]["findings"]);
    let found = findings.iter().filter_map(|f| f.as_str());
    assert_eq!(found.filter(|f| f.contains(note)).count(), 1, "{note}");
    // and nothing that one of them has and another has not
    let notes = document(&run(&format!("check --json {file}")).success());
    assert_eq!(
        &notes["files"][0]["notes"],
        &linted["scenarios"][0]["findings"]
    );
}

/// Scenarios of this project that are meant as they are.
#[test]
fn no_shipped_scenario_has_a_probable_mistake() {
    let linted = document(&run("suite --lint --json scenarios").success());
    let mut found = Vec::new();
    for scenario in list(&linted["scenarios"]) {
        let findings = list(&scenario["findings"]).iter();
        let name = scenario["scenario"].as_str().expect("a title");
        found.extend(findings.map(|f| format!("{name}: {}", f.as_str().expect("a text"))));
    }
    assert_eq!(found, EXPECTED, "{found:#?}");
}

/// A fairway whose ship keeps off the route, a case that its table and others count differently, and
/// horizons long after the arrival, at which ships pass over the last waypoint.
const EXPECTED: [&str; 9] = [
    "ZAM_Sample-2_1_T-1: no hard set in the way: with hulls alone own ship may keep to its route",
    "OT-GW, OT-GW, OT-SO: target_ship_1: meets own ship at 2100 s where it lies after its mission, which ends at 1800 s",
    "imazu-03: target 1: meets own ship at 4348 s where it lies after its mission, which ends at 3600 s",
    "imazu-07: target 1: meets own ship at 4348 s where it lies after its mission, which ends at 3600 s",
    "imazu-12: ships are missing: 3 declared, 2 found",
    "imazu-15: target 1: meets own ship at 4348 s where it lies after its mission, which ends at 3600 s",
    "imazu-17: target 1: meets own ship at 4348 s where it lies after its mission, which ends at 3600 s",
    "imazu-20: target 1: meets own ship at 4348 s where it lies after its mission, which ends at 3600 s",
    "imazu-22: target 1: meets own ship at 4348 s where it lies after its mission, which ends at 3600 s",
];
