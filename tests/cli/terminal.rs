//! What a person at a terminal sees, and what a pipe gets.

use super::program::{command, stdout};

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
