//! The bytes that a file describes: in itself, in URIs and in files beside it.

use std::collections::HashMap;
use std::path::{Component, Path};
use std::rc::Rc;

use gltf_json::{Index, buffer::View};

use super::{File, REMEDY};
use crate::error::word_text;
use crate::source::Source;
use crate::{LoadError, Place};

/// The buffers of a file.
pub(super) struct Buffers {
    buffers: Vec<Rc<Vec<u8>>>,
    total: u64,
}

/// The bytes of a view, and the distance between its elements if it tells one.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) stride: Option<usize>,
}

impl Buffers {
    pub(super) fn load(file: &File, blob: Option<Vec<u8>>) -> Result<Self, LoadError> {
        let (mut blob, mut beside) = (blob.map(Rc::new), HashMap::new());
        let mut all = Self { buffers: Vec::new(), total: file.source.len };
        for (i, buffer) in file.root.buffers.iter().enumerate() {
            let bytes = match &buffer.uri {
                Some(uri) => fetch(&file.source, uri, &mut beside)?,
                None if i == 0 => blob.take().unwrap_or_default(),
                None => Rc::default(),
            };
            let (claimed, found) = (buffer.byte_length.0, bytes.len() as u64);
            if found < claimed {
                let what = format!("buffers[{i}] claims {claimed} bytes and has {found}");
                return Err(file.missing(what));
            }
            all.buffers.push(bytes);
        }
        all.total += beside.values().map(|bytes| bytes.len() as u64).sum::<u64>();
        Ok(all)
    }

    /// The bytes of the file and of those beside it.
    pub(super) fn total(&self) -> u64 {
        self.total
    }

    pub(super) fn view(&self, file: &File, index: Index<View>) -> Result<Bytes<'_>, LoadError> {
        let view = file.get(&file.root.buffer_views, index, "bufferViews")?;
        let bytes = file.at(&self.buffers, view.buffer.value(), "buffers")?;
        let begin = view.byte_offset.unwrap_or_default().0;
        let range = usize::try_from(begin).ok().zip(usize::try_from(view.byte_length.0).ok());
        let part = range.and_then(|(begin, len)| bytes.get(begin..begin.checked_add(len)?));
        let bytes = part.ok_or_else(|| {
            let (i, len) = (index.value(), view.byte_length.0);
            let what = format!(
                "bufferViews[{i}] is {len} bytes from {begin}, beyond its buffer of {}",
                bytes.len()
            );
            file.wrong(what)
        })?;
        Ok(Bytes { bytes, stride: view.byte_stride.map(|stride| stride.0) })
    }
}

/// The bytes of a URI. Files beside the source are read once.
pub(super) fn fetch(
    source: &Source,
    uri: &str,
    beside: &mut HashMap<String, Rc<Vec<u8>>>,
) -> Result<Rc<Vec<u8>>, LoadError> {
    let wrong = |what: &str, remedy| {
        let what = format!("the URI '{}' {what}", word_text(uri.as_bytes()));
        source.corrupt(Place::Somewhere, what, remedy)
    };
    if let Some(data) = uri.strip_prefix("data:") {
        let bytes = data.split_once(";base64,").and_then(|(_, text)| base64(text.as_bytes()));
        return bytes.map(Rc::new).ok_or_else(|| wrong("is no base64 data", REMEDY));
    }
    if let Some(bytes) = beside.get(uri) {
        return Ok(bytes.clone());
    }
    let name = percent_decoded(uri).ok_or_else(|| wrong("is not percent-encoded text", REMEDY))?;
    let is_below = Path::new(&name)
        .components()
        .all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
    if name.is_empty() || !is_below || uri.contains(':') {
        return Err(wrong(
            "is no file in its folder or below",
            "move that file beside it, and write its name alone",
        ));
    }
    let folder = source.path.parent().unwrap_or(Path::new(""));
    let bytes = Rc::new(Source::open(&folder.join(&name), source.format)?.rest()?);
    beside.insert(uri.into(), bytes.clone());
    Ok(bytes)
}

fn percent_decoded(text: &str) -> Option<String> {
    let (mut bytes, mut rest) = (Vec::new(), text.as_bytes());
    while let [first, tail @ ..] = rest {
        rest = tail;
        let mut byte = *first;
        if byte == b'%' {
            let (code, tail) = rest.split_at_checked(2)?;
            let digit = |c: u8| char::from(c).to_digit(16);
            byte = (digit(code[0])? * 16 + digit(code[1])?) as u8;
            rest = tail;
        }
        bytes.push(byte);
    }
    String::from_utf8(bytes).ok()
}

/// None if a letter is none of its own, or the last group is of one letter.
fn base64(text: &[u8]) -> Option<Vec<u8>> {
    let end = text.iter().rposition(|b| *b != b'=').map_or(0, |i| i + 1);
    let text = if text.len() - end <= 2 { &text[..end] } else { return None };
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.chunks(4) {
        let mut bits = 0u32;
        for letter in group {
            let value = match letter {
                b'A'..=b'Z' => letter - b'A',
                b'a'..=b'z' => letter - b'a' + 26,
                b'0'..=b'9' => letter - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return None,
            };
            bits = bits << 6 | u32::from(value);
        }
        bits <<= 6 * (4 - group.len());
        bytes
            .extend(bits.to_be_bytes()[1..].get(..group.len().checked_sub(1).filter(|n| *n > 0)?)?);
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_all_lengths() {
        for (text, bytes) in
            [("", &b""[..]), ("TQ==", b"M"), ("TWE=", b"Ma"), ("TWFu", b"Man"), ("TWE", b"Ma")]
        {
            assert_eq!(base64(text.as_bytes()).as_deref(), Some(bytes), "{text}");
        }
        for text in ["T", "TWFuT", "TW!u", "TQ===", "T=Fu"] {
            assert_eq!(base64(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn percent_codes() {
        assert_eq!(percent_decoded("a%20b%C3%a9").as_deref(), Some("a b\u{e9}"));
        assert_eq!(percent_decoded("a%2"), None);
        assert_eq!(percent_decoded("%zz"), None);
        assert_eq!(percent_decoded("%ff"), None);
    }
}
