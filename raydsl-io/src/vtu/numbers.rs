//! Arrays of a VTU, as floats or as whole numbers.

use std::io::{BufRead, Read};

use crate::cells::CellArray;
use crate::error::word_text;
use crate::payload::{Claim, fill, next_word};
use crate::source::{Fault, Source};
use crate::volume::{ByteOrder, VoxelType};
use crate::vtk::{Document, REMEDY, VtkArray, with_data};
use crate::{LoadError, Place};

/// Bytes that one byte of a compressed file may stand for.
const INFLATION: u64 = 1032;

/// Reads arrays, as long as all of them together may be in the file: several may claim the same
/// bytes.
pub(super) struct Reader<'a> {
    pub(super) source: &'a mut Source,
    pub(super) document: &'a Document,
    /// Bytes that arrays may still claim.
    left: u64,
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a mut Source, document: &'a Document) -> Self {
        let inflation = if document.is_packed { INFLATION } else { 8 };
        let left = source.len.saturating_mul(inflation);
        Self { source, document, left }
    }

    /// Reads an array of so many points or cells as floats.
    pub(super) fn array(&mut self, array: &VtkArray, count: u64) -> Result<CellArray, LoadError> {
        let values = self.numbers(array, count, |n| n as f32)?;
        let components = array.components as usize;
        Ok(CellArray { name: array.name.clone(), components, values })
    }

    /// Reads an array of `count` tuples, each number by `to`.
    pub(super) fn numbers<T>(
        &mut self,
        array: &VtkArray,
        count: u64,
        to: impl Fn(f64) -> T + Copy,
    ) -> Result<Vec<T>, LoadError> {
        let (kind, order) = (array.kind(self.source)?, self.document.order);
        let label = word_text(array.name.as_bytes());
        let wrong =
            |source: &Source, what: String| source.corrupt(Place::Byte(array.at), what, REMEDY);
        if array.components == 0 {
            let what = format!("the array '{label}' has no components");
            return Err(wrong(self.source, what));
        }
        let numbers = count.checked_mul(array.components);
        let bytes = numbers.and_then(|n| n.checked_mul(kind.size().max(size_of::<T>() as u64)));
        let Some((numbers, left)) = numbers.zip(bytes.and_then(|b| self.left.checked_sub(b)))
        else {
            let what = format!(
                "with the array '{label}' of {count} x {} numbers its arrays are larger than a \
                 file of {} bytes may hold",
                array.components, self.source.len
            );
            return Err(wrong(self.source, what));
        };
        self.left = left;
        let name = format!("{numbers} numbers of the array '{label}'");
        let claim = Claim { name, count: numbers, bytes: numbers * kind.size() };
        let words = |stream: &mut dyn BufRead| from_text(stream, &claim, kind, to);
        let binary = |stream: &mut dyn Read| from_bytes(stream, &claim, kind, order, to);
        with_data(self.source, self.document, array, &claim, words, binary)
    }
}

/// An empty list with room for all, which are held against the file.
fn room<T>(count: u64) -> Result<Vec<T>, Fault> {
    let mut list = Vec::new();
    let remedy = "use a machine with more memory, or split the file";
    let no_room = Fault::NoRoom { what: "number", count, remedy };
    match list.try_reserve_exact(count as usize) {
        Ok(()) => Ok(list),
        Err(_) => Err(no_room),
    }
}

fn from_text<T>(
    stream: &mut dyn BufRead,
    claim: &Claim,
    kind: VoxelType,
    to: impl Fn(f64) -> T,
) -> Result<Vec<T>, Fault> {
    let (mut list, mut word) = (room(claim.count)?, Vec::new());
    for i in 0..claim.count {
        if !next_word(stream, &mut word)? {
            return Err(Fault::Cut(format!("{i} of {} are there", claim.name)));
        }
        let number = str::from_utf8(&word).ok().and_then(|word| word.parse::<f64>().ok());
        let Some(number) = number.filter(|n| kind.has(*n)) else {
            let (word, kind) = (word_text(&word), kind.name());
            let what = format!("number {i} of the {}, '{word}', is no {kind}", claim.name);
            return Err(Fault::Bad(what));
        };
        list.push(to(number));
    }
    Ok(list)
}

fn from_bytes<T>(
    stream: &mut dyn Read,
    claim: &Claim,
    kind: VoxelType,
    order: ByteOrder,
    to: impl Fn(f64) -> T,
) -> Result<Vec<T>, Fault> {
    let mut list = room(claim.count)?;
    let (mut buffer, mut done) = ([0; 1 << 14], 0);
    let size = kind.size() as usize;
    while done < claim.bytes {
        let part = (claim.bytes - done).min(buffer.len() as u64) as usize;
        let part = &mut buffer[..part];
        fill(stream, part, |held| {
            format!("{} of {} are there", (done + held) / kind.size(), claim.name)
        })?;
        for bytes in part.chunks_exact_mut(size) {
            if order == ByteOrder::Big {
                bytes.reverse();
            }
            list.push(to(number(bytes, kind)));
        }
        done += part.len() as u64;
    }
    Ok(list)
}

/// The number of little-endian bytes.
fn number(bytes: &[u8], kind: VoxelType) -> f64 {
    let mut wide = [0; 8];
    wide[..bytes.len()].copy_from_slice(bytes);
    let bits = u64::from_le_bytes(wide);
    match kind {
        VoxelType::U8 | VoxelType::U16 | VoxelType::U32 | VoxelType::U64 => bits as f64,
        VoxelType::I8 => f64::from(bits as u8 as i8),
        VoxelType::I16 => f64::from(bits as u16 as i16),
        VoxelType::I32 => f64::from(bits as u32 as i32),
        VoxelType::I64 => bits as i64 as f64,
        VoxelType::F32 => f64::from(f32::from_bits(bits as u32)),
        VoxelType::F64 => f64::from_bits(bits),
    }
}
