//! The text of a file, of which no more is read than is allowed.

use std::fs::File;
use std::io::{Error, ErrorKind, Read};
use std::path::Path;

use super::{Fault, ScenarioError};

/// Bytes of a mebibyte.
const MEBIBYTE: u64 = 1024 * 1024;

/// The text of a regular file of at most `most` bytes; a larger one is refused without reading it whole.
pub(super) fn text_of(file: &Path, most: u64) -> Result<String, ScenarioError> {
    let unread = |source| ScenarioError::Read {
        file: file.to_owned(),
        source,
    };
    let whole = |found: String, allowed: String| ScenarioError::Faults {
        file: file.to_owned(),
        faults: vec![Fault {
            path: String::new(),
            found,
            allowed,
            line: None,
        }],
    };
    // a pipe would be waited for, a device read for ever
    let about = std::fs::metadata(file).map_err(unread)?;
    if !about.is_file() {
        return Err(unread(Error::new(
            ErrorKind::InvalidInput,
            "not a regular file",
        )));
    }
    let large = || {
        let limit = most / MEBIBYTE;
        whole(
            format!("more than {limit} MiB"),
            format!("a scenario file of at most {limit} MiB"),
        )
    };
    if about.len() > most {
        return Err(large());
    }
    let handle = File::open(file).map_err(unread)?;
    let mut bytes = Vec::new();
    // it may have grown
    handle
        .take(most + 1)
        .read_to_end(&mut bytes)
        .map_err(unread)?;
    if bytes.len() as u64 > most {
        return Err(large());
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        whole(
            format!("bytes that are no text at byte {at}"),
            "UTF-8 text".to_owned(),
        )
    })
}
