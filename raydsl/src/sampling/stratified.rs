//! Stratified sampling: points in the cells of a grid.

use glam::{UVec4, Vec2, vec2};

use super::rng::ONE_MINUS_EPSILON;
use crate::kernel;
use crate::machine::functions::vec2;
use crate::machine::generic::{max, min};

/// Returns the position of `i` in a random permutation of `0..count`.
///
/// Kensler, "Correlated Multi-Jittered Sampling" (Pixar Technical Memo 13-01, 2013): a hash that is
/// a bijection of the next power of two is applied until the result is below `count`, less than
/// twice on average. A `count` of 0 counts as 1, an `i` beyond it as its remainder.
#[kernel]
pub fn permuted(i: u32, count: u32, seed: u32) -> u32 {
    let length = max(count, 1);
    let mask = 0xffff_ffffu32.wrapping_shr((length - 1).leading_zeros());
    let mask = if length == 1 { 0 } else { mask };
    let mut x = hash_within(i % length, mask, seed);
    while x >= length {
        x = hash_within(x, mask, seed);
    }
    // Add modulo the length, which may itself be large.
    let turn = seed % length;
    let room = length - turn;
    if x >= room { x - room } else { x + turn }
}

/// Applies a bijection of the numbers up to `mask`, which is a power of two less 1; the constants
/// are Kensler's.
#[kernel]
#[inline]
fn hash_within(i: u32, mask: u32, seed: u32) -> u32 {
    let a = (i ^ seed).wrapping_mul(0xe170_893d) ^ (seed >> 16);
    let b = a ^ ((a & mask) >> 4) ^ (seed >> 8);
    let c = b.wrapping_mul(0x0929_eb3f) ^ (seed >> 23);
    let d = (c ^ ((c & mask) >> 1)).wrapping_mul(1 | (seed >> 27)).wrapping_mul(0x6935_fa69);
    let e = (d ^ ((d & mask) >> 11)).wrapping_mul(0x74dc_b303);
    let f = (e ^ ((e & mask) >> 2)).wrapping_mul(0x9e50_1cc3);
    let g = (f ^ ((f & mask) >> 2)).wrapping_mul(0xc860_a3df) & mask;
    g ^ (g >> 5)
}

/// Returns the `i`-th of `count` numbers, one in each `count`-th of the unit interval, in a random
/// order. `jitter` is its position in its part.
#[kernel]
#[inline]
pub fn stratified_1d(i: u32, count: u32, seed: u32, jitter: f32) -> f32 {
    let part = permuted(i, count, seed);
    min((part as f32 + jitter) / max(count, 1) as f32, ONE_MINUS_EPSILON)
}

/// Returns the `i`-th of `count` points, one in each cell of a grid and in each `count`-th of the
/// height, and of the width where `count` is a square.
///
/// Multi-jittered sampling (Chiu, Shirley and Wang, "Graphics Gems IV", 1994) for any `count`,
/// without a table: each column and row has an order of its own. With one order for all of them, as
/// in Kensler, errors of smooth integrands fall as `count^-3/4`; so they do as `1 / count`. The
/// seeds are those of the order, the columns, and the positions within columns and rows; `jitter`
/// is the point's position in its part.
#[kernel]
#[inline]
pub fn stratified_2d(i: u32, count: u32, seeds: UVec4, jitter: Vec2) -> Vec2 {
    let n = max(count, 1);
    let columns = square_root(n);
    // Round up without overflow.
    let rows = (n - 1) / columns + 1;
    let s = permuted(i, n, seeds.x);
    let row = s / columns;
    let column = permuted(s % columns, columns, seeds.y);
    // The last row may be shorter.
    let length = min(columns, n - row * columns);
    let right = permuted(row, rows, mixed(seeds.z ^ column));
    let up = permuted(s % columns, length, mixed(seeds.w ^ row));
    let x = (column as f32 + (right as f32 + jitter.x) / rows as f32) / columns as f32;
    let y = ((row * columns + up) as f32 + jitter.y) / n as f32;
    vec2(min(x, ONE_MINUS_EPSILON), min(y, ONE_MINUS_EPSILON))
}

/// Hashes one word: Wellons' `lowbias32` (2018, constants of 2022).
#[kernel]
#[inline]
fn mixed(x: u32) -> u32 {
    let a = (x ^ (x >> 16)).wrapping_mul(0x21f0_aaad);
    let b = (a ^ (a >> 15)).wrapping_mul(0x735a_2d97);
    b ^ (b >> 15)
}

/// Returns the integer part of the square root. A device's `sqrt` may be rounded another way, which
/// would choose another grid.
#[kernel]
#[inline]
fn square_root(n: u32) -> u32 {
    let root = min((n as f32).sqrt() as u32, 65_535);
    let lower = if root > n / max(root, 1) { root - 1 } else { root };
    let next = lower + 1;
    if next <= n / next { next } else { lower }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::pcg4d;
    use glam::uvec4;

    #[test]
    fn orders_have_every_number_once() {
        for count in (1..70).chain([127, 128, 129, 1000, 4096]) {
            for seed in [0, 1, 0xdead_beef, u32::MAX] {
                let mut all: Vec<u32> = (0..count).map(|i| permuted(i, count, seed)).collect();
                all.sort_unstable();
                assert!(all.into_iter().eq(0..count), "{count} {seed}");
            }
        }
        assert_eq!(permuted(5, 0, 9), 0);
        assert!(permuted(u32::MAX, u32::MAX, 3) < u32::MAX);
    }

    #[test]
    fn roots_are_exact() {
        for k in 1..=65_535u32 {
            assert_eq!([square_root(k * k), square_root(k * k - 1)], [k, k - 1]);
        }
        assert_eq!([square_root(1), square_root(u32::MAX)], [1, 65_535]);
    }

    /// Counts the `points` in each of `n` parts of the unit interval.
    fn counts(points: impl Iterator<Item = f32>, n: u32) -> Vec<u32> {
        let mut all = vec![0; n as usize];
        for x in points {
            all[(f64::from(x) * f64::from(n)) as usize] += 1;
        }
        all
    }

    #[test]
    fn every_part_holds_one() {
        for n in [1u32, 2, 3, 4, 9, 12, 16, 17, 64, 100, 1024] {
            let seeds = pcg4d(uvec4(n, 1, 2, 3));
            let jitter = |i: u32| {
                let words = pcg4d(uvec4(i, n, 5, 6));
                vec2(crate::sampling::unit_f32(words.x), crate::sampling::unit_f32(words.y))
            };
            let points: Vec<Vec2> = (0..n).map(|i| stratified_2d(i, n, seeds, jitter(i))).collect();
            assert_eq!(counts(points.iter().map(|p| p.y), n), vec![1; n as usize], "{n}");
            let side = square_root(n);
            if side * side == n {
                assert_eq!(counts(points.iter().map(|p| p.x), n), vec![1; n as usize], "{n}");
                let cell = |p: &Vec2| {
                    (p.x * side as f32).floor() + (p.y * side as f32).floor() * side as f32
                };
                let cells = points.iter().map(|p| (cell(p) + 0.5) / n as f32);
                assert_eq!(counts(cells, n), vec![1; n as usize], "{n}");
            }
            let line = (0..n).map(|i| stratified_1d(i, n, seeds.w, jitter(i).x));
            assert_eq!(counts(line, n), vec![1; n as usize], "{n}");
        }
    }
}
