//! Thin-lens camera: depth of field.

use glam::{Vec2, Vec3};

use super::basis::Basis;
use super::{Camera, CameraRays, Pinhole, PinholeRays};
use crate::geometry::Ray;
use crate::sampling::sample_concentric_disk;
use crate::{Type, kernel};

/// Thin-lens camera: sharp in one plane, and blurred elsewhere in proportion to the lens radius.
///
/// An ideal lens (Potmesil and Chakravarty, "A Lens and Aperture Camera Model for Synthetic Image
/// Generation", 1981): all rays through a point of the film meet in the plane of focus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLens {
    /// Camera without the lens; points in focus appear where it sees them.
    pub pinhole: Pinhole,
    /// Radius of the lens, in units of the scene; with 0 everything is sharp.
    pub lens_radius: f32,
    /// Distance of the plane of focus, along the view. Infinity is allowed; values that are not
    /// positive count as infinity.
    pub focal_distance: f32,
}

impl ThinLens {
    /// Creates a camera with a lens in place of the pinhole.
    pub const fn new(pinhole: Pinhole, lens_radius: f32, focal_distance: f32) -> Self {
        Self { pinhole, lens_radius, focal_distance }
    }
}

/// Ray generation of a thin-lens camera for a film.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct ThinLensRays {
    /// Ray generation through the middle of the lens.
    pub middle: PinholeRays,
    /// Vector from the middle of the lens to its right edge.
    pub lens_right: Vec3,
    /// Vector from the middle of the lens to its upper edge.
    pub lens_up: Vec3,
    /// Reciprocal of the focal distance.
    pub nearness: f32,
}

impl Camera for ThinLens {
    type Rays = ThinLensRays;

    fn begin_frame(&self, width: u32, height: u32) -> ThinLensRays {
        let Basis { right, up, .. } = self.pinhole.basis();
        ThinLensRays {
            middle: self.pinhole.begin_frame(width, height),
            lens_right: right * self.lens_radius,
            lens_up: up * self.lens_radius,
            nearness: if self.focal_distance > 0.0 { self.focal_distance.recip() } else { 0.0 },
        }
    }
}

#[kernel]
impl CameraRays for ThinLensRays {
    const HAS_LENS: bool = true;

    /// Returns the ray through the middle of the lens.
    fn primary_ray(&self, x: f32, y: f32) -> Ray {
        self.middle.primary_ray(x, y)
    }

    /// Returns the ray through a point of the lens, uniform for a uniform `u`.
    fn lens_ray(&self, x: f32, y: f32, u: Vec2) -> Ray {
        let at = sample_concentric_disk(u);
        let offset = self.lens_right * at.x + self.lens_up * at.y;
        // Vector to the point in focus, divided by its distance.
        let through_middle = self.middle.corner + self.middle.right * x + self.middle.up * y;
        let direction = (through_middle - offset * self.nearness).normalize();
        Ray { origin: self.middle.origin + offset, direction, t_min: 0.0, t_max: f32::MAX }
    }
}
