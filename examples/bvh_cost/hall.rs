//! A hall of columns: large triangles beside small ones, and long ones that lie across the axes.

use std::f32::consts::TAU;

use raydsl::prelude::*;

/// A surface over a grid of `m` by `n` squares of (u, v) in [0, 1]².
fn surface((m, n): (u32, u32), at: impl Fn(f32, f32) -> Vec3) -> Vec<Triangle> {
    let corner = |i: u32, j: u32| at(i as f32 / m as f32, j as f32 / n as f32);
    let square = |i: u32, j: u32| {
        let (v0, v2) = (corner(i, j), corner(i + 1, j + 1));
        [Triangle { v0, v1: corner(i + 1, j), v2 }, Triangle { v0, v1: v2, v2: corner(i, j + 1) }]
    };
    let squares = (0..n).flat_map(|j| (0..m).map(move |i| (i, j)));
    squares.flat_map(|(i, j)| square(i, j)).collect()
}

/// Something round around an axis upwards from `foot`, as wide at each height as `radius` says.
fn turned(
    foot: Vec3,
    height: f32,
    patches: (u32, u32),
    radius: impl Fn(f32, f32) -> f32,
) -> Vec<Triangle> {
    surface(patches, |u, v| {
        let (sin, cos) = (u * TAU).sin_cos();
        let r = radius(u, v);
        foot + vec3(r * cos, v * height, r * sin)
    })
}

/// A bar with a square section from `a` to `b`.
fn bar(a: Vec3, b: Vec3, wide: f32) -> Vec<Triangle> {
    let (x, y) = (b - a).normalize().any_orthonormal_pair();
    surface((4, 1), |u, v| {
        let (sin, cos) = ((u + 0.125) * TAU).sin_cos();
        a.lerp(b, v) + (x * cos + y * sin) * wide
    })
}

/// Two rows of fluted columns under beams, a knobbly ball on a base, and ropes across.
pub(crate) fn hall() -> Vec<Triangle> {
    let mut all = surface((1, 1), |u, v| vec3(24.0 * u - 12.0, 0.0, 10.0 * v - 5.0));
    all.extend(surface((1, 1), |u, v| vec3(24.0 * u - 12.0, 5.2, 10.0 * v - 5.0)));
    all.extend(surface((1, 1), |u, v| vec3(24.0 * u - 12.0, 5.2 * v, -5.0)));
    let flutes = |u: f32, v: f32| {
        let bulge = 1.0 - 0.2 * v + 0.5 * (-30.0 * v).exp() + 0.5 * (-30.0 * (1.0 - v)).exp();
        0.34 * bulge * (1.0 + 0.05 * (16.0 * u * TAU).cos())
    };
    for (i, side) in (0..8).flat_map(|i| [(i, -2.6), (i, 2.6)]) {
        let foot = vec3(2.8 * (i as f32 - 3.5), 0.0, side);
        all.extend(turned(foot, 5.0, (64, 14), flutes));
    }
    for side in [-2.6, 2.6] {
        all.extend(bar(vec3(-11.0, 5.0, side), vec3(11.0, 5.0, side), 0.3));
    }
    // Long and thin, and not along an axis: what boxes are bad at.
    for i in 0..14 {
        let x = 1.4 * (i as f32 - 6.5);
        let (low, high) = (vec3(x - 2.0, 0.0, -2.6), vec3(x + 2.0, 4.9, 2.6));
        let side = if i % 2 == 0 { Vec3::ONE } else { vec3(1.0, 1.0, -1.0) };
        all.extend(bar(low * side, high * side, 0.02));
    }
    all.extend(turned(vec3(0.0, 0.0, 0.0), 1.0, (24, 1), |_, _| 0.7));
    all.extend(surface((160, 80), |u, v| {
        let ((s, c), (sv, cv)) = ((u * TAU).sin_cos(), (v * TAU / 2.0).sin_cos());
        let out = vec3(sv * c, -cv, sv * s);
        vec3(0.0, 1.75, 0.0) + out * (0.75 + 0.06 * (9.0 * out.x).sin() * (9.0 * out.y).sin())
    }));
    all
}
