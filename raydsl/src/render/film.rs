//! Films: pictures refined pass by pass.

use core::fmt;
use core::marker::PhantomData;

use glam::{DVec4, Vec4};

use super::Image;
use super::store::Store;
use crate::machine::Type;

/// The mean and the variance of every pixel, over all samples so far.
///
/// [`Renderer::accumulate`](super::Renderer::accumulate) adds samples. Means are kept in `f64`.
///
/// A `Film` keeps the colours of a kernel's results. [`Film::of_channels`] also keeps every other
/// number of them: a `Film<R>` of a struct or a tuple `R` has the mean and the standard error of
/// each.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::{Type, kernel};
///
/// #[derive(Clone, Copy, Type)]
/// #[repr(C)]
/// struct Pixel {
///     light: Vec3,
///     depth: f32,
/// }
///
/// #[kernel]
/// impl Radiance for Pixel {
///     fn rgba(&self) -> Vec4 {
///         self.light.extend(1.0)
///     }
/// }
///
/// let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
/// let floor = kernel!(|ray: Ray| {
///     let depth = 1.0 / max(-ray.direction.y, 0.01);
///     Pixel { light: vec3(1.0, 0.5, 0.25) / depth, depth }
/// });
/// let mut film = Film::<Pixel>::of_channels(32, 24);
/// TiledScheduler::new().accumulate(&camera, &floor, &Sampling::new(16), &mut film, 16);
/// let (means, errors) = (film.channels(), film.channel_errors());
/// assert!(means.pixels()[0].depth > 1.0 && errors.pixels()[0].depth < 0.1);
/// assert_eq!(means.pixels()[0].light.extend(1.0), film.image().pixels()[0]);
/// ```
pub struct Film<R = ()> {
    pub(super) store: Store,
    kept: PhantomData<fn() -> R>,
}

impl<R> Clone for Film<R> {
    fn clone(&self) -> Self {
        Self { store: self.store.clone(), kept: PhantomData }
    }
}

impl<R> PartialEq for Film<R> {
    fn eq(&self, other: &Self) -> bool {
        self.store == other.store
    }
}

impl<R> fmt::Debug for Film<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.store.fmt(f)
    }
}

impl Film {
    /// Creates a film of `width` by `height` pixels without samples, which keeps colours.
    pub fn new(width: u32, height: u32) -> Self {
        Self::of_store(Store::new(width, height))
    }

    pub(super) fn of_store(store: Store) -> Self {
        Self { store, kept: PhantomData }
    }

    /// Adds the result of a pass, of `samples` samples per pixel.
    #[cfg(test)]
    pub(crate) fn join(&mut self, pass: &Image<super::Moments>, samples: u32) {
        self.store.join(pass, samples);
    }
}

impl<R: Type> Film<R> {
    /// Creates a film of `width` by `height` pixels without samples, which keeps the colour and all
    /// channels of results.
    pub fn of_channels(width: u32, height: u32) -> Self {
        let store = Store::new(width, height).with_channels(R::SCHEMA);
        Self { store, kept: PhantomData }
    }

    /// Returns the mean of every number of the results. An integer or a truth value has no mean: it
    /// is that of the last sample.
    pub fn channels(&self) -> Image<R> {
        self.of_each_channel(true, |_, mean, _| mean)
    }

    /// Returns the variance of one sample in every number of the results, as [`Film::variance`];
    /// where there is no number, it is 0.
    pub fn channel_variances(&self) -> Image<R> {
        self.of_each_channel(false, |count, _, m2| variance(count, m2))
    }

    /// Returns the standard error of the mean of every number of the results, as
    /// [`Film::standard_error`]; where there is no number, it is 0.
    pub fn channel_errors(&self) -> Image<R> {
        self.of_each_channel(false, |count, _, m2| {
            (variance(count, m2) / count.max(1) as f64).sqrt()
        })
    }

    /// Returns `f` of the count, the mean and the sum of squared deviations of every number.
    fn of_each_channel(&self, with_integers: bool, f: fn(u64, f64, f64) -> f64) -> Image<R> {
        let (width, mut bytes) = (self.width() as usize, vec![0; R::SCHEMA.size()]);
        Image::from_fn(self.width(), self.height(), |x, y| {
            let pixel = y as usize * width + x as usize;
            if let Some(channels) = &self.store.channels {
                let count = self.store.sums()[pixel].count;
                channels.write(pixel, with_integers, &mut bytes, |mean, m2| f(count, mean, m2));
            }
            R::read(&bytes)
        })
    }
}

/// Returns the unbiased variance of one sample; 0 of fewer than two.
fn variance(count: u64, m2: f64) -> f64 {
    if count < 2 { 0.0 } else { m2 / (count - 1) as f64 }
}

impl<R> Film<R> {
    /// Returns the number of columns.
    pub fn width(&self) -> u32 {
        self.store.width()
    }

    /// Returns the number of rows.
    pub fn height(&self) -> u32 {
        self.store.height()
    }

    /// Returns the number of samples of each pixel so far, the largest if they differ. The next
    /// pass begins with the sample of this index.
    pub fn samples(&self) -> u32 {
        self.store.samples()
    }

    /// Returns the number of samples of each pixel. They differ if
    /// [`Until::adaptive`](super::Until::adaptive) chose them.
    pub fn sample_counts(&self) -> Image<u32> {
        self.store.map(|sums| u32::try_from(sums.count).unwrap_or(u32::MAX))
    }

    /// Clears all samples, for example after the camera has moved.
    pub fn clear(&mut self) {
        self.store.clear();
    }

    /// Returns the means: red, green, blue and alpha. They are black without samples, and NaN where
    /// a sample was NaN.
    pub fn image(&self) -> Image<Vec4> {
        self.store.map(|sums| sums.mean.as_vec4())
    }

    /// Returns the variance of one sample, unbiased (divided by n - 1); 0 where there are fewer
    /// than two.
    pub fn variance(&self) -> Image<Vec4> {
        self.store.map(|sums| match sums.count {
            0 | 1 => Vec4::ZERO,
            n => (sums.m2 / (n - 1) as f64).as_vec4(),
        })
    }

    /// Returns the standard error of each mean, if the samples are independent; other sequences are
    /// usually closer than that. It is 0 where there are fewer than two samples.
    pub fn standard_error(&self) -> Image<Vec4> {
        self.store.map(|sums| match sums.count {
            0 | 1 => Vec4::ZERO,
            n => {
                let variance = sums.m2 / (n - 1) as f64 / n as f64;
                DVec4::from_array(variance.to_array().map(f64::sqrt)).as_vec4()
            }
        })
    }

    /// Returns the number of pixels with a NaN sample.
    pub fn nan_pixels(&self) -> usize {
        self.store.nan_pixels()
    }

    /// Returns the means, row by row from the bottom, before rounding to `f32`.
    pub fn means(&self) -> impl Iterator<Item = DVec4> {
        self.store.sums().iter().map(|sums| sums.mean)
    }
}
