//! A ball of fur.

use raydsl::prelude::*;

use super::shape::Hair;

/// Three numbers from 0 to 1 that look random.
fn noise(i: u32) -> Vec3 {
    let mut state = i.wrapping_mul(0x9E37_79B9) ^ 0x85EB_CA6B;
    let mut next = || {
        state = (state ^ state >> 16).wrapping_mul(0x7FEB_352D);
        state = (state ^ state >> 15).wrapping_mul(0x846C_A68B);
        (state >> 8) as f32 / 16_777_216.0
    };
    vec3(next(), next(), next())
}

/// Hairs evenly over a ball of radius 1: they leave it straight, and fall around its poles.
pub(crate) fn fur(count: u32) -> Vec<Hair> {
    let golden_angle = std::f32::consts::PI * (3.0 - 5.0f32.sqrt());
    let hair = |i: u32| {
        let random = noise(i);
        let y = 1.0 - 2.0 * (i as f32 + 0.5) / count as f32;
        let (sin, cos) = (i as f32 * golden_angle).sin_cos();
        let aside = (1.0 - y * y).sqrt();
        let up = vec3(aside * cos, y, aside * sin);
        let whirl = up.cross(vec3(0.35, 0.9, 0.25)) + 0.3 * (random - 0.5);
        let wave = (5.0 * up.x + 3.0 * (4.0 * up.y).sin()).sin();
        let combed = whirl * (0.7 + 0.5 * wave) - Vec3::Y * 0.5;
        let long = 0.13 * (0.75 + 0.5 * random.x);
        let p1 = up + up * long;
        let p2 = p1 + (up * 0.5 + combed * 0.8) * long;
        let p3 = p2 + (up * 0.1 + combed * 1.3 + 0.5 * (random - 0.5)) * long;
        Hair { control: [up * 0.99, p1, p2, p3], root: 0.0045, tip: 0.0008 }
    };
    (0..count).map(hair).collect()
}
