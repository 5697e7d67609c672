//! Progress reports to an observer, which may stop the run.

use core::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// An observer of a picture: it receives the completed share, from 0 to 1, and returns whether to
/// go on.
pub type Observer<'a> = &'a mut (dyn FnMut(f64) -> ControlFlow<()> + Send);

/// Reports the progress of a shot to an observer. A scheduler of your own counts pixels with it,
/// and returns when it is stopped.
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
    /// Creates a watch without an observer.
    pub(super) const fn nobody() -> Self {
        let (done, is_stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        Self { observer: None, total: 1, done, is_stopped }
    }

    /// Creates a watch that reports the completed share of `total` pixels, excluding the beginning
    /// and the end.
    pub(super) fn new(observer: Observer<'a>, total: usize) -> Self {
        let (done, is_stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        Self { observer: Some(Mutex::new(observer)), total: total.max(1), done, is_stopped }
    }

    /// Counts `pixels` as completed.
    pub fn advance(&self, pixels: usize) {
        let Some(observer) = &self.observer else { return };
        self.done.fetch_add(pixels, Ordering::Relaxed);
        // A thread that finds the observer busy goes on with its work: another tile will follow.
        let Ok(mut observer) = observer.try_lock() else { return };
        let done = self.done.load(Ordering::Relaxed);
        if done < self.total
            && !self.is_stopped()
            && observer(done as f64 / self.total as f64).is_break()
        {
            self.is_stopped.store(true, Ordering::Relaxed);
        }
    }

    /// Returns whether the observer stopped the run.
    pub fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }
}
