//! The messages of a file, decoded: stores and their chunks.

use std::panic::{AssertUnwindSafe, catch_unwind};

use rayon::prelude::*;
use re_protos::common::v1alpha1::ext::StoreIdFromProtoError;
use re_protos::external::prost::Message;
use re_protos::log_msg::v1alpha1::{ArrowMsg, BlueprintActivationCommand, SetStoreInfo, log_msg};
use rerun::external::re_log_encoding::{
    ApplicationIdInjector, CachingApplicationIdInjector, CodecError, MessageKind, ToApplication,
};
use rerun::external::re_log_types::{LogMsg, StoreId, StoreInfo};
use rerun::log::Chunk;

use super::APPLICATION;
use super::digest::Digest;
use super::frames::{Frame, Frames};
use super::payload;

/// Bytes, 4 GiB: what is unpacked is held in memory.
const UNPACKED_BYTES: u64 = 1 << 32;

/// What a file holds.
#[derive(Debug)]
pub(super) struct Messages {
    pub stores: Vec<StoreInfo>,
    /// In the order of the file.
    pub chunks: Vec<(StoreId, Chunk)>,
}

/// A message with a chunk that is not decoded.
struct Part {
    store: StoreId,
    at: usize,
    message: ArrowMsg,
}

impl Messages {
    /// Decodes the messages of a file side by side; what is wrong with the first that is wrong, in words. O(bytes).
    pub(super) fn of(frames: &Frames) -> Result<Self, String> {
        let mut stores = Vec::new();
        let mut parts = Vec::new();
        let mut injector = CachingApplicationIdInjector::default();
        for frame in &frames.messages {
            let wrong = |reason: String| at(frame.at, &reason);
            match frame.kind {
                MessageKind::SetStoreInfo => {
                    stores.extend(store(frame, &mut injector).map_err(wrong)?);
                }
                MessageKind::ArrowMsg => {
                    parts.extend(part(frame, &injector).map_err(wrong)?);
                }
                MessageKind::BlueprintActivationCommand => {
                    let command = BlueprintActivationCommand::decode(frame.payload);
                    command.map_err(|error| wrong(error.to_string()))?;
                }
                MessageKind::End => {}
            }
        }
        let unpacked = parts.iter().map(|part| part.message.uncompressed_size);
        let unpacked = unpacked.fold(0, u64::saturating_add);
        if unpacked > UNPACKED_BYTES {
            return Err(format!(
                "its messages are said to unpack to {unpacked} bytes; allowed: {UNPACKED_BYTES}"
            ));
        }
        let chunks = || -> Vec<Result<Chunk, String>> {
            let chunks = parts.par_iter();
            chunks.map(|part| decoded(&part.message)).collect()
        };
        let sealed = || frames.is_footed || is_sealed(&stores, &parts);
        let (chunks, sealed) = rayon::join(chunks, sealed);
        if !sealed {
            return Err("its bytes are not those that it is named after".to_owned());
        }
        let chunks = chunks.into_iter().zip(parts).map(|(chunk, part)| {
            let chunk = chunk.map_err(|reason| at(part.at, &reason))?;
            Ok((part.store, chunk))
        });
        let chunks = chunks.collect::<Result<_, String>>()?;
        Ok(Self { stores, chunks })
    }
}

/// The chunk in a message. Arrow gives up with a panic where the types in it are none.
fn decoded(message: &ArrowMsg) -> Result<Chunk, String> {
    catch_unwind(AssertUnwindSafe(|| payload::chunk(message)))
        .unwrap_or_else(|_| Err("no Arrow table that can be read".to_owned()))
}

fn at(byte: usize, reason: &str) -> String {
    format!("the message at byte {byte}: {reason}")
}

/// What a store is; `None` where nobody says whose it is, as in files of old.
fn store(
    frame: &Frame,
    injector: &mut CachingApplicationIdInjector,
) -> Result<Option<StoreInfo>, String> {
    let message = SetStoreInfo::decode(frame.payload).map_err(|e| e.to_string())?;
    let message = log_msg::Msg::SetStoreInfo(message);
    match message.to_application((injector, Some(frame.version))) {
        Ok(LogMsg::SetStoreInfo(message)) => Ok(Some(message.info)),
        Ok(_) | Err(CodecError::StoreIdMissingApplicationId { .. }) => Ok(None),
        Err(error) => Err(error.to_string()),
    }
}

/// The same of a chunk.
fn part(frame: &Frame, injector: &CachingApplicationIdInjector) -> Result<Option<Part>, String> {
    let mut message = ArrowMsg::decode(frame.payload).map_err(|e| e.to_string())?;
    let store = message.store_id.take().ok_or("it belongs to no store")?;
    let store = match StoreId::try_from(store) {
        Ok(store) => Some(store),
        Err(StoreIdFromProtoError::MissingApplicationId(missing)) => {
            injector.recover_store_id(missing)
        }
        Err(error) => return Err(error.to_string()),
    };
    Ok(store.map(|store| Part {
        store,
        at: frame.at,
        message,
    }))
}

