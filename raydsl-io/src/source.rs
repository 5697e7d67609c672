//! An open file, and how far it has been read.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use crate::error::one_line;
use crate::stop::{self, Stoppable, is_stopped};
use crate::{LoadError, Place};

/// Longer lines are a sign that the file is no text.
const LONGEST: u64 = 1 << 20;

/// An open file, its length and the place that is read next.
pub(crate) struct Source {
    pub(crate) path: PathBuf,
    /// What errors call its format.
    pub(crate) format: &'static str,
    pub(crate) len: u64,
    /// The line that was read last, from 1.
    pub(crate) line: u64,
    /// The byte that is read next.
    pub(crate) at: u64,
    file: BufReader<Stoppable>,
}

/// What may be wrong with data that are decoded from a source.
pub(crate) enum Fault {
    Cut(String),
    Bad(String),
    NoRoom { what: &'static str, count: u64, remedy: &'static str },
    Io(io::Error),
}

impl From<io::Error> for Fault {
    fn from(e: io::Error) -> Self {
        Self::Io(e)
    }
}

impl Source {
    pub(crate) fn open(path: &Path, format: &'static str) -> Result<Self, LoadError> {
        let refuse = |source: io::Error| match source.kind() {
            ErrorKind::NotFound => LoadError::Missing { path: path.into() },
            _ => LoadError::Unreadable { path: path.into(), source },
        };
        // Asked before it is opened: a pipe waits for a writer, and has no length.
        let meta = fs::metadata(path).map_err(refuse)?;
        if meta.is_dir() {
            return Err(refuse(ErrorKind::IsADirectory.into()));
        }
        if !meta.is_file() {
            return Err(refuse(io::Error::other("a device or a pipe")));
        }
        let file = File::open(path).map_err(refuse)?;
        let file = BufReader::with_capacity(stop::MOST, Stoppable::new(file));
        Ok(Self { path: path.into(), format, len: meta.len(), line: 0, at: 0, file })
    }

    /// Bytes that are not read yet.
    pub(crate) fn remaining(&self) -> u64 {
        self.len.saturating_sub(self.at)
    }

    /// Reads a line into `line`, with its end; false at the end of the file.
    pub(crate) fn next_line(&mut self, line: &mut Vec<u8>) -> Result<bool, LoadError> {
        line.clear();
        let read = (&mut self.file).take(LONGEST).read_until(b'\n', line);
        let n = read.map_err(|e| self.unreadable(e))? as u64;
        self.at += n;
        self.line += 1;
        if n == LONGEST && line.last() != Some(&b'\n') {
            let what = format!("the line is longer than {LONGEST} bytes");
            return Err(self.bad_line(what, "check that the file is text"));
        }
        Ok(n > 0)
    }

    /// Fills `bytes`; false where the file ends before.
    pub(crate) fn fill(&mut self, bytes: &mut [u8]) -> Result<bool, LoadError> {
        match self.file.read_exact(bytes) {
            Ok(()) => {
                self.at += bytes.len() as u64;
                Ok(true)
            }
            Err(e) if e.kind() == ErrorKind::UnexpectedEof => Ok(false),
            Err(e) => Err(self.unreadable(e)),
        }
    }

    /// Passes over bytes; false where the file ends before.
    pub(crate) fn skip(&mut self, count: u64) -> Result<bool, LoadError> {
        let Some(step) = i64::try_from(count).ok().filter(|_| count <= self.remaining()) else {
            return Ok(false);
        };
        self.file.seek_relative(step).map_err(|e| self.unreadable(e))?;
        self.at += count;
        Ok(true)
    }

    /// Whether what is read next begins so.
    pub(crate) fn starts_with(&mut self, bytes: &[u8]) -> Result<bool, LoadError> {
        match self.file.fill_buf() {
            Ok(next) => Ok(next.starts_with(bytes)),
            Err(e) => Err(self.unreadable(e)),
        }
    }

    /// Reads next what is at a byte; false where the file ends before.
    pub(crate) fn go_to(&mut self, at: u64) -> Result<bool, LoadError> {
        if at > self.len {
            return Ok(false);
        }
        self.seek(SeekFrom::Start(at)).map_err(|e| self.unreadable(e))?;
        Ok(true)
    }

    /// Reads what is left, at most as many bytes as the file had when it was opened.
    pub(crate) fn rest(&mut self) -> Result<Vec<u8>, LoadError> {
        let (mut bytes, count) = (Vec::new(), self.remaining());
        let room = usize::try_from(count).ok();
        if room.is_none_or(|room| bytes.try_reserve_exact(room).is_err()) {
            let remedy = "use a machine with more memory, or make it smaller";
            let path = self.path.clone();
            return Err(LoadError::OutOfMemory { path, what: "byte", count, remedy });
        }
        let read = self.take(count).read_to_end(&mut bytes);
        read.map_err(|e| self.unreadable(e))?;
        Ok(bytes)
    }

    fn unreadable(&self, source: io::Error) -> LoadError {
        self.unless_stopped(LoadError::Unreadable { path: self.path.clone(), source })
    }

    fn unless_stopped(&self, error: LoadError) -> LoadError {
        if is_stopped() { LoadError::Stopped { path: self.path.clone() } } else { error }
    }

    pub(crate) fn truncated(&self, what: String) -> LoadError {
        let path = self.path.clone();
        self.unless_stopped(LoadError::Truncated { path, len: self.len, what })
    }

    pub(crate) fn corrupt(&self, place: Place, what: String, remedy: &'static str) -> LoadError {
        let (path, format) = (self.path.clone(), self.format);
        self.unless_stopped(LoadError::Corrupt { path, place, format, what, remedy })
    }

    /// What a stream over this source met.
    pub(crate) fn fault(&self, fault: Fault, remedy: &'static str) -> LoadError {
        let (source, text) = match fault {
            Fault::Cut(what) => return self.truncated(what),
            Fault::Bad(what) => return self.corrupt(Place::Byte(self.at), what, remedy),
            Fault::NoRoom { what, count, remedy } => {
                let path = self.path.clone();
                return LoadError::OutOfMemory { path, what, count, remedy };
            }
            Fault::Io(e) => {
                let text = one_line(&e);
                (e, text)
            }
        };
        match source.kind() {
            ErrorKind::UnexpectedEof => self.truncated("it ends within its header or data".into()),
            // Decoders say so of what they cannot decode.
            ErrorKind::InvalidInput | ErrorKind::InvalidData => {
                self.corrupt(Place::Byte(self.at), text, remedy)
            }
            _ => self.unreadable(source),
        }
    }

    /// Something is wrong with the line that was read last.
    pub(crate) fn bad_line(&self, what: String, remedy: &'static str) -> LoadError {
        self.corrupt(Place::Line(self.line), what, remedy)
    }
}

impl Read for Source {
    fn read(&mut self, buf: &mut [u8]) -> io::Result<usize> {
        let n = self.file.read(buf)?;
        self.at += n as u64;
        Ok(n)
    }

    fn read_exact(&mut self, buf: &mut [u8]) -> io::Result<()> {
        self.file.read_exact(buf)?;
        self.at += buf.len() as u64;
        Ok(())
    }
}

impl BufRead for Source {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.file.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.file.consume(count);
        self.at += count as u64;
    }
}

impl Seek for Source {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.at = self.file.seek(to)?;
        Ok(self.at)
    }
}
