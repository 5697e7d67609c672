//! Voxels: the scalar types of a grid, and how a grid stores them for fetches of whole cells.

use std::borrow::Cow;

use glam::{UVec2, UVec3, Vec4, vec4};

use crate::machine::functions::vec4;
use crate::machine::{Machine, Slice, Type, U, X3};
use crate::math::{F16, half_to_f32};
use crate::{Type as Derive, kernel};

/// Values at the corners of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Derive)]
pub struct Corners {
    /// At the lower z: at `(x, y)`, `(x + 1, y)`, `(x, y + 1)` and `(x + 1, y + 1)`.
    pub near: Vec4,
    /// At the upper z, likewise.
    pub far: Vec4,
}

/// Type of a grid's values: `u8`, `u16`, `i16`, [`F16`] or `f32`.
///
/// A grid of `f32` reads the application's slice in place. One of a smaller type keeps, beside each
/// voxel, its neighbours along x and y: with that a cell is two fetches, for four times the memory.
pub trait Voxel: Copy + Send + Sync + core::fmt::Debug + 'static {
    /// What a grid stores for each voxel.
    type Stored: Type + Clone + Send + Sync + core::fmt::Debug;

    /// Returns the value as it is before a grid's scale.
    fn number(self) -> f32;

    /// Returns what a grid of this size stores.
    #[doc(hidden)]
    fn stored(voxels: Cow<'_, [Self]>, size: UVec3) -> Cow<'_, [Self::Stored]>;

    /// Returns the corners of the cell whose first voxel is `i`; `steps` lead to its neighbours
    /// along x, y and z.
    #[doc(hidden)]
    fn corners(stored: &[Self::Stored], i: u32, steps: UVec3) -> Corners;

    /// Lifted form of [`corners`](Self::corners).
    #[doc(hidden)]
    fn corners_on<M: Machine>(
        m: &M,
        stored: Slice<'_, Self::Stored>,
        i: U<M>,
        steps: X3<U<M>>,
    ) -> <Corners as Type>::On<M>;
}

/// Calls `store` with each voxel and its neighbours along x and y; those outside are the nearest
/// inside.
fn squares<T: Copy + Sync, S: Send>(
    voxels: &[T],
    size: UVec3,
    store: impl Fn([T; 4]) -> S + Sync,
) -> Vec<S> {
    let (width, height) = (size.x as usize, size.y as usize);
    let row = |j: usize| {
        let (line, y) = (&voxels[j * width..][..width], j % height);
        let above = if y + 1 < height { &voxels[(j + 1) * width..][..width] } else { line };
        let store = &store;
        (0..width).map(move |x| {
            let next = (x + 1).min(width - 1);
            store([line[x], line[next], above[x], above[next]])
        })
    };
    let rows = voxels.len() / width;
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        (0..rows).into_par_iter().flat_map_iter(row).collect()
    }
    #[cfg(not(feature = "parallel"))]
    (0..rows).flat_map(row).collect()
}

/// Returns the four bytes of a word as numbers.
#[kernel]
#[inline(always)]
fn bytes_of(word: u32) -> Vec4 {
    vec4(
        (word & 0xff) as f32,
        (word >> 8 & 0xff) as f32,
        (word >> 16 & 0xff) as f32,
        (word >> 24) as f32,
    )
}

#[kernel]
#[inline(always)]
fn corners_of_bytes(stored: &[u32], i: u32, steps: UVec3) -> Corners {
    let near = stored[i as usize];
    let far = stored[(i + steps.z) as usize];
    Corners { near: bytes_of(near), far: bytes_of(far) }
}

/// Defines how the four corners in two words, 16 bits each, become numbers.
macro_rules! halves {
    ($corners:ident, $of:ident, |$bits:ident| $number:expr) => {
        #[kernel]
        #[inline]
        fn $of($bits: u32) -> f32 {
            $number
        }

        #[kernel]
        #[inline]
        fn $corners(stored: &[UVec2], i: u32, steps: UVec3) -> Corners {
            let near = stored[i as usize];
            let far = stored[(i + steps.z) as usize];
            Corners {
                near: vec4(
                    $of(near.x & 0xffff),
                    $of(near.x >> 16),
                    $of(near.y & 0xffff),
                    $of(near.y >> 16),
                ),
                far: vec4(
                    $of(far.x & 0xffff),
                    $of(far.x >> 16),
                    $of(far.y & 0xffff),
                    $of(far.y >> 16),
                ),
            }
        }
    };
}

halves!(corners_of_unsigned, unsigned, |bits| bits as f32);
halves!(corners_of_signed, signed, |bits| ((bits ^ 0x8000) as f32) - 32768.0);
halves!(corners_of_halves, half, |bits| half_to_f32(bits));

#[kernel]
#[inline(always)]
fn corners_of_floats(stored: &[f32], i: u32, steps: UVec3) -> Corners {
    let (x, y, z) = (steps.x, steps.y, steps.z);
    let far = i + z;
    Corners {
        near: vec4(
            stored[i as usize],
            stored[(i + x) as usize],
            stored[(i + y) as usize],
            stored[(i + y + x) as usize],
        ),
        far: vec4(
            stored[far as usize],
            stored[(far + x) as usize],
            stored[(far + y) as usize],
            stored[(far + y + x) as usize],
        ),
    }
}

macro_rules! voxel {
    ($t:ty, $stored:ty, $corners:ident, |$v:ident| $number:expr, $store:expr) => {
        impl Voxel for $t {
            type Stored = $stored;

            #[inline]
            fn number(self) -> f32 {
                let $v = self;
                $number
            }

            fn stored(voxels: Cow<'_, [Self]>, size: UVec3) -> Cow<'_, [Self::Stored]> {
                $store(voxels, size)
            }

            #[inline(always)]
            fn corners(stored: &[Self::Stored], i: u32, steps: UVec3) -> Corners {
                $corners(stored, i, steps)
            }

            #[inline(always)]
            fn corners_on<M: Machine>(
                m: &M,
                stored: Slice<'_, Self::Stored>,
                i: U<M>,
                steps: X3<U<M>>,
            ) -> <Corners as Type>::On<M> {
                $corners::on(m, stored, i, steps)
            }
        }
    };
}

/// Packs two numbers of 16 bits.
fn pair(low: u16, high: u16) -> u32 {
    u32::from(low) | u32::from(high) << 16
}

voxel!(u8, u32, corners_of_bytes, |v| f32::from(v), |voxels: Cow<'_, [u8]>, size| {
    Cow::Owned(squares(&voxels, size, u32::from_le_bytes))
});
voxel!(u16, UVec2, corners_of_unsigned, |v| f32::from(v), |voxels: Cow<'_, [u16]>, size| {
    Cow::Owned(squares(&voxels, size, |[a, b, c, d]| UVec2::new(pair(a, b), pair(c, d))))
});
voxel!(i16, UVec2, corners_of_signed, |v| f32::from(v), |voxels: Cow<'_, [i16]>, size| {
    let pair = |a: i16, b: i16| pair(a as u16, b as u16);
    Cow::Owned(squares(&voxels, size, |[a, b, c, d]| UVec2::new(pair(a, b), pair(c, d))))
});
voxel!(F16, UVec2, corners_of_halves, |v| v.to_f32(), |voxels: Cow<'_, [F16]>, size| {
    let pair = |a: F16, b: F16| pair(a.to_bits(), b.to_bits());
    Cow::Owned(squares(&voxels, size, |[a, b, c, d]| UVec2::new(pair(a, b), pair(c, d))))
});
voxel!(f32, f32, corners_of_floats, |v| v, |voxels, _| voxels);
