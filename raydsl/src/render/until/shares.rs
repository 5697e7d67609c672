//! Adaptive sampling: the blocks of a film that need more samples than others.

use super::Metric;
use super::replications::Replications;
use crate::render::allocation::{Allocation, BLOCK};

/// The smallest share of the mean that a block gets: events missed there by the pilot may still be
/// found.
const LEAST: f64 = 1.0 / 8.0;

/// The shares of a film's samples among its blocks.
pub(super) struct Shares {
    width: u32,
    /// The weight of each block, relative to the mean over all pixels.
    weights: Vec<f64>,
    /// The mean squared error of as many samples allocated like this, relative to that of the
    /// replications it was chosen by.
    pub(super) gain: f64,
}

/// The error of a block's pixels.
#[derive(Clone, Copy, Default)]
struct Block {
    /// The number of pixels.
    area: f64,
    /// The sum of the squared errors of their means.
    error: f64,
    /// The sum of the variances of one sample in them.
    variance: f64,
}

impl Block {
    fn join(self, other: Self) -> Self {
        Self {
            area: self.area + other.area,
            error: self.error + other.error,
            variance: self.variance + other.variance,
        }
    }

    /// Returns the mean variance of a pixel.
    fn mean_variance(self) -> f64 {
        if self.area > 0.0 { self.variance / self.area } else { 0.0 }
    }
}

impl Shares {
    /// Returns the shares that minimise the error of a film, from the errors of its replications;
    /// `None` if these are 0 or not finite.
    pub(super) fn of(replications: &Replications, metric: Metric, width: u32) -> Option<Self> {
        let columns = width.div_ceil(BLOCK) as usize;
        let blocks = blocks(replications, metric, width);
        let all = blocks.iter().copied().fold(Block::default(), Block::join);
        // Neighbours of a block that needs many samples may need some too.
        let pooled = |i: usize| {
            let around = neighbours(i, columns, blocks.len()).map(|i| blocks[i]);
            let around = around.fold(Block::default(), Block::join);
            blocks[i].mean_variance().max(around.mean_variance())
        };
        let needs: Vec<f64> = (0..blocks.len()).map(|i| pooled(i).sqrt()).collect();
        let mean = |of: &dyn Fn(f64) -> f64| {
            let sum = needs.iter().zip(&blocks).map(|(&need, block)| of(need) * block.area);
            sum.sum::<f64>() / all.area
        };
        let least = LEAST * mean(&|need| need);
        let scale = mean(&|need| need.max(least));
        if !(scale > 0.0 && scale.is_finite()) {
            return None;
        }
        let weights: Vec<f64> = needs.iter().map(|need| need.max(least) / scale).collect();
        let samples = replications.samples().max(1);
        let errors = blocks.iter().zip(&weights).map(|(b, w)| b.variance / w);
        let gain = errors.sum::<f64>() / f64::from(samples) / all.error;
        Some(Self { width, weights, gain })
    }

    /// Returns the samples of each block for a mean of `each`, in whole periods.
    pub(super) fn allocation(&self, each: u32, period: u32) -> Allocation {
        // At least one period, and no more than the mean in all.
        let rest = f64::from((each / period).saturating_sub(1));
        let samples = self
            .weights
            .iter()
            .map(|w| ((rest * w) as u32).saturating_add(1).saturating_mul(period));
        Allocation::new(self.width, samples.collect())
    }
}

/// Returns the blocks, row by row.
fn blocks(replications: &Replications, metric: Metric, width: u32) -> Vec<Block> {
    let columns = width.div_ceil(BLOCK) as usize;
    let (mut blocks, mut x, mut y) = (Vec::new(), 0, 0);
    for pixel in replications.pixels(metric) {
        let index = (y / BLOCK) as usize * columns + (x / BLOCK) as usize;
        if index >= blocks.len() {
            blocks.resize(index + 1, Block::default());
        }
        let block = &mut blocks[index];
        block.area += 1.0;
        if let Some(pixel) = pixel {
            block.error += pixel.variance;
            block.variance += pixel.variance * pixel.samples as f64;
        }
        (x, y) = if x + 1 < width { (x + 1, y) } else { (0, y + 1) };
    }
    blocks
}

/// Returns the indices of a block and its neighbours.
fn neighbours(i: usize, columns: usize, count: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (i % columns, i / columns);
    let rows = count.div_ceil(columns);
    let range = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
    range(y, rows).flat_map(move |y| range(x, columns).map(move |x| y * columns + x))
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;
    use crate::render::store::Store;
    use crate::render::{Image, Moments};

    /// Returns replications whose pixels scatter by `spread(x, y)`.
    fn replications(width: u32, height: u32, spread: impl Fn(u32, u32) -> f32) -> Replications {
        let mut all = Replications::none(16);
        for r in 0..8 {
            let sign = if r % 2 == 0 { 1.0 } else { -1.0 };
            let image = Image::from_fn(width, height, |x, y| {
                let mean = Vec4::splat(1.0 + sign * spread(x, y));
                Moments { count: 16, mean, m2: Vec4::ZERO }
            });
            let mut film = Store::new(width, height);
            film.join(&image, 16);
            all.join(film);
        }
        all
    }

    #[test]
    fn what_is_alike_gets_the_same() {
        for (width, height) in [(1, 1), (16, 16), (100, 37)] {
            let all = replications(width, height, |_, _| 0.1);
            let shares = Shares::of(&all, Metric::Rmse, width).expect("an error");
            assert!((shares.gain - 1.0).abs() < 1e-9, "{}", shares.gain);
            assert!(shares.allocation(1000, 1).samples().iter().all(|n| (999..=1000).contains(n)));
        }
        assert!(Shares::of(&replications(40, 40, |_, _| 0.0), Metric::Rmse, 40).is_none());
    }

    /// Tests that where nine in ten columns are quiet, these keep an eighth, and those next to the
    /// others get a part of their need. The mean is the requested one.
    #[test]
    fn what_scatters_gets_more() {
        let (width, height) = (160, 32);
        let all = replications(width, height, |x, _| if x < 16 { 0.1 } else { 1e-4 });
        let shares = Shares::of(&all, Metric::Rmse, width).expect("an error");
        for each in [1, 2, 8, 1000, 1 << 28] {
            let allocation = shares.allocation(each, 1);
            let samples = allocation.samples();
            assert_eq!(samples.len(), 20);
            let mean = samples.iter().map(|&n| f64::from(n)).sum::<f64>() / 20.0;
            let lost = f64::from(each) - mean;
            assert!((0.0..=1.0).contains(&lost), "{each} {mean}");
            assert!(samples.iter().all(|&n| n >= 1));
        }
        let rounds = shares.allocation(1000, 8);
        assert!(rounds.samples().iter().all(|n| n % 8 == 0));
        let samples = shares.allocation(1000, 1).samples().to_vec();
        assert!(samples[0] > 3500 && samples[1] > 1500 && samples[2] < 200, "{samples:?}");
        assert!(shares.gain < 0.3, "{}", shares.gain);
    }

    #[test]
    fn blocks_have_neighbours() {
        let around = |i| neighbours(i, 3, 6).collect::<Vec<_>>();
        assert_eq!(around(0), [0, 1, 3, 4]);
        assert_eq!(around(4), [0, 1, 2, 3, 4, 5]);
        assert_eq!(neighbours(0, 1, 1).collect::<Vec<_>>(), [0]);
    }
}
