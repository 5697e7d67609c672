//! Lights without an extent, whose shadows are sharp.

use glam::Vec3;

use crate::geometry::{Ray, SurfacePoint};
use crate::machine::generic::max;
use crate::{Type, kernel};

/// Something that shines on a point from one direction.
#[kernel]
pub trait Light {
    /// The light that falls on the point, for each unit of its area, if nothing is between. The
    /// side that its normal is on is lit.
    fn falling_on(&self, point: SurfacePoint) -> Vec3;

    /// What is between hits this ray.
    fn shadow_ray(&self, point: SurfacePoint) -> Ray;
}

/// A lamp that shines evenly in all directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct PointLight {
    /// Where it is.
    pub position: Vec3,
    /// Radiant intensity: what it sends into each unit of solid angle, as red, green and blue, not
    /// negative. At a distance `r`, straight under it, `intensity / r²` falls on a unit of area.
    pub intensity: Vec3,
}

/// A light that is so far away that its rays are parallel: the sun.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct DirectionalLight {
    /// Towards the light, with unit length.
    pub direction: Vec3,
    /// What falls on a unit of area that faces it, as red, green and blue, not negative.
    pub irradiance: Vec3,
}

#[kernel]
impl Light for PointLight {
    #[inline]
    fn falling_on(&self, point: SurfacePoint) -> Vec3 {
        let way = self.position - point.position;
        let squared = way.dot(way);
        let up = point.normal.dot(way);
        // The cosine is `up / r`. A lamp on the point itself has no direction, and no cosine.
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
