//! Texture errors.

use thiserror::Error;

/// Error of creating a texture.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum TextureError {
    /// An axis has no texels.
    #[error("axis {axis} of the texture has no texels: give every axis at least 1")]
    NoTexels {
        /// The axis, from 0.
        axis: usize,
    },
    /// An axis has more than [`MAX_SIZE`](super::MAX_SIZE) texels.
    #[error(
        "axis {axis} of the texture has {size} texels, and positions along an axis are exact for \
         {limit} at most: split the texture, or fold a long one into two dimensions"
    )]
    TooLong {
        /// The axis, from 0.
        axis: usize,
        /// Number of its texels.
        size: u32,
        /// Maximum number of texels.
        limit: u32,
    },
    /// There are more than [`MAX_TEXELS`](super::MAX_TEXELS) texels.
    #[error(
        "the texture has {count} texels with its levels, and kernels index {limit} at most: split \
         it"
    )]
    TooManyTexels {
        /// Number of texels.
        count: u128,
        /// Maximum number of texels.
        limit: u64,
    },
    /// The length of the slice does not match the size.
    #[error(
        "a texture of {expected} texels (the product of its sizes) was given {found}: pass a slice \
         of exactly that many, the first axis running fastest"
    )]
    WrongLength {
        /// The product of the sizes.
        expected: u64,
        /// The length of the slice.
        found: usize,
    },
    /// There is no memory for levels or coefficients.
    #[error("no memory for {bytes} bytes of texels: use a smaller texture or smaller texels")]
    OutOfMemory {
        /// Number of bytes requested.
        bytes: u64,
    },
}
