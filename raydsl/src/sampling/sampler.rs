//! Samples of pixels, by a method chosen on the host.

use glam::{UVec2, UVec4, Vec2, uvec2, uvec4, vec2};

use super::{
    pcg4d, scrambled_sobol_1d, scrambled_sobol_2d, stratified_1d, stratified_2d, unit_f32,
};
use crate::machine::functions::{uvec2, uvec4, vec2};
use crate::machine::generic::max;
use crate::machine::host::HostCapture;
use crate::machine::{Capture, Leaves, Machine, Schema, Value};
use crate::{Type, kernel};

/// Placement of samples. The host knows it, as a captured `bool`: WGSL contains the method in use,
/// and no trace of the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SampleMethod {
    /// Independent samples: errors fall as `n^-1/2`.
    Random,
    /// One sample in each cell of a grid: errors of smooth integrands of two dimensions fall as
    /// `1 / n`. Best with all `count` samples.
    Stratified,
    /// Owen-scrambled Sobol points, two dimensions at a time: errors of smooth integrands fall up
    /// to as fast as `n^-3/2`, at every power of two.
    #[default]
    Sobol,
}

impl HostCapture for SampleMethod {
    type Value = Self;

    #[inline(always)]
    fn host(&self) -> Self {
        *self
    }
}

impl<M: Machine> Value<M> for SampleMethod {
    const SCHEMA: &'static Schema = &Schema::Host;

    #[inline(always)]
    fn zero(_: &M) -> Self {
        Self::default()
    }

    #[inline(always)]
    fn zip(_: &M, a: Self, _: Self, _: &mut impl Leaves<M>) -> Self {
        a
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Capture<M> for SampleMethod {
    type On<'c> = Self;

    #[inline(always)]
    fn capture(&self, _: &M, _: &'static str) -> Self {
        *self
    }

    #[inline(always)]
    fn constant(&self, _: &M) -> Self {
        *self
    }
}

/// Generates the numbers of a pixel's sample, one or two dimensions at a time.
///
/// The `i`-th call returns each sample's `i`-th coordinates. For a good distribution all samples of
/// a pixel make the same calls in the same order; where paths differ, set `dimension` at each
/// bounce.
///
/// ```
/// use raydsl::prelude::*;
///
/// let method = SampleMethod::Sobol;
/// let kernel = kernel!(|x: u32, y: u32, i: u32| {
///     let mut sampler = Sampler::new(uvec2(x, y), 1, i, 64);
///     let lens = sampler.next_2d(host(method));
///     let time = sampler.next_1d(host(method));
///     lens.x + lens.y + time
/// });
/// assert!(kernel.call((3, 4, 0)) < 3.0);
/// assert!(!kernel.wgsl().contains("stratified"));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Type)]
#[repr(C)]
pub struct Sampler {
    /// Key of the pixel.
    pub key: UVec2,
    /// Index of the sample in the pixel.
    pub index: u32,
    /// Total number of samples of the pixel; only [`SampleMethod::Stratified`] uses it. Samples
    /// beyond belong to another set of as many.
    pub count: u32,
    /// Next dimension.
    pub dimension: u32,
}

#[kernel]
impl Sampler {
    /// Creates the sample `index` of `count` in a pixel. Another `seed` yields other samples
    /// everywhere.
    #[inline]
    pub fn new(pixel: UVec2, seed: u32, index: u32, count: u32) -> Self {
        let words = pcg4d(uvec4(pixel.x, pixel.y, seed, 0x5361_6d70));
        Self { key: uvec2(words.x, words.y), index, count, dimension: 0 }
    }

    /// Returns the next dimension: a number from 0 to below 1.
    #[inline]
    pub fn next_1d(&mut self, #[host] method: SampleMethod) -> f32 {
        let dimension = self.dimension;
        self.dimension = dimension.wrapping_add(1);
        match method {
            SampleMethod::Random => unit_f32(words_of(*self, dimension).x),
            SampleMethod::Stratified => {
                let jitter = unit_f32(words_of(*self, dimension).x);
                let seed = pattern(*self, dimension, self.index / max(self.count, 1)).x;
                stratified_1d(self.index, self.count, seed, jitter)
            }
            SampleMethod::Sobol => scrambled_sobol_1d(self.index, pattern(*self, dimension, 0)),
        }
    }

    /// Returns the next two dimensions: a point of the unit square.
    #[inline]
    pub fn next_2d(&mut self, #[host] method: SampleMethod) -> Vec2 {
        let dimension = self.dimension;
        self.dimension = dimension.wrapping_add(2);
        match method {
            SampleMethod::Random => unit_square(words_of(*self, dimension)),
            SampleMethod::Stratified => {
                let jitter = unit_square(words_of(*self, dimension));
                let seeds = pattern(*self, dimension, self.index / max(self.count, 1));
                stratified_2d(self.index, self.count, seeds, jitter)
            }
            SampleMethod::Sobol => scrambled_sobol_2d(self.index, pattern(*self, dimension, 0)),
        }
    }
}

/// Returns random words of this sample.
#[kernel]
#[inline]
fn words_of(sampler: Sampler, dimension: u32) -> UVec4 {
    pcg4d(uvec4(sampler.key.x, sampler.key.y, dimension, sampler.index))
}

/// Returns random words shared by all samples of the pixel: they count from the other end.
#[kernel]
#[inline]
fn pattern(sampler: Sampler, dimension: u32, set: u32) -> UVec4 {
    pcg4d(uvec4(sampler.key.x, sampler.key.y, dimension, !set))
}

#[kernel]
#[inline]
fn unit_square(words: UVec4) -> Vec2 {
    vec2(unit_f32(words.x), unit_f32(words.y))
}
