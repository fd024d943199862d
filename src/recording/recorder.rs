//! What a store of a recording holds, in the order in which it is logged.

use rerun::external::re_log_types::external::re_tuid::Tuid;
use rerun::log::{Chunk, ChunkId};
use rerun::{
    AsComponents, EntityPath, RecordingStreamResult, SerializedComponentColumn, TimeColumn,
};

/// Chunks of one store. Unlike the stream of the library it has no thread, no clock and no random number: what is logged alike has the
/// same bytes.
#[derive(Debug)]
pub struct Recorder {
    /// Before the number of the chunk in ids: sections of a store are logged side by side.
    section: u64,
    chunks: Vec<Chunk>,
}

impl Recorder {
    /// One of the sections of a store, numbered in their order.
    pub fn of_section(section: usize) -> Self {
        Self {
            section: section as u64 + 1,
            chunks: Vec::new(),
        }
    }

    /// Logs what holds at all times.
    pub fn log_static(
        &mut self,
        entity: impl Into<EntityPath>,
        parts: &(impl AsComponents + ?Sized),
    ) -> RecordingStreamResult<()> {
        let columns = parts.as_serialized_batches().into_iter();
        self.send_columns(entity, None, columns.map(SerializedComponentColumn::from))
    }

    /// Logs columns with a row per time, or with the one that holds at all times.
    pub fn send_columns(
        &mut self,
        entity: impl Into<EntityPath>,
        times: Option<TimeColumn>,
        columns: impl IntoIterator<Item = SerializedComponentColumn>,
    ) -> RecordingStreamResult<()> {
        let times = times.map(|column| (*column.timeline().name(), column));
        let columns = columns.into_iter().map(|c| (c.descriptor, c.list_array));
        // rows are numbered on from the chunk
        let number = (self.section << 32) + self.chunks.len() as u64;
        self.chunks.push(Chunk::from_auto_row_ids(
            ChunkId::from_tuid(Tuid::from_nanos_and_inc(number, 0)),
            entity.into(),
            times.into_iter().collect(),
            columns.collect(),
        )?);
        Ok(())
    }

    /// Adds what a later section holds.
    pub fn append(&mut self, later: Self) {
        self.chunks.extend(later.chunks);
    }

    /// Everything, in its order.
    pub fn into_chunks(self) -> Vec<Chunk> {
        self.chunks
    }
}
