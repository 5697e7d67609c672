//! The nearest colour of a palette, under a metric of the caller. (closure, option, computed index,
//! early return)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

#[kernel]
fn nearest(
    palette: &[Vec3],
    metric: impl Fn(Vec3, Vec3) -> f32,
    color: Vec3,
    reach: f32,
) -> Option<usize> {
    let mut best = None;
    let mut least = reach;
    for (i, entry) in palette.iter().enumerate() {
        let d = metric(*entry, color);
        if d == 0.0 {
            return Some(i);
        }
        if d < least {
            least = d;
            best = Some(i);
        }
    }
    best
}

#[kernel]
fn quantized(palette: &[Vec3], color: Vec3) -> Vec3 {
    let luma = vec3(0.2126, 0.7152, 0.0722);
    let weighted = |a: Vec3, b: Vec3| {
        let d = a - b;
        (d * d * luma).element_sum().sqrt()
    };
    match nearest(palette, weighted, color, 0.3) {
        Some(i) => palette[i],
        None => Vec3::splat(color.dot(luma)),
    }
}

#[test]
fn colours_are_quantized() {
    let palette = [Vec3::ZERO, Vec3::ONE, Vec3::X, vec3(0.1, 0.6, 0.2)];
    let palette = &palette[..];
    let kernel = kernel!(|color: Vec3| quantized(palette, color));
    let colors: Vec<Vec3> =
        (0..343).map(|i| vec3((i % 7) as f32, (i / 7 % 7) as f32, (i / 49) as f32) / 6.0).collect();
    assert_variants_agree!(&kernel, &colors);
    assert_eq!(kernel.call((Vec3::X,)), Vec3::X);
}
