//! Sample positions in a pixel, and the random numbers of samples.

use glam::{Vec2, vec2};

use crate::kernel;
use crate::machine::functions::vec2;
use crate::sampling::{SampleMethod, Sampler};

/// The sample positions in a pixel.
///
/// The fixed patterns are the standard ones of Direct3D for 2, 4 and 8 samples: each row and each
/// column of the pixel has one. Further samples repeat the pattern.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PixelSampler {
    /// The centre.
    Center,
    /// Two fixed positions.
    Two,
    /// Four fixed positions.
    Four,
    /// Eight fixed positions.
    Eight,
    /// Random positions, by [`Sampling::method`].
    #[default]
    Jittered,
}

impl PixelSampler {
    /// Returns the number of samples after which the positions repeat: a mean over whole periods
    /// weights all parts of the pixel equally.
    pub const fn period(self) -> u32 {
        match self {
            Self::Center | Self::Jittered => 1,
            Self::Two => 2,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }
}

/// The sampling of a film's pixels.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::render::{PixelSampler, Sampling};
///
/// let sampling = Sampling::new(64).method(SampleMethod::Stratified).seed(7);
/// assert_eq!(sampling.pixels, PixelSampler::Jittered);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// The sample positions in a pixel. Jittered unless set.
    pub pixels: PixelSampler,
    /// The method of the samplers: for positions in the pixel and on a lens, and for what kernels
    /// draw. Sobol unless set.
    pub method: SampleMethod,
    /// The seed; another one gives other samples everywhere. 0 unless set.
    pub seed: u32,
    /// The number of samples of each pixel in all, which stratification needs. At least 1.
    pub planned: u32,
}

impl Sampling {
    /// Creates jittered Sobol sampling with `planned` samples per pixel.
    pub const fn new(planned: u32) -> Self {
        let planned = if planned == 0 { 1 } else { planned };
        Self { pixels: PixelSampler::Jittered, method: SampleMethod::Sobol, seed: 0, planned }
    }

    /// Sets the sample positions in a pixel.
    #[must_use]
    pub const fn pixels(self, pixels: PixelSampler) -> Self {
        Self { pixels, ..self }
    }

    /// Sets the sampling method.
    #[must_use]
    pub const fn method(self, method: SampleMethod) -> Self {
        Self { method, ..self }
    }

    /// Sets the seed.
    #[must_use]
    pub const fn seed(self, seed: u32) -> Self {
        Self { seed, ..self }
    }
}

/// Returns the position of sample `index` of two, in a pixel of width 1. The functions below do so
/// for four and eight.
#[kernel]
#[inline]
fn of_two(index: u32) -> Vec2 {
    [vec2(0.75, 0.75), vec2(0.25, 0.25)][(index % 2) as usize]
}

#[kernel]
#[inline]
fn of_four(index: u32) -> Vec2 {
    let places = [vec2(6.0, 2.0), vec2(14.0, 6.0), vec2(2.0, 10.0), vec2(10.0, 14.0)];
    places[(index % 4) as usize] * 0.0625
}

#[kernel]
#[inline]
fn of_eight(index: u32) -> Vec2 {
    let places = [
        vec2(9.0, 5.0),
        vec2(7.0, 11.0),
        vec2(13.0, 9.0),
        vec2(5.0, 3.0),
        vec2(3.0, 13.0),
        vec2(1.0, 7.0),
        vec2(11.0, 15.0),
        vec2(15.0, 1.0),
    ];
    places[(index % 8) as usize] * 0.0625
}

/// Returns the position of the sample in the pixel: from (0, 0) at its lower left to below (1, 1).
/// Jittered samples take two dimensions of `sampler`, the others none.
#[kernel]
#[inline]
pub(super) fn pixel_place(sampler: &mut Sampler, #[host] pixels: PixelSampler) -> Vec2 {
    match pixels {
        PixelSampler::Center => vec2(0.5, 0.5),
        PixelSampler::Two => of_two(sampler.index),
        PixelSampler::Four => of_four(sampler.index),
        PixelSampler::Eight => of_eight(sampler.index),
        PixelSampler::Jittered => sampler.next_2d(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixed_places_share_no_row_and_no_column() {
        type Place = fn(u32) -> Vec2;
        for (place, count) in [(of_two as Place, 2), (of_four, 4), (of_eight, 8)] {
            let lines = |line: fn(Vec2) -> f32| {
                let all = (0..count).map(|i| (line(place(i)) * count as f32) as u32);
                all.collect::<std::collections::BTreeSet<u32>>()
            };
            let all = (0..count).collect();
            assert_eq!(lines(|p| p.x), all);
            assert_eq!(lines(|p| p.y), all);
            let sum: Vec2 = (0..count).map(place).sum();
            assert_eq!(sum / count as f32, Vec2::splat(0.5), "their middle is the pixel's");
            assert_eq!(place(count), place(0));
        }
    }
}
