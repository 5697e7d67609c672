//! Sample allocation: a number of samples for each block of a film.

use glam::UVec2;

use crate::kernel;

/// The edge of a block in pixels. It is a multiple of the edge of packets of every width.
pub(crate) const BLOCK: u32 = 16;

/// The number of samples per pixel of each block of a film, row by row from the bottom.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Allocation {
    /// Blocks in a row.
    columns: u32,
    samples: Vec<u32>,
}

impl Allocation {
    /// Creates an allocation; `samples` has one number for each block of a film of this width.
    pub(crate) fn new(width: u32, samples: Vec<u32>) -> Self {
        Self { columns: width.div_ceil(BLOCK), samples }
    }

    /// Returns the number of blocks in a row.
    pub(crate) fn columns(&self) -> u32 {
        self.columns
    }

    /// Returns the number of samples of each block.
    pub(crate) fn samples(&self) -> &[u32] {
        &self.samples
    }

    /// Returns the smallest number of samples of a pixel.
    pub(crate) fn least(&self) -> u32 {
        self.samples.iter().copied().min().unwrap_or(0)
    }

    /// Returns the largest number of samples of a pixel.
    pub(crate) fn most(&self) -> u32 {
        self.samples.iter().copied().max().unwrap_or(0)
    }
}

/// Returns the number of samples of a pixel in all, and how many of them come before `end`.
#[kernel]
#[inline]
pub(super) fn part_of(samples: &[u32], columns: u32, pixel: UVec2, end: u32) -> (u32, u32) {
    let planned = samples[(pixel.y / BLOCK * columns + pixel.x / BLOCK) as usize];
    (planned, planned.min(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_finds_its_block() {
        for (width, height) in [(1u32, 1u32), (16, 16), (17, 33), (40, 5)] {
            let blocks = width.div_ceil(BLOCK) * height.div_ceil(BLOCK);
            let all = Allocation::new(width, (0..blocks).collect());
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                let (planned, end) = part_of(all.samples(), all.columns(), UVec2::new(x, y), 3);
                assert_eq!(planned, y / BLOCK * width.div_ceil(BLOCK) + x / BLOCK);
                assert!(planned < blocks && end == planned.min(3));
            }
            assert_eq!(all.most(), blocks - 1);
        }
    }
}
