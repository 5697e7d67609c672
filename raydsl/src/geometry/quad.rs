//! Quads, of four vertices in order.

use glam::{Vec2, Vec3, vec2};

use super::axial::choose;
use super::edges::across;
use super::{Aabb, Hit, Ray, SurfacePoint, triangle};
use crate::kernel;
use crate::machine::functions::vec2;

/// What a quad's hit may be off by: that of its triangles.
pub const SLACK: f32 = triangle::SLACK;

/// How often a ray crosses it at most: twice if it is not flat. One through the diagonal of a flat quad
/// may cross both halves, which meet there, at distances an ulp apart. See
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 2;

/// Where a ray meets the quad: both sides, edges and vertices included.
///
/// It is the two triangles `v0 v1 v3` and `v2 v3 v1`, as Embree splits quads, so it need not be
/// flat, and no ray passes between neighbours that share two vertices, nor between the two halves.
/// `hit.u` runs from `v0` to `v1` and from `v3` to `v2`, `hit.v` from `v0` to `v3` and from `v1` to
/// `v2`, without a step at the diagonal. A ray along the surface hits it somewhere between the
/// edges that it passes.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3) -> Hit {
    let first = triangle::intersect(ray, v0, v1, v3);
    let second = triangle::intersect(ray, v2, v3, v1);
    // A vertex that is no number is one of the whole quad, though each half has only three.
    let diagonal = v2 - v0;
    let is_whole = diagonal.dot(diagonal) >= 0.0;
    if second.is_hit && !(first.is_hit && first.t <= second.t) {
        let (u, v) = (1.0 - second.u, 1.0 - second.v);
        Hit { u, v, ..Hit::new(is_whole, second.t) }
    } else {
        Hit { is_hit: first.is_hit && is_whole, ..first }
    }
}

/// The normal of the half that `ray` hits, towards where the vertices run anticlockwise.
#[kernel]
#[inline]
pub fn normal(_ray: Ray, hit: Hit, v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3) -> Vec3 {
    if hit.u + hit.v <= 1.0 { across(v1 - v0, v3 - v0) } else { across(v3 - v2, v1 - v2) }
}

/// The two coordinates of the hit: 0, 0 at `v0`, 1, 0 at `v1`, 1, 1 at `v2`.
#[kernel]
#[inline]
pub fn uv(_ray: Ray, hit: Hit, _v0: Vec3, _v1: Vec3, _v2: Vec3, _v3: Vec3) -> Vec2 {
    vec2(hit.u, hit.v)
}

/// The area of one side.
#[kernel]
#[inline]
pub fn area(v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3) -> f32 {
    triangle::area(v0, v1, v3) + triangle::area(v2, v3, v1)
}

/// A point of the quad; a uniform `u` in the unit square gives a uniform one.
#[kernel]
#[inline]
pub fn sample(u: Vec2, v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3) -> SurfacePoint {
    let first = triangle::area(v0, v1, v3);
    let half = choose(u.x, first / (first + triangle::area(v2, v3, v1)));
    let point = if half.y == 0.0 {
        triangle::sample(vec2(half.x, u.y), v0, v1, v3)
    } else {
        triangle::sample(vec2(half.x, u.y), v2, v3, v1)
    };
    SurfacePoint { error: 2.0 * point.error, ..point }
}

/// The point that `ray` hits, from the weights of the vertices of the half that it is in. The other
/// half reaches twice as far.
#[kernel]
#[inline]
pub fn surface_point(ray: Ray, hit: Hit, v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3) -> SurfacePoint {
    let half = if hit.u + hit.v <= 1.0 {
        triangle::surface_point(ray, hit, v0, v1, v3)
    } else {
        let opposite = Hit { u: 1.0 - hit.u, v: 1.0 - hit.v, ..hit };
        triangle::surface_point(ray, opposite, v2, v3, v1)
    };
    SurfacePoint { error: 2.0 * half.error, ..half }
}

/// The box of the vertices.
pub fn get_bounds(v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3) -> Aabb {
    Aabb::from_points([v0, v1, v2, v3])
}

/// Boxes around the parts of the quad below and above the plane `axis = at`: those of its halves.
pub fn split_primitive(
    axis: usize,
    at: f32,
    v0: Vec3,
    v1: Vec3,
    v2: Vec3,
    v3: Vec3,
) -> (Aabb, Aabb) {
    let first = triangle::split_primitive(axis, at, v0, v1, v3);
    let second = triangle::split_primitive(axis, at, v2, v3, v1);
    (first.0.union(second.0), first.1.union(second.1))
}
