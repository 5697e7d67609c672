//! What can be wrong with a file, in one line each.

use std::fmt::{self, Display};
use std::path::PathBuf;

/// Tells why a file cannot be used. The message is one line: the file, the place, what is wrong,
/// and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file does not exist.
    #[error("{}: no such file; check the path", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// The operating system refused to read.
    #[error("{}: cannot be read ({source}); check that it is a file and its permissions", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The refusal.
        source: std::io::Error,
    },
    /// Another thread has ended the loading; see [`stoppable`](crate::stoppable).
    #[error("{}: its loading was stopped; load it again", path.display())]
    Stopped {
        /// The file.
        path: PathBuf,
    },
    /// The file's name does not tell a format.
    #[error("{}: unknown extension '{extension}'; convert the file to one of {known}", path.display())]
    UnknownExtension {
        /// The file.
        path: PathBuf,
        /// What follows the last dot; empty without a dot.
        extension: String,
        /// The extensions that are known.
        known: String,
    },
    /// The format's loader is left out of this build.
    #[error("{}: its loader is left out; enable the feature `{feature}` of raydsl-io", path.display())]
    FeatureOff {
        /// The file.
        path: PathBuf,
        /// The feature that has the loader.
        feature: &'static str,
    },
    /// The file holds nothing that is looked for.
    #[error("{}: holds no {what}; check what wrote it", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// What it should hold: a point, a triangle, a voxel or an array of voxels.
        what: &'static str,
    },
    /// The file ends before its last element.
    #[error("{}: is cut off at byte {len}: {what}; copy or download it again", path.display())]
    Truncated {
        /// The file.
        path: PathBuf,
        /// The file's length in bytes.
        len: u64,
        /// What is missing.
        what: String,
    },
    /// The file has no array of voxels that is looked for, or several.
    #[error("{}: {what}; name one of its arrays of one component: {known}", path.display())]
    NoArray {
        /// The file.
        path: PathBuf,
        /// What is missing.
        what: String,
        /// The arrays that it has, each with its number of components.
        known: String,
    },
    /// The file contradicts its format, or has more than this crate reads of it.
    #[error("{}{place}: is no valid {format}: {what}; {remedy}", path.display())]
    Corrupt {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        place: Place,
        /// The format's name.
        format: &'static str,
        /// The contradiction.
        what: String,
        /// What to do.
        remedy: &'static str,
    },
    /// Coordinates are NaN or infinite.
    #[error(
        "{}: {count} of {total} {what}s have a coordinate that is not a finite number (the first \
         is {what} {first}, counted from 0); {remedy}",
        path.display()
    )]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// What has the coordinates: a point or a triangle.
        what: &'static str,
        /// How many are not finite.
        count: usize,
        /// How many there are.
        total: usize,
        /// Index of the first that is not.
        first: usize,
        /// What to do.
        remedy: &'static str,
    },
    /// More elements than 32-bit indices can tell apart.
    #[error("{}: has {count} {what}s, but at most {limit} are supported; {remedy}", path.display())]
    TooMany {
        /// The file.
        path: PathBuf,
        /// What there is too much of.
        what: &'static str,
        /// How many there are, or how many the file claims.
        count: u64,
        /// How many there may be.
        limit: u64,
        /// What to do.
        remedy: &'static str,
    },
    /// The file needs an extension of its format that this crate does not read.
    #[error("{}: needs the extension {extension}, which is not supported; {remedy}", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
        /// The extension's name.
        extension: String,
        /// What to do.
        remedy: &'static str,
    },
    /// The elements do not fit into memory.
    #[error("{}: no memory for {count} {what}s; {remedy}", path.display())]
    OutOfMemory {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        what: &'static str,
        /// How many there are.
        count: u64,
        /// What to do.
        remedy: &'static str,
    },
}

/// Tells where in a file something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// It is not known: a decoder of another crate does not say where.
    Somewhere,
    /// It is in a line of text, counted from 1.
    Line(u64),
    /// It begins at a byte, counted from 0.
    Byte(u64),
}

impl Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Somewhere => Ok(()),
            Self::Line(line) => write!(f, ":{line}"),
            Self::Byte(byte) => write!(f, ", byte {byte}"),
        }
    }
}

/// The text of a file, or of an error of another crate, on one line and of bounded length.
pub(crate) fn one_line(text: impl Display) -> String {
    let text = text.to_string();
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(160) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line,
    }
}

/// A word of a file, for a message.
pub(crate) fn word_text(word: &[u8]) -> String {
    // A word may be a line of the greatest length; the message has its start.
    one_line(String::from_utf8_lossy(&word[..word.len().min(640)]))
}
