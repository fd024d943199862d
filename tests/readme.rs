//! What the documents show is what the program does.
//!
//! The tables in the README are written anew by
//!
//! ```text
//! SEAROOM_UPDATE_README=1 cargo test --release --no-default-features --test readme
//! ```

use std::path::PathBuf;
use std::process::Command;

use searoom::scenario::Scenario;

const BEGIN: &str = "all but the time -->\n```text\n";
const END: &str = "```\n<!-- suite end -->";

const ASSESS: &[&str] = &[
    "assess",
    "scenarios/colregs/give-way.toml",
    "--at",
    "750,0,150",
    "--velocity",
    "4.8,-1.4",
];
const ASSESS_BEGIN: &str = "<!-- assess: checked by tests/readme.rs -->\n```text\n";
const ASSESS_END: &str = "```\n<!-- assess end -->";

fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn read(name: &str) -> String {
    std::fs::read_to_string(file(name)).expect("a document of the project")
}

/// What the program prints.
fn searoom(args: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_searoom"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(args)
        .output()
        .expect("started");
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).expect("text")
}

/// The words of each line without rules and without the times, which are the last but one of a row.
fn untimed(table: &str) -> Vec<Vec<&str>> {
    table
        .lines()
        .map(|line| line.split_whitespace().collect::<Vec<_>>())
        .filter(|words| {
            !words
                .iter()
                .all(|w| w.chars().all(|c| matches!(c, '─' | '═')))
        })
        .map(|mut words| {
            if matches!(words.last(), Some(&("yes" | "NO" | "–"))) {
                words.remove(words.len() - 2);
            }
            words
        })
        .collect()
}

/// The contents of the blocks of a language.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    text.split(&fence)
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .collect()
}

#[test]
fn the_readme_shows_the_table_of_the_suite() {
    let readme = read("README.md");
    let (before, rest) = readme.split_once(BEGIN).expect("the table's begin");
    let (shown, after) = rest.split_once(END).expect("the table's end");
    let table = searoom(&["suite", "scenarios/colregs"]);
    if std::env::var_os("SEAROOM_UPDATE_README").is_some() {
        let text = format!("{before}{BEGIN}{table}{END}{after}");
        let (before, rest) = text
            .split_once(ASSESS_BEGIN)
            .expect("the assessment's begin");
        let (_, after) = rest.split_once(ASSESS_END).expect("the assessment's end");
        let assessment = searoom(ASSESS);
        let text = format!("{before}{ASSESS_BEGIN}{assessment}{ASSESS_END}{after}");
        std::fs::write(file("README.md"), text).expect("written");
        return;
    }
    assert_eq!(
        untimed(shown),
        untimed(&table),
        "the README is out of date: SEAROOM_UPDATE_README=1 cargo test --release --no-default-features --test readme"
    );
}

#[test]
fn the_readme_shows_an_assessment() {
    let readme = read("README.md");
    let (_, rest) = readme
        .split_once(ASSESS_BEGIN)
        .expect("the assessment's begin");
    let (shown, _) = rest.split_once(ASSESS_END).expect("the assessment's end");
    assert!(readme.contains(&format!("searoom {}\n", ASSESS.join(" "))));
    if std::env::var_os("SEAROOM_UPDATE_README").is_none() {
        assert_eq!(shown, searoom(ASSESS));
    }
}

#[test]
fn the_scenarios_in_the_documents_are_sound() {
    let readme = read("README.md");
    let whole = blocks(&readme, "toml");
    assert_eq!(whole.len(), 1);
    let scenario = Scenario::parse(whole[0]).expect("no faults");
    let guide = read("docs/scenario.md");
    let targets = blocks(&guide, "toml");
    assert_eq!(targets.len(), 1);
    let both = Scenario::parse(&format!("{}\n{}", whole[0], targets[0])).expect("no faults");
    assert_eq!(both.targets.len(), scenario.targets.len() + 3);
}

/// The README's example, line by line.
fn example() -> Result<(), Box<dyn std::error::Error>> {
    let scenario = searoom::scenario::Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
    let run = searoom::pipeline::run(scenario);
    println!("{}", searoom::report::plan_text(&run));
    Ok(())
}

#[test]
fn the_example_in_the_readme_runs() {
    let (readme, here) = (read("README.md"), include_str!("readme.rs"));
    let shown = blocks(&readme, "rust");
    assert_eq!(shown.len(), 1);
    for line in shown[0].lines() {
        assert!(here.lines().any(|own| own.trim() == line), "{line}");
    }
    example().expect("a scenario without faults");
}

#[test]
fn every_file_that_the_documents_link_to_is_there() {
    for name in [
        "README.md",
        "docs/scenario.md",
        "docs/formats.md",
        "docs/sets.md",
        "docs/assess.md",
        "docs/space-time-planner.md",
        "docs/path-time-planner.md",
        "docs/development.md",
    ] {
        let text = read(name);
        let folder = file(name).parent().expect("a folder").to_owned();
        for target in text
            .split("](")
            .skip(1)
            .filter_map(|rest| rest.split(')').next())
            .filter(|target| !target.starts_with("http"))
        {
            assert!(folder.join(target).exists(), "{name}: {target}");
        }
    }
}
