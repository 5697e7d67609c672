//! Independent estimates of one picture, and what their spread says of their mean.

use glam::DVec3;

use super::quantile::f_quantile;
use super::{Estimate, Film, Metric, REPLICATIONS};
use crate::render::moments::Sums;

/// What rounding leaves of a number: half an ulp where it is made, half an ulp where it is
/// averaged.
const ROUNDING: f64 = 1.0 / (1 << 23) as f64;

/// Replications that lie no farther apart than this, in relation to their mean, agree: what is left
/// is rounding of different orders.
const AGREEMENT: f64 = 4.0 * ROUNDING;

/// Added to the square of a value that an error is put in relation to.
const RELATIVE_EPSILON: f64 = 1e-2;

/// Replications of a film, of `each` samples a pixel, on the average if they are allocated.
pub(super) struct Replications {
    /// The samples of all; none before there is one.
    film: Option<Film>,
    /// Samples a pixel of each.
    pub(super) each: u32,
    /// How many there are.
    pub(super) count: u32,
    /// Of each pixel, the sum of the squared distances of their means from the mean; of one
    /// replication, nothing.
    apart: Vec<DVec3>,
    /// The mean of the whole picture, by each.
    means: Vec<f64>,
}

/// The error of a pixel's mean.
pub(super) struct PixelError {
    /// The mean of its square, as it is expected.
    pub(super) variance: f64,
    /// The square of what rounding leaves.
    pub(super) rounding: f64,
    /// Of how many samples it is.
    pub(super) samples: u64,
}

/// A mean squared error as it is expected, and over how many independent pixels it is.
struct Spread {
    mean_square: f64,
    pixels: f64,
    /// What rounding leaves, as a root of a mean square.
    floor: f64,
}

impl Replications {
    /// None yet. Films are large: nothing is kept before there is something to keep.
    pub(super) fn none(each: u32) -> Self {
        Self { film: None, each, count: 0, apart: Vec::new(), means: Vec::new() }
    }

    /// Adds one. (Welford's step, for the mean of each pixel.)
    pub(super) fn join(&mut self, one: Film) {
        let finite = one.sums().iter().map(|s| s.mean.truncate()).filter(|m| m.is_finite());
        let (sum, count) = finite.fold((0.0, 0u64), |(s, n), m| (s + m.element_sum() / 3.0, n + 1));
        self.means.push(if count == 0 { f64::NAN } else { sum / count as f64 });
        self.count += 1;
        let Some(film) = &mut self.film else {
            self.film = Some(one);
            return;
        };
        self.apart.resize(one.sums().len(), DVec3::ZERO);
        let mut apart = self.apart.iter_mut();
        film.merge(&one, |before, all, one| {
            let (value, mean) = (one.mean.truncate(), all.mean.truncate());
            if let Some(apart) = apart.next() {
                *apart += (value - before.mean.truncate()) * (value - mean);
            }
        });
    }

    /// The samples of all, if there are any.
    pub(super) fn into_film(self) -> Option<Film> {
        self.film
    }

    fn sums(&self) -> &[Sums] {
        self.film.as_ref().map_or(&[], Film::sums)
    }

    /// Samples a pixel in all, on the average.
    pub(super) fn samples(&self) -> u32 {
        self.film.as_ref().map_or(0, |film| {
            let pixels = film.sums().len().max(1) as u64;
            u32::try_from(film.total_samples() / pixels).unwrap_or(u32::MAX)
        })
    }

    /// How much the error is worth before it is known: the squared quantile, over the samples.
    pub(super) fn expected(&self, confidence: f64) -> f64 {
        match self.count {
            0 => f64::INFINITY,
            1 => f64::MAX / f64::from(self.each),
            n => f_quantile(confidence, 1.0, f64::from(n - 1)) / f64::from(self.samples()),
        }
    }

