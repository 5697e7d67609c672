//! Methods of `f32`: std's, and those of glam's `FloatExt`.

use super::super::{
    B, Coerce, Compare, F, F32Binary, F32Unary, I, Machine, Op, U, op, vector::Arithmetic,
};
use super::{Method, name};

/// Returns std's `min` or `max`: if one operand is NaN they return the other.
#[inline(always)]
fn number_of<M: Machine, O: Op<F32Binary>>(m: &M, op: O, a: F<M>, b: F<M>) -> F<M> {
    let chosen = m.f32_binary(op, a.0, b.0);
    let a_is_nan = m.f32_compare(op::Ne, a.0, a.0);
    F(m.f32_select(a_is_nan, b.0, chosen))
}

#[inline(always)]
pub(super) fn add<M: Machine>(m: &M, a: F<M>, b: F<M>) -> F<M> {
    F(m.f32_binary(op::Add, a.0, b.0))
}

#[inline(always)]
pub(super) fn sub<M: Machine>(m: &M, a: F<M>, b: F<M>) -> F<M> {
    F(m.f32_binary(op::Sub, a.0, b.0))
}

#[inline(always)]
pub(super) fn mul<M: Machine>(m: &M, a: F<M>, b: F<M>) -> F<M> {
    F(m.f32_binary(op::Mul, a.0, b.0))
}

#[inline(always)]
pub(super) fn div<M: Machine>(m: &M, a: F<M>, b: F<M>) -> F<M> {
    F(m.f32_binary(op::Div, a.0, b.0))
}

#[inline(always)]
pub(super) fn unary<M: Machine, O: Op<F32Unary>>(m: &M, op: O, a: F<M>) -> F<M> {
    F(m.f32_unary(op, a.0))
}

#[inline(always)]
pub(super) fn number<M: Machine>(m: &M, v: f32) -> F<M> {
    F(m.f32(v))
}

#[inline(always)]
pub(super) fn select<M: Machine>(m: &M, c: B<M>, a: F<M>, b: F<M>) -> F<M> {
    F(m.f32_select(c.0, a.0, b.0))
}

#[inline(always)]
pub(super) fn compare<M: Machine, O: Op<Compare>>(m: &M, op: O, a: F<M>, b: F<M>) -> B<M> {
    B(m.f32_compare(op, a.0, b.0))
}

#[inline(always)]
pub(super) fn clamp<M: Machine>(m: &M, a: F<M>, low: F<M>, high: F<M>) -> F<M> {
    let raised = m.f32_binary(op::Max, a.0, low.0);
    F(m.f32_binary(op::Min, raised, high.0))
}

#[inline(always)]
pub(super) fn copysign<M: Machine>(m: &M, a: F<M>, sign: F<M>) -> F<M> {
    F(m.f32_copysign(a.0, sign.0))
}

#[inline(always)]
pub(super) fn beside_infinity<M: Machine, O: Op<Compare>>(m: &M, op: O, a: F<M>) -> B<M> {
    B(m.f32_beside_infinity(op, a.0))
}

#[inline(always)]
pub(super) fn sign_bit<M: Machine, O: Op<Compare>>(m: &M, op: O, a: F<M>) -> B<M> {
    B(m.f32_sign_bit(op, a.0))
}

#[inline(always)]
pub(super) fn signum<M: Machine>(m: &M, a: F<M>) -> F<M> {
    let one = copysign(m, number(m, 1.0), a);
    select(m, beside_infinity(m, op::Gt, a), a, one)
}

/// Rounds to the nearest whole number, halves away from zero.
///
/// The part removed by `trunc` is exact, and 0 from 2^23 on. WGSL's `round` would return the even
/// number.
#[inline(always)]
pub(super) fn round<M: Machine>(m: &M, a: F<M>) -> F<M> {
    let whole = unary(m, op::Trunc, a);
    let rest = unary(m, op::Abs, sub(m, a, whole));
    let away = add(m, whole, copysign(m, number(m, 1.0), a));
    select(m, compare(m, op::Ge, rest, number(m, 0.5)), away, whole)
}

#[inline(always)]
pub(super) fn fract<M: Machine>(m: &M, a: F<M>) -> F<M> {
    sub(m, a, unary(m, op::Trunc, a))
}

#[inline(always)]
pub(super) fn fract_gl<M: Machine>(m: &M, a: F<M>) -> F<M> {
    sub(m, a, unary(m, op::Floor, a))
}

