//! A grid that is made in code: hexahedra around a cylinder, and a field of two ropes.

use core::f32::consts::{PI, TAU};

use raydsl::prelude::*;
use raydsl_io::cells::{CellArray, CellFile, CellKind};

/// Radii of the grid, and half of its height.
const INNER: f32 = 0.55;
const OUTER: f32 = 1.9;
const HALF: f32 = 1.9;

/// Returns an O-grid of this many cells along the cylinder, and in proportion around it and away from
/// it, where layers are thinner near the cylinder.
pub fn ropes(along: u32) -> CellFile {
    let along = along.max(4);
    let (around, away) = (along * 3 / 2, along * 3 / 8);
    let mut file = CellFile::default();
    let mut values = Vec::new();
    for i in 0..around * (away + 1) * (along + 1) {
        let (turn, rest) = (i % around, i / around);
        let (layer, level) = (rest % (away + 1), rest / (away + 1));
        let angle = turn as f32 / around as f32 * TAU;
        let share = layer as f32 / away as f32;
        let radius = INNER + (OUTER - INNER) * (0.6 * share + 0.4 * share * share);
        let height = (level as f32 / along as f32 * 2.0 - 1.0) * HALF;
        file.points.push(vec3(radius * angle.cos(), radius * angle.sin(), height));
        values.push(field(radius, angle, height));
    }
    let index =
        |turn: u32, layer: u32, level: u32| turn % around + around * (layer + (away + 1) * level);
    for i in 0..around * away * along {
        let (turn, rest) = (i % around, i / around);
        let (layer, level) = (rest % away, rest / away);
        for z in [level, level + 1] {
            let ring = [(0, 0), (0, 1), (1, 1), (1, 0)];
            file.vertices.extend(ring.map(|(t, l)| index(turn + t, layer + l, z)));
        }
        file.kinds.push(CellKind::Hexahedron);
    }
    file.point_arrays.push(CellArray { name: "ropes".into(), components: 1, values });
    file
}

/// Two ropes that wind around the cylinder, and a warm skin on it.
fn field(radius: f32, angle: f32, height: f32) -> f32 {
    let rope = |phase: f32, at: f32, wide: f32| {
        let mut turn = (angle - 1.5 * height - phase).rem_euclid(TAU);
        if turn > PI {
            turn -= TAU;
        }
        let (out, side) = (radius - at, turn * at * 0.55);
        (-(out * out + side * side) / (wide * wide)).exp()
    };
    let skin = 0.5 * (-(radius - INNER) * 6.0).exp() * (1.0 + 0.3 * (6.0 * angle).cos());
    (rope(0.0, 1.2, 0.4) + 0.85 * rope(PI, 1.3, 0.3) + skin).min(1.0)
}
