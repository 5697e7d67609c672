//! What queries do in wide trees, in numbers: nothing without the feature `counts`.

use core::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// What all queries of the process have done in wide trees since
/// [`Counts::take`] was called.
///
/// Finding the nodes at which the rays of a query begin is not counted. Rays too odd for the boxes of such trees, and queries with a condition or of several hits, go
/// through the binary tree and are not counted. Of queries that
/// run meanwhile a part may be there.
#[cfg(feature = "counts")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Beams: rays of one octant that go through a tree together.
    pub beams: u64,
    /// The rays of all beams.
    pub beam_rays: u64,
    /// Nodes whose eight boxes a beam was tested against.
    pub beam_nodes: u64,
    /// Blocks of up to eight primitives that a beam entered.
    pub beam_blocks: u64,
    /// Tests of a box against a register of a beam's rays, one for each ray.
    pub register_boxes: u64,
    /// Blocks that a register of a beam's rays met, because one of them at least entered it.
    pub register_blocks: u64,
    /// Tests of a primitive against a register of a beam's rays.
    pub register_primitives: u64,
    /// Nodes whose eight boxes a ray on its own was tested against.
    pub nodes: u64,
    /// Blocks whose primitives, up to eight at once, a ray on its own was tested against.
    pub blocks: u64,
    /// Those of `blocks` and `register_blocks` that held a nearer hit than was known, where the
    /// closest one is asked for.
    pub nearer: u64,
}

#[cfg(feature = "counts")]
impl Counts {
    /// Everything since the last call; from now on it is counted anew.
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
            nearer: of(Event::Nearer),
        }
    }
}

/// What is counted; see the members of [`Counts`].
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
    Nearer,
}

static COUNTS: [AtomicU64; Event::Nearer as usize + 1] =
    [const { AtomicU64::new(0) }; Event::Nearer as usize + 1];

/// Counts an event.
#[inline(always)]
pub(super) fn one(event: Event) {
    some(event, 1);
}

/// Counts as many of an event.
#[inline(always)]
pub(super) fn some(event: Event, count: u32) {
    if cfg!(feature = "counts") {
        COUNTS[event as usize].fetch_add(count.into(), Relaxed);
    }
}
