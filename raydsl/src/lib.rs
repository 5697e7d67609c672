#![doc = include_str!("../README.md")]

extern crate self as raydsl;

pub mod bvh;
pub mod camera;
pub mod error;
pub mod geometry;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod kernel;
pub mod machine;
pub mod math;
pub mod prelude;
pub mod render;
pub mod report;

#[doc(hidden)]
pub mod __private;

pub use machine::Type;
pub use raydsl_macros::{Type, primitive};
/// `#[kernel]` on a function or an impl; the closure macro `kernel!` is in the [`prelude`].
pub use raydsl_macros::{kernel, kernels};
