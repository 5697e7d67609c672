//! Texture lookups at level 0, and at any level of detail, and single texels. `packet` repeats them for packets:
//! change both together.

use glam::{IVec2, IVec3, UVec2, UVec3, Vec2, Vec3};

use super::filter::{filter1, filter2, filter3, texel1, texel2, texel3};
use super::texel::{Texel, TexelValue};
use super::view::Texels;
use crate::Type;
use crate::kernel;
use crate::machine::generic::{max, min};
use crate::machine::{F, I, Machine, U, X2, X3};

/// Returns the number of texels of an axis at a level.
#[kernel]
pub(super) fn size_at(size: u32, level: u32) -> u32 {
    max(size >> level, 1u32)
}

/// Returns the first texel of a level; levels are consecutive.
#[kernel]
pub(super) fn level_start(size: UVec3, level: u32) -> u32 {
    let mut start = 0u32;
    for finer in 0..level {
        start += size_at(size.x, finer) * size_at(size.y, finer) * size_at(size.z, finer);
    }
    start
}

/// Clamps a level to `0..=last`; NaN becomes 0.
#[kernel]
pub(super) fn level_within(level: f32, last: u32) -> f32 {
    min(max(0.0, level), last as f32)
}

#[kernel]
pub(super) fn tex1<T: Texel<Value = V>, V: TexelValue>(texels: &Texels<'_, T>, u: f32) -> V {
    filter1(texels, texels.size1(), 0u32, u)
}

#[kernel]
pub(super) fn tex2<T: Texel<Value = V>, V: TexelValue>(texels: &Texels<'_, T>, uv: Vec2) -> V {
    filter2(texels, texels.size2(), 0u32, uv)
}

#[kernel]
pub(super) fn tex3<T: Texel<Value = V>, V: TexelValue>(texels: &Texels<'_, T>, uvw: Vec3) -> V {
    filter3(texels, texels.size3(), 0u32, uvw)
}

#[kernel]
fn at_level1<T: Texel<Value = V>, V: TexelValue>(texels: &Texels<'_, T>, u: f32, level: u32) -> V {
    let size = texels.size1();
    let first = level_start(UVec3::new(size, 1, 1), level);
    filter1(texels, size_at(size, level), first, u)
}

#[kernel]
fn at_level2<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    uv: Vec2,
    level: u32,
) -> V {
    let size = texels.size2();
    let first = level_start(UVec3::new(size.x, size.y, 1), level);
    filter2(texels, UVec2::new(size_at(size.x, level), size_at(size.y, level)), first, uv)
}

#[kernel]
fn at_level3<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    uvw: Vec3,
    level: u32,
) -> V {
    let size = texels.size3();
    let (w, h, d) = (size_at(size.x, level), size_at(size.y, level), size_at(size.z, level));
    filter3(texels, UVec3::new(w, h, d), level_start(size, level), uvw)
}

macro_rules! leveled {
    ($leveled:ident $base:ident $at_level:ident $coordinate:ty) => {
        #[kernel]
        pub(super) fn $leveled<T: Texel<Value = V>, V: TexelValue>(
            texels: &Texels<'_, T>,
            at: $coordinate,
            level: f32,
        ) -> V {
            if texels.has_levels() {
                let last = texels.last_level();
                let place = level_within(level, last);
                if texels.blends_levels() {
                    let finer = place.floor();
                    let below: V = $at_level(texels, at, finer as u32);
                    let above: V = $at_level(texels, at, min(finer as u32 + 1, last));
                    below.blend(above, texels.near(place - finer))
                } else {
                    $at_level(texels, at, (texels.near(place) + 0.5).floor() as u32)
                }
            } else {
                $base(texels, at)
            }
        }
    };
}

leveled!(tex1_level tex1 at_level1 f32);
leveled!(tex2_level tex2 at_level2 Vec2);
leveled!(tex3_level tex3 at_level3 Vec3);

#[kernel]
pub(super) fn texels1<T: Texel>(texels: &Texels<'_, T>, level: u32) -> u32 {
    let size = texels.size1();
    if texels.has_levels() { size_at(size, min(level, texels.last_level())) } else { size }
}