/// Returns `a (1 - s) + b s`.
#[inline(always)]
fn lerp<M: Machine>(m: &M, a: F<M>, b: F<M>, s: F<M>) -> F<M> {
    add(m, mul(m, a, sub(m, number(m, 1.0), s)), mul(m, b, s))
}

macro_rules! of_f32 {
    ($($name:literal, |$m:ident, $s:ident $(, $a:ident: $at:ty)*| -> $out:ty { $e:expr };)+) => {
        $(method!([] F<M>, $name, |$m, $s $(, $a: $at)*| -> $out { $e });)+
    };
}

of_f32! {
    "abs", |m, a| -> F<M> { unary(m, op::Abs, a) };
    "floor", |m, a| -> F<M> { unary(m, op::Floor, a) };
    "ceil", |m, a| -> F<M> { unary(m, op::Ceil, a) };
    "trunc", |m, a| -> F<M> { unary(m, op::Trunc, a) };
    "round", |m, a| -> F<M> { round(m, a) };
    "fract", |m, a| -> F<M> { fract(m, a) };
    "sqrt", |m, a| -> F<M> { unary(m, op::Sqrt, a) };
    "recip", |m, a| -> F<M> { div(m, number(m, 1.0), a) };
    "signum", |m, a| -> F<M> { signum(m, a) };
    "copysign", |m, a, sign: F<M>| -> F<M> { copysign(m, a, sign) };
    "min", |m, a, b: F<M>| -> F<M> { number_of(m, op::Min, a, b) };
    "max", |m, a, b: F<M>| -> F<M> { number_of(m, op::Max, a, b) };
    "clamp", |m, a, low: F<M>, high: F<M>| -> F<M> { clamp(m, a, low, high) };
    "mul_add", |m, a, b: F<M>, c: F<M>| -> F<M> { F(m.f32_mul_add(a.0, b.0, c.0)) };
    "to_bits", |m, a| -> U<M> { U(m.f32_to_bits(a.0)) };
    "to_radians", |m, a| -> F<M> { mul(m, a, number(m, core::f32::consts::PI / 180.0)) };
    "to_degrees", |m, a| -> F<M> { mul(m, a, number(m, 57.295_78)) };
    "is_nan", |m, a| -> B<M> { beside_infinity(m, op::Gt, a) };
    "is_infinite", |m, a| -> B<M> { beside_infinity(m, op::Eq, a) };
    "is_finite", |m, a| -> B<M> { beside_infinity(m, op::Lt, a) };
    "is_sign_negative", |m, a| -> B<M> { sign_bit(m, op::Lt, a) };
    "is_sign_positive", |m, a| -> B<M> { sign_bit(m, op::Ge, a) };
    // glam's `FloatExt`
    "lerp", |m, a, b: F<M>, s: F<M>| -> F<M> { lerp(m, a, b, s) };
    "lerp_monotonic", |m, a, b: F<M>, s: F<M>| -> F<M> {
        add(m, a, mul(m, sub(m, b, a), s))
    };
    "fract_gl", |m, a| -> F<M> { fract_gl(m, a) };
    "step", |m, edge, a: F<M>| -> F<M> {
        select(m, compare(m, op::Lt, a, edge), number(m, 0.0), number(m, 1.0))
    };
    "saturate", |m, a| -> F<M> { clamp(m, a, number(m, 0.0), number(m, 1.0)) };
    "smoothstep", |m, a, edge0: F<M>, edge1: F<M>| -> F<M> {{
        let t = div(m, sub(m, a, edge0), sub(m, edge1, edge0));
        let t = clamp(m, t, number(m, 0.0), number(m, 1.0));
        mul(m, mul(m, t, t), sub(m, number(m, 3.0), mul(m, number(m, 2.0), t)))
    }};
}

denied! { F<M>:
    RemainderOfFloats "a kernel has no remainder of floats: an exact one takes hundreds of steps"
        "write `x - y * (x / y).floor()`, which is never negative for a positive `y`"
        "rem_euclid" -> F<M>;
    QuotientOfFloats "a kernel has no `div_euclid` of floats"
        "write `(x / y).floor()` for a positive `y`"
        "div_euclid" -> F<M>;
}

