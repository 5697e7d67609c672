//! Hash functions of four words: counter in, random bits out.

use glam::{UVec2, UVec4, uvec2, uvec4};

use crate::kernel;
use crate::machine::functions::{uvec2, uvec4};

/// Hashes four words to four random words.
///
/// `pcg4d` of Jarzynski and Olano, "Hash Functions for GPU Rendering" (JCGT 2020), listing 3.16: a
/// linear congruential step, products of the words with each other, and a shift between them. It is
/// a bijection, so that no two counters have the same four words. In their measurements it is on
/// the front of speed against quality. One call yields as many numbers as a sample needs.
///
/// A change of one of the lower 20 bits of any word changes each of the upper 24 bits of all words
/// with a probability of a half, as far as 100,000 trials show. The higher bits reach fewer: bit 31
/// alone changes only the upper half. Put counters into the lower bits.
#[kernel]
#[inline]
pub fn pcg4d(v: UVec4) -> UVec4 {
    let x = congruent(v.x);
    let y = congruent(v.y);
    let z = congruent(v.z);
    let w = congruent(v.w);
    let mixed = crossed(uvec4(x, y, z, w));
    crossed(uvec4(
        mixed.x ^ (mixed.x >> 16),
        mixed.y ^ (mixed.y >> 16),
        mixed.z ^ (mixed.z >> 16),
        mixed.w ^ (mixed.w >> 16),
    ))
}

/// Steps the linear congruential generator of "Numerical Recipes" (1992).
#[kernel]
#[inline]
fn congruent(x: u32) -> u32 {
    x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)
}

/// Adds to each word, one after another, the product of two others.
#[kernel]
#[inline]
fn crossed(v: UVec4) -> UVec4 {
    let x = v.x.wrapping_add(v.y.wrapping_mul(v.w));
    let y = v.y.wrapping_add(v.z.wrapping_mul(x));
    let z = v.z.wrapping_add(x.wrapping_mul(y));
    let w = v.w.wrapping_add(y.wrapping_mul(z));
    uvec4(x, y, z, w)
}

/// Encrypts a counter with a key to four random words.
///
/// Philox-4x32-10 of Salmon, Moraes, Dror and Shaw, "Parallel Random Numbers: As Easy as 1, 2, 3"
/// (SC 2011): ten rounds of a cipher that passes every test of `TestU01`. It takes about ten times
/// the operations of [`pcg4d()`], since a kernel has no product of 64 bits; it is for simulations
/// that must defend their random numbers.
#[kernel]
pub fn philox4x32(counter: UVec4, key: UVec2) -> UVec4 {
    let mut words = counter;
    let mut round_key = key;
    for _ in 0u32..10 {
        let upper_x = product_high(0xd251_1f53, words.x);
        let lower_x = words.x.wrapping_mul(0xd251_1f53);
        let upper_z = product_high(0xcd9e_8d57, words.z);
        let lower_z = words.z.wrapping_mul(0xcd9e_8d57);
        words = uvec4(
            upper_z ^ words.y ^ round_key.x,
            lower_z,
            upper_x ^ words.w ^ round_key.y,
            lower_x,
        );
        round_key =
            uvec2(round_key.x.wrapping_add(0x9e37_79b9), round_key.y.wrapping_add(0xbb67_ae85));
    }
    words
}

/// Returns the upper word of the product of two words.
#[kernel]
#[inline]
fn product_high(a: u32, b: u32) -> u32 {
    let a_low = a & 0xffff;
    let a_high = a >> 16;
    let b_low = b & 0xffff;
    let b_high = b >> 16;
    let cross = a_low.wrapping_mul(b_high);
    // At most (2^16 - 1)^2 + 2 (2^16 - 1), which a word holds.
    let middle = a_high
        .wrapping_mul(b_low)
        .wrapping_add(cross & 0xffff)
        .wrapping_add(a_low.wrapping_mul(b_low) >> 16);
    a_high.wrapping_mul(b_high).wrapping_add(cross >> 16).wrapping_add(middle >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test vectors of Random123, the authors' library (`tests/kat_vectors`).
    #[test]
    fn philox_gives_the_published_words() {
        let all = u32::MAX;
        let vectors = [
            ([0; 4], [0; 2], [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]),
            ([all; 4], [all; 2], [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]),
            (
                [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344],
                [0xa409_3822, 0x299f_31d0],
                [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1],
            ),
        ];
        for (counter, key, expected) in vectors {
            let words = philox4x32(UVec4::from_array(counter), UVec2::from_array(key));
            assert_eq!(words.to_array(), expected);
        }
    }

    #[test]
    fn products_have_an_upper_word() {
        for a in [0, 1, 0xffff, 0x1_0000, 0xd251_1f53, u32::MAX] {
            for b in [0, 1, 0xffff, 0x1_0000, 0x8000_0001, u32::MAX] {
                let exact = u64::from(a) * u64::from(b);
                assert_eq!(product_high(a, b), (exact >> 32) as u32, "{a} {b}");
            }
        }
    }

    /// Each step can be undone, so that it is a bijection.
    #[test]
    fn pcg4d_can_be_undone() {
        let undone = |v: UVec4| {
            let uncrossed = |v: UVec4| {
                let w = v.w.wrapping_sub(v.y.wrapping_mul(v.z));
                let z = v.z.wrapping_sub(v.x.wrapping_mul(v.y));
                let y = v.y.wrapping_sub(z.wrapping_mul(v.x));
                let x = v.x.wrapping_sub(y.wrapping_mul(w));
                [x, y, z, w]
            };
            let mixed = uncrossed(v).map(|x| x ^ (x >> 16));
            // The inverse of 1664525 modulo 2^32, by Newton's iteration.
            let inverse = (0..5)
                .fold(1u32, |i, _| i.wrapping_mul(2u32.wrapping_sub(1_664_525u32.wrapping_mul(i))));
            let back = |x: u32| x.wrapping_sub(1_013_904_223).wrapping_mul(inverse);
            UVec4::from_array(uncrossed(UVec4::from_array(mixed)).map(back))
        };
        for i in 0..1000u32 {
            let v = uvec4(i, i.wrapping_mul(0x9e37_79b9), !i, i << 20);
            assert_eq!(undone(pcg4d(v)), v);
        }
    }
}
