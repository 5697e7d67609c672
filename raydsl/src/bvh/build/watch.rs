//! Telling an observer how far a build is, and stopping when it says so.
//!
//! Work is counted in units that add up to a known sum whatever is found on the way: boxes read,
//! and places for references whose subtree is done. Units are counted in an atomic number, a few
//! thousand at a time, and the observer is called by whoever counts past the next step.
//!
//! A stop is a flag that long loops look at. They leave early with whatever they have, which is
//! thrown away: no code but [`Watch::finish`] has to know that a build can fail half way.

use core::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::error::BuildError;

/// The observer is called at most once for each of these steps, and at the beginning and the end.
const STEPS: usize = 200;

/// Who is told, and how far the build is.
pub(super) struct Watch<'a> {
    observer: Option<Mutex<Observer<'a>>>,
    /// Units of the whole build.
    total: usize,
    done: AtomicUsize,
    is_stopped: AtomicBool,
}

/// The observer, and the last step it was told.
struct Observer<'a> {
    tell: &'a mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
    step: usize,
}

impl<'a> Watch<'a> {
    /// No one is told.
    pub(super) const fn nobody() -> Self {
        let (done, is_stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        Self { observer: None, total: 0, done, is_stopped }
    }

    /// Tells `tell` that a build of `total` units begins.
    pub(super) fn begin(
        tell: &'a mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
        total: usize,
    ) -> Self {
        let is_stopped = AtomicBool::new(tell(0.0).is_break());
        let observer = Some(Mutex::new(Observer { tell, step: 0 }));
        Self { observer, total: total.max(1), done: AtomicUsize::new(0), is_stopped }
    }

    /// Counts `units` that are done.
    pub(super) fn advance(&self, units: usize) {
        let Some(observer) = &self.observer else { return };
        let before = self.done.fetch_add(units, Ordering::Relaxed);
        let step = |done: usize| (done as f64 / self.total as f64 * STEPS as f64) as usize;
        if step(before + units) == step(before) {
            return;
        }
        // Whoever finds the observer busy goes on with its work: another step will follow.
        let Ok(mut observer) = observer.try_lock() else { return };
        let step = step(self.done.load(Ordering::Relaxed));
        // The last step is told by `finish`, and nothing after a stop.
        if step > observer.step && step < STEPS && !self.is_stopped() {
            observer.step = step;
            if (observer.tell)(step as f64 / STEPS as f64).is_break() {
                self.is_stopped.store(true, Ordering::Relaxed);
            }
        }
    }

    /// Whether what is being built will be thrown away.
    #[inline]
    pub(super) fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }

    /// Whether the build was stopped: an error then.
    pub(super) fn check(&self) -> Result<(), BuildError> {
        if self.is_stopped() { Err(BuildError::Cancelled) } else { Ok(()) }
    }

    /// Tells that all is done, which may still be answered with a stop.
    pub(super) fn finish(self) -> Result<(), BuildError> {
        self.check()?;
        let Some(observer) = self.observer else { return Ok(()) };
        let observer = observer.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
        if (observer.tell)(1.0).is_break() { Err(BuildError::Cancelled) } else { Ok(()) }
    }
}
