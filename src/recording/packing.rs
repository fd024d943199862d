//! Stores → the bytes of a file, packed closer than the library does: with many small messages that is a tenth of it.
//! Any reader of recordings reads them.

use lz4::block::{CompressionMode, compress};
use rayon::prelude::*;
use re_protos::common::v1alpha1::Compression;
use re_protos::log_msg::v1alpha1::{ArrowMsg, log_msg::Msg};
use rerun::external::re_log_encoding::{self, Encodable, Encoder, ToTransport};
use rerun::external::re_log_types::external::re_tuid::Tuid;
use rerun::external::re_log_types::{
    BlueprintActivationCommand, LogMsg, SetStoreInfo, StoreId, StoreInfo, StoreKind, StoreSource,
};
use rerun::log::Chunk;

use super::APPLICATION;
use super::digest::Digest;
use super::recorder::Recorder;

/// Of LZ4's twelve: those behind it gain a hundredth for four times the time.
const LEVEL: CompressionMode = CompressionMode::HIGHCOMPRESSION(7);

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// The stores of a file.
#[derive(Debug)]
pub struct Stores {
    /// What is shown.
    pub recording: Recorder,
    /// How it is laid out.
    pub layout: Recorder,
    /// What is neither shown nor compared.
    pub aside: Option<Recorder>,
}

/// The file. It has no footer: that is an index into files too large to be read whole, and would be 40 % of ours. Messages are packed side by
/// side. The recording is named after its contents, so that the viewer takes two that differ for two.
pub fn packed(stores: Stores) -> Result<Vec<u8>, Failure> {
    let recording = stores.recording.into_chunks();
    let others =
        [Some(stores.layout), stores.aside].map(|s| s.map_or_else(Vec::new, Recorder::into_chunks));
    let shown = recording.len();
    let laid_out = others[0].len();
    let chunks = recording.into_iter().chain(others.into_iter().flatten());
    let parts: Result<Vec<ArrowMsg>, Failure> = chunks
        .collect::<Vec<Chunk>>()
        .into_par_iter()
        .map(part)
        .collect();
    let mut parts = parts?;
    let mut aside = parts.split_off(shown);
    let layout: Vec<ArrowMsg> = aside.drain(..laid_out).collect();

    let digest = Digest::of(parts.iter().map(|part| &part.payload[..]));
    let recording_id = StoreId::new(StoreKind::Recording, APPLICATION, digest.recording());
    let beside = |what| StoreId::new(StoreKind::Blueprint, APPLICATION, digest.store(what));
    let (layout_id, aside_id) = (beside("layout"), beside("aside"));
    // the head of the stream, which says that LZ4 is used
    let mut encoder = Encoder::local()?;
    encoder.do_not_emit_footer();
    encoder.finish()?;
    let mut bytes = encoder.into_inner()?;
    put(&mut bytes, opening(&recording_id))?;
    if !aside.is_empty() {
        put(&mut bytes, opening(&aside_id))?;
        put_all(&mut bytes, aside, &aside_id)?;
    }
    put(&mut bytes, opening(&layout_id))?;
    put_all(&mut bytes, layout, &layout_id)?;
    let activation = BlueprintActivationCommand {
        blueprint_id: layout_id,
        make_active: true,
        make_default: true,
    };
    put(&mut bytes, activation.into())?;
    put_all(&mut bytes, parts, &recording_id)?;
    Ok(bytes)
}

/// What a store begins with.
fn opening(id: &StoreId) -> LogMsg {
    let source = StoreSource::Other(APPLICATION.to_owned());
    SetStoreInfo {
        row_id: Tuid::ZERO,
        info: StoreInfo::new(id.clone(), source),
    }
    .into()
}

fn put(bytes: &mut Vec<u8>, message: LogMsg) -> Result<(), Failure> {
    let message = message.to_transport(re_log_encoding::Compression::Off)?;
    message.to_rrd_bytes(bytes)?;
    Ok(())
}

fn put_all(bytes: &mut Vec<u8>, parts: Vec<ArrowMsg>, store: &StoreId) -> Result<(), Failure> {
    for mut part in parts {
        part.store_id = Some(store.clone().into());
        Msg::ArrowMsg(part).to_rrd_bytes(bytes)?;
    }
    Ok(())
}

/// One chunk, packed, but for the store that it belongs to.
fn part(chunk: Chunk) -> Result<ArrowMsg, Failure> {
    let nowhere = StoreId::new(StoreKind::Recording, APPLICATION, "");
    let message = chunk.to_arrow_msg()?;
    let mut part = message.to_transport((nowhere, re_log_encoding::Compression::Off))?;
    part.uncompressed_size = part.payload.len() as u64;
    part.payload = compress(&part.payload, Some(LEVEL), false)?.into();
    part.compression = Compression::Lz4.into();
    Ok(part)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use rerun::{ChunkStore, ChunkStoreConfig};

    use super::super::write;
    use crate::pipeline::{self, Run};
    use crate::scenario::Scenario;

    fn run(file: &str) -> Run {
        let file = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("scenarios")
            .join(file);
        pipeline::run(Scenario::read(&file).expect("valid"))
    }

    /// The names of the stores: the viewer takes two recordings of one name for one.
    fn names(bytes: &[u8]) -> Vec<String> {
        let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::DEFAULT, &mut &bytes[..]);
        let stores = stores.expect("reads");
        let mut names: Vec<String> = stores.keys().map(|id| format!("{id:?}")).collect();
        names.sort();
        names
    }

    #[test]
    fn the_same_run_twice_has_the_same_bytes_but_for_its_times() {
        let folder = tempfile::tempdir().expect("folder");
        let written = |run: &Run, document: Option<&str>| {
            let path = folder.path().join("a.rrd");
            write(run, document, &path).expect("writes");
            std::fs::read(path).expect("a file")
        };
        let head_on = || run("colregs/head-on.toml");
        let first = written(&head_on(), Some("{\"plan_s\": 0.25}"));
        assert!(first == written(&head_on(), Some("{\"plan_s\": 0.25}")));
        let later = written(&head_on(), Some("{\"plan_s\": 0.75}"));
        let differs = first.iter().zip(&later).filter(|(a, b)| a != b).count();
        assert!(first.len() == later.len() && differs == 1, "{differs}");
        // what holds other things is another recording
        assert_eq!(names(&first), names(&later));
        let give_way = run("colregs/give-way.toml");
        for other in [written(&head_on(), None), written(&give_way, None)] {
            let (first, other) = (names(&first), names(&other));
            assert!(other.iter().all(|name| !first.contains(name)), "{other:?}");
        }
    }
}
