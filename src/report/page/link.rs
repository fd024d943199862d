//! URLs of files on a page.

use std::path::Path;

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};

const PLAIN: AsciiSet = NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'_')
    .remove(b'.')
    .remove(b'~')
    .remove(b'/');

/// URL of a file in the folder of the page.
pub(super) fn address(name: &str) -> String {
    // the prefix "./" prevents a name from being parsed as a scheme
    format!("./{}", utf8_percent_encode(name, &PLAIN))
}

/// Relative URL of `file` for a page in `folder`. Both must exist. Otherwise, or without a relative
/// path, the result is the path of the file.
pub fn link_from(folder: &Path, file: &Path) -> String {
    let both = folder
        .canonicalize()
        .and_then(|a| Ok((a, file.canonicalize()?)));
    let way = both.ok().and_then(|(a, b)| pathdiff::diff_paths(b, a));
    let way = way.unwrap_or_else(|| file.to_owned());
    let way = way
        .to_string_lossy()
        .replace(std::path::MAIN_SEPARATOR, "/");
    if way.starts_with('/') {
        return utf8_percent_encode(&way, &PLAIN).to_string();
    }
    address(&way)
}
