//! Tiles of an image, and their rendering by one variant.

use core::cell::RefCell;
use core::iter::FusedIterator;
use core::marker::PhantomData;
use core::ops::Range;
use core::ptr::NonNull;

use glam::{UVec2, uvec2};

use super::{Image, Shot};
use crate::kernel::{GANG, PacketKernel, PacketTask, Variant};
use crate::machine::{Lanes, Packet, Type, U, X2, op};
use crate::run::fibers;

/// The edge of a tile in pixels, unless a scheduler has another.
pub(super) const TILE: u32 = 16;

/// Rows of tiles in a band: consecutive tiles are close to each other in both directions.
const BAND: u32 = 8;

/// Rows of pixels in a band of packets: the packets of a gang of 64 lanes cover a square.
const GANG_EDGE: u32 = 8;

/// A rectangle of a film with its pixels, the unit of work of a scheduler. See [`Image::tiles`].
pub struct Tile<'a, R> {
    x: u32,
    y: u32,
    width: u32,
    height: u32,
    /// Its lower left pixel, and the number of pixels from one row to the next.
    first: NonNull<R>,
    stride: usize,
    image: PhantomData<&'a mut [R]>,
}

// SAFETY: a tile is a rectangle of an image that is borrowed exclusively, like `&mut [R]`.
unsafe impl<R: Send> Send for Tile<'_, R> {}
// SAFETY: as above.
unsafe impl<R: Sync> Sync for Tile<'_, R> {}

/// An iterator over the tiles of an image; see [`Image::tiles`].
#[derive(Debug)]
pub struct Tiles<'a, R> {
    grid: Grid<R>,
    /// The indices of the remaining tiles.
    numbers: Range<usize>,
    image: PhantomData<&'a mut [R]>,
}

/// The tile grid of an image.
#[derive(Debug)]
struct Grid<R> {
    pixels: NonNull<R>,
    /// In pixels.
    width: u32,
    height: u32,
    edge: u32,
}

// SAFETY: its pixels are only accessed through `Grid::tile`, whose caller guarantees safety.
unsafe impl<R: Send> Send for Grid<R> {}
// SAFETY: as above; tiles are sent to other threads.
unsafe impl<R: Send> Sync for Grid<R> {}

impl<R: Type> Image<R> {
    /// Splits the image into tiles of `edge` by `edge` pixels; those at the end of rows and columns
    /// may be smaller. An edge of 0 is taken as 1.
    ///
    /// They come in an order that keeps caches warm: column by column in bands of eight rows of
    /// tiles, from the bottom. This allocates nothing.
    pub fn tiles(&mut self, edge: u32) -> Tiles<'_, R> {
        let (width, height, edge) = (self.width(), self.height(), edge.max(1));
        let pixels = self.pixels_mut();
        let area = (width as usize).checked_mul(height as usize);
        assert_eq!(Some(pixels.len()), area, "an image has all its pixels");
        let grid = Grid { pixels: NonNull::from(pixels).cast(), width, height, edge };
        // At most the number of pixels.
        let numbers = 0..grid.blocks().count();
        Tiles { grid, numbers, image: PhantomData }
    }
}

/// The partition of a rectangle into blocks.
#[derive(Clone, Copy, Debug)]
struct Blocks {
    columns: u32,
    lines: u32,
}

impl Blocks {
    fn count(self) -> usize {
        self.columns as usize * self.lines as usize
    }

    /// Returns the column and the line of a block, unique for each index below their count: column
    /// by column in bands of `band` lines.
    fn place(self, number: usize, band: u32) -> UVec2 {
        // A band may have more blocks than 32 bits can count.
        let (number, of_band) = (number as u64, u64::from(self.columns) * u64::from(band));
        let first = (number / of_band) as u32 * band;
        let lines = u64::from(band.min(self.lines - first));
        let in_band = number % of_band;
        uvec2((in_band / lines) as u32, first + (in_band % lines) as u32)
    }
}

/// The places of all blocks in the order of their indices, without divisions.
#[derive(Clone, Copy, Debug)]
struct Places {
    blocks: Blocks,
    band: u32,
    next: UVec2,
    /// The first line of the band.
    first: u32,
}

