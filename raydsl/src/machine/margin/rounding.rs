//! Rounding models of the variants.

use super::F32Binary;
use super::interval::{Interval, Rounded};

/// The rounding errors of a variant's operations, each relative to its exact result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding {
    /// `+ - *` and conversions of integers.
    pub sum: f64,
    /// Division.
    pub quotient: f64,
    /// `sqrt`.
    pub root: f64,
    /// The elementary functions of [`crate::math::elementary`].
    pub elementary: f64,
    /// The absolute error of any of them in addition, near 0.
    pub least: f64,
    /// Whether the operations are those of the source, one by one, and a result representable in
    /// `f32` is exact. If not, sums may be evaluated in any order, a product in a sum may be fused
    /// into it, a quotient or a root of whole numbers may be rounded like any other, and denormals
    /// may be 0.
    pub is_strict: bool,
}

/// One ulp of a number, relative to it: 2^-23.
const ULP: f64 = f32::EPSILON as f64;

impl Rounding {
    /// IEEE 754, rounding to nearest: the CPU's variants, and devices that follow it. Elementary
    /// functions are at most 4 ulp off.
    pub const IEEE: Self = Self {
        sum: 0.5 * ULP,
        quotient: 0.5 * ULP,
        root: 0.5 * ULP,
        elementary: 4.0 * ULP,
        least: 1.0 / (1u128 << 126) as f64 / (1 << 24) as f64,
        is_strict: true,
    };

    /// WGSL's requirements on a device: either neighbour of a sum or product, 2.5 ulp for a
    /// quotient whose divisor is between 2^-126 and 2^126, `sqrt` as `1 / inverseSqrt`, denormals
    /// as 0, sums in any order. For elementary functions, which are chains of these, 16 ulp are an
    /// estimate. Not covered: products whose other order would overflow.
    pub const WGSL: Self = Self {
        sum: ULP,
        quotient: 2.5 * ULP,
        root: 5.0 * ULP,
        elementary: 16.0 * ULP,
        least: f32::MIN_POSITIVE as f64,
        is_strict: false,
    };

    /// Returns the bound for an operation; it includes the rounding of the interval's ends and the
    /// reference in `f64`.
    fn rounded(self, relative: f64) -> Rounded {
        Rounded { relative: relative * (1.0 + 1.0 / (1 << 20) as f64), absolute: self.least }
    }

    pub(super) fn sum(self) -> Rounded {
        self.rounded(self.sum)
    }

    /// Returns the bound for a product; one with a power of two is exact, except near 0.
    pub(super) fn product(self, a: Interval, b: Interval) -> Rounded {
        let exact = is_power_of_two(a) || is_power_of_two(b);
        self.rounded(if exact { 0.0 } else { self.sum })
    }

    pub(super) fn quotient(self, by: Interval) -> Rounded {
        self.rounded(if self.is_strict && is_power_of_two(by) { 0.0 } else { self.quotient })
    }

    /// Returns whether a quotient by this has a bound.
    pub(super) fn divides(self, by: Interval) -> bool {
        let (size, limit) = (by.abs(), 1.0 / f64::from(f32::MIN_POSITIVE));
        self.is_strict || size.low >= 1.0 / limit && size.high <= limit
    }

    /// Returns the interval of a number of the input or of the scene.
    pub(super) fn taken(self, v: f32) -> Interval {
        let number = Interval::point(f64::from(v));
        let flushed = !self.is_strict && v.is_subnormal();
        if flushed { number.hull(Interval::point(0f64.copysign(v.into()))) } else { number }
    }

    pub(super) fn root(self) -> Rounded {
        self.rounded(self.root)
    }

    pub(crate) fn function(self) -> Rounded {
        Rounded { absolute: 8.0 * self.least, ..self.rounded(self.elementary) }
    }
}

fn is_power_of_two(x: Interval) -> bool {
    x.as_point().is_some_and(|v| v.is_normal() && v.to_bits() & ((1 << 52) - 1) == 0)
}

/// Returns the result of an operation on two `f32` numbers, if it is representable in `f32` or NaN.
pub(super) fn exact(op: F32Binary, x: f64, y: f64) -> Option<f64> {
    let (a, b) = (x as f32, y as f32);
    if f64::from(a) != x || f64::from(b) != y {
        return None;
    }
    let (short, long) = match op {
        F32Binary::Add => (a + b, x + y),
        F32Binary::Sub => (a - b, x - y),
        F32Binary::Mul => (a * b, x * y),
        F32Binary::Div => (a / b, x / y),
        F32Binary::Min => (if b < a { b } else { a }, if y < x { y } else { x }),
        F32Binary::Max => (if a < b { b } else { a }, if x < y { y } else { x }),
    };
    if short.is_nan() {
        return Some(f64::NAN);
    }
    // The product of two `f32` is exact in `f64`; the error of a sum is Knuth's.
    let is_exact = !short.is_finite()
        || match op {
            F32Binary::Add => lost(x, y) == 0.0,
            F32Binary::Sub => lost(x, -y) == 0.0,
            F32Binary::Div => long * y == x,
            _ => true,
        };
    (f64::from(short) == long && is_exact).then_some(long)
}

/// Returns the rounding error of `x + y` (Knuth's `TwoSum`).
fn lost(x: f64, y: f64) -> f64 {
    let sum = x + y;
    let part = sum - x;
    (x - (sum - part)) + (y - part)
}

/// Returns the square root, if it is representable in `f32` or NaN.
pub(super) fn exact_root(x: f64) -> Option<f64> {
    let (short, long) = ((x as f32).sqrt(), x.sqrt());
    if long.is_nan() {
        return Some(long);
    }
    (f64::from(short) == long && (long * long == x || !long.is_finite())).then_some(long)
}
