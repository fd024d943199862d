//! Build script: a hash of the sources, so that two builds of one version are told apart
//! (docs/guide/campaigns.md).

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

fn main() {
    let mut hasher = DefaultHasher::new();
    for path in ["src", "crates", "Cargo.toml", "Cargo.lock"] {
        println!("cargo::rerun-if-changed={path}");
        add(Path::new(path), &mut hasher);
    }
    println!("cargo::rustc-env=SEAROOM_SOURCES={:016x}", hasher.finish());
}

/// Adds the names and the contents of all files below a path, in the order of names.
fn add(path: &Path, hasher: &mut DefaultHasher) {
    if let Ok(entries) = path.read_dir() {
        let mut entries: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
        entries.sort();
        entries.iter().for_each(|entry| add(entry, hasher));
    } else if let Ok(content) = std::fs::read(path) {
        (path, content).hash(hasher);
    }
}
