//! What the tests of raydsl share.
//!
//! The tests are split by the kind of evidence that they give: `variants` (every variant of small
//! kernels agrees with the untouched source), `glam` (so does every operation), `rays` and `edges`
//! (queries of scenes), `images`, `gpu`, `layout`, `unorm`, `elementary`, `fuzz` (random kernels),
//! `campaign` (very many inputs at what is hard), `adversary` (scenes made of bytes).

pub mod adversary;
pub mod check;
pub mod close;
pub mod filters;
pub mod fuzz;
pub mod gpu;
pub mod hard_rays;
pub mod kernels;
pub mod lattice;
pub mod levels;
pub mod operations;
pub mod placed;
pub mod queries;
pub mod rng;
pub mod run_time;
pub mod scenes;
pub mod transport;
pub mod values;

/// How many rays a heavy test takes: `full`, or a share of it that the environment variable
/// `RAYDSL_TEST_SHARE` names, as in `0.1`.
pub fn scaled(full: usize) -> usize {
    let share = std::env::var("RAYDSL_TEST_SHARE").ok();
    let share = share.and_then(|s| s.parse::<f64>().ok()).unwrap_or(1.0);
    ((full as f64 * share) as usize).max(64)
}

/// How many threads a heavy test may use.
pub fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Does `work` for every part of `0..count`, on all processors, where there are threads.
pub fn in_parallel(count: usize, part: usize, work: impl Fn(std::ops::Range<usize>) + Sync) {
    let next = std::sync::atomic::AtomicUsize::new(0);
    let parts = || {
        loop {
            let start = next.fetch_add(part, std::sync::atomic::Ordering::Relaxed);
            if start >= count {
                break;
            }
            work(start..(start + part).min(count));
        }
    };
    if cfg!(target_family = "wasm") {
        return parts();
    }
    std::thread::scope(|scope| {
        for _ in 0..threads() {
            scope.spawn(parts);
        }
    });
}
