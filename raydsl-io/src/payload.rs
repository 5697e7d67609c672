//! What a header says of its voxels, and how they are read.

use std::io::{BufRead, Read};
use std::path::{Component, Path};

use glam::{Affine3, UVec3, Vec3};

use crate::LoadError;
use crate::error::word_text;
use crate::source::{Fault, Source};
use crate::volume::{ByteOrder, VolumeFile, VoxelType, Voxels};

/// Voxels of a volume at most.
pub(crate) const MOST: u64 = 1 << 31;
const CROP: &str = "crop it, or halve its resolution";
/// A compressed byte inflates to no more than this many.
const INFLATION: u64 = 1032;
/// Bytes between the start of a compressed stream and its voxels at most.
const LONGEST_GAP: u64 = 64 << 20;
/// Numbers of a text are shorter.
const LONGEST_WORD: usize = 64;

impl VoxelType {
    /// Bytes of a number.
    pub(crate) fn size(self) -> u64 {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::U64 | Self::I64 | Self::F64 => 8,
        }
    }

    /// What errors call it.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::U8 => "u8",
            Self::I8 => "i8",
            Self::U16 => "u16",
            Self::I16 => "i16",
            Self::U32 => "u32",
            Self::I32 => "i32",
            Self::U64 => "u64",
            Self::I64 => "i64",
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }

    /// Whether it has the number.
    pub(crate) fn has(self, number: f64) -> bool {
        let (low, high) = match self {
            Self::F32 | Self::F64 => return true,
            Self::U8 => (0.0, f64::from(u8::MAX)),
            Self::I8 => (f64::from(i8::MIN), f64::from(i8::MAX)),
            Self::U16 => (0.0, f64::from(u16::MAX)),
            Self::I16 => (f64::from(i16::MIN), f64::from(i16::MAX)),
            Self::U32 => (0.0, f64::from(u32::MAX)),
            Self::I32 => (f64::from(i32::MIN), f64::from(i32::MAX)),
            Self::U64 => (0.0, u64::MAX as f64),
            Self::I64 => (i64::MIN as f64, i64::MAX as f64),
        };
        number.fract() == 0.0 && (low..=high).contains(&number)
    }
}

/// A stream's compression.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Compression {
    Gzip,
    Zlib,
}

/// Numbers that a header claims to be there, and what errors call them.
pub(crate) struct Claim {
    pub(crate) name: String,
    pub(crate) count: u64,
    pub(crate) bytes: u64,
}

impl Claim {
    /// An error if all numbers cannot be in `held` bytes.
    pub(crate) fn check_held(&self, source: &Source, held: u64) -> Result<(), LoadError> {
        let bytes = self.bytes;
        if bytes <= held {
            return Ok(());
        }
        Err(source.truncated(format!("{} take {bytes} bytes, {held} are there", self.name)))
    }

    /// An error if all numbers cannot be in `held` compressed bytes.
    pub(crate) fn check_packed(&self, source: &Source, held: u64) -> Result<(), LoadError> {
        let bytes = self.bytes;
        if bytes <= held.saturating_mul(INFLATION) {
            return Ok(());
        }
        let name = &self.name;
        Err(source
            .truncated(format!("{name} take {bytes} bytes, {held} compressed ones are there")))
    }

    /// An error if all numbers cannot be in `held` bytes of text.
    pub(crate) fn check_text(&self, source: &Source, held: u64) -> Result<(), LoadError> {
        // A digit each, and what parts it from the next.
        let least = (2 * self.count).saturating_sub(1);
        if least <= held {
            return Ok(());
        }
        let name = &self.name;
        Err(source.truncated(format!("{name} take {least} bytes of text, {held} are there")))
    }
}

/// The voxels that a header claims: no more than the limit, and at least one.
#[derive(Clone, Copy)]
pub(crate) struct Payload {
    pub(crate) size: UVec3,
    pub(crate) kind: VoxelType,
    pub(crate) order: ByteOrder,
}

impl Payload {
    pub(crate) fn new(
        source: &Source,
        size: [u64; 3],
        kind: VoxelType,
        order: ByteOrder,
    ) -> Result<Self, LoadError> {
        let (path, what) = (|| source.path.clone(), "voxel");
        if size.contains(&0) {
            return Err(LoadError::Empty { path: path(), what });
        }
        let count = size.iter().fold(1u64, |count, n| count.saturating_mul(*n));
        if count > MOST {
            return Err(LoadError::TooMany {
                path: path(),
                what,
                count,
                limit: MOST,
                remedy: CROP,
            });
        }
        Ok(Self { size: size.map(|n| n as u32).into(), kind, order })
    }

