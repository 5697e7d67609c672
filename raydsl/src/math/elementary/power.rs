//! Power function: `pow`.

use super::function::Function;
use super::parts::{exp2_near_zero, head, is_nan, scaled, split};
use crate::kernel;
use crate::machine::generic::clamp;

/// Returns `x` to the power of `y`.
///
/// At most 1.26 ulp off. The special values are those of C (C17, F.10.4.4) and of IEEE 754's `pow`:
/// 1 where `x` is 1 or `y` is 0, whatever the other one is, and where `x` is -1 and `y` infinite;
/// NaN for a negative `x` and a `y` that is not whole; signed zeros and infinities by whether `y`
/// is odd.
///
/// Computes `2^(y log2(x))`, where the logarithm and its product with `y` are sums of two numbers,
/// together about 35 bits, as in FreeBSD's msun, `e_powf.c`: with `s = (m - 1) / (m + 1)` of the
/// mantissa `m` in two parts, `log(m) = 2/3 s (3 + s² + s⁴ G(s²))`.
#[kernel(known = Function::Pow)]
#[inline]
pub fn pow(x: f32, y: f32) -> f32 {
    let a = x.abs();
    let b = y.abs();
    let is_whole = b.floor() == b;
    let is_odd = is_whole && (b * 0.5).floor() != b * 0.5;

    // Compute `s` of the mantissa in two parts.
    let parts = split(a);
    let m = parts.mantissa;
    let k = parts.exponent;
    let f = m - 1.0;
    let d = m + 1.0;
    let s = f / d;
    let s_high = head(s);
    let d_high = head(d);
    let d_low = m - (d_high - 1.0);
    let s_low = ((f - s_high * d_high) - s_high * d_low) / d;

    // Compute `s (3 + s² + s⁴ G(s²))` in two parts.
    let z = s * s;
    let z_high = s_high * s_high;
    let g = 0.6000023 + z * (0.42820632 + z * 0.35129592);
    let rest = z * z * g + s_low * (s_high + s);
    let t_high = head(3.0 + z_high + rest);
    let t_low = rest - ((t_high - 3.0) - z_high);
    let u = s_high * t_high;
    let v = s_low * t_high + t_low * s;
    let p_high = head(u + v);
    let p_low = v - (p_high - u);

    // Multiply by 2 / (3 ln 2), whose first part has the upper 12 bits.
    let q_high = 0.9616699 * p_high;
    let q_low = 0.00012677205 * p_high + p_low * 0.9617967;
    let log_high = head((q_low + q_high) + k);
    let log_low = q_low - ((log_high - k) - q_high);

    // The least logarithm that is not 0 is 2^-24 and the exponent at most 2^8: a larger y overflows
    // or vanishes all the same, but an infinite one would give NaN.
    let e = clamp(y, -1e12, 1e12);
    let e_high = head(e);
    let high = e_high * log_high;
    let low = (e - e_high) * log_high + e * log_low;
    let n = (clamp(high + low, -152.0, 130.0) + 0.5).floor();
    let r = clamp((high - n) + low, -1.0, 1.0);
    let size = scaled(exp2_near_zero(r), n as i32);
    let power = if is_odd { size.copysign(x) } else { size };

    let is_usual = a > 0.0 && a <= f32::MAX && b <= f32::MAX && (x > 0.0 || is_whole);
    if is_usual { power } else { pow_at_the_ends(x, y, is_odd) }
}

/// Returns powers of 0, infinity and NaN, infinite or NaN powers, and roots of negative numbers.
#[kernel]
#[inline]
fn pow_at_the_ends(x: f32, y: f32, is_odd: bool) -> f32 {
    let a = x.abs();
    if x == 1.0 || y == 0.0 {
        return 1.0;
    }
    if is_nan(x) || is_nan(y) {
        return f32::NAN;
    }
    if y.abs() > f32::MAX {
        if a == 1.0 {
            return 1.0;
        }
        return if (a > 1.0) == (y > 0.0) { f32::INFINITY } else { 0.0 };
    }
    if a > 0.0 && a <= f32::MAX {
        return f32::NAN;
    }
    let size = if (a > 0.0) == (y > 0.0) { f32::INFINITY } else { 0.0 };
    size.copysign(if is_odd { x } else { 1.0 })
}
