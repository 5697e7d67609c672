//! Packets that do not wait for each other, where a machine has no fibers.

use super::{Key, Scratch};

/// Packets are alone anyway.
pub(crate) struct Alone;

impl Alone {
    pub(crate) const fn begin() -> Self {
        Self
    }
}

/// Runs `job` for each number below `count`.
pub(crate) fn each(count: usize, _at_once: usize, job: &dyn Fn(usize)) {
    (0..count).for_each(job);
}

/// Does not ask together with others.
pub(crate) fn ask<S: Scratch>(
    _key: Key,
    _load: impl FnOnce(&mut S) -> usize,
    _answer: impl FnOnce(&mut S),
    _read: impl FnOnce(&S, usize),
) -> bool {
    false
}
