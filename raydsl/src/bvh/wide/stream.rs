//! Many rays in turn, for rays that go their own ways.
//!
//! Each ray has a stack of its own and takes one step at a time: one node, or one block. The rays
//! that are at nodes and those at blocks are in a list each, and moving from one list to the other
//! takes no branch. So no branch is left that cannot be foretold, and the processor works on the
//! next rays while one waits for memory.

use core::ops::Range;

use super::blocks::Row;
use super::counts::{self, Event};
use super::node::{Child, WIDTH, WideNode};
use super::rays::{GROUP, Rays, lanes_of, place, ray_at, ray_at_mut, row};
use super::step::{Meeting, enter, ids, last_key, sorted, words};
use crate::bvh::contract::{limit_behind, precedes};
use crate::geometry::{Hit, HitOn, Primitive};
use crate::machine::{Lanes, Packet, op};

/// What rays in turn need, kept from one query to the next.
#[derive(Debug, Default)]
pub(super) struct Wave {
    /// Of each ray: the children that are to come.
    stacks: Vec<u32>,
    /// Where it enters them, as the bits of numbers above 0, in whose last three the slot is.
    enters: Vec<u32>,
    /// The places of the rays that are at nodes.
    at_nodes: Vec<u32>,
    /// And at blocks.
    at_blocks: Vec<u32>,
}

/// Groups of a wave: with more rays, what they need leaves the cache.
const GROUPS: usize = 16;

/// The places of rays.
struct List<'a> {
    places: &'a mut [u32],
    len: usize,
}

impl List<'_> {
    /// Adds a ray, or writes it where the next one will be.
    #[inline(always)]
    fn push_if(&mut self, condition: bool, ray: u32) {
        debug_assert!(self.len < self.places.len());
        // SAFETY: a ray is in one list at most, so with this one there are no more than there are
        // rays, and there is room for one more than that.
        unsafe { *self.places.get_unchecked_mut(self.len) = ray };
        self.len += usize::from(condition);
    }
}

/// A wave under way.
pub(super) struct Turns<'a> {
    stacks: &'a mut [u32],
    enters: &'a mut [u32],
    nodes: List<'a>,
    blocks: List<'a>,
    /// How many children of each may be on its stack.
    pending: u32,
}

impl Wave {
    /// Puts the rays of some groups that are alive at the root.
    fn begin(
        &mut self,
        rays: &mut Rays,
        groups: Range<usize>,
        pending: usize,
        is_sorted: bool,
    ) -> Turns<'_> {
        let mut turns = self.begin_empty(rays, groups.clone(), pending, is_sorted);
        for group in groups {
            for lane in lanes_of(rays.marks[group].alive) {
                rays.row_mut(group, row::AT)[lane] = Child::node(0).0;
                turns.nodes.push_if(true, place(GROUP * group + lane));
            }
        }
        turns
    }

    /// Empty stacks for the rays of some groups that are alive, with room for `pending` children each.
    pub(super) fn begin_empty(
        &mut self,
        rays: &mut Rays,
        groups: Range<usize>,
        pending: usize,
        is_sorted: bool,
    ) -> Turns<'_> {
        let count = GROUP * groups.len();
        // The end, what is pending, and room behind: eight are written at once.
        let stride = 1 + pending + WIDTH;
        let at_least = |v: &mut Vec<u32>, len: usize| {
            if v.len() < len {
                v.resize(len, 0);
            }
        };
        at_least(&mut self.stacks, stride * count);
        at_least(&mut self.enters, if is_sorted { stride * count } else { 0 });
        at_least(&mut self.at_nodes, count + 1);
        at_least(&mut self.at_blocks, count + 1);
        let mut base = 0;
        for group in groups {
            for lane in lanes_of(rays.marks[group].alive) {
                self.stacks[base] = Child::NONE.0;
                rays.row_mut(group, row::BOTTOM)[lane] = base as u32 + 1;
                rays.row_mut(group, row::TOP)[lane] = base as u32 + 1;
                base += stride;
            }
        }
        Turns {
            stacks: &mut self.stacks,
            enters: &mut self.enters,
            nodes: List { places: &mut self.at_nodes, len: 0 },
            blocks: List { places: &mut self.at_blocks, len: 0 },
            pending: pending as u32,
        }
    }
}

