//! A parallel scheduler over tiles.

use super::tile::TILE;
use super::watch::Watch;
use super::{Image, Scheduler, Shot};
use crate::kernel::{GANG, Kernel, Variant};
use crate::machine::Type;

/// Batch elements per parallel task.
#[cfg(feature = "parallel")]
const BATCH: usize = 1024;

/// A scheduler that renders tiles in parallel on the current rayon pool with the feature
/// `parallel`, else one after another on the calling thread. The image is the same either way.
#[derive(Clone, Copy, Debug)]
pub struct TiledScheduler {
    pub(super) variant: Variant,
    pub(super) edge: u32,
    pub(super) gang: usize,
}

impl Default for TiledScheduler {
    fn default() -> Self {
        Self::new()
    }
}

impl TiledScheduler {
    /// Creates a scheduler for the widest packets of this machine.
    pub fn new() -> Self {
        Self { variant: Variant::widest(), edge: TILE, gang: GANG }
    }

    /// Sets the CPU variant; [`Variant::Wgsl`] needs a device and panics here.
    pub const fn variant(self, variant: Variant) -> Self {
        Self { variant, ..self }
    }

    /// Sets the lanes of a gang, whose packets answer queries of wide trees in batches: [`GANG`]
    /// unless set, and 0 for packets without gangs. See [`Kernel::run_in_gangs`].
    pub const fn gang(self, lanes: usize) -> Self {
        Self { gang: lanes, ..self }
    }

    /// Sets the edge of a tile in pixels: 16 unless set.
    pub const fn tile(self, edge: u32) -> Self {
        Self { edge, ..self }
    }
}

impl Scheduler for TiledScheduler {
    fn run<S: Shot>(&self, shot: &S, image: &mut Image<S::Output>, watch: &Watch<'_>) {
        // Each tile is one task; after a stop the remaining tiles are skipped.
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
            // Each task has `BATCH` elements, and any of them may be stolen.
            let parts = inputs.par_chunks(BATCH).zip(outputs.par_chunks_mut(BATCH));
            parts.with_max_len(1).for_each(|(inputs, outputs)| {
                kernel.run_in_gangs(self.variant, self.gang, inputs, outputs)
            });
        }
        #[cfg(not(feature = "parallel"))]
        kernel.run_in_gangs(self.variant, self.gang, inputs, outputs);
    }
}
