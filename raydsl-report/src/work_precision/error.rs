//! What cannot be measured, and why.

use std::path::PathBuf;

/// The largest value of a knob: 2^24. Up to there a count of samples is a float without an error.
pub const MAX_KNOB: u32 = 1 << 24;

/// Why there is no [`Report`](super::Report), or none on disk.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WorkPrecisionError {
    /// A list that must not be empty is.
    #[error("there is no {what} to measure; give at least one")]
    Nothing {
        /// What is missing.
        what: &'static str,
    },
    /// A case's name is that of another one, or empty.
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
        /// The value that is wrong.
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
    /// The reference is no number.
    #[error("case `{case}`: number {index} of its reference is {value}; give finite numbers")]
    Reference {
        /// The case.
        case: String,
        /// Which number.
        index: usize,
        /// What it is.
        value: f64,
    },
    /// The reference's uncertainty is NaN, infinite or negative.
    #[error("case `{case}`: an uncertainty of {value}; give a finite number of at least 0")]
    Uncertainty {
        /// The case.
        case: String,
        /// What was given.
        value: f64,
    },
    /// A run gave another number of estimates than the reference has.
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
        /// Estimates.
        found: usize,
        /// Numbers of the reference.
        expected: usize,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {source}; choose another folder", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}
