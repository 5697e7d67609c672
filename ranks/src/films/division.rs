//! The division of a film into parts for ranks, and parts as messages.

use std::ops::Range;

use glam::{UVec2, uvec2};
use raydsl::render::{FilmExtent, PartError, SAMPLE_BLOCK};

use super::Job;

/// A window of the film.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Window {
    pub(super) origin: UVec2,
    pub(super) size: UVec2,
}

/// Returns the windows of a film, row by row.
pub(super) fn windows(job: &Job) -> Vec<Window> {
    let Job { film, tile, .. } = *job;
    let counts = uvec2(film.x.div_ceil(tile), film.y.div_ceil(tile));
    let window = |i: u32| {
        let origin = uvec2(i % counts.x, i / counts.x) * tile;
        Window { origin, size: (film - origin).min(UVec2::splat(tile)) }
    };
    (0..counts.x * counts.y).map(window).collect()
}

/// Returns the ranges of samples for ranks within what is missing, divided at multiples of the
/// job's blocks.
pub(super) fn ranges(job: &Job, missing: &[Range<u32>]) -> Vec<Range<u32>> {
    let step = u64::from(SAMPLE_BLOCK) * u64::from(job.blocks);
    let mut ranges = Vec::new();
    for gap in missing {
        let mut start = gap.start;
        while start < gap.end {
            let end = (u64::from(start) / step + 1) * step;
            let end = u32::try_from(end).unwrap_or(u32::MAX).min(gap.end);
            ranges.push(start..end);
            start = end;
        }
    }
    ranges
}

/// Returns the extent of a part of the job.
pub(super) fn extent(
    job: &Job,
    window: Window,
    samples: Range<u32>,
) -> Result<FilmExtent, PartError> {
    FilmExtent::new(job.film, window.origin, window.size, samples)
}

/// Returns the message with a part to render.
pub(super) fn message(extent: &FilmExtent) -> Vec<u8> {
    let (origin, size, samples) = (extent.origin(), extent.size(), extent.samples());
    let words = [origin.x, origin.y, size.x, size.y, samples.start, samples.end];
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Returns the part to render of a message, if it is one of the job.
pub(super) fn extent_of(job: &Job, message: &[u8]) -> Option<FilmExtent> {
    let (words, []) = message.as_chunks::<4>() else { return None };
    let words: [u32; 6] =
        words.iter().copied().map(u32::from_le_bytes).collect::<Vec<_>>().try_into().ok()?;
    let [x, y, width, height, start, end] = words;
    let window = Window { origin: uvec2(x, y), size: uvec2(width, height) };
    extent(job, window, start..end).ok().filter(|_| end <= job.samples)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(tile: u32, blocks: u32) -> Job {
        let description = String::new();
        Job { film: uvec2(70, 33), samples: 1000, tile, blocks, description }
    }

    #[test]
    fn windows_have_each_pixel_once() {
        for tile in [1, 7, 33, 64, 4096] {
            let mut counts = vec![0; 70 * 33];
            for Window { origin, size } in windows(&job(tile, 1)) {
                for (x, y) in (0..size.y).flat_map(|y| (0..size.x).map(move |x| (x, y))) {
                    counts[((origin.y + y) * 70 + origin.x + x) as usize] += 1;
                }
            }
            assert!(counts.iter().all(|n| *n == 1), "{tile}");
        }
    }

    #[test]
    fn ranges_have_each_missing_sample_once() {
        for blocks in [1, 2, 4, 1 << 20] {
            let missing = [64..192, 256..1000];
            let found = ranges(&job(64, blocks), &missing);
            let samples: Vec<u32> = found.iter().cloned().flatten().collect();
            assert_eq!(samples, missing.iter().cloned().flatten().collect::<Vec<_>>());
            assert!(found.iter().all(|range| range.start.is_multiple_of(SAMPLE_BLOCK)));
            assert!(found.iter().all(|range| range.len() as u64 <= u64::from(blocks) * 64));
        }
    }

    #[test]
    fn messages_keep_parts() {
        let job = job(16, 1);
        let part = FilmExtent::new(job.film, uvec2(64, 32), uvec2(6, 1), 64..100).expect("within");
        let bytes = message(&part);
        assert_eq!(extent_of(&job, &bytes), Some(part));
        assert_eq!(extent_of(&job, &[]), None);
        assert_eq!(extent_of(&job, &[255; 24]), None);
        assert_eq!(extent_of(&job, &bytes[..23]), None);
        assert_eq!(extent_of(&job, &[&bytes[..], &[0]].concat()), None);
        let end = job.samples + 1;
        let beyond = FilmExtent::new(job.film, uvec2(64, 32), uvec2(6, 1), 64..end);
        assert_eq!(extent_of(&job, &message(&beyond.expect("within"))), None);
    }
}
