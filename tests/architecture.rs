//! Enforces module boundaries: permitted imports of each module, and the places that may name
//! external libraries.
//!
//! Parses the sources as token trees, so comments, strings and formatting do not count. Unit tests
//! inside a file (`#[cfg(test)] mod …`) may use anything.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Modules of the program's package, and the libraries by their names there, that each of its
/// top-level modules may use; a module may always use itself. Between libraries the manifests hold
/// the borders.
const MAY_USE: &str = "
labels: frame geometry
output:
pipeline: parallel frame tolerance numerics geometry trajectory vessel target colregs obstacle planner evaluation scenario
simulation: frame tolerance geometry trajectory vessel target colregs obstacle planner evaluation scenario pipeline document replanning text
campaign: frame geometry tolerance colregs target vessel input output parallel pipeline scenario simulation document text trajectory
study: parallel document frame text tolerance trajectory vessel target colregs obstacle planner evaluation scenario pipeline
document: input frame tolerance geometry trajectory vessel target colregs obstacle planner evaluation scenario pipeline replanning text
publication: document evaluation pipeline verification
traffic: frame tolerance trajectory target colregs obstacle planner scenario pipeline document replanning vessel
replanning: frame tolerance trajectory vessel target colregs planner scenario pipeline text
report: labels frame tolerance geometry trajectory vessel colregs obstacle planner evaluation verification scenario pipeline document study output text
recording: labels frame tolerance geometry trajectory vessel target colregs obstacle planner evaluation scenario pipeline document study output text
";

/// The libraries by their names in the program's package.
const LIBRARIES: [&str; 18] = [
    "colregs",
    "evaluation",
    "frame",
    "geometry",
    "input",
    "map",
    "numerics",
    "obstacle",
    "parallel",
    "planner",
    "scenario",
    "search",
    "target",
    "text",
    "tolerance",
    "trajectory",
    "verification",
    "vessel",
];

/// The row of a module in [`MAY_USE`].
fn may_use(module: &str) -> Option<Vec<&'static str>> {
    let row = MAY_USE
        .lines()
        .find_map(|row| row.strip_prefix(module)?.strip_prefix(':'));
    row.map(|used| used.split_whitespace().collect())
}

/// Paths that a library, or a module of the program, may not name although it may use their
/// top-level module.
const NEVER: &[(&str, &str)] = &[
    ("scenario", "planner::cost"),
    ("scenario", "planner::space_time"),
    ("scenario", "planner::path_time"),
    ("scenario", "planner::optimal_control"),
];

/// Names with the only path prefixes where they may occur.
const ONLY_IN: &[(&str, &[&str])] = &[
    ("rerun", &["src/recording/", "src/cli/inspect"]),
    ("parry2d_f64", &["crates/geometry/src/parry"]),
    (
        "geojson",
        &["crates/scenario/src/map/", "src/report/route.rs"],
    ),
    (
        "chrono",
        &[
            "crates/input/src/field.rs",
            "crates/scenario/src/",
            "crates/traffic/src/",
            "src/report/route.rs",
        ],
    ),
    ("toml", &["crates/input/src/value.rs"]),
    ("spade", &["crates/geometry/src/polygon/decomposition.rs"]),
    ("robust", &["crates/geometry/src/"]),
    ("roxmltree", &["crates/scenario/src/import/"]),
    ("kurbo", &["src/report/figure/render.rs"]),
    ("kuva", &["src/report/figure/"]),
    ("png", &["src/report/figure/render.rs"]),
    ("parquet", &["src/campaign/part.rs", "crates/traffic/src/"]),
    ("statrs", &["src/campaign/bounds.rs"]),
    ("clap", &["src/cli/", "src/main.rs"]),
    (
        "textwrap",
        &[
            "src/cli/output/mod.rs",
            "src/report/table.rs",
            "crates/input/src/text.rs",
        ],
    ),
    ("to_degrees", &["crates/geometry/src/frame.rs"]),
    ("to_radians", &["crates/geometry/src/frame.rs"]),
    // nothing outside asks which planner it has
    ("SpaceTimePlanner", &["crates/planner/src/"]),
    ("PathTimePlanner", &["crates/planner/src/"]),
    ("OptimalControlPlanner", &["crates/planner/src/"]),
    ("println", &["src/cli/output/mod.rs"]),
    ("print", &["src/cli/output/mod.rs"]),
    ("eprintln", &["src/cli/output/mod.rs"]),
    ("eprint", &["src/cli/output/mod.rs"]),
    ("dbg", &[]),
];

