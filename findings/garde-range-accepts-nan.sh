#!/bin/bash
# garde's rule `range` on a floating-point field takes a number that is not one (NaN) as within the range.
#
# Guess of an engineer: a field with `range(min = 0.001, max = 100)` holds a number from 0.001 to 100 once it
# is validated. But the rule asks whether the number is below the least or above the greatest one, and a NaN is
# neither. `toml` reads `nan` as such a number, so a file can say it.
#
# Exit status: 0 while this is so, 1 when it has changed, 2 when the package cannot be built.
set -u
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cat > "$folder/Cargo.toml" <<'TOML'
[package]
name = "range"
version = "0.1.0"
edition = "2024"
[dependencies]
garde = { version = "=0.22.1", features = ["derive"] }
[workspace]
TOML
cat > "$folder/src/main.rs" <<'RUST'
use garde::Validate;

#[derive(Validate)]
struct Ship {
    #[garde(range(min = 0.001, max = 100.0))]
    speed_mps: f64,
}

fn main() {
    for speed_mps in [5.0, 0.0, 101.0, f64::INFINITY, f64::NAN] {
        let found = Ship { speed_mps }.validate();
        print!("{speed_mps} {}; ", if found.is_ok() { "valid" } else { "refused" });
    }
}
RUST
cargo build --quiet --manifest-path "$folder/Cargo.toml" --target-dir "$folder/target" || exit 2
found=$("$folder/target/debug/range")
echo "garde 0.22.1, 0.001 to 100: $found"
[ "$found" = "5 valid; 0 refused; 101 refused; inf refused; NaN valid; " ]
