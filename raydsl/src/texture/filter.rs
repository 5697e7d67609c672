//! Texture filters, and single texels: kernels over a texture's texels. `packet` repeats them for packets: change both
//! together.
//!
//! Each works on rows along the first axis, blended along the others. Filter and address modes are
//! host values, so a recorder emits only those of the texture.

use glam::{IVec2, IVec3, UVec2, UVec3, Vec2, Vec3};

use super::taps::{Four, OUTSIDE, Pair, four, nearest_texel, pair, texel_of};
use super::texel::{Texel, TexelValue};
use super::view::Texels;
use crate::kernel;
use crate::machine::generic::select;

/// Returns the first texel of part `i`, of `size` texels each, from `first` on: of a row in an
/// image, or of an image in a volume.
#[kernel]
fn part<T: Texel>(texels: &Texels<'_, T>, first: u32, size: u32, i: u32) -> u32 {
    if texels.has_border() {
        let start = first.wrapping_add(i.wrapping_mul(size));
        select(i == OUTSIDE || first == OUTSIDE, OUTSIDE, start)
    } else {
        first + i * size
    }
}

/// Returns texel `i` of a row, or the border.
#[kernel]
fn texel<T: Texel<Value = V>, V: TexelValue>(texels: &Texels<'_, T>, row: u32, i: u32) -> V {
    if texels.has_border() {
        let is_outside = row == OUTSIDE || i == OUTSIDE;
        let inside: V = texels.value(select(is_outside, 0u32, row.wrapping_add(i)));
        if is_outside { texels.border() } else { inside }
    } else {
        texels.value(row + i)
    }
}

#[kernel]
fn linear_row<T: Texel<Value = V>, V: TexelValue>(texels: &Texels<'_, T>, row: u32, x: Pair) -> V {
    let a: V = texel(texels, row, x.first);
    let b: V = texel(texels, row, x.second);
    a.blend(b, texels.near(x.share))
}

#[kernel]
fn linear_image<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    first: u32,
    width: u32,
    x: Pair,
    y: Pair,
) -> V {
    let a: V = linear_row(texels, part(texels, first, width, y.first), x);
    let b: V = linear_row(texels, part(texels, first, width, y.second), x);
    a.blend(b, texels.near(y.share))
}

#[kernel]
fn cubic_row<T: Texel<Value = V>, V: TexelValue>(texels: &Texels<'_, T>, row: u32, x: Four) -> V {
    let a: V = texel(texels, row, x.first);
    let b: V = texel(texels, row, x.second);
    let c: V = texel(texels, row, x.third);
    let d: V = texel(texels, row, x.fourth);
    b.blend4(a, c, d, x.w1, x.w3, x.w4)
}

#[kernel]
fn cubic_image<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    first: u32,
    width: u32,
    x: Four,
    y: Four,
) -> V {
    let rows = [y.first, y.second, y.third, y.fourth];
    let zero: V = texels.zero_value();
    let mut found = [zero; 4];
    // A loop: drivers would take minutes to compile 64 texels of a volume one by one.
    for i in 0..4 {
        found[i] = cubic_row(texels, part(texels, first, width, rows[i]), x);
    }
    let second: V = found[1];
    second.blend4(found[0], found[2], found[3], y.w1, y.w3, y.w4)
}

/// Filters a row of `size` texels from `first` on at `x`.
#[kernel]
pub(super) fn filter1<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    size: u32,
    first: u32,
    x: f32,
) -> V {
    if texels.is_nearest() {
        texel(texels, first, nearest_texel(x, size, texels.address_u()))
    } else if texels.is_linear() {
        linear_row(texels, first, pair(x, size, texels.address_u()))
    } else {
        cubic_row(texels, first, four(x, size, texels.address_u(), texels.filter()))
    }
}

/// Filters an image that starts at `first` at `uv`.
#[kernel]
pub(super) fn filter2<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    size: UVec2,
    first: u32,
    uv: Vec2,
) -> V {
    if texels.is_nearest() {
        let i = nearest_texel(uv.x, size.x, texels.address_u());
        let j = nearest_texel(uv.y, size.y, texels.address_v());
        texel(texels, part(texels, first, size.x, j), i)
    } else if texels.is_linear() {
        let x = pair(uv.x, size.x, texels.address_u());
        let y = pair(uv.y, size.y, texels.address_v());
        linear_image(texels, first, size.x, x, y)
    } else {
        let x = four(uv.x, size.x, texels.address_u(), texels.filter());
        let y = four(uv.y, size.y, texels.address_v(), texels.filter());
        cubic_image(texels, first, size.x, x, y)
    }
}

/// Filters a volume that starts at `first` at `uvw`.
#[kernel]
pub(super) fn filter3<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    size: UVec3,
    first: u32,
    uvw: Vec3,
) -> V {
    let image = size.x * size.y;
    if texels.is_nearest() {
        let i = nearest_texel(uvw.x, size.x, texels.address_u());
        let j = nearest_texel(uvw.y, size.y, texels.address_v());
        let k = nearest_texel(uvw.z, size.z, texels.address_w());
        let start = part(texels, first, image, k);
        texel(texels, part(texels, start, size.x, j), i)
    } else if texels.is_linear() {
        let x = pair(uvw.x, size.x, texels.address_u());
        let y = pair(uvw.y, size.y, texels.address_v());
        let z = pair(uvw.z, size.z, texels.address_w());
        let front = part(texels, first, image, z.first);
        let back = part(texels, first, image, z.second);
        let a: V = linear_image(texels, front, size.x, x, y);
        let b: V = linear_image(texels, back, size.x, x, y);
        a.blend(b, texels.near(z.share))
    } else {
        let x = four(uvw.x, size.x, texels.address_u(), texels.filter());
        let y = four(uvw.y, size.y, texels.address_v(), texels.filter());
        let z = four(uvw.z, size.z, texels.address_w(), texels.filter());
        let starts = [
            part(texels, first, image, z.first),
            part(texels, first, image, z.second),
            part(texels, first, image, z.third),
            part(texels, first, image, z.fourth),
        ];
        let zero: V = texels.zero_value();
        let mut found = [zero; 4];
        for i in 0..4 {
            found[i] = cubic_image(texels, starts[i], size.x, x, y);
        }
        let second: V = found[1];
        second.blend4(found[0], found[2], found[3], z.w1, z.w3, z.w4)
    }
}

/// Returns texel `at` of a row of `size` texels from `first` on.
#[kernel]
pub(super) fn texel1<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    size: u32,
    first: u32,
    at: i32,
) -> V {
    texel(texels, first, texel_of(at, size, texels.address_u()))
}

/// Returns texel `at` of an image that starts at `first`.
#[kernel]
pub(super) fn texel2<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    size: UVec2,
    first: u32,
    at: IVec2,
) -> V {
    let j = texel_of(at.y, size.y, texels.address_v());
    texel1(texels, size.x, part(texels, first, size.x, j), at.x)
}

/// Returns texel `at` of a volume that starts at `first`.
#[kernel]
pub(super) fn texel3<T: Texel<Value = V>, V: TexelValue>(
    texels: &Texels<'_, T>,
    size: UVec3,
    first: u32,
    at: IVec3,
) -> V {
    let k = texel_of(at.z, size.z, texels.address_w());
    let start = part(texels, first, size.x * size.y, k);
    texel2(texels, size.truncate(), start, at.truncate())
}
