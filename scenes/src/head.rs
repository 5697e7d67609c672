//! A head made in code, as a scanner would see it: skin, skull, a folded brain.
//!
//! Its functions are the library's, which are the same on every machine: so are the voxels.

use raydsl::prelude::*;
use rayon::prelude::*;

/// What the voxels are, from 0 for air; as those of a T1-weighted picture, but for a brighter skull.
mod tissue {
    pub(super) const SKIN: f32 = 80.0;
    pub(super) const SKULL: f32 = 215.0;
    pub(super) const FLUID: f32 = 25.0;
    pub(super) const GREY: f32 = 125.0;
    pub(super) const WHITE: f32 = 170.0;
}

/// Distance to an ellipsoid's surface, negative inside: exact near a sphere, of the right sign
/// elsewhere.
fn ellipsoid(p: Vec3, center: Vec3, radii: Vec3) -> f32 {
    let q = (p - center) / radii;
    let size = q.length();
    if size == 0.0 { -radii.min_element() } else { size * (size - 1.0) / (q / radii).length() }
}

/// Blends two distances, the nearer one first.
fn joined(a: f32, b: f32, width: f32) -> f32 {
    let h = (0.5 + 0.5 * (b - a) / width).clamp(0.0, 1.0);
    b + (a - b) * h - width * h * (1.0 - h)
}

/// Folds of the surface of a brain: waves whose places waves displace.
fn folds(p: Vec3) -> f32 {
    let q = p * 15.0;
    let warp = vec3(sin(q.y * 0.7) + cos(q.z), sin(q.z * 0.8 + 1.0), cos(q.x * 0.6 + 2.0));
    let q = q + warp * 1.6;
    let waves = sin(q.x) * cos(q.y) + sin(q.y) * cos(q.z) + sin(q.z) * cos(q.x);
    waves.abs().min(1.0)
}

/// What is at a point of the cube from -1 to 1: x to the left ear, y to the nose, z up.
fn value_at(p: Vec3, width: f32) -> f32 {
    let side = vec3(p.x.abs(), p.y, p.z);
    let skull_center = vec3(0.0, -0.08, 0.22);
    let cranium = ellipsoid(p, skull_center, vec3(0.62, 0.78, 0.66));
    let face = ellipsoid(p, vec3(0.0, 0.22, -0.3), vec3(0.44, 0.5, 0.55));
    let jaw = ellipsoid(p, vec3(0.0, 0.34, -0.66), vec3(0.3, 0.32, 0.2));
    let nose = ellipsoid(p, vec3(0.0, 0.77, -0.2), vec3(0.09, 0.14, 0.19));
    let ear = ellipsoid(side, vec3(0.63, -0.06, -0.04), vec3(0.06, 0.13, 0.2));
    let neck = (length(vec2(p.x / 0.36, (p.y + 0.12) / 0.38)) - 1.0) * 0.36;
    let neck = neck.max(p.z + 0.3);
    let head = joined(joined(cranium, face, 0.2), joined(jaw, neck, 0.2), 0.16);
    let lid = ellipsoid(side, vec3(0.2, 0.56, -0.02), Vec3::splat(0.1));
    let skin = joined(joined(joined(head, nose, 0.1), ear, 0.05), lid, 0.08);
    // The first of the layers from the inside out; their borders are as soft as a scanner's.
    let orbit = ellipsoid(side, vec3(0.2, 0.5, -0.02), Vec3::splat(0.12));
    let brain = ellipsoid(p, skull_center, vec3(0.5, 0.65, 0.52));
    let cleft = 0.022 + 0.03 * (p.z - 0.3).max(0.0) - p.x.abs();
    let groove = 0.05 * (1.0 - folds(p));
    let cortex = (brain + groove).max(if p.z > 0.1 { cleft } else { -1.0 });
    let white = brain + 0.09 + 1.6 * groove;
    let ventricle = ellipsoid(side, vec3(0.09, -0.05, 0.28), vec3(0.05, 0.24, 0.07));
    let cavity = brain - 0.03;
    let bone = joined(cranium, face, 0.2) + 0.07;
    let layers = [
        (ventricle, tissue::FLUID),
        (white, tissue::WHITE),
        (cortex, tissue::GREY),
        (cavity, tissue::FLUID),
        (orbit, tissue::GREY),
        (bone, tissue::SKULL),
        (skin, tissue::SKIN),
    ];
    let mut value = 0.0;
    for (distance, tissue) in layers.into_iter().rev() {
        let inside = (0.5 - distance / width).clamp(0.0, 1.0);
        value += (tissue - value) * inside;
    }
    value
}

/// Makes a head of `side`³ voxels in the cube from -1 to 1: x to the left ear, y to the nose, z up.
///
/// # Panics
///
/// If `side` is 0.
pub fn head(side: u32) -> Vec<u8> {
    head_part(side, UVec3::ZERO, UVec3::splat(side))
}

/// Makes a part of the voxels of [`head`]: `size` of them, from `first` on. It takes the memory of
/// the part.
///
/// # Panics
///
/// If `side` is 0.
pub fn head_part(side: u32, first: UVec3, size: UVec3) -> Vec<u8> {
    assert!(side > 0, "a head has voxels");
    let voxel = 2.0 / side as f32;
    let at = |i: u32| (i as f32 + 0.5) * voxel - 1.0;
    let row = size.x as usize;
    let mut voxels = vec![0; row * size.y as usize * size.z as usize];
    voxels.par_chunks_mut(row.max(1)).zip(0..size.y * size.z).for_each(|(voxels, i)| {
        let (y, z) = (at(first.y + i % size.y), at(first.z + i / size.y));
        for (value, x) in voxels.iter_mut().zip(first.x..) {
            *value = (value_at(vec3(at(x), y, z), 3.0 * voxel) + 0.5) as u8;
        }
    });
    voxels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_has_the_voxels_of_the_whole() {
        let (side, first, size) = (12, uvec3(2, 5, 0), uvec3(4, 6, 12));
        let (whole, part) = (head(side), head_part(side, first, size));
        let index = |p: UVec3, size: UVec3| ((p.z * size.y + p.y) * size.x + p.x) as usize;
        assert_eq!(part.len(), 4 * 6 * 12);
        for (x, y, z) in
            (0..4).flat_map(|x| (0..6).flat_map(move |y| (0..12).map(move |z| (x, y, z))))
        {
            let p = uvec3(x, y, z);
            assert_eq!(part[index(p, size)], whole[index(first + p, UVec3::splat(side))]);
        }
        assert!(part.iter().any(|v| *v != part[0]));
    }
}
