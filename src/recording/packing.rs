//! Messages → the bytes of a file, packed closer than the library does: with many small messages that is a tenth of it.
//! Any reader of recordings reads them.

use lz4::block::{CompressionMode, compress};
use rayon::prelude::*;
use re_protos::common::v1alpha1::Compression;
use re_protos::log_msg::v1alpha1::log_msg::Msg;
use rerun::external::re_log_encoding::{self, Encodable, Encoder, ToTransport};
use rerun::external::re_log_types::LogMsg;

/// Of LZ4's twelve: those behind it gain a hundredth for four times the time.
const LEVEL: CompressionMode = CompressionMode::HIGHCOMPRESSION(7);

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// The file, in the order of the messages, which are packed side by side. It has no footer: that is an index into files too large to be
/// read whole, and would be 40 % of ours.
pub fn packed(messages: Vec<LogMsg>) -> Result<Vec<u8>, Failure> {
    // the head of the stream, which says that LZ4 is used
    let mut encoder = Encoder::local()?;
    encoder.do_not_emit_footer();
    encoder.finish()?;
    let mut bytes = encoder.into_inner()?;
    let parts: Result<Vec<Vec<u8>>, Failure> = messages.into_par_iter().map(frame).collect();
    bytes.extend(parts?.concat());
    Ok(bytes)
}

/// One message as it stands in the file.
fn frame(message: LogMsg) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let mut message = message.to_transport(re_log_encoding::Compression::Off)?;
    if let Msg::ArrowMsg(data) = &mut message {
        data.uncompressed_size = data.payload.len() as u64;
        data.payload = compress(&data.payload, Some(LEVEL), false)?.into();
        data.compression = Compression::Lz4.into();
    }
    message.to_rrd_bytes(&mut bytes)?;
    Ok(bytes)
}
