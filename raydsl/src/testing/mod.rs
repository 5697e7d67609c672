//! Kernel tests, which run and compare every variant.
//!
//! * [`assert_variants_agree!`](crate::assert_variants_agree) runs a kernel over inputs in every
//!   variant.
//! * [`#[variant_test]`](crate::variant_test) makes a `#[test]` of each variant from one body.
//! * [`wgsl_test!`](crate::wgsl_test) makes a `#[test]` that a kernel's WGSL is valid. It needs no
//!   device.
//!
//! Variants that a machine lacks are skipped, with a message on standard error. With
//! `RAYDSL_REQUIRE_GPU=1` in the environment a missing device is an error.

mod agree;
mod agreement;
pub mod check;
mod explain;
mod film_test;
mod leaves;
mod means;
mod panics;
mod wgsl;

use crate::kernel::{Kernel, Variant};
use crate::machine::Type;

pub use agree::{Disagreement, variants_agree};
pub use agreement::{Agreement, BUCKETS, ulp};
pub use explain::{Cause, Explanation, Sample, explain};
#[doc(hidden)]
pub use explain::{OutcomesOf, SAMPLES, causes, sampled, spread};
#[doc(hidden)]
pub use film_test::MeansOf;
pub use film_test::{FilmTest, Inputs};
pub use means::{MeansAgreement, MeansTest, MeansVerdict, PairedMeans, Scale};
pub use wgsl::{InvalidWgsl, assert_valid_wgsl, validate};

/// Returns whether `variant` runs on this machine; if not, a message names `test`.
///
/// # Panics
///
/// If `variant` is WGSL, there is no device, and `RAYDSL_REQUIRE_GPU` is `1`.
pub fn can_run(variant: Variant, test: &str) -> bool {
    if variant == Variant::Wgsl {
        return device(test);
    }
    let has = variant.is_native();
    if !has {
        eprintln!("SKIPPED: {test}: this machine has no registers for {}", variant.name());
    }
    has
}

#[cfg(all(feature = "gpu", not(target_family = "wasm")))]
fn device(test: &str) -> bool {
    match shared() {
        Ok(_) => true,
        Err(error) => missing_device(test, error),
    }
}

#[cfg(not(all(feature = "gpu", not(target_family = "wasm"))))]
fn device(test: &str) -> bool {
    missing_device(test, NO_DEVICE)
}

/// Why there is no device to be asked for.
#[cfg(not(all(feature = "gpu", not(target_family = "wasm"))))]
const NO_DEVICE: &str = if cfg!(feature = "gpu") {
    "a test in a browser cannot wait for one: await GpuScheduler::batch_async"
} else {
    "raydsl was built without the feature `gpu`"
};

/// Skips with a message, or fails if a device is required.
fn missing_device(test: &str, error: &str) -> bool {
    let required = std::env::var("RAYDSL_REQUIRE_GPU").is_ok_and(|v| v == "1");
    assert!(!required, "RAYDSL_REQUIRE_GPU=1, but {test} has no device: {error}");
    eprintln!("SKIPPED: {test}: no device for WGSL ({error})");
    false
}

/// Returns the device of this process' tests, or why there is none.
#[cfg(all(feature = "gpu", not(target_family = "wasm")))]
fn shared() -> Result<&'static crate::gpu::GpuScheduler, &'static str> {
    use crate::gpu::{Context, GpuScheduler};
    // A driver for CPUs compiles at the first dispatch, and beside other tests.
    const TIMEOUT: std::time::Duration = std::time::Duration::from_secs(300);
    static GPU: std::sync::OnceLock<Result<GpuScheduler, String>> = std::sync::OnceLock::new();
    let gpu = GPU.get_or_init(|| {
        let context = Context::new().map_err(|e| e.to_string())?;
        Ok(GpuScheduler::with_context(context.with_timeout(TIMEOUT)))
    });
    gpu.as_ref().map_err(String::as_str)
}

