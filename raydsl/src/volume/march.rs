//! Integrators that take samples at regular distances.

use glam::Vec3;

use super::integral::{TransferPlace, mean_of_places, place_at};
use super::integrator::{
    Inside, Layer, VolumeIntegrator, inside, integrator, macro_walk, majorant_of,
};
use super::light::VolumeLight;
use super::sample::{InCell, cell_around, value_in};
use super::transfer::{TransferSample, seen_sample_of};
use super::volume::{Volume, VolumeView};
use super::voxel::Voxel;
use crate::geometry::{Ray, RayOn};
use crate::machine::generic::{clamp, max, min};
use crate::machine::{Machine, On};
use crate::math::elementary::{exp, expm1, log1p};
use crate::{Type, kernel};

/// What a rule makes of a step.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Step {
    pub(super) color: Vec3,
    pub(super) opacity: f32,
    pub(super) depth: f32,
}

/// Maximum number of steps: up to here their numbers are exact in an `f32`.
pub(super) const MOST_STEPS: f32 = 16_777_216.0;

/// Maximum number of macro-cells whose steps are one sum without its rounding errors.
pub(super) const RUN: u32 = 8;

/// Opacity that [`Euler`] takes for an opaque step.
const MOST_OPACITY: f32 = 1.0 - f32::EPSILON;

/// Returns the sample, without extinction where voxels are missing.
#[kernel]
#[inline(always)]
fn where_whole<T: Voxel>(
    volume: &Volume<'_, T>,
    is_whole: bool,
    sample: TransferSample,
) -> TransferSample {
    if volume.grid().has_gaps() {
        let extinction = if is_whole { sample.extinction } else { 0.0 };
        TransferSample { extinction, ..sample }
    } else {
        sample
    }
}

/// Returns the cell at a distance.
#[kernel]
#[inline(always)]
pub(super) fn cell_at_distance<T: Voxel>(volume: &Volume<'_, T>, part: Inside, t: f32) -> InCell {
    cell_around(volume.grid(), part.origin + part.direction * t)
}

/// Colour and extinction at an end of a step.
#[derive(Clone, Copy, Debug, Type)]
struct SampledEnd {
    sample: TransferSample,
    is_whole: bool,
}

/// Returns colour and extinction at a distance, and whether there is a value.
#[kernel]
#[inline(always)]
fn sampled_end_at<T: Voxel>(volume: &Volume<'_, T>, part: Inside, t: f32) -> SampledEnd {
    let cell = cell_at_distance(volume, part, t);
    let sample: TransferSample = volume.transfer().at(value_in(volume.grid(), cell));
    SampledEnd { sample: where_whole(volume, cell.is_whole, sample), is_whole: cell.is_whole }
}

/// Returns colour and extinction at a distance.
#[kernel]
#[inline(always)]
pub(super) fn sample_at<T: Voxel>(volume: &Volume<'_, T>, part: Inside, t: f32) -> TransferSample {
    sampled_end_at(volume, part, t).sample
}

/// Returns colour and extinction at a distance; black where there is no extinction.
#[kernel]
#[inline(always)]
fn seen_at<T: Voxel>(volume: &Volume<'_, T>, part: Inside, t: f32) -> TransferSample {
    let cell = cell_at_distance(volume, part, t);
    let sample = seen_sample_of(volume.transfer(), value_in(volume.grid(), cell));
    where_whole(volume, cell.is_whole, sample)
}

/// Returns extinction at a distance.
#[kernel]
#[inline]
pub(super) fn extinction_at<T: Voxel>(volume: &Volume<'_, T>, part: Inside, t: f32) -> f32 {
    seen_at(volume, part, t).extinction
}

/// Returns the opacity of an optical depth, which is 0 for most steps.
#[kernel]
#[inline(always)]
pub(super) fn opacity_of(depth: f32) -> f32 {
    let mut opacity = 0.0;
    if depth > 0.0 {
        opacity = -expm1(-depth);
    }
    opacity
}

