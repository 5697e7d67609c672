//! Who owns scene data, and whether they still do: a device keeps what it was sent until then.

use core::sync::atomic::{AtomicU64, Ordering};
use std::collections::HashSet;
use std::sync::{Mutex, MutexGuard, PoisonError};

static NEXT: AtomicU64 = AtomicU64::new(1);

/// The numbers of all owners that there are.
fn living() -> MutexGuard<'static, Option<HashSet<u64>>> {
    static LIVING: Mutex<Option<HashSet<u64>>> = Mutex::new(None);
    // The set is whole between any two operations.
    LIVING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A number that no other owner of scene data has, or ever has had.
#[derive(Debug)]
pub(crate) struct Owner(u64);

impl Owner {
    pub(crate) fn new() -> Self {
        let id = NEXT.fetch_add(1, Ordering::Relaxed);
        living().get_or_insert_default().insert(id);
        Self(id)
    }

    #[inline(always)]
    pub(crate) fn id(&self) -> u64 {
        self.0
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        if let Some(living) = living().as_mut() {
            living.remove(&self.0);
        }
    }
}

/// Those of these numbers whose owners are gone.
#[cfg(feature = "gpu")]
pub(crate) fn gone(ids: impl Iterator<Item = u64>) -> Vec<u64> {
    let next = NEXT.load(Ordering::Relaxed);
    let living = living();
    let lives = |id: &u64| living.as_ref().is_some_and(|living| living.contains(id));
    ids.filter(|id| *id < next && !lives(id)).collect()
}
