//! Enforces module boundaries: permitted imports of each module, and the places that may name
//! external libraries.
//!
//! Parses the sources as token trees, so comments, strings and formatting do not count. Unit tests
//! inside a file (`#[cfg(test)] mod …`) may use anything.

use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Modules of the crate that each top-level module may use; a module may always use itself. Vectors
/// and their products are in `frame`, which depends on neither ships nor time.
const MAY_USE: &str = "
frame:
tolerance:
numerics:
search:
output:
parallel:
text: frame
input: frame text
geometry: tolerance frame numerics
trajectory: frame tolerance geometry
vessel: frame tolerance geometry
map: frame geometry tolerance input text
target: frame geometry tolerance vessel
colregs: frame tolerance numerics geometry trajectory target vessel input text
obstacle: frame geometry tolerance numerics target trajectory
planner: parallel obstacle trajectory vessel target search geometry frame tolerance numerics colregs
evaluation: parallel frame tolerance geometry vessel target trajectory
verification: document input frame tolerance geometry vessel target trajectory evaluation text
scenario: frame tolerance geometry trajectory vessel map target colregs planner input text
pipeline: parallel frame tolerance numerics geometry trajectory vessel target colregs obstacle planner evaluation scenario
simulation: frame tolerance geometry trajectory vessel target colregs obstacle planner evaluation scenario pipeline document replanning text
campaign: frame geometry tolerance colregs target vessel input output parallel pipeline scenario simulation document text trajectory
study: parallel document frame text tolerance trajectory vessel target colregs obstacle planner evaluation scenario pipeline
document: input frame tolerance geometry trajectory vessel target colregs obstacle planner evaluation scenario pipeline text
publication: document evaluation pipeline verification
replanning: document frame tolerance trajectory vessel target colregs planner scenario text
report: frame tolerance geometry trajectory vessel colregs obstacle planner evaluation verification scenario pipeline document study output text
recording: frame tolerance geometry trajectory vessel target colregs obstacle planner evaluation scenario pipeline document study output text
";

/// The row of a module in [`MAY_USE`].
fn may_use(module: &str) -> Option<Vec<&'static str>> {
    let row = MAY_USE
        .lines()
        .find_map(|row| row.strip_prefix(module)?.strip_prefix(':'));
    row.map(|used| used.split_whitespace().collect())
}

/// Paths that a module may not name although it may use their top-level module.
const NEVER: &[(&str, &str)] = &[
    ("scenario", "planner::cost"),
    ("scenario", "planner::space_time"),
    ("scenario", "planner::path_time"),
    ("scenario", "planner::optimal_control"),
];

/// Names with the only path prefixes below `src/` where they may occur.
const ONLY_IN: &[(&str, &[&str])] = &[
    ("rerun", &["recording/", "cli/inspect"]),
    ("parry2d_f64", &["geometry/parry"]),
    ("geojson", &["map/", "report/route.rs"]),
    ("chrono", &["input/", "scenario/", "report/route.rs"]),
    ("spade", &["geometry/polygon/decomposition.rs"]),
    ("robust", &["geometry/"]),
    ("roxmltree", &["scenario/import/"]),
    ("kurbo", &["report/figure/render.rs"]),
    ("kuva", &["report/figure/"]),
    ("png", &["report/figure/render.rs"]),
    ("parquet", &["campaign/part.rs"]),
    ("statrs", &["campaign/bounds.rs"]),
    ("clap", &["cli/", "main.rs"]),
    (
        "textwrap",
        &["cli/output/mod.rs", "report/table.rs", "text.rs"],
    ),
    ("to_degrees", &["frame.rs"]),
    ("to_radians", &["frame.rs"]),
    // nothing outside asks which planner it has
    ("SpaceTimePlanner", &["planner/"]),
    ("PathTimePlanner", &["planner/"]),
    ("OptimalControlPlanner", &["planner/"]),
    ("println", &["cli/output/mod.rs"]),
    ("print", &["cli/output/mod.rs"]),
    ("eprintln", &["cli/output/mod.rs"]),
    ("eprint", &["cli/output/mod.rs"]),
    ("dbg", &[]),
];

/// Modules of the binary: they may use everything, and no module may use them.
const BINARY: &[&str] = &["cli", "main"];