    pub(crate) fn count(&self) -> u64 {
        self.size.to_array().iter().map(|n| u64::from(*n)).product()
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.count() * self.kind.size()
    }

    /// What the header claims to be there.
    pub(crate) fn claim(&self) -> Claim {
        Claim { name: self.name(), count: self.count(), bytes: self.bytes() }
    }

    pub(crate) fn name(&self) -> String {
        let [x, y, z] = self.size.to_array();
        format!("{x} x {y} x {z} voxels of {}", self.kind.name())
    }

    /// Reads voxels that are in the file as they are.
    pub(crate) fn read_plain(
        &self,
        source: &mut Source,
        remedy: &'static str,
    ) -> Result<Voxels, LoadError> {
        self.claim().check_held(source, source.remaining())?;
        self.read(source).map_err(|fault| source.fault(fault, remedy))
    }

    /// Reads voxels that follow `gap` bytes of a compressed stream.
    #[cfg(any(feature = "metaimage", feature = "nifti", feature = "nrrd"))]
    pub(crate) fn read_packed(
        &self,
        source: &mut Source,
        compression: Compression,
        gap: u64,
        remedy: &'static str,
    ) -> Result<Voxels, LoadError> {
        self.claim().check_packed(source, source.remaining())?;
        let read = match compression {
            Compression::Gzip => {
                self.read_behind(gap, &mut flate2::bufread::MultiGzDecoder::new(&mut *source))
            }
            Compression::Zlib => {
                self.read_behind(gap, &mut flate2::bufread::ZlibDecoder::new(&mut *source))
            }
        };
        read.map_err(|fault| source.fault(fault, remedy))
    }

    fn read_behind(&self, gap: u64, stream: &mut dyn Read) -> Result<Voxels, Fault> {
        if gap > LONGEST_GAP {
            let what =
                format!("its voxels begin at byte {gap}, at most {LONGEST_GAP} are supported");
            return Err(Fault::Bad(what));
        }
        let skipped = std::io::copy(&mut (&mut *stream).take(gap), &mut std::io::sink())?;
        if skipped < gap {
            return Err(Fault::Cut(format!(
                "{skipped} of {gap} bytes before the voxels are there"
            )));
        }
        self.read_to_end(stream)
    }

    /// Reads voxels, and the sum of a compressed stream that ends with them.
    pub(crate) fn read_to_end(&self, stream: &mut dyn Read) -> Result<Voxels, Fault> {
        let voxels = self.read(stream)?;
        // What follows is passed over; at the end the decoder compares sums.
        let _ = stream.read(&mut [0])?;
        Ok(voxels)
    }

    /// Reads voxels. The caller has held their count against the file.
    pub(crate) fn read(&self, stream: &mut dyn Read) -> Result<Voxels, Fault> {
        Ok(match self.kind {
            VoxelType::U8 => Voxels::U8(self.numbers(stream, u8::from_le_bytes)?),
            VoxelType::U16 => Voxels::U16(self.numbers(stream, u16::from_le_bytes)?),
            VoxelType::I16 => Voxels::I16(self.numbers(stream, i16::from_le_bytes)?),
            VoxelType::F32 => Voxels::F32(self.numbers(stream, f32::from_le_bytes)?),
            VoxelType::I8 => self.least(stream, |b| i8::from_le_bytes(b).into())?,
            VoxelType::U32 => self.least(stream, |b| u32::from_le_bytes(b).into())?,
            VoxelType::I32 => self.least(stream, |b| i32::from_le_bytes(b).into())?,
            VoxelType::U64 => self.least(stream, |b| u64::from_le_bytes(b) as f64)?,
            VoxelType::I64 => self.least(stream, |b| i64::from_le_bytes(b) as f64)?,
            VoxelType::F64 => self.least(stream, f64::from_le_bytes)?,
        })
    }

    /// Numbers of a type that is kept.
    fn numbers<T, const N: usize>(
        &self,
        stream: &mut dyn Read,
        from_le: impl Fn([u8; N]) -> T,
    ) -> Result<Vec<T>, Fault> {
        let mut numbers = self.room()?;
        self.each(stream, |bytes| {
            numbers.push(from_le(bytes));
            Ok(())
        })?;
        Ok(numbers)
    }

