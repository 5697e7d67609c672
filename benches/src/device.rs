//! A device as one of the contenders.

use std::time::{Duration, Instant};

use raydsl::gpu::{Context, GpuError, GpuScheduler, Timing};

/// Opens this machine's device if `is_asked`, and says which it is. If `is_fused`, its driver may fuse
/// and move operations.
///
/// # Errors
///
/// If there is none.
pub fn open(is_asked: bool, is_fused: bool) -> Result<Option<GpuScheduler>, GpuError> {
    if !is_asked {
        return Ok(None);
    }
    let context = Context::new()?;
    let context = if is_fused { context.with_operations_fused() } else { context };
    let exact = if context.is_exact() { "exact" } else { "not exact" };
    println!("WGSL on {}, {exact}", context.adapter_name());
    Ok(Some(GpuScheduler::with_context(context)))
}

/// How long a device is kept busy for one figure.
const BUSY: Duration = Duration::from_secs(1);

/// The least seconds that a device needs for `run`, by its own clock, or of the whole call if it has
/// none. It runs again and again for a while: a device that was idle has lowered its frequency.
///
/// # Panics
///
/// If the device refuses the kernel or is lost.
pub fn device_seconds(mut run: impl FnMut() -> Result<Timing, GpuError>) -> f64 {
    let begun = Instant::now();
    let mut least = f64::INFINITY;
    loop {
        let timing = run().expect("the device runs the kernel");
        least = least.min(1e-3 * timing.device_ms.unwrap_or(timing.wall_ms));
        if begun.elapsed() > BUSY {
            return least;
        }
    }
}
