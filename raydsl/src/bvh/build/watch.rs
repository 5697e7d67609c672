//! Progress and cancellation of a build.
//!
//! Work is counted in units with a total known beforehand: boxes read, and places for references
//! whose subtree is done. An atomic counter advances by a few thousand units at a time, and the
//! thread that counts past the next step calls the observer.
//!
//! A stop is a flag that long loops poll. They leave early with an incomplete result, which is
//! thrown away: no code but [`Watch::finish`] has to know that a build can fail half way.

use core::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::error::BuildError;

/// The observer is called at most once for each of these steps, and at the beginning and the end.
const STEPS: usize = 200;

/// Progress of a build, and its observer.
pub(super) struct Watch<'a> {
    observer: Option<Mutex<Observer<'a>>>,
    /// Total units of the build.
    total: usize,
    done: AtomicUsize,
    is_stopped: AtomicBool,
}

/// The observer, and the last step reported to it.
struct Observer<'a> {
    tell: &'a mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
    step: usize,
}

impl<'a> Watch<'a> {
    /// Creates a watch without an observer.
    pub(super) const fn nobody() -> Self {
        let (done, is_stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        Self { observer: None, total: 0, done, is_stopped }
    }

    /// Reports the start of a build of `total` units to `tell`.
    pub(super) fn begin(
        tell: &'a mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
        total: usize,
    ) -> Self {
        let is_stopped = AtomicBool::new(tell(0.0).is_break());
        let observer = Some(Mutex::new(Observer { tell, step: 0 }));
        Self { observer, total: total.max(1), done: AtomicUsize::new(0), is_stopped }
    }

    /// Counts `units` as done, and reports the next step if it is reached.
    pub(super) fn advance(&self, units: usize) {
        let Some(observer) = &self.observer else { return };
        let before = self.done.fetch_add(units, Ordering::Relaxed);
        let step = |done: usize| (done as f64 / self.total as f64 * STEPS as f64) as usize;
        if step(before + units) == step(before) {
            return;
        }
        // If another thread holds the observer, skip the report: another step will follow.
        let Ok(mut observer) = observer.try_lock() else { return };
        let step = step(self.done.load(Ordering::Relaxed));
        // `finish` reports the last step; nothing is reported after a stop.
        if step > observer.step && step < STEPS && !self.is_stopped() {
            observer.step = step;
            if (observer.tell)(step as f64 / STEPS as f64).is_break() {
                self.is_stopped.store(true, Ordering::Relaxed);
            }
        }
    }

    /// Returns whether the build was cancelled and its result will be thrown away.
    #[inline]
    pub(super) fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }

    /// Returns an error if the build was cancelled.
    pub(super) fn check(&self) -> Result<(), BuildError> {
        if self.is_stopped() { Err(BuildError::Cancelled) } else { Ok(()) }
    }

    /// Reports the end of the build, which may still be answered with a stop.
    pub(super) fn finish(self) -> Result<(), BuildError> {
        self.check()?;
        let Some(observer) = self.observer else { return Ok(()) };
        let observer = observer.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
        if (observer.tell)(1.0).is_break() { Err(BuildError::Cancelled) } else { Ok(()) }
    }
}
