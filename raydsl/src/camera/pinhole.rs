//! The pinhole camera.

use glam::{Vec2, Vec3};

use super::basis::{Basis, pixel_size};
use super::{Camera, CameraRays};
use crate::geometry::Ray;
use crate::{Type, kernel};

/// Pinhole camera: perspective projection, sharp at every distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinhole {
    /// Position of the camera.
    pub eye: Vec3,
    /// Point that it looks at, in the middle of the film.
    pub center: Vec3,
    /// Up direction.
    pub up: Vec3,
    /// Vertical field of view in radians, in (0, pi).
    pub fov_y: f32,
}

impl Pinhole {
    /// Creates a camera at `eye` that looks at `center`; `fov_y` is the vertical field of view in
    /// radians.
    pub const fn new(eye: Vec3, center: Vec3, up: Vec3, fov_y: f32) -> Self {
        Self { eye, center, up, fov_y }
    }

    pub(super) fn basis(&self) -> Basis {
        Basis::new(self.eye, self.center, self.up)
    }
}

/// Ray generation of a pinhole camera for a film.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct PinholeRays {
    /// Origin of all rays.
    pub origin: Vec3,
    /// Vector from the origin to the film's corner (0, 0).
    pub corner: Vec3,
    /// Step of one pixel to the right.
    pub right: Vec3,
    /// Step of one pixel up.
    pub up: Vec3,
}

impl Camera for Pinhole {
    type Rays = PinholeRays;

    fn begin_frame(&self, width: u32, height: u32) -> PinholeRays {
        let Basis { right, up, forward } = self.basis();
        let pixel = pixel_size(self.fov_y, height);
        let half = |n: u32| (0.5 * f64::from(n) * pixel) as f32;
        PinholeRays {
            origin: self.eye,
            corner: forward - right * half(width) - up * half(height),
            right: right * pixel as f32,
            up: up * pixel as f32,
        }
    }
}

#[kernel]
impl CameraRays for PinholeRays {
    /// Returns the ray through the point (`x`, `y`) of the film; its direction has unit length.
    fn primary_ray(&self, x: f32, y: f32) -> Ray {
        let direction = (self.corner + self.right * x + self.up * y).normalize();
        Ray { origin: self.origin, direction, t_min: 0.0, t_max: f32::MAX }
    }

    /// Returns the primary ray: there is no lens.
    fn lens_ray(&self, x: f32, y: f32, _u: Vec2) -> Ray {
        self.primary_ray(x, y)
    }
}
