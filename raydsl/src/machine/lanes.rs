//! Lane operations of one instruction set and width.
//!
//! [`Lanes`] is the small trait under [`Packet`](super::Packet), implemented over the tokens of
//! `fearless_simd`: a token is proof that the machine has the instruction set, and
//! [`Lanes::vectorize`] enters it through a `#[target_feature]` function.

use core::mem::MaybeUninit;

use fearless_simd::{
    Bytes, Select, Simd, SimdBase, SimdCvtFloat, SimdCvtTruncate, SimdFloat, SimdMask, f32x4,
    f32x8, f32x16, i32x4, i32x8, i32x16, mask32x4, mask32x8, mask32x16, u32x4, u32x8, u32x16,
};

use super::op::known;
use super::{BoolBinary, Compare, F32Binary, F32Unary, IntBinary, Op, Place, counted, scalar};
use crate::machine::Counted;

/// Registers of one width, and what can be done with them. `self` is the proof of the level.
#[expect(missing_docs, reason = "the operations are documented at their enums")]
pub trait Lanes: Copy + Send + Sync + 'static {
    /// How many lanes.
    const N: usize;
    type F32: Copy + 'static;
    type I32: Copy + 'static;
    type U32: Copy + 'static;
    type Mask: Copy + 'static;

    /// The instruction set's name, as reports print it.
    fn isa(self) -> &'static str;
    /// Runs `f` compiled for the instruction set.
    fn vectorize<R>(self, f: impl FnOnce() -> R) -> R;
    /// The same for a function of its own that is called from code that runs so already.
    #[inline(always)]
    fn enter_again<R>(self, f: impl FnOnce() -> R) -> R {
        self.vectorize(f)
    }
    /// The lanes of `active` are at a place of the source. Only [`Counted`](super::Counted)
    /// listens.
    #[inline(always)]
    fn at(self, _place: Place, _active: Self::Mask) {}

    fn f32(self, v: f32) -> Self::F32;
    fn i32(self, v: i32) -> Self::I32;
    fn u32(self, v: u32) -> Self::U32;
    fn mask(self, v: bool) -> Self::Mask;

    fn f32_unary<O: Op<F32Unary>>(self, op: O, a: Self::F32) -> Self::F32;
    fn f32_binary<O: Op<F32Binary>>(self, op: O, a: Self::F32, b: Self::F32) -> Self::F32;
    fn f32_mul_add(self, a: Self::F32, b: Self::F32, c: Self::F32) -> Self::F32;
    /// Sums, products, bits, shifts; the rest is done lane by lane.
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
    /// One bit a lane, lane 0 the lowest.
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
}