#[kernel]
pub(super) fn texels2<T: Texel>(texels: &Texels<'_, T>, level: u32) -> UVec2 {
    let size = texels.size2();
    if texels.has_levels() {
        let level = min(level, texels.last_level());
        UVec2::new(size_at(size.x, level), size_at(size.y, level))
    } else {
        size
    }
}

#[kernel]
pub(super) fn texels3<T: Texel>(texels: &Texels<'_, T>, level: u32) -> UVec3 {
    let size = texels.size3();
    if texels.has_levels() {
        let level = min(level, texels.last_level());
        UVec3::new(size_at(size.x, level), size_at(size.y, level), size_at(size.z, level))
    } else {
        size
    }
}

#[kernel]
pub(super) fn fetch1<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    at: i32,
    level: u32,
) -> V {
    if texels.has_levels() {
        let whole = UVec3::new(texels.size1(), 1, 1);
        let first = level_start(whole, min(level, texels.last_level()));
        texel1(texels, texels1(texels, level), first, at)
    } else {
        texel1(texels, texels.size1(), 0u32, at)
    }
}

#[kernel]
pub(super) fn fetch2<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    at: IVec2,
    level: u32,
) -> V {
    if texels.has_levels() {
        let whole = texels.size2();
        let last = texels.last_level();
        let first = level_start(UVec3::new(whole.x, whole.y, 1), min(level, last));
        texel2(texels, texels2(texels, level), first, at)
    } else {
        texel2(texels, texels.size2(), 0u32, at)
    }
}

#[kernel]
pub(super) fn fetch3<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    at: IVec3,
    level: u32,
) -> V {
    if texels.has_levels() {
        let first = level_start(texels.size3(), min(level, texels.last_level()));
        texel3(texels, texels3(texels, level), first, at)
    } else {
        texel3(texels, texels.size3(), 0u32, at)
    }
}

/// Selects the kernel for a number of axes.
macro_rules! by_axes {
    ($d:ident: $one:expr, $two:expr, $three:expr) => {
        if const { $d == 1 } {
            $one
        } else if const { $d == 2 } {
            $two
        } else {
            $three
        }
    };
}

impl<T: Texel> Texels<'_, T> {
    /// Runs the kernels on a machine at a position of `D` axes. A function of its own: it contains
    /// all filters.
    #[inline(never)]
    pub(crate) fn by_kernels<M: Machine, const D: usize>(
        &self,
        m: &M,
        at: &[F<M>; D],
    ) -> <T::Value as Type>::On<M> {
        // Indices are not constants: an array of one axis has no second element, though none is
        // read.
        let x = |i: usize| at[i];
        by_axes!(D:
            tex1::on(m, *self, x(0)),
            tex2::on(m, *self, X2 { x: x(0), y: x(1) }),
            tex3::on(m, *self, X3 { x: x(0), y: x(1), z: x(2) })
        )
    }

    /// Runs the kernels at a position of `D` axes and a level of detail.
    #[inline(never)]
    pub(crate) fn by_kernels_at_level<M: Machine, const D: usize>(
        &self,
        m: &M,
        at: &[F<M>; D],
        level: F<M>,
    ) -> <T::Value as Type>::On<M> {
        // Indices are not constants: an array of one axis has no second element, though none is
        // read.
        let x = |i: usize| at[i];
        by_axes!(D:
            tex1_level::on(m, *self, x(0), level),
            tex2_level::on(m, *self, X2 { x: x(0), y: x(1) }, level),
            tex3_level::on(m, *self, X3 { x: x(0), y: x(1), z: x(2) }, level)
        )
    }

    /// Runs the kernels of single texels at a place of `D` axes and a level.
    #[inline(never)]
    pub(crate) fn fetched_by_kernels<M: Machine, const D: usize>(
        &self,
        m: &M,
        at: &[I<M>; D],
        level: U<M>,
    ) -> <T::Value as Type>::On<M> {
        // As above.
        let x = |i: usize| at[i];
        by_axes!(D:
            fetch1::on(m, *self, x(0), level),
            fetch2::on(m, *self, X2 { x: x(0), y: x(1) }, level),
            fetch3::on(m, *self, X3 { x: x(0), y: x(1), z: x(2) }, level)
        )
    }
}
