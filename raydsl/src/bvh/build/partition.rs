//! Partitions of a range of references.

use glam::Vec4;

use super::binned_sah::{Grid, Plane};
use super::reference::{Bounds, Reference, Span};
use super::watch::Watch;

/// Iterations between two checks for cancellation.
const PIECE: usize = 1 << 16;

/// Moves the references left of `plane` to the front; returns their number and the centroid bounds
/// of both sides.
///
/// The loop is branch-free: sides are as good as random, so a branch would be unpredictable and
/// half of them mispredicted. Both stores of the exchange always happen, and the bounds of both
/// sides are always updated: the other side's with an infinitely distant point that changes
/// nothing.
pub(super) fn by_plane(
    references: &mut [Reference],
    grid: &Grid,
    plane: &Plane,
    watch: &Watch,
) -> (usize, [Bounds; 2]) {
    const DISTANCE: [Vec4; 2] = [Vec4::ZERO, Vec4::INFINITY];
    let limit = Vec4::splat(plane.position());
    let [mut left, mut right] = [Bounds::EMPTY; 2];
    let mut end = 0;
    for start in (0..references.len()).step_by(PIECE) {
        if watch.is_stopped() {
            break;
        }
        for k in start..references.len().min(start + PIECE) {
            let reference = references[k];
            let centroid = reference.centroid();
            let lanes = grid.position(centroid).cmplt(limit).bitmask();
            let is_left = (lanes >> plane.axis & 1) as usize;

            // Swap the reference with the first of the right side, and keep it there if it is left.
            references[k] = references[end];
            references[end] = reference;
            end += is_left;

            // Grow the centroid bounds of its side.
            let (from_left, from_right) = (DISTANCE[1 - is_left], DISTANCE[is_left]);
            left.lo = left.lo.min(centroid + from_left);
            left.hi = left.hi.max(centroid - from_left);
            right.lo = right.lo.min(centroid + from_right);
            right.hi = right.hi.max(centroid - from_right);
        }
    }
    (end, [left, right])
}

/// Moves the lower half along the longest axis of the centroids to the front.
///
/// For the rare node whose budget forbids an unbalanced split; indices break ties.
pub(super) fn by_median(references: &mut [Reference], centroids: &Bounds) -> (usize, [Span; 2]) {
    let axis = (centroids.hi - centroids.lo).truncate().max_position();
    let middle = references.len() / 2;
    references.select_nth_unstable_by(middle, |a, b| {
        let by_centroid = a.centroid()[axis].total_cmp(&b.centroid()[axis]);
        by_centroid.then_with(|| a.index().cmp(&b.index()))
    });
    (middle, spans(references, middle))
}

/// Halves the range in its current order, for coincident centroids.
pub(super) fn by_order(references: &[Reference]) -> (usize, [Span; 2]) {
    let middle = references.len() / 2;
    (middle, spans(references, middle))
}

fn spans(references: &[Reference], middle: usize) -> [Span; 2] {
    let (left, right) = references.split_at(middle);
    [Span::of(left), Span::of(right)]
}
