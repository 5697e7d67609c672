//! Lanes for code that is already compiled for their instruction set.

use raydsl::machine::{BoolBinary, Compare, F32Binary, F32Unary, IntBinary, Lanes, Op};

/// Lanes within [`Lanes::vectorize`]: kernels that run on them are inlined into the caller instead of
/// entering the level again, so that registers do not go through memory. The library's traversals test
/// primitives in the same way.
#[derive(Clone, Copy)]
pub(super) struct Entered<L>(pub(super) L);

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
    (of lanes $($name:ident: $register:ident -> $result:ty;)+) => {
        $(
            #[inline(always)]
            fn $name(a: &L::$register, lane: usize) -> $result {
                L::$name(a, lane)
            }
        )+
    };
}

// SAFETY: each operation is that of the lanes within.
unsafe impl<L: Lanes> Lanes for Entered<L> {
    const N: usize = L::N;
    type F32 = L::F32;
    type I32 = L::I32;
    type U32 = L::U32;
    type Mask = L::Mask;
    type Eight = L::Eight;

    #[inline(always)]
    fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
        f()
    }
    #[inline(always)]
    fn enter_again<R>(self, f: impl FnOnce() -> R) -> R {
        self.0.vectorize(f)
    }

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
        f32(v: f32) -> L::F32;
        i32(v: i32) -> L::I32;
        u32(v: u32) -> L::U32;
        mask(v: bool) -> L::Mask;
        f32_mul_add(a: L::F32, b: L::F32, c: L::F32) -> L::F32;
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
    delegate! {
        of lanes
        f32_lane: F32 -> f32;
        i32_lane: I32 -> i32;
        u32_lane: U32 -> u32;
        mask_lane: Mask -> bool;
    }
}