    /// Numbers of a type that is not kept.
    fn least<const N: usize>(
        &self,
        stream: &mut dyn Read,
        from_le: impl Fn([u8; N]) -> f64,
    ) -> Result<Voxels, Fault> {
        let mut least = Least::new(self.room()?);
        self.each(stream, |bytes| least.push(self, from_le(bytes)))?;
        Ok(least.voxels)
    }

    /// Calls `add` with the little-endian bytes of each number.
    fn each<const N: usize>(
        &self,
        stream: &mut dyn Read,
        mut add: impl FnMut([u8; N]) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let mut buffer = [0; 1 << 14];
        let (bytes, mut done) = (self.bytes(), 0);
        while done < bytes {
            let part = (bytes - done).min(buffer.len() as u64) as usize;
            let part = &mut buffer[..part];
            fill(stream, part, |held| {
                let held = (done + held) / N as u64;
                format!("{held} of {} voxels are there", self.count())
            })?;
            for number in part.as_chunks::<N>().0 {
                let mut number = *number;
                if self.order == ByteOrder::Big {
                    number.reverse();
                }
                add(number)?;
            }
            done += part.len() as u64;
        }
        Ok(())
    }

    /// Reads voxels that are numbers of a text, with white space between them.
    pub(crate) fn read_text(&self, stream: &mut dyn BufRead) -> Result<Voxels, Fault> {
        let mut least = Least::new(Vec::new());
        match self.kind {
            VoxelType::U8 => least.voxels = Voxels::U8(self.room()?),
            VoxelType::U16 => least.voxels = Voxels::U16(self.room()?),
            VoxelType::I16 => least.voxels = Voxels::I16(self.room()?),
            VoxelType::F32 => least.voxels = Voxels::F32(self.room()?),
            _ => least.voxels = Voxels::U8(self.room()?),
        }
        let mut word = Vec::new();
        for i in 0..self.count() {
            if !next_word(stream, &mut word)? {
                return Err(Fault::Cut(format!("{i} of {} voxels are there", self.count())));
            }
            let number = str::from_utf8(&word).ok().and_then(|word| word.parse::<f64>().ok());
            let Some(number) = number.filter(|n| self.kind.has(*n)) else {
                let (word, kind) = (word_text(&word), self.kind.name());
                return Err(Fault::Bad(format!("voxel {i}, '{word}', is no {kind}")));
            };
            least.push(self, number)?;
        }
        Ok(least.voxels)
    }

    /// An empty list with room for all.
    pub(crate) fn room<T>(&self) -> Result<Vec<T>, Fault> {
        let (mut list, count) = (Vec::new(), self.count());
        list.try_reserve_exact(count as usize).map_err(|_| Fault::NoRoom {
            what: "voxel",
            count,
            remedy: CROP,
        })?;
        Ok(list)
    }

    /// A volume with nothing known but its voxels and its place.
    pub(crate) fn volume(&self, voxels: Voxels, to_world: Affine3) -> VolumeFile {
        VolumeFile {
            size: self.size,
            to_world,
            is_cell_centred: true,
            voxels,
            scale: 1.0,
            offset: 0.0,
            no_data: None,
        }
    }
}

/// Fills `bytes`, or tells what is missing, by how many are there.
pub(crate) fn fill(
    stream: &mut dyn Read,
    bytes: &mut [u8],
    missing: impl Fn(u64) -> String,
) -> Result<(), Fault> {
    let mut held = 0;
    while held < bytes.len() {
        match stream.read(&mut bytes[held..]) {
            Ok(0) => return Err(Fault::Cut(missing(held as u64))),
            Ok(n) => held += n,
            Err(e) if e.kind() == std::io::ErrorKind::Interrupted => {}
            Err(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
                return Err(Fault::Cut(missing(held as u64)));
            }
            Err(e) => return Err(e.into()),
        }
    }
    Ok(())
}

