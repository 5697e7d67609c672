//! Coverage of split primitives by the leaves that hold their parts.
//!
//! A leaf's box bounds parts of several primitives, and the cuts are no longer known. The check is
//! whether the boxes leave a gap along an axis in which the primitive has points, as
//! [`Primitive::split_primitive`](crate::geometry::Primitive::split_primitive) says.

use super::build::Source;
use crate::geometry::Aabb;

/// Returns whether `leaves`, boxes that hold parts of a primitive, cover it along every axis.
pub(super) fn is_covered(source: &dyn Source, primitive: usize, leaves: &mut [Aabb]) -> bool {
    let whole = trimmed(source, primitive);
    (0..3).all(|axis| {
        leaves.sort_unstable_by(|a, b| a.min[axis].total_cmp(&b.min[axis]));
        let mut end = whole.min[axis];
        for leaf in &*leaves {
            if leaf.min[axis] > end
                && has_points(source, primitive, whole, axis, [end, leaf.min[axis]])
            {
                return false;
            }
            end = end.max(leaf.max[axis]);
        }
        let last = whole.max[axis];
        end >= last || !has_points(source, primitive, whole, axis, [end, last])
    })
}

/// Returns a box around the primitive as tight as its parts, which its own need not be.
fn trimmed(source: &dyn Source, primitive: usize) -> Aabb {
    let whole = source.bounds(primitive);
    (0..3).fold(whole, |all, axis| {
        let (below, above) = source.split(primitive, axis, whole.center()[axis]);
        let parts = [below, above].into_iter().filter(|part| part.is_valid());
        let both = parts.fold(Aabb::EMPTY, Aabb::union).intersection(all);
        if both.is_valid() { both } else { all }
    })
}

/// Returns whether the primitive has points between two planes, beyond the rounding of a plane.
fn has_points(
    source: &dyn Source,
    primitive: usize,
    whole: Aabb,
    axis: usize,
    [from, to]: [f32; 2],
) -> bool {
    let (_, above) = source.split(primitive, axis, from);
    let (below, _) = source.split(primitive, axis, to);
    let between = above.intersection(below).intersection(whole);
    let largest = whole.min[axis].abs().max(whole.max[axis].abs());
    between.is_valid() && between.max[axis] - between.min[axis] > 4.0 * f32::EPSILON * largest
}
