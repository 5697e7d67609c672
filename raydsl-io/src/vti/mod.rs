//! VTI: image data of VTK, in XML.

mod base64;
mod blocks;
mod document;

use std::io::{self, BufRead, BufReader, Read};

use crate::error::{one_line, word_text};
use crate::payload::{Payload, place};
use crate::source::{Fault, Source};
use crate::volume::{ByteOrder, VolumeFile, VoxelType, Voxels};
use crate::{LoadError, Place};
use base64::Base64;
use blocks::Blocks;
use document::{Array, Content, Document};

const REMEDY: &str = "write it again, for example with ParaView";

pub(crate) fn read(mut source: Source, wanted: Option<&str>) -> Result<VolumeFile, LoadError> {
    let document = document::read(&mut source)?;
    let array = choose(&source, &document, wanted)?;
    let kind = kind_of(&array.kind).ok_or_else(|| {
        let what = format!("'{}' is no type of numbers", word_text(array.kind.as_bytes()));
        source.corrupt(Place::Byte(array.at), what, REMEDY)
    })?;
    let size = document.size(array.is_cells);
    let payload = Payload::new(&source, size, kind, document.order)?;
    let to_world = to_world(&source, &document, array.is_cells)?;
    let voxels = voxels(&mut source, &document, array, &payload)?;
    let mut volume = payload.volume(voxels, to_world);
    volume.is_cell_centred = array.is_cells;
    Ok(volume)
}

/// The array that is asked for, or else the active scalars, or else the only scalars.
fn choose<'a>(
    source: &Source,
    document: &'a Document,
    wanted: Option<&str>,
) -> Result<&'a Array, LoadError> {
    let arrays = &document.arrays;
    if arrays.is_empty() {
        return Err(LoadError::Empty { path: source.path.clone(), what: "array of voxels" });
    }
    let refuse = |what: String| {
        let known = arrays.iter().map(|a| format!("'{}' ({})", a.name, a.components));
        let known = one_line(known.take(16).collect::<Vec<_>>().join(", "));
        LoadError::NoArray { path: source.path.clone(), what, known }
    };
    let named = |name: &str, is_cells: bool| {
        arrays.iter().find(|a| a.name == name && a.is_cells == is_cells)
    };
    let active = || {
        let names = document.active.iter().zip([false, true]);
        names.filter_map(|(name, is_cells)| named(name.as_deref()?, is_cells)).next()
    };
    let only = || {
        let mut scalars = arrays.iter().filter(|a| a.components == 1);
        scalars.next().filter(|_| scalars.next().is_none())
    };
    let found = match wanted {
        Some(name) => named(name, false)
            .or_else(|| named(name, true))
            .ok_or_else(|| refuse(format!("has no array '{}'", word_text(name.as_bytes()))))?,
        None => active()
            .or_else(only)
            .ok_or_else(|| refuse("has no active scalars and no single array of them".into()))?,
    };
    if found.components != 1 {
        let name = word_text(found.name.as_bytes());
        let what = format!("has {} components in the array '{name}'", found.components);
        return Err(refuse(what));
    }
    Ok(found)
}

fn to_world(
    source: &Source,
    document: &Document,
    is_cells: bool,
) -> Result<glam::Affine3, LoadError> {
    let Document { spacing, direction: d, .. } = document;
    // The file has the matrix row by row.
    let axes = [0, 1, 2].map(|i| [d[i], d[3 + i], d[6 + i]].map(|c| c * spacing[i]));
    let half = if is_cells { 0.5 } else { 0.0 };
    // An extent need not begin at 0.
    let first = [0, 1, 2].map(|i| f64::from(document.extent[2 * i]) + half);
    let origin = [0, 1, 2].map(|c| {
        let steps = axes.iter().zip(first).map(|(axis, first)| axis[c] * first);
        document.origin[c] + steps.sum::<f64>()
    });
    place(axes, origin).ok_or_else(|| {
        let what = "its spacing, origin or direction is not finite, or has no inverse".into();
        source.corrupt(Place::Byte(document.at), what, REMEDY)
    })
}

fn voxels(
    source: &mut Source,
    document: &Document,
    array: &Array,
    payload: &Payload,
) -> Result<Voxels, LoadError> {
    let (start, is_base64) = match (array.content, document.appended) {
        (Content::Text, _) => (Some(array.at), false),
        (Content::Inline, _) => (Some(array.at), true),
        (Content::Appended(offset), Some((at, is_base64))) => (at.checked_add(offset), is_base64),
        (Content::Appended(_), None) => {
            let what = "its voxels are in appended data, and there are none";
            return Err(source.corrupt(Place::Byte(array.at), what.into(), REMEDY));
        }
    };
    if !start.map_or(Ok(false), |start| source.go_to(start))? {
        let what = format!("its voxels begin behind byte {}", source.len);
        return Err(source.truncated(what));
    }
    let held = source.remaining();
    if array.content == Content::Text {
        payload.check_text(source, held)?;
        let mut text = BufReader::new(Element { source: &mut *source });
        return payload.read_text(&mut text).map_err(|fault| source.fault(fault, REMEDY));
    }
    match document.is_packed {
        true => payload.check_packed(source, held)?,
        false => payload.check_held(source, held)?,
    }
    let read = if is_base64 {
        let mut stream = BufReader::new(Base64::new(&mut *source));
        binary(&mut stream, held, document, payload)
    } else {
        binary(&mut *source, held, document, payload)
    };
    read.map_err(|fault| source.fault(fault, REMEDY))
}

/// Reads the lengths ahead of the voxels, and the voxels.
fn binary(
    stream: &mut dyn BufRead,
    held: u64,
    document: &Document,
    payload: &Payload,
) -> Result<Voxels, Fault> {
    let length = |stream: &mut dyn BufRead| -> Result<u64, Fault> {
        let mut bytes = [0; 8];
        let used = &mut bytes[..document.width];
        stream.read_exact(used)?;
        if document.order == ByteOrder::Big {
            used.reverse();
        }
        Ok(u64::from_le_bytes(bytes))
    };
    let (name, expected) = (payload.name(), payload.bytes());
    if !document.is_packed {
        let bytes = length(stream)?;
        if bytes != expected {
            return Err(Fault::Bad(format!("{name} take {expected} bytes, its array has {bytes}")));
        }
        return payload.read(stream);
    }
    let [count, each, last] = [length(stream)?, length(stream)?, length(stream)?];
    if count > held / document.width as u64 {
        return Err(Fault::Cut(format!("it lists {count} blocks in {held} bytes")));
    }
    let last = if last == 0 { each } else { last };
    let bytes = count.checked_sub(1).and_then(|full| full.checked_mul(each)?.checked_add(last));
    if bytes != Some(expected) {
        let what = format!(
            "{name} take {expected} bytes, its array has {count} blocks of {each}, the last of {last}"
        );
        return Err(Fault::Bad(what));
    }
    let mut blocks = Vec::new();
    for i in 0..count {
        blocks.push((length(stream)?, if i + 1 == count { last } else { each }));
    }
    payload.read_to_end(&mut Blocks::new(stream, blocks))
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

fn kind_of(name: &str) -> Option<VoxelType> {
    Some(match name {
        "UInt8" => VoxelType::U8,
        "Int8" => VoxelType::I8,
        "UInt16" => VoxelType::U16,
        "Int16" => VoxelType::I16,
        "UInt32" => VoxelType::U32,
        "Int32" => VoxelType::I32,
        "UInt64" => VoxelType::U64,
        "Int64" => VoxelType::I64,
        "Float32" => VoxelType::F32,
        "Float64" => VoxelType::F64,
        _ => return None,
    })
}
