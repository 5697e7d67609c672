//! Where rays that end soon begin: at a node made for them, of the boxes that any of them may
//! enter, instead of going down from the root one by one.

use super::Wide;
use super::beam::{Extents, pad};
use super::node::{Child, WIDTH, WideNode};
use super::rays::{GROUP, Rays, lanes_mask, load, row};
use crate::bvh::contract::Padding;
use crate::geometry::Aabb;
use crate::machine::Lanes;

/// Fewer rays than this are sooner traced than their node is made.
const FEWEST: u32 = 48;

/// So many nodes are opened for it at most.
const OPENED: usize = 8;

/// A node of the boxes that the rays which are alive may enter within their limits; none if they
/// are few, or some have no end. What does not fit into it stays closed.
#[inline(always)]
pub(super) fn of<E: Lanes>(
    e: E,
    tree: &Wide,
    rays: &Rays,
    root: &Aabb,
    padding: Padding,
) -> Option<WideNode> {
    let count: u32 = rays.marks.iter().map(|marks| marks.alive.count_ones()).sum();
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

/// Children of nodes, in the order in which rays should visit them.
struct Entries {
    count: usize,
    boxes: [Aabb; WIDTH],
    children: [Child; WIDTH],
}

impl Entries {
    /// The inner node with the largest box; the last of several.
    #[inline(never)]
    fn largest(&self) -> Option<usize> {
        let inner = (0..self.count).filter(|&i| !self.children[i].is_block());
        let area = |i: usize| self.boxes[i].half_area();
        inner.max_by(|&i, &j| area(i).total_cmp(&area(j)))
    }

    /// Puts the children of the root, or of an entry in its place, that `bounds` meets; not if they
    /// are too many.
    fn open(&mut self, tree: &Wide, bounds: &Aabb, entry: Option<usize>) -> bool {
        let node = &tree.nodes[entry.map_or(0, |i| self.children[i].index())];
        let mut met = [0; WIDTH];
        let mut count = 0;
        for slot in 0..WIDTH {
            met[count] = slot;
            count += usize::from(meets(node, slot, bounds));
        }
        let (at, others) = entry.map_or((0, 0), |i| (i, self.count - 1));
        if others + count > WIDTH {
            return false;
        }
        // Those behind the entry move.
        let behind = others - at;
        self.boxes.copy_within(self.count - behind..self.count, at + count);
        self.children.copy_within(self.count - behind..self.count, at + count);
        for (i, &slot) in met[..count].iter().enumerate() {
            self.boxes[at + i] = node.bounds(slot);
            self.children[at + i] = Child(node.children[slot]);
        }
        self.count = others + count;
        true
    }
}

/// Whether the box in a slot and `bounds` have a point in common.
#[inline(always)]
fn meets(node: &WideNode, slot: usize, bounds: &Aabb) -> bool {
    let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
    let along = |axis: usize| {
        (node.planes[2 * axis][slot] <= high[axis]) & (node.planes[2 * axis + 1][slot] >= low[axis])
    };
    along(0) & along(1) & along(2)
}

/// A box around what the rays reach; none if some have no end.
#[inline(always)]
fn bounds<E: Lanes>(e: E, rays: &Rays, root: &Aabb, padding: Padding) -> Option<Aabb> {
    if !have_ends(e, rays) {
        return None;
    }
    let mut origins = [Extents::none(e); 3];
    let mut ends = [Extents::none(e); 3];
    each_alive(
        e,
        rays,
        #[inline(always)]
        |group, from, alive| {
            let first = load(e, rays.row(group, row::T_MIN), from);
            let last = load(e, rays.row(group, row::LIMIT), from);
            for axis in 0..3 {
                let o = load(e, rays.row(group, row::ORIGIN + axis), from);
                let d = load(e, rays.row(group, row::DIRECTION + axis), from);
                origins[axis].add(e, o, alive);
                ends[axis].add(e, e.f32_mul_add_fast(d, first, o), alive);
                ends[axis].add(e, e.f32_mul_add_fast(d, last, o), alive);
            }
        },
    );
    let origins = [origins[0].extent(e), origins[1].extent(e), origins[2].extent(e)];
    // What rounding takes from an end is within what boxes are widened by, or lies outside the
    // scene.
    let pad = pad(&origins, root, padding);
    let mut bounds = Aabb::EMPTY;
    for (axis, end) in ends.into_iter().enumerate() {
        let end = end.extent(e);
        bounds.min[axis] = end.least - pad;
        bounds.max[axis] = end.greatest + pad;
    }
    bounds.is_finite().then_some(bounds)
}

/// Whether all rays that are alive end somewhere.
#[inline(always)]
pub(super) fn have_ends<E: Lanes>(e: E, rays: &Rays) -> bool {
    let mut limits = Extents::none(e);
    each_alive(
        e,
        rays,
        #[inline(always)]
        |group, from, alive| limits.add(e, load(e, rays.row(group, row::LIMIT), from), alive),
    );
    // `f32::MAX` is what rays have that go on.
    limits.extent(e).greatest < f32::MAX
}

/// Calls `see` for the rays that are alive: with their group, where they begin in it, and which of
/// them are.
#[inline(always)]
fn each_alive<E: Lanes>(e: E, rays: &Rays, mut see: impl FnMut(usize, usize, E::Mask)) {
    for (group, marks) in rays.marks.iter().enumerate() {
        for from in (0..GROUP).step_by(E::N) {
            let alive = marks.alive >> from & lanes_mask::<E>();
            if alive != 0 {
                see(group, from, e.mask_from_bits(alive.into()));
            }
        }
    }
}
