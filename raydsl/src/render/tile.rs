//! The pixels of a rectangle, by one variant.

use crate::camera::CameraRays;
use crate::geometry::Ray;
use crate::kernel::{Kernel, PacketKernel, PacketTask, Variant};
use crate::machine::{F, F32Binary, IntBinary, Lanes, Packet, Type};

/// A rectangle of the film: columns `x .. x + width`, rows `y .. y + height`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rect {
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) width: u32,
    pub(super) height: u32,
}

/// Renders the pixels of `rect` into `rows`, its rows of the film.
pub(super) fn render<C: CameraRays, R: Type>(
    camera: &C,
    kernel: &Kernel<'_, (Ray,), R>,
    variant: Variant,
    rect: Rect,
    rows: &mut [&mut [R]],
) {
    match variant {
        Variant::Wgsl => panic!("WGSL runs on a device: use raydsl::gpu::GpuScheduler"),
        Variant::Scalar => {
            for (row, y) in rows.iter_mut().zip(rect.y..) {
                for (pixel, x) in row.iter_mut().zip(rect.x..) {
                    let ray = camera.primary_ray(x as f32 + 0.5, y as f32 + 0.5);
                    *pixel = kernel.call((ray,));
                }
            }
        }
        packet => kernel.with_packets(packet, Tile { camera, rect, rows }),
    }
}

struct Tile<'a, 'r, C, R> {
    camera: &'a C,
    rect: Rect,
    rows: &'a mut [&'r mut [R]],
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

/// The centres of the pixels from `start` on, `offsets` apart.
#[inline(always)]
fn centers<L: Lanes>(l: L, start: u32, offsets: L::U32) -> F<Packet<L>> {
    let pixels = l.u32_binary(IntBinary::WrappingAdd, l.u32(start), offsets);
    F(l.f32_binary(F32Binary::Add, l.u32_to_f32(pixels), l.f32(0.5)))
}

impl<C: CameraRays, R: Type> PacketTask<(Ray,), R> for Tile<'_, '_, C, R> {
    type Output = ();

    fn run<L: Lanes>(self, lanes: L, kernel: &PacketKernel<'_, L, (Ray,), R>) {
        let Self { camera, rect, rows } = self;
        let (bw, bh) = const { block(L::N) };
        lanes.vectorize(
            #[inline(always)]
            || {
                let columns = lanes.u32_from_fn(|l| l as u32 % bw);
                let lines = lanes.u32_from_fn(|l| l as u32 / bw);
                for by in (0..rect.height).step_by(bh as usize) {
                    for bx in (0..rect.width).step_by(bw as usize) {
                        // At the film's edge a packet is partly filled.
                        let (width, height) = (bw.min(rect.width - bx), bh.min(rect.height - by));
                        let m = Packet::with_bits(lanes, lanes_within(width, height, bw));
                        let x = centers(lanes, rect.x + bx, columns);
                        let y = centers(lanes, rect.y + by, lines);
                        let ray = C::primary_ray_on(&m, C::splat(&m, *camera), x, y);
                        let result = kernel(&m, (ray,));
                        for j in 0..height {
                            let row = &mut rows[(by + j) as usize][bx as usize..][..width as usize];
                            for (pixel, i) in row.iter_mut().zip(0..) {
                                *pixel = R::lane(&result, (j * bw + i) as usize);
                            }
                        }
                    }
                }
            },
        );
    }
}

/// The lanes of a block of `bw` columns that lie in its first `width` columns and `height` lines.
#[inline(always)]
fn lanes_within(width: u32, height: u32, bw: u32) -> u64 {
    let line = (1 << width) - 1;
    (0..height).fold(0, |bits, j| bits | line << (j * bw))
}
