//! Ray packets: coherent rays, traced with interval culling.

use super::Wide;
use super::beam::{Beam, extent};
use super::blocks::{self, Row, has_boxes};
use super::counts::{self, Event};
use super::node::{Child, NO_BOXES, Planes, WIDTH};
use super::octant::{GROUPS, Octant};
use super::pairs::{Pairs, ROOM};
use super::rays::{ActiveMasks, GROUP, Group, Rays, lanes_mask, load, load_words, place, row};
use super::step::{LeafIntersector, count, enter, ids, last_key, nearest, sorted};
use crate::bvh::contract::{Padding, is_within, limit_behind, precedes};
use crate::bvh::packet_slabs::{and, max, min};
use crate::geometry::{Aabb, HitOn, HitRecord, Primitive, RayOn};
use crate::machine::{Entered, F, Lanes, Packet, U, V3, op};

/// Minimum number of rays of one octant that form a packet, unless they are most of the active
/// rays.
const FEWEST: u32 = 12;

/// Maximum spread of a packet's directions along an axis, relative to the largest component: rays
/// that diverge further visit fewer nodes in a stream.
const SPREAD: f32 = 0.5;

/// The share of a register's rays from which a primitive is tested with that register; pairs of fewer
/// rays and a primitive wait for others.
const FULL: (usize, usize) = (3, 4);

/// A block adds pairs of fewer than that share of a packet's rays, to fewer than a register of others.
const _: () = assert!(GROUPS * GROUP * WIDTH * FULL.0 / FULL.1 + GROUP <= ROOM);

/// Scratch memory of packets, reused by the next query.
#[derive(Debug, Default)]
pub(super) struct PacketScratch {
    /// Pending slots, each as eight times its node's index plus its index in the node.
    pub(super) stack: Vec<u32>,
    /// The entry distances of the packet, as the bits of floats above 0 with the slot in the last
    /// three.
    enters: Vec<u32>,
    /// The rays of the packet.
    pub(super) octant: Octant,
    pairs: Pairs,
}

impl PacketScratch {
    /// Grows the stacks for a tree: all pending slots, and eight more, since eight are written at
    /// once.
    pub(super) fn make_room(&mut self, tree: &Wide) {
        let room = 1 + tree.pending + WIDTH;
        for stack in [&mut self.stack, &mut self.enters] {
            if stack.len() < room {
                stack.resize(room, 0);
            }
        }
    }
}

/// Finds the least hits of rays that form packets, and leaves the others active. With `is_forced`,
/// all rays of an octant form a packet, however far they diverge.
#[inline(always)]
pub(super) fn closest_hit<R: Lanes, P: Primitive>(
    r: R,
    intersector: &LeafIntersector<'_, P>,
    rays: &mut Rays,
    packet_scratch: &mut PacketScratch,
    root: &Aabb,
    is_forced: bool,
) {
    let (at_least, spread) = if is_forced { (2, f32::INFINITY) } else { (FEWEST, SPREAD) };
    for groups in Octant::ranges(rays.masks.len()) {
        let active = |masks: &ActiveMasks| masks.active.count_ones();
        let mut left: u32 = rays.masks[groups.clone()].iter().map(active).sum();
        let fewest = at_least.min(left / 4 * 3).max(2);
        while left > 0 {
            let octant = &mut packet_scratch.octant;
            let size = octant.take(rays, groups.clone());
            left -= size;
            let beam = if size < fewest {
                None
            } else {
                Beam::of(r.eight(), rays, octant, spread, root, Padding::of::<P>())
            };
            if let Some(beam) = beam {
                counts::some(Event::BeamRay, size);
                traverse(r, intersector, rays, packet_scratch, beam);
                continue;
            }
            for (group, members) in octant.groups() {
                rays.masks[group].stream_fallback |= members;
            }
        }
    }
    for masks in &mut rays.masks {
        masks.active = core::mem::take(&mut masks.stream_fallback);
    }
}

