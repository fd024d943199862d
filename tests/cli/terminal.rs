//! What a person at a terminal sees, and what a pipe gets.

use super::program::{Folder, HEAD_ON, assert_values, command, document, run, stderr, stdout};

/// Tables fit the width that is known, and are whole where none is.
#[test]
fn tables_fit_the_terminal() {
    let shown = |words: &str, columns: Option<&str>| {
        let mut command = command(&words.split(' ').collect::<Vec<_>>());
        if let Some(columns) = columns {
            command.env("COLUMNS", columns);
        }
        stdout(&command.assert().success())
    };
    let suite = "suite scenarios/colregs";
    let compare = "compare scenarios/colregs/head-on.toml --planner space-time";
    for words in [suite, compare] {
        for width in [80, 120, 200] {
            let text = shown(words, Some(&width.to_string()));
            let (table, _) = text.rsplit_once('─').expect("a table");
            let fits = |line: &str| line.chars().count() <= width;
            assert!(table.lines().all(fits), "{width}: {text}");
            let kept = ["safe", "breaks", "J", "clearance"];
            assert!(kept.iter().all(|name| table.contains(name)), "{text}");
            assert_eq!(table.contains("nodes"), width == 200, "{text}");
        }
        let whole = shown(words, None);
        // the width of the times differs from run to run
        let header = |text: &str| {
            let line = text.lines().find(|line| line.contains("outcome"));
            let words = line.expect("a header").split_whitespace();
            words.map(str::to_owned).collect::<Vec<_>>()
        };
        for columns in ["0", "wide"] {
            assert_eq!(header(&shown(words, Some(columns))), header(&whole));
        }
        assert!(whole.contains("nodes"), "{whole}");
    }
    let cards = shown(suite, Some("60"));
    assert!(
        cards.starts_with("scenario      give-way.toml\noutcome       solved\n"),
        "{cards}"
    );
    assert!(!cards.contains('─') && !cards.contains("nodes"), "{cards}");
}

/// A terminal of no columns does not know its width: help is not broken after every word.
#[test]
fn help_is_readable_where_the_width_is_zero() {
    let shown = |columns: &str| {
        let mut command = command(&["plan", "--help"]);
        stdout(&command.env("COLUMNS", columns).assert().success())
    };
    assert_eq!(shown("0"), shown("100"));
    assert_ne!(shown("0"), shown("60"));
}

/// Legs keep their turns; what happens on them is broken into lines.
#[test]
fn legs_keep_their_turns_in_a_narrow_terminal() {
    for scenario in [
        "scenarios/harbour/munkholmen.toml",
        "scenarios/harbour/canal-transit.toml",
        "scenarios/dnv/traffic_situation_55.json",
    ] {
        let mut command = command(&["plan", scenario]);
        let text = stdout(&command.env("COLUMNS", "80").assert());
        let header = text.lines().find(|line| line.contains("what happens"));
        let header = header.expect("a table of legs");
        assert!(
            header.contains("turn") && header.contains("speed"),
            "{text}"
        );
        assert!(
            text.lines().all(|line| line.chars().count() <= 80),
            "{text}"
        );
        assert!(text.contains("  [kn]") && !text.contains("m/s"), "{text}");
    }
}

/// A ship has one block: its role, the closest approach and what the judges say, or one line.
#[test]
fn every_target_of_a_plan_has_one_block() {
    let text = stdout(&run("plan scenarios/harbour/munkholmen.toml").success());
    for name in ["ferry", "leisure boat", "tug"] {
        assert_eq!(
            text.matches(&format!("  target       '{name}': ")).count(),
            1,
            "{text}"
        );
    }
    let both = "head-on on the desired trajectory, no role on the plan\n";
    assert!(text.contains(both), "{text}");
    let text = stdout(&run("plan tests/faults/horizon-at-a-turn.toml"));
    let new =
        "'4 turning': no role on the desired trajectory; on the plan own ship is stand-on from";
    assert!(text.contains(new), "{text}");
    let text = stdout(&run("plan scenarios/harbour/ferry-crossing.toml").success());
    let without =
        "  target       'launch': no role; closest: 422.5 m hull to hull at 226 s, to port\n";
    assert!(text.contains(without), "{text}");
    // a rule that is broken without a role is named, too
    let text = stdout(&run("plan tests/faults/infeasible-at-goal.toml").code(1));
    assert!(
        text.contains("; breaks collision course (R1), contact (S))")
            && text.contains("\n               breaks contact (S) at 0 s: "),
        "{text}"
    );
}

