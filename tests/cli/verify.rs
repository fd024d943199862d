//! `searoom verify` as a user runs it.

use std::fs;

use super::program::{Folder, HEAD_ON, document, list, run, says, searoom, stderr, stdout, text};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};

#[test]
fn plans_that_a_suite_wrote_are_verified_and_altered_ones_rejected() {
    let folder = Folder::new();
    let plans = text(folder.path()).to_owned();
    searoom(&["suite", "scenarios/colregs", "--plans", &plans]).success();
    let file = |name: &str| format!("{plans}/{name}.json");
    let four = ["give-way", "head-on", "overtaking", "stand-on"].map(file);
    run(&format!("verify {}", four.join(" ")))
        .success()
        .stderr(is_empty())
        .stdout(contains(
            "head-on.json: Head-on: verified, safe; space-time plan, 10 pieces until ",
        ))
        .stdout(contains("margin").not());
    searoom(&["verify", &four[1]])
        .success()
        .stdout(contains("Head-on: verified, safe\n").and(contains("margin")));
    searoom(&["verify", &plans])
        .success()
        .stdout(contains("4 documents: 4 verified, 4 safe").and(contains("margin").not()));
    let empty = Folder::new();
    searoom(&["verify", text(empty.path())])
        .code(2)
        .stderr(contains("a folder without plan documents"));
    let altered = file("altered");
    let good = fs::read_to_string(&four[1]).expect("a plan");
    let from = "\"turning_radius_m\": 100.0";
    assert!(good.contains(from));
    fs::write(&altered, good.replace(from, "\"turning_radius_m\": 101.0")).expect("written");
    searoom(&["verify", &altered])
        .code(1)
        .stderr(is_empty())
        .stdout(contains("Head-on: REJECTED").and(contains("turning radius in segment")));
    // the highest status of all wins, and every file is answered
    let broken = file("broken");
    fs::write(&broken, &good[..good.len() / 2]).expect("written");
    let first = &four[0];
    let all = run(&format!(
        "verify --json {broken} {altered} {first} no-such.json"
    ))
    .code(2)
    .stderr(contains("broken.json: ").and(contains("no-such.json: cannot be read")));
    let found = document(&all);
    let verdicts: Vec<_> = list(&found["plans"])
        .iter()
        .map(|p| &p["verified"])
        .collect();
    assert_eq!(verdicts, [false, false, true, false]);
    assert_eq!(found["verified"], 1);
    assert_eq!(found["plans"][2]["targets"][0]["target"], "target");
    searoom(&["verify"]).code(2).stderr(contains("PLAN.json"));
    // what is not proven in time is not verified, and says so
    let budget = ["verify", "--budget-s", "1e-9", &four[0]];
    let late = "give-way.json: not proven within the budget of 0.000000001 s";
    searoom(&budget).code(1).stderr(contains(late));
    let all = searoom(&[&budget[..], &["--json"]].concat()).code(1);
    let found = document(&all);
    assert_eq!(found["plans"][0]["outcome"], "unproven");
    assert_eq!(found["plans"][0]["verified"], false);
    for wrong in ["0", "-1", "soon", "1e300"] {
        searoom(&["verify", "--budget-s", wrong, &four[0]])
            .code(2)
            .stderr(contains("a positive number of seconds"));
    }
}

/// The message for another document says that it is no plan document, and which kind it is.
#[test]
fn other_documents_are_no_plans() {
    let folder = Folder::new();
    let compared = run("compare scenarios/colregs/head-on.toml --planner path-time --json");
    folder.write("comparison.json", stdout(&compared.code(1)));
    folder.refuses(
        "
        verify README.md | found no JSON (expected value at line 1 column 1); allowed: a plan document
        verify DIR/comparison.json | format: found none in a document with the keys comparisons; allowed: searoom-plan/1
        ",
    );
}

/// What `compare`, `suite` and `simulate` write beside plans does not stop a check of the folder; a
/// plan that is cut or has no format does.
#[test]
fn results_of_other_commands_in_a_folder_are_left_out() {
    let folder = Folder::new();
    let head_on = "scenarios/colregs/head-on.toml";
    for (name, words) in [
        ("plan", "plan"),
        ("compared", "compare --planner space-time"),
        ("suite", "suite"),
        ("checked", "assess"),
        ("sailed", "simulate --duration-s 20"),
    ] {
        let (command, options) = words.split_once(' ').unwrap_or((words, ""));
        let document = run(&format!("{command} {head_on} --json {options}"));
        folder.write(&format!("{name}.json"), stdout(&document));
    }
    let verified = searoom(&["verify", text(folder.path())]).success();
    says(&stdout(&verified), "2 documents: 2 verified, 2 safe");
    let said = stderr(&verified);
    assert_eq!(
        said.matches("a result document, left out").count(),
        3,
        "{said}"
    );
    let alone = Folder::new();
    alone.write(
        "suite.json",
        fs::read_to_string(folder.at("suite.json")).expect("a suite"),
    );
    let refused = searoom(&["verify", text(alone.path())]).code(2);
    says(&stderr(&refused), "nothing to verify");
    let plan = fs::read_to_string(folder.at("plan.json")).expect("a plan");
    for broken in [
        &plan[..plan.len() / 2],
        &plan.replacen("\"format\"", "\"formats\"", 1),
    ] {
        folder.write("broken.json", broken);
        searoom(&["verify", text(folder.path())]).code(2);
    }
}

/// Texts of a document are shown, not obeyed: a terminal sees no control character and no line of
/// their own.
#[test]
fn control_characters_of_others_are_shown_as_codes() {
    let said = stdout(&searoom(&["verify", "tests/faults/verify-spoof.json"]).code(1));
    assert!(!said.contains('\u{1b}'), "{said:?}");
    let first = said.lines().next().expect("a line");
    says(first, r"verified\u000aspace-time | \u001b[8m | REJECTED");
    // as JSON the text is what it was
    let checked = document(&run("verify --json tests/faults/verify-spoof.json").code(1));
    let title = checked["plans"][0]["scenario"].as_str().expect("a text");
    assert!(title.contains("\u{1b}[8m"));

    let folder = Folder::new();
    let bad = "\u{1b}[8m\u{9b}2J\u{202e}\u{7f}";
    let key = bad
        .replace('\u{1b}', "\\u001b")
        .replace('\u{7f}', "\\u007f");
    let file = folder.write(&format!("a{bad}.toml"), format!("\"{key}\" = 1\n{HEAD_ON}"));
    let plan = folder.write(&format!("b{bad}.json"), format!("{{\"{bad}\": 1}}"));
    let profile = folder.write("c.toml", format!("x = \"{bad}\"\n"));
    let scenario = "scenarios/colregs/head-on.toml";
    for args in [
        &["check", &file][..],
        &["plan", &file],
        &["suite", &file],
        &["compare", &file],
        &["assess", &file],
        &["inspect", &plan],
        &["verify", &plan],
        &["import", &plan, "--out", text(folder.path())],
        &["plan", scenario, "--thresholds", &profile],
    ] {
        let output = searoom(args).code(2);
        for said in [stdout(&output), stderr(&output)] {
            let acts = |c: char| c.is_control() && !"\n\t".contains(c) || c == '\u{202e}';
            assert!(!said.contains(acts), "{args:?}: {said:?}");
        }
    }
}
