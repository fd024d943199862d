//! What each reader promises for any bytes, as one function per reader. The fuzz targets and the
//! test of the kept corpus (`tests/formats/corpus.rs`) call the same functions.
//!
//! A reader returns its result or a list of faults and never panics. Each fault has a text on one
//! line. What was read can be used: a scenario can be planned and its plan document is valid, an
//! imported file reads again as the same scenario, and a document that was verified stays verified
//! when it is written again.

use std::path::Path;

use searoom::document::PlanDocument;
use searoom::frame::{Geographic, Georeference};
use searoom::input::{Fault, InputError, read_from};
use searoom::map::Map;
use searoom::pipeline;
use searoom::report::printable;
use searoom::scenario::Scenario;
use searoom::scenario::import::{Assumed, Contents};
use searoom::verification::{is_simulation, verify, verify_simulations};
use searoom_traffic::{Report, Settings};

/// Gives bytes to one reader, and panics if it breaks its promise.
pub type Reader = fn(&[u8]);

/// Each reader by the name of its fuzz target.
pub const READERS: &[(&str, Reader)] = &[
    ("commonocean", imported),
    ("dnv", imported),
    ("map", map),
    ("plan", plan),
    #[cfg(feature = "recording")]
    ("recording", recording),
    ("route", route),
    ("scenario", scenario),
    ("traffic", traffic),
];

/// Gives the bytes to a reader, and panics if it breaks its promise.
pub fn read(name: &str, bytes: &[u8]) {
    let reader = READERS.iter().find(|(other, _)| *other == name);
    let (_, reader) = reader.unwrap_or_else(|| panic!("no reader is called {name}"));
    reader(bytes);
}

/// Mebibytes of a file; the readers allow more, which takes a fuzzer longer and shows nothing else.
const MEBIBYTES: u64 = 1;

/// Seconds that a plan may take.
const BUDGET_S: f64 = 1e-3;

/// Targets of a scenario that is planned. The sets of a target are made whatever the budget is.
const PLANNED_TARGETS: usize = 3;

fn scenario(bytes: &[u8]) {
    if let Some(text) = text(bytes) {
        planned_if_small(Scenario::parse(&text));
    }
}

/// A route is read by a scenario that names its file.
fn route(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("fuzz.rtz"), bytes).expect("written");
    planned_if_small(Scenario::parse_beside(ROUTE_SCENARIO, folder.path()));
}

const ROUTE_SCENARIO: &str = r#"
title = "A route"
horizon_s = 20000.0
origin = { lat_deg = 60.0, lon_deg = 10.0 }

[own_ship]
position = { lat_deg = 60.0, lon_deg = 10.0 }
course_deg = 0.0
speed_mps = 5.0
length_m = 80.0
beam_m = 14.0
turning_radius_m = 240.0

[mission]
route = "fuzz.rtz"
"#;

fn planned_if_small(read: Result<Scenario, Vec<Fault>>) {
    match read {
        Ok(scenario) if scenario.targets.len() <= PLANNED_TARGETS => planned(scenario),
        Ok(_) => {}
        Err(faults) => are_told(&faults),
    }
}

fn planned(mut scenario: Scenario) {
    let unfit = scenario.unfit();
    if !unfit.is_empty() {
        return are_told(&unfit);
    }
    scenario.deadline = BUDGET_S;
    let document = PlanDocument::of(&pipeline::run(scenario));
    let claimed = document.verified;
    let text = serde_json::to_string(&document).expect("JSON");
    let checked = verify(&text).unwrap_or_else(|error| panic!("the plan document: {error}"));
    assert!(checked.verified() || !claimed, "{:?}", checked.violations);
}

/// Traffic situations of DNV, cases of Imazu and scenarios of CommonOcean: the content decides.
fn imported(bytes: &[u8]) {
    let Some(text) = text(bytes) else {
        return;
    };
    let assumed = Assumed::default();
    let situations = match Contents::parse(&text, &assumed) {
        Ok(Contents::Situations(situations)) => situations,
        Ok(Contents::Scenario | Contents::Other(_)) => return,
        Err(faults) => return are_told(&faults),
    };
    assert!(!situations.is_empty());
    for situation in situations {
        match situation.and_then(|situation| situation.scenario(&assumed)) {
            Ok(imported) => {
                let again = Scenario::parse(&imported.text);
                assert_eq!(again.as_ref(), Ok(&imported.scenario));
                planned_if_small(again);
            }
            Err(faults) => are_told(&faults),
        }
    }
}

