//! Disks, given by a centre, a normal of any length and a radius.

use core::f32::consts::PI;

use glam::{Vec2, Vec3, vec2};

use super::axial::{at_turn, turn};
use super::near::{Near, distance_of, near};
use super::outwards::{around_disk, wide};
use super::surface::{point_on_ray, rounded_point};
use super::{Aabb, Hit, Ray, SurfacePoint};
use crate::kernel;
use crate::machine::functions::vec2;

/// Error bound of a disk's hit, relative as a sphere's.
///
/// Moving the ray to its closest point shifts it by 4 eps of the distance to the centre (eps =
/// 2^-24). From there on everything has the size of the disk: the two products with the normal are
/// off by 3 eps each, which tilts it by as much, and the point by 4 eps. Below 16 eps together;
/// twice that is allowed.
pub const SLACK: f32 = 1.0 / 524_288.0;

/// Maximum number of crossings of a ray; see
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 1;

/// Returns the distance from the ray's closest point to the plane, in lengths of the line's
/// direction.
///
/// In the plane the offset and the step have the same product with the normal. A ray within the
/// plane yields NaN or infinity.
#[kernel]
#[inline]
fn step_to_plane(line: Near, normal: Vec3) -> f32 {
    -line.offset.dot(normal) / line.direction.dot(normal)
}

/// Intersects a ray with the disk, from either side: `hit.u` is the distance from the centre as a
/// share of the radius. A ray within the plane misses it.
///
/// A disk whose radius or normal is 0 is never hit.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, center: Vec3, normal: Vec3, radius: f32) -> Hit {
    let line = near(ray, center - ray.origin);
    let s = step_to_plane(line, normal);
    let from_center = (line.offset + line.direction * s).length();
    let t = distance_of(line, s);
    let is_crossing = line.direction.dot(normal) != 0.0;
    let is_met = is_crossing && radius > 0.0 && from_center <= radius;
    let is_hit = is_met && t >= ray.t_min && t <= ray.t_max;
    Hit { u: from_center / radius, ..Hit::new(is_hit, t) }
}

/// Returns the unit normal, whichever side `ray` hits.
#[kernel]
#[inline]
pub fn normal(_ray: Ray, _hit: Hit, _center: Vec3, normal: Vec3, _radius: f32) -> Vec3 {
    normal.normalize()
}

/// Returns the coordinates of the hit: the distance from the centre as a share of the radius, and
/// the angle as a share of a turn, which begins at `normal.normalize().any_orthonormal_pair().0`.
#[kernel]
#[inline]
pub fn uv(ray: Ray, hit: Hit, center: Vec3, normal: Vec3, _radius: f32) -> Vec2 {
    let line = near(ray, center - ray.origin);
    let from_center = line.offset + line.direction * step_to_plane(line, normal);
    vec2(hit.u, turn(normal.normalize(), from_center))
}

/// Returns the area of one side.
#[kernel]
#[inline]
pub fn area(_center: Vec3, _normal: Vec3, radius: f32) -> f32 {
    PI * radius * radius
}

/// Samples a point of the disk, uniformly for a uniform `u` in the unit square.
#[kernel]
#[inline]
pub fn sample(u: Vec2, center: Vec3, normal: Vec3, radius: f32) -> SurfacePoint {
    let unit = normal.normalize();
    let from_center = at_turn(unit, u.y) * (radius * u.x.sqrt());
    rounded_point(center + from_center, unit, radius * SLACK)
}

/// Returns the point that `ray` hits.
#[kernel]
#[inline]
pub fn surface_point(ray: Ray, hit: Hit, _center: Vec3, normal: Vec3, radius: f32) -> SurfacePoint {
    point_on_ray(ray, hit, normal.normalize(), radius, SLACK)
}

/// Returns the smallest box around the disk, at most two ulp too large.
pub fn get_bounds(center: Vec3, normal: Vec3, radius: f32) -> Aabb {
    around_disk(center, wide(normal), radius)
}

/// Splits the disk's box at the plane `axis = at`; returns the parts below and above.
pub fn split_primitive(
    axis: usize,
    at: f32,
    center: Vec3,
    normal: Vec3,
    radius: f32,
) -> (Aabb, Aabb) {
    get_bounds(center, normal, radius).split(axis, at)
}
