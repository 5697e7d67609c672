//! Tests with hand-written modules that follow the interface, on any adapter.

mod application;
mod awaited;
mod background;
mod failures;
mod grid;
mod kernels;
mod scene;

use std::io::Write;

use super::{Context, GpuError};

/// Returns a context, or `None` with a message on standard error if the machine has no adapter.
///
/// `RAYDSL_REQUIRE_GPU=1` turns the skip into a failure.
pub(super) fn context() -> Option<Context> {
    match Context::new() {
        Ok(context) => Some(context),
        Err(error @ GpuError::NoAdapter { .. }) => {
            let required = std::env::var("RAYDSL_REQUIRE_GPU").is_ok_and(|value| value == "1");
            assert!(!required, "RAYDSL_REQUIRE_GPU=1, but {error}");
            // Not eprintln!, which the test harness captures when a test passes.
            let _ = writeln!(std::io::stderr(), "SKIPPED: no GPU adapter");
            None
        }
        Err(error) => panic!("{error}"),
    }
}
