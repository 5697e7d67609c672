//! Liveness of scene data's owners: a device keeps uploaded data as long as its owner lives.

use core::sync::atomic::{AtomicU64, Ordering};
use std::collections::HashSet;
use std::sync::{Mutex, MutexGuard, PoisonError};

static NEXT: AtomicU64 = AtomicU64::new(1);

/// Locks the set of the ids of all living owners.
fn living() -> MutexGuard<'static, Option<HashSet<u64>>> {
    static LIVING: Mutex<Option<HashSet<u64>>> = Mutex::new(None);
    // The set is consistent between any two operations.
    LIVING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// An id of an owner of scene data, unique in the process and never reused.
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

/// Returns those of `ids` whose owners are gone.
#[cfg(feature = "gpu")]
pub(crate) fn gone(ids: impl Iterator<Item = u64>) -> Vec<u64> {
    let next = NEXT.load(Ordering::Relaxed);
    let living = living();
    let lives = |id: &u64| living.as_ref().is_some_and(|living| living.contains(id));
    ids.filter(|id| *id < next && !lives(id)).collect()
}
