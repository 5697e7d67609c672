//! Where rays begin that leave a surface, and where they end that go to one.
//!
//! A ray from a point that was rounded may begin behind its surface, and hits it at once. The
//! origin is therefore moved along the normal by the error that the point is known to have: not by
//! a constant, which is too small far from the world's origin and too large next to it. (Pharr,
//! Jakob and Humphreys, "Physically Based Rendering", 4th edition, section 6.8.)

use glam::Vec3;

use super::{Ray, SurfacePoint};
use crate::kernel;

/// 16 eps (eps = 2^-24): what `intersect` of a triangle or a sphere is off by, as a share of the
/// way to it.
const OF_THE_WAY: f32 = 1.0 / 1_048_576.0;

/// Where a ray in `direction` begins that leaves a surface at `position`: `error` away, on the side
/// that it goes to. The normal has unit length, the direction any.
///
/// `position`, `normal` and `error` are those of a [`SurfacePoint`]; for a shape of your own,
/// `error` is a bound of what the position and your `intersect` may be off by along the normal.
#[kernel]
#[inline]
pub fn offset_origin(position: Vec3, normal: Vec3, error: f32, direction: Vec3) -> Vec3 {
    let shift = if normal.dot(direction) < 0.0 { -error } else { error };
    position + normal * shift
}

#[kernel]
impl SurfacePoint {
    /// The ray in `direction`, of any length, that does not meet the surface where it begins.
    #[inline]
    pub fn ray(&self, direction: Vec3) -> Ray {
        let origin = offset_origin(self.position, self.normal, self.error, direction);
        Ray { origin, direction, t_min: 0.0, t_max: f32::MAX }
    }

    /// The ray to a point light: `t` counts up to 1, and ends 16 eps before it, so that nothing at
    /// the point or beyond it stands in the way.
    #[inline]
    pub fn ray_to(&self, point: Vec3) -> Ray {
        let origin = offset_origin(self.position, self.normal, self.error, point - self.position);
        Ray { origin, direction: point - origin, t_min: 0.0, t_max: 1.0 - OF_THE_WAY }
    }

    /// The ray to a point of another surface, such as a light: it meets neither surface where it
    /// begins and ends, however grazing. What stands closer to the light than 16 eps of the way
    /// may be missed.
    #[inline]
    pub fn ray_between(&self, light: SurfacePoint) -> Ray {
        let way = light.position - self.position;
        let origin = offset_origin(self.position, self.normal, self.error, way);
        // Seen from afar the other surface is as uncertain as the way is long.
        let error = light.error + way.length() * OF_THE_WAY;
        let end = offset_origin(light.position, light.normal, error, -way);
        Ray { origin, direction: end - origin, t_min: 0.0, t_max: 1.0 }
    }
}
