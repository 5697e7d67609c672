//! sRGB transfer functions.

use crate::kernel;
use crate::math::elementary::pow;

/// Converts from sRGB to linear by the piecewise curve of IEC 61966-2-1: `x / 12.92` up to 0.04045
/// and `((x + 0.055) / 1.055)^2.4` above.
///
/// At most 7 ulp off for `x` in `[0, 1]`: the power amplifies the rounding of its base. The curve
/// continues beyond 1, the line below 0.
#[kernel]
#[inline]
pub fn srgb_to_linear(x: f32) -> f32 {
    if x <= 0.04045 { x / 12.92 } else { pow((x + 0.055) / 1.055, 2.4) }
}

/// Converts from linear to sRGB, the inverse of [`srgb_to_linear()`]: `12.92 x` up to 0.0031308 and
/// `1.055 x^(1/2.4) - 0.055` above. At most 4 ulp off for `x` in `[0, 1]`.
#[kernel]
#[inline]
pub fn linear_to_srgb(x: f32) -> f32 {
    if x <= 0.0031308 { x * 12.92 } else { 1.055 * pow(x, 1.0 / 2.4) - 0.055 }
}
