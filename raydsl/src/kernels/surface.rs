//! What kernels ask of the primitives they shade.

use glam::Vec3;

use crate::geometry::{Hit, Ray, SurfacePoint, Triangle};
use crate::kernel;

/// A primitive that can be shaded.
///
/// The shapes of the library have the point: `self.surface_point(ray, hit)`. That of a primitive
/// with an `intersect` of its own has the position, the unit normal, and how far a ray must begin
/// from there, as [`SurfacePoint`] says.
///
/// ```
/// use raydsl::kernels::Surface;
/// use raydsl::prelude::*;
/// use raydsl::kernel;
///
/// #[primitive(sphere(center, radius))]
/// struct Ball {
///     center: Vec3,
///     radius: f32,
///     color: Vec3,
/// }
///
/// #[kernel]
/// impl Surface for Ball {
///     fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
///         self.surface_point(ray, hit)
///     }
///
///     fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
///         self.color
///     }
/// }
/// ```
#[kernel]
pub trait Surface {
    /// The point that `ray` hits. The normal may be on either side.
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint;

    /// The share of red, green and blue light that comes back from there, each from 0 to 1.
    fn albedo(&self, ray: Ray, hit: Hit) -> Vec3;
}

/// A light grey.
#[kernel]
impl Surface for Triangle {
    #[inline]
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    #[inline]
    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::splat(0.8)
    }
}

/// The point as seen from `direction`: its normal is on the side that the ray comes from.
#[kernel]
#[inline]
pub fn facing(point: SurfacePoint, direction: Vec3) -> SurfacePoint {
    let is_behind = point.normal.dot(direction) > 0.0;
    let normal = if is_behind { -point.normal } else { point.normal };
    SurfacePoint { normal, ..point }
}
