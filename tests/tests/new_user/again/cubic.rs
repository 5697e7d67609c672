//! The real roots of a cubic, polished. (closure, zip, bare integers, early return)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

/// Up to three roots, in order.
#[derive(Clone, Copy, Type)]
struct Roots {
    at: [f32; 3],
    count: i32,
}

/// A root between `a` and `b`, at which `f` has different signs.
#[kernel]
fn between(f: impl Fn(f32) -> f32, a: f32, b: f32) -> f32 {
    let (mut low, mut high) = (a, b);
    let falls = f(a) > 0.0;
    for _ in 0..30 {
        let middle = (low + high) * 0.5;
        if (f(middle) > 0.0) == falls { low = middle } else { high = middle }
    }
    (low + high) * 0.5
}

/// The roots of x^3 + b x^2 + c x + d from -reach to reach.
#[kernel]
fn roots(b: f32, c: f32, d: f32, reach: f32) -> Roots {
    let f = |x: f32| ((x + b) * x + c) * x + d;
    let mut roots = Roots { at: [0.0; 3], count: 0 };
    let inner = b * b - 3.0 * c;
    if inner <= 0.0 {
        if f(-reach) * f(reach) <= 0.0 {
            roots.at[0] = between(f, -reach, reach);
            roots.count = 1;
        }
        return roots;
    }
    let spread = inner.sqrt();
    let starts = [-reach, (-b - spread) / 3.0, (-b + spread) / 3.0];
    let ends = [(-b - spread) / 3.0, (-b + spread) / 3.0, reach];
    for (start, end) in starts.iter().zip(ends) {
        if *start < end && f(*start) * f(end) < 0.0 {
            roots.at[roots.count as usize] = between(f, *start, end);
            roots.count += 1;
        }
    }
    roots
}

#[test]
fn roots_are_roots() {
    let kernel = kernel!(|b: f32, c: f32, d: f32| {
        let found = roots(b, c, d, 10.0);
        (found.at, found.count)
    });
    let inputs: Vec<(f32, f32, f32)> = (0..300)
        .map(|i| ((i % 7) as f32 - 3.1, (i % 11) as f32 - 8.2, (i % 5) as f32 - 1.7))
        .collect();
    assert_variants_agree!(&kernel, &inputs);
    let ([a, b, c], count) = kernel.call((-6.0, 11.0, -6.0));
    assert_eq!(count, 3);
    assert!((a - 1.0).abs() < 1e-4 && (b - 2.0).abs() < 1e-4 && (c - 3.0).abs() < 1e-4);
}
