//! Many rays that ask for any hit: sorted by direction they go together as long as enough of them
//! enter a box, and their own ways from there.
//!
//! (After Benthin, Wald, Woop, Ernst and Mark, "Combining Single and Packet-Ray Tracing for
//! Arbitrary Ray Distributions on the Intel MIC Architecture", TVCG 18(9), 2012; what is left of a
//! packet goes on as a wave here, not ray by ray.)

use super::beam::Beam;
use super::node::{Child, WIDTH};
use super::order::{self, Order};
use super::packet::{GROUPS, Register, Together, take_octant};
use super::rays::{GROUP, Rays, lanes_mask, row};
use super::step::{Meeting, count, enter};
use super::trace::Scratch;
use super::wave::{Turns, each_turn};
use crate::bvh::slabs::Allowance;
use crate::geometry::{Aabb, Primitive};
use crate::machine::{Entered, Lanes, Packet, op};

/// Fewer rays than this are sooner traced than sorted.
pub(super) const FEWEST: u32 = 512;

/// Where no more rays than this enter a box, they go their own ways from there.
const APART: u32 = 16;

/// Directions may differ as they like: the order keeps them near each other, and rays that part
/// come apart.
const SPREAD: f32 = f32::INFINITY;

/// So many boxes a ray may keep for its own way. Tests of the library make do with few, so that rays
/// stay together for want of room.
const KEPT: usize = if cfg!(test) { 3 } else { 40 };

/// So many rays at once come from the order: what they need lies in a cache of the second level.
const SOME: usize = 512;

/// The rays under way, kept from one query to the next.
#[derive(Debug, Default)]
pub(super) struct Sorted {
    order: Order,
    some: Rays,
}

/// Whether each ray that is alive meets anything. `e` is for rays on their own ways.
#[inline(always)]
pub(super) fn any_hit<R: Lanes, E: Lanes, P: Primitive>(
    r: R,
    e: E,
    meeting: &Meeting<'_, P>,
    root: &Aabb,
    scratch: &mut Scratch,
) {
    let Scratch { rays, wave, together, sorted: Sorted { order, some } } = scratch;
    let count = rays.marks.len();
    for first in (0..count).step_by(order::MOST) {
        let groups = first..(first + order::MOST).min(count);
        for places in order.of(r, rays, groups).chunks(SOME) {
            some.gather(rays, places);
            some.prepare(r, root, Allowance::of::<P>());
            let groups = 0..some.marks.len();
            let mut turns = wave.begin_empty(some, groups, meeting.tree.pending + KEPT, false);
            for first in (0..some.marks.len()).step_by(GROUPS) {
                go_together(r, meeting, root, some, first, together, &mut turns);
            }
            turns.start(some);
            each_turn::<false, E, P>(e, meeting, some.words(), turns);
            some.give_back(rays);
        }
    }
}

/// Takes the rays from the group `first` on through the tree, each octant for itself.
#[inline(always)]
fn go_together<R: Lanes, P: Primitive>(
    r: R,
    meeting: &Meeting<'_, P>,
    root: &Aabb,
    rays: &mut Rays,
    first: usize,
    together: &mut Together,
    turns: &mut Turns<'_>,
) {
    let groups = first..(first + GROUPS).min(rays.marks.len());
    loop {
        let octant = take_octant(rays, groups.clone(), &mut together.members);
        if octant == 0 {
            return;
        }
        let allowance = Allowance::of::<P>();
        let beam = if octant > APART {
            Beam::of(r.eight(), rays, first, &together.members, SPREAD, root, allowance)
        } else {
            None
        };
        if let Some(beam) = beam {
            walk(r, meeting, rays, turns, together, first, &beam);
        } else {
            for (g, &members) in together.members.iter().enumerate() {
                keep(rays, turns, first + g, members, Child::node(0));
            }
        }
    }
}

/// Keeps a child for the own way of some rays of a group.
#[inline(always)]
fn keep(rays: &mut Rays, turns: &mut Turns<'_>, group: usize, mut members: u32, child: Child) {
    if members == 0 {
        return;
    }
    let tops = rays.row_mut(group, row::TOP);
    while members != 0 {
        let lane = members.trailing_zeros() as usize;
        members &= members - 1;
        turns.set(tops[lane], child);
        tops[lane] += 1;
    }
}

/// Whether all of these rays may keep one more child.
#[inline(always)]
fn has_room(rays: &Rays, first: usize, members: &[u32; GROUPS]) -> bool {
    members.iter().enumerate().all(|(g, &members)| {
        let group = first + g;
        let mut members = members;
        let mut has_room = true;
        while members != 0 {
            let lane = members.trailing_zeros() as usize;
            members &= members - 1;
            let begin = rays.row(group, row::BOTTOM)[lane];
            has_room &= ((rays.row(group, row::TOP)[lane] - begin) as usize) < KEPT;
        }
        has_room
    })
}

/// Takes a packet through the tree, and keeps for later what few of its rays enter.
#[inline(always)]
fn walk<R: Lanes, P: Primitive>(
    r: R,
    meeting: &Meeting<'_, P>,
    rays: &mut Rays,
    turns: &mut Turns<'_>,
    together: &mut Together,
    first: usize,
    beam: &Beam,
) {
    let (e, tree) = (r.eight(), meeting.tree);
    together.make_room(tree);
    let Together { stack, members, .. } = together;
    let slots = e.u32_from_fn(
        #[inline(always)]
        |i| i as u32,
    );
    let m = Packet::new(Entered::new(r));
    let (mut at, mut top) = (0u32, 0);
    loop {
        let node = &tree.nodes[at as usize];
        let (_, mask) = enter(e, node, beam);
        let below = e.u32_binary(op::Or, slots, e.u32(8 * at));
        e.u32_store(e.u32_compress(below, mask), &mut stack[top..][..WIDTH]);
        top += e.bits(mask).count_ones() as usize;
        at = loop {
            if top == 0 {
                return;
            }
            top -= 1;
            let (node, slot) =
                (&tree.nodes[stack[top] as usize / WIDTH], stack[top] as usize % WIDTH);
            let child = Child(node.children[slot]);
            let mut entering = [0u32; GROUPS];
            let mut entered = 0;
            for (g, &members) in members.iter().enumerate() {
                for from in (0..GROUP).step_by(R::N) {
                    let alive = members >> from & lanes_mask::<R>();
                    if alive != 0 {
                        let lanes = Register { r, m: &m, group: rays.group_mut(first + g), from };
                        let there = r.bits(lanes.enter(node, slot, beam.side)) as u32 & alive;
                        entering[g] |= there << from;
                        entered += there.count_ones();
                    }
                }
            }
            if entered == 0 {
                continue;
            }
            if entered <= APART && has_room(rays, first, &entering) {
                for (g, &there) in entering[..members.len()].iter().enumerate() {
                    keep(rays, turns, first + g, there, child);
                }
                continue;
            }
            if !child.is_block() {
                break child.0;
            }
            let block = meeting.rows(child.index());
            let count = count(e, block);
            let mut left = 0;
            for (g, members) in members.iter_mut().enumerate() {
                for from in (0..GROUP).step_by(R::N) {
                    let there = entering[g] >> from & lanes_mask::<R>();
                    if there != 0 {
                        let lanes = Register { r, m: &m, group: rays.group_mut(first + g), from };
                        let hit =
                            lanes.meet_any(meeting, block, count, r.mask_from_bits(there.into()));
                        *members &= !(hit << from);
                    }
                }
                left |= *members;
            }
            if left == 0 {
                return;
            }
        };
    }
}