impl Places {
    fn new(blocks: Blocks, band: u32) -> Self {
        Self { blocks, band, next: UVec2::ZERO, first: 0 }
    }

    /// Returns the next place; there are as many as blocks.
    fn next(&mut self) -> UVec2 {
        let place = self.next;
        self.next.y += 1;
        let end = self.blocks.lines.min(self.first.saturating_add(self.band));
        if self.next.y == end {
            self.next = uvec2(place.x + 1, self.first);
            if self.next.x == self.blocks.columns {
                self.first = end;
                self.next = uvec2(0, end);
            }
        }
        place
    }
}

impl<R> Grid<R> {
    fn blocks(&self) -> Blocks {
        let Self { width, height, edge, .. } = *self;
        Blocks { columns: width.div_ceil(edge), lines: height.div_ceil(edge) }
    }

    /// Returns the tile of an index.
    ///
    /// # Safety
    ///
    /// The image of this grid is borrowed mutably for `'a`; the index is below the number of its
    /// tiles, and its tile is given out only once. Tiles of different indices have no pixel in
    /// common.
    unsafe fn tile<'a>(&self, number: usize) -> Tile<'a, R> {
        let UVec2 { x, y } = self.blocks().place(number, BAND) * self.edge;
        let (width, height) = (self.edge.min(self.width - x), self.edge.min(self.height - y));
        let stride = self.width as usize;
        // SAFETY: `x` and `y` are below the width and the height of the image, so this is one of
        // its pixels.
        let first = unsafe { self.pixels.add(y as usize * stride + x as usize) };
        Tile { x, y, width, height, first, stride, image: PhantomData }
    }
}

impl<'a, R> Tiles<'a, R> {
    /// Runs `f` for each tile, on all threads of the current rayon pool if there are any.
    pub(super) fn for_each_parallel(self, f: impl Fn(Tile<'a, R>) + Sync)
    where
        R: Send,
    {
        let Self { grid, numbers, .. } = self;
        // SAFETY: the image is borrowed for 'a, and each index of a tile comes once.
        each_number(numbers, &|number| f(unsafe { grid.tile(number) }));
    }
}

/// Runs `f` once for each index, on all threads of the current rayon pool if there are any. `f` is
/// a trait object, so that rayon's code is compiled once, not for every type of pixels.
fn each_number(numbers: Range<usize>, f: &(dyn Fn(usize) + Sync)) {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        // Any tile may be stolen: rayon's default splitting stops at up to a quarter of a frame for
        // two threads.
        numbers.into_par_iter().with_max_len(1).for_each(f);
    }
    #[cfg(not(feature = "parallel"))]
    numbers.for_each(f);
}

impl<'a, R> Iterator for Tiles<'a, R> {
    type Item = Tile<'a, R>;

    fn next(&mut self) -> Option<Tile<'a, R>> {
        // SAFETY: the image is borrowed for 'a, and each index of a tile comes once.
        self.numbers.next().map(|number| unsafe { self.grid.tile(number) })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.numbers.size_hint()
    }
}

impl<R> DoubleEndedIterator for Tiles<'_, R> {
    fn next_back(&mut self) -> Option<Self::Item> {
        // SAFETY: the image is borrowed for 'a, and each index of a tile comes once.
        self.numbers.next_back().map(|number| unsafe { self.grid.tile(number) })
    }
}

impl<R> ExactSizeIterator for Tiles<'_, R> {}

impl<R> FusedIterator for Tiles<'_, R> {}

impl<R> core::fmt::Debug for Tile<'_, R> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Tile").field("origin", &self.origin()).field("size", &self.size()).finish()
    }
}