/// Modules of the binary: they may use everything, and no module may use them.
const BINARY: &[&str] = &["cli", "main"];

/// Lists all faults of one file; `path` is below the repository, with forward slashes.
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
    let mut never_used = |room: &str| {
        for path_used in &used {
            for (_, never) in NEVER.iter().filter(|(r, _)| *r == room) {
                if path_used == never || path_used.starts_with(&format!("{never}::")) {
                    faults.push(format!("{path}: {room} may not use {path_used}"));
                }
            }
        }
    };
    if let Some(library) = path.strip_prefix("crates/") {
        never_used(library.split('/').next().unwrap_or_default());
        return faults;
    }
    // the library's root names every module to declare it
    let Some(room) = module.first().filter(|m| !BINARY.contains(&m.as_str())) else {
        return faults;
    };
    never_used(room);
    let Some(allowed) = may_use(room) else {
        faults.push(format!("{path}: room {room} is not in the table"));
        return faults;
    };
    for path_used in used {
        let first = path_used.split("::").next().unwrap_or_default();
        let known =
            may_use(first).is_some() || LIBRARIES.contains(&first) || BINARY.contains(&first);
        if known && first != room && !allowed.contains(&first) {
            faults.push(format!("{path}: {room} may not use {path_used}"));
        }
    }
    faults
}

