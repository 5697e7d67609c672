//! Delta lights, whose shadows are sharp.

use glam::Vec3;

use crate::geometry::{Ray, SurfacePoint};
use crate::machine::generic::max;
use crate::{Type, kernel};

/// A light that illuminates a point from one direction.
#[kernel]
pub trait Light {
    /// Returns the unshadowed irradiance at the point, on the side that its normal is on.
    fn falling_on(&self, point: SurfacePoint) -> Vec3;

    /// Returns the shadow ray: the light is occluded where this ray hits anything.
    fn shadow_ray(&self, point: SurfacePoint) -> Ray;
}

/// An isotropic point light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct PointLight {
    /// The position of the light.
    pub position: Vec3,
    /// Radiant intensity (flux per unit of solid angle) as red, green and blue, not negative. The
    /// irradiance at normal incidence and distance `r` is `intensity / r²`.
    pub intensity: Vec3,
}

/// A directional light, so far away that its rays are parallel, such as the sun.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct DirectionalLight {
    /// Unit vector towards the light.
    pub direction: Vec3,
    /// Irradiance at normal incidence, as red, green and blue, not negative.
    pub irradiance: Vec3,
}

#[kernel]
impl Light for PointLight {
    #[inline]
    fn falling_on(&self, point: SurfacePoint) -> Vec3 {
        let way = self.position - point.position;
        let squared = way.dot(way);
        let up = point.normal.dot(way);
        // The cosine is `up / r`. A light at the point itself has no direction, and no cosine.
        let share = if up > 0.0 { up / max(squared * squared.sqrt(), 1e-37) } else { 0.0 };
        self.intensity * share
    }

    #[inline]
    fn shadow_ray(&self, point: SurfacePoint) -> Ray {
        point.ray_to(self.position)
    }
}

#[kernel]
impl Light for DirectionalLight {
    #[inline]
    fn falling_on(&self, point: SurfacePoint) -> Vec3 {
        self.irradiance * max(point.normal.dot(self.direction), 0.0)
    }

    #[inline]
    fn shadow_ray(&self, point: SurfacePoint) -> Ray {
        point.ray(self.direction)
    }
}
