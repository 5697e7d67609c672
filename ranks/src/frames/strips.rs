//! Strips of a picture: which rank composites which pixels.

use core::ops::Range;

use glam::UVec2;

/// The division of a picture's pixels, row by row, into as many strips as ranks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strips {
    pixels: u64,
    ranks: u64,
}

impl Strips {
    pub(super) fn new(size: UVec2, ranks: u32) -> Self {
        Self { pixels: u64::from(size.x) * u64::from(size.y), ranks: u64::from(ranks) }
    }

    /// Returns the number of strips.
    pub(super) fn count(&self) -> u32 {
        self.ranks as u32
    }

    /// Returns the pixels of a rank's strip.
    pub(super) fn of(&self, rank: u32) -> Range<u32> {
        let first = |rank: u64| (self.pixels * rank / self.ranks) as u32;
        first(u64::from(rank))..first(u64::from(rank) + 1)
    }
}

/// Returns the pixels of a strip in at most `count` bands, for threads.
pub(super) fn bands(strip: &Range<u32>, count: u32) -> Vec<Range<u32>> {
    let length = (strip.end - strip.start).div_ceil(count.max(1)).max(1);
    let starts = strip.clone().step_by(length as usize);
    starts.map(|start| start..start.saturating_add(length).min(strip.end)).collect()
}

#[cfg(test)]
mod tests {
    use glam::uvec2;

    use super::*;

    #[test]
    fn each_pixel_is_in_one_strip() {
        for (size, ranks) in [(uvec2(7, 3), 1), (uvec2(7, 3), 4), (uvec2(2, 1), 5)] {
            let strips = Strips::new(size, ranks);
            let pixels: Vec<u32> = (0..strips.count()).flat_map(|rank| strips.of(rank)).collect();
            assert!(pixels.into_iter().eq(0..size.x * size.y));
        }
        for (strip, count) in [(3..40, 5), (3..4, 8), (7..7, 2), (0..9, 0)] {
            assert!(bands(&strip, count).into_iter().flatten().eq(strip));
        }
        // The largest picture.
        let strips = Strips::new(uvec2(65_535, 65_535), 1024);
        assert_eq!(strips.of(1023).end, 65_535 * 65_535);
    }
}