/// Defines the kernel of an integrator by its rule, which makes of the distances at which a step
/// begins and ends what the step adds. A rule of both ends keeps what it found at the last one: `$last`
/// is first `$first`, at the distance `$from`, and the rule sets it.
///
/// The kernel sums steps of equal length, at most `step` in the world, which tile the part of the
/// ray in the grid; it skips macro-cells without extinction, and ends where less than `least` is
/// transmitted. The loop is repeated for each rule: as a function of its own, which gets the rule
/// as a closure, packets would call that for every step.
macro_rules! march {
    (
        $name:ident by $kernel:ident in $of:ident,
        |$this:ident, $volume:ident, $part:ident, $from:ident, $to:ident $(, $last:ident = ($first:expr))?|
            $rule:expr
    ) => {
        #[kernel]
        #[inline(never)]
        fn $kernel<T: Voxel>(
            $this: $name,
            $volume: &$of<'_, T>,
            ray: Ray,
            light: VolumeLight,
        ) -> VolumeLight {
            let $part = inside($volume.grid(), ray);
            let count = clamp(($part.end * $part.scale / $this.step).ceil(), 1.0, MOST_STEPS);
            let width = $part.end / count;
            let mut light = light;
            let mut i = 0u32;
            let mut walk = macro_walk($volume.grid(), $part);
            while walk.is_inside && light.transmittance() >= $this.least {
                // The rays of a packet look for extinction together, and then all take steps.
                while walk.is_inside && majorant_of($volume, walk.cell) <= 0.0 {
                    walk.advance();
                }
                let (enter, mut leave) = (walk.enter, walk.enter);
                let mut passed = 0u32;
                while walk.is_inside && passed < RUN && majorant_of($volume, walk.cell) > 0.0 {
                    leave = walk.leave;
                    passed += 1;
                    walk.advance();
                }
                if passed > 0 {
                    // All steps that touch these macro-cells, but those that the ones before have
                    // had.
                    i = max(i, (enter / width) as u32);
                    let end = min(leave / width, count).ceil() as u32;
                    let enough = $this.least / max(light.transmittance(), f32::MIN_POSITIVE);
                    let mut layer = Layer::new();
                    $(
                        let $from = i as f32 * width;
                        let mut $last = $first;
                    )?
                    while i < end && layer.transmittance >= enough {
                        let ($from, $to) = (i as f32 * width, (i + 1) as f32 * width);
                        let found = $rule;
                        layer.add(found.color, found.opacity, found.depth);
                        i += 1;
                    }
                    light = light.then(layer.radiance, layer.depth);
                }
            }
            light
        }
    };
}

pub(super) use march;

/// Defines an integrator by its rule, with a step and a least transmittance.
macro_rules! rule {
    (
        $(#[$doc:meta])*
        $name:ident by $kernel:ident,
        |$volume:ident, $part:ident, $from:ident, $to:ident $(, $last:ident = ($first:expr))?| $rule:expr
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Type)]
        pub struct $name {
            /// Greatest length of a step, in the world; above 0.
            pub step: f32,
            /// Transmittance below which the rest of a ray is left out: at most this share of what
            /// is behind, whatever its radiance, is missing. 0 leaves nothing out.
            pub least: f32,
        }

        #[kernel]
        impl $name {
            /// Creates the integrator with this step. It leaves out what is behind a transmittance
            /// of 0.001.
            #[inline]
            pub fn new(step: f32) -> Self {
                Self { step, least: 0.001 }
            }

            /// Sets the transmittance below which the rest of a ray is left out.
            #[inline]
            #[must_use]
            pub fn least(self, least: f32) -> Self {
                Self { step: self.step, least }
            }
        }

        integrator!($name, $kernel);
        march! {
            $name by $kernel in Volume,
            |this, $volume, $part, $from, $to $(, $last = ($first))?| $rule
        }
    };
}

rule! {
    /// Naive compositing: the opacity of a step is its extinction times its length, at most 1.
    ///
    /// An explicit Euler step, at the middle of each step: first order, and unstable where
    /// extinction times step is above 1. Kept for comparison.
    Euler by euler, |volume, part, from, to| {
        let sample = seen_at(volume, part, (from + to) * 0.5);
        let depth = sample.extinction * ((to - from) * part.scale);
        let opacity = min(depth, MOST_OPACITY);
        Step { color: sample.color, opacity, depth: -log1p(-opacity) }
    }
}

rule! {
    /// Exponential steps with the sample at the beginning of each: what is called opacity
    /// correction. First order, right for any thickness of a homogeneous layer.
    ExponentialLeft by exponential_left, |volume, part, from, to| {
        let sample = seen_at(volume, part, from);
        let depth = sample.extinction * ((to - from) * part.scale);
        Step { color: sample.color, opacity: opacity_of(depth), depth }
    }
}

