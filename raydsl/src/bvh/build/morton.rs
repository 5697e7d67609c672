//! Morton codes: the order of primitives along a space-filling curve.
//!
//! The cube around all centroids is cut into `2^21` cells an axis. The code of a cell interleaves
//! the bits of its three coordinates, `z` above `y` above `x`: the highest bit selects a half of
//! the cube, the next one a half of that half, and so on. It is a cube even where the scene is
//! flat: then the bits of the flat axis are alike, and the others still split where the scene is
//! longest.

use glam::{Vec4, Vec4Swizzles};

use super::binned_sah::CLOSE;
use super::reference::{Bounds, Reference};
use super::tasks;

/// Bits of a cell's coordinate along one axis: three times as many fit in a `u64`.
const BITS: u32 = 21;
/// Largest coordinate of a cell along one axis.
const LAST: u32 = (1 << BITS) - 1;
/// `2^23`: adding it rounds a small number to an integer in the low mantissa bits.
const ROUND: f32 = 8_388_608.0;
/// Keys per piece of parallel work.
const PIECE: usize = 1 << 14;

/// Sort key of a primitive: its code, then its index.
///
/// No two are equal, so any sort is stable and gives one result. The index is in the lowest 32 bits
/// with the code above it: one number compares faster than two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Key(u128);

impl Key {
    fn new(code: u64, index: u32) -> Self {
        Self(u128::from(code) << 32 | u128::from(index))
    }

    /// Returns the code of the centroid's cell.
    #[inline]
    pub(super) fn code(self) -> u64 {
        (self.0 >> 32) as u64
    }

    /// Returns the primitive id.
    #[inline]
    pub(super) fn index(self) -> u32 {
        self.0 as u32
    }
}

/// Returns the keys of all `references`, sorted.
pub(super) fn keys(references: &[Reference], centroids: &Bounds) -> Vec<Key> {
    let cube = Cube::around(centroids);
    let mut keys = tasks::map(references, PIECE, |reference| {
        Key::new(Cube::code(cube.as_ref(), reference.centroid()), reference.index())
    });
    tasks::sort(&mut keys);
    keys
}

/// Recodes some of the primitives within the cube around their own centroids, and sorts them.
pub(super) fn order_again(keys: &mut [Key], references: &[Reference]) {
    let centroid = |key: Key| references[key.index() as usize].centroid();
    let centroids = keys.iter().map(|&key| centroid(key)).fold(Bounds::EMPTY, Bounds::with);
    let cube = Cube::around(&centroids);
    tasks::map_pieces_mut(keys, PIECE, |_, piece| {
        for key in piece {
            *key = Key::new(Cube::code(cube.as_ref(), centroid(*key)), key.index());
        }
    });
    tasks::sort(keys);
}

/// Grid of cells over the cube around the centroids.
#[derive(Clone, Copy, Debug)]
struct Cube {
    origin: Vec4,
    /// Cells per unit of length.
    scale: Vec4,
}

impl Cube {
    /// Creates the cube over the lowest corner of `centroids`; `None` when all centroids coincide.
    fn around(centroids: &Bounds) -> Option<Self> {
        let extent = (centroids.hi - centroids.lo).xyz().max_element();
        if extent < CLOSE {
            return None;
        }
        // As for bins: moving the origin by less than half a cell prevents denormal products, which
        // are slow.
        let origin = centroids.lo - Vec4::splat(extent * 2e-7);
        Some(Self { origin, scale: Vec4::splat(LAST as f32 / extent) })
    }

    /// Returns the code of the cell that holds a centroid; 0 without a cube, when all centroids
    /// coincide.
    #[inline]
    fn code(cube: Option<&Self>, centroid: Vec4) -> u64 {
        cube.map_or(0, |cube| cube.code_within(centroid))
    }

    #[inline]
    fn code_within(&self, centroid: Vec4) -> u64 {
        let cell = ((centroid - self.origin) * self.scale).min(Vec4::splat(LAST as f32));
        let [x, y, z] = (cell + Vec4::splat(ROUND)).xyz().to_array().map(|n| n.to_bits() & LAST);
        interleaved([x, y, z])
    }
}

/// Interleaves the low [`BITS`] bits of three numbers, beginning with the lowest of the first.
#[inline]
fn interleaved([x, y, z]: [u32; 3]) -> u64 {
    spread(x) | spread(y) << 1 | spread(z) << 2
}

/// Spreads the low [`BITS`] bits of a number, two zeros between any two: each step moves the upper
/// half of every remaining group.
#[inline]
fn spread(n: u32) -> u64 {
    let mut n = u64::from(n & LAST);
    for (shift, mask) in [
        (32, 0x001F_0000_0000_FFFF),
        (16, 0x001F_0000_FF00_00FF),
        (8, 0x100F_00F0_0F00_F00F),
        (4, 0x10C3_0C30_C30C_30C3),
        (2, 0x1249_2492_4924_9249),
    ] {
        n = (n | n << shift) & mask;
    }
    n
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn bits_in_turn() {
        let of = |x, y, z| interleaved([x, y, z]);
        assert_eq!([of(1, 0, 1), of(0, 1, 1), of(1, 1, 1)], [5, 6, 7]);
        for k in 0..BITS {
            assert_eq!(of(1 << k, 0, 0), 1 << (3 * k));
            assert_eq!(of(1 << k, 1 << k, 1 << k), 7 << (3 * k));
        }
        assert_eq!(of(LAST, LAST, LAST), u64::MAX >> 1);
    }

    #[test]
    fn the_corners_of_the_cube() {
        for (lo, size) in [(-3.0f32, 7.0f32), (1e20, 1e30), (0.0, 1e-20), (1.0, f32::EPSILON)] {
            let [lo, hi] = [lo, lo + size].map(|x| Vec3::splat(x).extend(f32::NAN));
            let cube = Cube::around(&Bounds { lo, hi }).expect("it has an extent");
            assert_eq!(cube.code_within(lo), 0);
            assert_eq!(cube.code_within(hi), u64::MAX >> 1);
        }
        let point = Vec4::splat(2.0);
        assert!(Cube::around(&Bounds { lo: point, hi: point }).is_none());
    }
}
