//! Ray streams: interleaved traversal of incoherent rays.
//!
//! Each ray has a stack of its own, and takes one step at a time: a node or a block. Rays at nodes
//! and rays at blocks are in separate lists, and move from one list to the other without a branch.
//! Where primitives have boxes, the rays at blocks are tested as [pairs](super::pairs).
//! So no unpredictable branch is left, and the processor works on the next rays while one waits for
//! memory.

use core::ops::Range;

use super::blocks::{Row, has_boxes};
use super::counts::{self, Event};
use super::node::{Child, WIDTH, WideNode};
use super::pairs::Pairs;
use super::rays::{GROUP, Rays, lanes_of, place, ray_at, ray_at_mut, row};
use super::step::{LeafIntersector, enter, ids, last_key, sorted, words};
use crate::bvh::contract::{limit_behind, precedes};
use crate::geometry::{Hit, HitOn, Primitive};
use crate::machine::{Lanes, Packet, op};

/// Scratch memory of ray streams, reused by the next query.
#[derive(Debug, Default)]
pub(super) struct RayStream {
    /// The stacks of pending children, one after another.
    stacks: Vec<u32>,
    /// The entry distances of these children, as the bits of floats above 0 with the slot in the
    /// last three.
    enters: Vec<u32>,
    /// The places of the rays that are at nodes.
    at_nodes: Vec<u32>,
    /// The places of the rays that are at blocks.
    at_blocks: Vec<u32>,
    pairs: Pairs,
}

/// Groups per stream: the stacks of more rays do not fit into the cache.
const GROUPS: usize = 16;

/// A list of the places of rays.
struct List<'a> {
    places: &'a mut [u32],
    len: usize,
}

impl List<'_> {
    /// Appends a ray if `condition` holds, without a branch: the place is written in either case.
    #[inline(always)]
    fn push_if(&mut self, condition: bool, ray: u32) {
        debug_assert!(self.len < self.places.len());
        // SAFETY: a ray is in at most one list, so a list has no more entries than there are rays.
        // It has room for one more, which is written where `condition` is false.
        unsafe { *self.places.get_unchecked_mut(self.len) = ray };
        self.len += usize::from(condition);
    }
}

/// The state of an interleaved traversal.
pub(super) struct Interleaved<'a> {
    stacks: &'a mut [u32],
    enters: &'a mut [u32],
    nodes: List<'a>,
    blocks: List<'a>,
    pairs: &'a mut Pairs,
    /// The most pending children of each ray.
    pending: u32,
}

impl RayStream {
    /// Begins a traversal of the active rays of some groups at the root.
    fn begin(
        &mut self,
        rays: &mut Rays,
        groups: Range<usize>,
        pending: usize,
        is_sorted: bool,
    ) -> Interleaved<'_> {
        let mut interleaved = self.begin_empty(rays, groups.clone(), pending, is_sorted);
        for group in groups {
            for lane in lanes_of(rays.masks[group].active) {
                rays.row_mut(group, row::AT)[lane] = Child::node(0).0;
                interleaved.nodes.push_if(true, place(GROUP * group + lane));
            }
        }
        interleaved
    }

    /// Begins a traversal of the active rays of some groups with empty stacks, which have room for
    /// `pending` children each.
    pub(super) fn begin_empty(
        &mut self,
        rays: &mut Rays,
        groups: Range<usize>,
        pending: usize,
        is_sorted: bool,
    ) -> Interleaved<'_> {
        let count = GROUP * groups.len();
        // The sentinel, the pending children, and eight more, since eight are written at once.
        let stride = 1 + pending + WIDTH;
        let at_least = |v: &mut Vec<u32>, len: usize| {
            if v.len() < len {
                v.resize(len, 0);
            }
        };
        // Grow the scratch memory.
        at_least(&mut self.stacks, stride * count);
        at_least(&mut self.enters, if is_sorted { stride * count } else { 0 });
        at_least(&mut self.at_nodes, count + 1);
        at_least(&mut self.at_blocks, count + 1);
        // Give each active ray an empty stack, with a sentinel below.
        let mut base = 0;
        for group in groups {
            for lane in lanes_of(rays.masks[group].active) {
                self.stacks[base] = Child::NONE.0;
                rays.row_mut(group, row::BOTTOM)[lane] = base as u32 + 1;
                rays.row_mut(group, row::TOP)[lane] = base as u32 + 1;
                base += stride;
            }
        }
        Interleaved {
            stacks: &mut self.stacks,
            enters: &mut self.enters,
            nodes: List { places: &mut self.at_nodes, len: 0 },
            blocks: List { places: &mut self.at_blocks, len: 0 },
            pairs: &mut self.pairs,
            pending: pending as u32,
        }
    }
}

