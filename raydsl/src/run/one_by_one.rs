//! Fallback for targets without fibers: packets answer their own queries.

use super::{Key, Scratch};

/// A guard without effect, since nothing yields.
pub(crate) struct NoYield;

impl NoYield {
    pub(crate) const fn begin() -> Self {
        Self
    }
}

/// Runs `job` for each index below `count`.
pub(crate) fn each(count: usize, _at_once: usize, job: &dyn Fn(usize)) {
    (0..count).for_each(job);
}

/// Returns false: there is no batch to join.
pub(crate) fn ask<S: Scratch>(
    _key: Key,
    _load: impl FnOnce(&mut S) -> usize,
    _answer: impl FnOnce(&mut S),
    _read: impl FnOnce(&S, usize),
) -> bool {
    false
}
