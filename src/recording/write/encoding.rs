//! Encodes a recording and its layout as the bytes of one file.

use rerun::external::re_log_encoding::Encoder;
use rerun::external::re_log_types::{BlueprintActivationCommand, LogMsg, StoreId, StoreKind};
use rerun::log::{Chunk, ChunkResult};

use super::Failure;
use crate::recording::APPLICATION;
use crate::recording::checksum::{checksum, opening, seal, unsealed};
use crate::recording::recorder::Recorder;

/// Encodes both stores with Rerun's encoder and writes the checksum. O(bytes).
pub fn encode(recording: Recorder, layout: Recorder) -> Result<Vec<u8>, Failure> {
    let (recording, layout) = (recording.into_chunks(), layout.into_chunks());
    // viewers merge recordings of one name, so the name depends on the contents
    let draft_id = StoreId::new(StoreKind::Recording, APPLICATION, "draft");
    let mut draft = Encoder::local()?;
    // the footer has no fixed order
    draft.do_not_emit_footer();
    draft.extend(messages(&draft_id, &recording))?;
    let name = format!("{:016x}", checksum(&[&draft.into_inner()?]));
    let layout_id = StoreId::new(StoreKind::Blueprint, APPLICATION, format!("layout_{name}"));
    let recording_id = StoreId::new(StoreKind::Recording, APPLICATION, name);

    let activation = BlueprintActivationCommand {
        blueprint_id: layout_id.clone(),
        make_active: true,
        make_default: true,
    };
    let all = std::iter::once(Ok(unsealed(recording_id.clone())))
        .chain(messages(&layout_id, &layout))
        .chain([Ok(activation.into())])
        .chain(data(&recording_id, &recording));
    let mut bytes = Encoder::encode(all)?;
    seal(&mut bytes);
    Ok(bytes)
}

fn messages(store: &StoreId, chunks: &[Chunk]) -> impl Iterator<Item = ChunkResult<LogMsg>> {
    std::iter::once(Ok(opening(store.clone()))).chain(data(store, chunks))
}

fn data(store: &StoreId, chunks: &[Chunk]) -> impl Iterator<Item = ChunkResult<LogMsg>> {
    let message = |chunk: &Chunk| Ok(LogMsg::ArrowMsg(store.clone(), chunk.to_arrow_msg()?));
    chunks.iter().map(message)
}
