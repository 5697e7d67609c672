//! What can be wrong with a point cloud, in one line each.

use std::fmt::Display;
use std::path::PathBuf;

/// A cloud that cannot be used. The message says what is wrong and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CloudError {
    /// No such file.
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
    /// The file's name does not tell a known format.
    #[error(
        "{}: unknown extension '{extension}'; use .laz, .las, .ply or .xyz, or convert the file, \
         for example with CloudCompare",
        path.display()
    )]
    UnknownExtension {
        /// The file.
        path: PathBuf,
        /// What follows the last dot; empty without a dot.
        extension: String,
    },
    /// The file holds no point.
    #[error("{}: holds no point; check what wrote it", path.display())]
    EmptyFile {
        /// The file.
        path: PathBuf,
    },
    /// A cloud without points was to be rendered.
    #[error("the cloud holds no point; load or make at least one")]
    Empty,
    /// The file ends before its last point.
    #[error(
        "{}: is cut off: {what}; copy or download it again",
        path.display()
    )]
    Truncated {
        /// The file.
        path: PathBuf,
        /// What is missing.
        what: String,
    },
    /// The file contradicts its format.
    #[error(
        "{}: is no valid {format} file: {what}; write it again, for example with {tool}",
        path.display()
    )]
    Corrupt {
        /// The file.
        path: PathBuf,
        /// The format's name.
        format: &'static str,
        /// The contradiction.
        what: String,
        /// A program that writes the format.
        tool: &'static str,
    },
    /// A line of a text file cannot be read as a point.
    #[error("{}:{line}: {what}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: u64,
        /// What is wrong and what to do.
        what: String,
    },
    /// Coordinates that are NaN or infinite.
    #[error(
        "{name}: {count} of {total} points have a coordinate that is not a finite number \
         (the first is point {first}, counted from 0); {remedy}"
    )]
    NotFinite {
        /// The file, or what stands for it.
        name: String,
        /// Points that are not finite.
        count: usize,
        /// All points.
        total: usize,
        /// Index of the first that is not.
        first: usize,
        /// What to do.
        remedy: &'static str,
    },
    /// More points than 32-bit indices can tell apart.
    #[error(
        "{}: claims {points} points, but at most {} are supported; thin or tile it, for example \
         with `pdal translate -f filters.decimation`",
        path.display(), u32::MAX
    )]
    TooManyPoints {
        /// The file.
        path: PathBuf,
        /// The claim.
        points: u64,
    },
    /// The points do not fit into memory.
    #[error(
        "{}: no memory for {points} points; thin or tile it, for example with \
         `pdal translate -f filters.decimation`",
        path.display()
    )]
    OutOfMemory {
        /// The file.
        path: PathBuf,
        /// Points to be held.
        points: u64,
    },
    /// A cloud whose vectors differ in length.
    #[error(
        "the cloud holds {positions} positions but {colors} colours; give every point one colour"
    )]
    LengthMismatch {
        /// Number of positions.
        positions: usize,
        /// Number of colours.
        colors: usize,
    },
    /// A radius that no sphere can have.
    #[error(
        "radius {radius}: is not a positive finite number; give one, or none to have it chosen"
    )]
    BadRadius {
        /// The radius asked for.
        radius: f64,
    },
    /// Centres in f32 would be off by a visible part of the radius.
    #[error(
        "radius {radius}: is too small for a cloud that spans {extent}, 32-bit coordinates cannot \
         resolve it; use at least {minimum}, or remove stray points far from the rest"
    )]
    RadiusTooSmall {
        /// The radius asked for, or chosen.
        radius: f64,
        /// Longest side of the cloud's box.
        extent: f64,
        /// Smallest radius that works.
        minimum: f64,
    },
    /// All points would vanish in a single sphere.
    #[error(
        "radius {radius}: is too large for a cloud that spans {extent}, all points would merge; \
         use at most {maximum}, in the units of the file"
    )]
    RadiusTooLarge {
        /// The radius asked for.
        radius: f64,
        /// Longest side of the cloud's box.
        extent: f64,
        /// Largest radius that works.
        maximum: f64,
    },
    /// The box's sides overflow, or vanish, in 64-bit arithmetic.
    #[error(
        "the cloud spans {extent}, beyond what can be scaled; remove stray points or change its unit"
    )]
    BadExtent {
        /// Longest side of the cloud's box.
        extent: f64,
    },
}

/// The text of an error of another crate, on one line and of bounded length.
pub(super) fn one_line(error: impl Display) -> String {
    let text = error.to_string();
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(160) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line,
    }
}
