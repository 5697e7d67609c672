//! Calls with many arguments, and exchanges of variables.

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

use super::pairs;

#[kernel]
#[allow(clippy::too_many_arguments, reason = "that is the test")]
fn many(
    a: f32,
    b: u32,
    c: Vec3,
    d: f32,
    e: f32,
    f: f32,
    g: bool,
    h: f32,
    i: [f32; 2],
    j: f32,
    k: f32,
    l: f32,
    n: f32,
    o: f32,
    p: (f32, u32),
    mut q: f32,
) -> f32 {
    q += a * b as f32 + c.y - d * e + f;
    if g && h > 0.0 {
        return q;
    }
    q + i[1] * j - k + l * n + o * p.0 + p.1 as f32
}

#[kernel]
fn calls_many(x: f32, y: f32) -> f32 {
    let first =
        many(x, 3, Vec3::splat(y), x, y, 1.0, x > y, y, [x, y], 1.0, x, y, x, y, (x, 2u32), y);
    first * many(y, 1, Vec3::ONE, y, x, 2.0, x < y, x, [y, x], x, 0.5, x, y, x, (y, 0u32), x)
}

#[kernel]
fn sort_two(a: &mut f32, b: &mut f32) {
    if *a > *b {
        core::mem::swap(a, b);
    }
}

#[kernel]
fn exchanged(x: f32, y: f32) -> [f32; 5] {
    let (mut a, mut b) = (x, y);
    sort_two(&mut a, &mut b);
    let mut xs = [x, y, x * y, x - y, 1.0];
    std::mem::swap(&mut a, &mut xs[4]);
    // The largest first.
    for i in 0..xs.len() {
        for k in i + 1..xs.len() {
            if xs[k] > xs[i] {
                xs.swap(i, k);
            }
        }
    }
    xs.swap(0, 1);
    let mut pair = (xs, [b; 3]);
    pair.0.swap(1, (x.abs() * 3.0) as usize % 5);
    std::mem::swap(&mut pair.0[2], &mut pair.1[1]);
    pair.0
}

#[test]
fn many_arguments() {
    assert_variants_agree!(calls_many, &pairs());
}

#[test]
fn exchanges() {
    let inputs: Vec<(f32, f32)> =
        pairs().into_iter().map(|(x, y)| (x * 1.013 + 0.0021, y * 0.987 - 0.0047)).collect();
    assert_variants_agree!(exchanged, &inputs);
}
