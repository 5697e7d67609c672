//! Counter-based random numbers.

use glam::{UVec2, Vec2, Vec3, uvec4, vec2, vec3};

use super::pcg4d;
use crate::machine::functions::{uvec4, vec2, vec3};
use crate::{Type, kernel};

/// Largest number below 1.
pub const ONE_MINUS_EPSILON: f32 = 1.0 - 1.0 / 16_777_216.0;

/// Converts the upper 24 bits to a number: at least 0, and below 1 for every word.
///
/// Whole multiples of 2^-24, so that `1 - u` is exact and at least 2^-24, and its logarithm is
/// finite. (A word times 2^-32 would be rounded to 1 for 128 words.)
#[kernel]
#[inline]
pub fn unit_f32(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Counter-based random number generator, with the same numbers in every variant.
///
/// Its state is a counter and a key of 96 bits, made of pixel, sample and seed; each draw is one
/// [`pcg4d()`] of both, and takes up to three words of it. No state is kept from one sample to the
/// next, and streams of other pixels or samples cannot overlap, as those of a stepped state can.
///
/// In kernels it is passed to calls as `&mut Rng`:
///
/// ```
/// use raydsl::prelude::*;
///
/// let kernel = kernel!(|x: u32, y: u32| {
///     let mut rng = Rng::new(uvec2(x, y), 0, 1);
///     let u = rng.next_2d();
///     if rng.next_f32() < 0.5 { u.x } else { u.y }
/// });
/// assert!(kernel.call((3, 4)) < 1.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Type)]
#[repr(C)]
pub struct Rng {
    /// First word of the stream's key.
    pub a: u32,
    /// Second word.
    pub b: u32,
    /// Third word.
    pub c: u32,
    /// Number of draws so far.
    pub counter: u32,
}

#[kernel]
impl Rng {
    /// Creates the stream of a sample of a pixel: `sample` is its number, or that of the frame.
    #[inline]
    pub fn new(pixel: UVec2, sample: u32, seed: u32) -> Self {
        let key = pcg4d(uvec4(pixel.x, pixel.y, sample, seed));
        Self { a: key.x, b: key.y, c: key.z, counter: 0 }
    }

    /// Draws 32 random bits.
    #[inline]
    pub fn next_u32(&mut self) -> u32 {
        let words = pcg4d(uvec4(self.a, self.b, self.c, self.counter));
        self.counter = self.counter.wrapping_add(1);
        words.x
    }

    /// Draws a number from 0 to below 1.
    #[inline]
    pub fn next_f32(&mut self) -> f32 {
        unit_f32(self.next_u32())
    }

    /// Draws a point of the unit square.
    #[inline]
    pub fn next_2d(&mut self) -> Vec2 {
        let words = pcg4d(uvec4(self.a, self.b, self.c, self.counter));
        self.counter = self.counter.wrapping_add(1);
        vec2(unit_f32(words.x), unit_f32(words.y))
    }

    /// Draws a point of the unit cube.
    #[inline]
    pub fn next_3d(&mut self) -> Vec3 {
        let words = pcg4d(uvec4(self.a, self.b, self.c, self.counter));
        self.counter = self.counter.wrapping_add(1);
        vec3(unit_f32(words.x), unit_f32(words.y), unit_f32(words.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lower 8 bits do not matter, so these are all possible numbers.
    #[test]
    fn every_word_gives_less_than_one() {
        for upper in 0..1u32 << 24 {
            let u = unit_f32(upper << 8);
            assert!((0.0..1.0).contains(&u) && (1.0 - u).ln().is_finite(), "{upper}");
            assert_eq!(u, unit_f32(upper << 8 | 0xff));
            assert_eq!(f64::from(u), f64::from(upper) / 16_777_216.0);
        }
        assert_eq!(unit_f32(u32::MAX), ONE_MINUS_EPSILON);
        assert_eq!(ONE_MINUS_EPSILON.next_up(), 1.0);
    }
}