rule! {
    /// Exponential steps with the sample at the middle of each: second order, at the cost of
    /// [`ExponentialLeft`].
    Midpoint by midpoint, |volume, part, from, to| {
        let sample = seen_at(volume, part, (from + to) * 0.5);
        let depth = sample.extinction * ((to - from) * part.scale);
        Step { color: sample.color, opacity: opacity_of(depth), depth }
    }
}

/// Returns the mean place of what is absorbed in a homogeneous step: 1/2 if thin, 0 if thick.
/// The integral of `s τ exp(-τ s)` over `1 - exp(-τ)`, `1/τ - 1/(exp(τ) - 1)`; by its series where
/// the terms cancel.
#[kernel]
#[inline(always)]
fn mean_place(depth: f32) -> f32 {
    let squared = depth * depth;
    let thin = 0.5 - depth * (1.0 / 12.0 - squared * (1.0 / 720.0 - squared / 30240.0));
    let thick = 1.0 / max(depth, 1.0) - exp(-depth) / -expm1(-max(depth, 1.0));
    if depth < 1.0 { thin } else { thick }
}

/// Returns the colour at a place between two ends, from 0 to 1.
#[kernel]
#[inline(always)]
fn color_between<T: Voxel>(
    volume: &Volume<'_, T>,
    a: SampledEnd,
    b: SampledEnd,
    place: f32,
) -> Vec3 {
    let (first, last) = (a.sample.color, b.sample.color);
    let (mut from, mut to) = (first, last);
    if volume.grid().has_gaps() {
        // What is missing has no colour: it is that of the other end.
        from = if a.is_whole { first } else { last };
        to = if b.is_whole { last } else { first };
    }
    from + (to - from) * place
}

rule! {
    /// Steps with the mean extinction of both ends, and a colour that is linear between them:
    /// second order, and right where extinction is constant. One sample a step: steps share ends.
    /// An end at missing voxels has no extinction, and the colour of the other one.
    MeanExtinction by mean_extinction,
    |volume, part, from, to, last = (sampled_end_at(volume, part, from))| {
        let (a, b) = (last, sampled_end_at(volume, part, to));
        last = b;
        let sum = a.sample.extinction + b.sample.extinction;
        let depth = sum * 0.5 * ((to - from) * part.scale);
        let color = color_between(volume, a, b, mean_place(depth));
        Step { color, opacity: opacity_of(depth), depth }
    }
}

/// An end of a step.
#[derive(Clone, Copy, Debug, Type)]
struct StepEnd {
    at: TransferPlace,
    is_whole: bool,
}

/// Returns what is at a distance.
#[kernel]
#[inline]
fn end_at<T: Voxel>(volume: &Volume<'_, T>, part: Inside, t: f32) -> StepEnd {
    let cell = cell_at_distance(volume, part, t);
    let mut value = value_in(volume.grid(), cell);
    if volume.grid().has_gaps() {
        // What is missing has no place.
        value = if cell.is_whole { value } else { 0.0 };
    }
    StepEnd { at: place_at(volume.transfer(), value), is_whole: cell.is_whole }
}

/// Returns the mean colour and extinction between two ends; without extinction where voxels are missing
/// at either.
#[kernel]
#[inline]
fn mean_on_step<T: Voxel>(volume: &Volume<'_, T>, a: StepEnd, b: StepEnd) -> TransferSample {
    let mean: TransferSample = mean_of_places(volume.transfer(), a.at, b.at).mean;
    where_whole(volume, a.is_whole & b.is_whole, mean)
}

rule! {
    /// Steps with the means of colour and extinction over all values between those at both ends, so
    /// that no peak of the transfer function falls between two samples: pre-integration. Second
    /// order; absorption within a step is left out of its colour, so steps are to be thin where
    /// colours change. One sample a step: steps share ends.
    ///
    /// The means are those of the function itself, [`TransferFunction::between`], and not of a
    /// table of pairs of values: there is no error of interpolation, and another function costs
    /// nothing. (Engel, Kraus and Ertl, "High-Quality Pre-Integrated Volume Rendering Using
    /// Hardware-Accelerated Pixel Shading", 2001.)
    ///
    /// [`TransferFunction::between`]: super::TransferFunction::between
    PreIntegrated by pre_integrated, |volume, part, from, to, last = (end_at(volume, part, from))| {
        let end = end_at(volume, part, to);
        let mean = mean_on_step(volume, last, end);
        last = end;
        let depth = mean.extinction * ((to - from) * part.scale);
        Step { color: mean.color, opacity: opacity_of(depth), depth }
    }
}
