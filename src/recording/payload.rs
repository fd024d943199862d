//! What a message with a chunk carries: unpacked, and held against its own length before Arrow reads it.

use re_protos::common::v1alpha1::Compression;
use re_protos::log_msg::v1alpha1::ArrowMsg;
use rerun::external::re_log_encoding::ToApplication;
use rerun::external::re_log_encoding::external::lz4_flex::block::decompress_into;
use rerun::log::Chunk;

use super::ipc;

/// Of a repetition in LZ4: bytes that say how far back it lies, and its least length.
const OFFSET: usize = 2;
const REPETITION: u64 = 4;

/// The chunk in a message; what is wrong with it in words. Memory is asked for only as far as the message can fill it.
pub(super) fn chunk(message: &ArrowMsg) -> Result<Chunk, String> {
    let payload = match message.compression() {
        Compression::Lz4 => unpacked(&message.payload, message.uncompressed_size)?.into(),
        Compression::None | Compression::Unspecified => message.payload.clone(),
    };
    ipc::check(&payload)?;
    let plain = ArrowMsg {
        payload,
        compression: Compression::None.into(),
        encoding: message.encoding,
        ..ArrowMsg::default()
    };
    let decoded = plain.to_application(()).map_err(|e| e.to_string())?;
    Chunk::from_arrow_msg(&decoded).map_err(|e| e.to_string())
}

/// The bytes that a block of LZ4 stands for, of which there are said to be `size`.
fn unpacked(block: &[u8], size: u64) -> Result<Vec<u8>, String> {
    match length(block) {
        Some(length) if length == size => {}
        Some(length) => {
            return Err(format!(
                "a payload is said to unpack to {size} bytes, and unpacks to {length}"
            ));
        }
        None => return Err("a packed payload ends within".to_owned()),
    }
    let scarce = |_| format!("{size} bytes, more than there is memory for");
    let size = usize::try_from(size).map_err(|_| scarce(()))?;
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(size).map_err(|_| scarce(()))?;
    bytes.resize(size, 0);
    decompress_into(block, &mut bytes).map_err(|e| e.to_string())?;
    Ok(bytes)
}

/// Bytes that a block of LZ4 stands for, from the lengths in it alone; `None` where it ends within. O(block).
fn length(block: &[u8]) -> Option<u64> {
    let (mut at, mut total) = (0, 0);
    loop {
        let token = *block.get(at)?;
        at += 1;
        let literals = extended(token >> 4, block, &mut at)?;
        total += literals;
        at = at.checked_add(usize::try_from(literals).ok()?)?;
        // the last has no repetition
        if at == block.len() {
            return Some(total);
        }
        at = at.checked_add(OFFSET)?;
        total += REPETITION + extended(token & 15, block, &mut at)?;
    }
}

/// A length of four bits, which goes on in bytes where they are all set, and in further ones where those are.
fn extended(nibble: u8, block: &[u8], at: &mut usize) -> Option<u64> {
    let mut length = u64::from(nibble);
    if nibble < 15 {
        return Some(length);
    }
    loop {
        let more = *block.get(*at)?;
        *at += 1;
        length += u64::from(more);
        if more < u8::MAX {
            return Some(length);
        }
    }
}

#[cfg(test)]
mod tests {
    use rerun::external::re_log_encoding::external::lz4_flex::block::compress;

    use super::*;

    fn texts() -> Vec<Vec<u8>> {
        let numbers = |n: u32, m: u32| (0..n).flat_map(|i| (i * i % m).to_le_bytes()).collect();
        vec![
            vec![],
            vec![1],
            vec![0; 100_000],
            numbers(300, 1 << 30),
            numbers(5_000, 7),
            numbers(5_000, 1_000),
        ]
    }

    #[test]
    fn the_length_of_a_block_is_that_of_what_it_unpacks_to() {
        for text in texts() {
            let fast = compress(&text);
            let small = lz4::block::compress(&text, None, false).expect("packs");
            for block in [fast, small] {
                assert_eq!(length(&block), Some(text.len() as u64));
                assert_eq!(unpacked(&block, text.len() as u64).as_ref(), Ok(&text));
            }
        }
        // nothing, within literals, within a length, within an offset
        for block in [&[][..], &[0x20, 1], &[0xf0, 255], &[0x10, 1, 1]] {
            assert_eq!(length(block), None, "{block:?}");
        }
    }

    /// The library would ask for the memory first.
    #[test]
    fn what_a_block_cannot_unpack_to_is_refused() {
        let block = compress(&texts()[2]);
        for size in [0, 99_999, 100_001, 1 << 33, 1 << 50, u64::MAX] {
            let refused = unpacked(&block, size).expect_err("another size");
            assert!(refused.contains(&size.to_string()), "{refused}");
        }
    }
}
