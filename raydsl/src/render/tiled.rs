//! Tiles on all threads.

use super::tile::{TILE, Tile};
use super::watch::Watch;
use super::{Image, Scheduler, Shot};
use crate::kernel::{Kernel, Variant};
use crate::machine::Type;

/// Elements of a batch that a thread takes at once.
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
        let run = |tile: &mut Tile<'_, S::Output>| {
            if !watch.is_stopped() {
                tile.render(shot, self.variant);
                watch.advance(tile.area());
            }
        };
        for_each(&mut image.tiles(self.edge), run);
    }

    fn batch<A: Type + Sync, R: Type + Send>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    ) {
        assert_eq!(inputs.len(), outputs.len(), "one output for each input");
        let mut parts: Vec<_> = inputs.chunks(BATCH).zip(outputs.chunks_mut(BATCH)).collect();
        for_each(&mut parts, |(inputs, outputs)| kernel.run(self.variant, inputs, outputs));
    }
}

/// Runs `f` for each item, on all threads of the pool if there are any.
fn for_each<T: Send>(items: &mut [T], f: impl Fn(&mut T) + Sync) {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        items.par_iter_mut().for_each(&f);
    }
    #[cfg(not(feature = "parallel"))]
    items.iter_mut().for_each(f);
}