/// Lists all faults of one file; `path` is below `src/`, with forward slashes.
fn faults(path: &str, text: &str) -> Vec<String> {
    let mut faults = Vec::new();
    let tokens: TokenStream = match text.parse() {
        Ok(tokens) => tokens,
        Err(error) => return vec![format!("{path}: not Rust: {error}")],
    };
    let module = module_of(path);
    // a file with unit tests only
    if module.iter().any(|m| m == "tests") {
        return faults;
    }
    let mut names = Vec::new();
    let mut used = Vec::new();
    read(tokens, &module, &mut names, &mut used);
    for name in names {
        let allowed = ONLY_IN.iter().find(|(n, _)| *n == name);
        if let Some((_, places)) = allowed
            && !places.iter().any(|place| path.starts_with(place))
        {
            faults.push(format!("{path}: names {name}, allowed only in {places:?}"));
        }
    }
    // the library's root names every module to declare it
    let Some(room) = module.first().filter(|m| !BINARY.contains(&m.as_str())) else {
        return faults;
    };
    let Some(allowed) = may_use(room) else {
        faults.push(format!("{path}: room {room} is not in the table"));
        return faults;
    };
    for path_used in used {
        let first = path_used.split("::").next().unwrap_or_default();
        let known = may_use(first).is_some() || BINARY.contains(&first);
        if known && first != room && !allowed.contains(&first) {
            faults.push(format!("{path}: {room} may not use {path_used}"));
        }
        for (_, never) in NEVER.iter().filter(|(r, _)| r == room) {
            if path_used == *never || path_used.starts_with(&format!("{never}::")) {
                faults.push(format!("{path}: {room} may not use {path_used}"));
            }
        }
    }
    faults
}

fn module_of(path: &str) -> Vec<String> {
    let stem = path.strip_suffix(".rs").unwrap_or(path);
    let mut module: Vec<String> = stem.split('/').map(str::to_owned).collect();
    if module.last().is_some_and(|m| m == "mod" || m == "lib") {
        module.pop();
    }
    module
}

/// Collects every identifier that is or starts a path, and every path below the crate.
fn read(tokens: TokenStream, module: &[String], names: &mut Vec<String>, used: &mut Vec<String>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut i = 0;
    while i < tokens.len() {
        if let Some(after) = skip_unit_tests(&tokens, i) {
            i = after;
            continue;
        }
        match &tokens[i] {
            TokenTree::Group(group) => read(group.stream(), module, names, used),
            TokenTree::Ident(ident) => {
                let name = ident.to_string();
                let macro_only = ["println", "print", "eprintln", "eprint", "dbg"];
                if !macro_only.contains(&name.as_str()) || is_punct(tokens.get(i + 1), '!') {
                    names.push(name.clone());
                }
                let headed = i > 0 && is_punct(tokens.get(i - 1), ':');
                if !headed && let Some((base, after)) = base(&tokens, i, module) {
                    expand(&tokens[after..], &base, used);
                }
            }
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
        i += 1;
    }
}

/// Resolves `crate::` or `super::super::` at `i` to its module, and the index where the path
/// continues.
fn base(tokens: &[TokenTree], i: usize, module: &[String]) -> Option<(Vec<String>, usize)> {
    let word = |i: usize| match tokens.get(i) {
        Some(TokenTree::Ident(ident)) => Some(ident.to_string()),
        _ => None,
    };
    let colons = |i: usize| is_punct(tokens.get(i), ':') && is_punct(tokens.get(i + 1), ':');
    match word(i)?.as_str() {
        "crate" | "searoom" if colons(i + 1) => Some((Vec::new(), i + 3)),
        "super" => {
            let (mut base, mut at) = (module.to_vec(), i);
            while word(at).is_some_and(|w| w == "super") && colons(at + 1) {
                base.pop();
                at += 3;
            }
            Some((base, at))
        }
        _ => None,
    }
}

/// Adds `a::b::c` and the members of `a::{b, c::{d}}`.
fn expand(tokens: &[TokenTree], base: &[String], used: &mut Vec<String>) {
    match tokens.first() {
        Some(TokenTree::Ident(ident)) => {
            let mut path = base.to_vec();
            path.push(ident.to_string());
            if is_punct(tokens.get(1), ':') && is_punct(tokens.get(2), ':') {
                expand(&tokens[3..], &path, used);
            } else {
                used.push(path.join("::"));
            }
        }
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
            let members: Vec<TokenTree> = group.stream().into_iter().collect();
            for member in members.split(|t| is_punct(Some(t), ',')) {
                expand(member, base, used);
            }
        }
        _ => used.push(base.join("::")),
    }
}

