//! Samples of pixels, by a method that the host chooses.

use glam::{UVec2, UVec4, Vec2, uvec2, uvec4, vec2};

use super::{
    pcg4d, scrambled_sobol_1d, scrambled_sobol_2d, stratified_1d, stratified_2d, unit_f32,
};
use crate::machine::functions::{uvec2, uvec4, vec2};
use crate::machine::generic::max;
use crate::machine::host::HostCapture;
use crate::machine::{Capture, Leaves, Machine, Schema, Value};
use crate::{Type, kernel};

/// How samples are placed. The host knows it, as a captured `bool`: WGSL has the method in use, and
/// no trace of the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SampleMethod {
    /// Independent: errors fall as `n^-1/2`.
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

/// Gives a sample of a pixel its numbers, one dimension or two at a time.
///
/// The `i`-th call gives each sample its `i`-th coordinates. For a good distribution all samples of
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
    /// What sets the pixel apart.
    pub key: UVec2,
    /// The number of the sample in the pixel.
    pub index: u32,
    /// How many samples the pixel will have; only [`SampleMethod::Stratified`] asks. Samples beyond
    /// belong to another set of as many.
    pub count: u32,
    /// The dimension that comes next.
    pub dimension: u32,
}

#[kernel]
impl Sampler {
    /// The sample `index` of `count` in a pixel. Another `seed` gives other samples everywhere.
    #[inline]
    pub fn new(pixel: UVec2, seed: u32, index: u32, count: u32) -> Self {
        let words = pcg4d(uvec4(pixel.x, pixel.y, seed, 0x5361_6d70));
        Self { key: uvec2(words.x, words.y), index, count, dimension: 0 }
    }

    /// The next dimension: a number from 0 to below 1.
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

    /// The next two dimensions: a point of the unit square.
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

/// Random words of this sample.
#[kernel]
#[inline]
fn words_of(sampler: Sampler, dimension: u32) -> UVec4 {
    pcg4d(uvec4(sampler.key.x, sampler.key.y, dimension, sampler.index))
}

/// Random words that all samples of the pixel share: they count from the other end.
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
