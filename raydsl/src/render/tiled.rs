//! Tiles on all threads.

use super::tile::TILE;
use super::watch::Watch;
use super::{Image, Scheduler, Shot};
use crate::kernel::{GANG, Kernel, Variant};
use crate::machine::Type;

/// Elements of a batch that a thread takes at once.
#[cfg(feature = "parallel")]
const BATCH: usize = 1024;

/// Runs tiles, on all threads of the current rayon pool with the feature
/// `parallel`, else on the calling one. The image is the same either way.
#[derive(Clone, Copy, Debug)]
pub struct TiledScheduler {
    variant: Variant,
    edge: u32,
    gang: usize,
}

impl Default for TiledScheduler {
    fn default() -> Self {
        Self::new()
    }
}

impl TiledScheduler {
    /// Runs the widest packets of this machine.
    pub fn new() -> Self {
        Self { variant: Variant::widest(), edge: TILE, gang: GANG }
    }

    /// Runs another variant of the CPU; [`Variant::Wgsl`] needs a device and panics here.
    pub const fn variant(self, variant: Variant) -> Self {
        Self { variant, ..self }
    }

    /// Gangs of `lanes`, whose packets wait for each other so that trees are asked about more rays at
    /// once: [`GANG`] unless this is called, and packets on their own with 0. See
    /// [`Kernel::run_in_gangs`].
    pub const fn gang(self, lanes: usize) -> Self {
        Self { gang: lanes, ..self }
    }

    /// Tiles of `edge` by `edge` pixels: 16 unless this is called.
    pub const fn tile(self, edge: u32) -> Self {
        Self { edge, ..self }
    }
}

impl Scheduler for TiledScheduler {
    fn run<S: Shot>(&self, shot: &S, image: &mut Image<S::Output>, watch: &Watch<'_>) {
        image.tiles(self.edge).for_each_parallel(|mut tile| {
            if !watch.is_stopped() {
                tile.render_in_gangs(shot, self.variant, self.gang);
                watch.advance(tile.area());
            }
        });
    }

    fn run_batch<A: Type, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    ) {
        assert_eq!(inputs.len(), outputs.len(), "one output for each input");
        #[cfg(feature = "parallel")]
        {
            use rayon::prelude::*;
            let parts = inputs.par_chunks(BATCH).zip(outputs.par_chunks_mut(BATCH));
            parts.with_max_len(1).for_each(|(inputs, outputs)| {
                kernel.run_in_gangs(self.variant, self.gang, inputs, outputs)
            });
        }
        #[cfg(not(feature = "parallel"))]
        kernel.run_in_gangs(self.variant, self.gang, inputs, outputs);
    }
}
