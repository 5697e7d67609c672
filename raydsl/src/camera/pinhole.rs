//! The pinhole camera.

use glam::Vec3;

use super::{Camera, CameraRays};
use crate::geometry::{Ray, RayOn};
use crate::machine::{F, Machine};
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
        let forward = (self.center - self.eye).normalize();
        let side = forward.cross(self.up).normalize();
        let up = side.cross(forward);
        let pixel = 2.0 * (f64::from(self.fov_y) * 0.5).tan() / f64::from(height.max(1));
        let (w, h) = (f64::from(width), f64::from(height));
        let half = |n: f64| (0.5 * n * pixel) as f32;
        PinholeRays {
            origin: self.eye,
            corner: forward - side * half(w) - up * half(h),
            right: side * pixel as f32,
            up: up * pixel as f32,
        }
    }
}

#[kernel]
impl PinholeRays {
    /// The ray through the point (`x`, `y`) of the film; its direction has unit length.
    pub fn primary_ray(&self, x: f32, y: f32) -> Ray {
        let direction = (self.corner + self.right * x + self.up * y).normalize();
        Ray { origin: self.origin, direction, t_min: 0.0, t_max: f32::MAX }
    }
}

impl CameraRays for PinholeRays {
    #[inline]
    fn primary_ray(&self, x: f32, y: f32) -> Ray {
        Self::primary_ray(self, x, y)
    }

    #[inline(always)]
    fn primary_ray_on<M: Machine>(m: &M, this: PinholeRaysOn<M>, x: F<M>, y: F<M>) -> RayOn<M> {
        Self::primary_ray_on(m, this, x, y)
    }
}
