//! The arithmetic of boxes, which tests of trees' boxes and [`Aabb::span`](super::Aabb::span)
//! share. A box is where three slabs meet: what is between two parallel planes.

use glam::{BVec3, Vec2, Vec3, vec2, vec3};

use super::Ray;
use crate::kernel;
use crate::machine::WithoutNan;
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::{all, any, max, min};

/// 2^-60.
const LEAST: f32 = 8.673_617_4e-19;

/// Returns whether a ray may hit anything: rays with a NaN or infinite component do not.
#[kernel]
#[inline(always)]
pub(crate) fn is_finite(ray: Ray) -> bool {
    are_finite(ray.origin) & are_finite(ray.direction)
}

#[kernel]
#[inline(always)]
fn are_finite(v: Vec3) -> bool {
    v.is_finite()
}

/// Intersects the slabs with the range: the last near plane, and the first far plane.
#[kernel(known = WithoutNan)]
#[inline(always)]
pub(crate) fn overlap(near: Vec3, far: Vec3, t_min: f32, t_max: f32) -> Vec2 {
    vec2(max(max(near.x, near.y), max(t_min, near.z)), min(min(far.x, far.y), min(t_max, far.z)))
}

/// Returns the reciprocal of every component, finite.
#[kernel(known = WithoutNan)]
#[inline(always)]
pub(crate) fn finite_inverse(d: Vec3) -> Vec3 {
    let least = negligible(d);
    1.0 / vec3(at_least(d.x, least), at_least(d.y, least), at_least(d.z, least))
}

/// Returns the size below which components of a direction count as 0.
#[kernel(known = WithoutNan)]
#[inline(always)]
fn negligible(d: Vec3) -> f32 {
    max(largest(d.abs()) * LEAST, f32::MIN_POSITIVE)
}

/// Returns `x`, or a number of this size with its sign if `x` is smaller.
#[kernel]
#[inline(always)]
fn at_least(x: f32, size: f32) -> f32 {
    let signed = if x < 0.0 { -size } else { size };
    if x.abs() < size { signed } else { x }
}

#[kernel(known = WithoutNan)]
#[inline(always)]
pub(crate) fn largest(v: Vec3) -> f32 {
    max(max(v.x, v.y), v.z)
}

/// Implements [`Aabb::span`](super::Aabb::span) for the box from `low` to `high`.
#[kernel]
#[inline]
pub(super) fn span(ray: Ray, low: Vec3, high: Vec3) -> Vec2 {
    let is_parallel = ray.direction.abs().cmplt(Vec3::splat(negligible(ray.direction)));
    let is_beside = any(is_parallel & (ray.origin.cmplt(low) | ray.origin.cmpgt(high)));
    let ends = ends(ray, low, high, is_parallel);
    // `ends` gives any numbers for a NaN: these comparisons do not hold for one.
    let is_any = all(low.cmple(high)) & (ray.t_min <= ray.t_max) & is_finite(ray);
    let is_met = is_any & !is_beside & (ends.x <= ends.y);
    if is_met { ends } else { vec2(f32::MAX, -f32::MAX) }
}

/// Returns the distances at which the ray enters and leaves the slabs that it is not parallel to.
#[kernel(known = WithoutNan)]
#[inline]
fn ends(ray: Ray, low: Vec3, high: Vec3, is_parallel: BVec3) -> Vec2 {
    let inverse = finite_inverse(ray.direction);
    let a = (low - ray.origin) * inverse;
    let b = (high - ray.origin) * inverse;
    let near = Vec3::select(is_parallel, Vec3::splat(-f32::MAX), min(a, b));
    let far = Vec3::select(is_parallel, Vec3::splat(f32::MAX), max(a, b));
    overlap(near, far, ray.t_min, ray.t_max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reciprocals_are_finite_and_keep_their_signs() {
        for d in [
            vec3(0.0, -0.0, 1.0),
            vec3(1e-30, -1e-30, 2.0),
            vec3(f32::MIN_POSITIVE / 8.0, 0.0, -0.0),
            vec3(-3.0, 0.5, 1e-19),
            vec3(1e30, -1.0, 0.0),
        ] {
            let inverse = finite_inverse(d);
            assert!(inverse.is_finite(), "{d}: {inverse}");
            let size = d.abs().max_element().max(f32::MIN_POSITIVE);
            for (d, inverse) in d.to_array().into_iter().zip(inverse.to_array()) {
                assert!(d == 0.0 || (d < 0.0) == (inverse < 0.0), "{d}: {inverse}");
                if d.abs() >= f32::MIN_POSITIVE && d.abs() > size * 1e-17 {
                    assert_eq!(inverse, 1.0 / d);
                }
            }
        }
    }
}
