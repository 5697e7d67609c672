//! Surface points and their error bounds.

use glam::Vec3;

use super::{Hit, Ray};
use crate::{Type, kernel};

/// Point of a surface, with its normal and error bound.
///
/// `surface_point(ray, hit)` of a shape returns the point that a ray hits, `sample(u)` a point for
/// light sampling. Rays from here are [`SurfacePoint::ray`], [`SurfacePoint::ray_to`] and
/// [`SurfacePoint::ray_between`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct SurfacePoint {
    /// Position.
    pub position: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// Distance from the position, along the normal, at which a ray must begin so as not to hit the
    /// surface at once: the position's own rounding, that of the sum with this shift, and that of
    /// the shape's `intersect`, whatever the direction. A length, in units of the scene.
    pub error: f32,
}

/// 3 eps (eps = 2^-24): each coordinate is rounded once where the shape is placed in the world,
/// once more if a device adds in another order, and once where the shift is added.
const OF_COORDINATES: f32 = 3.0 / 16_777_216.0;

/// Creates a point computed within its shape, where it and `intersect` are off by `own_error`, and
/// then placed in the world.
///
/// After the object-space bound of NVIDIA's self-intersection-avoidance sample (2024): the rounding
/// of the coordinates counts only as far as the normal points along them.
#[kernel]
#[inline]
pub(super) fn rounded_point(position: Vec3, normal: Vec3, own_error: f32) -> SurfacePoint {
    let of_coordinates = normal.abs().dot(position.abs()) * OF_COORDINATES;
    SurfacePoint { position, normal, error: of_coordinates + own_error }
}

/// Creates the point at `hit.t` of the ray. Its error is that of the distance: `slack` times the
/// sum of the distance and the size of the shape, as [`Primitive::SLACK`](super::Primitive::SLACK)
/// says.
#[kernel]
#[inline]
pub(super) fn point_on_ray(
    ray: Ray,
    hit: Hit,
    normal: Vec3,
    size: f32,
    slack: f32,
) -> SurfacePoint {
    let way = ray.direction * hit.t;
    rounded_point(ray.origin + way, normal, (way.length() + size) * slack)
}