impl<R> Tile<'_, R> {
    /// Returns the column and the row of its lower left pixel.
    pub fn origin(&self) -> UVec2 {
        uvec2(self.x, self.y)
    }

    /// Returns its width and height.
    pub fn size(&self) -> UVec2 {
        uvec2(self.width, self.height)
    }

    /// Returns the number of pixels.
    pub fn area(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Returns a row of its pixels; `row` is below its height.
    pub(super) fn row(&mut self, row: u32) -> &mut [R] {
        assert!(row < self.height, "row {row} of a tile that has {}", self.height);
        // SAFETY: a row of the tile is one of its image's, cut to its width; the tile borrows it
        // exclusively, as long as the slice.
        unsafe {
            let first = self.first.add(row as usize * self.stride);
            core::slice::from_raw_parts_mut(first.as_ptr(), self.width as usize)
        }
    }

    /// Renders its pixels with a variant of the CPU; [`Variant::Wgsl`] needs a device and panics
    /// here.
    pub fn render<S: Shot<Output = R>>(&mut self, shot: &S, variant: Variant) {
        self.render_in_gangs(shot, variant, GANG);
    }

    /// Renders like [`Tile::render`] with gangs of `lanes` lanes; see
    /// [`Kernel::run_in_gangs`](crate::kernel::Kernel::run_in_gangs).
    pub fn render_in_gangs<S: Shot<Output = R>>(
        &mut self,
        shot: &S,
        variant: Variant,
        lanes: usize,
    ) {
        match variant {
            Variant::Wgsl => panic!("WGSL runs on a device: use raydsl::gpu::GpuScheduler"),
            Variant::Scalar => pixel_by_pixel(self, shot),
            packet => {
                shot.kernel().with_packets(packet, Packets { shot, gang: lanes, tile: self });
            }
        }
    }
}

fn pixel_by_pixel<S: Shot>(tile: &mut Tile<'_, S::Output>, shot: &S) {
    let UVec2 { x: left, y: bottom } = tile.origin();
    for row in 0..tile.height {
        for (pixel, x) in tile.row(row).iter_mut().zip(left..) {
            *pixel = shot.pixel(uvec2(x, bottom + row));
        }
    }
}

struct Packets<'a, 'r, S: Shot> {
    shot: &'a S,
    gang: usize,
    tile: &'a mut Tile<'r, S::Output>,
}

/// Returns the rectangle of pixels that a packet of `n` lanes covers.
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
        let Self { shot, gang, tile } = self;
        let (bw, bh) = const { block(L::N) };
        let UVec2 { x: left, y: bottom } = tile.origin();
        let UVec2 { x: width, y: height } = tile.size();
        let blocks = Blocks { columns: width.div_ceil(bw), lines: height.div_ceil(bh) };
        let places = RefCell::new(Places::new(blocks, (GANG_EDGE / bh).max(1)));
        let tile = RefCell::new(tile);
        fibers::each(blocks.count(), gang / L::N, &|_| {
            let UVec2 { x: bx, y: by } = places.borrow_mut().next() * uvec2(bw, bh);
            lanes.vectorize(
                #[inline(always)]
                || {
                    let columns = lanes.u32_from_fn(|l| l as u32 % bw);
                    let lines = lanes.u32_from_fn(|l| l as u32 / bw);
                    // At the tile's edge a packet is partly filled.
                    let (across, up) = (bw.min(width - bx), bh.min(height - by));
                    let m = Packet::with_bits(lanes, lanes_within(across, up, bw));
                    let x = from(lanes, left + bx, columns);
                    let y = from(lanes, bottom + by, lines);
                    let result = shot.pixel_on(&m, X2 { x, y }, &|m, args| kernel(m, args));
                    let mut tile = tile.borrow_mut();
                    for j in 0..up {
                        let row = &mut tile.row(by + j)[bx as usize..][..across as usize];
                        for (pixel, i) in row.iter_mut().zip(0..) {
                            *pixel = S::Output::lane(&result, (j * bw + i) as usize);
                        }
                    }
                },
            );
        });
    }

    fn scalar(self, _: &(dyn Fn(S::Args) -> S::Result + Send + Sync)) {
        pixel_by_pixel(self.tile, self.shot);
    }
}

/// Returns the pixels at `offsets` from `start`.
#[inline(always)]
fn from<L: Lanes>(l: L, start: u32, offsets: L::U32) -> U<Packet<L>> {
    U(l.u32_binary(op::WrappingAdd, l.u32(start), offsets))
}

