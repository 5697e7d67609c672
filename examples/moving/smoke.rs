//! A plume of smoke, at steps in time: fields made in code that begin anew after the last.

use std::f32::consts::TAU;

use raydsl::prelude::*;
use raydsl::volume::{Grid, GridConfig, GridError, TransferError, TransferFunction};
use rayon::prelude::*;

/// Steps in time, after which the plume is what it was.
pub(crate) const STEPS: usize = 16;

/// Voxels along each axis.
const SIZE: UVec3 = uvec3(64, 80, 64);

/// Distance between two voxels.
const SPACING: f32 = 1.0 / 32.0;

/// Where the plume rises.
const FOOT: f32 = -0.8;

/// Cells of noise after which it repeats, upwards: as far as smoke rises in all steps.
const PERIOD: i32 = 4;

/// The voxels of all steps.
pub(crate) fn steps() -> Vec<Vec<u8>> {
    let step = |i: usize| {
        let phase = i as f32 / STEPS as f32;
        let voxel = |i: u32| {
            let at = uvec3(i % SIZE.x, i / SIZE.x % SIZE.y, i / (SIZE.x * SIZE.y));
            (density(corner() + at.as_vec3() * SPACING, phase) * 255.0) as u8
        };
        (0..SIZE.element_product()).into_par_iter().map(voxel).collect()
    };
    (0..STEPS).map(step).collect()
}

/// The first voxel.
fn corner() -> Vec3 {
    let half = (SIZE - 1).as_vec3() * (0.5 * SPACING);
    vec3(-half.x, FOOT, -half.z)
}

/// A grid over the voxels of one step.
pub(crate) fn grid(voxels: &[u8]) -> Result<Grid<'_, u8>, GridError> {
    let config = GridConfig::new().spacing(Vec3::splat(SPACING)).origin(corner());
    Grid::new(voxels, SIZE, config.rescale(1.0 / 255.0, 0.0))
}

/// Thin smoke is cold, what is dense glows.
pub(crate) fn function() -> Result<TransferFunction, TransferError> {
    let colors = [
        (0.0, vec3(0.30, 0.33, 0.40)),
        (0.35, vec3(0.42, 0.38, 0.40)),
        (0.55, vec3(0.75, 0.32, 0.14)),
        (0.75, vec3(1.2, 0.62, 0.16)),
        (1.0, vec3(1.5, 1.2, 0.6)),
    ];
    let knots = [(0.05, 0.0), (0.3, 2.5), (0.6, 9.0), (1.0, 22.0)];
    TransferFunction::from_extinction(&colors, &knots)
}

/// Density from 0 to 1 at a point, with `phase` from 0 to 1 around the loop.
fn density(p: Vec3, phase: f32) -> f32 {
    let height = (p.y - FOOT) / (SIZE.y as f32 * SPACING);
    let sway = TAU * (height * 0.9 - phase);
    let axis = vec2(sway.cos(), sway.sin()) * (0.22 * height);
    let aside = (vec2(p.x, p.z) - axis).length() / (0.3 + 0.75 * height.sqrt());
    // Smoke rises by the period of the noise in a loop.
    let rise = vec3(p.x, p.y, p.z) * 2.2 - vec3(0.0, phase * PERIOD as f32, 0.0);
    let billows = noise(rise, PERIOD)
        + 0.5 * noise(rise * 2.0 + 7.3, 2 * PERIOD)
        + 0.25 * noise(rise * 4.0 + 1.9, 4 * PERIOD);
    let ends = (height * 7.0).min((1.0 - height) * 2.6).clamp(0.0, 1.0);
    let inside = 1.15 - 1.25 * aside + 1.1 * billows - 0.45 * height;
    inside.clamp(0.0, 1.0) * ends
}

/// Gradient noise from about -0.7 to 0.7, of cells of size 1, that repeats upwards.
fn noise(p: Vec3, period: i32) -> f32 {
    let cell = p.floor();
    let place = p - cell;
    let fade = place * place * place * (place * (place * 6.0 - 15.0) + 10.0);
    let corner = |i: u32| {
        let side = uvec3(i & 1, i >> 1 & 1, i >> 2);
        let at = cell.as_ivec3() + side.as_ivec3();
        let slope = slope(at.x, at.y.rem_euclid(period), at.z);
        let weights = Vec3::select(side.cmpeq(UVec3::ONE), fade, 1.0 - fade);
        slope.dot(place - side.as_vec3()) * weights.element_product()
    };
    (0..8).map(corner).sum()
}

/// A direction for each corner of a cell. (PCG3D; Jarzynski and Olano, "Hash Functions for GPU
/// Rendering", 2020.)
fn slope(x: i32, y: i32, z: i32) -> Vec3 {
    let mut v = [x, y, z].map(|n| (n as u32).wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    for _ in 0..2 {
        for i in 0..3 {
            v[i] = v[i].wrapping_add(v[(i + 1) % 3].wrapping_mul(v[(i + 2) % 3]));
        }
        v = v.map(|n| n ^ n >> 16);
    }
    let unit = v.map(|n| (n >> 8) as f32 / 8_388_608.0 - 1.0);
    Vec3::from(unit).normalize_or(Vec3::X)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plume_begins_anew() {
        for i in 0..200 {
            let p = corner() + vec3((i % 7) as f32, (i % 11) as f32, (i % 5) as f32) * 0.3;
            let (first, last) = (density(p, 0.0), density(p, 1.0));
            assert!((first - last).abs() < 1e-3, "{p}: {first} and {last}");
        }
    }
}
