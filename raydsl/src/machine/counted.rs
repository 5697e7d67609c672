//! Lanes that count their utilisation at each place in the source.

use core::cell::RefCell;
use core::sync::atomic::{AtomicUsize, Ordering};
use std::collections::HashMap;

/// A place in the source of a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Place {
    /// The file, as `file!()` names it; empty for a place in the library.
    pub file: &'static str,
    /// The line.
    pub line: u32,
    /// `if`, `else` or `loop`, or the library's name for its own step.
    pub what: &'static str,
}

/// The lanes of `L`, with the running ones counted during a call of `count`.
#[derive(Clone, Copy, Debug)]
pub struct Counted<L>(pub L);

/// Packets that passed a place, and running lanes summed over them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// The number of packets that passed.
    pub rounds: u64,
    /// The number of running lanes, summed over the rounds.
    pub lanes: u64,
}

type Counts = HashMap<Place, Count>;

/// The number of threads that count. It is tested before the thread's own counters, which cost
/// more.
static COUNTING: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    static COUNTS: RefCell<Option<Counts>> = const { RefCell::new(None) };
}

#[inline(always)]
pub(super) fn is_counting() -> bool {
    COUNTING.load(Ordering::Relaxed) != 0
}

/// Counts the lanes whose bits are set.
#[cold]
#[inline(never)]
pub(super) fn add(place: Place, bits: u64) {
    COUNTS.with_borrow_mut(|counts| {
        if let Some(counts) = counts {
            let count = counts.entry(place).or_default();
            count.rounds += 1;
            count.lanes += u64::from(bits.count_ones());
        }
    });
}

/// Runs `f` and returns the counts of this thread at each place, ordered by place.
pub(crate) fn count(f: impl FnOnce()) -> Vec<(Place, Count)> {
    /// Ends the count even if `f` panics.
    struct Counting;
    impl Drop for Counting {
        fn drop(&mut self) {
            COUNTING.fetch_sub(1, Ordering::Relaxed);
        }
    }
    COUNTS.set(Some(Counts::new()));
    COUNTING.fetch_add(1, Ordering::Relaxed);
    let counting = Counting;
    f();
    drop(counting);
    let mut counts: Vec<_> = COUNTS.take().unwrap_or_default().into_iter().collect();
    counts.sort_unstable_by_key(|(place, _)| *place);
    counts
}
