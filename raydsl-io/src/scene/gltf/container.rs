//! The two kinds of files: JSON alone, and GLB, which holds JSON and a buffer.

use super::REMEDY;
use crate::source::Source;
use crate::{LoadError, Place};

const JSON: [u8; 4] = *b"JSON";
const BIN: [u8; 4] = *b"BIN\0";

/// Splits a file into its JSON and, in a GLB, its buffer.
pub(super) fn split(
    source: &Source,
    mut bytes: Vec<u8>,
) -> Result<(Vec<u8>, Option<Vec<u8>>), LoadError> {
    let is_glb = source.path.extension().is_some_and(|e| e.eq_ignore_ascii_case("glb"));
    if !bytes.starts_with(b"glTF") {
        if is_glb && b"glTF".starts_with(&bytes) {
            return Err(source.truncated("it ends within its header".into()));
        }
        if is_glb {
            let what = "it does not begin with 'glTF'".into();
            return Err(source.corrupt(Place::Byte(0), what, REMEDY));
        }
        return Ok((bytes, None));
    }
    let end = header(source, &bytes)?;
    bytes.truncate(end);
    let (kind, json) = chunk(source, &bytes, 12)?;
    if kind != JSON {
        let what = "its first chunk is not JSON".into();
        return Err(source.corrupt(Place::Byte(16), what, REMEDY));
    }
    let text = bytes[json.clone()].to_vec();
    if json.end == bytes.len() {
        return Ok((text, None));
    }
    let (kind, blob) = chunk(source, &bytes, json.end)?;
    if kind != BIN {
        return Ok((text, None));
    }
    bytes.truncate(blob.end);
    bytes.drain(..blob.start);
    Ok((text, Some(bytes)))
}

/// Checks the header; gives the length of the GLB.
fn header(source: &Source, bytes: &[u8]) -> Result<usize, LoadError> {
    let (Some(version), Some(len)) = (number(bytes, 4), number(bytes, 8)) else {
        return Err(source.truncated("it ends within its header".into()));
    };
    if version != 2 {
        let what = format!("it is a GLB of version {version}");
        return Err(source.corrupt(Place::Byte(4), what, "convert it to glTF 2.0"));
    }
    if len > bytes.len() {
        return Err(source.truncated(format!("its header tells a length of {len}")));
    }
    if len < 12 {
        let what = format!("its header tells a length of {len}");
        return Err(source.corrupt(Place::Byte(8), what, REMEDY));
    }
    Ok(len)
}

/// The type and the place of the data of the chunk that begins at a byte.
fn chunk(
    source: &Source,
    bytes: &[u8],
    at: usize,
) -> Result<([u8; 4], std::ops::Range<usize>), LoadError> {
    let kind = bytes.get(at + 4..at + 8).and_then(|kind| <[u8; 4]>::try_from(kind).ok());
    let (Some(len), Some(kind)) = (number(bytes, at), kind) else {
        return Err(source.truncated("it ends within the header of a chunk".into()));
    };
    let begin = at + 8;
    match begin.checked_add(len).filter(|end| *end <= bytes.len()) {
        Some(end) => Ok((kind, begin..end)),
        None => {
            let rest = bytes.len() - begin;
            Err(source.truncated(format!("a chunk of {len} bytes has {rest} of them")))
        }
    }
}

fn number(bytes: &[u8], at: usize) -> Option<usize> {
    let bytes = bytes.get(at..at + 4)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(bytes)).ok()
}
