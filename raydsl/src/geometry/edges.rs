//! Cross products of edges, scaled: products of lengths would leave the range of `f32` for edges of
//! 1e-12 or 1e12.

use glam::Vec3;

use super::near::largest;
use crate::kernel;

/// Returns the unit direction of `a × b`.
#[kernel]
#[inline]
pub(super) fn across(a: Vec3, b: Vec3) -> Vec3 {
    (a / largest(a)).cross(b / largest(b)).normalize()
}

/// Returns the length of `a × b`: the area of the parallelogram.
#[kernel]
#[inline]
pub(super) fn spanned(a: Vec3, b: Vec3) -> f32 {
    let (of_a, of_b) = (largest(a), largest(b));
    if of_a > 0.0 && of_b > 0.0 { (a / of_a).cross(b / of_b).length() * of_a * of_b } else { 0.0 }
}
