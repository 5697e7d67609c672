//! Packets that do not wait for each other, where a machine has no fibers.

use super::trace::Scratch;

/// What packets that would wait for each other have in common.
pub(super) type Key = (usize, [usize; 3]);

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
pub(super) fn ask(
    _key: Key,
    _load: impl FnOnce(&mut Scratch) -> usize,
    _answer: impl FnOnce(&mut Scratch),
    _read: impl FnOnce(&Scratch, usize),
) -> bool {
    false
}
