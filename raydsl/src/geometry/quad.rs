//! Quads, given by four vertices in order.

use glam::{Vec2, Vec3, vec2};

use super::axial::choose;
use super::edges::across;
use super::{Aabb, Hit, Ray, SurfacePoint, triangle};
use crate::kernel;
use crate::machine::functions::vec2;

/// Error bound of a quad's hit: that of its triangles.
pub const SLACK: f32 = triangle::SLACK;

/// Maximum number of crossings of a ray: 2 if it is not flat. A ray through the diagonal of a flat
/// quad may cross both halves there, at distances an ulp apart. See
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 2;

/// Intersects a ray with the quad: both sides, edges and vertices included.
///
/// It is the two triangles `v0 v1 v3` and `v2 v3 v1`, as Embree splits quads, so it need not be
/// flat, and no ray passes between neighbours that share two vertices, nor between the two halves.
/// `hit.u` runs from `v0` to `v1` and from `v3` to `v2`, `hit.v` from `v0` to `v3` and from `v1` to
/// `v2`, without a step at the diagonal. A ray along the surface hits it somewhere between the
/// edges that it crosses.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3) -> Hit {
    let first = triangle::intersect(ray, v0, v1, v3);
    let second = triangle::intersect(ray, v2, v3, v1);
    // A NaN vertex invalidates the whole quad, though each half has only three.
    let diagonal = v2 - v0;
    let is_whole = diagonal.dot(diagonal) >= 0.0;
    if second.is_hit && !(first.is_hit && first.t <= second.t) {
        let (u, v) = (1.0 - second.u, 1.0 - second.v);
        Hit { u, v, ..Hit::new(is_whole, second.t) }
    } else {
        Hit { is_hit: first.is_hit && is_whole, ..first }
    }
}

/// Returns the normal of the half that `ray` hits, on the side where the vertices run
/// anticlockwise.
#[kernel]
#[inline]
pub fn normal(_ray: Ray, hit: Hit, v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3) -> Vec3 {
    if hit.u + hit.v <= 1.0 { across(v1 - v0, v3 - v0) } else { across(v3 - v2, v1 - v2) }
}

/// Returns the coordinates of the hit: 0, 0 at `v0`, 1, 0 at `v1`, 1, 1 at `v2`.
#[kernel]
#[inline]
pub fn uv(_ray: Ray, hit: Hit, _v0: Vec3, _v1: Vec3, _v2: Vec3, _v3: Vec3) -> Vec2 {
    vec2(hit.u, hit.v)
}

/// Returns the area of one side.
#[kernel]
#[inline]
pub fn area(v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3) -> f32 {
    triangle::area(v0, v1, v3) + triangle::area(v2, v3, v1)
}

/// Samples a point of the quad, uniformly for a uniform `u` in the unit square.
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

/// Returns the point that `ray` hits, from the barycentric weights in its half. The other half
/// extends twice as far.
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

/// Returns the bounds of the vertices.
pub fn get_bounds(v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3) -> Aabb {
    Aabb::from_points([v0, v1, v2, v3])
}

/// Splits the quad at the plane `axis = at`; returns boxes around the parts of its halves below and
/// above.
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
