//! Running mean and variance of colours.

use glam::{DVec4, Vec4, vec4};

use crate::machine::functions::vec4;
use crate::{Type, kernel};

/// The moments of a pixel's samples: the count, the mean, and the sum of the squared deviations
/// from it, for each of red, green, blue and alpha.
///
/// A pass over a film returns one for each pixel. Passes are joined in `f64` by a
/// [`Film`](super::Film), so that the millionth sample of a pixel has the same weight as the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Moments {
    /// Number of samples.
    pub count: u32,
    /// The mean.
    pub mean: Vec4,
    /// The sum of the squared deviations from the mean.
    pub m2: Vec4,
}

#[kernel]
impl Moments {
    /// Returns the moments of no samples.
    #[inline]
    pub fn none() -> Self {
        let zero = vec4(0.0, 0.0, 0.0, 0.0);
        Self { count: 0, mean: zero, m2: zero }
    }

    /// Adds a sample. (Welford, "Note on a Method for Calculating Corrected Sums of Squares and
    /// Products", Technometrics 1962.)
    #[inline]
    pub fn add(&mut self, color: Vec4) {
        self.count = self.count.wrapping_add(1);
        let from_mean = color - self.mean;
        self.mean += from_mean / self.count as f32;
        self.m2 += from_mean * (color - self.mean);
    }
}

/// The moments of a pixel over all passes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sums {
    pub(super) count: u64,
    pub(super) mean: DVec4,
    pub(super) m2: DVec4,
}

impl Sums {
    /// Adds the moments of a pass.
    pub(super) fn join(&mut self, pass: &Moments) {
        let (mean, m2) = (pass.mean.as_dvec4(), pass.m2.as_dvec4());
        self.merge(&Self { count: u64::from(pass.count), mean, m2 });
    }

    /// Merges the moments of other samples. (Chan, Golub and LeVeque, "Updating Formulae and a
    /// Pairwise Algorithm for Computing Sample Variances", 1979, formula 2.1.)
    pub(super) fn merge(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        let (n, k) = (self.count as f64, other.count as f64);
        let apart = other.mean - self.mean;
        self.count += other.count;
        self.mean += apart * (k / (n + k));
        self.m2 += other.m2 + apart * apart * (n * k / (n + k));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests a case in which the sum of squares minus the square of the sum would give 509.75.
    #[test]
    fn a_small_variance_around_a_large_mean() {
        // Evenly from 999.5 to 1000.5.
        let values: Vec<f32> =
            (0..65_536).map(|i| (999.5 + (f64::from(i) * 0.618_034).fract()) as f32).collect();
        let mut sums = Sums::default();
        for pass in values.chunks(64) {
            let mut moments = Moments::none();
            pass.iter().for_each(|&v| moments.add(Vec4::splat(v)));
            sums.join(&moments);
        }
        let count = values.len() as f64;
        let mean = values.iter().copied().map(f64::from).sum::<f64>() / count;
        let variance =
            values.iter().map(|&v| (f64::from(v) - mean).powi(2)).sum::<f64>() / (count - 1.0);
        assert!((variance * 12.0 - 1.0).abs() < 1e-3, "{variance}");
        assert_eq!(sums.count, values.len() as u64);
        assert!((sums.m2.x / (count - 1.0) / variance - 1.0).abs() < 2e-3, "{}", sums.m2.x);
        assert!((sums.mean.x - mean).abs() < 1e-4, "{} {mean}", sums.mean.x);
    }

    /// Tests that the hundred millionth sample has the same weight as the first: a sum of `f32`
    /// would stall at 2^24.
    #[test]
    fn a_hundred_million_samples() {
        let pass = |shift: f32| {
            let mut moments = Moments::none();
            // Evenly in [0, 1): 64 values whose mean is 0.4921875.
            (0..64).for_each(|i| moments.add(Vec4::splat((i as f32 + shift) / 64.0)));
            moments
        };
        let (low, high) = (pass(0.0), pass(0.5));
        let mut sums = Sums::default();
        (0..781_250).for_each(|_| {
            sums.join(&low);
            sums.join(&high);
        });
        assert_eq!(sums.count, 100_000_000);
        let mean = (63.0 + 64.0) / 4.0 / 64.0;
        assert!((sums.mean.x / mean - 1.0).abs() < 1e-6, "{}", sums.mean.x);
        // The variance of 0 ..= 127, over 128^2.
        let variance = (128.0 * 128.0 - 1.0) / 12.0 / (128.0 * 128.0);
        let found = sums.m2.x / (sums.count - 1) as f64;
        assert!((found / variance - 1.0).abs() < 1e-6, "{found} {variance}");
    }

    /// Tests that the mean is the same to two units in the last place in any order of merging.
    #[test]
    fn the_order_of_joining_hardly_matters() {
        let part = |i: u32| {
            let mut moments = Moments::none();
            let value = |j: u32| ((i * 97 + j * 31) % 1009) as f32 + 0.1;
            (0..1 + i % 64).for_each(|j| moments.add(Vec4::splat(value(j))));
            let mut sums = Sums::default();
            sums.join(&moments);
            sums
        };
        let all: Vec<Sums> = (0..1000).map(part).collect();
        let joined = |parts: &[Sums]| {
            let mut sums = Sums::default();
            parts.iter().for_each(|p| sums.merge(p));
            sums
        };
        let in_turn = joined(&all);
        let by_tens: Vec<Sums> = all.chunks(10).map(joined).collect();
        let backwards: Vec<Sums> = all.iter().rev().copied().collect();
        for other in [joined(&by_tens), joined(&backwards)] {
            assert_eq!(other.count, in_turn.count);
            let ulp = f64::from(f32::EPSILON) * in_turn.mean.x / 2.0;
            assert!((other.mean.x - in_turn.mean.x).abs() <= 2.0 * ulp);
            assert!((other.m2.x / in_turn.m2.x - 1.0).abs() <= 2.0 * f64::from(f32::EPSILON));
        }
    }

    #[test]
    fn passes_of_any_size_are_joined() {
        let value = |i: u32| Vec4::new(i as f32, 1.0, 0.0, (i % 3) as f32);
        let expected: f64 = (0..1000).map(f64::from).sum::<f64>() / 1000.0;
        for size in [1, 7, 100, 1000] {
            let mut sums = Sums::default();
            for first in (0..1000).step_by(size) {
                let mut moments = Moments::none();
                (first..(first + size as u32).min(1000)).for_each(|i| moments.add(value(i)));
                sums.join(&moments);
            }
            sums.join(&Moments::none());
            assert!((sums.mean.x - expected).abs() < 1e-4 * expected, "{size}: {sums:?}");
            assert_eq!((sums.mean.y, sums.m2.y, sums.mean.z), (1.0, 0.0, 0.0));
            // The variance of 0 ..= 999 is (n^2 - 1) / 12.
            let variance = sums.m2.x / 1000.0;
            assert!((variance / 83_333.25 - 1.0).abs() < 1e-5, "{size}: {variance}");
        }
    }
}
