//! Tone curves, of several kinds, in a row. (enum with fields, closure, option, early return)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

#[derive(Clone, Copy, Type)]
enum Curve {
    Gain(f32),
    Gamma { exponent: f32 },
    Shoulder { knee: f32, white: f32 },
}

#[kernel]
fn applied(curve: Curve, x: f32) -> Option<f32> {
    if !x.is_finite() || x < 0.0 {
        return None;
    }
    let y = match curve {
        Curve::Gain(gain) => x * gain,
        Curve::Gamma { exponent } => pow(x, exponent),
        Curve::Shoulder { knee, white } => {
            if x <= knee {
                x
            } else {
                let t = (x - knee) / (white - knee);
                knee + (1.0 - knee) * t / (1.0 + t)
            }
        }
    };
    Some(y)
}

#[kernel]
fn each(f: impl Fn(f32) -> f32, v: Vec3) -> Vec3 {
    vec3(f(v.x), f(v.y), f(v.z))
}

#[kernel]
fn graded(curves: &[Curve], color: Vec3) -> Vec3 {
    let mut color = color;
    for curve in curves.iter().rev() {
        color = each(|x| applied(*curve, x).unwrap_or(0.0), color);
    }
    color
}

#[test]
fn curves_follow_each_other() {
    let curves = vec![
        Curve::Shoulder { knee: 0.6, white: 4.0 },
        Curve::Gamma { exponent: 0.8 },
        Curve::Gain(1.5),
    ];
    let kernel = kernel!(|color: Vec3| graded(&curves, color));
    let colors: Vec<Vec3> = (0..216)
        .map(|i| vec3((i % 6) as f32 - 0.5, (i / 6 % 6) as f32 * 0.5, (i / 36) as f32 * 0.2))
        .collect();
    assert_variants_agree!(&kernel, &colors);
    assert_eq!(kernel.call((Vec3::ZERO,)), Vec3::ZERO);
    assert!(kernel.call((Vec3::splat(3.0),)).max_element() < 1.0);
}