impl Interleaved<'_> {
    /// Sets an entry of a stack.
    #[inline(always)]
    pub(super) fn set(&mut self, top: u32, child: Child) {
        self.stacks[top as usize] = child.0;
    }

    /// Begins at the stacks of all queried rays that have no hit yet.
    pub(super) fn start(&mut self, rays: &mut Rays) {
        for group in 0..rays.masks.len() {
            for lane in lanes_of(rays.masks[group].queried & !rays.masks[group].degenerate) {
                let is_open = rays.row(group, row::FOUND)[lane] == 0;
                let top = rays.row(group, row::TOP)[lane];
                self.pop_if(is_open, rays.words(), place(GROUP * group + lane), top);
            }
        }
    }

    /// Returns eight entries of the stacks from `top` on.
    #[inline(always)]
    fn stack(&mut self, top: u32) -> &mut [u32] {
        &mut self.stacks[top as usize..][..WIDTH]
    }

    /// Pops a ray's stack at `top`, and appends the ray to the list of the popped child if
    /// `condition` holds and the stack was not empty.
    #[inline(always)]
    fn pop_if(&mut self, condition: bool, words: &mut [u32], ray: u32, top: u32) {
        let at = Child(self.stacks[top as usize - 1]);
        let mut state = ray_at_mut(words, ray);
        state.set(row::AT, at.0);
        state.set(row::TOP, top - 1);
        self.nodes.push_if(condition & !at.is_block(), ray);
        self.blocks.push_if(condition & at.is_block() & (at != Child::NONE), ray);
    }

    /// Tests a ray against the children of a node: pushes those that it enters, and pops the
    /// nearest.
    #[inline(always)]
    fn step<const CLOSEST: bool, E: Lanes>(
        &mut self,
        e: E,
        node: &WideNode,
        all: &mut [u32],
        ray: u32,
    ) {
        counts::one(Event::Node);
        let words_of = ray_at(all, ray);
        let top = words_of.word(row::TOP);
        let (near, mask) = enter(e, &node.planes, words_of);
        let children = words(e, &node.children);
        debug_assert!(top + e.bits(mask).count_ones() <= words_of.word(row::BOTTOM) + self.pending);
        if CLOSEST {
            let keys = sorted(e, near, mask);
            e.u32_store(e.u32_permute(children, keys), self.stack(top));
            e.u32_store(keys, &mut self.enters[top as usize..][..WIDTH]);
        } else {
            e.u32_store(e.u32_compress(children, mask), self.stack(top));
        }
        self.pop_if(true, all, ray, top + e.bits(mask).count_ones());
    }

    /// Tests the rays at blocks against the boxes of the primitives, and then those that they enter.
    #[inline(always)]
    fn test_boxes<const CLOSEST: bool, R: Lanes, E: Lanes, P: Primitive>(
        &mut self,
        r: R,
        e: E,
        intersector: &LeafIntersector<'_, P>,
        all: &mut [u32],
    ) {
        let count = core::mem::take(&mut self.blocks.len);
        let mut begin = 0;
        while begin < count {
            // Collect pairs.
            let mut end = begin;
            while end < count && !self.pairs.is_full() {
                counts::one(Event::Block);
                let ray = self.blocks.places[end];
                let words_of = ray_at(all, ray);
                let block = Child(words_of.word(row::AT)).index();
                let (_, mask) = enter(e, intersector.tree.blocks.boxes(block), words_of);
                self.pairs.add(e, ray, block, mask);
                ray_at_mut(all, ray).set(row::NEARER, 0);
                end += 1;
            }
            self.pairs.flush::<CLOSEST, R, P>(r, intersector, all);
            // Go on, and cull the stacks of rays with a nearer hit.
            for i in begin..end {
                let ray = self.blocks.places[i];
                let words_of = ray_at(all, ray);
                let (mut top, found) = (words_of.word(row::TOP), words_of.word(row::FOUND));
                if CLOSEST && words_of.word(row::NEARER) != 0 {
                    let (bottom, limit) = (words_of.word(row::BOTTOM), words_of.float(row::LIMIT));
                    top = self.drop_beyond(e, bottom, top, limit);
                }
                self.pop_if(CLOSEST || found == 0, all, ray, top);
            }
            begin = end;
        }
    }

    /// Removes the children that a ray enters beyond `limit` from its stack; returns the new top.
    #[inline(always)]
    fn drop_beyond<E: Lanes>(&mut self, e: E, bottom: u32, top: u32, limit: f32) -> u32 {
        let last = e.u32(last_key(limit));
        let (mut kept, mut from) = (bottom as usize, bottom as usize);
        while from < top as usize {
            let enters = load(e, self.enters, from);
            let stack = load(e, self.stacks, from);
            // Compress the entries within the limit to the bottom.
            let begun = e.u32_binary(op::And, enters, e.u32(!7));
            let places = e.u32_from_fn(
                #[inline(always)]
                |i| (from + i) as u32,
            );
            let in_range = e.u32_compare(op::Lt, places, e.u32(top));
            let within = e.u32_compare(op::Le, begun, last);
            let stay = e.mask_binary(op::And, in_range, within);
            e.u32_store(e.u32_compress(enters, stay), &mut self.enters[kept..][..WIDTH]);
            e.u32_store(e.u32_compress(stack, stay), &mut self.stacks[kept..][..WIDTH]);
            kept += e.bits(stay).count_ones() as usize;
            from += WIDTH;
        }
        kept as u32
    }
}

