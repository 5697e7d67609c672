//! SIMD registers of an instruction set.

use fearless_simd::{
    Bytes, Level, Select, Simd, SimdBase, SimdCvtFloat, SimdCvtTruncate, SimdFloat, SimdMask,
    f32x4, f32x8, f32x16, i32x4, i32x8, i32x16, mask32x4, mask32x8, mask32x16, u32x4, u32x8,
    u32x16,
};

use super::{Lanes, fill, shuffle};
use crate::machine::op::known;
use crate::machine::{BoolBinary, Compare, F32Binary, F32Unary, IntBinary, Op, scalar};

/// Returns the name of a level for reports.
fn isa_name(level: Level) -> &'static str {
    #[allow(unreachable_patterns, reason = "which levels exist depends on the target")]
    match level {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx512(_) => "avx512",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx2(_) => "avx2",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Sse4_2(_) => "sse4.2",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Sse2(_) => "sse2",
        #[cfg(target_arch = "aarch64")]
        Level::Neon(_) => "neon",
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        Level::WasmSimd128(_) => "simd128",
        _ => "portable",
    }
}

/// Returns whether a level's `x.min(y)` is `if x < y { x } else { y }` for every pair of numbers,
/// as on x86, and `max` likewise.
#[inline(always)]
fn has_ordered_min(level: Level) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    use Level::{Avx2, Avx512, Sse2, Sse4_2};
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
    ($name:ident, $n:literal, $f:ident, $i:ident, $u:ident, $m:ident; $($own:item)*) => {
        #[doc = concat!(stringify!($n), " lanes of the instruction set that `S` proves.")]
        #[derive(Clone, Copy, Debug)]
        pub struct $name<S: Simd>(pub S);

        // SAFETY: each operation is that of the instruction set, which `fearless_simd` names.
        unsafe impl<S: Simd> Lanes for $name<S> {
            const N: usize = $n;
            const HAS_TABLES: bool = true;
            type F32 = $f<S>;
            type I32 = $i<S>;
            type U32 = $u<S>;
            type Mask = $m<S>;
            type Eight = Simd8<S>;

            #[inline(always)]
            fn eight(self) -> Simd8<S> {
                Simd8(self.0)
            }
            #[inline(always)]
            fn level(self) -> Option<Level> {
                Some(self.0.level())
            }
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
                // Whether the instruction is `if b < a { b } else { a }`, NaN and zeros included.
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
            fn f32_mul_add_fast(self, a: $f<S>, b: $f<S>, c: $f<S>) -> $f<S> {
                a.mul_add(b, c)
            }
            #[inline(always)]
            fn u32_compress(self, a: $u<S>, mask: $m<S>) -> $u<S> {
                a.compress(mask)
            }
            #[inline(always)]
            fn f32_store(self, a: $f<S>, out: &mut [f32]) {
                a.store_slice(&mut out[..$n]);
            }
            #[inline(always)]
            fn u32_store(self, a: $u<S>, out: &mut [u32]) {
                a.store_slice(&mut out[..$n]);
            }
            $($own)*
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

simd_lanes!(Simd4, 4, f32x4, i32x4, u32x4, mask32x4;);
simd_lanes!(Simd8, 8, f32x8, i32x8, u32x8, mask32x8;
    #[inline(always)]
    fn u32_sort_descending(self, a: u32x8<S>) -> u32x8<S> {
        shuffle::sort_descending(self, a)
    }
    #[inline(always)]
    fn u32_least(self, a: u32x8<S>) -> u32 {
        shuffle::least(self, a)
    }
    #[inline(always)]
    fn u32_permute(self, a: u32x8<S>, from: u32x8<S>) -> u32x8<S> {
        shuffle::permute(self, a, from)
    }
);
simd_lanes!(Simd16, 16, f32x16, i32x16, u32x16, mask32x16;);
