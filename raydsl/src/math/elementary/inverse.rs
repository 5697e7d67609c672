//! Inverse trigonometric functions: `asin`, `acos`, `atan`, `atan2`.

use core::f32::consts::{FRAC_PI_2, PI};

use super::function::Function;
use super::parts::{is_nan, turned};
use crate::kernel;
use crate::machine::generic::{max, min};

/// Excess of `FRAC_PI_2` over pi / 2.
const FRAC_PI_2_EXCESS: f32 = 4.371139e-8;
/// Excess of `PI` over pi.
const PI_EXCESS: f32 = 8.742278e-8;
/// Upper 8 bits of pi / 4: multiples up to four are exact.
const FRAC_PI_4_HIGH: f32 = 0.78515625;
/// Rest of pi / 4.
const FRAC_PI_4_LOW: f32 = 0.0002419134;

/// Returns the arc sine, from -pi / 2 to pi / 2.
///
/// At most 2.36 ulp off. NaN outside -1 to 1; -0 gives -0.
///
/// A polynomial up to 1/2; above, `asin(x) = pi/2 - 2 asin(sqrt((1 - x) / 2))` (Cody and Waite,
/// 1980, chapter 10).
#[kernel(known = Function::Asin)]
#[inline]
pub fn asin(x: f32) -> f32 {
    let a = x.abs();
    let is_far = a > 0.5;
    let z = if is_far { (1.0 - a) * 0.5 } else { a * a };
    let s = if is_far { z.sqrt() } else { a };
    let p = asin_series(s, z);
    let v = if is_far { FRAC_PI_2 - (2.0 * p + FRAC_PI_2_EXCESS) } else { p };
    if a <= 1.0 { v.copysign(x) } else { f32::NAN }
}

/// Returns the arc cosine, from 0 to pi.
///
/// At most 1.13 ulp off. NaN outside -1 to 1.
///
/// `pi/2 - asin(x)` up to 1/2; above, `2 asin(sqrt((1 - x) / 2))`, which loses nothing near 1.
#[kernel(known = Function::Acos)]
#[inline]
pub fn acos(x: f32) -> f32 {
    let a = x.abs();
    let is_far = a > 0.5;
    let z = if is_far { (1.0 - a) * 0.5 } else { a * a };
    let s = if is_far { z.sqrt() } else { a };
    let p = asin_series(s, z);
    let near = FRAC_PI_2 - (p.copysign(x) + FRAC_PI_2_EXCESS);
    let far = if x > 0.0 { 2.0 * p } else { PI - (2.0 * p + PI_EXCESS) };
    let v = if is_far { far } else { near };
    if a <= 1.0 { v } else { f32::NAN }
}

/// Returns `asin(s)` from `s` and `z = s²`, up to 1/2.
#[kernel]
#[inline]
fn asin_series(s: f32, z: f32) -> f32 {
    let p = 0.04547666 + z * (0.024148121 + z * 0.04221983);
    s + s * z * (0.16666754 + z * (0.07495249 + z * p))
}

/// Returns the arc tangent, from -pi / 2 to pi / 2.
///
/// At most 1.87 ulp off. ±pi / 2 at ±infinity; -0 gives -0.
///
/// With `k` eighths of a turn subtracted, `atan(x) = k pi/4 + atan(q)` with `|q| <= tan(pi/8)`: `q`
/// is `x`, `(x - 1) / (x + 1)` or `-1 / x` (Cephes, `atanf.c`).
#[kernel(known = Function::Atan)]
#[inline]
pub fn atan(x: f32) -> f32 {
    let a = x.abs();
    let is_middle = a > 0.41421357;
    let is_steep = a > 2.4142135;
    let upper = if is_middle { a - 1.0 } else { a };
    let lower = if is_middle { a + 1.0 } else { 1.0 };
    let above = if is_steep { -1.0 } else { upper };
    let below = if is_steep { a } else { lower };
    let k = (is_middle as u32 + is_steep as u32) as f32;
    atan_of_parts(k, above / below).copysign(x)
}

/// Returns the angle of the point `(x, y)`, from -pi to pi, counted from the axis of x.
///
/// At most 2.0 ulp off. Zeros, signs and infinities as in C (C17, F.10.1.4): ±0 for a `y` of ±0
/// and a positive `x` or +0, ±pi for a negative `x` or -0, ±pi / 2 for an `x` of 0, multiples of
/// pi / 4 where both are infinite.
///
/// Computes the arc tangent of the smaller part over the larger one, and the quadrant from the
/// signs.
#[kernel(known = Function::Atan2)]
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    let width = x.abs();
    let height = y.abs();
    let mut long = max(width, height);
    let mut short = min(width, height);
    if long > f32::MAX || long == 0.0 {
        short = if short > f32::MAX { 1.0 } else { 0.0 };
        long = 1.0;
    }
    // The sum of two large numbers would overflow, the quotient of two denormals is coarse.
    let scale = if long > 1e19 { 0.25 } else { 1.0 };
    let scale = if long < 7.888609e-31 { 16777216.0 } else { scale };
    let long = long * scale;
    let short = short * scale;
    let is_middle = short > 0.41421357 * long;
    let above = if is_middle { short - long } else { short };
    let below = if is_middle { short + long } else { long };
    let q = above / below;
    // From the octant to the half plane: mirror at the diagonal, then at the axis of y.
    let k = is_middle as u32;
    let is_high = height > width;
    let k = if is_high { 2 - k } else { k };
    let is_left = (x.to_bits() >> 31) != 0;
    let k = if is_left { 4 - k } else { k };
    let mirrored = ((is_high as u32) ^ (is_left as u32)) << 31;
    let angle = atan_of_parts(k as f32, turned(q, mirrored));
    if is_nan(x) || is_nan(y) { f32::NAN } else { angle.copysign(y) }
}

/// Returns `k pi/4 + atan(q)` for a `k` up to 4 and `|q| <= tan(pi/8)`.
#[kernel]
#[inline]
fn atan_of_parts(k: f32, q: f32) -> f32 {
    let z = q * q;
    let p = -0.14244422 + z * (0.10599357 + z * -0.060903553);
    let rest = q * z * (-0.33333316 + z * (0.1999853 + z * p));
    k * FRAC_PI_4_HIGH + (q + (rest + k * FRAC_PI_4_LOW))
}