/// A map, with and without a radius of points and lines.
fn map(bytes: &[u8]) {
    let Some(text) = text(bytes) else {
        return;
    };
    let earth = Georeference::new(Geographic::new(60.0, 10.0)).expect("a place on the earth");
    for point_radius in [None, Some(10.0)] {
        match Map::parse(&text, &earth, point_radius) {
            Ok(map) => {
                assert!(!map.pieces().is_empty());
                for piece in map.pieces() {
                    let corners = piece.vertices();
                    assert!(
                        corners
                            .iter()
                            .all(|corner| map.signed_distance(*corner) < 1e-3)
                    );
                }
            }
            Err(faults) => are_told(&faults),
        }
    }
}

/// A plan document, or the document of a simulation, as `searoom verify` reads both.
fn plan(bytes: &[u8]) {
    let Some(text) = text(bytes) else {
        return;
    };
    if is_simulation(&text) {
        match verify_simulations(&text) {
            Ok(all) => {
                let violations = all.iter().flat_map(|checked| &checked.violations);
                violations.for_each(|violation| is_told(&violation.what));
            }
            Err(error) => is_told(&error.to_string()),
        }
        return;
    }
    match verify(&text) {
        Ok(checked) => {
            let violations = checked.violations.iter();
            violations.for_each(|violation| is_told(&violation.what));
            let document: PlanDocument = serde_json::from_str(&text).expect("a plan document");
            let again = serde_json::to_string(&document).expect("JSON");
            let again = verify(&again).expect("a document that is written again");
            assert_eq!(again.verified(), checked.verified());
        }
        Err(error) => is_told(&error.to_string()),
    }
}

/// A recording, as `searoom inspect` reads it. Nothing of a file with a wrong checksum is decoded.
#[cfg(feature = "recording")]
fn recording(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("fuzz.rrd");
    std::fs::write(&file, bytes).expect("written");
    match searoom::recording::Recorded::read_all(&file) {
        Ok(all) => {
            assert!(!all.is_empty());
            for recorded in all {
                for entity in recorded.entities() {
                    assert!(recorded.table(&entity.path).is_some());
                }
                if let Some(document) = recorded.document() {
                    plan(document.as_bytes());
                }
            }
        }
        Err(error) => is_told(&error.to_string()),
    }
}

/// Sentences, rows or documents of traffic: sound sets, printable names, every line counted, and the same
/// reports when the stream comes in pieces. Bytes that are cut off from a line that is too long may be read
/// differently.
fn traffic(bytes: &[u8]) {
    let read = |piece: usize| {
        let mut reader = searoom_traffic::Reader::new(Settings::default());
        let mut reports = Vec::new();
        for bytes in bytes.chunks(piece) {
            reader.bytes(bytes, 1.7e9, |report| reports.push(report));
        }
        reader.finish(1.7e9, |report| reports.push(report));
        if let Some(missing) = reader.missing_column() {
            is_told(&missing.to_string());
        }
        assert_eq!(reader.counts().reports, reports.len() as u64);
        (reports, reader.counts().clone())
    };
    let whole = read(bytes.len().max(1));
    whole.0.iter().for_each(is_sound);
    if bytes
        .split(|byte| *byte == b'\n')
        .all(|line| line.len() <= 512)
    {
        assert_eq!(whole, read(7));
    }
}

fn is_sound(report: &Report) {
    for name in [report.name, report.call_sign].into_iter().flatten() {
        is_told(name.as_str());
    }
    if let Some(fix) = report.fix {
        let speed = fix.velocity.speed;
        assert!(
            0.0 <= speed.least && speed.least <= speed.most,
            "{report:?}"
        );
        assert!(fix.time.least <= fix.time.most, "{report:?}");
        assert!(
            fix.position
                .is_none_or(|set| set.at.is_on_earth() && set.radius_m >= 0.0)
        );
        assert!(!fix.velocity.outer(13.0).vertices().is_empty());
    }
    if let Some(hull) = report.hull {
        assert!(
            hull.reach() >= 0.0 && hull.reach().is_finite(),
            "{report:?}"
        );
    }
}

/// The text of a file with these bytes.
fn text(bytes: &[u8]) -> Option<String> {
    match read_from(bytes, Path::new("fuzz"), MEBIBYTES, "a file") {
        Ok(text) => Some(text),
        Err(InputError::Faults { faults, .. }) => {
            are_told(&faults);
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// Each of the faults, at least one, says what was found and what is allowed.
fn are_told(faults: &[Fault]) {
    assert!(!faults.is_empty());
    for fault in faults {
        is_told(&fault.found);
        is_told(&fault.allowed);
        is_told(&fault.to_string());
    }
}

/// A message has a text, and is one line when it is printed.
fn is_told(message: &str) {
    assert!(!message.trim().is_empty(), "a message without a text");
    assert_eq!(printable(message).lines().count(), 1, "{message:?}");
    assert!(!message.contains('\n'), "{message:?}");
}
