//! Trigonometric functions: `sin`, `cos`, `tan`, `sincos_2pi`.

use core::f32::consts::{FRAC_2_PI, FRAC_PI_2, TAU};

use super::function::Function;
use super::parts::turned;
use crate::{Type, kernel};

/// Upper 11 bits of pi / 2: products with whole numbers below 2^13 are exact.
const FRAC_PI_2_1: f32 = 1.5703125;
/// Next 11 bits of pi / 2.
const FRAC_PI_2_2: f32 = 0.0004837513;
/// Next 11 bits of pi / 2.
const FRAC_PI_2_3: f32 = 7.5495336e-8;
/// Rest of pi / 2.
const FRAC_PI_2_4: f32 = 2.563344e-12;
/// Rest of pi / 2 after its upper 8 bits, which are `FRAC_PI_2_1`.
const FRAC_PI_2_REST: f32 = 0.0004838268;

/// Returns the sine of an angle in radians.
///
/// At most 1.64 ulp off, for every number, however large. NaN at the infinities; -0 gives -0.
///
/// The angle is reduced to at most pi / 4: below 8192 by pi / 2 in four parts (Cody and Waite,
/// 1980), else by the relevant bits of 2 / pi (Payne and Hanek, 1983). Packets skip a branch that
/// no lane takes.
#[kernel(known = Function::Sin)]
#[inline]
pub fn sin(x: f32) -> f32 {
    let angle = reduced(x.abs());
    turned(wave(angle, angle.quarters), x.to_bits())
}

/// Returns the cosine of an angle in radians.
///
/// At most 1.71 ulp off, for every number, however large. NaN at the infinities.
///
/// As [`sin()`], a quarter of a turn ahead.
#[kernel(known = Function::Cos)]
#[inline]
pub fn cos(x: f32) -> f32 {
    let angle = reduced(x.abs());
    wave(angle, angle.quarters.wrapping_add(1))
}

/// Returns the tangent of an angle in radians.
///
/// At most 2.54 ulp off, for every number, however large. NaN at the infinities; -0 gives -0.
///
/// The angle is reduced as in [`sin()`]; in odd quarters `tan(r + pi/2) = -1 / tan(r)`.
#[kernel(known = Function::Tan)]
#[inline]
pub fn tan(x: f32) -> f32 {
    let angle = reduced(x.abs());
    let r = angle.rest;
    let z = r * r;
    let p = 0.021238612 + z * (0.010945531 + z * (-4.615774e-5 + z * 0.0044418084));
    let series = r * z * (0.33333352 + z * (0.13332583 + z * (0.05406865 + z * p)));
    let t = r + (series - (angle.tail + angle.tail * z));
    let v = if (angle.quarters & 1) == 0 { t } else { -1.0 / t };
    turned(v, x.to_bits())
}

/// Sine and cosine of one angle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct SinCos {
    /// The sine.
    pub sin: f32,
    /// The cosine.
    pub cos: f32,
}

/// Returns the sine and the cosine of `2 pi u`: of an angle in turns.
///
/// At most 1.60 ulp off, for every number. NaN at the infinities. Multiples of a quarter return
/// exact zeros and ones; a zero sine has the sign of `u`, a zero cosine is +0 (as IEEE 754's
/// `sinPi` and `cosPi`).
///
/// Turns are reduced without an error, so this is both more accurate and faster than [`sin()`] of a
/// product with 2 pi.
#[kernel(known = Function::SinCos2Pi)]
#[inline]
pub fn sincos_2pi(u: f32) -> SinCos {
    let a = u.abs();
    let turn = a - a.floor();
    let n = (4.0 * turn + 0.5).floor();
    let r = turn - 0.25 * n;
    let z = r * r;
    let s = r * (TAU + z * (-41.341873 + z * (81.62744 + z * -76.8646)));
    let c = 1.0 + z * (-19.739208 + z * (64.93914 + z * (-85.42312 + z * 58.561153)));
    let quarters = n as u32;
    let is_odd = (quarters & 1) != 0;
    let sin = if is_odd { c } else { s };
    let cos = if is_odd { s } else { c };
    // Adding 0 turns -0 into +0.
    let sin = turned(sin, quarters << 30) + 0.0;
    let cos = turned(cos, quarters.wrapping_add(1) << 30) + 0.0;
    SinCos { sin: turned(sin, u.to_bits()), cos }
}

/// Reduced angle `rest - tail + quarters pi/2`, with `rest` from -pi / 4 to pi / 4, a `tail` below
/// its last bits, and `quarters` modulo 4.
#[derive(Clone, Copy, Debug, Type)]
#[repr(C)]
struct Reduced {
    rest: f32,
    tail: f32,
    quarters: u32,
}

