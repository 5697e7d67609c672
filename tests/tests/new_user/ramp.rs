//! A colour ramp with uneven knots. (option, early return, computed index, bare integers)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

/// A knot of the ramp.
#[derive(Clone, Copy, Type)]
struct Knot {
    at: f32,
    color: Vec3,
}

/// The index of the last knot at or before `x`, by bisection.
#[kernel]
fn segment(knots: &[Knot], x: f32) -> Option<usize> {
    if knots.is_empty() || x < knots[0].at || x > knots[knots.len() - 1].at {
        return None;
    }
    let mut low = 0;
    let mut high = knots.len() - 1;
    while high - low > 1 {
        let middle = (low + high) / 2;
        if knots[middle].at <= x {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(low)
}

/// The colour at `x`, or `outside`.
#[kernel]
fn ramp(knots: &[Knot], outside: Vec3, x: f32) -> Vec3 {
    let Some(i) = segment(knots, x) else { return outside };
    let (a, b) = (knots[i], knots[(i + 1).min(knots.len() - 1)]);
    let t = (x - a.at) / max(b.at - a.at, 1e-6);
    a.color.lerp(b.color, t.clamp(0.0, 1.0))
}

#[test]
fn colours_lie_between_knots() {
    let knots: Vec<Knot> = [0.0, 0.1, 0.15, 0.7, 1.0]
        .iter()
        .map(|&at| Knot { at, color: vec3(at, 1.0 - at, at * at) })
        .collect();
    let outside = Vec3::NEG_ONE;
    let kernel = kernel!(|x: f32| ramp(&knots, outside, x));
    let xs: Vec<f32> = (0..500).map(|i| i as f32 * 0.003 - 0.2).collect();
    assert_variants_agree!(&kernel, &xs);
    assert_eq!(kernel.call((-0.1,)), outside);
    assert!((kernel.call((0.4,)).x - 0.4).abs() < 1e-6);
}
