//! Decomposition and composition of floats.

use crate::{Type, kernel};

/// Returns the upper 12 bits of a number's mantissa: the product of two heads is exact, and
/// `x - head(x)` has the 12 lower ones.
#[kernel]
#[inline]
pub(super) fn head(x: f32) -> f32 {
    f32::from_bits(x.to_bits() & 0xffff_f000)
}

/// Flips the sign of `x` by the uppermost bit of `sign`.
#[kernel]
#[inline]
pub(super) fn turned(x: f32, sign: u32) -> f32 {
    f32::from_bits(x.to_bits() ^ (sign & 0x8000_0000))
}

#[kernel]
#[inline]
pub(super) fn is_nan(x: f32) -> bool {
    (x.to_bits() & 0x7fff_ffff) > 0x7f80_0000
}

/// Returns `2^n` for `n` from -126 to 127.
#[kernel]
#[inline]
pub(super) fn power_of_two(n: i32) -> f32 {
    f32::from_bits((n.wrapping_add(127) as u32) << 23)
}

/// Returns `x * 2^n` for `n` from -252 to 254: of two factors the first leaves a number near 1
/// normal, so that a denormal result is rounded once.
#[kernel]
#[inline]
pub(super) fn scaled(x: f32, n: i32) -> f32 {
    let half = n >> 1;
    x * power_of_two(half) * power_of_two(n.wrapping_sub(half))
}

/// Returns `2^r` for `r` from -0.5 to 0.5, and a number of that size up to 1.
#[kernel]
#[inline]
pub(super) fn exp2_near_zero(r: f32) -> f32 {
    let p =
        0.2402265 + r * (0.055503596 + r * (0.0096180625 + r * (0.001339101 + r * 0.00015462885)));
    1.0 + r * (core::f32::consts::LN_2 + r * p)
}

/// Positive number as `mantissa * 2^exponent`, the mantissa from `sqrt(1/2)` to `sqrt(2)`.
#[derive(Clone, Copy, Debug, Type)]
#[repr(C)]
pub(super) struct Split {
    pub(super) mantissa: f32,
    pub(super) exponent: f32,
}

#[kernel]
#[inline]
pub(super) fn split(x: f32) -> Split {
    let is_denormal = x < f32::MIN_POSITIVE;
    let normal = if is_denormal { x * 33554432.0 } else { x };
    let shift = if is_denormal { 25.0 } else { 0.0 };
    // The bits of sqrt(1/2): the excess over them in steps of 2^23 is the exponent.
    let above = normal.to_bits().wrapping_sub(0x3f35_04f3);
    let mantissa = f32::from_bits((above & 0x007f_ffff).wrapping_add(0x3f35_04f3));
    Split { mantissa, exponent: ((above as i32) >> 23) as f32 - shift }
}
