//! Checks that the examples in the documentation match the program's output.

use std::path::PathBuf;

use crate::program::{Folder, run, searoom, stdout};
use searoom::scenario::{Fault, Scenario};

const BEGIN: &str = "all but the time -->\n```text\n";
const END: &str = "```\n<!-- suite end -->";

const ASSESS: &str = "assess scenarios/colregs/give-way.toml --at 750,0,150 --velocity 4.8,-1.4";
const ASSESS_BEGIN: &str = "<!-- assess: checked by tests/cli/docs/readme.rs -->\n```text\n";
const ASSESS_END: &str = "```\n<!-- assess end -->";

fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn read(name: &str) -> String {
    std::fs::read_to_string(file(name)).expect("a document of the project")
}

/// Words of each line without table rules and times; the times precede the last two columns.
fn untimed(table: &str) -> Vec<Vec<&str>> {
    table
        .lines()
        .map(|line| line.split_whitespace().collect::<Vec<_>>())
        .filter(|words| !words.concat().trim_matches(['─', '═']).is_empty())
        .map(|mut words| {
            if matches!(words.last(), Some(&("yes" | "NO" | "–"))) {
                words.remove(words.len() - 3);
            }
            words
        })
        .collect()
}

/// Contents of the code blocks in a language.
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
    let (_, rest) = readme.split_once(BEGIN).expect("the table's begin");
    let (shown, _) = rest.split_once(END).expect("the table's end");
    let table = stdout(&searoom(&["suite", "scenarios/colregs"]).success());
    assert_eq!(
        untimed(shown),
        untimed(&table),
        "the README is out of date; the table of today:\n{table}"
    );
}

#[test]
fn the_guide_shows_an_assessment() {
    let guide = read("docs/reference/assess.md");
    let (_, rest) = guide.split_once(ASSESS_BEGIN).expect("the begin");
    let (shown, _) = rest.split_once(ASSESS_END).expect("the end");
    assert!(guide.contains(&format!("searoom {ASSESS}\n")));
    let printed = stdout(&run(ASSESS).success());
    assert_eq!(
        shown, printed,
        "docs/reference/assess.md is out of date; the text of today:\n{printed}"
    );
}

#[test]
fn the_guide_goes_on_from_a_plan() {
    let guide = read("docs/guide/replanning.md");
    let (_, rest) = guide
        .split_once("<!-- previous: checked")
        .expect("the begin");
    let shown = blocks(rest, "text")[0];
    let folder = Folder::new();
    let first = stdout(&run("plan scenarios/colregs/head-on.toml --json").success());
    let previous = folder.write("plan.json", first);
    let later = folder.write("later.toml", blocks(&guide, "toml")[0]);
    let printed = stdout(&run(&format!("plan {later} --previous {previous}")).success());
    assert!(
        printed.starts_with(shown),
        "docs/guide/replanning.md is out of date:\n{printed}"
    );
}

#[test]
fn the_scenarios_in_the_documents_are_sound() {
    let guide = read("docs/reference/scenario.md");
    let shown = blocks(&guide, "toml");
    let [whole, targets] = shown[..] else {
        panic!("two blocks: {shown:?}");
    };
    let scenario = Scenario::parse(whole).expect("no faults");
    let both = Scenario::parse(&format!("{whole}\n{targets}")).expect("no faults");
    assert_eq!(both.targets.len(), scenario.targets.len() + 4);
}

/// Example of the README, line by line.
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

/// Unknown keys in every table of a scenario: the error lists the valid keys.
const NO_KEYS: &str = r#"
title = "A"
horizon_s = 400.0
zzz = 1
origin = { zzz = 1 }
own_ship = { zzz = 1, position = { zzz = 1 } }
mission = { zzz = 1, waypoints = [{ zzz = 1 }] }
planner = { zzz = 1, optimal_control = { zzz = 1, force_limits = { zzz = 1 } } }
targets = [
    { zzz = 1, name = "a", domain = { zzz = 1 } },
    { name = "b", initial_set = { zzz = 1 }, velocity_set = { zzz = 1 } },
    { name = "c", initial_set = { zzz = 1 }, velocity_sets = [{ zzz = 1 }] },
]
"#;

