//! The device of the tests.

use std::sync::OnceLock;

use raydsl::gpu::GpuScheduler;

/// The scheduler of this machine's adapter, or `None` after saying so loudly.
///
/// # Panics
///
/// If there is no adapter and `RAYDSL_REQUIRE_GPU` is `1`.
#[must_use = "a test that needs a device must return without one"]
pub fn gpu() -> Option<&'static GpuScheduler> {
    static GPU: OnceLock<Option<GpuScheduler>> = OnceLock::new();
    GPU.get_or_init(|| match GpuScheduler::new() {
        Ok(gpu) => {
            eprintln!("GPU adapter: {}", gpu.context().adapter_name());
            Some(gpu)
        }
        Err(error) => {
            let required = std::env::var("RAYDSL_REQUIRE_GPU").is_ok_and(|v| v == "1");
            assert!(!required, "RAYDSL_REQUIRE_GPU=1, but: {error}");
            eprintln!("SKIPPED: no GPU adapter ({error})");
            None
        }
    })
    .as_ref()
}
