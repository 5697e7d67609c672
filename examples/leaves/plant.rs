//! A plant whose leaves are triangles with a mask: holes, slits and outline are in no mesh.

use std::f32::consts::{PI, TAU};

use raydsl::kernel;
use raydsl::prelude::*;

/// A triangle with texture coordinates.
#[primitive(triangle(v0, v1, v2))]
#[derive(Debug)]
pub(crate) struct Part {
    /// Its corners.
    pub(crate) v0: Vec3,
    /// Its corners.
    pub(crate) v1: Vec3,
    /// Its corners.
    pub(crate) v2: Vec3,
    /// Where they are on the leaf: along it from 0 to 1, and aside from -1 to 1.
    pub(crate) st: [Vec2; 3],
    /// 0 for a leaf, 1 for a stem, 2 for the pot.
    pub(crate) kind: u32,
}

// ANCHOR: st
#[kernel]
impl Part {
    /// Where on the leaf it was hit.
    pub(crate) fn st_at(&self, hit: Hit) -> Vec2 {
        let [a, b, c] = self.st;
        a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v
    }

    /// Whether there is something at a hit: all of a stem, and of a leaf what its mask leaves.
    pub(crate) fn is_there(&self, hit: Hit) -> bool {
        self.kind != 0 || mask(self.st_at(hit))
    }
}
// ANCHOR_END: st

/// 0 in the middle of a rib, 1 in the middle between two of them.
#[kernel]
pub(crate) fn between_ribs(st: Vec2) -> f32 {
    // Ribs leave the middle one, and bend towards the tip.
    let rib = (st.x - 0.34 * st.y.abs().sqrt() + 0.6) * 6.0;
    1.0 - (2.0 * (rib - rib.floor()) - 1.0).abs()
}

// ANCHOR: mask
/// Whether a leaf is there, at `st.x` along it and `st.y` aside: a heart with slits from its edge
/// and holes along its rib, as *Monstera deliciosa* has them.
#[kernel]
pub(crate) fn mask(st: Vec2) -> bool {
    let (along, aside) = (st.x, st.y.abs());
    let base = clamp((along + 0.02) / 0.3, 0.0, 1.0);
    let edge =
        0.97 * base.sqrt() * pow(clamp(1.0 - along, 0.0, 1.0), 0.62) + 0.1 * base * (1.0 - base);
    let share = aside / max(edge, 0.001);
    if share > 1.0 || along < 0.0 {
        return false;
    }
    let between = between_ribs(st);
    let slit = share > 0.5 && between > 0.78 - 0.2 * (share - 0.5) && along > 0.12 && along < 0.85;
    let hole = vec2((between - 1.0) * 0.5, (share - 0.25) * 2.2).length() < 0.2;
    !(slit || hole && along > 0.2 && along < 0.75)
}
// ANCHOR_END: mask

/// A surface over a grid of `m` by `n` squares of (u, v) in [0, 1]².
fn surface((m, n): (u32, u32), kind: u32, at: impl Fn(f32, f32) -> (Vec3, Vec2)) -> Vec<Part> {
    let corner = |i: u32, j: u32| at(i as f32 / m as f32, j as f32 / n as f32);
    let part = |a: (Vec3, Vec2), b: (Vec3, Vec2), c: (Vec3, Vec2)| Part {
        v0: a.0,
        v1: b.0,
        v2: c.0,
        st: [a.1, b.1, c.1],
        kind,
    };
    let square = |i, j| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [part(a, b, c), part(a, c, d)]
    };
    (0..n)
        .flat_map(|j| (0..m).flat_map(move |i| [(i, j)]))
        .flat_map(|(i, j)| square(i, j))
        .collect()
}

/// A leaf at the end of a stem from `root`: it points along `out`, and hangs.
fn leaf(root: Vec3, out: Vec3, reach: f32, size: f32) -> Vec<Part> {
    let level = vec3(out.x, 0.0, out.z).normalize();
    let base = root + out * reach;
    let bow = |s: f32| root + out * (reach * s) + Vec3::Y * (0.25 * reach * s * (1.0 - s)) * 1.6;
    let aside = level.cross(Vec3::Y);
    let mut all = surface((8, 12), 1, |u, v| {
        let (sin, cos) = (u * TAU).sin_cos();
        (bow(v) + (aside * cos + Vec3::Y.lerp(level, 0.4) * sin) * (0.02 - 0.006 * v), Vec2::ZERO)
    });
    let up = (Vec3::Y * 0.55 + level * 0.85).normalize();
    let along = up.cross(aside).normalize() * -1.0;
    all.extend(surface((14, 14), 0, |u, v| {
        let (s, t) = (u * 1.04 - 0.02, 2.0 * v - 1.0);
        let droop = -0.42 * s * s - 0.16 * t * t + 0.03 * (9.0 * s).sin() * t.abs();
        let place = along * (s - 0.12) + aside * (0.56 * t) + up * droop;
        (base + place * size, vec2(s, t))
    }));
    all
}

fn pot() -> Vec<Part> {
    let profile = [
        (0.0, 0.02),
        (0.3, 0.0),
        (0.42, 0.56),
        (0.46, 0.56),
        (0.46, 0.66),
        (0.41, 0.66),
        (0.39, 0.56),
        (0.0, 0.58),
    ];
    let count = profile.len() as u32 - 1;
    surface((48, count), 2, |u, v| {
        let (radius, y) = profile[(v * count as f32).round() as usize];
        let (sin, cos) = (u * TAU).sin_cos();
        (vec3(radius * cos, y, radius * sin), Vec2::ZERO)
    })
}

/// A plant in a pot, with this many leaves.
pub(crate) fn plant(leaves: u32) -> Vec<Part> {
    let golden_angle = PI * (3.0 - 5.0f32.sqrt());
    let mut all = pot();
    for i in 0..leaves {
        let share = (i as f32 + 0.5) / leaves as f32;
        let (sin, cos) = (i as f32 * golden_angle + 0.6).sin_cos();
        let rise = 0.75 + 1.9 * share;
        let out = vec3(cos, rise, sin).normalize();
        let root = vec3(0.08 * cos, 0.55, 0.08 * sin);
        all.extend(leaf(root, out, 0.7 + 0.85 * share, 1.1 - 0.25 * share));
    }
    all
}