/// Runs any variant for which [`can_run`] returns true, and returns the results.
///
/// # Panics
///
/// If the device refuses, or there is none.
pub fn run<A: Type, R: Type>(kernel: &Kernel<'_, A, R>, variant: Variant, inputs: &[A]) -> Vec<R> {
    match try_run(kernel, variant, inputs) {
        Ok(found) => found,
        Err(error) => panic!("{}: {error}", variant.name()),
    }
}

/// Returns a value that no result has by chance: its bytes are a pattern.
fn unwritten<R: Type>() -> R {
    let pattern = (0..R::SCHEMA.size()).map(|i| if i % 4 == 3 { 0x5a } else { 0xa5 });
    R::read(&pattern.collect::<Vec<u8>>())
}

fn try_run<A: Type, R: Type>(
    kernel: &Kernel<'_, A, R>,
    variant: Variant,
    inputs: &[A],
) -> Result<Vec<R>, String> {
    // A variant that omits a result must not find the right zeros here.
    let mut found = vec![unwritten(); inputs.len()];
    if variant == Variant::Wgsl {
        on_device(kernel, inputs, &mut found)?;
    } else {
        kernel.run(variant, inputs, &mut found);
    }
    Ok(found)
}

#[cfg(all(feature = "gpu", not(target_family = "wasm")))]
fn on_device<A: Type, R: Type>(
    kernel: &Kernel<'_, A, R>,
    inputs: &[A],
    found: &mut [R],
) -> Result<(), String> {
    use crate::render::Renderer;
    shared()?.batch(kernel, inputs, found).map(|_| ()).map_err(|e| e.to_string())
}

#[cfg(not(all(feature = "gpu", not(target_family = "wasm"))))]
fn on_device<A: Type, R: Type>(_: &Kernel<'_, A, R>, _: &[A], _: &mut [R]) -> Result<(), String> {
    Err(NO_DEVICE.to_owned())
}

/// Panics unless every variant of a kernel agrees with the scalar one.
///
/// The first argument is a reference to a [`Kernel`], or the name of a `#[kernel] fn`; the second a
/// slice of its parameters, as tuples, or for a kernel that renders films a
/// [`FilmTest`](crate::testing::FilmTest).
///
/// * Packets must return the bits of the scalar function; +0 equals -0, and NaN equals NaN.
/// * The WGSL must be valid. On a device its results may differ by rounding, and in decisions that
///   rounding leaves open, according to [`explain`]. The rounding is that allowed by WGSL,
///   [`Rounding::WGSL`](crate::machine::Rounding::WGSL), unless given as a third argument.
///   On a film, where too many decisions are open for that, its means must agree: see
///   [`MeansTest`](crate::testing::MeansTest).
///
/// The panic message lists up to ten differing results: variant, index, the first wrong number, the
/// expected and the found value with their bits, the values that rounding allows, and the input.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::{assert_variants_agree, kernel};
///
/// #[kernel]
/// fn falloff(distance: f32) -> f32 {
///     if distance < 1.0 { 1.0 } else { 1.0 / (distance * distance) }
/// }
///
/// let inputs: Vec<(f32,)> = (0..1000).map(|i| (i as f32 * 0.01,)).collect();
/// assert_variants_agree!(falloff, &inputs);
///
/// let gain = 2.0;
/// let louder = kernel!(|distance: f32| gain * falloff(distance));
/// assert_variants_agree!(&louder, &inputs);
/// ```
///
/// [`Kernel`]: crate::kernel::Kernel
#[macro_export]
macro_rules! assert_variants_agree {
    (& $kernel:expr, $inputs:expr $(,)?) => {
        $crate::assert_variants_agree!(&$kernel, $inputs, $crate::machine::Rounding::WGSL)
    };
    (& $kernel:expr, $inputs:expr, $rounding:expr $(,)?) => {
        let found = $crate::testing::variants_agree(&$kernel, $inputs, $rounding);
        if let ::core::result::Result::Err(e) = found {
            ::core::panic!("{e}");
        }
    };
    ($kernel:path, $inputs:expr $(, $rounding:expr)? $(,)?) => {
        $crate::assert_variants_agree!(
            &$crate::kernel::Kernel::of::<$kernel>(), $inputs $(, $rounding)?
        )
    };
}