fn is_punct(token: Option<&TokenTree>, character: char) -> bool {
    matches!(token, Some(TokenTree::Punct(p)) if p.as_char() == character)
}

/// Index after `#[cfg(test)] mod name { … }` or `#[cfg(test)] mod name;` if it starts at `i`.
fn skip_unit_tests(tokens: &[TokenTree], i: usize) -> Option<usize> {
    let TokenTree::Group(attribute) = tokens.get(i + 1)? else {
        return None;
    };
    let is_test = is_punct(tokens.get(i), '#')
        && attribute.stream().to_string().replace(' ', "") == "cfg(test)";
    let mut at = i + 2;
    if !is_test {
        return None;
    }
    // visibility and further attributes may occur between
    while !matches!(tokens.get(at)?, TokenTree::Ident(word) if word == "mod") {
        at += 1;
        if at > i + 8 {
            return None;
        }
    }
    Some(at + 3)
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("a readable folder")
        .map(|entry| entry.expect("a readable entry").path())
        .collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn the_sources_keep_the_borders() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    // the build script is a program of its own
    files.retain(|file| *file != root.join("build.rs"));
    assert!(files.len() > 20, "{files:?}");
    let faults: Vec<String> = files
        .iter()
        .flat_map(|file| faults(&below(&root, file), &text_of(file)))
        .collect();
    assert!(faults.is_empty(), "{faults:#?}");
}

/// Path of a file below a folder, with forward slashes.
fn below(root: &Path, file: &Path) -> String {
    let path = file.strip_prefix(root).expect("below the folder");
    path.to_string_lossy().replace('\\', "/")
}

fn text_of(file: &Path) -> String {
    std::fs::read_to_string(file).expect("text")
}

fn rows(table: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    table.lines().filter_map(|row| row.split_once(" | "))
}

/// Paths below `src/` with a line that each breaks one border.
const BROKEN: &str = r#"
geometry/disc.rs | use crate::vessel::Hull;
search/mod.rs | fn f() -> crate::frame::Pose { todo!() }
planner/cost.rs | use crate::{frame::Pose, evaluation::Evaluation};
planner/space_time/graph/mod.rs | use super::super::super::scenario::Scenario;
evaluation/mod.rs | use crate::obstacle::contact::first_contact;
verification/mod.rs | use crate::recording::Recorded;
verification/coverage.rs | use crate::obstacle::Obstacle;
verification/motion.rs | use crate::planner::PLANNERS;
scenario/mod.rs | use crate::planner::{SearchKind, space_time};
pipeline.rs | use crate::report::table;
pipeline/mod.rs | use crate::planner::path_time::PathTimePlanner;
report/table.rs | use crate::recording::Recording;
colregs/domain.rs | use crate::cli::output;
target.rs | use rerun::RecordingStream;
report/table.rs | use kuva::plot::LinePlot;
trajectory/mod.rs | use parry2d_f64::math::Point;
report/table.rs | #[derive(clap::ValueEnum)] enum A { B }
scenario/check.rs | fn f(a: f64) -> f64 { a.to_radians() }
cli/plan.rs | fn f() { println!("x"); }
planner/mod.rs | fn f() { dbg!(1); }
weather/mod.rs | fn f() {}
frame.rs | fn f( {
"#;

#[test]
fn every_border_can_be_broken() {
    for (path, text) in rows(BROKEN) {
        assert_eq!(
            faults(path, text).len(),
            1,
            "{path}: {text}: {:?}",
            faults(path, text)
        );
    }
}

/// Paths below `src/` with a line that breaks no border.
const ALLOWED: &str = r#"
geometry/disc.rs | use crate::frame::Vector; // crate::vessel, println!, rerun
geometry/disc.rs | #[cfg(test)] mod tests { use crate::vessel::Hull; }
geometry/disc.rs | #[cfg(test)] pub(crate) mod tests;
geometry/disc.rs | const A: &str = "use crate::vessel";
planner/space_time/graph/mod.rs | use super::super::{Problem, cost}; use super::route;
scenario/mod.rs | use crate::planner::SearchKind;
cli/output/mod.rs | fn f() { println!("x"); }
cli/plan.rs | use searoom::recording::record; use clap::Args;
recording/file.rs | use rerun::external::re_log;
lib.rs | pub mod cli; pub use crate::planner::Plan;
"#;

#[test]
fn what_is_allowed_passes() {
    for (path, text) in rows(ALLOWED) {
        assert_eq!(faults(path, text), Vec::<String>::new());
    }
}
