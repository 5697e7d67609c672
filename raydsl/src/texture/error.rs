//! Why there is no texture.

use thiserror::Error;

/// Why a texture cannot be made, and what to do about it.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum TextureError {
    /// An axis without texels.
    #[error("axis {axis} of the texture has no texels: give every axis at least 1")]
    NoTexels {
        /// The axis, from 0.
        axis: usize,
    },
    /// An axis of more than [`MAX_SIZE`](super::MAX_SIZE) texels.
    #[error(
        "axis {axis} of the texture has {size} texels, and positions along an axis are exact for \
         {limit} at most: split the texture, or fold a long one into two dimensions"
    )]
    TooLong {
        /// The axis, from 0.
        axis: usize,
        /// How many texels it has.
        size: u32,
        /// How many it may have.
        limit: u32,
    },
    /// More than [`MAX_TEXELS`](super::MAX_TEXELS) texels.
    #[error(
        "the texture has {count} texels with its levels, and kernels index {limit} at most: split \
         it"
    )]
    TooManyTexels {
        /// How many texels there are.
        count: u128,
        /// How many there may be.
        limit: u64,
    },
    /// A slice that is not as long as the size says.
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
    /// No memory for levels or coefficients.
    #[error("no memory for {bytes} bytes of texels: use a smaller texture or smaller texels")]
    OutOfMemory {
        /// How many bytes were asked for.
        bytes: u64,
    },
}
