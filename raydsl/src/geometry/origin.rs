//! Offset of ray origins and ends from surfaces.
//!
//! A ray from a rounded point may begin behind its surface, and hits it at once. The origin is
//! therefore moved along the normal by the error bound of the point: not by a constant, which is
//! too small far from the world's origin and too large next to it. (Pharr, Jakob and Humphreys,
//! "Physically Based Rendering", 4th edition, section 6.8.)

use glam::Vec3;

use super::{Ray, SurfacePoint};
use crate::kernel;

/// 16 eps (eps = 2^-24): error of `intersect` of a triangle or a sphere, as a share of the
/// distance.
const OF_THE_WAY: f32 = 1.0 / 1_048_576.0;

/// Returns the origin of a ray in `direction` that leaves a surface at `position`: `error` away, on
/// the side of the direction. The normal has unit length, the direction any.
///
/// `position`, `normal` and `error` are those of a [`SurfacePoint`]; for a user-defined shape,
/// `error` is a bound of the error of the position and of `intersect` along the normal.
#[kernel]
#[inline]
pub fn offset_origin(position: Vec3, normal: Vec3, error: f32, direction: Vec3) -> Vec3 {
    let shift = if normal.dot(direction) < 0.0 { -error } else { error };
    position + normal * shift
}

#[kernel]
impl SurfacePoint {
    /// Returns the ray in `direction`, of any length, that does not hit the surface where it
    /// begins.
    #[inline]
    pub fn ray(&self, direction: Vec3) -> Ray {
        let origin = offset_origin(self.position, self.normal, self.error, direction);
        Ray { origin, direction, t_min: 0.0, t_max: f32::MAX }
    }

    /// Returns the ray to a point light: `t` runs up to 1, and ends 16 eps before it, so that
    /// nothing at the point or beyond it occludes.
    #[inline]
    pub fn ray_to(&self, point: Vec3) -> Ray {
        let origin = offset_origin(self.position, self.normal, self.error, point - self.position);
        Ray { origin, direction: point - origin, t_min: 0.0, t_max: 1.0 - OF_THE_WAY }
    }

    /// Returns the ray to a point of another surface, such as a light: it hits neither surface at
    /// its ends, however grazing. Occluders closer to the light than 16 eps of the distance may be
    /// missed.
    #[inline]
    pub fn ray_between(&self, light: SurfacePoint) -> Ray {
        let way = light.position - self.position;
        let origin = offset_origin(self.position, self.normal, self.error, way);
        // From afar the error of the other surface grows with the distance.
        let error = light.error + way.length() * OF_THE_WAY;
        let end = offset_origin(light.position, light.normal, error, -way);
        Ray { origin, direction: end - origin, t_min: 0.0, t_max: 1.0 }
    }
}
