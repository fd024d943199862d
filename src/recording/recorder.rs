//! Collects the chunks of a store, in the order in which they are logged.

use crate::recording::Logged;
use rerun::external::re_log_types::external::re_tuid::Tuid;
use rerun::log::{Chunk, ChunkId};
use rerun::{
    AsComponents, EntityPath, MediaType, SerializedComponentColumn, TextDocument, TimeColumn,
};

/// Chunks of one store. Rerun's `RecordingStream` has a thread, a clock, random names, and
/// environment variables that redirect it. This has none, so that equal runs make equal recordings.
#[derive(Debug, Default)]
pub struct Recorder {
    chunks: Vec<Chunk>,
}

impl Recorder {
    /// Logs what holds at all times.
    pub fn log_static(
        &mut self,
        entity: impl Into<EntityPath>,
        parts: &(impl AsComponents + ?Sized),
    ) -> Logged {
        let columns = parts.as_serialized_batches().into_iter();
        self.send_columns(entity, None, columns.map(SerializedComponentColumn::from))
    }

    pub fn log_markdown(&mut self, entity: &str, text: String) -> Logged {
        let text = TextDocument::new(text).with_media_type(MediaType::MARKDOWN);
        self.log_static(entity, &text)
    }

    /// Logs `style`, which holds at all times, and `columns` with a row per time.
    pub fn log_moving(
        &mut self,
        entity: impl Into<EntityPath>,
        times: TimeColumn,
        style: &(impl AsComponents + ?Sized),
        columns: impl IntoIterator<Item = SerializedComponentColumn>,
    ) -> Logged {
        let entity = entity.into();
        self.log_static(entity.clone(), style)?;
        self.send_columns(entity, Some(times), columns)
    }

    /// Logs columns with a row per time, or with the one row that holds at all times.
    pub fn send_columns(
        &mut self,
        entity: impl Into<EntityPath>,
        times: Option<TimeColumn>,
        columns: impl IntoIterator<Item = SerializedComponentColumn>,
    ) -> Logged {
        if times.as_ref().is_some_and(|times| times.num_rows() == 0) {
            return Ok(());
        }
        let times = times.map(|column| (*column.timeline().name(), column));
        let columns = columns.into_iter().map(|c| (c.descriptor, c.list_array));
        // the ids of the rows follow from that of the chunk
        let number = 1 + self.chunks.len() as u64;
        self.chunks.push(Chunk::from_auto_row_ids(
            ChunkId::from_tuid(Tuid::from_nanos_and_inc(number, 0)),
            entity.into(),
            times.into_iter().collect(),
            columns.collect(),
        )?);
        Ok(())
    }

    pub fn into_chunks(self) -> Vec<Chunk> {
        self.chunks
    }
}
