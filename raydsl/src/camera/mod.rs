//! Cameras: from a point of the film to a ray.

mod pinhole;

pub use pinhole::{Pinhole, PinholeRays, PinholeRaysOn};

use crate::geometry::{Ray, RayOn};
use crate::machine::{F, Machine, Type};

/// Makes rays for the pixels of a film.
///
/// Film coordinates count in pixels: `x` to the right, `y` upwards, so row 0 is the bottom one, and
/// the centre of pixel (0, 0) is at (0.5, 0.5).
pub trait Camera {
    /// The camera, prepared for a film.
    type Rays: CameraRays;

    /// Prepares for a film of `width` by `height` pixels.
    fn begin_frame(&self, width: u32, height: u32) -> Self::Rays;
}

/// A camera prepared for a film: a kernel from a point to a ray.
pub trait CameraRays: Type + Send + Sync {
    /// The ray through the point (`x`, `y`) of the film.
    fn primary_ray(&self, x: f32, y: f32) -> Ray;

    /// `primary_ray`, lifted.
    #[doc(hidden)]
    fn primary_ray_on<M: Machine>(m: &M, this: Self::On<M>, x: F<M>, y: F<M>) -> RayOn<M>;

    /// Brings the camera to the machine.
    #[doc(hidden)]
    fn on<M: Machine>(&self, m: &M) -> Self::On<M> {
        m.capture("camera", *self)
    }
}
