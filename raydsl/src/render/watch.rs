//! Telling an observer how far a picture is, and stopping when it says so.

use core::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// What an observer of a picture is: it is told the share that is done, from 0 to 1, and says
/// whether to go on.
pub type Observer<'a> = &'a mut (dyn FnMut(f64) -> ControlFlow<()> + Send);

/// Who is told how far a shot is. A scheduler of one's own counts pixels, and stops where it is
/// told to.
pub struct Watch<'a> {
    observer: Option<Mutex<Observer<'a>>>,
    total: usize,
    done: AtomicUsize,
    is_stopped: AtomicBool,
}

impl core::fmt::Debug for Watch<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Watch").field("done", &self.done).field("of", &self.total).finish()
    }
}

impl<'a> Watch<'a> {
    /// No one is told.
    pub(super) const fn nobody() -> Self {
        let (done, is_stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        Self { observer: None, total: 1, done, is_stopped }
    }

    /// `observer` is told how much of a shot of `total` pixels is done, between its ends.
    pub(super) fn new(observer: Observer<'a>, total: usize) -> Self {
        let (done, is_stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        Self { observer: Some(Mutex::new(observer)), total: total.max(1), done, is_stopped }
    }

    /// Counts `pixels` that are done.
    pub fn advance(&self, pixels: usize) {
        let Some(observer) = &self.observer else { return };
        self.done.fetch_add(pixels, Ordering::Relaxed);
        // Whoever finds the observer busy goes on with its work: another tile will follow.
        let Ok(mut observer) = observer.try_lock() else { return };
        let done = self.done.load(Ordering::Relaxed);
        if done < self.total
            && !self.is_stopped()
            && observer(done as f64 / self.total as f64).is_break()
        {
            self.is_stopped.store(true, Ordering::Relaxed);
        }
    }

    /// Whether the observer wants no more.
    pub fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }
}
