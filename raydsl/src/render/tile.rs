//! The pixels of a rectangle, by one variant.

use glam::{UVec2, uvec2};

use super::{Image, Shot};
use crate::kernel::{PacketKernel, PacketTask, Variant};
use crate::machine::{Lanes, Packet, Type, U, X2, op};

/// Edge of a tile in pixels, unless a scheduler has another.
pub(super) const TILE: u32 = 16;

/// A rectangle of a film, and its pixels: what a scheduler hands out. See [`Image::tiles`].
#[derive(Debug)]
pub struct Tile<'a, R> {
    x: u32,
    y: u32,
    width: u32,
    rows: Vec<&'a mut [R]>,
}

impl<R: Type> Image<R> {
    /// Cuts the image into tiles of `edge` by `edge` pixels, row by row of tiles from the bottom;
    /// those at the end of rows and columns may be smaller. An edge of 0 is taken as 1.
    pub fn tiles(&mut self, edge: u32) -> Vec<Tile<'_, R>> {
        let (width, edge) = (self.width(), edge.max(1));
        if width == 0 {
            return Vec::new();
        }
        let mut all = Vec::new();
        let band = (width as usize).saturating_mul(edge as usize);
        for (y, band) in (0..).step_by(edge as usize).zip(self.pixels_mut().chunks_mut(band)) {
            let first = all.len();
            all.extend((0..width).step_by(edge as usize).map(|x| Tile {
                x,
                y,
                width: edge.min(width - x),
                rows: Vec::with_capacity(band.len() / width as usize),
            }));
            for row in band.chunks_mut(width as usize) {
                for (tile, part) in all[first..].iter_mut().zip(row.chunks_mut(edge as usize)) {
                    tile.rows.push(part);
                }
            }
        }
        all
    }
}

impl<R> Tile<'_, R> {
    /// The column and the row of its lower left pixel.
    pub fn origin(&self) -> UVec2 {
        uvec2(self.x, self.y)
    }

    /// Its width and height.
    pub fn size(&self) -> UVec2 {
        uvec2(self.width, self.rows.len() as u32)
    }

    /// The number of pixels.
    pub fn area(&self) -> usize {
        self.width as usize * self.rows.len()
    }

    /// Runs a shot for its pixels, by a variant of the CPU; [`Variant::Wgsl`] needs a device and
    /// panics here.
    pub fn render<S: Shot<Output = R>>(&mut self, shot: &S, variant: Variant) {
        match variant {
            Variant::Wgsl => panic!("WGSL runs on a device: use raydsl::gpu::GpuScheduler"),
            Variant::Scalar => {
                for (row, y) in self.rows.iter_mut().zip(self.y..) {
                    for (pixel, x) in row.iter_mut().zip(self.x..) {
                        *pixel = shot.pixel(uvec2(x, y));
                    }
                }
            }
            packet => shot.kernel().with_packets(packet, Packets { shot, tile: self }),
        }
    }
}

struct Packets<'a, 'r, S: Shot> {
    shot: &'a S,
    tile: &'a mut Tile<'r, S::Output>,
}

/// The rectangle of pixels that a packet of `n` lanes covers.
const fn block(n: usize) -> (u32, u32) {
    match n {
        4 => (2, 2),
        8 => (4, 2),
        16 => (4, 4),
        32 => (8, 4),
        64 => (8, 8),
        n => (n as u32, 1),
    }
}

impl<S: Shot> PacketTask<S::Args, S::Result> for Packets<'_, '_, S> {
    type Output = ();

    fn run<L: Lanes>(self, lanes: L, kernel: &PacketKernel<'_, L, S::Args, S::Result>) {
        let Self { shot, tile } = self;
        let (bw, bh) = const { block(L::N) };
        let UVec2 { x: width, y: height } = tile.size();
        lanes.vectorize(
            #[inline(always)]
            || {
                let columns = lanes.u32_from_fn(|l| l as u32 % bw);
                let lines = lanes.u32_from_fn(|l| l as u32 / bw);
                for by in (0..height).step_by(bh as usize) {
                    for bx in (0..width).step_by(bw as usize) {
                        // At the tile's edge a packet is partly filled.
                        let (across, up) = (bw.min(width - bx), bh.min(height - by));
                        let m = Packet::with_bits(lanes, lanes_within(across, up, bw));
                        let x = from(lanes, tile.x + bx, columns);
                        let y = from(lanes, tile.y + by, lines);
                        let result = shot.pixel_on(&m, X2 { x, y }, &|m, args| kernel(m, args));
                        for j in 0..up {
                            let row = &mut tile.rows[(by + j) as usize];
                            let row = &mut row[bx as usize..][..across as usize];
                            for (pixel, i) in row.iter_mut().zip(0..) {
                                *pixel = S::Output::lane(&result, (j * bw + i) as usize);
                            }
                        }
                    }
                }
            },
        );
    }
}

/// The pixels that lie `offsets` from `start`.
#[inline(always)]
fn from<L: Lanes>(l: L, start: u32, offsets: L::U32) -> U<Packet<L>> {
    U(l.u32_binary(op::WrappingAdd, l.u32(start), offsets))
}

/// The lanes of a block of `bw` columns that lie in its first `width` columns and `height` lines.
#[inline(always)]
fn lanes_within(width: u32, height: u32, bw: u32) -> u64 {
    let line = (1 << width) - 1;
    (0..height).fold(0, |bits, j| bits | line << (j * bw))
}