/// True where every recording of ours was opened, and has the bytes that it is named after.
fn is_sealed(stores: &[StoreInfo], parts: &[Part]) -> bool {
    let opened: Vec<&StoreId> = stores.iter().map(|info| &info.store_id).collect();
    let mut ours: Vec<&StoreId> = (opened.iter().copied())
        .chain(parts.iter().map(|part| &part.store))
        .filter(|id| id.is_recording() && id.application_id().as_str() == APPLICATION)
        .collect();
    ours.sort();
    ours.dedup();
    ours.into_iter().all(|id| {
        let own = parts.iter().filter(|part| part.store == *id);
        let digest = Digest::of(own.map(|part| &part.message.payload[..]));
        opened.contains(&id) && id.recording_id().as_str() == digest.recording()
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::frames::frames;
    use super::super::write;
    use super::*;
    use crate::pipeline;
    use crate::scenario::Scenario;

    /// The end of a stream of another program, with the marks of a footer.
    const FOOTED: [&[u8]; 4] = [&[0; 16], &[0; 20], b"RRF2FOOT", &[1, 0, 0, 0]];

    fn recording() -> Vec<u8> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let scenario = Scenario::read(&root.join("scenarios/colregs/head-on.toml"));
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a.rrd");
        write(&pipeline::run(scenario.expect("valid")), None, &file).expect("writes");
        std::fs::read(file).expect("a file")
    }

    fn read(bytes: &[u8]) -> Result<usize, String> {
        Messages::of(&frames(bytes)?).map(|messages| messages.chunks.len())
    }

    /// The file with another last message.
    fn with_last(whole: &[u8], last: &ArrowMsg) -> Vec<u8> {
        let found = frames(whole).expect("whole");
        let at = found.messages.last().expect("a message").at;
        let payload = last.encode_to_vec();
        let length = (payload.len() as u64).to_le_bytes();
        [&whole[..at], &whole[at..at + 8], &length, &payload].concat()
    }

    #[test]
    fn a_recording_of_ours_has_the_bytes_that_it_is_named_after() {
        let whole = recording();
        let found = frames(&whole).expect("whole").messages;
        let chunks = found.iter().filter(|m| m.kind == MessageKind::ArrowMsg);
        assert_eq!(read(&whole), Ok(chunks.count()));
        let last = found.last().expect("a message");
        let message = ArrowMsg::decode(last.payload).expect("a chunk");
        let size = i32::try_from(message.uncompressed_size).expect("small");
        let unpacked = lz4::block::decompress(&message.payload, Some(size)).expect("packed");
        // a number that decodes as well as the one that was there
        let changed = |at: usize| {
            let mut unpacked = unpacked.clone();
            unpacked[at] ^= 1;
            let payload = lz4::block::compress(&unpacked, None, false).expect("packs");
            ArrowMsg {
                payload: payload.into(),
                ..message.clone()
            }
        };
        let at = (0..unpacked.len()).rfind(|at| payload::chunk(&changed(*at)).is_ok());
        let changed = with_last(&whole, &changed(at.expect("a number")));
        let elsewhere = ArrowMsg {
            store_id: message.store_id.clone().map(|mut id| {
                id.recording_id.push('0');
                id
            }),
            ..message.clone()
        };
        let elsewhere = with_last(&whole, &elsewhere);
        let joints = found.iter().map(|m| &whole[..m.at]).skip(1);
        for damaged in joints.chain([&changed[..], &elsewhere]) {
            let refused = read(damaged).expect_err("another content");
            assert!(refused.contains("named after"), "{refused}");
            // what another program has written anew is not held against its name
            assert!(read(&[damaged, &FOOTED.concat()].concat()).is_ok());
        }
    }

    /// Where each byte in turn is another, or the file ends, there is an error or a whole recording: no panic, no end of the program.
    #[test]
    fn damage_is_an_error() {
        let whole = recording();
        let found = frames(&whole).expect("whole").messages;
        // the first chunk of each store: of a small one all bytes
        let chunks = found.iter().filter(|m| m.kind == MessageKind::ArrowMsg);
        let smallest = chunks.min_by_key(|m| m.payload.len()).expect("a chunk");
        let message = ArrowMsg::decode(smallest.payload).expect("a chunk");
        let size = i32::try_from(message.uncompressed_size).expect("small");
        let unpacked = lz4::block::decompress(&message.payload, Some(size)).expect("packed");
        let mut refused = 0;
        for at in 0..unpacked.len() {
            for value in [0, 0x7f, 0x80, 0xff] {
                let mut unpacked = unpacked.clone();
                unpacked[at] = value;
                let plain = ArrowMsg {
                    payload: unpacked.into(),
                    compression: re_protos::common::v1alpha1::Compression::None.into(),
                    ..message.clone()
                };
                refused += usize::from(decoded(&plain).is_err());
            }
        }
        assert!(refused > unpacked.len() / 4, "{refused}");
    }
}