impl Turns<'_> {
    /// Writes an entry of a stack.
    #[inline(always)]
    pub(super) fn set(&mut self, top: u32, child: Child) {
        self.stacks[top as usize] = child.0;
    }

    /// Goes on with what rays that have found nothing have on their stacks.
    pub(super) fn start(&mut self, rays: &mut Rays) {
        for group in 0..rays.marks.len() {
            for lane in lanes_of(rays.marks[group].asked & !rays.marks[group].odd) {
                let is_open = rays.row(group, row::FOUND)[lane] == 0;
                let top = rays.row(group, row::TOP)[lane];
                self.pop_if(is_open, rays.words(), place(GROUP * group + lane), top);
            }
        }
    }

    /// Eight entries of the stacks from `top` on.
    #[inline(always)]
    fn stack(&mut self, top: u32) -> &mut [u32] {
        &mut self.stacks[top as usize..][..WIDTH]
    }

    /// Goes on with what is below the `top` of a ray's stack, or with nothing.
    #[inline(always)]
    fn pop_if(&mut self, condition: bool, words: &mut [u32], ray: u32, top: u32) {
        let at = Child(self.stacks[top as usize - 1]);
        let mut state = ray_at_mut(words, ray);
        state.set(row::AT, at.0);
        state.set(row::TOP, top - 1);
        self.nodes.push_if(condition & !at.is_block(), ray);
        self.blocks.push_if(condition & at.is_block() & (at != Child::NONE), ray);
    }

    /// Takes a ray from a node to what it enters first there, and keeps the rest for later.
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
        let (near, mask) = enter(e, node, words_of);
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

    /// Takes what a ray enters beyond `limit` from its stack; returns the new top.
    #[inline(always)]
    fn drop_beyond<E: Lanes>(&mut self, e: E, bottom: u32, top: u32, limit: f32) -> u32 {
        let last = e.u32(last_key(limit));
        let (mut kept, mut from) = (bottom as usize, bottom as usize);
        while from < top as usize {
            let enters = load(e, self.enters, from);
            let stack = load(e, self.stacks, from);
            let begun = e.u32_binary(op::And, enters, e.u32(!7));
            let places = e.u32_from_fn(
                #[inline(always)]
                |i| (from + i) as u32,
            );
            let there = e.u32_compare(op::Lt, places, e.u32(top));
            let within = e.u32_compare(op::Le, begun, last);
            let stay = e.mask_binary(op::And, there, within);
            e.u32_store(e.u32_compress(enters, stay), &mut self.enters[kept..][..WIDTH]);
            e.u32_store(e.u32_compress(stack, stay), &mut self.stacks[kept..][..WIDTH]);
            kept += e.bits(stay).count_ones() as usize;
            from += WIDTH;
        }
        kept as u32
    }
}

/// Whether each ray that is alive meets anything; with `CLOSEST` the least hit of each, if it is less
/// than what the ray has already. They begin at `entry`, or at the root.
#[inline(always)]
pub(super) fn run<const CLOSEST: bool, E: Lanes, P: Primitive>(
    e: E,
    meeting: &Meeting<'_, P>,
    entry: Option<&WideNode>,
    rays: &mut Rays,
    wave: &mut Wave,
) {
    // Seven more of the entry's children may wait for what is below one.
    let pending = meeting.tree.pending + if entry.is_some() { WIDTH } else { 0 };
    let count = rays.marks.len();
    for first in (0..count).step_by(GROUPS) {
        let groups = first..(first + GROUPS).min(count);
        let mut turns = wave.begin(rays, groups, pending, CLOSEST);
        let all = rays.words();
        if let Some(entry) = entry {
            for i in 0..core::mem::take(&mut turns.nodes.len) {
                let ray = turns.nodes.places[i];
                turns.step::<CLOSEST, E>(e, entry, all, ray);
            }
        }
        each_turn::<CLOSEST, E, P>(e, meeting, all, turns);
    }
}

