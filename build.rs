//! A hash of the sources, so that two builds of one version are told apart (docs/campaigns.md).

use std::path::Path;

fn main() {
    let mut hash = 0xcbf2_9ce4_8422_2325;
    for path in ["src", "Cargo.toml", "Cargo.lock"] {
        println!("cargo::rerun-if-changed={path}");
        add(Path::new(path), &mut hash);
    }
    println!("cargo::rustc-env=SEAROOM_SOURCES={hash:016x}");
}

/// FNV-1a of the names and the texts of all files below a path, in the order of names. A line end
/// counts the same on every system.
fn add(path: &Path, hash: &mut u64) {
    let mut take = |bytes: &[u8]| {
        for byte in bytes.iter().filter(|byte| **byte != b'\r') {
            *hash = (*hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    if let Ok(entries) = path.read_dir() {
        let mut entries: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
        entries.sort();
        entries.iter().for_each(|entry| add(entry, hash));
    } else if let Ok(text) = std::fs::read(path) {
        take(path.to_string_lossy().replace('\\', "/").as_bytes());
        take(&text);
    }
}
