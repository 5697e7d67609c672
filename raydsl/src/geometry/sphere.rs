//! Spheres, given by a centre and a radius.

use core::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3, vec2, vec3};

use super::surface::rounded_point;
use super::{Aabb, Hit, Ray, SurfacePoint};
use crate::kernel;
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::max;
use crate::math::elementary::{acos, atan2, sincos_2pi};

/// Error bound of a sphere's hit, relative to the distance from the ray's origin; see
/// [`Primitive::SLACK`](super::Primitive::SLACK).
///
/// With `f` the offset of the centre, the radicand `r² - |f - (f·d) d|²` is exact for a radius
/// within 4 eps |f| of `r` (eps = 2^-24): the error of the perpendicular is that of two roundings
/// of `f`, and the squares are not subtracted: with `l` its length the radicand is
/// `(r - l) (r + l)`. 16 eps leave room for the final sums.
pub const SLACK: f32 = 1.0 / 1_048_576.0;

/// Maximum number of crossings of a ray; see
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 2;

/// Intersects a ray with a sphere: the nearer of the two intersections within the ray's range.
///
/// The discriminant is computed from the part of the offset perpendicular to the ray, as in Haines,
/// Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing
/// Gems (2019), chapter 7. A sphere of radius 0 is never hit. Radii and lengths of directions are from
/// 1e-18 to 1e18: the squares of others are not in the range of `f32`, and such rays miss.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, center: Vec3, radius: f32) -> Hit {
    let f = center - ray.origin;
    let d = ray.direction;
    // The division depends on the ray alone: loops over spheres hoist it.
    let per_d2 = 1.0 / d.dot(d);
    // Project the centre on the ray, and drop the perpendicular.
    let closest = f.dot(d) * per_d2;
    let aside = f - d * closest;
    let distance = aside.length();
    let radicand = (radius - distance) * (radius + distance);
    let half = (radicand * per_d2).sqrt();
    let near = closest - half;
    let far = closest + half;
    let t = if near < ray.t_min { far } else { near };
    let is_hit = radicand >= 0.0 && radius > 0.0 && t >= ray.t_min && t <= ray.t_max;
    Hit::new(is_hit, t)
}

/// Returns the normal where `ray` hits the sphere.
///
/// It is computed from the offset to the centre, not from the point at `hit.t`, whose error is that
/// of the distance: for a small sphere far away, larger than the sphere. Its error is at most 8 eps
/// times the distance over the radius (eps = 2^-24).
#[kernel]
#[inline]
pub fn normal(ray: Ray, hit: Hit, center: Vec3, radius: f32) -> Vec3 {
    let f = center - ray.origin;
    let d = ray.direction;
    let per_d2 = 1.0 / d.dot(d);
    let closest = f.dot(d) * per_d2;
    let aside = f - d * closest;
    let distance = aside.length();
    let radicand = (radius - distance) * (radius + distance);
    let half = (max(radicand, 0.0) * per_d2).sqrt();
    // Select the intersection nearer to the hit.
    let is_far = (hit.t - (closest - half)).abs() > (closest + half - hit.t).abs();
    let along = if is_far { half } else { -half };
    (d * along - aside).normalize()
}

/// Returns longitude and latitude of the point that `ray` hits, from 0 to 1: the axis is z, and `v`
/// is 0 at its positive end.
#[kernel]
#[inline]
pub fn uv(ray: Ray, hit: Hit, center: Vec3, radius: f32) -> Vec2 {
    let n = normal(ray, hit, center, radius);
    let turn = atan2(n.y, n.x) / TAU;
    vec2(if turn < 0.0 { turn + 1.0 } else { turn }, acos(n.z) / PI)
}

/// Returns the surface area.
#[kernel]
#[inline]
pub fn area(_center: Vec3, radius: f32) -> f32 {
    4.0 * PI * radius * radius
}

/// Samples a point of the surface, uniformly for a uniform `u` in the unit square (Archimedes:
/// equal heights have equal areas).
#[kernel]
#[inline]
pub fn sample(u: Vec2, center: Vec3, radius: f32) -> SurfacePoint {
    let z = 1.0 - 2.0 * u.x;
    let r = max(1.0 - z * z, 0.0).sqrt();
    let around = sincos_2pi(u.y);
    let normal = vec3(r * around.cos, r * around.sin, z);
    of_normal(normal, center, radius)
}

/// Returns the point that `ray` hits, from the normal of the hit, so that it lies on the sphere
/// however far the ray came from.
#[kernel]
#[inline]
pub fn surface_point(ray: Ray, hit: Hit, center: Vec3, radius: f32) -> SurfacePoint {
    of_normal(normal(ray, hit, center, radius), center, radius)
}

/// Returns the point with this normal. The normal is off by 3 eps, and the perpendicular of a ray
/// from there by 4 of the radius (eps = 2^-24); twice that is allowed.
#[kernel]
#[inline]
pub(crate) fn of_normal(normal: Vec3, center: Vec3, radius: f32) -> SurfacePoint {
    rounded_point(center + normal * radius, normal, radius * SLACK)
}

/// Returns the smallest box around the sphere, at most one ulp too large.
pub fn get_bounds(center: Vec3, radius: f32) -> Aabb {
    Aabb::from_sphere(center, radius)
}

/// Splits the sphere at the plane `axis = at`; returns boxes around the parts below and above.
///
/// A part without the centre is as wide as the circle in the plane, which is computed in `f64` and
/// rounded outwards.
pub fn split_primitive(axis: usize, at: f32, center: Vec3, radius: f32) -> (Aabb, Aabb) {
    let whole = get_bounds(center, radius);
    let (below, above) = whole.split(axis, at);
    let aside = f64::from(at) - f64::from(center[axis]);
    let square = f64::from(radius).powi(2) - aside * aside;
    let circle = Aabb::from_sphere(center, (square.max(0.0).sqrt() as f32).next_up());
    let narrowed = |part: Aabb| {
        let mut narrow = circle.intersection(whole);
        (narrow.min[axis], narrow.max[axis]) = (part.min[axis], part.max[axis]);
        narrow
    };
    if aside > 0.0 { (below, narrowed(above)) } else { (narrowed(below), above) }
}
