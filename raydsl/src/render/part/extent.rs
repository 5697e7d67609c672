//! Extents: which pixels and which samples a part of a film has.

use core::ops::Range;

use glam::{UVec2, uvec2};

use super::error::PartError;
use crate::render::renderer::LARGEST_PASS;

/// The number of samples of a pixel that are summed where they are computed. Parts of films begin at
/// multiples of it.
pub const SAMPLE_BLOCK: u32 = LARGEST_PASS;

/// The pixels and the samples of a part of a film: a window, and a range of samples that begins at a
/// multiple of [`SAMPLE_BLOCK`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct FilmExtent {
    film: UVec2,
    origin: UVec2,
    size: UVec2,
    samples: Range<u32>,
}

impl FilmExtent {
    /// Creates the extent of `size` pixels, the lower left one at `origin`, of a film of `film`
    /// pixels.
    ///
    /// # Errors
    ///
    /// [`PartError::Window`] if the window has no pixel or is not within the film;
    /// [`PartError::Samples`] if there is no sample, or the first is no multiple of
    /// [`SAMPLE_BLOCK`].
    pub fn new(
        film: UVec2,
        origin: UVec2,
        size: UVec2,
        samples: Range<u32>,
    ) -> Result<Self, PartError> {
        let fits = |origin: u32, size: u32, film: u32| {
            size > 0 && origin.checked_add(size).is_some_and(|end| end <= film)
        };
        if !(fits(origin.x, size.x, film.x) && fits(origin.y, size.y, film.y)) {
            return Err(PartError::Window { origin, size, film });
        }
        if samples.start >= samples.end || !samples.start.is_multiple_of(SAMPLE_BLOCK) {
            return Err(PartError::Samples { start: samples.start, end: samples.end });
        }
        Ok(Self { film, origin, size, samples })
    }

    /// Returns the size of the whole film in pixels.
    pub fn film(&self) -> UVec2 {
        self.film
    }

    /// Returns the column and the row of the window's lower left pixel.
    pub fn origin(&self) -> UVec2 {
        self.origin
    }

    /// Returns the width and the height of the window.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Returns the indices of the samples.
    pub fn samples(&self) -> Range<u32> {
        self.samples.clone()
    }

    /// Returns the number of samples of all pixels together.
    pub fn total_samples(&self) -> u64 {
        self.area() as u64 * u64::from(self.samples.end - self.samples.start)
    }

    /// Returns the number of pixels.
    pub(super) fn area(&self) -> usize {
        self.size.x as usize * self.size.y as usize
    }

    /// Returns the indices of the blocks of samples.
    pub(super) fn blocks(&self) -> Range<u32> {
        self.samples.start / SAMPLE_BLOCK..self.samples.end.div_ceil(SAMPLE_BLOCK)
    }

    /// Returns the samples of a block; the last one may have fewer than the others.
    pub(super) fn samples_of(&self, block: u32) -> Range<u32> {
        let start = block * SAMPLE_BLOCK;
        start..start.saturating_add(SAMPLE_BLOCK).min(self.samples.end)
    }

    /// Returns the extent of both, if `next` has the same window and the samples behind.
    pub(super) fn followed_by(&self, next: &Self) -> Option<Self> {
        let is_same = (self.film, self.origin, self.size) == (next.film, next.origin, next.size);
        let follows = is_same && self.samples.end == next.samples.start;
        follows.then_some(Self { samples: self.samples.start..next.samples.end, ..*self })
    }

    /// Returns the indices of the window's pixels in the film, row by row.
    pub(super) fn pixel_indices(&self) -> impl Iterator<Item = usize> + use<> {
        let (UVec2 { x, y }, UVec2 { x: width, y: height }) = (self.origin, self.size);
        let stride = self.film.x as usize;
        (y..y + height).flat_map(move |row| {
            let first = row as usize * stride + x as usize;
            first..first + width as usize
        })
    }

    /// Returns the column and the row of a pixel of the film.
    pub(super) fn pixel(&self, index: usize) -> UVec2 {
        let width = self.film.x as usize;
        uvec2((index % width) as u32, (index / width) as u32)
    }
}
