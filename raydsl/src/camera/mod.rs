//! Cameras: rays through points of a film.
//!
//! | camera | projection |
//! |---|---|
//! | [`Pinhole`] | perspective, sharp everywhere |
//! | [`ThinLens`] | perspective, sharp at one distance |
//! | [`Orthographic`] | parallel rays |
//! | [`Matrix`] | given by the matrices of a rasteriser |
//! | [`Stereo`] | a pinhole for each eye |
//!
//! Degenerate input has a defined result. Where `eye` and `center` coincide, the view is along -z;
//! where `up` is parallel to the view, some direction perpendicular to it is up. Fields of view are
//! clamped to the range from 1e-6 to pi - 1e-6; those of nearly half a turn work. A film may have
//! any size.

mod basis;
mod matrix;
mod orthographic;
mod pinhole;
mod stereo;
mod thin_lens;

pub use matrix::{CameraError, DepthRange, Matrix, MatrixRays, MatrixRaysOn};
pub use orthographic::{Orthographic, OrthographicRays, OrthographicRaysOn};
pub use pinhole::{Pinhole, PinholeRays, PinholeRaysOn};
pub use stereo::{Eye, Stereo};
pub use thin_lens::{ThinLens, ThinLensRays, ThinLensRaysOn};

use glam::Vec2;

use crate::geometry::Ray;
use crate::kernel;

/// Camera that generates rays for the pixels of a film.
///
/// Film coordinates are in pixels: `x` to the right, `y` upwards, so row 0 is the bottom one, and
/// the centre of pixel (0, 0) is at (0.5, 0.5).
pub trait Camera {
    /// Ray generation for a film.
    type Rays: CameraRays;

    /// Prepares ray generation for a film of `width` by `height` pixels.
    fn begin_frame(&self, width: u32, height: u32) -> Self::Rays;
}

/// Ray generation of a camera for a film: a kernel from a point to a ray.
///
/// Kernels may capture one, and generate rays of their own. A user-defined camera is a struct with
/// `#[derive(Type)]` and a `#[kernel] impl CameraRays`.
#[kernel]
pub trait CameraRays: Send + Sync {
    /// Whether [`lens_ray`](Self::lens_ray) uses the point of the lens. If not, none need be
    /// sampled.
    const HAS_LENS: bool = false;

    /// Returns the ray through the point (`x`, `y`) of the film; through the middle of the lens, if
    /// there is one.
    fn primary_ray(&self, x: f32, y: f32) -> Ray;

    /// Returns the ray through the point (`x`, `y`) of the film and the lens point of a uniform `u`
    /// in the unit square. Without a lens it is the primary ray.
    fn lens_ray(&self, x: f32, y: f32, _u: Vec2) -> Ray {
        self.primary_ray(x, y)
    }
}
