//! One pixel, or one packet, after the other.

use super::tile::{Rect, render};
use super::{Image, Scheduler};
use crate::camera::Camera;
use crate::geometry::Ray;
use crate::kernel::{Kernel, Variant};
use crate::machine::Type;

/// Runs on the calling thread.
#[derive(Clone, Copy, Debug)]
pub struct SimpleScheduler {
    variant: Variant,
}

impl Default for SimpleScheduler {
    fn default() -> Self {
        Self::new()
    }
}

impl SimpleScheduler {
    /// Runs the user's own function: the variant that a debugger steps through.
    pub const fn new() -> Self {
        Self { variant: Variant::Scalar }
    }

    /// Runs another variant of the CPU; [`Variant::Wgsl`] needs a device and panics here.
    pub const fn variant(self, variant: Variant) -> Self {
        Self { variant }
    }
}

impl Scheduler for SimpleScheduler {
    fn frame<C: Camera, R: Type + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, (Ray,), R>,
        image: &mut Image<R>,
    ) {
        let (width, height) = (image.width(), image.height());
        if width == 0 || height == 0 {
            return;
        }
        let rays = camera.begin_frame(width, height);
        let mut rows: Vec<&mut [R]> = image.pixels_mut().chunks_mut(width as usize).collect();
        render(&rays, kernel, self.variant, Rect { x: 0, y: 0, width, height }, &mut rows);
    }
}
