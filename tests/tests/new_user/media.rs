//! The light that comes through clear, even and layered media. (enum with fields, closure, bare
//! integers, early return)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

/// What fills a space.
#[derive(Clone, Copy, Type)]
enum Medium {
    Clear,
    Even { extinction: f32 },
    Layered { ground: f32, height: f32 },
}

#[kernel]
impl Medium {
    fn extinction(&self, p: Vec3) -> f32 {
        match *self {
            Medium::Clear => 0.0,
            Medium::Even { extinction } => extinction,
            Medium::Layered { ground, height } => ground * exp(-p.y / height),
        }
    }
}

/// The integral of `f` from `a` to `b` by Simpson's rule.
#[kernel]
fn simpson(f: impl Fn(f32) -> f32, a: f32, b: f32) -> f32 {
    let h = (b - a) / 8.0;
    let mut sum = f(a) + f(b);
    for i in 1..8 {
        let weight = if i % 2 == 1 { 4.0 } else { 2.0 };
        sum += weight * f(a + i as f32 * h);
    }
    sum * h / 3.0
}

/// The share of light that passes.
#[kernel]
fn transmittance(medium: Medium, from: Vec3, to: Vec3) -> f32 {
    let way = to - from;
    let length = way.length();
    if length == 0.0 {
        return 1.0;
    }
    let optical = simpson(|t| medium.extinction(from + way * (t / length)), 0.0, length);
    exp(-optical)
}

#[test]
fn light_passes_media() {
    let media = [
        Medium::Clear,
        Medium::Even { extinction: 0.5 },
        Medium::Layered { ground: 1.0, height: 2.0 },
    ];
    let media = &media[..];
    let kernel = kernel!(|which: u32, from: Vec3, to: Vec3| {
        transmittance(media[which as usize], from, to)
    });
    let inputs: Vec<(u32, Vec3, Vec3)> = (0..200)
        .map(|i| (i % 3, vec3(i as f32 * 0.01, 0.5, 0.0), vec3(1.0, 0.02 * i as f32, 2.0)))
        .collect();
    assert_variants_agree!(&kernel, &inputs);
    assert_eq!(kernel.call((0, Vec3::ZERO, Vec3::ONE)), 1.0);
    let even = kernel.call((1, Vec3::ZERO, vec3(0.0, 0.0, 2.0)));
    assert!((even - (-1.0f32).exp()).abs() < 1e-5);
}