    /// The error of the mean of all, as a root of a mean square, and what rounding leaves of it.
    /// The number of independent pixels makes the squared error in units of the estimated one a
    /// variable of F.
    pub(super) fn estimate(&self, metric: Metric, confidence: f64) -> (Estimate, f64) {
        let spread = self.spread(metric);
        if self.count < 2 {
            return (Estimate::UNKNOWN, spread.floor);
        }
        let Spread { mean_square, pixels, floor } = spread;
        let degrees = pixels * f64::from(self.count - 1);
        let root = |p: f64| (f_quantile(p, pixels, degrees) * mean_square).sqrt();
        let estimate = Estimate {
            error: mean_square.sqrt().max(floor),
            low: root(1.0 - confidence),
            high: root(confidence) + floor,
        };
        (estimate, floor)
    }

    fn spread(&self, metric: Metric) -> Spread {
        match metric {
            Metric::Mean => self.spread_of_mean(),
            Metric::Rmse | Metric::RelMse => self.spread_of_pixels(metric),
        }
    }

    /// The variance of the mean of all replications, by how far they lie apart; `unseen` where they
    /// agree.
    fn of_means(&self, sum_of_squares: f64, mean: f64, unseen: impl FnOnce() -> f64) -> f64 {
        let n = f64::from(self.count);
        let rounding = AGREEMENT * mean;
        if self.count < 2 {
            0.0
        } else if sum_of_squares <= n * rounding * rounding {
            unseen()
        } else {
            sum_of_squares / (n * (n - 1.0))
        }
    }

    /// The squared error that replications of a pixel share where they agree. Evenly spread samples
    /// meet what is rare equally often in all of them, as 5 times where 5.12 are due: then each is
    /// off by a part of one sample's weight, at most by `1 - f` of it if a share `f` of all
    /// replications gives the same. All of `n` do so with a probability of `f^n`; with every `f` as
    /// likely as any other beforehand, the mean of `(1 - f)^2` is `2 / ((n + 2) (n + 3))`.
    ///
    /// The weight is that of samples which are all or nothing, `E[x^2] / E[x]`; but no more than
    /// what one sample among all can have, given their variance.
    fn unseen(&self, sums: &Sums) -> DVec3 {
        let (mean, m2) = (sums.mean.truncate(), sums.m2.truncate());
        let (all, n) = (sums.count as f64, f64::from(self.count));
        let share = (2.0 / ((n + 2.0) * (n + 3.0))).sqrt() * n / all;
        let weight = |mean: f64, m2: f64| {
            let of_rare = mean.abs() + m2 / (all * mean.abs());
            of_rare.min(m2.sqrt())
        };
        let one = |mean: f64, m2: f64| (share * weight(mean, m2)).powi(2);
        DVec3::new(one(mean.x, m2.x), one(mean.y, m2.y), one(mean.z, m2.z))
    }

    fn spread_of_mean(&self) -> Spread {
        let mean = self.means.iter().sum::<f64>() / self.means.len() as f64;
        let squares = self.means.iter().map(|m| (m - mean) * (m - mean)).sum();
        let floor = if mean.is_nan() { f64::INFINITY } else { ROUNDING * mean.abs() };
        let unseen = || {
            let finite = self.sums().iter().filter(|s| s.mean.is_finite());
            let each = finite.map(|s| self.unseen(s).element_sum() / 3.0);
            let (sum, pixels) = each.fold((0.0, 0.0), |(sum, n), v| (sum + v, n + 1.0));
            sum / (pixels * pixels)
        };
        Spread { mean_square: self.of_means(squares, mean, unseen), pixels: 1.0, floor }
    }

    /// What is known of each pixel's error, in the metric's weights; nothing of those that are no
    /// numbers.
    pub(super) fn pixels(&self, metric: Metric) -> impl Iterator<Item = Option<PixelError>> {
        let weigh = move |square: f64, value: f64| match metric {
            Metric::Rmse | Metric::Mean => square,
            Metric::RelMse => square / (value * value + RELATIVE_EPSILON),
        };
        let mean_of = move |squares: DVec3, values: DVec3| {
            (0..3).map(|i| weigh(squares[i], values[i])).sum::<f64>() / 3.0
        };
        let apart = self.apart.iter().chain(std::iter::repeat(&DVec3::ZERO));
        apart.zip(self.sums()).map(move |(apart, sums)| {
            let value = sums.mean.truncate();
            if !(apart.is_finite() && value.is_finite()) {
                return None;
            }
            let unseen = self.unseen(sums);
            let of_channel = |i: usize| self.of_means(apart[i], value[i], || unseen[i]);
            let variance = DVec3::new(of_channel(0), of_channel(1), of_channel(2));
            let rounding = value * ROUNDING;
            Some(PixelError {
                variance: mean_of(variance, value),
                rounding: mean_of(rounding * rounding, value),
                samples: sums.count,
            })
        })
    }

