//! sRGB.

use crate::kernel;
use crate::math::elementary::pow;

/// From sRGB to linear: the piecewise curve of IEC 61966-2-1, `x / 12.92` up to 0.04045 and
/// `((x + 0.055) / 1.055)^2.4` above.
///
/// At most 7 ulp off for `x` in `[0, 1]`: the power enlarges the rounding of what it is taken of.
/// Beyond 1 the curve goes on, below 0 the line does.
#[kernel]
#[inline]
pub fn srgb_to_linear(x: f32) -> f32 {
    if x <= 0.04045 { x / 12.92 } else { pow((x + 0.055) / 1.055, 2.4) }
}

/// From linear to sRGB, the inverse of [`srgb_to_linear()`]: `12.92 x` up to 0.0031308 and
/// `1.055 x^(1/2.4) - 0.055` above. At most 4 ulp off for `x` in `[0, 1]`.
#[kernel]
#[inline]
pub fn linear_to_srgb(x: f32) -> f32 {
    if x <= 0.0031308 { x * 12.92 } else { 1.055 * pow(x, 1.0 / 2.4) - 0.055 }
}