/// Where nothing could be read there is nothing but the error.
#[test]
fn a_folder_that_is_not_there_has_no_table() {
    let folder = Folder::new();
    let (nowhere, empty) = (folder.at("nowhere"), folder.at("empty"));
    std::fs::create_dir(&empty).expect("made");
    for command in [
        "suite",
        "suite --lint",
        "check",
        "compare",
        "simulate",
        "verify",
    ] {
        for place in [&nowhere, &empty] {
            let refused = run(&format!("{command} {place}")).code(2).stdout("");
            assert_eq!(stderr(&refused).matches("error: ").count(), 1, "{command}");
        }
        // the counts of several documents are no table
        let both = run(&format!("{command} {nowhere} {empty}")).code(2);
        let counted = stdout(&both).starts_with("\n2 documents: ");
        assert!(counted == (command == "verify") && (counted || stdout(&both).is_empty()));
        assert_eq!(stderr(&both).matches("error: ").count(), 2, "{command}");
    }
}

/// `-` is standard input, in the folder in which the program runs.
#[test]
fn a_scenario_is_read_from_standard_input() {
    let give = |text: &str, words: &str| {
        let mut command = command(&words.split(' ').collect::<Vec<_>>());
        command.write_stdin(text).assert()
    };
    for (words, shown) in [
        ("check -", "standard input: ok"),
        ("plan -", "Head-on: solved"),
        ("assess -", "Head-on: 1 target"),
        ("simulate - --duration-s 5", "Head-on: no contact"),
    ] {
        let text = stdout(&give(HEAD_ON, words).success());
        assert!(text.starts_with(shown), "{words}: {text}");
    }
    let map = include_str!("../../scenarios/harbour/munkholmen.toml");
    let map = map.replace("../../maps/", "maps/");
    give(&map, "check -").success();
    let foreign = include_str!("../../scenarios/dnv/traffic_situation_01.json");
    give(foreign, "check -").success();
    let early = HEAD_ON.rsplit_once("length_m").expect("a target").0;
    let (half, _) = foreign.split_at(foreign.len() / 2);
    for command in ["check -", "plan -", "assess -", "simulate -"] {
        for (text, said) in [
            (
                "",
                "standard input: 1 fault\n  found nothing; allowed: a scenario file",
            ),
            ("\n", "found nothing; allowed: a scenario file"),
            (early, "standard input: "),
            (half, "standard input: "),
        ] {
            let refused = give(text, command).code(2).stdout("");
            assert!(stderr(&refused).contains(said), "{}", stderr(&refused));
        }
    }
    give(HEAD_ON, "check ./-").code(2);
}

/// One document holds every fault with its place; valid files are in it, too.
#[test]
fn a_check_is_a_document() {
    let folder = Folder::new();
    let bad = folder.write(
        "bad.toml",
        HEAD_ON.replace("horizon_s = 400.0", "horizon_s = -1"),
    );
    let absent = folder.at("absent.toml");
    let imazu = "scenarios/imazu/imazu.json";
    let checked = run(&format!("check --json {bad} {absent} {imazu}")).code(2);
    assert!(stderr(&checked).contains("bad.toml: 1 fault") && !stderr(&checked).contains("note"));
    let checked = document(&checked);
    assert_values(
        &checked,
        r#"
/files/0/scenario null
/files/0/faults/0/line 3
/files/0/faults/0/field "horizon_s"
/files/0/faults/0/found "-1"
/files/0/faults/0/allowed "a number from 0.001 to 1000000"
/files/1/faults []
/files/2/error null
/files/2/scenario "imazu-01"
"#,
    );
    assert_eq!(checked["files"].as_array().map(Vec::len), Some(2 + 22));
    let said = checked["files"][1]["error"].as_str().expect("a reason");
    assert!(said.contains("absent.toml: cannot be read"), "{said}");
    let note = checked["files"][2]["notes"][0].as_str().expect("a note");
    assert!(note.contains("no size in the file"), "{note}");
    run("check --json scenarios/colregs").success().stderr("");
}

