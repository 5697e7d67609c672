//! Entry nodes: short rays begin at a node made of the boxes that any of them may enter, instead of
//! each descending from the root.

use super::Wide;
use super::beam::{Extents, pad};
use super::node::{Child, WIDTH, WideNode};
use super::rays::{GROUP, Rays, lanes_mask, load, row};
use crate::bvh::contract::Padding;
use crate::geometry::Aabb;
use crate::machine::Lanes;

/// Minimum number of rays for an entry node: fewer are traced in less time.
const FEWEST: u32 = 48;

/// Maximum number of nodes opened for an entry node.
const OPENED: usize = 8;

/// Makes a node of the boxes that the active rays may enter within their limits; none if there are
/// few rays, or some are unbounded. Nodes whose children do not fit stay closed.
#[inline(always)]
pub(super) fn of<E: Lanes>(
    e: E,
    tree: &Wide,
    rays: &Rays,
    root: &Aabb,
    padding: Padding,
) -> Option<WideNode> {
    let count: u32 = rays.masks.iter().map(|masks| masks.active.count_ones()).sum();
    if count < FEWEST {
        return None;
    }
    let bounds = bounds(e, rays, root, padding)?;
    let mut entries =
        Entries { count: 0, boxes: [Aabb::EMPTY; WIDTH], children: [Child::NONE; WIDTH] };
    entries.open(tree, &bounds, None);
    for _ in 1..OPENED {
        let Some(largest) = entries.largest() else { break };
        if !entries.open(tree, &bounds, Some(largest)) {
            break;
        }
    }
    let mut node = WideNode::EMPTY;
    for i in 0..entries.count {
        node.set(i, entries.boxes[i], entries.children[i]);
    }
    Some(node)
}

/// Children of an entry node, in traversal order.
struct Entries {
    count: usize,
    boxes: [Aabb; WIDTH],
    children: [Child; WIDTH],
}

impl Entries {
    /// Returns the inner node with the largest box; the last of several.
    #[inline(never)]
    fn largest(&self) -> Option<usize> {
        let inner = (0..self.count).filter(|&i| !self.children[i].is_block());
        let area = |i: usize| self.boxes[i].half_area();
        inner.max_by(|&i, &j| area(i).total_cmp(&area(j)))
    }

    /// Replaces an entry by those of its children that overlap `bounds`, or adds those of the root.
    /// Returns false, and does nothing, if they do not fit.
    fn open(&mut self, tree: &Wide, bounds: &Aabb, entry: Option<usize>) -> bool {
        let node = &tree.nodes[entry.map_or(0, |i| self.children[i].index())];
        let mut overlapping = [0; WIDTH];
        let mut count = 0;
        for slot in 0..WIDTH {
            overlapping[count] = slot;
            count += usize::from(overlaps(node, slot, bounds));
        }
        let (at, others) = entry.map_or((0, 0), |i| (i, self.count - 1));
        if others + count > WIDTH {
            return false;
        }
        // Move the entries after it.
        let behind = others - at;
        self.boxes.copy_within(self.count - behind..self.count, at + count);
        self.children.copy_within(self.count - behind..self.count, at + count);
        for (i, &slot) in overlapping[..count].iter().enumerate() {
            self.boxes[at + i] = node.bounds(slot);
            self.children[at + i] = Child(node.children[slot]);
        }
        self.count = others + count;
        true
    }
}

/// Tests whether the box in a slot overlaps `bounds`.
#[inline(always)]
fn overlaps(node: &WideNode, slot: usize, bounds: &Aabb) -> bool {
    let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
    let along = |axis: usize| {
        (node.planes[2 * axis][slot] <= high[axis]) & (node.planes[2 * axis + 1][slot] >= low[axis])
    };
    along(0) & along(1) & along(2)
}

/// Computes the bounds of the active rays up to their limits; none if some are unbounded.
#[inline(always)]
fn bounds<E: Lanes>(e: E, rays: &Rays, root: &Aabb, padding: Padding) -> Option<Aabb> {
    if !are_bounded(e, rays) {
        return None;
    }
    let mut origins = [Extents::none(e); 3];
    let mut ends = [Extents::none(e); 3];
    each_active(
        e,
        rays,
        #[inline(always)]
        |group, from, active| {
            let first = load(e, rays.row(group, row::T_MIN), from);
            let last = load(e, rays.row(group, row::LIMIT), from);
            for axis in 0..3 {
                let o = load(e, rays.row(group, row::ORIGIN + axis), from);
                let d = load(e, rays.row(group, row::DIRECTION + axis), from);
                origins[axis].add(e, o, active);
                ends[axis].add(e, e.f32_mul_add_fast(d, first, o), active);
                ends[axis].add(e, e.f32_mul_add_fast(d, last, o), active);
            }
        },
    );
    let origins = [origins[0].extent(e), origins[1].extent(e), origins[2].extent(e)];
    // Rounding errors of an end are within the padding of boxes, or outside the scene.
    let pad = pad(&origins, root, padding);
    let mut bounds = Aabb::EMPTY;
    for (axis, end) in ends.into_iter().enumerate() {
        let end = end.extent(e);
        bounds.min[axis] = end.least - pad;
        bounds.max[axis] = end.greatest + pad;
    }
    bounds.is_finite().then_some(bounds)
}

/// Tests whether all active rays are bounded.
#[inline(always)]
pub(super) fn are_bounded<E: Lanes>(e: E, rays: &Rays) -> bool {
    let mut limits = Extents::none(e);
    each_active(
        e,
        rays,
        #[inline(always)]
        |group, from, active| limits.add(e, load(e, rays.row(group, row::LIMIT), from), active),
    );
    // Unbounded rays have `f32::MAX`.
    limits.extent(e).greatest < f32::MAX
}

/// Calls `visit` for each register of active rays: with its group, its first lane in the group, and
/// the active mask.
#[inline(always)]
fn each_active<E: Lanes>(e: E, rays: &Rays, mut visit: impl FnMut(usize, usize, E::Mask)) {
    for (group, masks) in rays.masks.iter().enumerate() {
        for from in (0..GROUP).step_by(E::N) {
            let active = masks.active >> from & lanes_mask::<E>();
            if active != 0 {
                visit(group, from, e.mask_from_bits(active.into()));
            }
        }
    }
}
