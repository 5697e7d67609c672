//! Logarithms: `log`, `log2`, `log1p`.

use super::exponential::{LN_2_HIGH, LN_2_LOW};
use super::function::Function;
use super::parts::{head, power_of_two, split};
use crate::kernel;

/// Upper 12 bits of 1 / ln 2.
const LOG2_E_HIGH: f32 = 1.4423828;
/// Rest of 1 / ln 2.
const LOG2_E_LOW: f32 = 0.0003122284;

/// Returns the natural logarithm.
///
/// At most 0.82 ulp off. -infinity at both zeros, NaN below, 0 at 1, infinity at infinity.
///
/// `x = m 2^k` with `m` from `sqrt(1/2)` to `sqrt(2)`. With `f = m - 1` and `s = f / (2 + f)`,
/// `log(1 + f) = 2 atanh(s) = f - f²/2 + s (f²/2 + R(s²))` (the form of FreeBSD's msun, `e_log.c`,
/// after Remez), and `k ln 2` is added in two parts.
#[kernel(known = Function::Log)]
#[inline]
pub fn log(x: f32) -> f32 {
    let parts = split(x);
    let v = log_of_parts(parts.mantissa - 1.0, parts.exponent);
    if x > 0.0 && x <= f32::MAX { v } else { log_at_the_ends(x) }
}

/// Returns the logarithm to base 2.
///
/// At most 0.87 ulp off, and exact at powers of 2. -infinity at both zeros, NaN below, infinity at
/// infinity.
///
/// As [`log()`], with the logarithm of the mantissa in two parts for the product with 1 / ln 2.
#[kernel(known = Function::Log2)]
#[inline]
pub fn log2(x: f32) -> f32 {
    let parts = split(x);
    let f = parts.mantissa - 1.0;
    let s = f / (2.0 + f);
    let half = 0.5 * f * f;
    let high = head(f - half);
    let low = (f - high) - half + s * (half + log_rest(s * s));
    let small = (low + high) * LOG2_E_LOW + low * LOG2_E_HIGH;
    let v = small + high * LOG2_E_HIGH + parts.exponent;
    if x > 0.0 && x <= f32::MAX { v } else { log_at_the_ends(x) }
}

/// Returns `log(1 + x)`, without the loss of `log(1.0 + x)` near 0.
///
/// At most 1.39 ulp off. -infinity at -1, NaN below, `x` itself next to 0 (-0 gives -0), infinity
/// at infinity.
///
/// The rounded `1 + x` only determines the exponent `k`. `f = 2^-k x + (2^-k - 1)` is then
/// `2^-k (1 + x) - 1`: `x` itself for `k = 0`, else rounded once where the result is large.
#[kernel(known = Function::Log1p)]
#[inline]
pub fn log1p(x: f32) -> f32 {
    let y = 1.0 + x;
    let k = (y.to_bits().wrapping_sub(0x3f35_04f3) as i32) >> 23;
    // Four times 2^-k, a normal number for k = 128 too.
    let scale = power_of_two(2 - k);
    let f = x * scale * 0.25 + (scale * 0.25 - 1.0);
    let v = log_of_parts(f, k as f32).copysign(x);
    if x > -1.0 && x <= f32::MAX { v } else { log_at_the_ends(y) }
}

/// Returns `log((1 + f) 2^k)`.
#[kernel]
#[inline]
fn log_of_parts(f: f32, k: f32) -> f32 {
    let s = f / (2.0 + f);
    let half = 0.5 * f * f;
    let small = s * (half + log_rest(s * s)) + k * LN_2_LOW;
    k * LN_2_HIGH + (f - (half - small))
}

/// Returns `2 atanh(s) / s - 2` from `z = s²`.
#[kernel]
#[inline]
fn log_rest(z: f32) -> f32 {
    z * (0.66666776 + z * (0.39977568 + z * 0.2987146))
}

/// Returns the logarithms of 0, infinity, NaN and negative numbers.
#[kernel]
#[inline]
fn log_at_the_ends(x: f32) -> f32 {
    if x == 0.0 {
        f32::NEG_INFINITY
    } else if x < 0.0 {
        f32::NAN
    } else {
        x
    }
}
