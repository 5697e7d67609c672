//! Validation of generated WGSL without a device.

use crate::kernel::Kernel;
use crate::machine::{KernelFn, Type};

/// The error for invalid WGSL: naga's message and the text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}\n{source_text}")]
pub struct InvalidWgsl {
    /// naga's message, with the lines concerned.
    pub message: String,
    /// The whole text.
    pub source_text: String,
}

/// Validates a kernel's WGSL with naga, the compiler of wgpu.
///
/// Without the feature `validate`, which `gpu` contains, the kernel is only recorded and standard
/// error says that nothing was validated.
///
/// # Errors
///
/// If the WGSL is not valid.
pub fn validate<A: Type, R: Type>(kernel: &Kernel<'_, A, R>) -> Result<(), InvalidWgsl> {
    let source_text = kernel.wgsl();
    check(&source_text).map_err(|message| InvalidWgsl { message, source_text })
}

#[cfg(feature = "validate")]
fn check(source: &str) -> Result<(), String> {
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map(|_| ())
        .map_err(|e| e.emit_to_string(source))
}

#[cfg(not(feature = "validate"))]
fn check(_: &str) -> Result<(), String> {
    eprintln!("SKIPPED: WGSL is not validated: raydsl was built without the feature `validate`");
    Ok(())
}

/// Implements [`wgsl_test!`](crate::wgsl_test).
///
/// # Panics
///
/// If the WGSL of `F` is not valid.
pub fn assert_valid_wgsl<F: KernelFn>() {
    if let Err(e) = validate(&Kernel::of::<F>()) {
        let info = F::info();
        panic!("the WGSL of `{}` ({}:{}) is not valid: {e}", info.name, info.file, info.line);
    }
}

/// Implements the test of `wgsl_test!`. The features of raydsl are known here, not where the macro
/// is called.
#[cfg(feature = "validate")]
#[doc(hidden)]
#[macro_export]
macro_rules! __wgsl_test {
    ($name:ident, $kernel:path) => {
        #[test]
        fn $name() {
            $crate::testing::assert_valid_wgsl::<$kernel>();
        }
    };
}

/// Ignores the test without naga, since nothing would be tested.
#[cfg(not(feature = "validate"))]
#[doc(hidden)]
#[macro_export]
macro_rules! __wgsl_test {
    ($name:ident, $kernel:path) => {
        #[test]
        #[ignore = "raydsl was built without the feature `validate`"]
        fn $name() {
            $crate::testing::assert_valid_wgsl::<$kernel>();
        }
    };
}

#[cfg(all(test, feature = "validate"))]
mod tests {
    use super::check;

    #[test]
    fn mistakes_are_named() {
        assert_eq!(check("fn f() -> f32 { return 1.0; }"), Ok(()));
        let error = check("fn f() -> f32 { return 1u; }").unwrap_err();
        assert!(error.contains("return 1u"), "{error}");
        assert!(check("fn f( {").is_err());
    }
}
