//! Blocks of an array, each compressed by itself.

use std::io::{self, BufRead, ErrorKind, Read};

use flate2::{Decompress, FlushDecompress, Status};

/// The bytes of all blocks, one after the other.
pub(super) struct Blocks<'a> {
    stream: &'a mut dyn BufRead,
    /// Lengths of the blocks that follow: compressed, and not.
    blocks: std::vec::IntoIter<(u64, u64)>,
    decoder: Decompress,
    /// Bytes of this block that are not read yet: compressed, and not.
    packed: u64,
    plain: u64,
    has_ended: bool,
}

impl<'a> Blocks<'a> {
    pub(super) fn new(stream: &'a mut dyn BufRead, blocks: Vec<(u64, u64)>) -> Self {
        let (blocks, decoder) = (blocks.into_iter(), Decompress::new(true));
        Self { stream, blocks, decoder, packed: 0, plain: 0, has_ended: true }
    }

    /// Inflates some of this block.
    fn inflate(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let bytes = self.stream.fill_buf()?;
        let held = bytes.len().min(usize::try_from(self.packed).unwrap_or(usize::MAX));
        if held == 0 && self.packed > 0 {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        // The decoder may hold bytes back after the last compressed one.
        let (read, written) = (self.decoder.total_in(), self.decoder.total_out());
        let flush = FlushDecompress::None;
        let status = self.decoder.decompress(&bytes[..held], out, flush);
        let status = status.map_err(|e| io::Error::new(ErrorKind::InvalidData, e))?;
        let read = self.decoder.total_in() - read;
        let written = self.decoder.total_out() - written;
        self.stream.consume(read as usize);
        self.packed -= read;
        self.has_ended = status == Status::StreamEnd;
        if read == 0 && written == 0 && !self.has_ended {
            return Err(bad("a compressed block ends before its last byte"));
        }
        Ok(written as usize)
    }

    /// Reads the sum behind a block's last byte.
    fn finish(&mut self) -> io::Result<()> {
        while !self.has_ended {
            if self.inflate(&mut [0])? > 0 {
                return Err(bad("a compressed block inflates to more bytes than its length"));
            }
        }
        if self.packed > 0 {
            return Err(bad("a compressed block is shorter than its length"));
        }
        Ok(())
    }
}

fn bad(what: &'static str) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, what)
}

impl Read for Blocks<'_> {
    fn read(&mut self, buf: &mut [u8]) -> io::Result<usize> {
        loop {
            if self.plain == 0 {
                self.finish()?;
                let Some(next) = self.blocks.next() else { return Ok(0) };
                (self.packed, self.plain) = next;
                self.decoder.reset(true);
                self.has_ended = false;
                continue;
            }
            if self.has_ended {
                return Err(bad("a compressed block inflates to fewer bytes than its length"));
            }
            let room = buf.len().min(usize::try_from(self.plain).unwrap_or(usize::MAX));
            let written = self.inflate(&mut buf[..room])?;
            self.plain -= written as u64;
            if written > 0 {
                return Ok(written);
            }
        }
    }
}
