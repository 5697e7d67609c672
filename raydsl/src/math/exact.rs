//! Error-free transformations: exact rounding errors of sums and products.
//!
//! Where a device fuses products into sums, the recovered error is smaller, and at worst 0.

use glam::{Vec3, vec3};

use crate::machine::functions::vec3;
use crate::machine::generic::min;
use crate::machine::margin::{Interval, Known};
use crate::machine::{KnownFunction, Margin};
use crate::{Type, kernel};

/// Returns the same number, opaque to compilers: those of some drivers cancel `a - (a - b)` and
/// reorder sums.
#[kernel]
#[inline]
fn kept(a: Vec3) -> Vec3 {
    min(a, vec3(f32::MAX, f32::MAX, f32::MAX))
}

/// Returns the rounding error of `a - b` (Knuth, TAOCP 2, 4.2.2, theorem B).
#[kernel]
#[inline]
pub(crate) fn lost_by_difference(a: Vec3, b: Vec3) -> Vec3 {
    let difference = kept(a - b);
    let part = kept(a - difference);
    let rest = difference + part;
    (a - rest) + (part - b)
}

/// Returns the upper half of a number's bits. (Veltkamp, 1968: as in Dekker, section 5.)
#[kernel]
#[inline]
fn upper_half(a: Vec3) -> Vec3 {
    let wide = a * 4097.0;
    wide - kept(wide - a)
}

/// Returns the rounding error of `a * b`, unless it underflows: products of halves are exact.
/// (Dekker, "A Floating-Point Technique for Extending the Available Precision", 1971.)
#[kernel]
#[inline]
fn lost_by_product(a: Vec3, b: Vec3) -> Vec3 {
    let a_high = upper_half(a);
    let b_high = upper_half(b);
    let a_low = a - a_high;
    let b_low = b - b_high;
    ((a_high * b_high - a * b) + a_high * b_low + a_low * b_high) + a_low * b_low
}

/// Rounding error as a rounded number and its own rounding error.
#[derive(Clone, Copy, Debug, Type)]
pub(crate) struct Lost {
    pub(crate) most: Vec3,
    pub(crate) rest: Vec3,
}

/// Returns the rounding error of the products in a cross product.
#[kernel(known = LostByCross)]
#[inline]
pub(crate) fn lost_by_cross(a: Vec3, b: Vec3) -> Lost {
    let (a_yzx, a_zxy) = (vec3(a.y, a.z, a.x), vec3(a.z, a.x, a.y));
    let (b_yzx, b_zxy) = (vec3(b.y, b.z, b.x), vec3(b.z, b.x, b.y));
    let lost = lost_by_product(a_yzx, b_zxy);
    let lost_too = lost_by_product(a_zxy, b_yzx);
    Lost { most: lost - lost_too, rest: lost_by_difference(lost, lost_too) }
}

/// Rounding bounds of [`lost_by_cross()`]: it is small, where intervals would only widen.
#[derive(Debug)]
struct LostByCross;

/// Factor that splits a number in halves, rounded up.
const SPLIT: f64 = 4098.0;
/// Number of sums and products in the error of one product that may underflow.
const PARTS: f64 = 8.0;

impl KnownFunction for LostByCross {
    /// Returns 0 in `f64`. Each product loses at most its rounding error; a device that fuses or
    /// reorders its computation may be off by as much again.
    fn bound(&self, m: &Margin, args: &[Known]) -> Option<Vec<Known>> {
        let size = |i: usize| args[i].range.magnitude();
        let product = |i: usize, j: usize| {
            let (a, b) = (size(i), size(3 + j));
            // A factor is split in halves by a multiple of it; beyond the largest number that is
            // infinite, and the rest is NaN.
            let largest = (SPLIT * a).max(SPLIT * b).max(a * b);
            if largest > f64::from(f32::MAX) {
                return f64::INFINITY;
            }
            2.0 * (m.rounding().sum * a * b + PARTS * m.rounding().least)
        };
        let lost = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| product(i, j) + product(j, i));
        let nan = args.iter().any(|v| v.range.nan || v.range.is_nan());
        let within = |error: f64| {
            let nan = nan || !error.is_finite();
            m.bounded(0.0, Interval::new(-error, error, nan))
        };
        let rest = lost.map(|error| 2.0 * (m.rounding().sum * error + m.rounding().least));
        Some(lost.into_iter().chain(rest).map(within).collect())
    }
}

/// Returns the cross product with at most 2 ulp lost of each component, however much they cancel:
/// their signs are those of the exact ones.
#[kernel]
#[inline(never)]
pub(crate) fn exact_cross(a: Vec3, b: Vec3) -> Vec3 {
    let lost = lost_by_cross(a, b);
    kept(kept(a.cross(b)) + lost.most) + lost.rest
}
