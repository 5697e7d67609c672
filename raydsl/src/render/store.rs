//! The samples of a film, whatever it keeps of them.

use super::channels::ChannelSums;
use super::moments::Sums;
use super::{Image, Moments};
use crate::machine::{Schema, Type};

/// The mean and the variance of every pixel, over all samples so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Store {
    width: u32,
    height: u32,
    pub(super) pixels: Vec<Sums>,
    samples: u32,
    /// Those of the channels, if they are kept.
    pub(super) channels: Option<ChannelSums>,
}

impl Store {
    /// Creates a store for a film of `width` by `height` pixels without samples, of colours alone.
    pub(super) fn new(width: u32, height: u32) -> Self {
        let pixels = vec![Sums::default(); width as usize * height as usize];
        Self::of_pixels(width, height, pixels, 0)
    }

    /// Creates a store of colours with these moments, row by row; no pixel has more than `samples`
    /// samples.
    pub(super) fn of_pixels(width: u32, height: u32, pixels: Vec<Sums>, samples: u32) -> Self {
        Self { width, height, pixels, samples, channels: None }
    }

    /// Adds the channels of results of a layout.
    pub(super) fn with_channels(self, schema: &Schema) -> Self {
        let channels = Some(ChannelSums::new(schema, self.pixels.len()));
        Self { channels, ..self }
    }

    /// Returns a store of the same size, for the same channels, without samples.
    pub(super) fn cleared(&self) -> Self {
        let mut channels = self.channels.clone();
        channels.iter_mut().for_each(ChannelSums::clear);
        Self { channels, ..Self::new(self.width, self.height) }
    }

    /// Returns the number of columns.
    pub(super) fn width(&self) -> u32 {
        self.width
    }

    /// Returns the number of rows.
    pub(super) fn height(&self) -> u32 {
        self.height
    }

    /// Returns the number of samples of each pixel so far, the largest if they differ. The next
    /// pass begins with the sample of this index.
    pub(super) fn samples(&self) -> u32 {
        self.samples
    }

    /// Returns the number of samples of all pixels together.
    pub(super) fn total_samples(&self) -> u64 {
        self.pixels.iter().map(|sums| sums.count).sum()
    }

    /// Clears all samples, for example after the camera has moved.
    pub(super) fn clear(&mut self) {
        self.pixels.fill(Sums::default());
        self.channels.iter_mut().for_each(ChannelSums::clear);
        self.samples = 0;
    }

    /// Adds the result of a pass, of `samples` samples per pixel.
    pub(super) fn join(&mut self, pass: &Image<Moments>, samples: u32) {
        for (sums, moments) in self.pixels.iter_mut().zip(pass.pixels()) {
            sums.join(moments);
        }
        self.samples = self.samples.saturating_add(samples);
    }

    /// Adds all samples of another film of the same size, which must be different samples. `each`
    /// receives a pixel before and after, and the added samples.
    pub(super) fn merge(&mut self, other: &Self, mut each: impl FnMut(&Sums, &Sums, &Sums)) {
        if let (Some(channels), Some(more)) = (&mut self.channels, &other.channels) {
            channels.merge(&self.pixels, more, &other.pixels);
        }
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

    /// Returns the number of pixels with a NaN sample.
    pub(super) fn nan_pixels(&self) -> usize {
        self.pixels.iter().filter(|sums| sums.mean.is_nan()).count()
    }

    pub(super) fn map<T: Type>(&self, f: impl Fn(&Sums) -> T) -> Image<T> {
        let width = self.width as usize;
        let at = |x, y| f(&self.pixels[y as usize * width + x as usize]);
        Image::from_fn(self.width, self.height, at)
    }
}
