//! Many rays in turn, for rays that go their own ways.
//!
//! Each ray has a stack of its own and takes one step at a time: one node, or one block. The rays
//! that are at nodes and those at blocks are in a list each, and moving from one list to the other
//! takes no branch. So no branch is left that cannot be foretold, and the processor works on the
//! next rays while one waits for memory.

use super::blocks::Row;
use super::node::{Child, WIDTH};
use super::rays::{Rays, place, ray_at, ray_at_mut, row};
use super::step::{Leaf, Meeting, enter, ids, sorted, words};
use crate::geometry::{HitOn, Primitive};
use crate::machine::{Lanes, op};

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
struct Turns<'a> {
    stacks: &'a mut [u32],
    enters: &'a mut [u32],
    nodes: List<'a>,
    blocks: List<'a>,
}

impl Wave {
    /// Puts the rays of all groups that are alive at the root.
    fn begin(&mut self, rays: &mut Rays, pending: usize, is_sorted: bool) -> Turns<'_> {
        let count = 16 * rays.marks.len();
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
        let mut nodes = List { places: &mut self.at_nodes, len: 0 };
        let mut base = 0;
        for group in 0..rays.marks.len() {
            let mut alive = rays.marks[group].alive;
            while alive != 0 {
                let lane = alive.trailing_zeros() as usize;
                alive &= alive - 1;
                self.stacks[base] = Child::NONE.0;
                rays.row_mut(group, row::AT)[lane] = Child::node(0).0;
                rays.row_mut(group, row::TOP)[lane] = base as u32 + 1;
                nodes.push_if(true, place(16 * group + lane));
                base += stride;
            }
        }
        Turns {
            stacks: &mut self.stacks,
            enters: &mut self.enters,
            nodes,
            blocks: List { places: &mut self.at_blocks, len: 0 },
        }
    }
}

impl Turns<'_> {
    /// Eight entries of the stacks from `top` on.
    #[inline(always)]
    fn stack(&mut self, top: u32) -> &mut [u32] {
        &mut self.stacks[top as usize..][..WIDTH]
    }

    /// Goes on with what is below the `top` of a ray's stack.
    #[inline(always)]
    fn pop(&mut self, words: &mut [u32], ray: u32, top: u32) {
        let at = Child(self.stacks[top as usize - 1]);
        let mut state = ray_at_mut(words, ray);
        state.set(row::AT, at.0);
        state.set(row::TOP, top - 1);
        self.nodes.push_if(!at.is_block(), ray);
        self.blocks.push_if(at.is_block() && at != Child::NONE, ray);
    }
}

/// Whether each ray that is alive meets anything; with `CLOSEST` the least hit of each, if it is less
/// than what the ray has already.
#[inline(always)]
pub(super) fn run<const CLOSEST: bool, E: Lanes, P: Primitive>(
    e: E,
    meeting: &Meeting<'_, E, P>,
    rays: &mut Rays,
    wave: &mut Wave,
) {
    let tree = meeting.tree;
    let mut turns = wave.begin(rays, tree.pending, CLOSEST);
    let all = rays.words();
    while turns.nodes.len + turns.blocks.len > 0 {
        for i in 0..core::mem::take(&mut turns.nodes.len) {
            let ray = turns.nodes.places[i];
            let words_of = ray_at(all, ray);
            let top = words_of.word(row::TOP);
            let node = &tree.nodes[words_of.word(row::AT) as usize];
            let (near, mask) = enter(e, node, words_of);
            let children = words(e, &node.children);
            if CLOSEST {
                let keys = sorted(e, near, mask);
                e.u32_store(e.u32_permute(children, keys), turns.stack(top));
                e.u32_store(keys, &mut turns.enters[top as usize..][..WIDTH]);
            } else {
                e.u32_store(e.u32_compress(children, mask), turns.stack(top));
            }
            turns.pop(all, ray, top + e.bits(mask).count_ones());
        }
        for i in 0..core::mem::take(&mut turns.blocks.len) {
            let ray = turns.blocks.places[i];
            let words_of = ray_at(all, ray);
            let mut top = words_of.word(row::TOP);
            let block = meeting.rows(Child(words_of.word(row::AT)).index());
            let (hit, mask) = meeting.block(block, words_of);
            if e.any(mask) {
                if !CLOSEST {
                    ray_at_mut(all, ray).set(row::FOUND, 1);
                    continue;
                }
                if take(e, meeting, &hit, mask, block, all, ray) {
                    let limit = ray_at(all, ray).number(row::LIMIT);
                    top = turns.drop_beyond(e, top, limit);
                }
            }
            turns.pop(all, ray, top);
        }
    }
}

/// Keeps the least hit of a block if it is less than the ray's; whether it is.
#[inline(always)]
fn take<E: Lanes, P: Primitive>(
    e: E,
    meeting: &Meeting<'_, E, P>,
    hit: &HitOn<Leaf<E>>,
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
        let (t, id) = (E::f32_lane(&hit.t.0, i), meeting.part.first + numbers[i]);
        let (best, first) = (words.as_ref().number(row::T), words.as_ref().word(row::ID));
        if t < best || (t == best && id < first) {
            words.set_number(row::T, t);
            words.set_number(row::U, E::f32_lane(&hit.u.0, i));
            words.set_number(row::V, E::f32_lane(&hit.v.0, i));
            words.set(row::ID, id);
            is_taken = true;
        }
    }
    if is_taken {
        words.set(row::FOUND, 1);
        let (t, end) = (words.as_ref().number(row::T), words.as_ref().number(row::T_MAX));
        let limit = t + t.abs() * P::SLACK;
        words.set_number(row::LIMIT, if limit < end { limit } else { end });
    }
    is_taken
}

impl Turns<'_> {
    /// Takes what a ray enters beyond `limit` from its stack; returns the new top.
    #[inline(always)]
    fn drop_beyond<E: Lanes>(&mut self, e: E, top: u32, limit: f32) -> u32 {
        // Below the first distance above zero no bits are larger.
        let limit = e.u32(if limit > 0.0 { limit.to_bits() } else { 7 });
        let mut bottom = top as usize;
        while self.stacks[bottom - 1] != Child::NONE.0 {
            bottom -= 1;
        }
        let (mut kept, mut from) = (bottom, bottom);
        while from < top as usize {
            let enters = load(e, self.enters, from);
            let stack = load(e, self.stacks, from);
            let begun = e.u32_binary(op::And, enters, e.u32(!7));
            let places = e.u32_from_fn(
                #[inline(always)]
                |i| (from + i) as u32,
            );
            let there = e.u32_compare(op::Lt, places, e.u32(top));
            let within = e.u32_compare(op::Le, begun, limit);
            let stay = e.mask_binary(op::And, there, within);
            e.u32_store(e.u32_compress(enters, stay), &mut self.enters[kept..][..WIDTH]);
            e.u32_store(e.u32_compress(stack, stay), &mut self.stacks[kept..][..WIDTH]);
            kept += e.bits(stay).count_ones() as usize;
            from += WIDTH;
        }
        kept as u32
    }
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
