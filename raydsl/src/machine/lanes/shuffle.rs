//! Permutations and sorting of eight lanes.

use fearless_simd::{Simd, u32x8};

use super::{Lanes, Simd8};

/// Sorts the lanes in descending order by a bitonic network (Batcher, "Sorting Networks and Their
/// Applications", AFIPS 1968).
#[inline(always)]
pub(super) fn sort_descending<S: Simd>(lanes: Simd8<S>, a: u32x8<S>) -> u32x8<S> {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = lanes.0.level().as_avx2() {
        return x86::sort_descending(avx2, lanes.0, a);
    }
    sort_by_insertion(lanes, a)
}

/// Returns the smallest lane.
#[inline(always)]
pub(super) fn least<S: Simd>(lanes: Simd8<S>, a: u32x8<S>) -> u32 {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = lanes.0.level().as_avx2() {
        return x86::least(avx2, a);
    }
    least_by_lane(lanes, a)
}

/// Returns the smallest lane, for any lanes.
#[inline(always)]
pub(super) fn least_by_lane<L: Lanes>(_: L, a: L::U32) -> u32 {
    (0..L::N).fold(
        u32::MAX,
        #[inline(always)]
        |least, lane| least.min(L::u32_lane(&a, lane)),
    )
}

/// Returns in each lane the lane of `a` that `from` names, modulo 8.
#[inline(always)]
pub(super) fn permute<S: Simd>(lanes: Simd8<S>, a: u32x8<S>, from: u32x8<S>) -> u32x8<S> {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = lanes.0.level().as_avx2() {
        return x86::permute(avx2, lanes.0, a, from);
    }
    permute_by_lane(lanes, a, from)
}

/// Sorts any lanes in descending order.
#[inline(always)]
pub(super) fn sort_by_insertion<L: Lanes>(lanes: L, a: L::U32) -> L::U32 {
    let mut sorted = [0; 64];
    for lane in 0..L::N {
        let v = L::u32_lane(&a, lane);
        let mut place = lane;
        while place > 0 && sorted[place - 1] < v {
            sorted[place] = sorted[place - 1];
            place -= 1;
        }
        sorted[place] = v;
    }
    lanes.u32_from_fn(|lane| sorted[lane])
}