/// Traces a packet through the tree.
#[inline(always)]
fn traverse<R: Lanes, P: Primitive>(
    r: R,
    intersector: &LeafIntersector<'_, P>,
    rays: &mut Rays,
    packet_scratch: &mut PacketScratch,
    mut beam: Beam,
) {
    let (e, tree) = (r.eight(), intersector.tree);
    packet_scratch.make_room(tree);
    let PacketScratch { stack, enters, octant, pairs } = packet_scratch;
    counts::one(Event::Beam);
    let mut packet = RayPacket::new(r, rays, octant, beam.side);
    let (mut at, mut slot, mut top) = (Child::node(0), 0, 0);
    loop {
        if at.is_block() {
            // Intersect a block, and lower the limit if any hit is nearer.
            counts::one(Event::BeamBlock);
            let around = (&tree.nodes[slot / WIDTH].planes, slot % WIDTH);
            if packet.closest_hits(intersector, at.index(), around, &beam, pairs) {
                beam.limit = extent(e, packet.rays, packet.octant, row::LIMIT).greatest;
            }
        } else {
            // Push the children that the beam enters, the nearest last.
            counts::one(Event::BeamNode);
            let node = &tree.nodes[at.index()];
            let (near, mask) = enter(e, &node.planes, &beam);
            let entered = e.bits(mask).count_ones() as usize;
            let keys = sorted(e, near, mask);
            let below = e.u32_binary(op::And, keys, e.u32(7));
            let below = e.u32_binary(op::Or, below, e.u32(8 * at.0));
            e.u32_store(below, &mut stack[top..][..WIDTH]);
            e.u32_store(keys, &mut enters[top..][..WIDTH]);
            if entered > 0 {
                // The nearest child is visited next instead of being pushed.
                top += entered - 1;
                let first = nearest(e, near, mask);
                slot = WIDTH * at.index() + first;
                at = Child(node.children[first]);
                continue;
            }
        }
        // Pop the next child within the limit.
        let last = last_key(beam.limit);
        loop {
            if top == 0 {
                if const { has_boxes::<P>() } {
                    pairs.flush::<true, R, P>(r, intersector, packet.rays.words());
                }
                return;
            }
            top -= 1;
            if enters[top] & !7 <= last {
                break;
            }
        }
        slot = stack[top] as usize;
        at = Child(tree.nodes[slot / WIDTH].children[slot % WIDTH]);
    }
}

/// Ray packet in traversal.
pub(super) struct RayPacket<'a, R: Lanes> {
    r: R,
    m: Packet<Entered<R>>,
    pub(super) rays: &'a mut Rays,
    pub(super) octant: &'a mut Octant,
    side: [usize; 3],
}

impl<'a, R: Lanes> RayPacket<'a, R> {
    #[inline(always)]
    pub(super) fn new(r: R, rays: &'a mut Rays, octant: &'a mut Octant, side: [usize; 3]) -> Self {
        Self { r, m: Packet::new(Entered::new(r)), rays, octant, side }
    }