#[test]
fn a_quiet_command_has_an_exit_status_alone() {
    let imazu = "scenarios/imazu/imazu.json";
    let folder = Folder::new();
    for words in [
        format!("suite {imazu}"),
        format!("suite scenarios/colregs --plans {folder}/plans"),
        "suite --lint scenarios/colregs".to_owned(),
        "plan scenarios/dnv/traffic_situation_01.json --no-return".to_owned(),
        "simulate scenarios/colregs/head-on.toml scenarios/colregs/stand-on.toml".to_owned(),
    ] {
        let quiet = run(&format!("{words} --quiet")).stdout("").stderr("");
        let loud = run(&words);
        assert_eq!(
            quiet.get_output().status,
            loud.get_output().status,
            "{words}"
        );
        assert!(!stdout(&loud).is_empty(), "{words}");
        let json = document(&run(&format!("{words} --quiet --json")).stderr(""));
        assert!(json.is_object(), "{words}");
    }
    let bad = folder.write("bad.toml", "title = 3");
    let refused = run(&format!("plan {bad} --quiet")).code(2).stdout("");
    assert!(stderr(&refused).contains("bad.toml: "));
}

/// Lines go on below their value; a pipe gets them whole.
#[test]
fn long_lines_fit_the_terminal() {
    let imported = "scenarios/dnv/traffic_situation_55.json";
    for words in [
        "plan scenarios/harbour/munkholmen.toml".to_owned(),
        format!("plan {imported}"),
        format!("check {imported} scenarios/imazu/imazu.json"),
        "compare scenarios/forces/give-way.toml".to_owned(),
        "simulate scenarios/closed-loop/harbour-ferries.toml --duration-s 60".to_owned(),
        "suite --lint scenarios/imazu/imazu.json".to_owned(),
        "verify scenarios/colregs/head-on.toml".to_owned(),
    ] {
        let words: Vec<&str> = words.split(' ').collect();
        for width in [80, 120] {
            let shown = command(&words).env("COLUMNS", width.to_string()).assert();
            let text = stdout(&shown) + &stderr(&shown);
            let wide = text.lines().find(|line| line.chars().count() > width);
            assert_eq!(wide, None, "{words:?}");
        }
    }
    let shown = command(&["plan", "scenarios/harbour/munkholmen.toml"])
        .env("COLUMNS", "80")
        .assert();
    let text = stdout(&shown);
    let broken = "\n               first alteration 220 s before the closest approach on the course\n                 before it: 1 turn\n";
    assert!(text.contains(broken), "{text}");
    let whole = stdout(&run("plan scenarios/harbour/munkholmen.toml"));
    assert!(
        whole.contains("on the course before it: 1 turn\n"),
        "{whole}"
    );
}

/// What is noted of several ships, or of several situations of a file, is one note.
#[test]
fn notes_name_all_that_they_are_about() {
    let files = "scenarios/imazu/imazu.json scenarios/dnv/traffic_situation_55.json";
    let notes = stderr(&run(&format!("check {files}")).success());
    assert_eq!(notes.lines().count(), 6, "{notes}");
    for note in [
        "imazu-03, imazu-07, imazu-15, imazu-17, imazu-20, imazu-22: target 1: meets own ship at",
        "imazu.json: imazu-12: ships are missing: 3 declared, 2 found",
        "imazu.json: imazu-01, imazu-02, imazu-03, imazu-04: own ship, target 1: no size",
        "_55.json: target_ship_1, target_ship_2, target_ship_3: its track ends at 1796 s",
    ] {
        assert!(notes.contains(note), "{notes}");
    }
}

/// A plan is verified through a pipe, and goes on from one.
#[test]
fn a_plan_is_read_from_standard_input() {
    let head_on = "scenarios/colregs/head-on.toml";
    let plan = stdout(&run(&format!("plan {head_on} --json")).success());
    let give = |words: &str, text: &str| {
        let words: Vec<&str> = words.split(' ').collect();
        command(&words).write_stdin(text).assert()
    };
    let verified = stdout(&give("verify -", &plan).success());
    assert!(
        verified.starts_with("Head-on: verified, safe\n"),
        "{verified}"
    );
    let checked = document(&give("verify - --json", &plan).success());
    assert_values(&checked, "/plans/0/file \"standard input\"\n/verified 1");
    let said = stderr(&give("verify -", "").code(2));
    assert!(
        said.contains("standard input: 1 fault\n  found nothing"),
        "{said}"
    );
    let later = give(&format!("plan {head_on} --previous - --json"), &plan);
    assert!(document(&later.success())["memory"].is_object());
}
