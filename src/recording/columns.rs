//! What moves, together with its look, as one chunk: a chunk costs more than most of what is in it.

use std::sync::Arc;

use rerun::external::arrow::array::ListArray;
use rerun::external::arrow::buffer::{NullBuffer, OffsetBuffer};
use rerun::external::arrow::datatypes::Field;
use rerun::{
    AsComponents, EntityPath, RecordingStreamResult, SerializedComponentBatch,
    SerializedComponentColumn, TimeColumn,
};

use super::recorder::Recorder;

/// Sends `columns` with a row per time, and `look` in the first of these rows: it holds from then on.
pub fn log_columns(
    rec: &mut Recorder,
    entity: EntityPath,
    times: TimeColumn,
    look: &dyn AsComponents,
    columns: impl IntoIterator<Item = SerializedComponentColumn>,
) -> RecordingStreamResult<()> {
    let rows = times.num_rows();
    if rows == 0 {
        return rec.log_static(entity, look);
    }
    let once = look.as_serialized_batches().into_iter().map(|batch| {
        let mut lengths = vec![None; rows];
        lengths[0] = Some(batch.array.len());
        sparse(batch, &lengths)
    });
    rec.send_columns(entity, Some(times), once.chain(columns))
}

/// A column whose rows take so many of the batch's instances each; where there is `None` the row before goes on to hold.
/// The lengths sum to the batch's.
pub fn sparse(
    batch: SerializedComponentBatch,
    lengths: &[Option<usize>],
) -> SerializedComponentColumn {
    let offsets = OffsetBuffer::from_lengths(lengths.iter().map(|n| n.unwrap_or(0)));
    let holds: NullBuffer = lengths.iter().map(Option::is_some).collect();
    let item = Field::new("item", batch.array.data_type().clone(), true);
    let rows = ListArray::new(Arc::new(item), offsets, batch.array, Some(holds));
    SerializedComponentColumn::new(rows, batch.descriptor)
}

#[cfg(test)]
mod tests {
    use rerun::Points2D;
    use rerun::external::arrow::array::Array;

    use super::*;

    #[test]
    fn what_holds_on_is_not_repeated() {
        let points = Points2D::update_fields().with_positions([[0.0f32, 1.0], [2.0, 3.0]]);
        let batch = points.as_serialized_batches().remove(0);
        let column = sparse(batch, &[None, Some(2), None]);
        let valid: Vec<bool> = (0..3).map(|row| column.list_array.is_valid(row)).collect();
        assert_eq!(valid, [false, true, false]);
        assert_eq!(column.list_array.value(1).len(), 2);
    }
}
