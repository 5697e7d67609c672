//! Independent replications of a picture, and the error of their mean.

use glam::DVec3;

use super::quantile::f_quantile;
use super::{Estimate, Metric, REPLICATIONS};
use crate::render::moments::Sums;
use crate::render::store::Store;

/// The relative rounding error of a number: half an ulp where it is computed, half an ulp where it
/// is averaged.
const ROUNDING: f64 = 1.0 / (1 << 23) as f64;

/// The spread, relative to their mean, up to which replications agree: it is the rounding of
/// different orders.
const AGREEMENT: f64 = 4.0 * ROUNDING;

/// Added to the square of the value in a relative error.
const RELATIVE_EPSILON: f64 = 1e-2;

/// Replications of a film, of `each` samples per pixel, on average if they are allocated.
pub(super) struct Replications {
    /// The samples of all replications; `None` before the first.
    film: Option<Store>,
    /// Samples per pixel of a replication.
    pub(super) each: u32,
    /// The number of replications.
    pub(super) count: u32,
    /// For each pixel, the sum of the squared deviations of the replications' means from their
    /// mean; empty for one replication.
    apart: Vec<DVec3>,
    /// The mean of the whole picture in each replication.
    means: Vec<f64>,
}

/// The error of a pixel's mean.
pub(super) struct PixelError {
    /// The expected value of its square.
    pub(super) variance: f64,
    /// The square of the rounding error.
    pub(super) rounding: f64,
    /// The number of its samples.
    pub(super) samples: u64,
}

/// An expected mean squared error, and the number of independent pixels in it.
struct Spread {
    mean_square: f64,
    pixels: f64,
    /// The rounding error floor, as a root of a mean square.
    floor: f64,
}

impl Replications {
    /// Returns an empty set. Films are large: none is allocated before the first replication.
    pub(super) fn none(each: u32) -> Self {
        Self { film: None, each, count: 0, apart: Vec::new(), means: Vec::new() }
    }

    /// Adds a replication. (Welford's step, for the mean of each pixel.)
    pub(super) fn join(&mut self, one: Store) {
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

    /// Returns the samples of all replications, if there are any.
    pub(super) fn into_film(self) -> Option<Store> {
        self.film
    }

    fn sums(&self) -> &[Sums] {
        self.film.as_ref().map_or(&[], Store::sums)
    }

    /// Returns the samples per pixel in all, on average.
    pub(super) fn samples(&self) -> u32 {
        self.film.as_ref().map_or(0, |film| {
            let pixels = film.sums().len().max(1) as u64;
            u32::try_from(film.total_samples() / pixels).unwrap_or(u32::MAX)
        })
    }

    /// Returns the expected size of the error before it is known: the squared quantile, over the
    /// samples.
    pub(super) fn expected(&self, confidence: f64) -> f64 {
        match self.count {
            0 => f64::INFINITY,
            1 => f64::MAX / f64::from(self.each),
            n => f_quantile(confidence, 1.0, f64::from(n - 1)) / f64::from(self.samples()),
        }
    }

    /// Returns the error of the mean of all, as a root of a mean square, and its rounding error
    /// floor. The squared error in units of the estimated one has an F distribution, with the
    /// number of independent pixels as its degrees of freedom.
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

    /// Returns the variance of the mean of all replications from their spread, or `unseen` if they
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

    /// Returns the squared error common to replications that agree in a pixel. Evenly spread
    /// samples find a rare event equally often in all of them, such as 5 times instead of 5.12:
    /// then each is off by a part of one sample's weight, at most by `1 - f` of it if a share `f`
    /// of all replications gives the same. All of `n` do so with a probability of `f^n`; with a
    /// uniform prior of `f`, the mean of `(1 - f)^2` is `2 / ((n + 2) (n + 3))`.
    ///
    /// The weight is that of samples which are all or nothing, `E[x^2] / E[x]`, limited to the
    /// greatest possible one of a single sample, given their variance.
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

    /// Returns the error of each pixel, in the metric's weights; `None` for NaN pixels.
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

    /// Returns the spread over pixels. The channels of a pixel may be correlated, so a pixel counts
    /// once. Pixels with more variance than others count for fewer (Satterthwaite, "An Approximate
    /// Distribution of Estimates of Variance Components", 1946).
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

/// Returns the effective number of equal terms in a sum of variances: `(sum v)^2 / sum v^2` of the
/// true variances, from their estimates by `n` values each. Without the correction, the scatter of
/// the estimates would count too.
fn independent(sum: f64, squares: f64, n: f64) -> f64 {
    let true_squares = squares * (n - 1.0) / (n + 1.0);
    let true_sum = sum * sum - 2.0 * squares / (n + 1.0);
    if true_squares > 0.0 { true_sum / true_squares } else { 1.0 }
}

/// Returns whether a stage has all replications.
pub(super) fn is_complete(stage: &Replications) -> bool {
    stage.count == REPLICATIONS
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;
    use crate::render::{Image, Moments};

    /// Returns a film of one pixel with `hits` samples of 100 among `each`.
    fn rare(hits: u32, each: u32) -> Store {
        let mut film = Store::new(1, 1);
        let mut moments = Moments::none();
        (0..each).for_each(|i| moments.add(Vec4::splat(if i < hits { 100.0 } else { 0.0 })));
        film.join(&Image::filled(1, 1, moments), each);
        film
    }

    /// Tests 5 rare samples in each of eight replications of 512, where 5.12 are expected: they
    /// agree, and the error is still bounded.
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
