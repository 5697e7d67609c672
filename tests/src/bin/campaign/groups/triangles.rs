//! Rays at the seams of closed meshes, through a tree.

use raydsl::prelude::*;
use raydsl_tests::hard_rays::mesh::Icosphere;
use raydsl_tests::hard_rays::seams::{self, PLACES, Place};

use super::fault;
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "triangles",
    title: "Rays at edges and vertices of a closed mesh of 320 triangles",
    clauses: &["No ray passes an edge or a vertex that triangles share."],
    rows,
};

fn rows() -> Vec<Row> {
    PLACES.iter().map(seams_at).collect()
}

/// The textbook is Möller and Trumbore's test, without a tree.
fn seams_at(place: &'static Place) -> Row {
    Row::new(place.name, 1, Unit::Faults, Bound::NONE, |run| {
        let mesh = Icosphere::new(place.center, place.radius);
        let triangles = mesh.triangles();
        let bvh = Bvh::build(&triangles)?;
        let kernels =
            [kernel!(|ray: Ray| bvh.closest_hit(ray).is_hit), kernel!(|ray: Ray| bvh.any_hit(ray))];
        let outcome =
            run.measure(&kernels, |rng| (seams::ray(&mesh, rng),), |_, is_hit| fault(!is_hit))?;
        let textbook = run.broken_by(run.count / 100, |rng| {
            let ray = seams::ray(&mesh, rng);
            !triangles.iter().any(|t| textbook(&ray, t))
        });
        Ok(outcome.beside(textbook))
    })
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
