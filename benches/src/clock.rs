//! Time that a thread was running, and what rounds of it say.

use std::time::Duration;

#[cfg(target_os = "linux")]
mod thread {
    use std::time::Duration;

    #[repr(C)]
    struct Timespec {
        seconds: i64,
        nanoseconds: i64,
    }

    const CLOCK_THREAD_CPUTIME_ID: i32 = 3;

    unsafe extern "C" {
        fn clock_gettime(clock: i32, time: *mut Timespec) -> i32;
    }

    pub(super) fn now() -> Duration {
        let mut time = Timespec { seconds: 0, nanoseconds: 0 };
        // SAFETY: the clock exists on every Linux, and `time` is a valid place for its answer.
        let status = unsafe { clock_gettime(CLOCK_THREAD_CPUTIME_ID, &raw mut time) };
        assert_eq!(status, 0, "no thread clock");
        Duration::new(time.seconds as u64, time.nanoseconds as u32)
    }
}

#[cfg(not(target_os = "linux"))]
mod thread {
    use std::sync::OnceLock;
    use std::time::{Duration, Instant};

    pub(super) fn now() -> Duration {
        static START: OnceLock<Instant> = OnceLock::new();
        START.get_or_init(Instant::now).elapsed()
    }
}

/// How long this thread has been running. On a shared machine that says more than the time of
/// day; where the system does not tell, it is the time of day.
pub fn thread_time() -> Duration {
    thread::now()
}

/// The seconds that `f` takes on this thread.
pub fn seconds(f: impl FnOnce()) -> f64 {
    let start = thread_time();
    f();
    (thread_time() - start).as_secs_f64()
}

/// What `f` gives, and the seconds that it takes: of one thread those that it was running, of
/// several those of the day.
pub fn seconds_on<T>(threads: usize, f: impl FnOnce() -> T) -> (T, f64) {
    let (start, begun) = (thread_time(), std::time::Instant::now());
    let result = f();
    let seconds = if threads == 1 { thread_time() - start } else { begun.elapsed() };
    (result, seconds.as_secs_f64())
}

/// The value below which the share `q` of `values` lies; 0 for none.
pub fn quantile(values: &[f64], q: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let index = q * sorted.len().saturating_sub(1) as f64;
    let (low, high) = (index.floor() as usize, index.ceil() as usize);
    match (sorted.get(low), sorted.get(high)) {
        (Some(a), Some(b)) => a + (b - a) * index.fract(),
        _ => 0.0,
    }
}

/// The middle value.
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// The middle half of the values, as a share of the median.
pub fn spread(values: &[f64]) -> f64 {
    (quantile(values, 0.75) - quantile(values, 0.25)) / median(values)
}
