//! The plan document in a recording: all of it but the time that planning took, which lies in a store of its own, so that
//! recordings of one scenario compare equal.

use rerun::external::re_log_types::LogMsg;
use rerun::{
    MediaType, RecordingStream, RecordingStreamBuilder, RecordingStreamResult, TextDocument,
};

use super::{APPLICATION, DOCUMENT, TIMING};

/// What stands before the time in the text of a document.
const KEY: &str = "\"plan_s\": ";

/// What stands in its place in the recording.
const NOTHING: &str = "null";

/// The text without its time, and the time as it stands there.
struct Parted {
    text: String,
    time: String,
}

impl Parted {
    fn of(text: &str) -> Self {
        // the last one: a title may say anything
        let Some(at) = text.rfind(KEY).map(|at| at + KEY.len()) else {
            return Self {
                text: text.to_owned(),
                time: String::new(),
            };
        };
        let is_end = |c: char| c.is_whitespace() || c == ',' || c == '}';
        let end = text[at..].find(is_end).map_or(text.len(), |n| at + n);
        Self {
            text: format!("{}{NOTHING}{}", &text[..at], &text[end..]),
            time: text[at..end].to_owned(),
        }
    }
}

/// Puts the time back; a document whose time is lost keeps null.
pub(super) fn joined(text: &str, time: Option<&str>) -> String {
    let key = format!("{KEY}{NOTHING}");
    match (text.rfind(&key), time) {
        (Some(at), Some(time)) => {
            let rest = &text[at + key.len()..];
            format!("{}{KEY}{time}{rest}", &text[..at])
        }
        _ => text.to_owned(),
    }
}

/// Logs the document after everything else, so that a recording that was cut short is without it.
pub(super) fn log_document(rec: &RecordingStream, document: &str) -> RecordingStreamResult<()> {
    // what is logged before is then in messages before
    let _ = rec.flush_blocking();
    let json = MediaType("application/json".into());
    let text = Parted::of(document).text;
    rec.log_static(DOCUMENT, &TextDocument::new(text).with_media_type(json))
}

/// The time in a store of the kind that is not compared, nor shown unless it is made active.
pub(super) fn timing(document: &str) -> RecordingStreamResult<Vec<LogMsg>> {
    let (rec, store) = RecordingStreamBuilder::new(APPLICATION)
        .enabled(true)
        .blueprint()
        .memory()?;
    rec.set_log_time_enabled(false);
    rec.set_log_tick_enabled(false);
    rec.log_static(TIMING, &TextDocument::new(Parted::of(document).time))?;
    Ok(store.take())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_comes_back_as_it_was() {
        for text in [
            "{\n  \"scenario\": \"\\\"plan_s\\\": 3\",\n  \"timing\": {\n    \"plan_s\": 0.0025\n  }\n}\n",
            "{\"timing\":{\"plan_s\": 1e-5},\"more\":[]}",
            "{}",
        ] {
            let parted = Parted::of(text);
            assert!(!parted.text.contains("0.0025") && !parted.text.contains("1e-5"));
            assert_eq!(joined(&parted.text, Some(&parted.time)), text);
        }
        assert_eq!(joined("{\"plan_s\": null}", None), "{\"plan_s\": null}");
    }
}
