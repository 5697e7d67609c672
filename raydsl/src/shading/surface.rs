//! The trait of primitives that integrators can shade.

use glam::{Vec2, Vec3, vec2};

use crate::geometry::{Hit, Ray, SurfacePoint, Triangle, triangle};
use crate::kernel;
use crate::machine::functions::vec2;

/// A primitive that can be shaded.
///
/// The shapes of the library compute the surface point: `self.surface_point(ray, hit)`. A primitive
/// with its own `intersect` fills in the position, the unit normal and the error bounds by which
/// rays are offset; see [`SurfacePoint`].
///
/// ```
/// use raydsl::shading::Surface;
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
    /// Returns the point that `ray` hits. The normal may be on either side.
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint;

    /// Returns the albedo at the hit: red, green and blue, each from 0 to 1.
    fn albedo(&self, ray: Ray, hit: Hit) -> Vec3;

    /// Returns the surface coordinates of the hit, for textures: those of the hit itself.
    fn uv(&self, _ray: Ray, hit: Hit) -> Vec2 {
        vec2(hit.u, hit.v)
    }

    /// Returns the number of the material, counted by the application: 0.
    fn material(&self, _ray: Ray, _hit: Hit) -> u32 {
        0
    }

    /// Returns 1 where `ray` enters a closed surface, and -1 where it leaves it: by the normal, which
    /// is on the outside. A triangle returns 0 where the ray passes through an edge or a vertex and
    /// another one counts the crossing.
    fn crossing(&self, ray: Ray, hit: Hit) -> i32 {
        if self.surface(ray, hit).normal.dot(ray.direction) < 0.0 { 1 } else { -1 }
    }
}

/// Has a light grey albedo.
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

    #[inline]
    fn crossing(&self, ray: Ray, hit: Hit) -> i32 {
        triangle::crossing(ray, hit, self.v0, self.v1, self.v2)
    }
}

/// Flips the normal of a point to the side that a ray with this direction comes from.
#[kernel]
#[inline]
pub fn facing(point: SurfacePoint, direction: Vec3) -> SurfacePoint {
    let is_behind = point.normal.dot(direction) > 0.0;
    let normal = if is_behind { -point.normal } else { point.normal };
    SurfacePoint { normal, ..point }
}
