//! Films: pictures refined pass by pass.

use glam::{DVec4, Vec4};

use super::moments::Sums;
use super::{Image, Moments};
use crate::machine::Type;

/// The mean and the variance of every pixel, over all samples so far.
///
/// [`Renderer::accumulate`](super::Renderer::accumulate) adds samples. Means are kept in `f64`.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    pixels: Vec<Sums>,
    samples: u32,
}

impl Film {
    /// Creates a film of `width` by `height` pixels without samples.
    pub fn new(width: u32, height: u32) -> Self {
        let pixels = vec![Sums::default(); width as usize * height as usize];
        Self { width, height, pixels, samples: 0 }
    }

    /// Returns the number of columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the number of samples of each pixel so far, the largest if they differ. The next
    /// pass begins with the sample of this index.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Returns the number of samples of each pixel. They differ if
    /// [`Until::adaptive`](super::Until::adaptive) chose them.
    pub fn sample_counts(&self) -> Image<u32> {
        self.map(|sums| u32::try_from(sums.count).unwrap_or(u32::MAX))
    }

    /// Returns the number of samples of all pixels together.
    pub(super) fn total_samples(&self) -> u64 {
        self.pixels.iter().map(|sums| sums.count).sum()
    }

    /// Clears all samples, for example after the camera has moved.
    pub fn clear(&mut self) {
        self.pixels.fill(Sums::default());
        self.samples = 0;
    }

    /// Adds the result of a pass, of `samples` samples per pixel.
    pub(crate) fn join(&mut self, pass: &Image<Moments>, samples: u32) {
        for (sums, moments) in self.pixels.iter_mut().zip(pass.pixels()) {
            sums.join(moments);
        }
        self.samples = self.samples.saturating_add(samples);
    }

    /// Adds all samples of another film of the same size, which must be different samples. `each`
    /// receives a pixel before and after, and the added samples.
    pub(super) fn merge(&mut self, other: &Self, mut each: impl FnMut(&Sums, &Sums, &Sums)) {
        for (sums, more) in self.pixels.iter_mut().zip(&other.pixels) {
            let before = *sums;
            sums.merge(more);
            each(&before, sums, more);
        }
        self.samples = self.samples.saturating_add(other.samples);
    }

    /// Returns the moments of each pixel.
    pub(super) fn sums(&self) -> &[Sums] {
        &self.pixels
    }

    /// Returns the means: red, green, blue and alpha. They are black without samples, and NaN where
    /// a sample was NaN.
    pub fn image(&self) -> Image<Vec4> {
        self.map(|sums| sums.mean.as_vec4())
    }

    /// Returns the variance of one sample, unbiased (divided by n - 1); 0 where there are fewer
    /// than two.
    pub fn variance(&self) -> Image<Vec4> {
        self.map(|sums| match sums.count {
            0 | 1 => Vec4::ZERO,
            n => (sums.m2 / (n - 1) as f64).as_vec4(),
        })
    }

    /// Returns the standard error of each mean, if the samples are independent; other sequences are
    /// usually closer than that. It is 0 where there are fewer than two samples.
    pub fn standard_error(&self) -> Image<Vec4> {
        self.map(|sums| match sums.count {
            0 | 1 => Vec4::ZERO,
            n => {
                let variance = sums.m2 / (n - 1) as f64 / n as f64;
                DVec4::from_array(variance.to_array().map(f64::sqrt)).as_vec4()
            }
        })
    }

    /// Returns the number of pixels with a NaN sample.
    pub fn nan_pixels(&self) -> usize {
        self.pixels.iter().filter(|sums| sums.mean.is_nan()).count()
    }

    /// Returns the means, row by row from the bottom, before rounding to `f32`.
    pub fn means(&self) -> impl Iterator<Item = DVec4> {
        self.pixels.iter().map(|sums| sums.mean)
    }

    fn map<T: Type>(&self, f: impl Fn(&Sums) -> T) -> Image<T> {
        let width = self.width as usize;
        let at = |x, y| f(&self.pixels[y as usize * width + x as usize]);
        Image::from_fn(self.width, self.height, at)
    }
}
