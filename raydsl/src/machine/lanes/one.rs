//! Lanes of width one.

use super::Lanes;
use crate::machine::{BoolBinary, Compare, F32Binary, F32Unary, Gang, IntBinary, Op, scalar};

/// One lane with masks: running `Packet<One>` against the untouched source is the oracle of the
/// lowering.
#[derive(Clone, Copy, Debug, Default)]
pub struct One;

// SAFETY: each operation is that of a number.
unsafe impl Lanes for One {
    const N: usize = 1;
    type F32 = f32;
    type I32 = i32;
    type U32 = u32;
    type Mask = bool;
    type Eight = Gang<Self, 8>;

    #[inline(always)]
    fn eight(self) -> Gang<Self, 8> {
        Gang(self)
    }
    fn isa(self) -> &'static str {
        "portable"
    }
    #[inline(always)]
    fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
        f()
    }
    #[inline(always)]
    fn f32(self, v: f32) -> f32 {
        v
    }
    #[inline(always)]
    fn i32(self, v: i32) -> i32 {
        v
    }
    #[inline(always)]
    fn u32(self, v: u32) -> u32 {
        v
    }
    #[inline(always)]
    fn mask(self, v: bool) -> bool {
        v
    }
    #[inline(always)]
    fn f32_unary<O: Op<F32Unary>>(self, _: O, a: f32) -> f32 {
        O::OP.of(a)
    }
    #[inline(always)]
    fn f32_binary<O: Op<F32Binary>>(self, _: O, a: f32, b: f32) -> f32 {
        O::OP.of(a, b)
    }
    #[inline(always)]
    fn f32_mul_add(self, a: f32, b: f32, c: f32) -> f32 {
        a.mul_add(b, c)
    }
    #[inline(always)]
    fn i32_binary<O: Op<IntBinary>>(self, _: O, a: i32, b: i32) -> i32 {
        scalar::i32_binary(O::OP, a, b).1
    }
    #[inline(always)]
    fn u32_binary<O: Op<IntBinary>>(self, _: O, a: u32, b: u32) -> u32 {
        scalar::u32_binary(O::OP, a, b).1
    }
    #[inline(always)]
    fn mask_binary<O: Op<BoolBinary>>(self, _: O, a: bool, b: bool) -> bool {
        O::OP.of(a, b)
    }
    #[inline(always)]
    fn mask_not(self, a: bool) -> bool {
        !a
    }
    #[inline(always)]
    fn f32_compare<O: Op<Compare>>(self, _: O, a: f32, b: f32) -> bool {
        O::OP.of(a, b)
    }
    #[inline(always)]
    fn i32_compare<O: Op<Compare>>(self, _: O, a: i32, b: i32) -> bool {
        O::OP.of(a, b)
    }
    #[inline(always)]
    fn u32_compare<O: Op<Compare>>(self, _: O, a: u32, b: u32) -> bool {
        O::OP.of(a, b)
    }
    #[inline(always)]
    fn f32_select(self, c: bool, a: f32, b: f32) -> f32 {
        if c { a } else { b }
    }
    #[inline(always)]
    fn i32_select(self, c: bool, a: i32, b: i32) -> i32 {
        if c { a } else { b }
    }
    #[inline(always)]
    fn u32_select(self, c: bool, a: u32, b: u32) -> u32 {
        if c { a } else { b }
    }
    #[inline(always)]
    fn any(self, a: bool) -> bool {
        a
    }
    #[inline(always)]
    fn bits(self, a: bool) -> u64 {
        u64::from(a)
    }
    #[inline(always)]
    fn mask_from_bits(self, bits: u64) -> bool {
        bits & 1 != 0
    }
    #[inline(always)]
    fn f32_to_i32(self, a: f32) -> i32 {
        a as i32
    }
    #[inline(always)]
    fn f32_to_u32(self, a: f32) -> u32 {
        a as u32
    }
    #[inline(always)]
    fn i32_to_f32(self, a: i32) -> f32 {
        a as f32
    }
    #[inline(always)]
    fn u32_to_f32(self, a: u32) -> f32 {
        a as f32
    }
    #[inline(always)]
    fn i32_to_u32(self, a: i32) -> u32 {
        a as u32
    }
    #[inline(always)]
    fn u32_to_i32(self, a: u32) -> i32 {
        a as i32
    }
    #[inline(always)]
    fn f32_to_bits(self, a: f32) -> u32 {
        a.to_bits()
    }
    #[inline(always)]
    fn f32_from_bits(self, a: u32) -> f32 {
        f32::from_bits(a)
    }
    #[inline(always)]
    fn f32_from_fn(self, mut f: impl FnMut(usize) -> f32) -> f32 {
        f(0)
    }
    #[inline(always)]
    fn i32_from_fn(self, mut f: impl FnMut(usize) -> i32) -> i32 {
        f(0)
    }
    #[inline(always)]
    fn u32_from_fn(self, mut f: impl FnMut(usize) -> u32) -> u32 {
        f(0)
    }
    #[inline(always)]
    fn f32_lane(a: &f32, _: usize) -> f32 {
        *a
    }
    #[inline(always)]
    fn i32_lane(a: &i32, _: usize) -> i32 {
        *a
    }
    #[inline(always)]
    fn u32_lane(a: &u32, _: usize) -> u32 {
        *a
    }
    #[inline(always)]
    fn mask_lane(a: &bool, _: usize) -> bool {
        *a
    }
}
