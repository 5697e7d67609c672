//! Hybrid any-hit traversal of many rays: as ray packets while enough of their rays enter a box,
//! and as a ray stream from there.
//!
//! (After Benthin, Wald, Woop, Ernst and Mark, "Combining Single and Packet-Ray Tracing for
//! Arbitrary Ray Distributions on the Intel MIC Architecture", TVCG 18(9), 2012, whose rays leave a
//! packet one by one.)

use core::ops::Range;

use super::beam::Beam;
use super::counts::{self, Event};
use super::node::{Child, WIDTH};
use super::octant::Octant;
use super::order::Sequence;
use super::packet::{PacketScratch, RayPacket};
use super::rays::{Rays, lanes_of, row};
use super::step::{LeafIntersector, enter};
use super::stream::{Interleaved, trace_interleaved};
use super::trace::Scratch;
use crate::bvh::contract::Padding;
use crate::geometry::{Aabb, Primitive};
use crate::machine::{Lanes, op};

/// Minimum number of rays to sort: fewer are traced in less time unsorted.
pub(super) const FEWEST: u32 = 512;

/// Maximum number of rays that leave their packet at a box, for the stream.
pub(super) const APART: u32 = 16;

/// The limit of divergence: none, since rays are sorted, and divergent ones leave the packet.
const SPREAD: f32 = f32::INFINITY;

/// Maximum number of boxes that a ray may keep for the stream. Few in unit tests, so that stacks
/// are full and rays have to stay in the packet.
const KEPT: usize = if cfg!(test) { 3 } else { 40 };

/// Finds whether each active ray hits anything, in some sequence. `e` are the lanes of the stream.
#[inline(always)]
pub(super) fn any_hit<R: Lanes, E: Lanes, P: Primitive>(
    r: R,
    e: E,
    intersector: &LeafIntersector<'_, P>,
    root: &Aabb,
    scratch: &mut Scratch,
    sequence: Sequence,
) {
    let Scratch { rays, stream, packet_scratch, portions } = scratch;
    portions.each::<false, R>(
        r,
        rays,
        sequence,
        #[inline(always)]
        |rays| {
            rays.prepare(r, root, Padding::of::<P>());
            let groups = 0..rays.masks.len();
            let mut interleaved =
                stream.begin_empty(rays, groups, intersector.tree.pending + KEPT, false);
            for groups in Octant::ranges(rays.masks.len()) {
                trace_packets(r, intersector, root, rays, groups, packet_scratch, &mut interleaved);
            }
            interleaved.start(rays);
            trace_interleaved::<false, R, E, P>(r, e, intersector, rays.words(), interleaved);
        },
    );
}

/// Traces the rays of some groups through the tree, as one packet for each octant.
#[inline(always)]
fn trace_packets<R: Lanes, P: Primitive>(
    r: R,
    intersector: &LeafIntersector<'_, P>,
    root: &Aabb,
    rays: &mut Rays,
    groups: Range<usize>,
    packet_scratch: &mut PacketScratch,
    interleaved: &mut Interleaved<'_>,
) {
    loop {
        let octant = &mut packet_scratch.octant;
        let size = octant.take(rays, groups.clone());
        if size == 0 {
            return;
        }
        let beam = if size > APART {
            Beam::of(r.eight(), rays, octant, SPREAD, root, Padding::of::<P>())
        } else {
            None
        };
        if let Some(beam) = beam {
            counts::some(Event::BeamRay, size);
            traverse(r, intersector, rays, interleaved, packet_scratch, &beam);
        } else {
            for (group, members) in octant.groups() {
                keep(rays, interleaved, group, members, Child::node(0));
            }
        }
    }
}

/// Pushes a child on the stream's stacks of some rays of a group.
#[inline(always)]
fn keep(
    rays: &mut Rays,
    interleaved: &mut Interleaved<'_>,
    group: usize,
    members: u32,
    child: Child,
) {
    if members == 0 {
        return;
    }
    let tops = rays.row_mut(group, row::TOP);
    for lane in lanes_of(members) {
        interleaved.set(tops[lane], child);
        tops[lane] += 1;
    }
}

/// Returns whether the stream's stacks of all of these rays of a group have room for one more
/// child.
#[inline(always)]
fn has_room(rays: &Rays, group: usize, members: u32) -> bool {
    let (bottoms, tops) = (rays.row(group, row::BOTTOM), rays.row(group, row::TOP));
    lanes_of(members).all(|lane| ((tops[lane] - bottoms[lane]) as usize) < KEPT)
}

/// Traces a packet through the tree, and keeps for the stream the boxes that few of its rays enter.
#[inline(always)]
fn traverse<R: Lanes, P: Primitive>(
    r: R,
    intersector: &LeafIntersector<'_, P>,
    rays: &mut Rays,
    interleaved: &mut Interleaved<'_>,
    packet_scratch: &mut PacketScratch,
    beam: &Beam,
) {
    let (e, tree) = (r.eight(), intersector.tree);
    packet_scratch.make_room(tree);
    let PacketScratch { stack, octant, .. } = packet_scratch;
    counts::one(Event::Beam);
    let mut packet = RayPacket::new(r, rays, octant, beam.side);
    let slots = e.u32_from_fn(
        #[inline(always)]
        |i| i as u32,
    );
    let (mut at, mut top) = (0u32, 0);
    loop {
        // Push the children that the beam enters.
        counts::one(Event::BeamNode);
        let node = &tree.nodes[at as usize];
        let (_, mask) = enter(e, &node.planes, beam);
        let below = e.u32_binary(op::Or, slots, e.u32(8 * at));
        e.u32_store(e.u32_compress(below, mask), &mut stack[top..][..WIDTH]);
        top += e.bits(mask).count_ones() as usize;
        at = loop {
            if top == 0 {
                return;
            }
            top -= 1;
            // Pop a child that some ray enters.
            let (node, slot) = (stack[top] as usize / WIDTH, stack[top] as usize % WIDTH);
            let node = &tree.nodes[node];
            let child = Child(node.children[slot]);
            let (entering, count) = packet.enter(&node.planes, slot);
            if count == 0 {
                continue;
            }
            let of_groups = || packet.octant.groups().zip(entering);
            // Keep it for the stream if few rays enter it and their stacks have room.
            if count <= APART
                && of_groups().all(|((group, _), active)| has_room(packet.rays, group, active))
            {
                for ((group, _), active) in of_groups() {
                    keep(packet.rays, interleaved, group, active, child);
                }
                continue;
            }
            if !child.is_block() {
                break child.0;
            }
            // Intersect a block.
            counts::one(Event::BeamBlock);
            if !packet.any_hits(intersector, child.index(), entering, beam) {
                return;
            }
        };
    }
}
