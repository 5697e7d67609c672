//! Integrals of a transfer function over values: means between any two, with no table of pairs.

use glam::{DVec3, Vec3, vec3};

use super::transfer::{TransferFunction, TransferKnot, TransferSample, sample_between};
use crate::machine::functions::vec3;
use crate::machine::generic::{max, min};
use crate::{Type, kernel};

/// Integrals over the values from the first knot to one of the others, each as a number and the
/// rest that it lacks: their differences are right to some 2^-48 of the whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct TransferIntegral {
    pub(super) extinction: f32,
    extinction_rest: f32,
    pub(super) emission: Vec3,
    emission_rest: Vec3,
}

/// Greatest integral of extinction: beyond it differences would not be numbers.
const MOST: f64 = 1e30;

/// Returns the integrals up to each knot, the far ones at both ends aside.
pub(super) fn integrals(knots: &[TransferKnot]) -> Vec<TransferIntegral> {
    let (mut extinction, mut emission) = (0.0f64, DVec3::ZERO);
    let mut all = vec![TransferIntegral::default(); knots.len()];
    let (first, last) = (&knots[1], &knots[knots.len() - 2]);
    // Greater ones are opaque all the same.
    let most = MOST / (f64::from(last.value) - f64::from(first.value)).max(1.0);
    for i in 2..knots.len() - 1 {
        let (a, b) = (&knots[i - 1], &knots[i]);
        let width = f64::from(b.value) - f64::from(a.value);
        let [ea, eb] = [a, b].map(|k| f64::from(k.extinction).min(most));
        let [ca, cb] = [a, b].map(|k| k.color.as_dvec3());
        extinction += (ea + eb) * 0.5 * width;
        let product = ca * (2.0 * ea + eb) + cb * (ea + 2.0 * eb);
        emission = (emission + product * (width / 6.0)).min(DVec3::splat(f32::MAX.into()));
        let (number, rest) = (extinction as f32, emission.as_vec3());
        all[i] = TransferIntegral {
            extinction: number,
            extinction_rest: (extinction - f64::from(number)) as f32,
            emission: rest,
            emission_rest: (emission - rest.as_dvec3()).as_vec3(),
        };
    }
    if let [.., before, last] = &mut all[..] {
        *last = *before;
    }
    all
}

/// Returns the mean over the values between two of one interval; colour is weighted by extinction.
#[kernel]
#[inline]
fn mean_of(a: TransferSample, b: TransferSample) -> TransferSample {
    // Scaled, so that sums of any extinctions are finite.
    let (ea, eb) = (a.extinction * 0.125, b.extinction * 0.125);
    let share = (ea + 2.0 * eb) / max(3.0 * (ea + eb), f32::MIN_POSITIVE);
    TransferSample {
        color: a.color + (b.color - a.color) * min(share, 1.0),
        extinction: 0.5 * a.extinction + 0.5 * b.extinction,
    }
}

/// A mean over the values between two, and the colours of both.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct MeanBetween {
    pub(super) mean: TransferSample,
    pub(super) from: Vec3,
    pub(super) to: Vec3,
}

/// A value of the field, and what a function has there.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct TransferPlace {
    pub(super) value: f32,
    /// The interval, and the knots at its ends.
    interval: u32,
    below: TransferKnot,
    above: TransferKnot,
    sample: TransferSample,
}

/// Looks a value up.
#[kernel]
#[inline]
pub(super) fn place_at(function: &TransferFunction, value: f32) -> TransferPlace {
    let interval: u32 = function.interval(value);
    let below: TransferKnot = function.knot(interval);
    let above: TransferKnot = function.knot(interval + 1);
    let sample = sample_between(below, above, value);
    TransferPlace { value, interval, below, above, sample }
}

/// Returns the mean over all values between two, each as frequent as any other: pre-integration
/// without absorption within. (Engel, Kraus and Ertl, "High-Quality Pre-Integrated Volume Rendering
/// Using Hardware-Accelerated Pixel Shading", 2001, section 3.3; there it is a table.)
#[kernel]
#[inline]
pub(super) fn mean_between(function: &TransferFunction, a: f32, b: f32) -> TransferSample {
    let (low, high) = (place_at(function, min(a, b)), place_at(function, max(a, b)));
    mean_of_places(function, low, high).mean
}

/// Returns the mean over the values between two.
#[kernel]
#[inline]
pub(super) fn mean_of_places(
    function: &TransferFunction,
    a: TransferPlace,
    b: TransferPlace,
) -> MeanBetween {
    let is_falling = b.value < a.value;
    let (low, high) = (if is_falling { b } else { a }, if is_falling { a } else { b });
    let (i, j) = (low.interval, high.interval);
    let (from, to): (TransferSample, TransferSample) = (low.sample, high.sample);
    let mut mean = mean_of(from, to);
    if i < j {
        // Parts of the outer intervals, and the whole ones between them.
        let (above, below): (TransferKnot, TransferKnot) = (low.above, high.below);
        let first = mean_of(from, end_of(above));
        let last = mean_of(end_of(below), to);
        let (begin, end) = (function.integral(i + 1), function.integral(j));
        let per = 1.0 / max(high.value - low.value, f32::MIN_POSITIVE);
        let depths = vec3(
            first.extinction * ((above.value - low.value) * per),
            ((end.extinction - begin.extinction) + (end.extinction_rest - begin.extinction_rest))
                * per,
            last.extinction * ((high.value - below.value) * per),
        );
        let inner = (end.emission - begin.emission) + (end.emission_rest - begin.emission_rest);
        let sum = depths.x + depths.y + depths.z;
        let each = 1.0 / max(sum, 1e-30);
        let color =
            first.color * (depths.x * each) + (inner * per) * each + last.color * (depths.z * each);
        mean = TransferSample { color, extinction: sum };
    }
    MeanBetween { mean, from: from.color, to: to.color }
}

/// Returns what a knot has.
#[kernel]
#[inline]
fn end_of(knot: TransferKnot) -> TransferSample {
    TransferSample { color: knot.color, extinction: knot.extinction }
}
