//! Gangs: packets wider than a register, with several registers per value.

use fearless_simd::Level;

use super::{BoolBinary, Compare, F32Binary, F32Unary, IntBinary, Lanes, Op, fill, op};

/// `K` registers of `L`: `K` times as many lanes of the same level, at most 64.
///
/// `Gang<Simd8<Avx2>, 4>` has 32 lanes of AVX2. Lane `i` is lane `i % L::N` of register `i / L::N`.
/// A decision is made once for the whole gang, so a wide gang executes less control flow, but more
/// of its lanes idle where they diverge.
///
/// ```
/// use raydsl::machine::{Gang, Lanes, One};
///
/// let gang = Gang::<One, 32>(One);
/// let odd = gang.u32_from_fn(|lane| lane as u32 % 2);
/// let is_odd = gang.u32_compare(raydsl::machine::op::Eq, odd, gang.u32(1));
/// assert_eq!(gang.bits(is_odd), 0xaaaa_aaaa);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Gang<L, const K: usize>(pub L);

/// Implements the operations that act on each register alone.
macro_rules! each_register {
    ($($name:ident($($a:ident: $register:ident),+) -> $result:ident;)+) => {
        $(
            #[inline(always)]
            fn $name(self, $($a: Self::$register),+) -> Self::$result {
                fill(
                    #[inline(always)]
                    |i| self.0.$name($($a[i]),+),
                )
            }
        )+
    };
    (operations $($name:ident: $kind:ident($($a:ident: $register:ident),+) -> $result:ident;)+) => {
        $(
            #[inline(always)]
            fn $name<O: Op<$kind>>(self, op: O, $($a: Self::$register),+) -> Self::$result {
                fill(
                    #[inline(always)]
                    |i| self.0.$name(op, $($a[i]),+),
                )
            }
        )+
    };
}

/// Implements a splat, a value per lane, and the value of one lane.
macro_rules! numbers {
    ($($t:ident $register:ident $from_fn:ident $lane:ident;)+) => {
        $(
            #[inline(always)]
            fn $t(self, v: $t) -> Self::$register {
                [self.0.$t(v); K]
            }
            #[inline(always)]
            fn $from_fn(self, mut f: impl FnMut(usize) -> $t) -> Self::$register {
                fill(
                    #[inline(always)]
                    |i| self.0.$from_fn(
                        #[inline(always)]
                        |lane| f(i * L::N + lane),
                    ),
                )
            }
            #[inline(always)]
            fn $lane(a: &Self::$register, lane: usize) -> $t {
                L::$lane(&a[lane / L::N], lane % L::N)
            }
        )+
    };
}

// SAFETY: each operation is that of the lanes within.
unsafe impl<L: Lanes, const K: usize> Lanes for Gang<L, K> {
    const N: usize = {
        assert!(L::N * K <= 64, "a mask has 64 bits");
        L::N * K
    };
    type F32 = [L::F32; K];
    type I32 = [L::I32; K];
    type U32 = [L::U32; K];
    type Mask = [L::Mask; K];
    type Eight = L::Eight;

    #[inline(always)]
    fn eight(self) -> L::Eight {
        self.0.eight()
    }
    #[inline(always)]
    fn level(self) -> Option<Level> {
        self.0.level()
    }
    fn isa(self) -> &'static str {
        self.0.isa()
    }
    #[inline(always)]
    fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
        self.0.vectorize(f)
    }

    numbers! {
        f32 F32 f32_from_fn f32_lane;
        i32 I32 i32_from_fn i32_lane;
        u32 U32 u32_from_fn u32_lane;
    }

    each_register! {
        operations
        f32_unary: F32Unary(a: F32) -> F32;
        f32_binary: F32Binary(a: F32, b: F32) -> F32;
        i32_binary: IntBinary(a: I32, b: I32) -> I32;
        u32_binary: IntBinary(a: U32, b: U32) -> U32;
        mask_binary: BoolBinary(a: Mask, b: Mask) -> Mask;
        f32_compare: Compare(a: F32, b: F32) -> Mask;
        i32_compare: Compare(a: I32, b: I32) -> Mask;
        u32_compare: Compare(a: U32, b: U32) -> Mask;
    }

    each_register! {
        f32_mul_add(a: F32, b: F32, c: F32) -> F32;
        f32_mul_add_fast(a: F32, b: F32, c: F32) -> F32;
        mask_not(a: Mask) -> Mask;
        f32_select(c: Mask, a: F32, b: F32) -> F32;
        i32_select(c: Mask, a: I32, b: I32) -> I32;
        u32_select(c: Mask, a: U32, b: U32) -> U32;
        f32_to_i32(a: F32) -> I32;
        f32_to_u32(a: F32) -> U32;
        i32_to_f32(a: I32) -> F32;
        u32_to_f32(a: U32) -> F32;
        i32_to_u32(a: I32) -> U32;
        u32_to_i32(a: U32) -> I32;
        f32_to_bits(a: F32) -> U32;
        f32_from_bits(a: U32) -> F32;
    }

    #[inline(always)]
    fn mask(self, v: bool) -> Self::Mask {
        [self.0.mask(v); K]
    }
    #[inline(always)]
    fn any(self, a: Self::Mask) -> bool {
        let mut all = a[0];
        let mut i = 1;
        while i < K {
            all = self.0.mask_binary(op::Or, all, a[i]);
            i += 1;
        }
        self.0.any(all)
    }
    #[inline(always)]
    fn bits(self, a: Self::Mask) -> u64 {
        let mut bits = 0;
        let mut i = 0;
        while i < K {
            bits |= self.0.bits(a[i]) << (i * L::N);
            i += 1;
        }
        bits
    }
    #[inline(always)]
    fn mask_from_bits(self, bits: u64) -> Self::Mask {
        let lanes = u64::MAX >> (64 - L::N);
        fill(
            #[inline(always)]
            |i| self.0.mask_from_bits(bits >> (i * L::N) & lanes),
        )
    }
    #[inline(always)]
    fn mask_lane(a: &Self::Mask, lane: usize) -> bool {
        L::mask_lane(&a[lane / L::N], lane % L::N)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::One;

    /// Tests that masks of 64 lanes use every bit of a word and that nothing shifts by 64, an
    /// error.
    #[test]
    fn sixty_four_lanes() {
        type All = Gang<Gang<One, 4>, 16>;
        let all = Gang::<_, 16>(Gang::<_, 4>(One));
        assert_eq!(All::N, 64);
        for bits in [0, 1, 1 << 63, u64::MAX, 0x0123_4567_89ab_cdef] {
            let mask = all.mask_from_bits(bits);
            assert_eq!(all.bits(mask), bits);
            assert_eq!(all.any(mask), bits != 0);
            assert_eq!(all.bits(all.mask_not(mask)), !bits);
            let lanes = (0..64).filter(|l| All::mask_lane(&mask, *l)).count();
            assert_eq!(lanes, bits.count_ones() as usize);
        }
        let numbers = all.u32_from_fn(|lane| lane as u32);
        assert!((0..64).all(|l| All::u32_lane(&numbers, l) == l as u32));
    }
}