/// [`run`] from where the rays are. In its own function, which rays that were sorted share.
#[inline(never)]
pub(super) fn each_turn<const CLOSEST: bool, E: Lanes, P: Primitive>(
    e: E,
    meeting: &Meeting<'_, P>,
    all: &mut [u32],
    mut turns: Turns<'_>,
) {
    e.enter_again(
        #[inline(always)]
        || {
            let tree = meeting.tree;
            while turns.nodes.len + turns.blocks.len > 0 {
                for i in 0..core::mem::take(&mut turns.nodes.len) {
                    let ray = turns.nodes.places[i];
                    let node = &tree.nodes[ray_at(all, ray).word(row::AT) as usize];
                    turns.step::<CLOSEST, E>(e, node, all, ray);
                }
                for i in 0..core::mem::take(&mut turns.blocks.len) {
                    counts::one(Event::Block);
                    let ray = turns.blocks.places[i];
                    let words_of = ray_at(all, ray);
                    let mut top = words_of.word(row::TOP);
                    let block = meeting.rows(Child(words_of.word(row::AT)).index());
                    let (ray_on, best) =
                        (words_of.ray_on(&Packet::new(e)), words_of.number(row::T));
                    let (hit, mask) = meeting.block(e, block, ray_on, best);
                    let is_met = e.any(mask);
                    if !CLOSEST {
                        let found = words_of.word(row::FOUND) | u32::from(is_met);
                        ray_at_mut(all, ray).set(row::FOUND, found);
                    } else if is_met && take(e, meeting, &hit, mask, block, all, ray) {
                        let words_of = ray_at(all, ray);
                        let (bottom, limit) =
                            (words_of.word(row::BOTTOM), words_of.number(row::LIMIT));
                        top = turns.drop_beyond(e, bottom, top, limit);
                    }
                    turns.pop_if(CLOSEST || !is_met, all, ray, top);
                }
            }
        },
    );
}

/// Keeps the least hit of a block if it is less than the ray's; whether it is.
#[inline(always)]
fn take<E: Lanes, P: Primitive>(
    e: E,
    meeting: &Meeting<'_, P>,
    hit: &HitOn<Packet<E>>,
    mask: E::Mask,
    block: &[Row],
    all: &mut [u32],
    ray: u32,
) -> bool {
    let numbers = ids(block);
    let mut bits = e.bits(mask);
    let mut is_taken = false;
    let mut words = ray_at_mut(all, ray);
    while bits != 0 {
        let i = bits.trailing_zeros() as usize;
        bits &= bits - 1;
        let of = |t, prim_id| Hit { is_hit: true, t, prim_id, ..Hit::miss() };
        let found = of(E::f32_lane(&hit.t.0, i), meeting.part.first + numbers[i]);
        let best = of(words.as_ref().number(row::T), words.as_ref().word(row::ID));
        if precedes(false, found, best) {
            words.set_number(row::T, found.t);
            words.set_number(row::U, E::f32_lane(&hit.u.0, i));
            words.set_number(row::V, E::f32_lane(&hit.v.0, i));
            words.set(row::ID, found.prim_id);
            is_taken = true;
        }
    }
    if is_taken {
        counts::one(Event::Nearer);
        words.set(row::FOUND, 1);
        let (t, end) = (words.as_ref().number(row::T), words.as_ref().number(row::T_MAX));
        words.set_number(row::LIMIT, limit_behind(t, P::SLACK, end));
    }
    is_taken
}

/// Eight words from `from` on.
#[inline(always)]
fn load<E: Lanes>(e: E, all: &[u32], from: usize) -> E::U32 {
    let all = &all[from..][..WIDTH];
    e.u32_from_fn(
        #[inline(always)]
        |i| all[i],
    )
}
