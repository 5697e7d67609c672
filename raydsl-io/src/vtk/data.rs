//! The numbers of an array: where they begin, and what they are packed in.

use std::io::{self, BufRead, BufReader, Read};

use super::base64::Base64;
use super::blocks::Blocks;
use super::{Content, Document, REMEDY, VtkArray};
use crate::payload::Claim;
use crate::source::{Fault, Source};
use crate::volume::ByteOrder;
use crate::{LoadError, Place};

/// Hands the numbers of an array to `text` or to `binary`, once what it claims to hold is held
/// against what is there.
pub(crate) fn with_data<T>(
    source: &mut Source,
    document: &Document,
    array: &VtkArray,
    claim: &Claim,
    text: impl FnOnce(&mut dyn BufRead) -> Result<T, Fault>,
    binary: impl FnOnce(&mut dyn Read) -> Result<T, Fault>,
) -> Result<T, LoadError> {
    let (start, is_base64) = match (array.content, document.appended) {
        (Content::Text, _) => (Some(array.at), false),
        (Content::Inline, _) => (Some(array.at), true),
        (Content::Appended(offset), Some((at, is_base64))) => (at.checked_add(offset), is_base64),
        (Content::Appended(_), None) => {
            let what = format!("{} are in appended data, and there are none", claim.name);
            return Err(source.corrupt(Place::Byte(array.at), what, REMEDY));
        }
    };
    if !start.map_or(Ok(false), |start| source.go_to(start))? {
        let what = format!("{} begin behind byte {}", claim.name, source.len);
        return Err(source.truncated(what));
    }
    let held = source.remaining();
    if array.content == Content::Text {
        claim.check_text(source, held)?;
        let mut words = BufReader::new(Element { source: &mut *source });
        return text(&mut words).map_err(|fault| source.fault(fault, REMEDY));
    }
    match document.is_packed {
        true => claim.check_packed(source, held)?,
        false => claim.check_held(source, held)?,
    }
    let read = if is_base64 {
        let mut stream = BufReader::new(Base64::new(&mut *source));
        unpacked(&mut stream, held, document, claim, binary)
    } else {
        unpacked(&mut *source, held, document, claim, binary)
    };
    read.map_err(|fault| source.fault(fault, REMEDY))
}

/// Reads the lengths ahead of the numbers, and hands on the numbers.
fn unpacked<T>(
    stream: &mut dyn BufRead,
    held: u64,
    document: &Document,
    claim: &Claim,
    read: impl FnOnce(&mut dyn Read) -> Result<T, Fault>,
) -> Result<T, Fault> {
    let length = |stream: &mut dyn BufRead| -> Result<u64, Fault> {
        let mut bytes = [0; 8];
        let used = &mut bytes[..document.width];
        stream.read_exact(used)?;
        if document.order == ByteOrder::Big {
            used.reverse();
        }
        Ok(u64::from_le_bytes(bytes))
    };
    let Claim { name, bytes: expected, .. } = claim;
    if !document.is_packed {
        let bytes = length(stream)?;
        if bytes != *expected {
            return Err(Fault::Bad(format!("{name} take {expected} bytes, its array has {bytes}")));
        }
        return read(&mut &mut *stream);
    }
    let [count, each, last] = [length(stream)?, length(stream)?, length(stream)?];
    if count > held / document.width as u64 {
        return Err(Fault::Cut(format!("it lists {count} blocks in {held} bytes")));
    }
    let last = if last == 0 { each } else { last };
    // Otherwise a small file may list empty blocks without end.
    if count > 0 && !(1..=each).contains(&last) {
        return Err(Fault::Bad(format!("{name} have blocks of {each} bytes, the last of {last}")));
    }
    let bytes = match count {
        0 => Some(0),
        count => (count - 1).checked_mul(each).and_then(|full| full.checked_add(last)),
    };
    if bytes != Some(*expected) {
        let what = format!(
            "{name} take {expected} bytes, its array has {count} blocks of {each}, the last of {last}"
        );
        return Err(Fault::Bad(what));
    }
    let mut blocks = Vec::new();
    if usize::try_from(count).map_or(true, |count| blocks.try_reserve_exact(count).is_err()) {
        return Err(Fault::Bad(format!("{name} have {count} blocks, too many for the memory")));
    }
    for i in 0..count {
        blocks.push((length(stream)?, if i + 1 == count { last } else { each }));
    }
    let mut blocks = Blocks::new(stream, blocks);
    let numbers = read(&mut blocks)?;
    // What follows is passed over; at the end the decoder compares sums.
    let _ = blocks.read(&mut [0])?;
    Ok(numbers)
}

/// The text of an element: what comes before the next tag.
struct Element<'a> {
    source: &'a mut Source,
}

impl Read for Element<'_> {
    fn read(&mut self, buf: &mut [u8]) -> io::Result<usize> {
        let bytes = self.source.fill_buf()?;
        if bytes.is_empty() {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let text = bytes.iter().position(|b| *b == b'<').unwrap_or(bytes.len());
        let count = text.min(buf.len());
        buf[..count].copy_from_slice(&bytes[..count]);
        self.source.consume(count);
        Ok(count)
    }
}
