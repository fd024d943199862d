//! The plan or comparison document in a recording: all of it but the time that planning took, which lies in a store of its own, so that
//! recordings of one scenario compare equal.

use rerun::external::re_log_types::LogMsg;
use rerun::{
    MediaType, RecordingStream, RecordingStreamBuilder, RecordingStreamResult, TextDocument,
};

use super::{APPLICATION, TIMING};

/// What stands before the time in the text of a document.
const KEY: &str = "\"plan_s\": ";

/// What stands in its place in the recording.
const NOTHING: &str = "null";

/// The text without its times, and the times as they stand there, a line each.
struct Parted {
    text: String,
    times: String,
}

impl Parted {
    /// The key is found as a key alone: within a text its quotes are escaped.
    fn of(document: &str) -> Self {
        let mut parts = document.split(KEY);
        let mut text = parts.next().unwrap_or_default().to_owned();
        let mut times = Vec::new();
        for part in parts {
            let is_end = |c: char| c.is_whitespace() || c == ',' || c == '}';
            let end = part.find(is_end).unwrap_or(part.len());
            times.push(&part[..end]);
            text.extend([KEY, NOTHING, &part[end..]]);
        }
        Self {
            text,
            times: times.join("\n"),
        }
    }
}

/// Puts the times back; where a time is lost there stays null.
pub(super) fn joined(text: &str, times: Option<&str>) -> String {
    let mut times = times.unwrap_or_default().lines();
    let key = format!("{KEY}{NOTHING}");
    let mut parts = text.split(&key);
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        whole.extend([KEY, times.next().unwrap_or(NOTHING), part]);
    }
    whole
}

/// Logs the document after everything else, so that a recording that was cut short is without it.
pub(super) fn log_document(
    rec: &RecordingStream,
    entity: &str,
    document: &str,
) -> RecordingStreamResult<()> {
    // what is logged before is then in messages before
    let _ = rec.flush_blocking();
    let json = MediaType("application/json".into());
    let text = Parted::of(document).text;
    rec.log_static(entity, &TextDocument::new(text).with_media_type(json))
}

/// The time in a store of the kind that is not compared, nor shown unless it is made active.
pub(super) fn timing(document: &str) -> RecordingStreamResult<Vec<LogMsg>> {
    let (rec, store) = RecordingStreamBuilder::new(APPLICATION)
        .enabled(true)
        .blueprint()
        .memory()?;
    rec.set_log_time_enabled(false);
    rec.set_log_tick_enabled(false);
    rec.log_static(TIMING, &TextDocument::new(Parted::of(document).times))?;
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
            "[{\"plan_s\": 1e-5},{\"plan_s\": null},{\"plan_s\": 0.0025}]",
            "{}",
        ] {
            let parted = Parted::of(text);
            assert!(!parted.text.contains("0.0025") && !parted.text.contains("1e-5"));
            assert_eq!(joined(&parted.text, Some(&parted.times)), text);
        }
        assert_eq!(joined("{\"plan_s\": null}", None), "{\"plan_s\": null}");
    }
}
