//! Bit counting and bit reversal of a `u32` by sums, masks and shifts.
//!
//! After Warren, "Hacker's Delight" (2013), chapters 5 and 7.

use super::op::known;
use super::{IntBinary, Machine, Op, U32Unary, op};

#[inline(always)]
pub(super) fn u32_unary<M: Machine, O: Op<U32Unary>>(m: &M, _: O, a: M::U32) -> M::U32 {
    known!(O::OP;
        U32Unary::CountOnes => count_ones(m, a),
        U32Unary::LeadingZeros => leading_zeros(m, a),
        U32Unary::TrailingZeros => trailing_zeros(m, a),
        U32Unary::ReverseBits => reverse_bits(m, a),
    )
}

#[inline(always)]
fn with<M: Machine, O: Op<IntBinary>>(m: &M, op: O, a: M::U32, b: u32) -> M::U32 {
    m.u32_binary(op, a, m.u32(b))
}

#[inline(always)]
fn count_ones<M: Machine>(m: &M, a: M::U32) -> M::U32 {
    use op::{And, Shr, WrappingAdd, WrappingMul, WrappingSub};
    let pairs = m.u32_binary(WrappingSub, a, with(m, And, with(m, Shr, a, 1), 0x5555_5555));
    let upper = with(m, And, with(m, Shr, pairs, 2), 0x3333_3333);
    let nibbles = m.u32_binary(WrappingAdd, with(m, And, pairs, 0x3333_3333), upper);
    let bytes = m.u32_binary(WrappingAdd, nibbles, with(m, Shr, nibbles, 4));
    let bytes = with(m, And, bytes, 0x0f0f_0f0f);
    with(m, Shr, with(m, WrappingMul, bytes, 0x0101_0101), 24)
}

#[inline(always)]
fn leading_zeros<M: Machine>(m: &M, a: M::U32) -> M::U32 {
    let mut filled = a;
    for n in [1, 2, 4, 8, 16] {
        filled = m.u32_binary(op::Or, filled, with(m, op::Shr, filled, n));
    }
    count_ones(m, m.u32_not(filled))
}

#[inline(always)]
fn trailing_zeros<M: Machine>(m: &M, a: M::U32) -> M::U32 {
    let below = with(m, op::WrappingSub, a, 1);
    count_ones(m, m.u32_binary(op::And, m.u32_not(a), below))
}

#[inline(always)]
fn reverse_bits<M: Machine>(m: &M, a: M::U32) -> M::U32 {
    let mut turned = a;
    for (n, mask) in [(1, 0x5555_5555), (2, 0x3333_3333), (4, 0x0f0f_0f0f), (8, 0x00ff_00ff)] {
        let right = with(m, op::And, with(m, op::Shr, turned, n), mask);
        let left = with(m, op::Shl, with(m, op::And, turned, mask), n);
        turned = m.u32_binary(op::Or, left, right);
    }
    let (right, left) = (with(m, op::Shr, turned, 16), with(m, op::Shl, turned, 16));
    m.u32_binary(op::Or, left, right)
}
