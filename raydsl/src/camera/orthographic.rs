//! Parallel rays.

use glam::{Vec2, Vec3};

use super::basis::Basis;
use super::{Camera, CameraRays};
use crate::geometry::Ray;
use crate::{Type, kernel};

/// A camera whose rays are parallel: what is far away is as large as what is near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    /// The middle of the film; what is behind it is not seen.
    pub eye: Vec3,
    /// What the middle of the film sees.
    pub center: Vec3,
    /// Which way is up.
    pub up: Vec3,
    /// The film's height, in units of the scene.
    pub height: f32,
}

impl Orthographic {
    /// A camera at `eye` that looks at `center`, and sees so much from the bottom to the top.
    pub const fn new(eye: Vec3, center: Vec3, up: Vec3, height: f32) -> Self {
        Self { eye, center, up, height }
    }
}

/// An orthographic camera prepared for a film.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct OrthographicRays {
    /// The film's corner (0, 0).
    pub corner: Vec3,
    /// One pixel to the right.
    pub right: Vec3,
    /// One pixel up.
    pub up: Vec3,
    /// The direction of all rays, with unit length.
    pub direction: Vec3,
}

impl Camera for Orthographic {
    type Rays = OrthographicRays;

    fn begin_frame(&self, width: u32, height: u32) -> OrthographicRays {
        let Basis { right, up, forward } = Basis::new(self.eye, self.center, self.up);
        let pixel = f64::from(self.height) / f64::from(height.max(1));
        let half = |n: u32| (0.5 * f64::from(n) * pixel) as f32;
        OrthographicRays {
            corner: self.eye - right * half(width) - up * half(height),
            right: right * pixel as f32,
            up: up * pixel as f32,
            direction: forward,
        }
    }
}

#[kernel]
impl CameraRays for OrthographicRays {
    /// The ray from the point (`x`, `y`) of the film.
    fn primary_ray(&self, x: f32, y: f32) -> Ray {
        let origin = self.corner + self.right * x + self.up * y;
        Ray { origin, direction: self.direction, t_min: 0.0, t_max: f32::MAX }
    }

    /// The primary ray: there is no lens.
    fn lens_ray(&self, x: f32, y: f32, _u: Vec2) -> Ray {
        self.primary_ray(x, y)
    }
}
