//! Rays at the seams of closed meshes, which must not pass.

use raydsl::prelude::*;

use super::mesh::Icosphere;
use crate::rng::Rng;

/// Where meshes stand and how large they are.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// In words.
    pub name: &'static str,
    /// The middle.
    pub center: Vec3,
    /// The distance of the vertices from it.
    pub radius: f32,
}

const fn place(name: &'static str, center: Vec3, radius: f32) -> Place {
    Place { name, center, radius }
}

/// Around the world's origin at every scale, and where their coordinates are large against them.
/// The last position is that of the watertightness tests of Embree.
pub const PLACES: [Place; 13] = [
    place("radius 1e-15", Vec3::ZERO, 1e-15),
    place("radius 1e-10", Vec3::ZERO, 1e-10),
    place("radius 1e-5", Vec3::ZERO, 1e-5),
    place("radius 1", Vec3::ZERO, 1.0),
    place("radius 1e5", Vec3::ZERO, 1e5),
    place("radius 1e10", Vec3::ZERO, 1e10),
    place("radius 1e15", Vec3::ZERO, 1e15),
    place("radius 1e-5 at 1e-3", vec3(1e-3, -1e-3, 1e-3), 1e-5),
    place("radius 1 at 100", vec3(100.0, 70.0, -30.0), 1.0),
    place("radius 1 at 1000", vec3(-1000.0, 1000.0, 300.0), 1.0),
    place("radius 1e4 at 1e7", vec3(1e7, -4e6, 7e6), 1e4),
    place("radius 2 at 223,423", EMBREE, 2.0),
    place("radius 1000 at 223,423", EMBREE, 1000.0),
];

const EMBREE: Vec3 = vec3(148_376.0, 1234.0, -223_423.0);

/// A ray that must hit: from inside, or from outside where the mesh faces it.
pub fn ray(mesh: &Icosphere, rng: &mut Rng) -> Ray {
    let (target, normal) = mesh.seam(rng);
    let origin = if rng.below(2) == 0 {
        mesh.inside(rng)
    } else {
        let far = mesh.radius * rng.pick(&[0.1, 1.0, 10.0, 100.0]);
        let way = (rng.direction() * 0.5 + normal).normalize();
        target + way * far
    };
    let d = target - origin;
    match rng.below(4) {
        0 => Ray::new(origin, d),
        1 => Ray::new(origin, d * rng.pick(&[1e-3, 1e3])),
        _ => Ray::new(origin, unit(d)),
    }
}

/// `d` with unit length, at every scale.
fn unit(d: Vec3) -> Vec3 {
    (d / d.abs().max_element()).normalize()
}
