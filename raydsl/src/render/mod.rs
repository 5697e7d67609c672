//! From kernels to pictures.

mod image;
mod simple;
mod tile;
mod tiled;

pub use image::{Image, Shaded, ShadedOn};
pub use simple::SimpleScheduler;
pub use tiled::TiledScheduler;

use crate::camera::Camera;
use crate::geometry::Ray;
use crate::kernel::Kernel;
use crate::machine::Type;

/// Runs a kernel for every pixel of a film.
pub trait Scheduler {
    /// Renders a frame: `image`'s size is the film's.
    fn frame<C: Camera, R: Type + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, (Ray,), R>,
        image: &mut Image<R>,
    );
}
