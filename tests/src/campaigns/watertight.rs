//! Rays at the seams of closed meshes: none passes.

use raydsl::bvh::BuildError;
use raydsl::prelude::*;

use super::mesh::Icosphere;
use super::{Asked, TEXTBOOK, Tally};
use crate::rng::Rng;

/// Where meshes stand and how large they are.
pub struct Place {
    /// For the table.
    pub name: &'static str,
    center: Vec3,
    radius: f32,
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
fn ray(mesh: &Icosphere, rng: &mut Rng) -> Ray {
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

/// The test of Möller and Trumbore ("Fast, Minimum Storage Ray/Triangle Intersection", 1997), as it
/// stands in textbooks.
fn textbook(ray: &Ray, t: &Triangle) -> bool {
    let (e1, e2) = (t.v1 - t.v0, t.v2 - t.v0);
    let across = ray.direction.cross(e2);
    let inverse = 1.0 / e1.dot(across);
    let from_v0 = ray.origin - t.v0;
    let u = from_v0.dot(across) * inverse;
    let q = from_v0.cross(e1);
    let (v, t) = (ray.direction.dot(q) * inverse, e2.dot(q) * inverse);
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0
}

/// How many of `count` rays pass the mesh by that test, without a tree.
fn lost_by_textbook(mesh: &Icosphere, triangles: &[Triangle], count: usize) -> Asked {
    let mut rng = Rng::of("textbook");
    let is_lost = |_: &usize| {
        let ray = ray(mesh, &mut rng);
        !triangles.iter().any(|t| textbook(&ray, t))
    };
    let lost = (0..count).filter(is_lost).count() as u64;
    Asked { who: TEXTBOOK.to_owned(), rays: count as u64, lost }
}

/// Asks every natural variant about `count` rays at each place together, and WGSL about `wgsl`.
///
/// # Errors
///
/// None: the meshes have finite bounds.
pub fn campaign(count: usize, wgsl: usize) -> Result<Vec<Tally>, BuildError> {
    let each = |place: &Place| {
        let mesh = Icosphere::new(place.center, place.radius);
        let triangles = mesh.triangles();
        let bvh = Bvh::build(&triangles)?;
        let kernels =
            [kernel!(|ray: Ray| bvh.closest_hit(ray).is_hit), kernel!(|ray: Ray| bvh.any_hit(ray))];
        let mut tally = Tally::new(place.name);
        let ray = |rng: &mut Rng| ray(&mesh, rng);
        tally.cpu(&kernels, count / PLACES.len(), &ray);
        tally.wgsl(&kernels, wgsl / PLACES.len(), &ray);
        tally.others.push(lost_by_textbook(&mesh, &triangles, count / PLACES.len() / 100));
        Ok(tally)
    };
    PLACES.iter().map(each).collect()
}