    #[inline(always)]
    fn register(&mut self, group: usize, from: usize) -> Register<'_, R> {
        Register { r: self.r, m: &self.m, group: self.rays.group_mut(group), from }
    }

    /// Intersects the primitives of a block, whose box is in a slot of a node; returns whether any
    /// ray has a nearer hit.
    #[inline(always)]
    fn closest_hits<P: Primitive>(
        &mut self,
        intersector: &LeafIntersector<'_, P>,
        block: usize,
        (planes, slot): (&Planes, usize),
        beam: &Beam,
        pairs: &mut Pairs,
    ) -> bool {
        let (r, side) = (self.r, self.side);
        let tested = Members::of(r.eight(), intersector, block, beam, true);
        if tested.count == 0 {
            return false;
        }
        let mut is_nearer = false;
        for (group, members) in self.octant.groups() {
            for from in (0..GROUP).step_by(R::N) {
                let active = members >> from & lanes_mask::<R>();
                if active == 0 {
                    continue;
                }
                let lanes = self.register(group, from);
                let entering = lanes.enter(planes, slot, side);
                let entering = and(r, entering, r.mask_from_bits(active.into()));
                if r.any(entering) {
                    let first = place(GROUP * group + from);
                    let to_test = (&mut *pairs, first);
                    let is_hit = lanes.closest_hits(intersector, &tested, side, entering, to_test);
                    counts::some(Event::Nearer, is_hit.into());
                    is_nearer |= is_hit;
                }
            }
        }
        if const { has_boxes::<P>() } {
            is_nearer |= pairs.flush_full(r, intersector, self.rays.words());
        }
        is_nearer
    }

    /// Returns the masks of the rays that enter the box in a slot of a node within their limits,
    /// and how many they are.
    #[inline(always)]
    pub(super) fn enter(&mut self, planes: &Planes, slot: usize) -> ([u32; GROUPS], u32) {
        let (r, side) = (self.r, self.side);
        let (mut entering, mut count) = ([0; GROUPS], 0);
        for (entering, (group, members)) in entering.iter_mut().zip(self.octant.groups()) {
            for from in (0..GROUP).step_by(R::N) {
                let active = members >> from & lanes_mask::<R>();
                if active != 0 {
                    let lanes = self.register(group, from);
                    let hits = r.bits(lanes.enter(planes, slot, side)) as u32 & active;
                    *entering |= hits << from;
                    count += hits.count_ones();
                }
            }
        }
        (entering, count)
    }

    /// Intersects the primitives of a block with some of the rays, and removes those with a hit
    /// from the packet; returns whether any ray is left.
    #[inline(always)]
    pub(super) fn any_hits<P: Primitive>(
        &mut self,
        intersector: &LeafIntersector<'_, P>,
        block: usize,
        entering: [u32; GROUPS],
        beam: &Beam,
    ) -> bool {
        let (r, side) = (self.r, self.side);
        let tested = Members::of(r.eight(), intersector, block, beam, false);
        if tested.count == 0 {
            return true;
        }
        let mut hits = [0; GROUPS];
        for ((hits, entering), (group, _)) in
            hits.iter_mut().zip(entering).zip(self.octant.groups())
        {
            for from in (0..GROUP).step_by(R::N) {
                let active = entering >> from & lanes_mask::<R>();
                if active != 0 {
                    let active = r.mask_from_bits(active.into());
                    let lanes = self.register(group, from);
                    *hits |= lanes.any_hits(intersector, &tested, side, active) << from;
                }
            }
        }
        self.octant.leave(hits)
    }
}

/// The primitives of a block that a packet tests.
struct Members<'a> {
    block: &'a [Row],
    /// The index of the block.
    index: usize,
    /// The boxes of the primitives, if they [have boxes](has_boxes).
    boxes: &'a Planes,
    /// The slots of those whose boxes the packet's beam enters, the nearest last.
    slots: [u32; WIDTH],
    count: usize,
}

impl<'a> Members<'a> {
    /// Returns the primitives of a block that the rays of a beam may hit; in their order along the
    /// beam if that matters.
    #[inline(always)]
    fn of<E: Lanes, P: Primitive>(
        e: E,
        intersector: &'a LeafIntersector<'_, P>,
        index: usize,
        beam: &Beam,
        is_ordered: bool,
    ) -> Self {
        let block = intersector.rows(index);
        if const { !has_boxes::<P>() } {
            let count = count(e, block);
            return Self { block, index, boxes: &NO_BOXES, slots: [0; WIDTH], count };
        }
        let boxes = intersector.tree.blocks.boxes(index);
        let (near, mask) = enter(e, boxes, beam);
        let mut slots = [0; WIDTH];
        if is_ordered {
            e.u32_store(sorted(e, near, mask), &mut slots);
        } else {
            let all = e.u32_from_fn(
                #[inline(always)]
                |i| i as u32,
            );
            e.u32_store(e.u32_compress(all, mask), &mut slots);
        }
        Self { block, index, boxes, slots, count: e.bits(mask).count_ones() as usize }
    }

