//! The sphere test that every sphere-like primitive shares.

use glam::Vec3;

use super::{Hit, Ray};
use crate::kernel;

/// What a sphere's hit may be off by, relative to the distance from the ray's origin; see
/// [`Primitive::SLACK`](super::Primitive::SLACK).
///
/// With `f` the offset of the centre, the radicand `r² - |f - (f·d) d|²` is exact for a radius
/// within 4 eps |f| of `r` (eps = 2^-24): the error of the perpendicular is that of two
/// roundings of `f`, and its square has no cancellation. 16 eps leave room for the closing sums.
pub const SLACK: f32 = 1.0 / 1_048_576.0;

/// Where a ray meets a sphere: the nearer of its two intersections that lies in the ray's range.
///
/// The discriminant is formed from the part of the offset that is perpendicular to the ray, as
/// in Haines, Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection",
/// Ray Tracing Gems (2019), chapter 7. A sphere of radius 0 is never hit.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, center: Vec3, radius: f32) -> Hit {
    let f = center - ray.origin;
    let d = ray.direction;
    // One division, which is the ray's alone: loops over spheres do it once.
    let per_d2 = 1.0 / d.dot(d);
    // Along the ray to the point closest to the centre, and from there to the centre.
    let closest = f.dot(d) * per_d2;
    let aside = f - d * closest;
    let radicand = radius * radius - aside.dot(aside);
    let half = (radicand * per_d2).sqrt();
    let near = closest - half;
    let far = closest + half;
    let t = if near < ray.t_min { far } else { near };
    let is_hit = radicand >= 0.0 && radius > 0.0 && t >= ray.t_min && t <= ray.t_max;
    Hit { is_hit, t, prim_id: 0, u: 0.0, v: 0.0 }
}
