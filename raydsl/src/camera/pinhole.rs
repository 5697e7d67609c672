//! The pinhole camera.

use glam::{Vec2, Vec3};

use super::basis::{Basis, pixel_size};
use super::{Camera, CameraRays};
use crate::geometry::Ray;
use crate::{Type, kernel};

/// A camera that sees everything sharp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinhole {
    /// Where the camera is.
    pub eye: Vec3,
    /// What it looks at: the middle of the film.
    pub center: Vec3,
    /// Which way is up.
    pub up: Vec3,
    /// Vertical field of view in radians, in (0, pi).
    pub fov_y: f32,
}

impl Pinhole {
    /// A camera at `eye` that looks at `center`; `fov_y` is the vertical field of view in radians.
    pub const fn new(eye: Vec3, center: Vec3, up: Vec3, fov_y: f32) -> Self {
        Self { eye, center, up, fov_y }
    }

    pub(super) fn basis(&self) -> Basis {
        Basis::new(self.eye, self.center, self.up)
    }
}

/// A pinhole camera prepared for a film.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct PinholeRays {
    /// Where all rays start.
    pub origin: Vec3,
    /// From the origin to the film's corner (0, 0).
    pub corner: Vec3,
    /// One pixel to the right.
    pub right: Vec3,
    /// One pixel up.
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
    /// The ray through the point (`x`, `y`) of the film; its direction has unit length.
    fn primary_ray(&self, x: f32, y: f32) -> Ray {
        let direction = (self.corner + self.right * x + self.up * y).normalize();
        Ray { origin: self.origin, direction, t_min: 0.0, t_max: f32::MAX }
    }

    /// The primary ray: there is no lens.
    fn lens_ray(&self, x: f32, y: f32, _u: Vec2) -> Ray {
        self.primary_ray(x, y)
    }
}
