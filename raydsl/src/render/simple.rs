//! A scheduler for one thread.

use super::tile::TILE;
use super::watch::Watch;
use super::{Image, Scheduler, Shot};
use crate::kernel::{Kernel, Variant};
use crate::machine::Type;

/// A scheduler that runs on the calling thread, without gangs of packets.
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
    fn run<S: Shot>(&self, shot: &S, image: &mut Image<S::Output>, watch: &Watch<'_>) {
        for mut tile in image.tiles(TILE) {
            if watch.is_stopped() {
                return;
            }
            tile.render_in_gangs(shot, self.variant, 0);
            watch.advance(tile.area());
        }
    }

    fn run_batch<A: Type, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    ) {
        kernel.run_in_gangs(self.variant, 0, inputs, outputs);
    }
}
