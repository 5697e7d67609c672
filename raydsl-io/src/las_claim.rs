//! What LAS and LAZ files claim about themselves. The decoders allocate by counts in the
//! file before they find its end; here those counts are held against its length.

use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::ops::Range;

use crate::las::File;
use crate::source::Source;
use crate::{LoadError, Place};

/// Where a LAS 1.4 header holds the place and number of extended records.
const EXTENDED_RECORDS: Range<u64> = 235..247;

/// What a header claims, and how many points the file's length can bear.
pub(crate) struct Claim {
    pub(crate) points: u64,
    pub(crate) credible: u64,
    pub(crate) compressed: bool,
    /// Where the points start.
    pub(crate) start: u64,
    /// Bytes of a point before compression.
    pub(crate) record: u64,
}

impl Claim {
    /// Reads a header and leaves the source at its start.
    pub(crate) fn inspect(source: &mut Source, file: File<'_>) -> Result<Self, LoadError> {
        let header = ::las::raw::Header::read_from(&mut *source).map_err(|e| file.las_error(e))?;
        source.rewind().map_err(|e| file.io_error(&e))?;
        let large = header.large_file.map_or(0, |l| l.number_of_point_records);
        let points = match header.number_of_point_records {
            0 => large,
            n => u64::from(n),
        };
        let (start, len) = (u64::from(header.offset_to_point_data), source.len);
        if start > len {
            let what = format!("the points begin at byte {start} of {len}");
            return Err(file.truncated(what));
        }
        let record = u64::from(header.point_data_record_length);
        // The two high bits of the format mark compression.
        let compressed = header.point_data_record_format & 0xc0 != 0;
        let held = (len - start) / record.max(1);
        if !compressed && held < points {
            return Err(file.truncated(format!("{held} of {points} points are there")));
        }
        // Compressed points take more than a byte, but in degenerate files, which may grow.
        let credible = if compressed { len } else { held };
        Ok(Self { points, credible, compressed, start, record })
    }
}

/// Whether compressed points come in chunks, as in all files but the earliest.
pub(crate) fn chunked(header: &::las::Header) -> bool {
    const POINTWISE: [u8; 2] = [1, 0];
    let vlr = header.vlrs().iter().find(|v| ::las::laz::is_laszip_vlr(v));
    vlr.is_some_and(|v| !v.data.starts_with(&POINTWISE))
}

/// Holds the count of the chunk table, by which the decoder allocates, against the file's
/// length; gives the range of the chunks.
pub(crate) fn check_chunks(
    source: &mut Source,
    file: File<'_>,
    start: u64,
) -> Result<Range<u64>, LoadError> {
    let len = source.len;
    let mut read_at = |at: SeekFrom| {
        let mut word = [0; 8];
        let result = source.seek(at).and_then(|_| source.read_exact(&mut word));
        result.map(|()| word).map_err(|e| file.io_error(&e))
    };
    let mut table = i64::from_le_bytes(read_at(SeekFrom::Start(start))?);
    if table <= start as i64 {
        // A writer that could not seek puts the table's place at the end of the file.
        table = i64::from_le_bytes(read_at(SeekFrom::End(-8))?);
    }
    let table = u64::try_from(table).unwrap_or(0);
    if !(start..len).contains(&table) {
        return Err(file.truncated("the table of its compressed chunks is missing".into()));
    }
    let [_, _, _, _, count @ ..] = read_at(SeekFrom::Start(table))?;
    let count = u64::from(u32::from_le_bytes(count));
    if count > len {
        let what = format!("it lists {count} chunks in {len} bytes");
        return Err(file.corrupt(Place::Byte(table + 4), what));
    }
    Ok(start + 8..table)
}

/// A file as the decoders may see it.
///
/// The extended records, which would be loaded whole with a length from the file, are
/// hidden; a picture needs none of them. Sizes of compressed layers, for which the decoder
/// would zero up to 4 GiB each, must not exceed the file.
pub(crate) struct Masked {
    pub(crate) source: Source,
    /// Where chunks are; empty when there are none.
    pub(crate) chunks: Range<u64>,
    at: u64,
    /// Whether the header has extended records at all.
    extended: bool,
    /// 4-byte reads in a row, and how many of them are no sizes.
    words: u32,
    exempt: u32,
}

impl Masked {
    pub(crate) fn new(mut source: Source, record: u64) -> io::Result<Self> {
        let mut start = [0; 105];
        source.read_exact(&mut start)?;
        source.rewind()?;
        let extended = start[24] == 1 && start[25] >= 4;
        // A layered chunk is its first point, field by field, the number of its points, and
        // the layers' sizes. Extra bytes of a point may be a 4-byte read of their own.
        let plain = ::las::point::Format::new(start[104]).map_or(0, |f| u64::from(f.len()));
        let exempt = if record == plain + 4 { 2 } else { 1 };
        Ok(Self { source, chunks: 0..0, at: 0, extended, words: 0, exempt })
    }

    fn hide(&self, buf: &mut [u8]) {
        if !self.extended || self.at >= EXTENDED_RECORDS.end {
            return;
        }
        for (at, byte) in (self.at..).zip(buf) {
            if EXTENDED_RECORDS.contains(&at) {
                *byte = 0;
            }
        }
    }

    fn check_size(&mut self, buf: &[u8]) -> io::Result<()> {
        let word = buf.try_into().ok().filter(|_| self.chunks.contains(&self.at));
        let Some(word) = word else {
            self.words = 0;
            return Ok(());
        };
        self.words += 1;
        let size = u64::from(u32::from_le_bytes(word));
        if self.words > self.exempt && size > self.source.len {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        Ok(())
    }
}

impl Read for Masked {
    fn read(&mut self, buf: &mut [u8]) -> io::Result<usize> {
        let n = self.source.read(buf)?;
        self.words = 0;
        self.hide(&mut buf[..n]);
        self.at += n as u64;
        Ok(n)
    }

    fn read_exact(&mut self, buf: &mut [u8]) -> io::Result<()> {
        self.source.read_exact(buf)?;
        self.hide(buf);
        self.check_size(buf)?;
        self.at += buf.len() as u64;
        Ok(())
    }
}

impl Seek for Masked {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.at = self.source.seek(to)?;
        Ok(self.at)
    }
}
