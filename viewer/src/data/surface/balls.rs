//! Two balls that show an environment: a mirror, and a white one.

use core::f32::consts::{PI, TAU};

use glam::Affine3A;
use raydsl::prelude::*;
use raydsl_io::scene::{Instance, Material, Scene, SceneMesh};

/// Parts around a ball, and from pole to pole.
const PARTS: (u32, u32) = (192, 96);

/// Returns both balls, beside each other.
pub(super) fn balls() -> Scene {
    let white = Vec3::splat(0.8).extend(1.0);
    let material = |name: &str, metallic, roughness| Material {
        name: name.to_owned(),
        base_color: white,
        metallic,
        roughness,
        ..Default::default()
    };
    let rough = Material { specular: 0.0, ..material("white", 0.0, 1.0) };
    let place = |mesh: usize, x: f32| Instance {
        name: String::new(),
        mesh,
        transform: Affine3A::from_translation(vec3(x, 0.0, 0.0)),
    };
    Scene {
        meshes: vec![ball(0), ball(1)],
        materials: vec![material("mirror", 1.0, 0.0), rough],
        instances: vec![place(0, -1.1), place(1, 1.1)],
        ..Default::default()
    }
}

/// A ball of radius 1, by latitudes and longitudes.
fn ball(material: usize) -> SceneMesh {
    let (around, down) = PARTS;
    let at = |i: u32, j: u32| {
        let (sin, cos) = (i as f32 / around as f32 * TAU).sin_cos();
        let (radius, height) = (j as f32 / down as f32 * PI).sin_cos();
        vec3(radius * cos, height, -radius * sin)
    };
    let positions: Vec<Vec3> =
        (0..=down).flat_map(|j| (0..around).map(move |i| at(i, j))).collect();
    let index = |i: u32, j: u32| i % around + j * around;
    let square = |i: u32, j: u32| {
        let [a, b, c, d] = [index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i + 1, j)];
        [[a, b, c], [a, c, d]]
    };
    let triangles = (0..down).flat_map(|j| (0..around).flat_map(move |i| square(i, j)));
    let normals = positions.clone();
    SceneMesh { triangles: triangles.collect(), positions, normals, material, ..Default::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn balls_are_round_and_seen_from_outside() {
        let mesh = ball(0);
        assert!(mesh.positions.iter().all(|p| (p.length() - 1.0).abs() < 1e-6));
        let mut volume = 0.0f64;
        for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|i| mesh.positions[i as usize])) {
            volume += f64::from(a.dot(b.cross(c))) / 6.0;
        }
        let ball = 4.0 / 3.0 * std::f64::consts::PI;
        assert!((volume / ball - 1.0).abs() < 2e-3, "{volume}");
    }
}
