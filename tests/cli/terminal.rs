//! What a person at a terminal sees, and what a pipe gets.

use super::program::{HEAD_ON, command, stderr, stdout};

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
            assert!(table.contains("safe") && table.contains("breaks"), "{text}");
            assert_eq!(table.contains("nodes"), width == 200, "{text}");
        }
        let whole = shown(words, None);
        for columns in ["0", "wide"] {
            assert_eq!(
                shown(words, Some(columns)).lines().nth(2),
                whole.lines().nth(2)
            );
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
    let early = HEAD_ON.split_once("speed_spread").expect("a target").0;
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