// The macro refuses these where it sees that the receiver is a number.
denied! { F<M>:
    StdSin "`sin` of std differs from one machine to the next"
        "write `sin(x)`, the function of raydsl's prelude"
        "sin" -> F<M>;
    StdCos "`cos` of std differs from one machine to the next"
        "write `cos(x)`, the function of raydsl's prelude"
        "cos" -> F<M>;
    StdTan "`tan` of std differs from one machine to the next"
        "write `tan(x)`, the function of raydsl's prelude"
        "tan" -> F<M>;
    StdAsin "`asin` of std differs from one machine to the next"
        "write `asin(x)`, the function of raydsl's prelude"
        "asin" -> F<M>;
    StdAcos "`acos` of std differs from one machine to the next"
        "write `acos(x)`, the function of raydsl's prelude"
        "acos" -> F<M>;
    StdAtan "`atan` of std differs from one machine to the next"
        "write `atan(x)`, the function of raydsl's prelude"
        "atan" -> F<M>;
    StdAtan2 "`atan2` of std differs from one machine to the next"
        "write `atan2(y, x)`, the function of raydsl's prelude"
        "atan2" -> F<M>;
    StdSinCos "`sin_cos` of std differs from one machine to the next"
        "write `sincos_2pi(u)`, the function of raydsl's prelude"
        "sin_cos" -> F<M>;
    StdExp "`exp` of std differs from one machine to the next"
        "write `exp(x)`, the function of raydsl's prelude"
        "exp" -> F<M>;
    StdExp2 "`exp2` of std differs from one machine to the next"
        "write `exp2(x)`, the function of raydsl's prelude"
        "exp2" -> F<M>;
    StdExpM1 "`exp_m1` of std differs from one machine to the next"
        "write `expm1(x)`, the function of raydsl's prelude"
        "exp_m1" -> F<M>;
    StdLn "`ln` of std differs from one machine to the next"
        "write `log(x)`, the function of raydsl's prelude"
        "ln" -> F<M>;
    StdLn1p "`ln_1p` of std differs from one machine to the next"
        "write `log1p(x)`, the function of raydsl's prelude"
        "ln_1p" -> F<M>;
    StdLog2 "`log2` of std differs from one machine to the next"
        "write `log2(x)`, the function of raydsl's prelude"
        "log2" -> F<M>;
    StdPowf "`powf` of std differs from one machine to the next"
        "write `pow(x, y)`, the function of raydsl's prelude"
        "powf" -> F<M>;
    StdPowi "`powi` of std differs from one machine to the next"
        "write `pow(x, y)`, the function of raydsl's prelude"
        "powi" -> F<M>;
    StdLog "`log` of std differs from one machine to the next"
        "compute it outside the kernel and capture the result"
        "log" -> F<M>;
    StdLog10 "`log10` of std differs from one machine to the next"
        "compute it outside the kernel and capture the result"
        "log10" -> F<M>;
    StdHypot "`hypot` of std differs from one machine to the next"
        "compute it outside the kernel and capture the result"
        "hypot" -> F<M>;
    StdCbrt "`cbrt` of std differs from one machine to the next"
        "compute it outside the kernel and capture the result"
        "cbrt" -> F<M>;
    StdSinh "`sinh` of std differs from one machine to the next"
        "compute it outside the kernel and capture the result"
        "sinh" -> F<M>;
    StdCosh "`cosh` of std differs from one machine to the next"
        "compute it outside the kernel and capture the result"
        "cosh" -> F<M>;
    StdTanh "`tanh` of std differs from one machine to the next"
        "compute it outside the kernel and capture the result"
        "tanh" -> F<M>;
}

/// The sign of a number, of whatever kind.
pub(crate) trait Signed<M: Machine>: Arithmetic<M> {
    fn abs(m: &M, a: Self) -> Self;
    fn signum(m: &M, a: Self) -> Self;
}

impl<M: Machine> Signed<M> for F<M> {
    #[inline(always)]
    fn abs(m: &M, a: Self) -> Self {
        unary(m, op::Abs, a)
    }

    #[inline(always)]
    fn signum(m: &M, a: Self) -> Self {
        signum(m, a)
    }
}

impl<M: Machine> Signed<M> for I<M> {
    /// Panics for the number without a positive counterpart, as in Rust.
    #[inline(always)]
    fn abs(m: &M, a: Self) -> Self {
        let negative = m.i32_compare(op::Lt, a.0, m.i32(0));
        I(m.i32_select(negative, m.i32_neg(a.0), a.0))
    }

    #[inline(always)]
    fn signum(m: &M, a: Self) -> Self {
        let positive = m.i32_compare(op::Gt, a.0, m.i32(0));
        let sign = m.i32_binary(op::Shr, a.0, m.i32(31));
        I(m.i32_select(positive, m.i32(1), sign))
    }
}
