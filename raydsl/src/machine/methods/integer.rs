//! Methods of `i32` and `u32`, alone and as components of vectors.

use super::super::{
    B, Coerce, I, IntBinary, Machine, Op, U, U32Unary, op,
    vector::{Arithmetic, Integer, IsVector, Vector},
};
use super::float::Signed;
use super::{Method, name};
use crate::machine::op::known;

#[inline(always)]
fn and<M: Machine, E: Integer<M>>(m: &M, a: E, mask: i32) -> E {
    E::binary(m, op::And, a, E::number(m, mask))
}

#[inline(always)]
fn is_negative<M: Machine, E: Integer<M>>(m: &M, a: E) -> B<M> {
    E::compare(m, op::Lt, a, E::number(m, 0))
}

/// Shifts by the amount modulo 32.
#[inline(always)]
fn wrapping_shift<M: Machine, E: Integer<M>, O: Op<IntBinary>>(m: &M, op: O, a: E, n: U<M>) -> E {
    E::binary(m, op, a, E::from_u32(m, and(m, n, 31)))
}

#[inline(always)]
fn rotate_left<M: Machine>(m: &M, a: U<M>, n: U<M>) -> U<M> {
    let rest = U::binary(m, op::WrappingSub, U::number(m, 0), n);
    let left = wrapping_shift(m, op::Shl, a, n);
    let right = wrapping_shift(m, op::Shr, a, rest);
    U::binary(m, op::Or, left, right)
}

#[inline(always)]
fn swap_bytes<M: Machine>(m: &M, a: U<M>) -> U<M> {
    let odd = and(m, rotate_left(m, a, U::number(m, 8)), 0x00ff_00ff);
    let even = and(m, rotate_left(m, a, U::number(m, 24)), 0xff00_ff00_u32 as i32);
    U::binary(m, op::Or, odd, even)
}

#[inline(always)]
fn abs_diff<M: Machine, E: Integer<M>>(m: &M, a: E, b: E) -> U<M> {
    let less = E::compare(m, op::Lt, a, b);
    let up = E::binary(m, op::WrappingSub, b, a);
    let down = E::binary(m, op::WrappingSub, a, b);
    E::choose(m, less, up, down).to_u32(m)
}

#[inline(always)]
fn wrapping_neg<M: Machine, E: Integer<M>>(m: &M, a: E) -> E {
    E::binary(m, op::WrappingSub, E::number(m, 0), a)
}

/// Integers with saturating sums and differences.
pub(crate) trait Saturating<M: Machine>: Integer<M> {
    /// Returns where `a + b` or `a - b`, wrapped to `sum`, overflowed, and the bound it saturates
    /// to.
    fn overflow<O: Op<IntBinary>>(m: &M, op: O, a: Self, b: Self, sum: Self) -> (B<M>, Self);
}

impl<M: Machine> Saturating<M> for U<M> {
    #[inline(always)]
    fn overflow<O: Op<IntBinary>>(m: &M, _: O, a: Self, b: Self, sum: Self) -> (B<M>, Self) {
        known!(O::OP;
            IntBinary::WrappingAdd => (Self::compare(m, op::Lt, sum, a), U(m.u32(u32::MAX))),
            _ => (Self::compare(m, op::Lt, a, b), U(m.u32(0))),
        )
    }
}

impl<M: Machine> Saturating<M> for I<M> {
    #[inline(always)]
    fn overflow<O: Op<IntBinary>>(m: &M, _: O, a: Self, b: Self, sum: Self) -> (B<M>, Self) {
        let differs = |x: Self, y: Self| Self::binary(m, op::Xor, x, y);
        // In an overflow, the sum differs in sign from both operands; the difference differs from
        // `a`, which differs from `b`.
        let second = known!(O::OP;
            IntBinary::WrappingAdd => differs(b, sum),
            _ => differs(a, b),
        );
        let both = Self::binary(m, op::And, differs(a, sum), second);
        let sign = Self::binary(m, op::Shr, a, I(m.i32(31)));
        (is_negative(m, both), differs(sign, I(m.i32(i32::MAX))))
    }
}

