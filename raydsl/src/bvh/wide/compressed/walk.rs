//! The traversal of a device by one ray of the host: what the text `on/wgsl/wide.wgsl` does.

use glam::Vec3;

use super::{CompressedNode, LAST_PLANE, cell_sizes};
use crate::bvh::contract::{
    Padding, Slabs, enter_leave, is_before, is_finite, is_within, limit_behind, slabs,
};
use crate::bvh::{Bvh, Cost};
use crate::geometry::{Hit, HitRecord, Primitive, Ray};

impl CompressedNode {
    /// Returns the corners of the box in a slot.
    pub(super) fn corners(&self, slot: usize) -> [Vec3; 2] {
        let cells = cell_sizes(self.exponents);
        [0, 1].map(|side| {
            let number = |axis: usize| f32::from(self.planes[axis][side][slot]);
            Vec3::from(self.corner) + Vec3::new(number(0), number(1), number(2)) * cells
        })
    }

    /// Returns the primitives of a slot: the first of them, and how many.
    pub(super) fn leaf(&self, slot: usize) -> [usize; 2] {
        let count = |slot: usize| (self.counts >> (4 * slot) & 15) as usize;
        [self.first_leaf as usize + (0..slot).map(count).sum::<usize>(), count(slot)]
    }

    /// Returns the slots in the order in which a ray is likely to enter them, whose direction is
    /// negative along the axes `octant`.
    fn order(octant: u32) -> impl Iterator<Item = usize> {
        (0..8).map(move |i| (i ^ octant) as usize)
    }

    /// Returns the slots whose boxes a ray enters up to `limit`.
    fn entered(&self, s: Slabs, ray: &Ray, limit: f32) -> u32 {
        let enters = |&slot: &usize| {
            let [low, high] = self.corners(slot);
            let span = enter_leave(s, low, high, ray.t_min, limit);
            span.x <= span.y
        };
        (0..8).filter(enters).fold(0, |all, slot| all | 1 << slot)
    }
}

impl<P: Primitive> Bvh<'_, P> {
    /// Finds the least `(t, id)` hit of a ray, or any, as a device does in a wide tree; returns the
    /// nodes that it reads, each with eight boxes, and the primitives. `None` if a device does not read a wide tree: it was
    /// not built, was refitted, or has coordinates that are too large.
    #[doc(hidden)]
    pub fn hit_on_device(&self, ray: Ray, is_any: bool) -> Option<(Hit, Cost)> {
        let wide = self.tree.own.structure.wide().filter(|wide| wide.is_for_devices())?;
        let tree = wide.compressed(self.tree.prims, self.tree.shared);
        let (mut best, mut cost, mut limit) = (Hit::miss(), Cost::default(), ray.t_max);
        if tree.nodes.is_empty() || !is_finite(ray) {
            return Some((best, cost));
        }
        let root = &tree.nodes[0];
        let corner = Vec3::from(root.corner);
        let end = corner + LAST_PLANE as f32 * cell_sizes(root.exponents);
        let s = slabs(false, ray, corner, end, Padding::of::<P>().slack, 0.0);
        let (mut at, mut stack) = (0, Vec::new());
        let octant = ray.direction.cmplt(Vec3::ZERO).bitmask();
        loop {
            cost.nodes += 1;
            let node = &tree.nodes[at];
            let entered = node.entered(s, &ray, limit);
            for slot in CompressedNode::order(octant).filter(|slot| entered >> slot & 1 == 1) {
                let [first, count] = node.leaf(slot);
                for &id in &tree.ids[first..first + count] {
                    cost.primitives += 1;
                    let record =
                        self.tree.prims[id as usize].intersect(ray, self.tree.shared.slices());
                    let hit = Hit { prim_id: id, ..record.hit() };
                    if is_within(hit, ray) && is_before(false, hit, best) {
                        best = hit;
                        limit = limit_behind(hit.t, P::SLACK, ray.t_max);
                        if is_any {
                            return Some((best, cost));
                        }
                    }
                }
            }
            // The children that are left of a node: the first of them all, the slots that the ray
            // enters, in its order, and all slots of nodes.
            let inner = (0..8).filter(|i| (node.slots & entered) >> (i ^ octant) & 1 == 1);
            let left = inner.fold(0u32, |all, i| all | 1 << i);
            let group = match left {
                0 => stack.pop(),
                left => Some((node.first_node, left, node.slots & 255)),
            };
            let Some((first, mut left, slots)) = group else { return Some((best, cost)) };
            let slot = left.trailing_zeros() ^ octant;
            left &= left - 1;
            if left != 0 {
                stack.push((first, left, slots));
                assert!(stack.len() < wide.levels(), "a group for each level but the last");
            }
            at = (first + (slots & ((1 << slot) - 1)).count_ones()) as usize;
        }
    }
}