/// Traces the active rays from `entry`, or from the root: finds the least hit of each with
/// `CLOSEST`, if it precedes the hit that the ray has already, else whether there is any.
#[inline(always)]
pub(super) fn run<const CLOSEST: bool, R: Lanes, E: Lanes, P: Primitive>(
    r: R,
    e: E,
    intersector: &LeafIntersector<'_, P>,
    entry: Option<&WideNode>,
    rays: &mut Rays,
    stream: &mut RayStream,
) {
    // Seven more children, of the entry node, may be pending.
    let pending = intersector.tree.pending + if entry.is_some() { WIDTH } else { 0 };
    let count = rays.masks.len();
    for first in (0..count).step_by(GROUPS) {
        let groups = first..(first + GROUPS).min(count);
        let mut interleaved = stream.begin(rays, groups, pending, CLOSEST);
        let all = rays.words();
        if let Some(entry) = entry {
            for i in 0..core::mem::take(&mut interleaved.nodes.len) {
                let ray = interleaved.nodes.places[i];
                interleaved.step::<CLOSEST, E>(e, entry, all, ray);
            }
        }
        trace_interleaved::<CLOSEST, R, E, P>(r, e, intersector, all, interleaved);
    }
}

/// Traces the rays of a stream from their current children. A function of its own, which [`run`]
/// and the hybrid traversal share.
#[inline(never)]
pub(super) fn trace_interleaved<const CLOSEST: bool, R: Lanes, E: Lanes, P: Primitive>(
    r: R,
    e: E,
    intersector: &LeafIntersector<'_, P>,
    all: &mut [u32],
    mut interleaved: Interleaved<'_>,
) {
    e.enter_again(
        #[inline(always)]
        || {
            let tree = intersector.tree;
            while interleaved.nodes.len + interleaved.blocks.len > 0 {
                // Rays at nodes.
                for i in 0..core::mem::take(&mut interleaved.nodes.len) {
                    let ray = interleaved.nodes.places[i];
                    let node = &tree.nodes[ray_at(all, ray).word(row::AT) as usize];
                    interleaved.step::<CLOSEST, E>(e, node, all, ray);
                }
                // Rays at blocks.
                if const { has_boxes::<P>() } {
                    interleaved.test_boxes::<CLOSEST, R, E, P>(r, e, intersector, all);
                    continue;
                }
                for i in 0..core::mem::take(&mut interleaved.blocks.len) {
                    counts::one(Event::Block);
                    let ray = interleaved.blocks.places[i];
                    let words_of = ray_at(all, ray);
                    let mut top = words_of.word(row::TOP);
                    let block = Child(words_of.word(row::AT)).index();
                    let (ray_on, best) = (words_of.ray_on(&Packet::new(e)), words_of.float(row::T));
                    let (hit, mask) = intersector.intersect(e, block, (ray_on, words_of), best);
                    let block = intersector.rows(block);
                    let is_hit = e.any(mask);
                    // Update the ray's hit, and cull its stack if that is nearer.
                    if !CLOSEST {
                        let found = words_of.word(row::FOUND) | u32::from(is_hit);
                        ray_at_mut(all, ray).set(row::FOUND, found);
                    } else if is_hit && update_hit(e, intersector, &hit, mask, block, all, ray) {
                        let words_of = ray_at(all, ray);
                        let (bottom, limit) =
                            (words_of.word(row::BOTTOM), words_of.float(row::LIMIT));
                        top = interleaved.drop_beyond(e, bottom, top, limit);
                    }
                    interleaved.pop_if(CLOSEST || !is_hit, all, ray, top);
                }
            }
        },
    );
}