/// Returns the lanes of a block of `bw` columns in its first `width` columns and `height` lines.
#[inline(always)]
fn lanes_within(width: u32, height: u32, bw: u32) -> u64 {
    let line = (1 << width) - 1;
    (0..height).fold(0, |bits, j| bits | line << (j * bw))
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    /// Tests work stealing: the first tile waits until all others are done, so a slow tile delays
    /// no other.
    #[cfg(feature = "parallel")]
    #[test]
    fn any_tile_is_stolen_from_a_slow_one() {
        use std::sync::atomic::{AtomicUsize, Ordering};
        use std::time::{Duration, Instant};

        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
        let pool = pool.expect("two threads can be started");
        let mut image = Image::filled(64, 16, 0u32);
        let others = image.tiles(1).len() - 1;
        let done = AtomicUsize::new(0);
        let begin = Instant::now();
        pool.install(|| {
            image.tiles(1).for_each_parallel(|tile| {
                let is_first = tile.origin() == UVec2::ZERO;
                while is_first && done.load(Ordering::Relaxed) < others {
                    let waited = begin.elapsed();
                    assert!(waited < Duration::from_secs(60), "{done:?} of {others}");
                    std::thread::yield_now();
                }
                done.fetch_add(1, Ordering::Relaxed);
            });
        });
    }

    #[test]
    fn each_pixel_is_in_one_tile() {
        for (width, height) in [(0, 0), (0, 5), (5, 0), (1, 1), (37, 21), (16, 400), (131, 77)] {
            for edge in [0, 1, 5, 16, 64, u32::MAX] {
                let mut image = Image::filled(width, height, 0u32);
                let mut tiles = image.tiles(edge);
                let (mut count, mut left) = (0, tiles.len());
                let fill = |mut tile: Tile<'_, u32>| {
                    assert!(tile.size().max_element() <= edge.max(1) && tile.area() > 0);
                    for row in 0..tile.size().y {
                        tile.row(row).iter_mut().for_each(|pixel| *pixel += 1);
                    }
                };
                // From both ends.
                while let Some(tile) = if count % 3 == 2 { tiles.next_back() } else { tiles.next() }
                {
                    fill(tile);
                    count += 1;
                    left -= 1;
                    assert_eq!(tiles.len(), left);
                }
                assert!(tiles.next().is_none() && tiles.next_back().is_none() && left == 0);
                assert!(image.pixels().iter().all(|&n| n == 1), "{width} x {height}, {edge}");
                image.tiles(edge).for_each_parallel(fill);
                assert!(image.pixels().iter().all(|&n| n == 2), "{width} x {height}, {edge}");
            }
        }
    }

    #[test]
    fn places_follow_their_numbers() {
        for (columns, lines) in [(1, 1), (1, 9), (7, 1), (4, 4), (5, 7), (3, 8), (2, 17)] {
            for band in [1, 2, 3, 8, 100, u32::MAX] {
                let blocks = Blocks { columns, lines };
                let mut places = Places::new(blocks, band);
                for number in 0..blocks.count() {
                    let expected = blocks.place(number, band);
                    assert_eq!(places.next(), expected, "{blocks:?}, {band}, {number}");
                }
            }
        }
    }

    /// Tests also bands with more tiles than 32 bits can count; no image is allocated.
    #[test]
    #[cfg(target_pointer_width = "64")]
    fn numbers_of_tiles_lead_to_different_places() {
        for (width, height) in [(u32::MAX, 11), (1 << 29 | 1, 8), (11, u32::MAX)] {
            let grid = Grid { pixels: NonNull::<u32>::dangling(), width, height, edge: 1 };
            let area = width as usize * height as usize;
            let numbers = (0..200).map(|i| i * (area / 200)).chain(area - 20..area);
            let numbers = numbers.chain([7, (1 << 32) + 7, 1 << 32]).filter(|&n| n < area);
            let numbers: HashSet<usize> = numbers.collect();
            let places: HashSet<UVec2> =
                numbers.iter().map(|&n| grid.blocks().place(n, BAND)).collect();
            assert_eq!(places.len(), numbers.len(), "{width} x {height}");
            assert!(places.iter().all(|p| p.x < width && p.y < height));
        }
    }
}