/// Reads the next word of a text; false at its end.
pub(crate) fn next_word(stream: &mut dyn BufRead, word: &mut Vec<u8>) -> Result<bool, Fault> {
    word.clear();
    loop {
        let bytes = stream.fill_buf()?;
        let is_space = u8::is_ascii_whitespace;
        let space = match word.is_empty() {
            true => bytes.iter().take_while(|b| is_space(b)).count(),
            false => 0,
        };
        let letters = bytes[space..].iter().take_while(|b| !is_space(b)).count();
        word.extend(bytes[space..][..letters].iter().take(LONGEST_WORD + 1));
        if word.len() > LONGEST_WORD {
            let what = format!("a number is longer than {LONGEST_WORD} letters");
            return Err(Fault::Bad(what));
        }
        let (at_end, taken) = (bytes.is_empty(), space + letters);
        let ends = taken < bytes.len();
        stream.consume(taken);
        if at_end || ends {
            return Ok(!word.is_empty());
        }
    }
}

/// Numbers in the smallest type that holds all so far.
struct Least {
    voxels: Voxels,
    greatest: f64,
}

impl Least {
    fn new(empty: Vec<u8>) -> Self {
        Self { voxels: Voxels::U8(empty), greatest: 0.0 }
    }

    fn push(&mut self, payload: &Payload, number: f64) -> Result<(), Fault> {
        match &mut self.voxels {
            Voxels::U8(v) if VoxelType::U8.has(number) => v.push(number as u8),
            Voxels::U16(v) if VoxelType::U16.has(number) => v.push(number as u16),
            Voxels::I16(v) if VoxelType::I16.has(number) => v.push(number as i16),
            Voxels::F32(v) => v.push(number as f32),
            _ => {
                self.widen(payload, number)?;
                return self.push(payload, number);
            }
        }
        self.greatest = self.greatest.max(number);
        Ok(())
    }

    /// Takes a larger type, which has `number` too.
    fn widen(&mut self, payload: &Payload, number: f64) -> Result<(), Fault> {
        let all = |kind: VoxelType| kind.has(number) && kind.has(self.greatest);
        self.voxels = match &self.voxels {
            Voxels::U8(v) if all(VoxelType::U16) => {
                Voxels::U16(widened(payload, v, |n| u16::from(*n))?)
            }
            Voxels::U8(v) if all(VoxelType::I16) => {
                Voxels::I16(widened(payload, v, |n| i16::from(*n))?)
            }
            // None of these is above what the other holds: `greatest` is not.
            Voxels::U16(v) if all(VoxelType::I16) => {
                Voxels::I16(widened(payload, v, |n| *n as i16)?)
            }
            Voxels::U8(v) => Voxels::F32(widened(payload, v, |n| f32::from(*n))?),
            Voxels::U16(v) => Voxels::F32(widened(payload, v, |n| f32::from(*n))?),
            Voxels::I16(v) => Voxels::F32(widened(payload, v, |n| f32::from(*n))?),
            Voxels::F32(_) => return Ok(()),
        };
        Ok(())
    }
}

fn widened<T, U>(payload: &Payload, from: &[T], to: impl Fn(&T) -> U) -> Result<Vec<U>, Fault> {
    let mut list = payload.room()?;
    list.extend(from.iter().map(to));
    Ok(list)
}

/// The map from indices to the world, by the steps along each axis and the place of the first
/// voxel. None if it is not finite, or its inverse is not: there is none, or steps are too small.
pub(crate) fn place(axes: [[f64; 3]; 3], origin: [f64; 3]) -> Option<Affine3> {
    let vector = |v: [f64; 3]| Vec3::from(v.map(|x| x as f32));
    let [x, y, z] = axes.map(vector);
    let map = Affine3::from_cols(x, y, z, vector(origin));
    // In `f32` the determinant of steps of a picometre is 0.
    let inverse = map.as_daffine3().inverse().as_affine3();
    (map.is_finite() && inverse.is_finite()).then_some(map)
}

/// Opens the file with the voxels, which a header names; it is beside the header or below.
pub(crate) fn open_beside(header: &Source, name: &str) -> Result<Source, LoadError> {
    let named = Path::new(name);
    let is_below =
        named.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
    if name.is_empty() || !is_below {
        let what = format!("its voxels are in '{}'", word_text(name.as_bytes()));
        let remedy = "move that file beside the header, and write its name alone";
        return Err(header.corrupt(crate::Place::Line(header.line), what, remedy));
    }
    let folder = header.path.parent().unwrap_or(Path::new(""));
    Source::open(&folder.join(named), header.format)
}
