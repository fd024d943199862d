//! Every reader keeps its promise for each file of the kept corpus of the fuzz targets, and for
//! random changes of them.

use std::collections::BTreeSet;
use std::fs;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};

use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

#[path = "../../fuzz/readers.rs"]
mod readers;

/// Changed files per reader.
const CHANGED: u64 = 300;

/// Longest kept file and all of them, bytes: a fuzzer changes small files faster.
const FILE_BYTES: usize = 12_000;
const CORPUS_BYTES: usize = 200_000;

/// Values that replace a number: ends of what a format, a type or a reader allows, and other types.
const EXTREMES: &str = "0 -0.0 5e-324 -1 1e-9 0.001 1 2 90 -90 90.0000001 180 -180 180.0000001 \
                        360 1e4 1e7 -1e7 1e15 1e308 -1e308 1e400 9223372036854775808 nan inf null \
                        true \"\" \"a\" [] {}";

fn folder(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fuzz")
        .join(path)
}

/// The kept files of a target, in the order of their names. What a fuzzer adds has no ending.
fn kept(target: &str) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder("corpus").join(target)).expect("a folder");
    let files = entries.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> = files.filter(|file| file.extension().is_some()).collect();
    files.sort();
    let name = |file: &Path| file.file_name().unwrap_or_default().display().to_string();
    let read = |file: PathBuf| (name(&file), fs::read(file).expect("a file"));
    files.into_iter().map(read).collect()
}

/// Replays the kept files of a reader, then changed ones. A file at which the reader fails is
/// written, so that it can be kept.
fn replay(target: &str) {
    let files = kept(target);
    let try_one = |name: &str, bytes: &[u8]| {
        if catch_unwind(|| readers::read(target, bytes)).is_err() {
            let failed = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{target}-{name}"));
            fs::write(&failed, bytes).expect("written");
            panic!("{target} fails, see above: {}", failed.display());
        }
    };
    for (name, bytes) in &files {
        try_one(name, bytes);
    }
    for seed in 0..CHANGED {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let (name, bytes) = files.choose(&mut rng).expect("a kept file");
        let (_, other) = files.choose(&mut rng).expect("a kept file");
        let bytes = changed(&mut rng, bytes.clone(), other);
        try_one(&format!("{seed}-{name}"), &bytes);
    }
}

/// A file with one to three changes; some of them take a part of another file.
fn changed(rng: &mut ChaCha8Rng, mut bytes: Vec<u8>, other: &[u8]) -> Vec<u8> {
    for _ in 0..rng.random_range(1..=3) {
        match rng.random_range(0..9) {
            0..4 => replace_number(rng, &mut bytes),
            4 => bytes.truncate(rng.random_range(0..=bytes.len())),
            5 if !bytes.is_empty() => {
                let at = rng.random_range(0..bytes.len());
                bytes[at] ^= 1 << rng.random_range(0..8);
            }
            6 => {
                let part = span(rng, &bytes);
                bytes.drain(part);
            }
            7 => {
                let part = bytes[span(rng, &bytes)].to_vec();
                let at = rng.random_range(0..=bytes.len());
                bytes.splice(at..at, part);
            }
            _ => {
                let into = span(rng, &bytes);
                let part = other[span(rng, other)].to_vec();
                bytes.splice(into, part);
            }
        }
    }
    bytes
}

/// A part of at most 100 bytes.
fn span(rng: &mut ChaCha8Rng, bytes: &[u8]) -> std::ops::Range<usize> {
    let from = rng.random_range(0..=bytes.len());
    from..rng.random_range(from..=bytes.len().min(from + 100))
}

fn replace_number(rng: &mut ChaCha8Rng, bytes: &mut Vec<u8>) {
    let of_number = |byte: &u8| byte.is_ascii_digit() || b".-+eE".contains(byte);
    let begins =
        |at: &usize| bytes[*at].is_ascii_digit() && !bytes[..*at].last().is_some_and(of_number);
    let starts: Vec<usize> = (0..bytes.len()).filter(begins).collect();
    let extremes: Vec<&str> = EXTREMES.split_whitespace().collect();
    if let (Some(&start), Some(extreme)) = (starts.choose(rng), extremes.choose(rng)) {
        let length = bytes[start..]
            .iter()
            .take_while(|byte| of_number(byte))
            .count();
        bytes.splice(start..start + length, extreme.bytes());
    }
}

#[test]
fn commonocean_files_are_read_or_refused() {
    replay("commonocean");
}

#[test]
fn dnv_files_are_read_or_refused() {
    replay("dnv");
}

#[test]
fn maps_are_read_or_refused() {
    replay("map");
}

#[test]
fn plan_documents_are_verified_or_refused() {
    replay("plan");
}

#[test]
fn routes_are_read_or_refused() {
    replay("route");
}

#[test]
fn traffic_is_read_or_counted() {
    replay("traffic");
}

#[test]
fn scenario_files_are_read_or_refused() {
    replay("scenario");
}

#[test]
#[cfg(feature = "recording")]
fn recordings_are_read_or_refused() {
    use searoom::document::PlanDocument;

    replay("recording");
    // a whole recording is too large to be kept
    let scenario = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/colregs/head-on.toml");
    let run = searoom::pipeline::run(searoom::scenario::Scenario::read(&scenario).expect("good"));
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("head-on.rrd");
    searoom::recording::write(&run, &PlanDocument::of(&run), &file).expect("written");
    let whole = fs::read(&file).expect("a recording");
    readers::read("recording", &whole);
    for seed in 0..CHANGED {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let bytes = changed(&mut rng, whole.clone(), &whole);
        readers::read("recording", &bytes);
    }
}

#[test]
fn every_reader_has_a_target_and_small_kept_files() {
    let manifest = fs::read_to_string(folder("Cargo.toml")).expect("a manifest");
    let mut bytes = 0;
    let mut targets = BTreeSet::new();
    for entry in fs::read_dir(folder("fuzz_targets")).expect("a folder") {
        let file = entry.expect("an entry").path();
        let target = file.file_stem().expect("a name").display().to_string();
        assert!(
            manifest.contains(&format!("path = \"fuzz_targets/{target}.rs\"")),
            "{target}"
        );
        let source = fs::read_to_string(&file).expect("a target");
        assert!(
            source.contains(&format!("readers::read(\"{target}\", bytes)")),
            "{target}"
        );
        let files = kept(&target);
        assert!(!files.is_empty(), "{target}");
        for (name, file) in files {
            assert!(file.len() <= FILE_BYTES, "{target}/{name}");
            bytes += file.len();
        }
        targets.insert(target);
    }
    assert!(bytes <= CORPUS_BYTES, "{bytes}");
    let readers = readers::READERS.iter().map(|(name, _)| (*name).to_owned());
    let mut readers: BTreeSet<String> = readers.collect();
    // a build without recordings has no reader for them
    readers.insert("recording".to_owned());
    assert_eq!(targets, readers);
}
