//! Rays that leave a surface.

use std::slice;

use raydsl::prelude::*;
use raydsl_tests::hard_rays::bounces::{
    Ball, Bounce, POSITIONS, SIZES, fault_on_ball, fault_on_mesh, from_frame, is_resolved, local,
    position, towards,
};
use raydsl_tests::hard_rays::mesh::Icosphere;
use raydsl_tests::rng::Rng;

use super::{fault, shadows};
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "offsets",
    title: "Rays that leave a surface which another ray has hit",
    clauses: &[
        "None hits the surface where it begins, or is through to the other side; origins move by \
         at most 4 ulp of their distance from the world's origin and 8 eps of the size.",
        "A ray between a point of a surface and a light meets neither of them, and whatever is \
         between.",
        "A picture of a scene far from the world's origin differs from that at the origin by what \
         the rounding of vertices and of shadow rays' origins moves its edges.",
    ],
    rows,
};

fn rows() -> Vec<Row> {
    fn at_each(on: fn(f32, f32) -> Row) -> impl Iterator<Item = Row> {
        let sizes = |p| SIZES.into_iter().filter(move |&size| is_resolved(p, size));
        POSITIONS.into_iter().flat_map(move |p| sizes(p).map(move |size| on(p, size)))
    }
    let own = at_each(from_triangles).chain(at_each(from_spheres));
    own.chain(shadows::rows()).collect()
}

/// Traces a ray at a surface and one from there, with a share of the error that is allowed for.
macro_rules! bounce {
    ($bvh:ident) => {
        kernel!(|ray: Ray, local: Vec3, share: f32| {
            let first = $bvh.closest_hit(ray);
            let point = $bvh.primitive(first).surface_point(ray, first);
            let moved = SurfacePoint { error: share * point.error, ..point };
            let next = moved.ray(from_frame(point.normal, local));
            Bounce { first, point, next, again: $bvh.closest_hit(next) }
        })
    };
}

/// What `bounces` found wrong; nothing is promised of a first ray that misses.
fn judged(bounce: &Bounce, wrong: Option<&'static str>) -> Option<f64> {
    fault(wrong.is_some()).filter(|_| bounce.first.is_hit)
}

/// Of closed meshes, through a tree. The textbook's rays begin at the rounded point.
fn from_triangles(p: f32, size: f32) -> Row {
    let name = format!("triangle of {size:?} at {p:?}");
    let row = Row::new(name, 1, Unit::Faults, Bound::NONE, move |run| {
        let mesh = Icosphere::with_edges(position(p), size);
        let triangles = mesh.triangles();
        let bvh = Bvh::build(&triangles)?;
        let make = |rng: &mut Rng| {
            let target = if rng.below(3) == 0 { mesh.seam(rng).0 } else { mesh.point(rng) };
            (towards(rng, target, (target - mesh.center) / mesh.radius, size), local(rng), 1.0)
        };
        let check = |b: &Bounce| fault_on_mesh(&triangles, b);
        let kernel = bounce!(bvh);
        let outcome = run.measure(slice::from_ref(&kernel), make, |_, b| judged(b, check(b)))?;
        let textbook = run.broken_by(run.count / 100, |rng| {
            let (ray, local, _) = make(rng);
            let bounce = kernel.call((ray, local, 0.0));
            bounce.first.is_hit && check(&bounce).is_some()
        });
        Ok(outcome.beside(textbook))
    });
    row.share(0.1)
}

/// Of spheres. The textbook's rays begin at the rounded point.
fn from_spheres(p: f32, size: f32) -> Row {
    let name = format!("sphere of {size:?} at {p:?}");
    let row = Row::new(name, 1, Unit::Faults, Bound::NONE, move |run| {
        let ball = Ball { center: position(p), radius: 0.5 * size };
        let balls = [ball];
        let bvh = Bvh::build(&balls)?;
        let make = |rng: &mut Rng| {
            let normal = rng.direction().normalize();
            (towards(rng, ball.center + normal * ball.radius, normal, size), local(rng), 1.0)
        };
        let check = |b: &Bounce| fault_on_ball(&ball, b);
        let kernel = bounce!(bvh);
        let outcome = run.measure(slice::from_ref(&kernel), make, |_, b| judged(b, check(b)))?;
        let textbook = run.broken_by(run.count / 100, |rng| {
            let (ray, local, _) = make(rng);
            let bounce = kernel.call((ray, local, 0.0));
            bounce.first.is_hit && check(&bounce).is_some()
        });
        Ok(outcome.beside(textbook))
    });
    row.share(0.1)
}
