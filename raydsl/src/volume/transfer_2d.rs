//! Transfer functions of two numbers: the value, and the length of its gradient.

use glam::{UVec2, Vec2, Vec3};

use super::error::TransferError;
use super::transfer::{TransferSample, extinction};
use crate::Type;
use crate::machine::Owner;

/// A 2-D transfer function's numbers in kernels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct TransferLayout2d {
    /// Value and gradient of the first sample.
    pub first: Vec2,
    /// Samples per value, and per gradient.
    pub per: Vec2,
    /// Number of the last sample along each axis.
    pub last: Vec2,
    /// Samples along the values, which run fastest.
    pub stride: u32,
}

/// Greatest number of samples along an axis.
const MOST_SAMPLES: u32 = 4096;

/// Transfer function of the value and of the length of its gradient: colour and extinction,
/// bilinear between samples at equal distances.
///
/// Borders between two materials are long gradients around the values between them, and what is
/// within one material has short ones, so that a border is told from a material of the same value.
/// (Kindlmann and Durkin, "Semi-Automatic Generation of Transfer Functions for Direct Volume
/// Rendering", 1998; Kniss, Kindlmann and Hansen, "Multidimensional Transfer Functions for
/// Interactive Volume Rendering", 2002.) Beyond the first and the last sample it is constant.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::TransferFunction2d;
///
/// // Red where the value changes by 20 per length, whatever it is.
/// let red = |opacity| (Vec3::X, opacity);
/// let samples = [red(0.0), red(0.0), red(0.5), red(0.5), red(0.0), red(0.0)];
/// let edges =
///     TransferFunction2d::new(&samples, uvec2(2, 3), vec2(0.0, 255.0), vec2(0.0, 40.0), 1.0)?;
/// assert_eq!(edges.at(100.0, 20.0).extinction, 2f32.ln());
/// assert_eq!(edges.at(100.0, 0.0).extinction, 0.0);
/// # Ok::<(), raydsl::volume::TransferError>(())
/// ```
#[derive(Debug)]
pub struct TransferFunction2d {
    pub(super) samples: Vec<TransferSample>,
    /// The greatest extinction of a value's samples, of gradients up to each.
    below: Vec<f32>,
    pub(super) layout: TransferLayout2d,
    pub(super) owner: Owner,
}

impl Clone for TransferFunction2d {
    fn clone(&self) -> Self {
        let Self { samples, below, layout, .. } = self;
        let (samples, below) = (samples.clone(), below.clone());
        Self { samples, below, layout: *layout, owner: Owner::new() }
    }
}

impl TransferFunction2d {
    /// Creates a function from `size.x * size.y` samples `(colour, opacity)`: along the values from
    /// `values.x` to `values.y`, which run fastest, and the lengths of gradients from `gradients.x`
    /// to `gradients.y`, in values per length of the world. Opacities are from 0 to 1, of a layer
    /// of thickness `unit`.
    ///
    /// # Errors
    ///
    /// If there are fewer than two samples along an axis or more than 4096, their number is
    /// another, a range is empty, or a number is out of range.
    pub fn new(
        samples: &[(Vec3, f32)],
        size: UVec2,
        values: Vec2,
        gradients: Vec2,
        unit: f32,
    ) -> Result<Self, TransferError> {
        if !(unit > 0.0 && unit.is_finite()) {
            return Err(TransferError::UnitDistance(unit));
        }
        let expected = u64::from(size.x) * u64::from(size.y);
        let is_good = size.min_element() >= 2 && size.max_element() <= MOST_SAMPLES;
        if !is_good || samples.len() as u64 != expected {
            return Err(TransferError::Samples { size, found: samples.len() });
        }
        let first = Vec2::new(values.x, gradients.x);
        let width = Vec2::new(values.y, gradients.y) - first;
        if !(width.min_element() > 0.0 && width.is_finite() && first.is_finite()) {
            return Err(TransferError::Range { values, gradients });
        }
        let is_bad = |(color, opacity): &(Vec3, f32)| {
            !(color.is_finite() && color.min_element() >= 0.0 && (0.0..=1.0).contains(opacity))
        };
        if let Some(index) = samples.iter().position(is_bad) {
            return Err(TransferError::OutOfRange { of: "samples", index });
        }
        let sample = |(color, opacity): &(Vec3, f32)| TransferSample {
            color: *color,
            extinction: extinction(f64::from(*opacity), f64::from(unit)) as f32,
        };
        let samples: Vec<TransferSample> = samples.iter().map(sample).collect();
        let mut below: Vec<f32> = samples.iter().map(|s| s.extinction).collect();
        for i in size.x as usize..below.len() {
            below[i] = below[i].max(below[i - size.x as usize]);
        }
        let last = (size - 1).as_vec2();
        let layout = TransferLayout2d { first, per: last / width, last, stride: size.x };
        Ok(Self { samples, below, layout, owner: Owner::new() })
    }

    /// Returns colour and extinction of a value with a gradient of this length.
    pub fn at(&self, value: f32, gradient: f32) -> TransferSample {
        let TransferLayout2d { first, per, last, stride } = self.layout;
        let place = ((Vec2::new(value, gradient) - first) * per).clamp(Vec2::ZERO, last);
        let cell = place.min(last - 0.5).floor();
        let share = place - cell;
        let i = (cell.y as u32 * stride + cell.x as u32) as usize;
        let mix = |a: TransferSample, b: TransferSample, share: f32| TransferSample {
            color: a.color + (b.color - a.color) * share,
            extinction: a.extinction + (b.extinction - a.extinction) * share,
        };
        let row = |i: usize| mix(self.samples[i], self.samples[i + 1], share.x);
        mix(row(i), row(i + stride as usize), share.y)
    }

    /// Returns a bound on the extinction of the values from `range.x` to `range.y` with gradients
    /// up to a length; 0 if the first value is greater.
    pub(super) fn greatest_extinction(&self, range: Vec2, gradient: f32) -> f32 {
        if range.x.partial_cmp(&range.y).is_none_or(core::cmp::Ordering::is_gt) {
            return 0.0;
        }
        let TransferLayout2d { first, per, last, stride } = self.layout;
        let place = |value: f32| ((value - first.x) * per.x).clamp(0.0, last.x);
        let (from, to) = (place(range.x).floor() as usize, place(range.y).ceil() as usize);
        // Rounding may take a place to the next sample.
        let (from, to) = (from.saturating_sub(1), (to + 1).min(last.x as usize));
        let row = ((gradient - first.y) * per.y).clamp(0.0, last.y).ceil() as usize + 1;
        let row = row.min(last.y as usize) * stride as usize;
        self.below[row + from..=row + to].iter().copied().fold(0.0, f32::max)
    }
}