/// The module of a file within its crate.
fn module_of(path: &str) -> Vec<String> {
    let below = path.split_once("src/").map_or(path, |(_, below)| below);
    let stem = below.strip_suffix(".rs").unwrap_or(below);
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
        library if colons(i + 1) && library.starts_with("searoom_") => {
            Some((facade(library, word(i + 3).as_deref()), i + 3))
        }
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

/// Where the program's package has a library, whose path goes on with `next`.
fn facade(library: &str, next: Option<&str>) -> Vec<String> {
    let topic = match (library, next) {
        ("searoom_geometry", Some("frame" | "tolerance" | "numerics")) => return Vec::new(),
        ("searoom_planner", Some("search"))
        | ("searoom_model", _)
        | ("searoom_scenario", Some("map"))
        | ("searoom_input", Some("text")) => return Vec::new(),
        ("searoom_sets", _) => "obstacle",
        (other, _) => other.trim_start_matches("searoom_"),
    };
    vec![topic.to_owned()]
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

/// Sources of the program and of the libraries: paths below the repository, and texts.
fn all_sources() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    sources(&root.join("src"), &mut files);
    sources(&root.join("crates"), &mut files);
    // the build script, the examples and the benchmarks are programs of their own
    files.retain(|file| *file != root.join("src/build.rs"));
    let is_program = |path: String| path.contains("/examples/") || path.contains("/benches/");
    files.retain(|file| !is_program(below(root, file)));
    assert!(files.len() > 20, "{files:?}");
    let read = |file: &PathBuf| (below(root, file), text_of(file));
    files.iter().map(read).collect()
}

#[test]
fn the_sources_keep_the_borders() {
    let all = all_sources();
    let found = all.iter().flat_map(|(path, text)| faults(path, text));
    let faults: Vec<String> = found.collect();
    assert!(faults.is_empty(), "{faults:#?}");
}

/// Directories beside each other, and what names the one in the other: `(folder, from, to)`, with
/// the folder's path below the repository.
fn imports(sources: &[(String, String)]) -> BTreeMap<(String, String, String), String> {
    let folder = |path: &str| -> (String, Vec<String>) {
        let (root, _) = path.split_once("src/").unwrap_or(("", path));
        (format!("{root}src"), module_of(path))
    };
    let mut directories = BTreeSet::new();
    for (path, _) in sources {
        let (root, module) = folder(path);
        let depth = match path.ends_with("/mod.rs") {
            true => module.len(),
            false => module.len().saturating_sub(1),
        };
        for n in 1..=depth {
            directories.insert((root.clone(), module[..n].to_vec()));
        }
    }
    // what a module takes from its children, by the name under which others find it
    let mut taken: BTreeMap<(String, Vec<String>), Vec<String>> = BTreeMap::new();
    let mut all_used = Vec::new();
    for (path, text) in sources {
        let (root, module) = folder(path);
        let Ok(tokens) = text.parse::<TokenStream>() else {
            continue;
        };
        if module.iter().any(|m| m == "tests") {
            continue;
        }
        let (mut names, mut used) = (Vec::new(), Vec::new());
        read(tokens.clone(), &module, &mut names, &mut used);
        for (name, from) in taken_from_children(tokens) {
            let mut key = module.clone();
            key.push(name);
            let mut place = module.clone();
            place.extend(from);
            taken.insert((root.clone(), key), place);
        }
        all_used.push((path.clone(), root, module, used));
    }
    let mut found = BTreeMap::new();
    for (path, root, module, used) in all_used {
        for used in used {
            let mut to: Vec<String> = used.split("::").map(str::to_owned).collect();
            while let Some(place) = taken.get(&(root.clone(), to.clone())) {
                if *place == to {
                    break;
                }
                to = place.clone();
            }
            let common = module.iter().zip(&to).take_while(|(a, b)| a == b).count();
            let (own, other) = (module.get(..=common), to.get(..=common));
            let (Some(own), Some(other)) = (own, other) else {
                continue;
            };
            let known = |m: &[String]| directories.contains(&(root.clone(), m.to_vec()));
            if known(own) && known(other) {
                let parent = [std::slice::from_ref(&root), &own[..common]]
                    .concat()
                    .join("/");
                let key = (parent, own[common].clone(), other[common].clone());
                found.entry(key).or_insert(format!("{path}: {used}"));
            }
        }
    }
    found
}

/// The names that `use child::…` takes into a module, with their paths below it.
fn taken_from_children(tokens: TokenStream) -> Vec<(String, Vec<String>)> {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut found = Vec::new();
    for i in 0..tokens.len() {
        let is_use = matches!(&tokens[i], TokenTree::Ident(word) if word == "use");
        let first = match tokens.get(i + 1) {
            Some(TokenTree::Ident(word)) => word.to_string(),
            _ => continue,
        };
        if is_use && !["crate", "super", "self", "std"].contains(&first.as_str()) {
            let mut paths = Vec::new();
            let end = (i + 1..tokens.len()).find(|k| is_punct(tokens.get(*k), ';'));
            expand(&tokens[i + 1..end.unwrap_or(tokens.len())], &[], &mut paths);
            for path in paths {
                let path: Vec<String> = path.split("::").map(str::to_owned).collect();
                found.extend(path.last().cloned().map(|name| (name, path.clone())));
            }
        }
    }
    found
}

/// No directory imports from one beside it that imports from it, directly or by others.
#[test]
fn no_directories_import_each_other_in_a_circle() {
    let imports = imports(&all_sources());
    let mut reached: BTreeMap<(String, String), BTreeSet<String>> = BTreeMap::new();
    for (folder, from, to) in imports.keys() {
        let key = (folder.clone(), from.clone());
        reached.entry(key).or_default().insert(to.clone());
    }
    loop {
        let before = reached.clone();
        for ((folder, _), to) in &mut reached {
            let of = |to: &String| before.get(&(folder.clone(), to.clone()));
            let more: Vec<_> = to.iter().filter_map(of).flatten().cloned().collect();
            to.extend(more);
        }
        if before == reached {
            break;
        }
    }
    let circles: BTreeSet<String> = (reached.iter())
        .filter(|((_, from), to)| to.contains(from))
        .map(|((folder, from), _)| format!("{folder}/{from}"))
        .collect();
    let in_circles = |key: &(String, String, String)| {
        let (folder, from, to) = key;
        [from, to]
            .iter()
            .all(|m| circles.contains(&format!("{folder}/{m}")))
    };
    let why: Vec<_> = imports.iter().filter(|(key, _)| in_circles(key)).collect();
    assert!(circles.is_empty(), "{circles:#?} by {why:#?}");
}

/// Each library has a program that shows its use. `parallel` serves the others.
#[test]
fn a_library_has_an_example() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    sources(&root.join("crates"), &mut files);
    let paths: Vec<String> = files.iter().map(|file| below(root, file)).collect();
    let parts = |path: &String| {
        let (library, file) = path.strip_prefix("crates/")?.split_once('/')?;
        Some((library.to_owned(), file.starts_with("examples/")))
    };
    let all: BTreeSet<(String, bool)> = paths.iter().filter_map(parts).collect();
    let without = (all.iter())
        .filter(|(library, is_example)| !is_example && !all.contains(&(library.clone(), true)))
        .map(|(library, _)| library.as_str());
    assert_eq!(without.collect::<Vec<_>>(), ["parallel"]);
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

/// Paths with a line that each breaks one border.
const BROKEN: &str = r#"
src/study/mod.rs | use crate::recording::Recorded;
src/pipeline/mod.rs | use crate::verification::verify;
src/pipeline/mod.rs | use searoom_verification::verify;
src/pipeline/mod.rs | use searoom_document::PlanDocument;
src/document/plan/legs.rs | use searoom_verification::verify;
crates/scenario/src/lib.rs | use searoom_planner::space_time::plan;
crates/scenario/src/check.rs | use searoom_planner::{SearchKind, space_time};
src/report/table.rs | use super::super::simulation::Simulation;
src/pipeline.rs | use crate::report::table;
src/pipeline/mod.rs | use crate::planner::path_time::PathTimePlanner;
src/report/table.rs | use crate::recording::Recording;
src/labels.rs | use crate::{frame::Pose, evaluation::Evaluation};
src/report/table.rs | use crate::cli::output;
crates/model/src/target.rs | use rerun::RecordingStream;
src/report/table.rs | use kuva::plot::LinePlot;
crates/model/src/trajectory/mod.rs | use parry2d_f64::math::Point;
src/report/table.rs | #[derive(clap::ValueEnum)] enum A { B }
crates/scenario/src/check.rs | fn f(a: f64) -> f64 { a.to_radians() }
src/cli/plan.rs | fn f() { println!("x"); }
crates/planner/src/lib.rs | fn f() { dbg!(1); }
src/weather/mod.rs | fn f() {}
crates/geometry/src/frame.rs | fn f( {
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

/// Paths with a line that breaks no border.
const ALLOWED: &str = r#"
src/labels.rs | use crate::frame::Vector; // crate::vessel, println!, rerun
src/labels.rs | #[cfg(test)] mod tests { use crate::vessel::Hull; }
src/labels.rs | #[cfg(test)] pub(crate) mod tests;
src/labels.rs | const A: &str = "use crate::vessel";
crates/planner/src/space_time/graph/mod.rs | use super::super::{Problem, cost}; use super::route;
crates/geometry/src/parry.rs | use parry2d_f64::math::Point;
crates/scenario/src/lib.rs | use searoom_planner::SearchKind;
src/cli/output/mod.rs | fn f() { println!("x"); }
src/cli/plan.rs | use searoom::recording::record; use clap::Args;
src/recording/file.rs | use rerun::external::re_log;
src/lib.rs | pub mod cli; pub use crate::planner::Plan;
"#;

/// A circle is found through a name that a module takes from its child.
#[test]
fn circles_are_found() {
    let sources = [
        (
            "src/a/mod.rs",
            "pub mod b; pub mod c; pub use c::deep::Thing;",
        ),
        ("src/a/b/mod.rs", "use super::Thing;"),
        ("src/a/c/mod.rs", "mod deep;"),
        ("src/a/c/deep.rs", "use crate::a::b::Other;"),
    ];
    let sources = sources.map(|(path, text)| (path.to_owned(), text.to_owned()));
    let found = imports(&sources);
    let between: Vec<(&str, &str)> = (found.keys())
        .map(|(_, from, to)| (from.as_str(), to.as_str()))
        .collect();
    assert_eq!(between, [("b", "c"), ("c", "b")]);
}

/// Outside crates of a library as built for users, and the libraries of the project that it links.
fn linked(package: &str) -> (BTreeSet<String>, BTreeSet<String>) {
    let output = std::process::Command::new(env!("CARGO"))
        .args([
            "tree",
            "--locked",
            "--offline",
            "--edges",
            "normal",
            "--prefix",
            "none",
        ])
        .args(["--package", package, "--format", "{p}"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).expect("text");
    let names = text.lines().filter_map(|line| line.split(' ').next());
    let names = names.filter(|name| !name.is_empty()).map(str::to_owned);
    let (own, outside) = names.partition(|name: &String| name.starts_with("searoom"));
    (outside, own)
}

/// The evaluation and the verification of documents link no planner and none of the planners' sets,
/// and whoever takes one library takes few others.
#[test]
fn a_library_links_what_it_needs() {
    for (package, most, never) in [
        ("searoom-parallel", 0, &["searoom-geometry"][..]),
        ("searoom-geometry", 45, &["searoom-model"]),
        ("searoom-input", 60, &["searoom-model", "searoom-colregs"]),
        ("searoom-model", 45, &["searoom-sets", "searoom-colregs"]),
        ("searoom-traffic", 52, &["searoom-sets", "searoom-input"]),
        ("searoom-sets", 45, &["searoom-colregs", "searoom-planner"]),
        ("searoom-colregs", 45, &["searoom-sets", "searoom-planner"]),
        ("searoom-planner", 55, &["searoom-evaluation", "searoom"]),
        (
            "searoom-document",
            65,
            &[
                "searoom-planner",
                "searoom-sets",
                "searoom-scenario",
                "searoom-verification",
                "searoom",
            ],
        ),
        (
            "searoom-verification",
            65,
            &[
                "searoom-planner",
                "searoom-sets",
                "searoom-scenario",
                "searoom",
            ],
        ),
        (
            "searoom-scenario",
            70,
            &["searoom-evaluation", "searoom-document", "searoom"],
        ),
        (
            "searoom-evaluation",
            45,
            &[
                "searoom-planner",
                "searoom-sets",
                "searoom-colregs",
                "searoom",
            ],
        ),
    ] {
        let (outside, own) = linked(package);
        assert!(
            outside.len() <= most,
            "{package}: {} of {most}: {outside:?}",
            outside.len()
        );
        let linked: Vec<_> = never.iter().filter(|name| own.contains(**name)).collect();
        assert!(linked.is_empty(), "{package} links {linked:?}");
    }
}

#[test]
fn what_is_allowed_passes() {
    for (path, text) in rows(ALLOWED) {
        assert_eq!(faults(path, text), Vec::<String>::new());
    }
}

/// cargo drops `strip` of a profile for a package with an override there
/// (findings/cargo-strip-and-package-override.sh).
#[test]
fn the_program_is_stripped_as_its_profile_says() {
    let text = include_str!("../Cargo.toml");
    let manifest: toml::Table = text.parse().expect("a manifest");
    let release = &manifest["profile"]["release"];
    assert_eq!(release["strip"], release["package"]["searoom"]["strip"]);
}