    /// The channels of a pixel may go together, so a pixel counts once. Pixels with more variance
    /// than others count for fewer (Satterthwaite, "An Approximate Distribution of Estimates of
    /// Variance Components", 1946).
    fn spread_of_pixels(&self, metric: Metric) -> Spread {
        let (mut pixels, mut sum, mut squares, mut rounding) = (0u64, 0.0, 0.0, 0.0);
        for pixel in self.pixels(metric).flatten() {
            pixels += 1;
            sum += pixel.variance;
            squares += pixel.variance * pixel.variance;
            rounding += pixel.rounding;
        }
        if pixels == 0 {
            return Spread { mean_square: 0.0, pixels: 1.0, floor: f64::INFINITY };
        }
        let n = pixels as f64;
        let floor = (rounding / n).sqrt();
        let independent = independent(sum, squares, f64::from(self.count)).clamp(1.0, n);
        Spread { mean_square: sum / n, pixels: independent, floor }
    }
}

/// How many equal ones a sum of variances amounts to: `(sum v)^2 / sum v^2` of the true variances,
/// from their estimates by `n` values each. Without the correction, the scatter of the estimates
/// would count too.
fn independent(sum: f64, squares: f64, n: f64) -> f64 {
    let true_squares = squares * (n - 1.0) / (n + 1.0);
    let true_sum = sum * sum - 2.0 * squares / (n + 1.0);
    if true_squares > 0.0 { true_sum / true_squares } else { 1.0 }
}

/// Whether all replications are there.
pub(super) fn is_complete(stage: &Replications) -> bool {
    stage.count == REPLICATIONS
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;
    use crate::render::{Image, Moments};

    /// A film of one pixel with `hits` samples of 100 among `each`.
    fn rare(hits: u32, each: u32) -> Film {
        let mut film = Film::new(1, 1);
        let mut moments = Moments::none();
        (0..each).for_each(|i| moments.add(Vec4::splat(if i < hits { 100.0 } else { 0.0 })));
        film.join(&Image::filled(1, 1, moments), each);
        film
    }

    /// 5 rare samples in each of eight replications of 512, where 5.12 are due: they agree, and the
    /// error is known all the same.
    #[test]
    fn replications_that_agree_do_not_deceive() {
        let mut all = Replications::none(512);
        (0..REPLICATIONS).for_each(|_| all.join(rare(5, 512)));
        for metric in [Metric::Rmse, Metric::Mean] {
            let (estimate, _) = all.estimate(metric, 0.95);
            let quantum = 100.0 / 512.0;
            assert!(
                estimate.high > 0.3 * quantum && estimate.high < 0.35 * quantum,
                "{estimate:?}"
            );
        }
        // A constant has no rare samples.
        let mut constant = Replications::none(512);
        (0..REPLICATIONS).for_each(|_| constant.join(rare(512, 512)));
        let (estimate, floor) = constant.estimate(Metric::Rmse, 0.95);
        assert_eq!(estimate.high, floor);
    }

    #[test]
    fn one_pixel_is_one_and_equal_ones_are_all() {
        let v: f64 = 3.0;
        assert!((independent(v, v * v, 8.0) - 1.0).abs() < 1e-12);
        // A hundred estimates of one variance by 8 values scatter by 2 / 7 of its square.
        let squares = 100.0 * v * v * (1.0 + 2.0 / 7.0);
        assert!((independent(100.0 * v, squares, 8.0) / 100.0 - 1.0).abs() < 0.01);
        assert_eq!(independent(0.0, 0.0, 8.0), 1.0);
    }
}