/// Permutes any lanes, modulo their number.
#[inline(always)]
pub(super) fn permute_by_lane<L: Lanes>(lanes: L, a: L::U32, from: L::U32) -> L::U32 {
    lanes.u32_from_fn(|lane| L::u32_lane(&a, L::u32_lane(&from, lane) as usize % L::N))
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod x86 {
    #[cfg(target_arch = "x86")]
    use core::arch::x86 as arch;
    #[cfg(target_arch = "x86_64")]
    use core::arch::x86_64 as arch;

    use arch::{
        __m256i, _mm_cvtsi128_si32, _mm_min_epu32, _mm_shuffle_epi32, _mm256_blend_epi32,
        _mm256_castsi256_si128, _mm256_extracti128_si256, _mm256_max_epu32, _mm256_min_epu32,
        _mm256_permute4x64_epi64, _mm256_permutevar8x32_epi32, _mm256_shuffle_epi32,
    };
    use fearless_simd::{Avx2, Simd, SimdInto, u32x8};

    /// Performs one step of the network: each lane is compared with its partner, and the lanes of
    /// the mask keep the smaller number.
    macro_rules! step {
        ($a:ident, $partner:expr, $smaller:literal) => {{
            let b = $partner;
            _mm256_blend_epi32::<$smaller>(_mm256_max_epu32($a, b), _mm256_min_epu32($a, b))
        }};
    }

    #[inline(always)]
    pub(super) fn sort_descending<S: Simd>(avx2: Avx2, simd: S, a: u32x8<S>) -> u32x8<S> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn sort(_token: Avx2, a: __m256i) -> __m256i {
                let a = step!(a, _mm256_shuffle_epi32::<0xb1>(a), 0x66);
                let a = step!(a, _mm256_shuffle_epi32::<0x4e>(a), 0x3c);
                let a = step!(a, _mm256_shuffle_epi32::<0xb1>(a), 0x5a);
                let a = step!(a, _mm256_permute4x64_epi64::<0x4e>(a), 0xf0);
                let a = step!(a, _mm256_shuffle_epi32::<0x4e>(a), 0xcc);
                step!(a, _mm256_shuffle_epi32::<0xb1>(a), 0xaa)
            }
        );
        sort(avx2, a.into()).simd_into(simd)
    }

    #[inline(always)]
    pub(super) fn least<S: Simd>(avx2: Avx2, a: u32x8<S>) -> u32 {
        fearless_simd::kernel!(
            #[inline(always)]
            fn least(_token: Avx2, a: __m256i) -> u32 {
                let a = _mm_min_epu32(_mm256_castsi256_si128(a), _mm256_extracti128_si256::<1>(a));
                let a = _mm_min_epu32(a, _mm_shuffle_epi32::<0x4e>(a));
                let a = _mm_min_epu32(a, _mm_shuffle_epi32::<0xb1>(a));
                _mm_cvtsi128_si32(a) as u32
            }
        );
        least(avx2, a.into())
    }

    #[inline(always)]
    pub(super) fn permute<S: Simd>(avx2: Avx2, simd: S, a: u32x8<S>, from: u32x8<S>) -> u32x8<S> {
        fearless_simd::kernel!(
            #[inline(always)]
            fn permute(_token: Avx2, a: __m256i, from: __m256i) -> __m256i {
                _mm256_permutevar8x32_epi32(a, from)
            }
        );
        permute(avx2, a.into(), from.into()).simd_into(simd)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests that every order of zeroes and ones is sorted, and so every order of anything (the 0-1
    /// principle: Knuth, "The Art of Computer Programming", volume 3, section 5.3.4), and that a
    /// permutation returns the lanes named.
    fn check<L: Lanes>(l: L) {
        for bits in 0..256u32 {
            let of = |lane: usize| (bits >> lane & 1) * u32::MAX;
            let sorted = l.u32_sort_descending(l.u32_from_fn(of));
            let ones = bits.count_ones() as usize;
            assert!(
                (0..8).all(|lane| L::u32_lane(&sorted, lane) == u32::from(lane < ones) * u32::MAX)
            );
            let numbered = |lane: usize| of(lane) ^ (0x8000_0000 + 7 - lane as u32);
            let least = (0..8).map(numbered).min().expect("eight");
            assert_eq!(l.u32_least(l.u32_from_fn(numbered)), least);
            let packed =
                l.u32_compress(l.u32_from_fn(|lane| lane as u32), l.mask_from_bits(bits.into()));
            let expected = (0..8).filter(|lane| bits >> lane & 1 != 0);
            assert!(expected.enumerate().all(|(at, lane)| L::u32_lane(&packed, at) == lane));
            let from = |lane: usize| (bits.rotate_left(lane as u32) ^ lane as u32) & 0xff;
            let moved = l.u32_permute(l.u32_from_fn(|lane| 10 * lane as u32), l.u32_from_fn(from));
            assert!((0..8).all(|lane| L::u32_lane(&moved, lane) == from(lane) % 8 * 10));
        }
    }

    #[test]
    fn every_level_sorts_packs_and_permutes() {
        check(crate::machine::Gang::<_, 8>(crate::machine::One));
        check(Simd8(fearless_simd::Fallback::new()));
        #[cfg(target_arch = "x86_64")]
        {
            let level = fearless_simd::Level::new();
            level.as_sse4_2().into_iter().for_each(|s| check(Simd8(s)));
            level.as_avx2().into_iter().for_each(|s| check(Simd8(s)));
            level.as_avx512().into_iter().for_each(|s| check(Simd8(s)));
        }
    }
}
