//! Lane operations of one instruction set and width.
//!
//! [`Lanes`] is the small trait under [`Packet`](super::Packet), implemented over the tokens of
//! `fearless_simd`: a token is proof that the machine has the instruction set, and
//! [`Lanes::vectorize`] enters it through a `#[target_feature]` function.

mod around;
mod one;
mod shuffle;
mod simd;

use core::mem::{ManuallyDrop, MaybeUninit};

use fearless_simd::Level;

pub use around::Entered;
pub use one::One;
pub use simd::{Simd4, Simd8, Simd16};

use super::{BoolBinary, Compare, F32Binary, F32Unary, IntBinary, Op, Place, op};

/// Registers of one width and their operations. `self` is the proof of the level.
///
/// # Safety
///
/// Integers compare, are selected and leave their lanes as the operations say: packets fetch elements
/// by what these return without asking again whether there are such.
#[expect(missing_docs, reason = "the operations are documented at their enums")]
pub unsafe trait Lanes: Copy + Send + Sync + 'static {
    /// The number of lanes.
    const N: usize;
    type F32: Copy + 'static;
    type I32: Copy + 'static;
    type U32: Copy + 'static;
    type Mask: Copy + 'static;
    /// Whether a kernel continues after an early exit even if no lane is left.
    const STRAIGHT: bool = false;
    /// Whether kernels lifted for these lanes reach traversals through tables, so that traversals
    /// are compiled only where they may be needed.
    const HAS_TABLES: bool = false;
    /// Eight lanes of the same level: a node of a wide tree has as many children, and a leaf block
    /// as many primitives.
    type Eight: Lanes;

    /// Returns the lanes of [`Lanes::Eight`].
    fn eight(self) -> Self::Eight;
    /// Returns the instruction set level, if the lanes belong to one.
    #[inline(always)]
    fn level(self) -> Option<Level> {
        None
    }

    /// Returns the instruction set's name for reports.
    fn isa(self) -> &'static str;
    /// Runs `f` compiled for the instruction set.
    fn vectorize<R>(self, f: impl FnOnce() -> R) -> R;
    /// Runs `f` as a function of its own, called from code already compiled for the instruction
    /// set.
    #[inline(always)]
    fn enter_again<R>(self, f: impl FnOnce() -> R) -> R {
        self.vectorize(f)
    }
    /// Reports that the lanes of `active` are at a place of the source. Only
    /// [`Counted`](super::Counted) uses it.
    #[inline(always)]
    fn at(self, _place: Place, _active: Self::Mask) {}

    fn f32(self, v: f32) -> Self::F32;
    fn i32(self, v: i32) -> Self::I32;
    fn u32(self, v: u32) -> Self::U32;
    fn mask(self, v: bool) -> Self::Mask;

    fn f32_unary<O: Op<F32Unary>>(self, op: O, a: Self::F32) -> Self::F32;
    fn f32_binary<O: Op<F32Binary>>(self, op: O, a: Self::F32, b: Self::F32) -> Self::F32;
    fn f32_mul_add(self, a: Self::F32, b: Self::F32, c: Self::F32) -> Self::F32;
    /// Returns `a * b + c`, rounded once where that is one instruction, else twice. Not for
    /// kernels, whose results are the same on all levels.
    #[inline(always)]
    fn f32_mul_add_fast(self, a: Self::F32, b: Self::F32, c: Self::F32) -> Self::F32 {
        self.f32_binary(op::Add, self.f32_binary(op::Mul, a, b), c)
    }
    /// Computes sums, products, bits and shifts with vector instructions, the rest lane by lane.
    fn i32_binary<O: Op<IntBinary>>(self, op: O, a: Self::I32, b: Self::I32) -> Self::I32;
    fn u32_binary<O: Op<IntBinary>>(self, op: O, a: Self::U32, b: Self::U32) -> Self::U32;
    fn mask_binary<O: Op<BoolBinary>>(self, op: O, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    fn mask_not(self, a: Self::Mask) -> Self::Mask;
    fn f32_compare<O: Op<Compare>>(self, op: O, a: Self::F32, b: Self::F32) -> Self::Mask;
    fn i32_compare<O: Op<Compare>>(self, op: O, a: Self::I32, b: Self::I32) -> Self::Mask;
    fn u32_compare<O: Op<Compare>>(self, op: O, a: Self::U32, b: Self::U32) -> Self::Mask;
    fn f32_select(self, c: Self::Mask, a: Self::F32, b: Self::F32) -> Self::F32;
    fn i32_select(self, c: Self::Mask, a: Self::I32, b: Self::I32) -> Self::I32;
    fn u32_select(self, c: Self::Mask, a: Self::U32, b: Self::U32) -> Self::U32;
    fn any(self, a: Self::Mask) -> bool;
    /// Returns one bit per lane, lane 0 the lowest.
    fn bits(self, a: Self::Mask) -> u64;
    fn mask_from_bits(self, bits: u64) -> Self::Mask;

    fn f32_to_i32(self, a: Self::F32) -> Self::I32;
    fn f32_to_u32(self, a: Self::F32) -> Self::U32;
    fn i32_to_f32(self, a: Self::I32) -> Self::F32;
    fn u32_to_f32(self, a: Self::U32) -> Self::F32;
    fn i32_to_u32(self, a: Self::I32) -> Self::U32;
    fn u32_to_i32(self, a: Self::U32) -> Self::I32;
    fn f32_to_bits(self, a: Self::F32) -> Self::U32;
    fn f32_from_bits(self, a: Self::U32) -> Self::F32;

    fn f32_from_fn(self, f: impl FnMut(usize) -> f32) -> Self::F32;
    fn i32_from_fn(self, f: impl FnMut(usize) -> i32) -> Self::I32;
    fn u32_from_fn(self, f: impl FnMut(usize) -> u32) -> Self::U32;
    fn f32_lane(a: &Self::F32, lane: usize) -> f32;
    fn i32_lane(a: &Self::I32, lane: usize) -> i32;
    fn u32_lane(a: &Self::U32, lane: usize) -> u32;
    fn mask_lane(a: &Self::Mask, lane: usize) -> bool;

    /// Packs the lanes of `mask` to the front, in order; the lanes behind them are unspecified.
    #[inline(always)]
    fn u32_compress(self, a: Self::U32, mask: Self::Mask) -> Self::U32 {
        let (mut packed, mut n) = ([0; 64], 0);
        for lane in 0..Self::N {
            packed[n] = Self::u32_lane(&a, lane);
            n += usize::from(Self::mask_lane(&mask, lane));
        }
        self.u32_from_fn(|lane| packed[lane])
    }
    /// Sorts the lanes in descending order.
    #[inline(always)]
    fn u32_sort_descending(self, a: Self::U32) -> Self::U32 {
        shuffle::sort_by_insertion(self, a)
    }
    /// Returns the smallest lane.
    #[inline(always)]
    fn u32_least(self, a: Self::U32) -> u32 {
        shuffle::least_by_lane(self, a)
    }
    /// Returns in each lane the lane of `a` that `from` names, modulo the number of lanes.
    #[inline(always)]
    fn u32_permute(self, a: Self::U32, from: Self::U32) -> Self::U32 {
        shuffle::permute_by_lane(self, a, from)
    }
    /// Stores the lanes in order at the start of `out`.
    #[inline(always)]
    fn f32_store(self, a: Self::F32, out: &mut [f32]) {
        for (lane, out) in out[..Self::N].iter_mut().enumerate() {
            *out = Self::f32_lane(&a, lane);
        }
    }
    /// Stores the lanes in order at the start of `out`.
    #[inline(always)]
    fn u32_store(self, a: Self::U32, out: &mut [u32]) {
        for (lane, out) in out[..Self::N].iter_mut().enumerate() {
            *out = Self::u32_lane(&a, lane);
        }
    }
}

/// Returns `[f(0), f(1), ..]`. Unlike the array functions of `core` it is always inlined: code that
/// is not inlined is not compiled for the level, and there every operation is a call. Up to four
/// elements, as in vectors, are unrolled by hand; more are a loop, so that `f` is compiled once.
#[inline(always)]
pub(crate) fn fill<T: Copy, const N: usize>(f: impl FnMut(usize) -> T) -> [T; N] {
    // Not dropped, or each call of it would have a landing pad.
    let f = &mut *ManuallyDrop::new(f);
    let mut all = [const { MaybeUninit::uninit() }; N];
    macro_rules! element {
        ($($i:literal)+) => {
            $(if const { $i < N } {
                // SAFETY: the index is that of an element.
                unsafe { all.get_unchecked_mut($i) }.write(f($i));
            })+
        };
    }
    if const { N <= 4 } {
        element!(0 1 2 3);
    } else {
        for (i, v) in all.iter_mut().enumerate() {
            v.write(f(i));
        }
    }
    // SAFETY: each of the `N` elements has been written, and `MaybeUninit<T>` has the layout of
    // `T`.
    unsafe { core::mem::transmute_copy::<[MaybeUninit<T>; N], [T; N]>(&all) }
}
