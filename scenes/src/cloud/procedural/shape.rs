//! Surfaces that points are spread over.

use std::f64::consts::TAU;

use super::noise::{noise3, unit};

/// A vector or a place.
pub(super) type V3 = [f64; 3];

pub(super) fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn times(a: V3, k: f64) -> V3 {
    a.map(|c| c * k)
}

pub(super) fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn length(a: V3) -> f64 {
    dot(a, a).sqrt()
}

pub(super) fn normalize(a: V3) -> V3 {
    times(a, 1.0 / length(a).max(1e-12))
}

/// A surface with a known area.
#[derive(Clone, Copy)]
pub(super) enum Shape {
    /// A square of ground, its lowest corner and side. The height comes from the terrain.
    Ground { corner: [f64; 2], side: f64 },
    /// The parallelogram `origin + a*u + b*v`; its normal is `u × v`.
    Quad { origin: V3, u: V3, v: V3 },
    /// Half of that parallelogram, `a + b <= 1`.
    Triangle { origin: V3, u: V3, v: V3 },
    /// An upright tube; `taper` is the top's radius over the base's (0 is a cone).
    Tube { base: V3, radius: f64, height: f64, taper: f64 },
    /// A lumpy ellipsoid of leaves.
    Crown { center: V3, radii: V3 },
    /// A conifer's foliage: a cone in drooping tiers.
    Tiers { base: V3, radius: f64, height: f64 },
}

/// A point of a surface.
pub(super) struct Spot {
    pub(super) position: V3,
    pub(super) normal: V3,
    /// Metres along and up the surface for walls and roofs; for foliage, the height within
    /// the crown (0 to 1) and how far out the point lies (about 0 to 1).
    pub(super) local: [f64; 2],
}

impl Shape {
    /// The area in square metres. Ground is estimated by its caller, who knows its slope.
    pub(super) fn area(&self) -> f64 {
        match *self {
            Shape::Ground { side, .. } => side * side,
            Shape::Quad { u, v, .. } => length(cross(u, v)),
            Shape::Triangle { u, v, .. } => 0.5 * length(cross(u, v)),
            Shape::Tube { radius, height, taper, .. } => {
                let slant = height.hypot(radius * (1.0 - taper));
                0.5 * TAU * radius * (1.0 + taper) * slant
            }
            Shape::Crown { radii: [a, b, c], .. } => {
                // Thomsen's formula, within 1.1 %.
                let p = 1.6075;
                let sum = (a * b).powf(p) + (a * c).powf(p) + (b * c).powf(p);
                2.0 * TAU * (sum / 3.0).powf(1.0 / p)
            }
            Shape::Tiers { radius, height, .. } => 0.6 * TAU * radius * height.hypot(radius),
        }
    }

    /// The point at (`a`, `b`) of the unit square; equal areas there are equal areas here.
    pub(super) fn spot(&self, a: f64, b: f64, seed: u64) -> Spot {
        match *self {
            Shape::Ground { corner, side } => Spot {
                position: [corner[0] + a * side, corner[1] + b * side, 0.0],
                normal: [0.0, 0.0, 1.0],
                local: [0.0; 2],
            },
            Shape::Quad { origin, u, v } => flat(origin, u, v, a, b),
            Shape::Triangle { origin, u, v } if a + b > 1.0 => flat(origin, u, v, 1.0 - a, 1.0 - b),
            Shape::Triangle { origin, u, v } => flat(origin, u, v, a, b),
            Shape::Tube { base, radius, height, taper } => tube(base, radius, height, taper, a, b),
            Shape::Crown { center, radii } => crown(center, radii, a, b, seed),
            Shape::Tiers { base, radius, height } => tiers(base, radius, height, a, b, seed),
        }
    }
}

fn flat(origin: V3, u: V3, v: V3, a: f64, b: f64) -> Spot {
    Spot {
        position: add(origin, add(times(u, a), times(v, b))),
        normal: normalize(cross(u, v)),
        local: [a * length(u), b * length(v)],
    }
}

/// The height fraction at which a share `b` of a tapered tube's area lies below.
fn tapered_height(b: f64, taper: f64) -> f64 {
    if (1.0 - taper).abs() < 1e-6 {
        return b;
    }
    let full = 1.0 - taper * taper;
    (1.0 - (1.0 - b * full).sqrt()) / (1.0 - taper)
}

fn tube(base: V3, radius: f64, height: f64, taper: f64, a: f64, b: f64) -> Spot {
    let h = tapered_height(b, taper);
    let (sin, cos) = (a * TAU).sin_cos();
    let r = radius * (1.0 - h * (1.0 - taper));
    Spot {
        position: add(base, [r * cos, r * sin, h * height]),
        normal: normalize([cos * height, sin * height, radius * (1.0 - taper)]),
        local: [a * TAU * radius, h * height],
    }
}

fn crown(center: V3, radii: V3, a: f64, b: f64, seed: u64) -> Spot {
    let z = 1.0 - 2.0 * a;
    let (sin, cos) = (b * TAU).sin_cos();
    let ring = (1.0 - z * z).max(0.0).sqrt();
    let out = [ring * cos, ring * sin, z];
    let surface = [out[0] * radii[0], out[1] * radii[1], out[2] * radii[2]];
    let lump = noise3(seed, times(add(center, surface), 0.9));
    let leaf = unit(seed, (a.to_bits() ^ b.to_bits().rotate_left(32)) | 1);
    let grow = 0.9 + 0.2 * lump + 0.12 * (leaf - 0.5);
    Spot {
        position: add(center, times(surface, grow)),
        normal: normalize([out[0] / radii[0], out[1] / radii[1], out[2] / radii[2]]),
        local: [0.5 + 0.5 * z, 0.5 + 0.5 * lump],
    }
}

fn tiers(base: V3, radius: f64, height: f64, a: f64, b: f64, seed: u64) -> Spot {
    let h = tapered_height(b, 0.0);
    let count = (height * 0.9).floor().max(4.0);
    // Within a tier the branches reach out furthest at its lower edge.
    let tier = h * count;
    let reach = 1.0 - (tier - tier.floor());
    let (sin, cos) = (a * TAU).sin_cos();
    let leaf = unit(seed, (a.to_bits() ^ b.to_bits().rotate_left(32)) | 1);
    let lobes = noise3(seed, [cos * 2.2, sin * 2.2, tier.floor()]);
    let r = radius * (1.0 - h) * (0.62 + 0.42 * reach + 0.2 * lobes) * (0.85 + 0.2 * leaf);
    Spot {
        position: add(base, [r * cos, r * sin, h * height - 0.25 * reach * (1.0 - h)]),
        normal: normalize([cos, sin, 0.35 + 0.3 * (1.0 - reach)]),
        local: [h, (0.25 + 0.75 * reach) * (0.75 + 0.35 * lobes)],
    }
}
