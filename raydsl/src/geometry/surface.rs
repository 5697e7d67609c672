//! Points of surfaces.

use glam::Vec3;

use super::{Hit, Ray};
use crate::{Type, kernel};

/// A point of a surface, which way the surface faces there, and what rounding made of it.
///
/// `surface_point(ray, hit)` of a shape gives the point that a ray hits, `sample(u)` one of the
/// light that it sends. Rays from here are [`SurfacePoint::ray`], [`SurfacePoint::ray_to`] and
/// [`SurfacePoint::ray_between`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct SurfacePoint {
    /// Where it is.
    pub position: Vec3,
    /// The normal, with unit length.
    pub normal: Vec3,
    /// How far from the position, along the normal, a ray must begin so that it does not meet the
    /// surface at once: the position's own rounding, that of the sum with this shift, and that of
    /// the shape's `intersect`, whatever the direction. A length, in units of the scene.
    pub error: f32,
}

/// 3 eps (eps = 2^-24): each coordinate is rounded once where the shape is put into the world, once
/// more if a device adds in another order, and once where the shift is added.
const OF_COORDINATES: f32 = 3.0 / 16_777_216.0;

/// A point that was made within its shape, where it and `intersect` are off by `own_error`, and
/// then put into the world.
///
/// After the object-space bound of NVIDIA's self-intersection-avoidance sample (2024): what the
/// coordinates lose counts only as far as the normal points along them.
#[kernel]
#[inline]
pub(super) fn rounded_point(position: Vec3, normal: Vec3, own_error: f32) -> SurfacePoint {
    let of_coordinates = normal.abs().dot(position.abs()) * OF_COORDINATES;
    SurfacePoint { position, normal, error: of_coordinates + own_error }
}

/// The point at `hit.t` of the ray. Its error is that of the distance: `slack` times the way there
/// and the size of the shape, as [`Primitive::SLACK`](super::Primitive::SLACK) says.
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
