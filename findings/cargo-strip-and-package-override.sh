#!/bin/bash
# cargo drops `strip = true` of a profile for a package that has any override in that profile, as
# `[profile.release.package.NAME] opt-level = 2`: rustc is then asked to strip debug information only, and
# the program keeps its symbols. An override that repeats `strip = true` is followed.
#
# Guess of an engineer: an override changes the keys that it names, and the others stay those of the
# profile, as cargo's reference says of overrides. An override of the optimisation does not touch the
# stripping, all the more as cargo accepts `strip` in an override.
#
# Without debug information cargo strips that of the standard library by default (rust-lang/cargo pull
# request 13257); with an override this default wins over the profile's value.
#
# Exit status: 0 while this is so, 1 when it has changed, 2 when this cargo is not there.
set -u
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
version=1.95.0
cargo=(cargo)
case "$(cargo --version 2>/dev/null)" in
    "cargo $version "*) ;;
    *) rustup toolchain install "$version" --profile minimal >/dev/null 2>&1 || exit 2
       cargo=(rustup run "$version" cargo) ;;
esac
"${cargo[@]}" --version || exit 2
mkdir "$folder/src"
echo 'fn main() { println!("hello"); }' > "$folder/src/main.rs"

# asked OVERRIDE: what rustc is asked to strip from the program with this override of its package
asked() {
    {
        printf '[package]\nname = "hello"\nversion = "0.1.0"\nedition = "2024"\n[workspace]\n'
        printf '[profile.release]\nstrip = true\n'
        printf '%b' "$1"
    } > "$folder/Cargo.toml"
    rm -rf "$folder/target"
    "${cargo[@]}" build --release --offline --verbose --manifest-path "$folder/Cargo.toml" 2>&1 |
        grep -o 'strip=[a-z]*'
}
override='[profile.release.package.hello]\n'
without=$(asked '')
with=$(asked "${override}opt-level = 2\n")
again=$(asked "${override}opt-level = 2\nstrip = true\n")
echo "strip = true in the profile, no override:            $without"
echo "an override that names opt-level alone:              $with"
echo "an override that names opt-level and strip = true:   $again"
[ "$without $with $again" = "strip=symbols strip=debuginfo strip=symbols" ]
