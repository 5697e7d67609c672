//! Scrambled Sobol sequences in one and two dimensions.

use glam::{UVec2, UVec4, Vec2, uvec2, vec2};

use super::unit_f32;
use crate::kernel;
use crate::machine::functions::{uvec2, vec2};

/// Returns the `i`-th point of the Sobol sequence in the unit square, as words: a coordinate is a
/// word times 2^-32.
///
/// A (0, 2)-sequence: of the points from a multiple of `2^m` on, each of the `2^m` boxes of one
/// size that halving the square yields holds one, whatever the box's shape. The first coordinate is
/// that of [`van_der_corput()`](super::van_der_corput()). (Sobol, 1967.)
#[kernel]
#[inline]
pub fn sobol_2d(i: u32) -> UVec2 {
    uvec2(i.reverse_bits(), pascal(i).reverse_bits())
}

/// Multiplies the bits of `i` by Pascal's triangle modulo 2, the matrix of the second Sobol
/// dimension with the least bit first: bit `r` is the sum of all bits `k` for which `C(k, r)` is
/// odd.
///
/// By Lucas' theorem those `k` have every bit of the number `r`, so that five exchanges of halves
/// compute the sums; a loop over direction numbers takes 32. (Ahmed, "An Implementation Algorithm
/// of 2D Sobol Sequence Fast, Elegant, and Compact", 2024.)
#[kernel]
#[inline]
fn pascal(i: u32) -> u32 {
    let a = i ^ (i >> 16);
    let b = a ^ ((a & 0xff00_ff00) >> 8);
    let c = b ^ ((b & 0xf0f0_f0f0) >> 4);
    let d = c ^ ((c & 0xcccc_cccc) >> 2);
    d ^ ((d & 0xaaaa_aaaa) >> 1)
}

/// Flips each bit by a hash of the seed and of the bits below it.
///
/// Laine and Karras, "Stratified Sampling for Stochastic Transparency" (2011), found hashes of this
/// kind; these are the constants of Vegdahl, "Building a Better LK Hash" (2021).
#[kernel]
#[inline]
fn laine_karras(x: u32, seed: u32) -> u32 {
    let a = x ^ x.wrapping_mul(0x3d20_adea);
    let b = a.wrapping_add(seed).wrapping_mul((seed >> 16) | 1);
    let c = b ^ b.wrapping_mul(0x0552_6c56);
    c ^ c.wrapping_mul(0x53a2_2864)
}

/// Owen-scrambles a coordinate: whether halves, quarters and so on are swapped depends on the seed
/// and on their position, and nets stay nets.
///
/// Owen, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences" (1995), by a hash instead of a tree
/// of random bits: Burley, "Practical Hash-based Owen Scrambling" (JCGT 2020).
#[kernel]
#[inline]
pub fn owen_scramble(x: u32, seed: u32) -> u32 {
    laine_karras(x.reverse_bits(), seed).reverse_bits()
}

/// Returns the `i`-th point of a shuffled and scrambled Sobol sequence.
///
/// Four words of a hash choose the scrambling: `seeds.x` and `seeds.y` of the coordinates,
/// `seeds.z` of the order. Points with other seeds may be combined to points of more dimensions,
/// since their order is another one (Burley, section 3). Any aligned `2^m` of them are a (0, m,
/// 2)-net.
#[kernel]
#[inline]
pub fn scrambled_sobol_2d(i: u32, seeds: UVec4) -> Vec2 {
    let shuffled = owen_scramble(i, seeds.z);
    // The bits are needed in reverse, so that the reversals of Sobol and Owen cancel.
    let x = laine_karras(shuffled, seeds.x).reverse_bits();
    let y = laine_karras(pascal(shuffled), seeds.y).reverse_bits();
    vec2(unit_f32(x), unit_f32(y))
}

/// Returns the `i`-th number of a shuffled and scrambled Sobol sequence in one dimension.
#[kernel]
#[inline]
pub fn scrambled_sobol_1d(i: u32, seeds: UVec4) -> f32 {
    unit_f32(laine_karras(owen_scramble(i, seeds.z), seeds.x).reverse_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::pcg4d;
    use glam::uvec4;

    /// Returns the sum of direction numbers, as in the literature: each is the one before, halved
    /// and added.
    fn by_direction_numbers(i: u32) -> u32 {
        let (mut sum, mut direction) = (0, 1u32 << 31);
        for k in 0..32 {
            if i >> k & 1 == 1 {
                sum ^= direction;
            }
            direction ^= direction >> 1;
        }
        sum
    }

    #[test]
    fn the_second_dimension_is_that_of_direction_numbers() {
        for i in (0..5000u32).chain((0..5000).map(|k: u32| k.wrapping_mul(0x9e37_79b9))) {
            assert_eq!(sobol_2d(i).y, by_direction_numbers(i), "{i}");
        }
        // Joe and Kuo's table: the first points.
        let first = [0, 1, 2, 3, 4].map(|i| sobol_2d(i).y >> 29);
        assert_eq!(first, [0, 4, 6, 2, 5]);
    }

    /// Checks that every box of every shape holds one of `2^m` points.
    fn assert_net(points: &[Vec2], m: u32) {
        for columns in 0..=m {
            let mut seen = vec![false; points.len()];
            for p in points {
                let column = (f64::from(p.x) * f64::from(1u32 << columns)) as usize;
                let row = (f64::from(p.y) * f64::from(1u32 << (m - columns))) as usize;
                let cell = row << columns | column;
                assert!(!seen[cell], "2^{m} points, 2^{columns} columns: two in a box");
                seen[cell] = true;
            }
        }
    }

    #[test]
    fn aligned_powers_of_two_are_nets() {
        for m in 0..=12 {
            for block in [0, 1, 5, 1000] {
                let points = |seed: u32| {
                    let seeds = pcg4d(uvec4(seed, m, block, 7));
                    let numbers = (block << m)..(block + 1) << m;
                    numbers.map(move |i| scrambled_sobol_2d(i, seeds)).collect::<Vec<_>>()
                };
                let plain = |i: u32| vec2(unit_f32(sobol_2d(i).x), unit_f32(sobol_2d(i).y));
                assert_net(&((block << m)..(block + 1) << m).map(plain).collect::<Vec<_>>(), m);
                assert_net(&points(1), m);
                assert_net(&points(2), m);
            }
        }
    }

    /// Owen's condition: a bit of the result depends on the bits above it, never on those below.
    #[test]
    fn scrambling_keeps_boxes_together() {
        for i in 0..1000u32 {
            let (x, seed) = (i.wrapping_mul(0x9e37_79b9), i.wrapping_mul(0x85eb_ca6b));
            for bits in 1..32 {
                let neighbour = x ^ (1 << (31 - bits));
                let changed = owen_scramble(x, seed) ^ owen_scramble(neighbour, seed);
                assert_eq!(changed.leading_zeros(), bits, "{x:x} {seed:x}");
            }
        }
    }
}
