//! Arithmetic that keeps what rounding loses.
//!
//! Where a device fuses products into sums, what is kept is less, and at worst nothing.

use glam::{Vec3, vec3};

use crate::machine::functions::vec3;
use crate::machine::generic::min;
use crate::machine::{KernelFn, KernelInfo};
use crate::{Type, kernel};

/// The same number, of which a compiler knows nothing: those of some drivers cancel `a - (a - b)`
/// and reorder sums.
#[kernel]
#[inline]
fn kept(a: Vec3) -> Vec3 {
    min(a, vec3(f32::MAX, f32::MAX, f32::MAX))
}

/// What `a - b` lost by rounding (Knuth, TAOCP 2, 4.2.2, theorem B).
#[kernel]
#[inline]
pub(crate) fn lost_by_difference(a: Vec3, b: Vec3) -> Vec3 {
    let difference = kept(a - b);
    let part = kept(a - difference);
    let rest = difference + part;
    (a - rest) + (part - b)
}

/// The upper half of the bits of a number. (Veltkamp, 1968: as in Dekker, section 5.)
#[kernel]
#[inline]
fn upper_half(a: Vec3) -> Vec3 {
    let wide = a * 4097.0;
    wide - kept(wide - a)
}

/// What `a * b` lost by rounding, unless it underflows: products of halves are exact. (Dekker, "A
/// Floating-Point Technique for Extending the Available Precision", 1971.)
#[kernel]
#[inline]
fn lost_by_product(a: Vec3, b: Vec3) -> Vec3 {
    let a_high = upper_half(a);
    let b_high = upper_half(b);
    let a_low = a - a_high;
    let b_low = b - b_high;
    ((a_high * b_high - a * b) + a_high * b_low + a_low * b_high) + a_low * b_low
}

/// What is lost, rounded, and what rounding that loses.
#[derive(Clone, Copy, Debug, Type)]
pub(crate) struct Lost {
    pub(crate) most: Vec3,
    pub(crate) rest: Vec3,
}

/// What the cross product loses by rounding its products.
#[kernel]
#[inline]
pub(crate) fn lost_by_cross(a: Vec3, b: Vec3) -> Lost {
    let (a_yzx, a_zxy) = (vec3(a.y, a.z, a.x), vec3(a.z, a.x, a.y));
    let (b_yzx, b_zxy) = (vec3(b.y, b.z, b.x), vec3(b.z, b.x, b.y));
    let lost = lost_by_product(a_yzx, b_zxy);
    let lost_too = lost_by_product(a_zxy, b_yzx);
    Lost { most: lost - lost_too, rest: lost_by_difference(lost, lost_too) }
}

/// Whether a kernel is [`lost_by_cross()`]. A machine that bounds errors knows how small its
/// results are, and could not find out from its operations.
pub(crate) fn is_lost_by_cross(info: &KernelInfo) -> bool {
    let own = <lost_by_cross as KernelFn>::info();
    (info.name, info.file, info.line) == (own.name, own.file, own.line)
}

/// The cross product with 2 ulp at most lost of each component, however much they cancel: their
/// signs are those of the exact ones.
#[kernel]
#[inline(never)]
pub(crate) fn exact_cross(a: Vec3, b: Vec3) -> Vec3 {
    let lost = lost_by_cross(a, b);
    kept(kept(a.cross(b)) + lost.most) + lost.rest
}
