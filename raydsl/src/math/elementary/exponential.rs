//! Exponential functions: `exp`, `exp2`, `expm1`.

use core::f32::consts::LOG2_E;

use super::function::Function;
use super::parts::{exp2_near_zero, power_of_two, scaled};
use crate::kernel;
use crate::machine::generic::clamp;

/// Upper 13 bits of ln 2, so that the product with an exponent is exact.
pub(super) const LN_2_HIGH: f32 = 0.69311523;
/// Rest of ln 2.
pub(super) const LN_2_LOW: f32 = 3.1946183e-5;

/// Returns `e^x`.
///
/// At most 0.98 ulp off. Infinity above 88.72, 0 below -103.97, 1 at both zeros.
///
/// `x = n ln 2 + r` with a whole `n` and `|r| <= ln 2 / 2` by two parts of ln 2 (Cody and Waite,
/// 1980), then a polynomial of degree 6 in `r`.
#[kernel(known = Function::Exp)]
#[inline]
pub fn exp(x: f32) -> f32 {
    // Arguments outside overflow or vanish like the limits.
    let y = clamp(x, -105.0, 90.0);
    let n = (y * LOG2_E + 0.5).floor();
    let r = (y - n * LN_2_HIGH) - n * LN_2_LOW;
    let p =
        0.49999994 + r * (0.16666517 + r * (0.041668102 + r * (0.008369193 + r * 0.0013838839)));
    scaled(1.0 + (r + r * r * p), n as i32)
}

/// Returns `2^x`.
///
/// At most 1.09 ulp off, and exact where `x` is whole. Infinity from 128 on, 0 from -150 down.
///
/// The whole part goes to the exponent, the rest through a polynomial of degree 6.
#[kernel(known = Function::Exp2)]
#[inline]
pub fn exp2(x: f32) -> f32 {
    let y = clamp(x, -151.0, 129.0);
    let n = (y + 0.5).floor();
    scaled(exp2_near_zero(y - n), n as i32)
}

/// Returns `e^x - 1`, without the loss of `exp(x) - 1.0` near 0.
///
/// At most 1.45 ulp off. Infinity above 88.72, -1 far below 0, `x` itself next to 0 (-0 gives -0).
///
/// With `x = n ln 2 + r` as in [`exp()`] and `e = e^r - 1`, the result is `2^n (e + (1 - 2^-n))`:
/// for `n = 0` nothing is added.
#[kernel(known = Function::Expm1)]
#[inline]
pub fn expm1(x: f32) -> f32 {
    let y = clamp(x, -18.0, 90.0);
    let n = (y * LOG2_E + 0.5).floor();
    let r = (y - n * LN_2_HIGH) - n * LN_2_LOW;
    let q = 0.04166649 + r * (0.008333206 + r * (0.0013932673 + r * 0.0001994595));
    let e = r + r * r * (0.5 + r * (0.16666667 + r * q));
    let whole = n as i32;
    // From 2^25 on, the subtracted 1 is below the last bit.
    let rest = 1.0 - power_of_two(-whole.min(60));
    scaled(e + rest, whole).copysign(x)
}