#[inline(always)]
fn saturating<M: Machine, E: Saturating<M>, O: Op<IntBinary>>(m: &M, op: O, a: E, b: E) -> E {
    let sum = E::binary(m, op, a, b);
    let (c, end) = E::overflow(m, op, a, b, sum);
    E::choose(m, c, end, sum)
}

/// Returns the Euclidean remainder, which is never negative.
#[inline(always)]
fn rem_euclid<M: Machine, E: Integer<M>>(m: &M, a: E, b: E) -> E {
    let rest = E::binary(m, op::Rem, a, b);
    if !E::SIGNED {
        return rest;
    }
    let size = E::choose(m, is_negative(m, b), wrapping_neg(m, b), b);
    let raised = E::binary(m, op::WrappingAdd, rest, size);
    E::choose(m, is_negative(m, rest), raised, rest)
}

#[inline(always)]
fn div_euclid<M: Machine, E: Integer<M>>(m: &M, a: E, b: E) -> E {
    let quotient = E::binary(m, op::Div, a, b);
    if !E::SIGNED {
        return quotient;
    }
    let rest = E::binary(m, op::Rem, a, b);
    let one = E::choose(m, is_negative(m, b), E::number(m, -1), E::number(m, 1));
    let lower = E::binary(m, op::WrappingSub, quotient, one);
    E::choose(m, is_negative(m, rest), lower, quotient)
}

#[inline(always)]
fn counted<M: Machine, E: Integer<M>, O: Op<U32Unary>>(m: &M, op: O, a: E) -> U<M> {
    U(m.u32_unary(op, a.to_u32(m).0))
}

macro_rules! of_integers {
    ($($name:literal, |$m:ident, $s:ident $(, $a:ident: $at:ident)*| -> $out:ident { $e:expr };)+) => {
        $(
            of_integers!(@one I $name |$m, $s $(, $a: $at)*| $out $e);
            of_integers!(@one U $name |$m, $s $(, $a: $at)*| $out $e);
        )+
    };
    (@one $t:ident $name:literal |$m:ident, $s:ident $(, $a:ident: $at:ident)*| $out:ident $e:expr) => {
        const _: () = {
            #[allow(dead_code, reason = "not every method gives its own type")]
            type Own<M> = $t<M>;
            method!([] $t<M>, $name, |$m, $s $(, $a: $at<M>)*| -> $out<M> { $e });
        };
    };
}

of_integers! {
    "wrapping_add", |m, a, b: Own| -> Own { Own::binary(m, op::WrappingAdd, a, b) };
    "wrapping_sub", |m, a, b: Own| -> Own { Own::binary(m, op::WrappingSub, a, b) };
    "wrapping_mul", |m, a, b: Own| -> Own { Own::binary(m, op::WrappingMul, a, b) };
    "wrapping_neg", |m, a| -> Own { wrapping_neg(m, a) };
    "wrapping_shl", |m, a, n: U| -> Own { wrapping_shift(m, op::Shl, a, n) };
    "wrapping_shr", |m, a, n: U| -> Own { wrapping_shift(m, op::Shr, a, n) };
    "saturating_add", |m, a, b: Own| -> Own { saturating(m, op::WrappingAdd, a, b) };
    "saturating_sub", |m, a, b: Own| -> Own { saturating(m, op::WrappingSub, a, b) };
    "rotate_left", |m, a, n: U| -> Own { Own::from_u32(m, rotate_left(m, a.to_u32(m), n)) };
    "rotate_right", |m, a, n: U| -> Own {
        Own::from_u32(m, rotate_left(m, a.to_u32(m), wrapping_neg(m, n)))
    };
    "swap_bytes", |m, a| -> Own { Own::from_u32(m, swap_bytes(m, a.to_u32(m))) };
    "reverse_bits", |m, a| -> Own { Own::from_u32(m, counted(m, op::ReverseBits, a)) };
    "count_ones", |m, a| -> U { counted(m, op::CountOnes, a) };
    "count_zeros", |m, a| -> U {
        U(m.u32_unary(op::CountOnes, m.u32_not(a.to_u32(m).0)))
    };
    "leading_zeros", |m, a| -> U { counted(m, op::LeadingZeros, a) };
    "trailing_zeros", |m, a| -> U { counted(m, op::TrailingZeros, a) };
    "min", |m, a, b: Own| -> Own { Own::extreme(m, op::Min, a, b) };
    "max", |m, a, b: Own| -> Own { Own::extreme(m, op::Max, a, b) };
    "clamp", |m, a, low: Own, high: Own| -> Own {
        Own::extreme(m, op::Min, Own::extreme(m, op::Max, a, low), high)
    };
    "abs_diff", |m, a, b: Own| -> U { abs_diff(m, a, b) };
    "rem_euclid", |m, a, b: Own| -> Own { rem_euclid(m, a, b) };
    "div_euclid", |m, a, b: Own| -> Own { div_euclid(m, a, b) };
}