/// Returns the sine of the `rest` after this many quarters of a turn.
#[kernel]
#[inline]
fn wave(angle: Reduced, quarters: u32) -> f32 {
    let r = angle.rest;
    let z = r * r;
    let sin_series = r * z * (-0.16666655 + z * (0.008332191 + z * -0.00019518605));
    let sin = r + (sin_series - angle.tail);
    let cos_series = z * z * (0.041666646 + z * (-0.001388731 + z * 2.4432327e-5));
    let cos = 1.0 - (0.5 * z - (cos_series + r * angle.tail));
    let v = if (quarters & 1) == 0 { sin } else { cos };
    turned(v, quarters << 30)
}

/// Reduces a non-negative angle.
#[kernel]
#[inline]
fn reduced(a: f32) -> Reduced {
    if a < 8192.0 {
        let n = (a * FRAC_2_PI + 0.5).floor();
        let rest = ((a - n * FRAC_PI_2_1) - n * FRAC_PI_2_2) - n * FRAC_PI_2_3;
        Reduced { rest, tail: n * FRAC_PI_2_4, quarters: n as u32 }
    } else {
        reduced_large(a)
    }
}

/// Reduces an angle from 2^13 on; infinity and NaN return NaN.
///
/// With `a = m 2^e`, bits of 2 / pi that contribute a multiple of 4 to `a 2/pi` do not matter: 96
/// bits are taken from the first one that does. The upper 64 bits of their product with `m` are two
/// bits of quarters and 62 of a fraction. No number comes closer to a multiple of pi / 2 than about
/// 2^-30 of it, so at least 30 bits remain.
#[kernel]
fn reduced_large(a: f32) -> Reduced {
    let bits = a.to_bits();
    let m = (bits & 0x007f_ffff) | 0x0080_0000;
    let first = (bits >> 23).wrapping_sub(120);
    let words = two_over_pi(first >> 5);
    let shift = first & 31;
    // Two shifts to the right, since one by 32 is not allowed.
    let back = shift ^ 31;
    let w0 = (words.a << shift) | ((words.b >> 1) >> back);
    let w1 = (words.b << shift) | ((words.c >> 1) >> back);
    let w2 = (words.c << shift) | ((words.d >> 1) >> back);

    let product = m.wrapping_mul(w1);
    let low = product.wrapping_add(upper_half(m, w2));
    let carry = (low < product) as u32;
    let high = m.wrapping_mul(w0).wrapping_add(upper_half(m, w1)).wrapping_add(carry);

    // Round to the nearest quarter; the fraction is then signed.
    let quarters = high.wrapping_add(0x2000_0000) >> 30;
    let fraction = (high << 2) | (low >> 30);
    let flip = ((fraction as i32) >> 31) as u32;
    let upper = fraction ^ flip;
    let lower = (low << 2) ^ flip;

    // The upper 16 bits times the upper 8 of pi / 2 are exact. Factors: 2^-16, 2^-32, 2^-64.
    let v = (upper >> 16) as f32 * 1.5258789e-5;
    let w = (upper & 0xffff) as f32 * 2.3283064e-10 + lower as f32 * 5.421011e-20;
    let rest = v * FRAC_PI_2_1 + (v * FRAC_PI_2_REST + w * FRAC_PI_2);
    Reduced { rest: if a <= f32::MAX { turned(rest, flip) } else { f32::NAN }, tail: 0.0, quarters }
}

/// Returns the upper word of the product of a number of 24 bits and one of 32.
#[kernel]
#[inline]
fn upper_half(m: u32, w: u32) -> u32 {
    let m_low = m & 0xffff;
    let m_high = m >> 16;
    let w_low = w & 0xffff;
    let w_high = w >> 16;
    let cross = m_low.wrapping_mul(w_high);
    let middle = (m_low.wrapping_mul(w_low) >> 16)
        .wrapping_add(cross & 0xffff)
        .wrapping_add(m_high.wrapping_mul(w_low));
    m_high.wrapping_mul(w_high).wrapping_add(cross >> 16).wrapping_add(middle >> 16)
}

/// Four words of bits.
#[derive(Clone, Copy, Debug, Type)]
#[repr(C)]
struct Words {
    a: u32,
    b: u32,
    c: u32,
    d: u32,
}

/// Returns four words of 2 / pi from the word `i` on; the first is the one before the binary point.
#[kernel]
#[inline]
fn two_over_pi(i: u32) -> Words {
    if i == 0 {
        Words { a: 0, b: 0xa2f9_836e, c: 0x4e44_1529, d: 0xfc27_57d1 }
    } else if i == 1 {
        Words { a: 0xa2f9_836e, b: 0x4e44_1529, c: 0xfc27_57d1, d: 0xf534_ddc0 }
    } else if i == 2 {
        Words { a: 0x4e44_1529, b: 0xfc27_57d1, c: 0xf534_ddc0, d: 0xdb62_9599 }
    } else if i == 3 {
        Words { a: 0xfc27_57d1, b: 0xf534_ddc0, c: 0xdb62_9599, d: 0x3c43_9041 }
    } else {
        Words { a: 0xf534_ddc0, b: 0xdb62_9599, c: 0x3c43_9041, d: 0xfe51_63ab }
    }
}
