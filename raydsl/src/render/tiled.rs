//! Tiles on all threads.

use super::tile::TILE;
use super::watch::Watch;
use super::{Image, Scheduler, Shot};
use crate::kernel::{Kernel, Variant};
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
}

impl Default for TiledScheduler {
    fn default() -> Self {
        Self::new()
    }
}

impl TiledScheduler {
    /// Runs the widest packets of this machine.
    pub fn new() -> Self {
        Self { variant: Variant::widest(), edge: TILE }
    }

    /// Runs another variant of the CPU; [`Variant::Wgsl`] needs a device and panics here.
    pub const fn variant(self, variant: Variant) -> Self {
        Self { variant, ..self }
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
                tile.render(shot, self.variant);
                watch.advance(tile.area());
            }
        });
    }

    fn batch<A: Type + Sync, R: Type + Send>(
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
            parts.for_each(|(inputs, outputs)| kernel.run(self.variant, inputs, outputs));
        }
        #[cfg(not(feature = "parallel"))]
        kernel.run(self.variant, inputs, outputs);
    }
}