method!([] I<M>, "abs", |m, a| -> I<M> { Signed::abs(m, a) });
method!([] I<M>, "signum", |m, a| -> I<M> { Signed::signum(m, a) });
method!([] I<M>, "unsigned_abs", |m, a| -> U<M> {
    I::choose(m, is_negative(m, a), wrapping_neg(m, a), a).to_u32(m)
});
method!([] I<M>, "wrapping_abs", |m, a| -> I<M> {
    I::choose(m, is_negative(m, a), wrapping_neg(m, a), a)
});
method!([] I<M>, "is_negative", |m, a| -> B<M> { is_negative(m, a) });
method!([] I<M>, "is_positive", |m, a| -> B<M> {
    I::compare(m, op::Gt, a, I::number(m, 0))
});
method!([] U<M>, "is_multiple_of", |m, a, b: U<M>| -> B<M> {{
    // Only 0 is a multiple of 0, which is no divisor.
    let is_divisor = U::compare(m, op::Ne, b, U::number(m, 0));
    let rest = U::binary(m, op::Rem, a, U::choose(m, is_divisor, b, U::number(m, 1)));
    let rest = U::choose(m, is_divisor, rest, a);
    U::compare(m, op::Eq, rest, U::number(m, 0))
}});
method!([] U<M>, "is_power_of_two", |m, a| -> B<M> {{
    let below = U::binary(m, op::WrappingSub, a, U::number(m, 1));
    let shared = U::binary(m, op::And, a, below);
    let single = U::compare(m, op::Eq, shared, U::number(m, 0));
    let some = U::compare(m, op::Ne, a, U::number(m, 0));
    B(m.bool_binary(op::And, some.0, single.0))
}});

macro_rules! of_vectors {
    ($($name:literal $op:ident;)+) => {
        $(
            method!([V: IsVector + Vector<M, Component: Integer<M>>] V, $name, |m, a, b: V| -> V {
                V::arithmetic(m, op::$op, a, b)
            });
        )+
    };
}

of_vectors! {
    "wrapping_add" WrappingAdd;
    "wrapping_sub" WrappingSub;
    "wrapping_mul" WrappingMul;
}

macro_rules! each_pair {
    ($($name:literal $bound:ident |$m:ident, $x:ident, $y:ident| $e:expr;)+) => {
        $(
            method!([E: $bound<M>, V: IsVector + Vector<M, Component = E, Of<E> = V>] V, $name,
                |$m, a, b: V| -> V {
                    a.both(b, #[inline(always)] |$x: E, $y: E| $e)
                });
        )+
    };
}

each_pair! {
    "saturating_add" Saturating |m, x, y| saturating(m, op::WrappingAdd, x, y);
    "saturating_sub" Saturating |m, x, y| saturating(m, op::WrappingSub, x, y);
    "rem_euclid" Integer |m, x, y| rem_euclid(m, x, y);
    "div_euclid" Integer |m, x, y| div_euclid(m, x, y);
}
