//! Many files at once: which are run, what is written, and their report.

use std::fs;

use super::program::{Folder, HEAD_ON, document, run, says, searoom, stderr, stdout, text};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};
use serde_json::Value;

#[test]
fn the_scenarios_of_the_project_are_good() {
    let checked = searoom(&["check", "scenarios"])
        .success()
        .stdout(contains("scenarios/colregs/head-on.toml: ok"))
        .stdout(contains("scenarios/imazu/imazu.json: imazu-22: ok"));
    // what foreign files do not say is told, and nothing else
    let messages = String::from_utf8_lossy(&checked.get_output().stderr).into_owned();
    let foreign = ["dnv", "imazu", "commonocean"].map(|f| format!("note: scenarios/{f}/"));
    for line in messages.lines() {
        assert!(foreign.iter().any(|f| line.starts_with(f)), "{line}");
    }
}

#[test]
fn two_results_never_share_a_file() {
    let folder = Folder::new();
    let a = folder.write("a/same.toml", HEAD_ON);
    let b = folder.write("b/same.toml", HEAD_ON);
    searoom(&["suite", &a, &b, "--plans", &folder.at("plans")])
        .code(2)
        .stdout(is_empty())
        .stderr(contains("'same'"));
    assert!(!folder.path().join("plans").exists());
}

#[cfg(not(feature = "recording"))]
#[test]
fn recordings_need_their_feature() {
    for command in ["suite", "simulate"] {
        searoom(&[command, "scenarios/colregs", "--rrd", "recordings/"])
            .code(2)
            .stdout(is_empty())
            .stderr(contains("built without recordings"));
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

/// Scenarios that the rules or a planner of the command line do not fit are no fault of theirs.
#[test]
fn a_suite_skips_what_does_not_apply() {
    let folder = Folder::new();
    let ferry = "scenarios/harbour/ferry-crossing.toml";
    let head_on = "scenarios/colregs/head-on.toml";
    let page = folder.at("page");
    let asked = ["suite", ferry, head_on, "--compliance", "rules"];
    let said = searoom(&[asked.as_slice(), &["--report", &page]].concat()).success();
    let expected = "2 scenarios: 1 solved, 1 not applicable; 1 verified, 1 safe";
    assert!(stdout(&said).contains(expected), "{}", stdout(&said));
    assert!(!stdout(&said).contains("unreadable") && !stderr(&said).contains("error"));
    let page = fs::read_to_string(format!("{page}/index.html")).expect("a page");
    assert!(page.contains("not applicable") && page.contains("planner.compliance"));
    let suite = document(&searoom(&[asked.as_slice(), &["--json"]].concat()).success());
    let run = &suite["runs"][0];
    assert_eq!(run["outcome"], "not-applicable");
    assert_eq!(run["error"], Value::Null);
    says(
        run["reason"].as_str().expect("a text"),
        "planner.compliance",
    );
    assert_eq!(suite["summary"]["not_applicable"], 1);
    assert_eq!(suite["summary"]["unreadable"], 0);
    // a single plan that was asked for is refused
    searoom(&["plan", ferry, "--compliance", "rules"])
        .code(2)
        .stderr(contains("planner.compliance"));
}

/// A page that is given to others does not tell where its files were on this machine.
#[test]
fn a_report_has_no_folder_of_this_machine() {
    let folder = Folder::new();
    let good = folder.write("secret/good.toml", HEAD_ON);
    let bad = folder.write("secret/bad.toml", "title = 3");
    let scenario = "scenarios/colregs/head-on.toml";
    let here = format!("{}/{scenario}", env!("CARGO_MANIFEST_DIR"));
    let page = folder.at("page");
    let read = || fs::read_to_string(format!("{page}/index.html")).expect("a page");
    searoom(&["suite", &good, &bad, "--report", &page]).code(2);
    assert!(read().contains("good.toml") && read().contains("bad.toml"));
    assert!(!read().contains("secret"), "{}", read());
    searoom(&["compare", &good, &bad, "--report", &page]).code(2);
    assert!(read().contains("good.toml") && !read().contains("secret"));
    searoom(&["plan", &here, "--report", &page]).success();
    says(&read(), &format!("<p class=\"quiet\">{scenario}</p>"));
}

#[test]
fn a_report_is_one_page_with_its_figures() {
    let folder = Folder::new();
    let broken = folder.write("broken.toml", "title = \"<b>\"\n");
    let (suite, plans) = (folder.at("suite"), folder.at("plans"));
    run(&format!(
        "suite scenarios/colregs {broken} --report {suite} --plans {plans}"
    ))
    .code(2)
    .stdout(contains("5 scenarios: 4 solved, 1 unreadable"));
    let page = fs::read_to_string(format!("{suite}/index.html")).expect("a page");
    assert_eq!(page.matches("<img").count(), 4, "{page}");
    assert!(page.contains("href=\"./../plans/head-on.json\"") && page.contains("unreadable"));
    assert!(page.contains("5 scenarios: 4 solved"));

    run(&format!(
        "plan scenarios/colregs/head-on.toml --report {broken}"
    ))
    .code(2)
    .stderr(contains("--report: ").and(contains("folder")));
}
