//! A ribbon of triangles, and bubbles around it.

use std::f32::consts::TAU;

use raydsl::prelude::*;
use raydsl_examples::rasterizer::Corner;

#[primitive(sphere(center, radius))]
pub(crate) struct Bubble {
    pub(crate) center: Vec3,
    pub(crate) radius: f32,
    pub(crate) color: Vec3,
}

/// Bubbles along a knot's hollows.
pub(crate) fn bubbles() -> Vec<Bubble> {
    let bubble = |i: u32| {
        let t = i as f32 / 28.0 * TAU;
        let center = knot(t * 2.0 + 0.35) * (0.62 + 0.3 * (5.0 * t).sin());
        let color = 0.5 + 0.45 * vec3(t.sin(), (t + 2.1).sin(), (t + 4.2).sin());
        Bubble { center, radius: 0.34 + 0.16 * (3.0 * t).cos(), color }
    };
    (0..28).map(bubble).collect()
}

/// A knot around a torus: twice around the axis, three times around the ring.
fn knot(t: f32) -> Vec3 {
    let ring = 2.0 + 0.8 * (1.5 * t).cos();
    vec3(ring * t.cos(), 0.8 * (1.5 * t).sin(), ring * t.sin())
}

/// A ribbon along the knot, of two triangles for each step, lit from above.
pub(crate) fn ribbon() -> Vec<[Corner; 3]> {
    let corner = |i: u32, side: f32| {
        let t = i as f32 / 600.0 * 2.0 * TAU;
        let along = (knot(t + 0.01) - knot(t - 0.01)).normalize();
        let across = along.cross(vec3(t.cos() * (1.5 * t).cos(), (1.5 * t).sin(), t.sin()));
        let across = across.normalize();
        let light = 0.35 + 0.6 * across.cross(along).y.abs();
        let stripe =
            if (i / 10).is_multiple_of(2) { vec3(0.95, 0.85, 0.6) } else { vec3(0.55, 0.3, 0.2) };
        Corner { place: knot(t) + across * (0.3 * side), color: stripe * light }
    };
    let step = |i: u32| {
        let [a, b] = [-1.0, 1.0].map(|side| corner(i, side));
        let [c, d] = [-1.0, 1.0].map(|side| corner(i + 1, side));
        [[a, b, c], [c, b, d]]
    };
    (0..600).flat_map(step).collect()
}
