//! Errors of measurements.

use std::path::PathBuf;

/// The largest value of a knob: 2^24. Up to there a number of samples is exact as a float.
pub const MAX_KNOB: u32 = 1 << 24;

/// The reason why there is no [`Report`](super::Report), or none on disk.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WorkPrecisionError {
    /// A required list is empty.
    #[error("there is no {what} to measure; give at least one")]
    Nothing {
        /// The list.
        what: &'static str,
    },
    /// A case's name is empty or used by another case.
    #[error("case `{case}`: its name is empty or that of another case; rename it")]
    Name {
        /// The case.
        case: String,
    },
    /// The knob's values do not rise from at least 1 to at most [`MAX_KNOB`].
    #[error(
        "the knob's value {value} is out of order; give values that rise, from 1 to {MAX_KNOB}"
    )]
    Knob {
        /// The wrong value.
        value: u32,
    },
    /// The film has no pixels, or more than 2^24.
    #[error("a film of {width} by {height} pixels; give at least 1 and at most 2^24 pixels")]
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The reference has a number that is not finite.
    #[error("case `{case}`: number {index} of its reference is {value}; give finite numbers")]
    Reference {
        /// The case.
        case: String,
        /// The index of the number.
        index: usize,
        /// The number.
        value: f64,
    },
    /// The reference's uncertainty is NaN, infinite or negative.
    #[error("case `{case}`: an uncertainty of {value}; give a finite number of at least 0")]
    Uncertainty {
        /// The case.
        case: String,
        /// The given value.
        value: f64,
    },
    /// A run's number of estimates differs from the reference's.
    #[error(
        "case `{case}`, {method} at {knob}: {found} estimates, but the reference has {expected} \
         numbers; give one number for all, or one for each pixel"
    )]
    Length {
        /// The case.
        case: String,
        /// The method.
        method: String,
        /// The knob's value.
        knob: u32,
        /// The number of estimates.
        found: usize,
        /// The number of the reference's values.
        expected: usize,
    },
    /// A plot cannot be drawn.
    #[cfg(feature = "png")]
    #[error(transparent)]
    Png(#[from] super::PngError),
    /// A file cannot be written.
    #[error("cannot write {}: {source}; choose another folder", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
}
