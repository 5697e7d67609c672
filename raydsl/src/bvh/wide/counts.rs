//! Counters of traversals of wide trees; they do nothing without the feature `counts`.

use core::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Counters of all queries of the process in wide trees since the last [`Counts::take`].
///
/// Finding the entry nodes of a query is not counted, nor are degenerate rays, which fall back to
/// the binary tree. A query that runs meanwhile may be counted in part.
#[cfg(feature = "counts")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Beams: ray packets of one octant that are traced with interval culling.
    pub beams: u64,
    /// Rays of all beams.
    pub beam_rays: u64,
    /// Nodes visited by beams, each a test of eight boxes.
    pub beam_nodes: u64,
    /// Blocks of up to eight primitives visited by beams.
    pub beam_blocks: u64,
    /// Tests of a box, of a child or of a primitive, against a register of a beam's rays.
    pub register_boxes: u64,
    /// Blocks intersected by a register of a beam's rays, since one of them at least enters it.
    pub register_blocks: u64,
    /// Tests of a primitive against a register of a beam's rays.
    pub register_primitives: u64,
    /// Nodes visited by single rays and rays of streams, each a test of eight boxes.
    pub nodes: u64,
    /// Blocks visited by single rays and rays of streams, each a test of up to eight primitives, or of
    /// their boxes where `intersect` is not [short](crate::geometry::Primitive::IS_SHORT).
    pub blocks: u64,
    /// Pairs of a ray and a primitive whose box it enters, each tested in a lane: those of streams, and
    /// those of beams where less than three quarters of a register enter the box.
    pub pairs: u64,
    /// Those of `blocks`, `register_blocks` and `pairs` that held a nearer hit, in closest-hit queries;
    /// of streams that have pairs, the pairs alone.
    pub nearer: u64,
}

#[cfg(feature = "counts")]
impl Counts {
    /// Returns the counters since the last call, and resets them.
    pub fn take() -> Self {
        let of = |event: Event| COUNTS[event as usize].swap(0, Relaxed);
        Self {
            beams: of(Event::Beam),
            beam_rays: of(Event::BeamRay),
            beam_nodes: of(Event::BeamNode),
            beam_blocks: of(Event::BeamBlock),
            register_boxes: of(Event::RegisterBox),
            register_blocks: of(Event::RegisterBlock),
            register_primitives: of(Event::RegisterPrimitive),
            nodes: of(Event::Node),
            blocks: of(Event::Block),
            pairs: of(Event::Pair),
            nearer: of(Event::Nearer),
        }
    }
}

/// Events that are counted; see the members of [`Counts`].
#[derive(Clone, Copy)]
pub(super) enum Event {
    Beam,
    BeamRay,
    BeamNode,
    BeamBlock,
    RegisterBox,
    RegisterBlock,
    RegisterPrimitive,
    Node,
    Block,
    Pair,
    Nearer,
}

static COUNTS: [AtomicU64; Event::Nearer as usize + 1] =
    [const { AtomicU64::new(0) }; Event::Nearer as usize + 1];

/// Counts one event.
#[inline(always)]
pub(super) fn one(event: Event) {
    some(event, 1);
}

/// Counts several events of one kind.
#[inline(always)]
pub(super) fn some(event: Event, count: u32) {
    if cfg!(feature = "counts") {
        COUNTS[event as usize].fetch_add(count.into(), Relaxed);
    }
}