    /// Returns the slot of the primitive that is tested next, after `k` others.
    #[inline(always)]
    fn slot<P: Primitive>(&self, k: usize) -> usize {
        if const { has_boxes::<P>() } {
            self.slots[(self.count - 1 - k) % WIDTH] as usize % WIDTH
        } else {
            k
        }
    }
}

/// A register of rays.
struct Register<'a, R: Lanes> {
    r: R,
    m: &'a Packet<Entered<R>>,
    group: &'a mut Group,
    from: usize,
}

impl<R: Lanes> Register<'_, R> {
    #[inline(always)]
    fn float(&self, row: usize) -> R::F32 {
        load(self.r, &self.group[row].0, self.from)
    }

    #[inline(always)]
    fn set(&mut self, row: usize, word: R::U32) {
        self.r.u32_store(word, &mut self.group[row].0[self.from..]);
    }

    #[inline(always)]
    fn set_float(&mut self, row: usize, value: R::F32) {
        self.set(row, self.r.f32_to_bits(value));
    }

    #[inline(always)]
    fn vector(&self, row: usize) -> V3<Packet<Entered<R>>> {
        V3 { x: F(self.float(row)), y: F(self.float(row + 1)), z: F(self.float(row + 2)) }
    }

    /// Returns the mask of the rays that enter a box within their limits.
    #[inline(always)]
    fn enter(&self, planes: &Planes, slot: usize, side: [usize; 3]) -> R::Mask {
        counts::one(Event::RegisterBox);
        let r = self.r;
        let mut near = self.float(row::T_MIN);
        let mut far = self.float(row::LIMIT);
        for (axis, side) in side.into_iter().enumerate() {
            let first = r.f32(planes[2 * axis + (side & 1)][slot % WIDTH]);
            let last = r.f32(planes[2 * axis + 1 - (side & 1)][slot % WIDTH]);
            let inverse = self.float(row::INVERSE + axis);
            near = max(r, near, r.f32_mul_add_fast(first, inverse, self.float(row::FIRST + axis)));
            far = min(r, far, r.f32_mul_add_fast(last, inverse, self.float(row::LAST + axis)));
        }
        r.f32_compare(op::Le, near, far)
    }

    /// Loads the rays.
    #[inline(always)]
    fn ray(&self) -> RayOn<Packet<Entered<R>>> {
        RayOn {
            origin: self.vector(row::ORIGIN),
            direction: self.vector(row::DIRECTION),
            t_min: F(self.float(row::T_MIN)),
            t_max: F(self.float(row::T_MAX)),
        }
    }

    /// Intersects the first primitives of a block; returns the mask of the active rays with a hit.
    #[inline(always)]
    fn any_hits<P: Primitive>(
        mut self,
        intersector: &LeafIntersector<'_, P>,
        members: &Members<'_>,
        side: [usize; 3],
        mut active: R::Mask,
    ) -> u32 {
        let (r, m) = (self.r, self.m);
        let (ray, queried, block) = (self.ray(), active, members.block);
        counts::one(Event::RegisterBlock);
        for k in 0..members.count {
            let i = members.slot::<P>(k);
            let mut tested = active;
            if const { has_boxes::<P>() } {
                tested = and(r, active, self.enter(members.boxes, i % WIDTH, side));
                if !r.any(tested) {
                    continue;
                }
            }
            counts::one(Event::RegisterPrimitive);
            let prim = blocks::read::<_, P>(
                m,
                #[inline(always)]
                |word| r.u32(block[word].0[i % WIDTH]),
            );
            let record = m.with_active(
                tested,
                #[inline(always)]
                || P::intersect_among_on(m, intersector.kinds, prim, ray, intersector.shared),
            );
            let hit = P::Hit::hit_on(record);
            let hits = and(r, tested, is_within::on(m, hit, ray).0);
            if r.any(hits) {
                active = and(r, active, r.mask_not(hits));
                if !r.any(active) {
                    break;
                }
            }
        }
        let hits = and(r, queried, r.mask_not(active));
        let found = load_words(r, &self.group[row::FOUND].0, self.from);
        self.set(row::FOUND, r.u32_select(hits, r.u32(1), found));
        r.bits(hits) as u32
    }

    /// Intersects the first primitives of a block; returns whether any ray has a nearer hit.
    #[inline(always)]
    fn closest_hits<P: Primitive>(
        mut self,
        intersector: &LeafIntersector<'_, P>,
        members: &Members<'_>,
        side: [usize; 3],
        active: R::Mask,
        (pairs, first): (&mut Pairs, u32),
    ) -> bool {
        let (r, m) = (self.r, self.m);
        let (ray, block) = (self.ray(), members.block);
        let block_ids = ids(block);
        let mut is_nearer = false;
        counts::one(Event::RegisterBlock);
        // A function shared with `any_hits` would make these tests up to a tenth slower. Without
        // bounds checks inside, terms that depend only on the rays are hoisted out of the loop.
        for k in 0..members.count {
            let i = members.slot::<P>(k);
            let mut tested = active;
            if const { has_boxes::<P>() } {
                tested = and(r, active, self.enter(members.boxes, i % WIDTH, side));
                let count = r.bits(tested).count_ones() as usize;
                if count == 0 {
                    continue;
                }
                // Pairs of different primitives may be of different kinds, which take turns.
                if P::KINDS == 1 && FULL.1 * count < FULL.0 * R::N {
                    let primitive = (WIDTH * members.index + i % WIDTH) as u32;
                    pairs.add_rays(r, first, primitive, tested);
                    continue;
                }
            }
            counts::one(Event::RegisterPrimitive);
            let prim = blocks::read::<_, P>(
                m,
                #[inline(always)]
                |word| r.u32(block[word].0[i % WIDTH]),
            );
            let record = m.with_active(
                tested,
                #[inline(always)]
                || P::intersect_among_on(m, intersector.kinds, prim, ray, intersector.shared),
            );
            let hit = P::Hit::hit_on(record);
            let best = self.float(row::T);
            let t_max = F(min(r, ray.t_max.0, best));
            let hits = and(r, tested, is_within::on(m, hit, RayOn { t_max, ..ray }).0);
            if !r.any(hits) {
                continue;
            }
            let id = r.u32(intersector.part.first + block_ids[i % WIDTH]);
            let ids = load_words(r, &self.group[row::ID].0, self.from);
            let hit = HitOn { prim_id: U(id), ..hit };
            let before = HitOn { t: F(best), prim_id: U(ids), ..hit };
            let is_closer = and(r, hits, precedes::on(m, false, hit, before).0);
            let best = r.f32_select(is_closer, hit.t.0, best);
            let (u, v) = (self.float(row::U), self.float(row::V));
            let found = load_words(r, &self.group[row::FOUND].0, self.from);
            self.set_float(row::T, best);
            self.set_float(row::U, r.f32_select(is_closer, hit.u.0, u));
            self.set_float(row::V, r.f32_select(is_closer, hit.v.0, v));
            self.set(row::ID, r.u32_select(is_closer, id, ids));
            self.set(row::FOUND, r.u32_select(is_closer, r.u32(1), found));
            let limit = limit_behind::on(m, F(best), F(r.f32(P::SLACK)), ray.t_max);
            self.set_float(row::LIMIT, limit.0);
            is_nearer = true;
        }
        is_nearer
    }
}
