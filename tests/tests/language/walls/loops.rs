//! Parts of lists, and patterns, in the head of a `for`.

use raydsl::prelude::*;
use raydsl::{Type, assert_variants_agree, kernel};

use super::pairs;

#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Pair {
    a: f32,
    b: u32,
}

#[kernel]
#[expect(clippy::needless_borrow, reason = "kernels take either form")]
fn parts(all: &[f32], x: f32, y: f32) -> f32 {
    let first = (x.abs() * 3.0) as usize % all.len();
    let end = (first + (y.abs() * 4.0) as usize).min(all.len());
    let mut sum = x;
    for w in &all[first..end] {
        sum = sum * 0.5 + w;
    }
    for (i, w) in all[..end].iter().rev().enumerate() {
        sum += i as f32 * w;
    }
    for (v, w) in (&all[first..]).iter().zip(all[2..=4].iter()) {
        sum += v * w;
        if sum > 4.0 {
            break;
        }
    }
    for w in &all[1..3] {
        sum -= w;
    }
    let square = [x, y, 1.0, 2.0];
    for v in &square[1..(first + 1).min(3)] {
        sum += v * y;
    }
    sum
}

#[kernel]
fn patterns(pairs: &[Pair], spans: &[[f32; 2]], points: &[(f32, u32)], x: f32, y: f32) -> f32 {
    let mut sum = y;
    for Pair { a, b } in pairs {
        sum += a * *b as f32;
    }
    for &Pair { a, b: count } in pairs.iter().rev() {
        sum = sum * 0.5 + a * count as f32;
    }
    for &[low, high] in spans {
        if x < low || x > high {
            continue;
        }
        sum += high - low;
    }
    for [low, _] in spans.iter() {
        sum += low * x;
    }
    for (i, &(p, n)) in points.iter().enumerate() {
        sum += p * (n + i as u32) as f32;
    }
    for ((p, _), Pair { a, .. }) in points.iter().zip(pairs) {
        sum += p * a;
    }
    for (a, b) in [(x, y), (y, 2.0)] {
        sum += a * b;
    }
    for (i, mut a) in [x, y].into_iter().enumerate() {
        a += i as f32;
        sum += a;
    }
    for &a in &[x, y] {
        sum -= a;
    }
    sum
}

#[test]
fn parts_of_lists() {
    let all = vec![0.5f32, -1.0, 2.0, 0.25, 1.5, -0.75, 3.0];
    let kernel = kernel!(|x: f32, y: f32| parts(&all, x * 1.01 + 0.003, y * 0.99 + 0.001));
    assert_variants_agree!(&kernel, &pairs());
}

#[test]
fn patterns_in_heads() {
    let of = vec![Pair { a: 0.5, b: 3 }, Pair { a: -1.5, b: 2 }];
    let spans = vec![[-1.003f32, 0.217], [0.104, 0.501], [-0.302, 1.003]];
    let points = vec![(0.5f32, 2u32), (1.25, 0), (-0.5, 7)];
    let kernel = kernel!(|x: f32, y: f32| patterns(&of, &spans, &points, x, y));
    assert_variants_agree!(&kernel, &pairs());
}

/// A loop on a condition of the host runs until it is left, or not at all.
#[test]
#[expect(clippy::while_immutable_condition, reason = "the host decides it once")]
fn loops_of_host_conditions() {
    for is_on in [false, true] {
        let kernel = kernel!(|x: f32| {
            let mut sum = x;
            while is_on {
                sum += 1.5;
                if sum > 9.0 {
                    break;
                }
            }
            sum
        });
        assert_eq!(kernel.call((2.0,)), if is_on { 9.5 } else { 2.0 });
        assert_variants_agree!(&kernel, &[(2.0,), (0.5,), (20.0,)]);
    }
}
