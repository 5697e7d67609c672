//! Bodies of loops that are recorded again.
//!
//! What is assumed of variables while the body of a loop is recorded may turn out to be too little
//! where it ends, since the body runs again. Then all that was recorded since the loop began is
//! discarded, and the lifted code runs its body once more, as other machines do, with more known of
//! the variables. Sets of kinds only grow, so that ends; and what is recorded last is what would have
//! been recorded if the kinds had been known before.
//!
//! A variable read in loops within loops is checked where the outermost loop ends that it was not made
//! in, with all the loops that are in that one.

use core::cell::Cell;

use super::builder::Builder;
use super::{Captured, RecordedLoop, Recorder};

/// The number of passes that add the kinds found by the last one. Later ones add all kinds: an enum
/// may have many, and a loop within loops is recorded as often as all of them together.
const CAUTIOUS: u32 = 3;

/// What was recorded when the body of a loop began.
pub(super) struct Start {
    builder: Builder,
    functions: usize,
    uniforms: usize,
    buffers: usize,
    textures: usize,
    before_body: Captured,
    /// How often the body has been recorded.
    passes: Cell<u32>,
}

impl Recorder {
    /// Returns what is recorded now, unless nothing that a loop does could be assumed wrongly.
    pub(super) fn start(&self) -> Option<Start> {
        let state = self.state.borrow();
        let builder = state.open.last().filter(|b| b.has_kinds())?.clone();
        Some(Start {
            builder,
            functions: state.functions.len(),
            uniforms: state.uniforms.len(),
            buffers: state.buffers.len(),
            textures: state.textures.len(),
            before_body: state.before_body,
            passes: Cell::new(0),
        })
    }

    /// Returns whether the body of the innermost loop, recorded just now, was recorded under wrong
    /// assumptions. Then it is discarded.
    pub(super) fn restart(&self, l: &RecordedLoop) -> bool {
        let Some(start) = &l.start else { return false };
        let mut state = self.state.borrow_mut();
        let Some(builder) = state.open.last_mut().filter(|b| b.assumed_too_few()) else {
            return false;
        };
        start.passes.set(start.passes.get() + 1);
        let recorded = core::mem::replace(builder, start.builder.clone());
        builder.widen(&recorded, start.passes.get() >= CAUTIOUS);
        state.functions.truncate(start.functions);
        state.uniforms.truncate(start.uniforms);
        state.buffers.truncate(start.buffers);
        state.textures.truncate(start.textures);
        state.before_body = start.before_body;
        l.body.take();
        true
    }
}
