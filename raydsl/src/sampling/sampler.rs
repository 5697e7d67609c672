//! Samples of pixels, by one of several methods.

use glam::{UVec2, UVec4, Vec2, uvec2, uvec4, vec2};

use super::{
    pcg4d, scrambled_sobol_1d, scrambled_sobol_2d, stratified_1d, stratified_2d, unit_f32,
};
use crate::machine::functions::{uvec2, uvec4, vec2};
use crate::machine::generic::max;
use crate::{Type, kernel};

/// Placement of samples, which a [`Sampler`] knows. WGSL contains the methods in use, and no trace of
/// the others: those that the host captures, and those that a kernel names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Type)]
#[repr(u32)]
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
///     let mut sampler = Sampler::new(uvec2(x, y), 1, i, 64, method);
///     let lens = sampler.next_2d();
///     let time = sampler.next_1d();
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
    /// The placement of the samples.
    pub method: SampleMethod,
}

#[kernel]
impl Sampler {
    /// Creates the sample `index` of `count` in a pixel, placed by `method`. Another `seed` yields
    /// other samples everywhere.
    #[inline]
    pub fn new(pixel: UVec2, seed: u32, index: u32, count: u32, method: SampleMethod) -> Self {
        let words = pcg4d(uvec4(pixel.x, pixel.y, seed, 0x5361_6d70));
        Self { key: uvec2(words.x, words.y), index, count, dimension: 0, method }
    }

    /// Returns the next dimension: a number from 0 to below 1.
    #[inline(always)]
    pub fn next_1d(&mut self) -> f32 {
        let Self { key, index, count, dimension, method } = *self;
        self.dimension = dimension.wrapping_add(1);
        match method {
            SampleMethod::Random => random_number(key, index, dimension),
            SampleMethod::Stratified => stratified_number(key, index, count, dimension),
            SampleMethod::Sobol => sobol_number(key, index, dimension),
        }
    }

    /// Returns the next two dimensions: a point of the unit square.
    #[inline(always)]
    pub fn next_2d(&mut self) -> Vec2 {
        let Self { key, index, count, dimension, method } = *self;
        self.dimension = dimension.wrapping_add(2);
        match method {
            SampleMethod::Random => random_point(key, index, dimension),
            SampleMethod::Stratified => stratified_point(key, index, count, dimension),
            SampleMethod::Sobol => sobol_point(key, index, dimension),
        }
    }
}

// The long ones are functions of their own, so that the choice between them is short enough to be
// made in front of a loop.

#[kernel]
#[inline]
fn random_number(key: UVec2, index: u32, dimension: u32) -> f32 {
    unit_f32(words_of(key, index, dimension).x)
}

#[kernel]
#[inline]
fn random_point(key: UVec2, index: u32, dimension: u32) -> Vec2 {
    unit_square(words_of(key, index, dimension))
}

#[kernel]
#[inline]
fn stratified_number(key: UVec2, index: u32, count: u32, dimension: u32) -> f32 {
    let jitter = random_number(key, index, dimension);
    let seed = pattern(key, dimension, index / max(count, 1)).x;
    stratified_1d(index, count, seed, jitter)
}

#[kernel]
#[inline]
fn stratified_point(key: UVec2, index: u32, count: u32, dimension: u32) -> Vec2 {
    let jitter = random_point(key, index, dimension);
    let seeds = pattern(key, dimension, index / max(count, 1));
    stratified_2d(index, count, seeds, jitter)
}

#[kernel]
#[inline]
fn sobol_number(key: UVec2, index: u32, dimension: u32) -> f32 {
    scrambled_sobol_1d(index, pattern(key, dimension, 0))
}

#[kernel]
#[inline]
fn sobol_point(key: UVec2, index: u32, dimension: u32) -> Vec2 {
    scrambled_sobol_2d(index, pattern(key, dimension, 0))
}

/// Returns random words of a sample.
#[kernel]
#[inline]
fn words_of(key: UVec2, index: u32, dimension: u32) -> UVec4 {
    pcg4d(uvec4(key.x, key.y, dimension, index))
}

/// Returns random words shared by all samples of the pixel: they count from the other end.
#[kernel]
#[inline]
fn pattern(key: UVec2, dimension: u32, set: u32) -> UVec4 {
    pcg4d(uvec4(key.x, key.y, dimension, !set))
}

#[kernel]
#[inline]
fn unit_square(words: UVec4) -> Vec2 {
    vec2(unit_f32(words.x), unit_f32(words.y))
}