/// Number of tables of a scenario with an unknown key.
const TABLES: usize = 15;

#[test]
fn the_guide_has_every_field_of_a_scenario() {
    let guide = read("docs/reference/scenario.md");
    let faults = Scenario::parse(NO_KEYS).expect_err("keys that are none");
    let unknown: Vec<&Fault> = faults.iter().filter(|f| f.path.ends_with("zzz")).collect();
    assert_eq!(unknown.len(), TABLES, "{unknown:#?}");
    for fault in unknown {
        let keys = fault.allowed.strip_prefix("one of ").expect("a list");
        for key in keys.split(", ") {
            // the guide states once that knots, miles and cables may replace metres
            let key = key.replace("_kn", "_mps");
            let key = &key.replace("_nmi", "_m").replace("_cbl", "_m");
            let is_word = |text: &str| {
                let mut words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
                words.any(|word| word == key)
            };
            assert!(is_word(&guide), "{}: {key}", fault.path);
        }
    }
}

#[test]
fn the_page_on_comparisons_has_every_column() {
    let page = read("docs/reference/compare.md");
    let folder = Folder::new();
    let csv = folder.at("rows.csv");
    for command in ["suite", "compare"] {
        run(&format!(
            "{command} scenarios/colregs/head-on.toml --csv {csv}"
        ))
        .success();
        let mut rows = csv::Reader::from_path(&csv).expect("rows");
        for column in rows.headers().expect("columns") {
            assert!(page.contains(&format!("`{column}`")), "{column}");
        }
    }
}

/// Maximum total size of all images in the documentation, in bytes.
const PICTURES: u64 = 1_000_000;

#[test]
fn the_gallery_is_small_and_shows_what_there_is() {
    let page = read("docs/guide/figures.md");
    let mut bytes = 0;
    for picture in std::fs::read_dir(file("docs/gallery")).expect("a folder") {
        let picture = picture.expect("an entry");
        let name = picture.file_name().to_string_lossy().into_owned();
        assert!(page.contains(&format!("(../gallery/{name})")), "{name}");
        bytes += picture.metadata().expect("a file").len();
    }
    assert!((1..PICTURES).contains(&bytes), "{bytes} bytes");
}

/// Pages below docs, those at the root, and the README of each library and of the Python package.
fn pages() -> Vec<String> {
    let names = |folder: &str| -> Vec<String> {
        let entries = std::fs::read_dir(file(folder)).expect("a folder").flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        names.map(|name| format!("{folder}/{name}")).collect()
    };
    let folders = ["docs", "docs/guide", "docs/reference"].into_iter();
    let docs = folders.flat_map(names).filter(|name| name.ends_with(".md"));
    let crates = names("crates").into_iter();
    let libraries = crates.map(|library| format!("{library}/README.md"));
    let root = [
        "README.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "python/README.md",
    ];
    docs.chain(libraries)
        .chain(root.map(str::to_owned))
        .collect()
}

#[test]
fn every_file_that_the_documents_link_to_is_there() {
    let pages = pages();
    assert!(pages.len() > 40, "{pages:?}");
    for name in &pages {
        let text = read(name);
        let folder = file(name).parent().expect("a folder").to_owned();
        for target in text
            .split("](")
            .skip(1)
            .filter_map(|rest| rest.split(')').next())
            .filter(|target| !target.starts_with("http"))
        {
            let target = target.split('#').next().unwrap_or(target);
            assert!(folder.join(target).exists(), "{name}: {target}");
        }
    }
}

#[test]
fn the_citation_has_the_version_of_the_package() {
    let citation = read("CITATION.cff");
    let version = concat!("version: ", env!("CARGO_PKG_VERSION"));
    assert!(citation.lines().any(|line| line == version), "{citation}");
}
