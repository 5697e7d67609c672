//! What is rasterised: a table, and a ring around the plant.

use std::f32::consts::TAU;

use raydsl::prelude::*;
use raydsl_examples::rasterizer::Corner;

/// Half of the table's side, and squares along it.
const TABLE: (f32, u32) = (2.4, 24);
/// Radius of the ring and of its tube, its height, and how it is tilted.
const RING: (f32, f32) = (1.05, 0.09);
const HEIGHT: f32 = 1.25;
const TILT: f32 = 0.35;

/// Triangles with the lamp's light in their corners; shadows are not in it.
pub(crate) fn triangles(lamp: Vec3) -> Vec<[Corner; 3]> {
    table(lamp).chain(ring(lamp)).collect()
}

fn lit(place: Vec3, normal: Vec3, paint: Vec3, lamp: Vec3) -> Corner {
    let way = lamp - place;
    let facing = normal.dot(way.normalize()).max(0.0);
    let light = 0.32 + 19.0 / way.length_squared() * facing;
    Corner { place, color: paint * light }
}

fn square([a, b, c, d]: [Corner; 4]) -> [[Corner; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

fn table(lamp: Vec3) -> impl Iterator<Item = [Corner; 3]> {
    let (half, count) = TABLE;
    let step = 2.0 * half / count as f32;
    let squares = (0..count).flat_map(move |j| (0..count).map(move |i| (i, j)));
    squares.flat_map(move |(i, j)| {
        let is_dark = (i / 2 + j / 2).is_multiple_of(2);
        let paint = if is_dark { vec3(0.26, 0.17, 0.11) } else { vec3(0.62, 0.47, 0.31) };
        let at = |i: u32, j: u32| {
            let place = vec3(i as f32 * step - half, 0.0, half - j as f32 * step);
            lit(place, Vec3::Y, paint, lamp)
        };
        square([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
    })
}

fn ring(lamp: Vec3) -> impl Iterator<Item = [Corner; 3]> {
    let (around, across) = (96u32, 16u32);
    let tilt = Mat3::from_rotation_x(TILT);
    let at = move |i: u32, j: u32| {
        let (sin, cos) = (i as f32 / around as f32 * TAU).sin_cos();
        let (aside, above) = (j as f32 / across as f32 * TAU).sin_cos();
        let out = vec3(cos, 0.0, sin);
        let normal = out * above + Vec3::Y * aside;
        let place = out * RING.0 + normal * RING.1;
        let paint =
            if (i / 6).is_multiple_of(2) { vec3(0.8, 0.62, 0.2) } else { vec3(0.7, 0.2, 0.12) };
        lit(tilt * place + Vec3::Y * HEIGHT, tilt * normal, paint, lamp)
    };
    (0..around).flat_map(move |i| {
        (0..across)
            .flat_map(move |j| square([at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]))
    })
}