/// Updates the ray's hit by the least hit of a block; returns whether that is nearer.
#[inline(always)]
fn update_hit<E: Lanes, P: Primitive>(
    e: E,
    intersector: &LeafIntersector<'_, P>,
    hit: &HitOn<Packet<E>>,
    mask: E::Mask,
    block: &[Row],
    all: &mut [u32],
    ray: u32,
) -> bool {
    let block_ids = ids(block);
    let mut bits = e.bits(mask);
    let mut is_nearer = false;
    let mut words = ray_at_mut(all, ray);
    while bits != 0 {
        let i = bits.trailing_zeros() as usize;
        bits &= bits - 1;
        let of = |t, prim_id| Hit { is_hit: true, t, prim_id, ..Hit::miss() };
        let found = of(E::f32_lane(&hit.t.0, i), intersector.part.first + block_ids[i]);
        let best = of(words.as_ref().float(row::T), words.as_ref().word(row::ID));
        if precedes(false, found, best) {
            words.set_float(row::T, found.t);
            words.set_float(row::U, E::f32_lane(&hit.u.0, i));
            words.set_float(row::V, E::f32_lane(&hit.v.0, i));
            words.set(row::ID, found.prim_id);
            is_nearer = true;
        }
    }
    if is_nearer {
        counts::one(Event::Nearer);
        words.set(row::FOUND, 1);
        let (t, end) = (words.as_ref().float(row::T), words.as_ref().float(row::T_MAX));
        words.set_float(row::LIMIT, limit_behind(t, P::SLACK, end));
    }
    is_nearer
}

/// Loads eight words from `from` on.
#[inline(always)]
fn load<E: Lanes>(e: E, all: &[u32], from: usize) -> E::U32 {
    let all = &all[from..][..WIDTH];
    e.u32_from_fn(
        #[inline(always)]
        |i| all[i],
    )
}
