//! Trees with leaves on uneven ground.

use std::f32::consts::TAU;

use raydsl::prelude::*;
use raydsl_tests::scenes::patch;

use super::{Scene, xorshift};

const TREES: u32 = 60;
const BRANCHES: u32 = 10;
/// Clusters of leaves along a branch, and leaves in each.
const CLUSTERS: u32 = 3;
const LEAVES: u32 = 80;
/// Clusters that grow on the ground.
const BUSHES: u32 = 400;
/// Half the width of the ground.
const HALF: f32 = 18.0;

/// A grove: ground, trunks, branches, and small leaves in clusters that face every way; about
/// 220,000 triangles. Rays pass close by many things that they do not meet.
pub fn grove() -> Scene<Triangle> {
    let mut unit = xorshift();
    let mut prims = Vec::new();
    patch(&mut prims, 96, 96, |u, v| ground(HALF * (2.0 * u - 1.0), HALF * (2.0 * v - 1.0)));
    for i in 0..TREES {
        // One in each cell of a grid, so that they stand apart.
        let (column, row) = (i % 10, i / 10);
        let x = HALF * ((column as f32 + unit()) / 5.0 - 1.0);
        let z = HALF * ((row as f32 + unit()) / 3.0 - 1.0);
        tree(&mut prims, ground(x, z), &mut unit);
    }
    for _ in 0..BUSHES {
        let foot = ground(HALF * (2.0 * unit() - 1.0), HALF * (2.0 * unit() - 1.0));
        cluster(&mut prims, foot + vec3(0.0, 0.4, 0.0), &mut unit);
    }
    let eye = ground(0.4, HALF - 2.0) + vec3(0.0, 1.7, 0.0);
    let camera = Pinhole::new(eye, vec3(-1.0, 2.2, 0.0), Vec3::Y, 1.05);
    Scene { prims, camera }
}

/// Hills of two sizes.
fn ground(x: f32, z: f32) -> Vec3 {
    let hills = 0.8 * (0.13 * x).sin() * (0.11 * z + 0.7).cos();
    vec3(x, hills + 0.12 * (1.3 * x + 0.4 * z).sin() * (1.1 * z - 0.3 * x).cos(), z)
}

fn tree(out: &mut Vec<Triangle>, foot: Vec3, unit: &mut impl FnMut() -> f32) {
    let height = 4.0 + 3.0 * unit();
    let lean = vec3(unit() - 0.5, 0.0, unit() - 0.5);
    let top = foot + vec3(0.0, height, 0.0) + lean;
    let thick = 0.04 * height;
    limb(out, (12, 6), foot - vec3(0.0, 0.3, 0.0), top, thick);
    for i in 0..BRANCHES {
        let share = 0.35 + 0.6 * (i as f32 + unit()) / BRANCHES as f32;
        let start = foot + (top - foot) * share;
        let (sin, cos) = (TAU * (0.381_966 * i as f32 + 0.1 * unit())).sin_cos();
        let reach = (1.2 - share) * (1.5 + unit());
        let end = start + vec3(reach * cos, 0.3 + 0.5 * unit(), reach * sin);
        limb(out, (5, 3), start, end, 0.35 * thick * (1.3 - share));
        for j in 1..=CLUSTERS {
            let middle = start + (end - start) * (0.4 + 0.2 * j as f32);
            cluster(out, middle, unit);
        }
    }
}

/// A cone without a tip between two points.
fn limb(out: &mut Vec<Triangle>, (nu, nv): (u32, u32), start: Vec3, end: Vec3, thick: f32) {
    let (x, y) = (end - start).normalize().any_orthonormal_pair();
    patch(out, nu, nv, |u, v| {
        let (sin, cos) = (TAU * u).sin_cos();
        start + (end - start) * v + (x * cos + y * sin) * (thick * (1.0 - 0.7 * v))
    });
}

/// Leaves at random places of a ball, denser towards its middle, each turned its own way.
fn cluster(out: &mut Vec<Triangle>, middle: Vec3, unit: &mut impl FnMut() -> f32) {
    for _ in 0..LEAVES {
        let mut about = || vec3(unit(), unit(), unit()) - 0.5;
        let at = middle + about() + 0.4 * about();
        let along = 0.16 * about().normalize_or(Vec3::X);
        let across = 0.05 * along.cross(about()).normalize_or(Vec3::Y);
        out.push(Triangle { v0: at - across, v1: at + across, v2: at + along });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grove_is_always_the_same() {
        let (a, b) = (grove().prims, grove().prims);
        assert!((150_000..250_000).contains(&a.len()), "{}", a.len());
        assert!(a == b && a.iter().all(|t| t.get_bounds().max.is_finite()));
    }
}
