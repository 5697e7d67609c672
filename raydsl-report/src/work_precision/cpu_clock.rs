//! CPU time of the process.

/// A clock of this process's CPU time, from [`Self::start`] on.
#[derive(Clone, Copy, Debug)]
pub(super) struct CpuClock {
    /// `None` if the system refuses.
    #[cfg(feature = "cpu_time")]
    start: Option<cpu_time::ProcessTime>,
}

impl CpuClock {
    pub(super) fn start() -> Self {
        Self {
            #[cfg(feature = "cpu_time")]
            start: cpu_time::ProcessTime::try_now().ok(),
        }
    }

    /// Returns user and system time of all threads; `None` without the feature `cpu_time`.
    pub(super) fn seconds(self) -> Option<f64> {
        #[cfg(feature = "cpu_time")]
        return self.start?.try_elapsed().ok().map(|time| time.as_secs_f64());
        #[cfg(not(feature = "cpu_time"))]
        None
    }
}

#[cfg(all(test, feature = "cpu_time"))]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;

    /// Tests that work is counted. Tests running beside this one make the clock faster, never
    /// slower: it is that of the whole process.
    #[test]
    fn work_is_counted() {
        let (clock, start) = (CpuClock::start(), Instant::now());
        let mut sum = 0u64;
        while start.elapsed() < Duration::from_millis(50) {
            sum = core::hint::black_box(sum + 1);
        }
        let worked = clock.seconds();
        // On a shared machine, this thread may have had little of that time.
        assert!(worked.is_some_and(|s| s > 1e-3), "{worked:?} after {sum} steps");
    }
}
