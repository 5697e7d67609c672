//! Wrappers of lanes that change how they enter a level or count.

use fearless_simd::Level;

use super::Lanes;
use crate::machine::{
    BoolBinary, Compare, Counted, F32Binary, F32Unary, IntBinary, Op, Place, counted,
};

/// Lanes for code that is already compiled for their instruction set.
///
/// Kernels that run on them are inlined instead of entering the level again; that is for the
/// innermost loops, which must not pass registers through memory.
#[derive(Clone, Copy, Debug)]
pub struct Entered<L, const STRAIGHT: bool = false>(L);

impl<L> Entered<L> {
    /// Wraps lanes for code that [`Lanes::vectorize`] of them runs.
    #[inline(always)]
    pub fn new(lanes: L) -> Self {
        Self(lanes)
    }
}

impl<L> Entered<L, true> {
    /// Wraps lanes for code whose early exits are unpredictable branches; see [`Lanes::STRAIGHT`].
    #[inline(always)]
    pub(crate) fn straight(lanes: L) -> Self {
        Self(lanes)
    }
}

macro_rules! delegate {
    ($($name:ident($($a:ident: $t:ty),*) -> $result:ty;)+) => {
        $(
            #[inline(always)]
            fn $name(self, $($a: $t),*) -> $result {
                self.0.$name($($a),*)
            }
        )+
    };
    (operations $($name:ident: $kind:ident($($a:ident: $t:ty),*) -> $result:ty;)+) => {
        $(
            #[inline(always)]
            fn $name<O: Op<$kind>>(self, op: O, $($a: $t),*) -> $result {
                self.0.$name(op, $($a),*)
            }
        )+
    };
}

/// Implements [`Lanes`] for a wrapper, forwarding every item not given here.
macro_rules! lanes_around {
    (<L $(, const $n:ident: $t:ty)?> $name:ty { $($own:tt)* }) => {
        // SAFETY: each operation is that of the lanes within.
        unsafe impl<L: Lanes $(, const $n: $t)?> Lanes for $name {
            const N: usize = L::N;
            type F32 = L::F32;
            type I32 = L::I32;
            type U32 = L::U32;
            type Mask = L::Mask;
            type Eight = L::Eight;

        $($own)*

            delegate! {
                operations
                f32_unary: F32Unary(a: L::F32) -> L::F32;
                f32_binary: F32Binary(a: L::F32, b: L::F32) -> L::F32;
                i32_binary: IntBinary(a: L::I32, b: L::I32) -> L::I32;
                u32_binary: IntBinary(a: L::U32, b: L::U32) -> L::U32;
                mask_binary: BoolBinary(a: L::Mask, b: L::Mask) -> L::Mask;
                f32_compare: Compare(a: L::F32, b: L::F32) -> L::Mask;
                i32_compare: Compare(a: L::I32, b: L::I32) -> L::Mask;
                u32_compare: Compare(a: L::U32, b: L::U32) -> L::Mask;
            }
            delegate! {
                isa() -> &'static str;
                eight() -> L::Eight;
                level() -> Option<Level>;
                f32(v: f32) -> L::F32;
                i32(v: i32) -> L::I32;
                u32(v: u32) -> L::U32;
                mask(v: bool) -> L::Mask;
                f32_mul_add(a: L::F32, b: L::F32, c: L::F32) -> L::F32;
                f32_mul_add_fast(a: L::F32, b: L::F32, c: L::F32) -> L::F32;
                u32_compress(a: L::U32, mask: L::Mask) -> L::U32;
                u32_sort_descending(a: L::U32) -> L::U32;
                u32_least(a: L::U32) -> u32;
                u32_permute(a: L::U32, from: L::U32) -> L::U32;
                f32_store(a: L::F32, out: &mut [f32]) -> ();
                u32_store(a: L::U32, out: &mut [u32]) -> ();
                mask_not(a: L::Mask) -> L::Mask;
                f32_select(c: L::Mask, a: L::F32, b: L::F32) -> L::F32;
                i32_select(c: L::Mask, a: L::I32, b: L::I32) -> L::I32;
                u32_select(c: L::Mask, a: L::U32, b: L::U32) -> L::U32;
                any(a: L::Mask) -> bool;
                bits(a: L::Mask) -> u64;
                mask_from_bits(bits: u64) -> L::Mask;
                f32_to_i32(a: L::F32) -> L::I32;
                f32_to_u32(a: L::F32) -> L::U32;
                i32_to_f32(a: L::I32) -> L::F32;
                u32_to_f32(a: L::U32) -> L::F32;
                i32_to_u32(a: L::I32) -> L::U32;
                u32_to_i32(a: L::U32) -> L::I32;
                f32_to_bits(a: L::F32) -> L::U32;
                f32_from_bits(a: L::U32) -> L::F32;
                f32_from_fn(f: impl FnMut(usize) -> f32) -> L::F32;
                i32_from_fn(f: impl FnMut(usize) -> i32) -> L::I32;
                u32_from_fn(f: impl FnMut(usize) -> u32) -> L::U32;
            }

            #[inline(always)]
            fn f32_lane(a: &L::F32, lane: usize) -> f32 {
                L::f32_lane(a, lane)
            }
            #[inline(always)]
            fn i32_lane(a: &L::I32, lane: usize) -> i32 {
                L::i32_lane(a, lane)
            }
            #[inline(always)]
            fn u32_lane(a: &L::U32, lane: usize) -> u32 {
                L::u32_lane(a, lane)
            }
            #[inline(always)]
            fn mask_lane(a: &L::Mask, lane: usize) -> bool {
                L::mask_lane(a, lane)
            }
        }
    };
}

lanes_around!(<L, const IS_STRAIGHT: bool> Entered<L, IS_STRAIGHT> {
    const STRAIGHT: bool = IS_STRAIGHT;

    #[inline(always)]
    fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
        f()
    }
    #[inline(always)]
    fn enter_again<R>(self, f: impl FnOnce() -> R) -> R {
        self.0.vectorize(f)
    }
    #[inline(always)]
    fn at(self, place: Place, active: L::Mask) {
        self.0.at(place, active);
    }
});

lanes_around!(<L> Counted<L> {
    #[inline(always)]
    fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
        self.0.vectorize(f)
    }
    #[inline(always)]
    fn at(self, place: Place, active: L::Mask) {
        if counted::is_counting() {
            counted::add(place, self.0.bits(active));
        }
    }
});
