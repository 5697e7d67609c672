//! Errors of parts of films.

use glam::UVec2;

use super::{FilmExtent, SAMPLE_BLOCK};

/// Why there is no such part of a film, or parts cannot be joined.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PartError {
    /// A window has no pixel, or is not within the film.
    #[error("a window of {size} pixels at {origin} is none of a film of {film}: keep it within")]
    Window {
        /// The lower left pixel.
        origin: UVec2,
        /// Width and height.
        size: UVec2,
        /// Those of the film.
        film: UVec2,
    },
    /// There is no sample, or a range does not begin where a block does.
    #[error("samples {start} to {end}: begin at a multiple of {SAMPLE_BLOCK}, before the end")]
    Samples {
        /// The first sample.
        start: u32,
        /// The one behind the last.
        end: u32,
    },
    /// Parts to be joined do not follow each other.
    #[error("{next:?} does not follow {first:?}: join the next samples of the same window")]
    Apart {
        /// The extent of the first part.
        first: Box<FilmExtent>,
        /// That of the other.
        next: Box<FilmExtent>,
    },
    /// A part is of a film of another size.
    #[error("a part of a film of {found} pixels is none of a film of {film}")]
    OtherFilm {
        /// Width and height of the film.
        film: UVec2,
        /// Those of the film of the part.
        found: UVec2,
    },
    /// A part lacks the first samples.
    #[error("a part begins with sample {first}: join it to those from sample 0 on")]
    NoBeginning {
        /// The first sample of the part.
        first: u32,
    },
    /// Two parts have a pixel in common.
    #[error(
        "two parts have the pixel {pixel}: join those of one window, and divide into windows \
             that do not overlap"
    )]
    Overlap {
        /// Column and row.
        pixel: UVec2,
    },
    /// Bytes have the wrong length for the extent that they begin with.
    #[error("{found} bytes for a part of a film that takes {expected}: they are damaged")]
    Length {
        /// The number that the extent takes, 32 if there is none.
        expected: u64,
        /// The number given.
        found: u64,
    },
}
