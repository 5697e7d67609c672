//! How long processors work.

/// Measures the processors' time of this process, from [`Self::start`] on.
#[derive(Clone, Copy, Debug)]
pub(super) struct CpuClock {
    /// None where the system refuses.
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

    /// User's and system's, of all threads; none without the feature `cpu_time`.
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

    /// Tests beside this one make it run faster, never slower: it is the whole process's clock.
    #[test]
    fn work_is_counted() {
        let (clock, start) = (CpuClock::start(), Instant::now());
        let mut sum = 0u64;
        while start.elapsed() < Duration::from_millis(50) {
            sum = core::hint::black_box(sum + 1);
        }
        let worked = clock.seconds();
        // On a machine that is shared, this thread may have had little of that time.
        assert!(worked.is_some_and(|s| s > 1e-3), "{worked:?} after {sum} steps");
    }
}