/// `[f(0), f(1), ..]`. Unlike the array functions of `core` it is always inlined: what is not
/// inlined is not compiled for the level, and there every operation is a call. Up to four elements,
/// as vectors have, it is no loop that an optimiser must unroll; more are one, so that `f` stands
/// in one place.
#[inline(always)]
pub(crate) fn fill<T: Copy, const N: usize>(mut f: impl FnMut(usize) -> T) -> [T; N] {
    let mut all = [const { MaybeUninit::uninit() }; N];
    macro_rules! element {
        ($($i:literal)+) => {
            $(if const { $i < N } {
                all[$i].write(f($i));
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

/// The name of a level, as reports print it.
fn isa_name(level: fearless_simd::Level) -> &'static str {
    #[allow(unreachable_patterns, reason = "which levels exist depends on the target")]
    match level {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        fearless_simd::Level::Avx512(_) => "avx512",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        fearless_simd::Level::Avx2(_) => "avx2",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        fearless_simd::Level::Sse4_2(_) => "sse4.2",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        fearless_simd::Level::Sse2(_) => "sse2",
        #[cfg(target_arch = "aarch64")]
        fearless_simd::Level::Neon(_) => "neon",
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        fearless_simd::Level::WasmSimd128(_) => "simd128",
        _ => "portable",
    }
}

/// Whether a level's `x.min(y)` is `if x < y { x } else { y }` for every pair of numbers, as it is
/// on x86, and `max` likewise.
#[inline(always)]
fn has_ordered_min(level: fearless_simd::Level) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    use fearless_simd::Level::{Avx2, Avx512, Sse2, Sse4_2};
    #[allow(unreachable_patterns, reason = "which levels exist depends on the target")]
    match level {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Avx512(_) | Avx2(_) | Sse4_2(_) | Sse2(_) => true,
        _ => false,
    }
}

macro_rules! int_vector_op {
    ($self:ident, $v:ident, $op:ident, $a:ident, $b:ident, $bits:ident, $lane:path) => {
        known!($op::OP;
            IntBinary::Add | IntBinary::WrappingAdd => $a + $b,
            IntBinary::Sub | IntBinary::WrappingSub => $a - $b,
            IntBinary::Mul | IntBinary::WrappingMul => $a * $b,
            IntBinary::And => $a & $b,
            IntBinary::Or => $a | $b,
            IntBinary::Xor => $a ^ $b,
            IntBinary::Shl => $a << ($b & $v::splat($self.0, 31)),
            IntBinary::Shr => $a >> ($b & $v::splat($self.0, 31)),
            // Division and remainder.
            _ => $v::from_fn($self.0, |l| $lane($op::OP, $a[l], $b[l]).1),
        )
    };
}

macro_rules! compare_op {
    ($op:ident, $a:ident, $b:ident) => {
        known!($op::OP;
            Compare::Eq => $a.simd_eq($b),
            Compare::Ne => !$a.simd_eq($b),
            Compare::Lt => $a.simd_lt($b),
            Compare::Le => $a.simd_le($b),
            Compare::Gt => $a.simd_gt($b),
            Compare::Ge => $a.simd_ge($b),
        )
    };
}

macro_rules! simd_lanes {
    ($name:ident, $n:literal, $f:ident, $i:ident, $u:ident, $m:ident) => {
        #[doc = concat!(stringify!($n), " lanes of the instruction set that `S` proves.")]
        #[derive(Clone, Copy, Debug)]
        pub struct $name<S: Simd>(pub S);

        impl<S: Simd> Lanes for $name<S> {
            const N: usize = $n;
            type F32 = $f<S>;
            type I32 = $i<S>;
            type U32 = $u<S>;
            type Mask = $m<S>;

            fn isa(self) -> &'static str {
                isa_name(self.0.level())
            }
            #[inline(always)]
            fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
                self.0.vectorize(f)
            }
            #[inline(always)]
            fn f32(self, v: f32) -> $f<S> {
                $f::splat(self.0, v)
            }
            #[inline(always)]
            fn i32(self, v: i32) -> $i<S> {
                $i::splat(self.0, v)
            }
            #[inline(always)]
            fn u32(self, v: u32) -> $u<S> {
                $u::splat(self.0, v)
            }
            #[inline(always)]
            fn mask(self, v: bool) -> $m<S> {
                $m::splat(self.0, v)
            }
            #[inline(always)]
            fn f32_unary<O: Op<F32Unary>>(self, _: O, a: $f<S>) -> $f<S> {
                known!(O::OP;
                    F32Unary::Neg => -a,
                    F32Unary::Abs => a.abs(),
                    F32Unary::Sqrt => a.sqrt(),
                    F32Unary::Floor => a.floor(),
                    F32Unary::Ceil => a.ceil(),
                    F32Unary::Trunc => a.trunc(),
                )
            }
            #[inline(always)]
            fn f32_binary<O: Op<F32Binary>>(self, _: O, a: $f<S>, b: $f<S>) -> $f<S> {
                // Where the instruction is `if b < a { b } else { a }`, NaN and zeros included.
                let is_ordered = || has_ordered_min(self.0.level());
                known!(O::OP;
                    F32Binary::Add => a + b,
                    F32Binary::Sub => a - b,
                    F32Binary::Mul => a * b,
                    F32Binary::Div => a / b,
                    F32Binary::Min => if is_ordered() { b.min(a) } else { b.simd_lt(a).select(b, a) },
                    F32Binary::Max => if is_ordered() { b.max(a) } else { a.simd_lt(b).select(b, a) },
                )
            }
            #[inline(always)]
            fn f32_mul_add(self, a: $f<S>, b: $f<S>, c: $f<S>) -> $f<S> {
                a.mul_add_precise(b, c)
            }
            #[inline(always)]
            fn i32_binary<O: Op<IntBinary>>(self, _: O, a: $i<S>, b: $i<S>) -> $i<S> {
                int_vector_op!(self, $i, O, a, b, i32, scalar::i32_binary)
            }
            #[inline(always)]
            fn u32_binary<O: Op<IntBinary>>(self, _: O, a: $u<S>, b: $u<S>) -> $u<S> {
                int_vector_op!(self, $u, O, a, b, u32, scalar::u32_binary)
            }
            #[inline(always)]
            fn mask_binary<O: Op<BoolBinary>>(self, _: O, a: $m<S>, b: $m<S>) -> $m<S> {
                known!(O::OP;
                    BoolBinary::And => a & b,
                    BoolBinary::Or => a | b,
                    BoolBinary::Xor => a ^ b,
                )
            }
            #[inline(always)]
            fn mask_not(self, a: $m<S>) -> $m<S> {
                !a
            }
            #[inline(always)]
            fn f32_compare<O: Op<Compare>>(self, _: O, a: $f<S>, b: $f<S>) -> $m<S> {
                compare_op!(O, a, b)
            }
            #[inline(always)]
            fn i32_compare<O: Op<Compare>>(self, _: O, a: $i<S>, b: $i<S>) -> $m<S> {
                compare_op!(O, a, b)
            }
            #[inline(always)]
            fn u32_compare<O: Op<Compare>>(self, _: O, a: $u<S>, b: $u<S>) -> $m<S> {
                compare_op!(O, a, b)
            }
            #[inline(always)]
            fn f32_select(self, c: $m<S>, a: $f<S>, b: $f<S>) -> $f<S> {
                c.select(a, b)
            }
            #[inline(always)]
            fn i32_select(self, c: $m<S>, a: $i<S>, b: $i<S>) -> $i<S> {
                c.select(a, b)
            }
            #[inline(always)]
            fn u32_select(self, c: $m<S>, a: $u<S>, b: $u<S>) -> $u<S> {
                c.select(a, b)
            }
            #[inline(always)]
            fn any(self, a: $m<S>) -> bool {
                a.any_true()
            }
            #[inline(always)]
            fn bits(self, a: $m<S>) -> u64 {
                a.to_bitmask()
            }
            #[inline(always)]
            fn mask_from_bits(self, bits: u64) -> $m<S> {
                $m::from_bitmask(self.0, bits)
            }
            #[inline(always)]
            fn f32_to_i32(self, a: $f<S>) -> $i<S> {
                $i::truncate_from_precise(a)
            }
            #[inline(always)]
            fn f32_to_u32(self, a: $f<S>) -> $u<S> {
                $u::truncate_from_precise(a)
            }
            #[inline(always)]
            fn i32_to_f32(self, a: $i<S>) -> $f<S> {
                $f::float_from(a)
            }
            #[inline(always)]
            fn u32_to_f32(self, a: $u<S>) -> $f<S> {
                $f::float_from(a)
            }
            #[inline(always)]
            fn i32_to_u32(self, a: $i<S>) -> $u<S> {
                a.bitcast()
            }
            #[inline(always)]
            fn u32_to_i32(self, a: $u<S>) -> $i<S> {
                a.bitcast()
            }
            #[inline(always)]
            fn f32_to_bits(self, a: $f<S>) -> $u<S> {
                a.bitcast()
            }
            #[inline(always)]
            fn f32_from_bits(self, a: $u<S>) -> $f<S> {
                a.bitcast()
            }
            #[inline(always)]
            fn f32_from_fn(self, f: impl FnMut(usize) -> f32) -> $f<S> {
                $f::load_array(self.0, fill(f))
            }
            #[inline(always)]
            fn i32_from_fn(self, f: impl FnMut(usize) -> i32) -> $i<S> {
                $i::load_array(self.0, fill(f))
            }
            #[inline(always)]
            fn u32_from_fn(self, f: impl FnMut(usize) -> u32) -> $u<S> {
                $u::load_array(self.0, fill(f))
            }
            #[inline(always)]
            fn f32_lane(a: &$f<S>, lane: usize) -> f32 {
                a[lane]
            }
            #[inline(always)]
            fn i32_lane(a: &$i<S>, lane: usize) -> i32 {
                a[lane]
            }
            #[inline(always)]
            fn u32_lane(a: &$u<S>, lane: usize) -> u32 {
                a[lane]
            }
            #[inline(always)]
            fn mask_lane(a: &$m<S>, lane: usize) -> bool {
                a.to_bitmask() >> lane & 1 != 0
            }
        }
    };
}

simd_lanes!(Simd4, 4, f32x4, i32x4, u32x4, mask32x4);
simd_lanes!(Simd8, 8, f32x8, i32x8, u32x8, mask32x8);
simd_lanes!(Simd16, 16, f32x16, i32x16, u32x16, mask32x16);

/// One lane with masks: `Packet<One>` against the untouched source is the oracle of the lowering.
#[derive(Clone, Copy, Debug, Default)]
pub struct One;

impl Lanes for One {
    const N: usize = 1;
    type F32 = f32;
    type I32 = i32;
    type U32 = u32;
    type Mask = bool;

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
        scalar::f32_unary(O::OP, a)
    }
    #[inline(always)]
    fn f32_binary<O: Op<F32Binary>>(self, _: O, a: f32, b: f32) -> f32 {
        scalar::f32_binary(O::OP, a, b)
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
        scalar::bool_binary(O::OP, a, b)
    }
    #[inline(always)]
    fn mask_not(self, a: bool) -> bool {
        !a
    }
    #[inline(always)]
    fn f32_compare<O: Op<Compare>>(self, _: O, a: f32, b: f32) -> bool {
        scalar::compare(O::OP, a, b)
    }
    #[inline(always)]
    fn i32_compare<O: Op<Compare>>(self, _: O, a: i32, b: i32) -> bool {
        scalar::compare(O::OP, a, b)
    }
    #[inline(always)]
    fn u32_compare<O: Op<Compare>>(self, _: O, a: u32, b: u32) -> bool {
        scalar::compare(O::OP, a, b)
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

/// Lanes whose instruction set the code around is compiled for already.
///
/// Kernels that run on them are inlined instead of entering the level again; that is for the
/// innermost loops, which must not pass registers through memory.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entered<L>(pub(crate) L);

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

/// Lanes around others: what is not given here is theirs.
macro_rules! lanes_around {
    ($name:ident { $($own:tt)* }) => {
        impl<L: Lanes> Lanes for $name<L> {
            const N: usize = L::N;
            type F32 = L::F32;
            type I32 = L::I32;
            type U32 = L::U32;
            type Mask = L::Mask;

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
                f32(v: f32) -> L::F32;
                i32(v: i32) -> L::I32;
                u32(v: u32) -> L::U32;
                mask(v: bool) -> L::Mask;
                f32_mul_add(a: L::F32, b: L::F32, c: L::F32) -> L::F32;
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

lanes_around!(Entered {
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

lanes_around!(Counted {
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
