//! Descent through instances by a SIMD packet: [`Descent`](super::Descent) with active masks.

use super::placed::{Placing, STACK, Target};
use crate::bvh::contract::is_finite;
use crate::bvh::packet_slabs::{PacketSlabs, and};
use crate::bvh::traverse::Stack;
use crate::geometry::{RayOn, transform_ray};
use crate::machine::{Lanes, Packet, Type, op};

/// Traversal of the groups of a scene that stops at every tree some ray may enter.
pub(crate) struct PacketDescent<'a, L: Lanes> {
    groups: &'a [Placing],
    levels: Vec<Level<'a, L>>,
    /// Pending items. Lanes that do not enter one have NaN, which is within no limit.
    stack: Stack<L::F32, STACK>,
}

/// A group that is being traversed.
struct Level<'a, L: Lanes> {
    group: &'a Placing,
    /// The instance id of the first tree in it.
    first: u32,
    /// The rays in the space of the group.
    ray: RayOn<Packet<L>>,
    slabs: PacketSlabs<L>,
    /// The length of the stack when the group was entered.
    bottom: usize,
}

/// A placed tree.
pub(crate) struct PacketPlace<L: Lanes> {
    pub(crate) tree: u32,
    pub(crate) inst: u32,
    /// The rays in the space of the tree.
    pub(crate) ray: RayOn<Packet<L>>,
    /// The rays that may enter it.
    pub(crate) mask: L::Mask,
}

impl<'a, L: Lanes> PacketDescent<'a, L> {
    /// Begins a traversal of the last group.
    #[inline(never)]
    pub(crate) fn new(
        l: L,
        groups: &'a [Placing],
        ray: &RayOn<Packet<L>>,
        active: L::Mask,
    ) -> Box<Self> {
        l.enter_again(
            #[inline(always)]
            || {
                let levels = Vec::with_capacity(1);
                let mut descent = Box::new(Self { groups, levels, stack: Stack::new() });
                if let Some(top) = groups.last() {
                    descent.enter(l, top, 0, ray, active, ray.t_max.0);
                }
                descent
            },
        )
    }

    /// Enters a group if some active ray may enter its bounds.
    #[inline(always)]
    fn enter(
        &mut self,
        l: L,
        group: &'a Placing,
        first: u32,
        ray: &RayOn<Packet<L>>,
        active: L::Mask,
        limit: L::F32,
    ) {
        let Some(root) = group.branches().nodes.first() else { return };
        let slabs = PacketSlabs::new(l, ray, active, root, group.padding);
        let (enter, hit) = slabs.enter(l, root, limit);
        let hit = and(l, active, hit);
        if l.any(hit) {
            self.levels.push(Level { group, first, ray: *ray, slabs, bottom: self.stack.len() });
            self.stack.push(0, l.f32_select(hit, enter, l.f32(f32::NAN)));
        }
    }

    /// Returns the next tree that some active ray may enter within its `limit`.
    #[inline(never)]
    pub(crate) fn next(&mut self, l: L, active: L::Mask, limit: L::F32) -> Option<PacketPlace<L>> {
        l.enter_again(
            #[inline(always)]
            || {
                let m = Packet::with_mask(l, active);
                while let Some(level) = self.levels.last() {
                    let (group, first) = (level.group, level.first);
                    let Some((index, mask)) = self.next_item(l, active, limit) else {
                        self.levels.pop();
                        continue;
                    };
                    let (item, level) =
                        (&group.items[index as usize], &self.levels[self.levels.len() - 1]);
                    let map = Type::splat(&m, item.to_object);
                    let ray = transform_ray::on(&m, level.ray, map);
                    let (inst, mask) = (first + item.first, and(l, mask, is_finite::on(&m, ray).0));
                    match item.target {
                        Target::Tree(tree) if l.any(mask) => {
                            return Some(PacketPlace { tree, inst, ray, mask });
                        }
                        Target::Tree(_) => {}
                        Target::Group(group) => {
                            self.enter(l, &self.groups[group as usize], inst, &ray, mask, limit);
                        }
                    }
                }
                None
            },
        )
    }

    /// Returns the next instance of the innermost group that some active ray may enter, and the
    /// mask of those rays.
    #[inline(always)]
    fn next_item(&mut self, l: L, active: L::Mask, limit: L::F32) -> Option<(u32, L::Mask)> {
        let level = self.levels.last()?;
        let tree = level.group.branches();
        while self.stack.len() > level.bottom {
            let (index, enter) = self.stack.pop()?;
            let mut mask = and(l, active, l.f32_compare(op::Le, enter, limit));
            let mut node = &tree.nodes[index as usize];
            while l.any(mask) {
                if node.is_leaf() {
                    return Some((tree.indices[node.first as usize], mask));
                }
                let children = &tree.nodes[node.first as usize..node.first as usize + 2];
                let (t0, hit0) = level.slabs.enter(l, &children[0], limit);
                let (t1, hit1) = level.slabs.enter(l, &children[1], limit);
                let (hit0, hit1) = (and(l, mask, hit0), and(l, mask, hit1));
                let both = and(l, hit0, hit1);
                let left = and(l, both, l.f32_compare(op::Le, t0, t1));
                // Visit the child that more lanes enter first; push the other if any lane enters
                // it.
                let left_first = match (l.any(hit0), l.any(hit1)) {
                    (true, true) => 2 * l.bits(left).count_ones() >= l.bits(both).count_ones(),
                    (left, _) => left,
                };
                let far = l.f32(f32::NAN);
                let (next, wait) = if left_first {
                    ((&children[0], hit0), (1, t1, hit1))
                } else {
                    ((&children[1], hit1), (0, t0, hit0))
                };
                if l.any(wait.2) {
                    self.stack.push(node.first + wait.0, l.f32_select(wait.2, wait.1, far));
                }
                (node, mask) = next;
            }
        }
        None
    }
}
