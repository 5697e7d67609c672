//! Tiles on all threads.

use super::tile::{Rect, render};
use super::{Image, Scheduler};
use crate::camera::Camera;
use crate::geometry::Ray;
use crate::kernel::{Kernel, Variant};
use crate::machine::Type;

/// Edge of a tile in pixels.
const TILE: u32 = 16;

/// Runs tiles of 16 by 16 pixels, on all threads of the current rayon pool with the feature
/// `parallel`, else on the calling one. The image is the same either way.
#[derive(Clone, Copy, Debug)]
pub struct TiledScheduler {
    variant: Variant,
}

impl Default for TiledScheduler {
    fn default() -> Self {
        Self::new()
    }
}

impl TiledScheduler {
    /// Runs the widest packets of this machine.
    pub fn new() -> Self {
        Self { variant: Variant::widest() }
    }

    /// Runs another variant of the CPU; [`Variant::Wgsl`] needs a device and panics here.
    pub const fn variant(self, variant: Variant) -> Self {
        Self { variant }
    }
}

/// The rows of one tile.
struct Tile<'a, R> {
    rect: Rect,
    rows: Vec<&'a mut [R]>,
}

/// Cuts the film into tiles, row by row of tiles.
fn tiles<R>(pixels: &mut [R], width: u32) -> Vec<Tile<'_, R>> {
    let mut all = Vec::new();
    let band = width as usize * TILE as usize;
    for (j, band) in pixels.chunks_mut(band).enumerate() {
        let columns = width.div_ceil(TILE) as usize;
        let height = (band.len() / width as usize) as u32;
        let first = all.len();
        all.extend((0..columns as u32).map(|i| Tile {
            rect: Rect {
                x: i * TILE,
                y: j as u32 * TILE,
                width: TILE.min(width - i * TILE),
                height,
            },
            rows: Vec::with_capacity(height as usize),
        }));
        for row in band.chunks_mut(width as usize) {
            for (tile, part) in all[first..].iter_mut().zip(row.chunks_mut(TILE as usize)) {
                tile.rows.push(part);
            }
        }
    }
    all
}

impl Scheduler for TiledScheduler {
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
        let variant = self.variant;
        let run = |tile: &mut Tile<'_, R>| {
            render(&rays, kernel, variant, tile.rect, &mut tile.rows);
        };
        let mut tiles = tiles(image.pixels_mut(), width);
        #[cfg(feature = "parallel")]
        {
            use rayon::prelude::*;
            tiles.par_iter_mut().for_each(run);
        }
        #[cfg(not(feature = "parallel"))]
        tiles.iter_mut().for_each(run);
    }
}
