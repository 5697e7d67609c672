//! Build errors.

use thiserror::Error;

/// Error of a tree build.
///
/// Of several invalid primitives, the one with the smallest index is reported.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BuildError {
    /// There are more primitives than [`MAX_PRIMITIVES`](super::MAX_PRIMITIVES).
    #[error(
        "{count} primitives are too many for one tree: split them into trees of at most {limit}"
    )]
    TooManyPrimitives {
        /// Number of primitives.
        count: usize,
        /// Maximum number of primitives.
        limit: usize,
    },
    /// A bound is not a number.
    #[error(
        "the bounds of primitive {index} contain NaN: repair or remove the primitive (an indexed \
         triangle has such bounds if a vertex is not there)"
    )]
    NanBounds {
        /// Index of the primitive.
        index: usize,
    },
    /// A bound is infinite.
    #[error(
        "the bounds of primitive {index} are infinite: clip the primitive to a finite box or remove it"
    )]
    InfiniteBounds {
        /// Index of the primitive.
        index: usize,
    },
    /// A lower bound is above the upper one.
    #[error(
        "the bounds of primitive {index} are inverted (min > max): order the corners or remove the primitive"
    )]
    InvertedBounds {
        /// Index of the primitive.
        index: usize,
    },
    /// A field of the configuration is out of range.
    #[error("BuildConfig::{field} is {value}: choose a value in {range}")]
    InvalidConfig {
        /// The field.
        field: &'static str,
        /// Its value.
        value: f64,
        /// Its valid range.
        range: &'static str,
    },
    /// The observer cancelled the build.
    #[error("the build was stopped by its observer")]
    Cancelled,
}
