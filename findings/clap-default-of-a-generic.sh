#!/bin/bash
# clap's derive takes the first default of a generic struct of arguments for all of its types: where
# `default_value_t` is a constant of the type, as of `Scenes<10>` and `Scenes<20>`, whichever is built first
# decides for both, also in the help text.
#
# Guess of an engineer: the derived code is generic as the struct is, so each type has the default that its
# constant says. But the text of a default is kept in a `static` inside of the derived function, and Rust has
# one static for all types of a generic function (clap-rs/clap issue 5127).
#
# Exit status: 0 while this is so, 1 when it has changed, 2 when the package cannot be built.
set -u
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cat > "$folder/Cargo.toml" <<'TOML'
[package]
name = "defaults"
version = "0.1.0"
edition = "2024"
[dependencies]
clap = { version = "=4.6.7", features = ["derive"] }
[workspace]
TOML
cat > "$folder/src/main.rs" <<'RUST'
use clap::{Args, Parser};

#[derive(Args)]
struct Scenes<const COUNT: u64> {
    #[arg(long, default_value_t = COUNT)]
    count: u64,
}

#[derive(Parser)]
enum Command {
    Ten(Scenes<10>),
    Twenty(Scenes<20>),
}

fn main() {
    let count = match Command::parse() {
        Command::Ten(scenes) => scenes.count,
        Command::Twenty(scenes) => scenes.count,
    };
    println!("{count}");
}
RUST
cargo build --quiet --manifest-path "$folder/Cargo.toml" --target-dir "$folder/target" || exit 2
program="$folder/target/debug/defaults"
ten=$("$program" ten)
twenty=$("$program" twenty)
help=$("$program" twenty --help | grep -o 'default: [0-9]*')
echo "clap 4.6.7, defaults of 10 and 20: $ten and $twenty; help of the second: $help"
[ "$ten $twenty $help" = "10 10 default: 10" ]
