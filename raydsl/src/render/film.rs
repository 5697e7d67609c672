//! Pictures that get better with every pass.

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
    /// A film of `width` by `height` pixels without samples.
    pub fn new(width: u32, height: u32) -> Self {
        let pixels = vec![Sums::default(); width as usize * height as usize];
        Self { width, height, pixels, samples: 0 }
    }

    /// The number of columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// The number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Samples of each pixel so far, the most of any if they do not all have the same number. The
    /// next pass begins with the one of this number.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// How many samples each pixel has. They differ where [`Until::adaptive`](super::Until::adaptive)
    /// chose them.
    pub fn sample_counts(&self) -> Image<u32> {
        self.map(|sums| u32::try_from(sums.count).unwrap_or(u32::MAX))
    }

    /// The samples of all pixels.
    pub(super) fn total_samples(&self) -> u64 {
        self.pixels.iter().map(|sums| sums.count).sum()
    }

    /// Forgets all samples, as when the camera has moved.
    pub fn clear(&mut self) {
        self.pixels.fill(Sums::default());
        self.samples = 0;
    }

    /// Adds what a pass gave, of `samples` samples a pixel.
    pub(crate) fn join(&mut self, pass: &Image<Moments>, samples: u32) {
        for (sums, moments) in self.pixels.iter_mut().zip(pass.pixels()) {
            sums.join(moments);
        }
        self.samples = self.samples.saturating_add(samples);
    }

    /// Adds all samples of another film of the same size, which must be other samples. `each` sees
    /// what a pixel was, what it has become, and what was added.
    pub(super) fn merge(&mut self, other: &Self, mut each: impl FnMut(&Sums, &Sums, &Sums)) {
        for (sums, more) in self.pixels.iter_mut().zip(&other.pixels) {
            let before = *sums;
            sums.merge(more);
            each(&before, sums, more);
        }
        self.samples = self.samples.saturating_add(other.samples);
    }

    /// What is known of each pixel.
    pub(super) fn sums(&self) -> &[Sums] {
        &self.pixels
    }

    /// The means: red, green, blue and alpha. Black without samples; a pixel one of whose samples
    /// was no number is none.
    pub fn image(&self) -> Image<Vec4> {
        self.map(|sums| sums.mean.as_vec4())
    }

    /// The variance of one sample, unbiased (divided by n - 1); 0 where there are fewer than two.
    pub fn variance(&self) -> Image<Vec4> {
        self.map(|sums| match sums.count {
            0 | 1 => Vec4::ZERO,
            n => (sums.m2 / (n - 1) as f64).as_vec4(),
        })
    }

    /// The standard error of each mean, if the samples are independent; other sequences are mostly
    /// closer than that. 0 where there are fewer than two samples.
    pub fn standard_error(&self) -> Image<Vec4> {
        self.map(|sums| match sums.count {
            0 | 1 => Vec4::ZERO,
            n => {
                let variance = sums.m2 / (n - 1) as f64 / n as f64;
                DVec4::from_array(variance.to_array().map(f64::sqrt)).as_vec4()
            }
        })
    }

    /// How many pixels had a sample that was no number.
    pub fn nan_pixels(&self) -> usize {
        self.pixels.iter().filter(|sums| sums.mean.is_nan()).count()
    }

    /// The means, row by row from the bottom, before they are rounded to `f32`.
    pub fn means(&self) -> impl Iterator<Item = DVec4> {
        self.pixels.iter().map(|sums| sums.mean)
    }

    fn map<T: Type>(&self, f: impl Fn(&Sums) -> T) -> Image<T> {
        let width = self.width as usize;
        let at = |x, y| f(&self.pixels[y as usize * width + x as usize]);
        Image::from_fn(self.width, self.height, at)
    }
}
