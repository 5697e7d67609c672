//! Orthographic camera: parallel primary rays.

use glam::{Vec2, Vec3};

use super::basis::Basis;
use super::{Camera, CameraRays};
use crate::geometry::Ray;
use crate::{Type, kernel};

/// Orthographic camera: objects have the same size at any distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    /// Middle of the film; geometry behind it is not seen.
    pub eye: Vec3,
    /// Point seen in the middle of the film.
    pub center: Vec3,
    /// Up direction.
    pub up: Vec3,
    /// Height of the film, in units of the scene.
    pub height: f32,
}

impl Orthographic {
    /// Creates a camera at `eye` that looks at `center`, with a film of this height.
    pub const fn new(eye: Vec3, center: Vec3, up: Vec3, height: f32) -> Self {
        Self { eye, center, up, height }
    }
}

/// Ray generation of an orthographic camera for a film.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct OrthographicRays {
    /// Corner (0, 0) of the film.
    pub corner: Vec3,
    /// Step of one pixel to the right.
    pub right: Vec3,
    /// Step of one pixel up.
    pub up: Vec3,
    /// Direction of all rays, with unit length.
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
    /// Returns the ray from the point (`x`, `y`) of the film.
    fn primary_ray(&self, x: f32, y: f32) -> Ray {
        let origin = self.corner + self.right * x + self.up * y;
        Ray { origin, direction: self.direction, t_min: 0.0, t_max: f32::MAX }
    }

    /// Returns the primary ray: there is no lens.
    fn lens_ray(&self, x: f32, y: f32, _u: Vec2) -> Ray {
        self.primary_ray(x, y)
    }
}
