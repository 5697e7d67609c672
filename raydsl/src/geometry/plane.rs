//! Planes, given by a normal of any length and an offset: where `normal · p = offset`.
//!
//! A plane has no finite box, so there is no tree over planes: `Bvh::build` returns
//! [`BuildError::InfiniteBounds`](crate::bvh::BuildError::InfiniteBounds). Slices of planes support
//! every query.

use glam::{Vec2, Vec3, vec2};

use super::near::largest;
use super::outwards::{above, below};
use super::surface::{point_on_ray, rounded_point};
use super::{Aabb, Hit, Ray, SurfacePoint};
use crate::kernel;
use crate::machine::functions::vec2;

/// Error bound of a plane's hit, relative to the distances of the plane and of the hit from the
/// world's origin and from the ray's: the two products are off by 3 eps each (eps = 2^-24).
pub const SLACK: f32 = 1.0 / 2_097_152.0;

/// Maximum number of crossings of a ray; see
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 1;

/// Intersects a ray with the plane, from either side. A ray within the plane misses it, and so does
/// every ray if the normal is 0.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, normal: Vec3, offset: f32) -> Hit {
    // Scale the largest component to 1, so that the products neither over- nor underflow.
    let scale = largest(ray.direction);
    let approach = (ray.direction / scale).dot(normal);
    let t = (offset - ray.origin.dot(normal)) / approach / scale;
    let is_hit = approach != 0.0 && t >= ray.t_min && t <= ray.t_max;
    Hit::new(is_hit, t)
}

/// Returns the unit normal, whichever side `ray` hits.
#[kernel]
#[inline]
pub fn normal(_ray: Ray, _hit: Hit, normal: Vec3, _offset: f32) -> Vec3 {
    normal.normalize()
}

/// Returns the coordinates of the hit in the plane, along the two vectors of
/// `normal.normalize().any_orthonormal_pair()`, from the point closest to the world's origin. They
/// are lengths, not shares, since a plane has no end: `fract()` of them makes tiles of size 1.
#[kernel]
#[inline]
pub fn uv(ray: Ray, hit: Hit, normal: Vec3, _offset: f32) -> Vec2 {
    let (x, y) = normal.normalize().any_orthonormal_pair();
    let p = ray.origin + ray.direction * hit.t;
    vec2(p.dot(x), p.dot(y))
}

/// Returns infinity.
#[kernel]
#[inline]
pub fn area(_normal: Vec3, _offset: f32) -> f32 {
    f32::INFINITY
}

/// Samples a point of the unit square around the plane's point closest to the world's origin,
/// uniformly for a uniform `u`; a whole plane has no uniform distribution.
#[kernel]
#[inline]
pub fn sample(u: Vec2, normal: Vec3, offset: f32) -> SurfacePoint {
    let unit = normal.normalize();
    let (x, y) = unit.any_orthonormal_pair();
    let foot = unit * (offset / normal.length());
    let position = foot + (x * (u.x - 0.5) + y * (u.y - 0.5));
    rounded_point(position, unit, (foot.length() + position.length()) * SLACK)
}

/// Returns the point that `ray` hits. Its error grows with the distances of point and plane from
/// the world's origin.
#[kernel]
#[inline]
pub fn surface_point(ray: Ray, hit: Hit, normal: Vec3, offset: f32) -> SurfacePoint {
    let of_plane = (offset / normal.length()).abs();
    let size = of_plane + ray.origin.length() + (ray.direction * hit.t).length();
    point_on_ray(ray, hit, normal.normalize(), size, SLACK)
}

/// Returns the infinite box; for a plane across an axis it is flat there.
pub fn get_bounds(normal: Vec3, offset: f32) -> Aabb {
    let mut bounds = Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY);
    for i in 0..3 {
        let is_across =
            normal[i] != 0.0 && normal[(i + 1) % 3] == 0.0 && normal[(i + 2) % 3] == 0.0;
        if is_across {
            let (n, offset) = (f64::from(normal[i]), f64::from(offset));
            let at = offset / n;
            let error = if at * n == offset { 0.0 } else { at.abs() * f64::EPSILON };
            (bounds.min[i], bounds.max[i]) = (below(at, -error), above(at, error));
        }
    }
    bounds
}

/// Splits the plane's box at the plane `axis = at`; returns the parts below and above.
pub fn split_primitive(axis: usize, at: f32, normal: Vec3, offset: f32) -> (Aabb, Aabb) {
    get_bounds(normal, offset).split(axis, at)
}
