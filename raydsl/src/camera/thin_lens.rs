//! A camera with a lens.

use glam::{Vec2, Vec3};

use super::basis::Basis;
use super::{Camera, CameraRays, Pinhole, PinholeRays};
use crate::geometry::Ray;
use crate::sampling::sample_concentric_disk;
use crate::{Type, kernel};

/// A camera that sees sharp what lies in one plane, and all else the more blurred the wider its
/// lens is.
///
/// An ideal lens (Potmesil and Chakravarty, "A Lens and Aperture Camera Model for Synthetic Image
/// Generation", 1981): all rays through a point of the film meet in the plane of focus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLens {
    /// The camera without the lens: what is in focus is seen where this sees it.
    pub pinhole: Pinhole,
    /// The radius of the lens, in units of the scene; with 0 everything is sharp.
    pub lens_radius: f32,
    /// How far away the plane of focus is, along the view. Infinity is allowed; what is not
    /// positive counts as infinity.
    pub focal_distance: f32,
}

impl ThinLens {
    /// A camera with a lens in place of the hole.
    pub const fn new(pinhole: Pinhole, lens_radius: f32, focal_distance: f32) -> Self {
        Self { pinhole, lens_radius, focal_distance }
    }
}

/// A thin lens prepared for a film.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct ThinLensRays {
    /// The rays through the middle of the lens.
    pub middle: PinholeRays,
    /// From the middle of the lens to its right edge.
    pub lens_right: Vec3,
    /// From the middle of the lens to its upper edge.
    pub lens_up: Vec3,
    /// 1 / the distance of the plane of focus.
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

    /// The ray through the middle of the lens.
    fn primary_ray(&self, x: f32, y: f32) -> Ray {
        self.middle.primary_ray(x, y)
    }

    /// The ray through a point of the lens: a uniform `u` gives a uniform one.
    fn lens_ray(&self, x: f32, y: f32, u: Vec2) -> Ray {
        let at = sample_concentric_disk(u);
        let offset = self.lens_right * at.x + self.lens_up * at.y;
        // To the point in focus, divided by its distance.
        let through_middle = self.middle.corner + self.middle.right * x + self.middle.up * y;
        let direction = (through_middle - offset * self.nearness).normalize();
        Ray { origin: self.middle.origin + offset, direction, t_min: 0.0, t_max: f32::MAX }
    }
}
