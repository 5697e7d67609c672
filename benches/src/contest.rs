//! What systems have in common that are asked the same rays.

use std::iter::Sum;

use raydsl::prelude::*;
use rayon::prelude::*;

/// The share of the rays whose hits may be others: those that pass through edges.
const OTHER_HITS: f64 = 1e-5;
/// How much the mean distance may be off, as a share.
const OTHER_DISTANCE: f64 = 1e-4;

/// The edge of a tile in pixels.
pub const TILE: u32 = 16;
/// The edge of a block in a tile.
const BLOCK: u32 = 4;

/// Rays that a thread is handed at once.
const PART: usize = 4096;

/// Reads the width and height of a film, a multiple of [`TILE`].
///
/// # Errors
///
/// A sentence with the sizes that there are.
pub fn parse_size(text: &str) -> Result<u32, String> {
    let size = text.parse::<u32>().ok().filter(|n| (TILE..=4096).contains(n) && n % TILE == 0);
    size.ok_or_else(|| "sizes are multiples of 16 up to 4096".to_owned())
}

/// Reads the name of a traversal.
///
/// # Errors
///
/// A sentence with the names that there are.
pub fn parse_traversal(text: &str) -> Result<Traversal, String> {
    let named = Traversal::ALL.into_iter().find(|traversal| traversal.name() == text);
    named.ok_or_else(|| format!("one of {}", Traversal::ALL.map(Traversal::name).join(", ")))
}

/// What asking some rays gave.
#[derive(Clone, Copy, Default)]
pub struct Outcome {
    /// See [`seconds_on`](crate::clock::seconds_on).
    pub seconds: f64,
    /// Rays that met something.
    pub hits: usize,
    /// The sum of the hits' distances, if they are known.
    pub distance: f64,
}

impl Sum for Outcome {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |a, b| Self {
            seconds: a.seconds + b.seconds,
            hits: a.hits + b.hits,
            distance: a.distance + b.distance,
        })
    }
}

impl Outcome {
    /// The mean distance of the hits, if it is known.
    pub fn mean(&self) -> Option<f64> {
        (self.distance > 0.0).then(|| self.distance / self.hits as f64)
    }

    /// Whether two systems met the same, as far as rounding lets them.
    pub fn agrees(&self, expected: &Self, rays: usize) -> bool {
        let others = self.hits.abs_diff(expected.hits) as f64;
        let is_near = match (self.mean(), expected.mean()) {
            (Some(a), Some(b)) => (a - b).abs() <= OTHER_DISTANCE * b,
            (a, b) => a.is_none() && b.is_none(),
        };
        others <= OTHER_HITS * rays as f64 && is_near
    }
}

/// What it took to build a tree.
#[derive(Clone, Copy, Default)]
pub struct Cost {
    /// Milliseconds.
    pub build_ms: f64,
    /// What it holds.
    pub bytes_per_primitive: f64,
}

impl Cost {
    /// The cost of a tree over so many primitives.
    pub fn new(seconds: f64, bytes: usize, primitives: usize) -> Self {
        Self { build_ms: 1e3 * seconds, bytes_per_primitive: bytes as f64 / primitives as f64 }
    }
}

/// Asks rays part by part on the threads of the pool. `ask` says how long it took, without what
/// stands around it, so that nobody is charged for copies of rays; the sum is shared among the
/// threads. It is handed a place for these copies.
pub fn in_parts<B: Default + Send>(
    rays: &[Ray],
    threads: usize,
    ask: impl Fn(&mut B, &[Ray]) -> Outcome + Sync,
) -> Outcome {
    let all: Outcome =
        rays.par_chunks(PART).map_init(B::default, |place, part| ask(place, part)).sum();
    Outcome { seconds: all.seconds / threads as f64, ..all }
}

/// The pixels of a square, tile by tile, and within them block by block. Its edge is a multiple of
/// [`TILE`].
pub fn pixels(size: u32) -> Vec<(u32, u32)> {
    let corners = |from: (u32, u32), size: u32, step: u32| {
        (0..size).step_by(step as usize).flat_map(move |y| {
            (0..size).step_by(step as usize).map(move |x| (from.0 + x, from.1 + y))
        })
    };
    corners((0, 0), size, TILE)
        .flat_map(|tile| corners(tile, TILE, BLOCK))
        .flat_map(|block| corners(block, BLOCK, 1))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_is_there_once_in_blocks() {
        let all = pixels(48);
        let mut sorted = all.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!((all.len(), sorted.len()), (48 * 48, 48 * 48));
        for block in all.chunks(16) {
            assert!(block.iter().all(|(x, y)| (x / 4, y / 4) == (block[0].0 / 4, block[0].1 / 4)));
        }
    }

    #[test]
    fn other_hits_and_distances_are_noticed() {
        let outcome = |hits, distance| Outcome { seconds: 1.0, hits, distance };
        let expected = outcome(500_000, 1e6);
        assert!(outcome(500_005, 1.000_05e6).agrees(&expected, 1_000_000));
        assert!(!outcome(500_020, 1e6).agrees(&expected, 1_000_000));
        assert!(!outcome(500_000, 1.001e6).agrees(&expected, 1_000_000));
        assert!(!outcome(500_000, 0.0).agrees(&expected, 1_000_000));
    }

    #[test]
    fn parts_add_up() {
        let rays = vec![Ray::new(Vec3::ZERO, Vec3::Z); 3 * PART + 1];
        let outcome = in_parts(&rays, 2, |(): &mut (), part| Outcome {
            seconds: 1.0,
            hits: part.len(),
            distance: 2.0,
        });
        let Outcome { seconds, hits, distance } = outcome;
        assert_eq!((seconds, hits, distance), (2.0, rays.len(), 8.0));
    }
}
