//! Many rays that ask for any hit: they go together as long as enough of them enter a box, and their
//! own ways from there.
//!
//! (After Benthin, Wald, Woop, Ernst and Mark, "Combining Single and Packet-Ray Tracing for
//! Arbitrary Ray Distributions on the Intel MIC Architecture", TVCG 18(9), 2012; what is left of a
//! packet goes on as a wave here, not ray by ray.)

use core::ops::Range;

use super::beam::Beam;
use super::counts::{self, Event};
use super::node::{Child, WIDTH};
use super::octant::Octant;
use super::order::Sequence;
use super::packet::{Bundle, Together};
use super::rays::{Rays, lanes_of, row};
use super::step::{Meeting, enter};
use super::trace::Scratch;
use super::wave::{Turns, each_turn};
use crate::bvh::contract::Padding;
use crate::geometry::{Aabb, Primitive};
use crate::machine::{Lanes, op};

/// Fewer rays than this are sooner traced than sorted.
pub(super) const FEWEST: u32 = 512;

/// Where no more rays than this enter a box, they go their own ways from there.
pub(super) const APART: u32 = 16;

/// Directions may differ as they like: the order keeps them near each other, and rays that part
/// come apart.
const SPREAD: f32 = f32::INFINITY;

/// So many boxes a ray may keep for its own way. Tests of the library make do with few, so that rays
/// stay together for want of room.
const KEPT: usize = if cfg!(test) { 3 } else { 40 };

/// Whether each ray that is alive meets anything, in some sequence. `e` is for rays on their own ways.
#[inline(always)]
pub(super) fn any_hit<R: Lanes, E: Lanes, P: Primitive>(
    r: R,
    e: E,
    meeting: &Meeting<'_, P>,
    root: &Aabb,
    scratch: &mut Scratch,
    sequence: Sequence,
) {
    let Scratch { rays, wave, together, portions } = scratch;
    portions.each::<false, R>(
        r,
        rays,
        sequence,
        #[inline(always)]
        |rays| {
            rays.prepare(r, root, Padding::of::<P>());
            let groups = 0..rays.marks.len();
            let mut turns = wave.begin_empty(rays, groups, meeting.tree.pending + KEPT, false);
            for groups in Octant::ranges(rays.marks.len()) {
                go_together(r, meeting, root, rays, groups, together, &mut turns);
            }
            turns.start(rays);
            each_turn::<false, E, P>(e, meeting, rays.words(), turns);
        },
    );
}

/// Takes the rays of some groups through the tree, each octant for itself.
#[inline(always)]
fn go_together<R: Lanes, P: Primitive>(
    r: R,
    meeting: &Meeting<'_, P>,
    root: &Aabb,
    rays: &mut Rays,
    groups: Range<usize>,
    together: &mut Together,
    turns: &mut Turns<'_>,
) {
    loop {
        let octant = &mut together.octant;
        let taken = octant.take(rays, groups.clone());
        if taken == 0 {
            return;
        }
        let beam = if taken > APART {
            Beam::of(r.eight(), rays, octant, SPREAD, root, Padding::of::<P>())
        } else {
            None
        };
        if let Some(beam) = beam {
            counts::some(Event::BeamRay, taken);
            walk(r, meeting, rays, turns, together, &beam);
        } else {
            for (group, members) in octant.groups() {
                keep(rays, turns, group, members, Child::node(0));
            }
        }
    }
}

/// Keeps a child for the own way of some rays of a group.
#[inline(always)]
fn keep(rays: &mut Rays, turns: &mut Turns<'_>, group: usize, members: u32, child: Child) {
    if members == 0 {
        return;
    }
    let tops = rays.row_mut(group, row::TOP);
    for lane in lanes_of(members) {
        turns.set(tops[lane], child);
        tops[lane] += 1;
    }
}

/// Whether all of these rays of a group may keep one more child.
#[inline(always)]
fn has_room(rays: &Rays, group: usize, members: u32) -> bool {
    let (bottoms, tops) = (rays.row(group, row::BOTTOM), rays.row(group, row::TOP));
    lanes_of(members).all(|lane| ((tops[lane] - bottoms[lane]) as usize) < KEPT)
}

/// Takes a packet through the tree, and keeps for later what few of its rays enter.
#[inline(always)]
fn walk<R: Lanes, P: Primitive>(
    r: R,
    meeting: &Meeting<'_, P>,
    rays: &mut Rays,
    turns: &mut Turns<'_>,
    together: &mut Together,
    beam: &Beam,
) {
    let (e, tree) = (r.eight(), meeting.tree);
    together.make_room(tree);
    let Together { stack, octant, .. } = together;
    counts::one(Event::Beam);
    let mut bundle = Bundle::new(r, rays, octant, beam.side);
    let slots = e.u32_from_fn(
        #[inline(always)]
        |i| i as u32,
    );
    let (mut at, mut top) = (0u32, 0);
    loop {
        counts::one(Event::BeamNode);
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
            let (node, slot) = (stack[top] as usize / WIDTH, stack[top] as usize % WIDTH);
            let node = &tree.nodes[node];
            let child = Child(node.children[slot]);
            let (entering, count) = bundle.enter(node, slot);
            if count == 0 {
                continue;
            }
            let of_groups = || bundle.octant.groups().zip(entering);
            if count <= APART
                && of_groups().all(|((group, _), there)| has_room(bundle.rays, group, there))
            {
                for ((group, _), there) in of_groups() {
                    keep(bundle.rays, turns, group, there, child);
                }
                continue;
            }
            if !child.is_block() {
                break child.0;
            }
            counts::one(Event::BeamBlock);
            if !bundle.stop(meeting, meeting.rows(child.index()), entering) {
                return;
            }
        };
    }
}
