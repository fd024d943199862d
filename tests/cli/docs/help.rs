//! What the program says of itself.

use crate::program::{searoom, stdout};
use predicates::str::is_empty;

/// A heading holds for what follows it.
#[test]
fn options_stand_under_their_own_heading() {
    for (command, option) in [
        ("plan", "--no-return"),
        ("suite", "--plans"),
        ("suite", "--lint"),
    ] {
        let help = stdout(&searoom(&[command, "--help"]).success());
        let (own, foreign) = help.split_once("Foreign files").expect("a heading");
        assert!(own.contains(option) && !foreign.contains(option), "{help}");
        assert!(foreign.contains("--variants"), "{help}");
    }
}

#[test]
fn shells_know_every_command() {
    let commands = [
        "init", "check", "assess", "plan", "suite", "compare", "inspect", "verify", "schema",
    ];
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = stdout(
            &searoom(&["completions", shell])
                .success()
                .stderr(is_empty()),
        );
        let all = commands.iter().all(|c| text.contains(c)) && text.contains("max-risk");
        assert!(all, "{shell}");
        // the words of options, where the generator of the shell knows them
        let knows_words = !["powershell", "elvish"].contains(&shell);
        for words in [
            ["space-time", "path-time"],
            ["a-star", "thorough"],
            ["dnv-trafficgen", "sfi-autoship"],
            ["scenario", "lint"],
        ] {
            let all = words.iter().all(|word| text.contains(word));
            assert!(all || !knows_words, "{shell}: {words:?}");
        }
    }
    searoom(&["completions", "csh"]).code(2);
}
