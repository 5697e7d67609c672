#![doc = include_str!("../README.md")]
// On docs.rs, whose compiler is a nightly, items tell the feature that they need.
#![cfg_attr(docsrs, feature(doc_cfg))]

extern crate self as raydsl;

pub mod bsdf;
pub mod bvh;
pub mod camera;
pub mod error;
pub mod flow;
pub mod geometry;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod integrators;
pub mod kernel;
pub mod light;
pub mod machine;
pub mod math;
pub mod prelude;
pub mod render;
mod run;
pub mod sampling;
pub mod shading;
pub mod testing;
pub mod texture;
pub mod volume;

#[doc(hidden)]
pub mod __private;

pub use bvh::{RayQuery, RecordQuery};
pub use geometry::HitRecord;
pub use machine::Type;
/// One body, a test for each variant.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::{kernel, testing, variant_test};
///
/// #[kernel]
/// fn twice(x: f32) -> f32 {
///     x + x
/// }
///
/// #[variant_test]
/// fn doubles(variant: Variant) {
///     let found = testing::run(&Kernel::of::<twice>(), variant, &[(1.5,), (-2.0,)]);
///     assert_eq!(found, [3.0, -4.0]);
/// }
/// # doubles(Variant::Packet8);
/// ```
pub use raydsl_macros::variant_test;
/// A test that a kernel's WGSL is valid.
///
/// ```
/// use raydsl::{kernel, wgsl_test};
///
/// #[kernel]
/// fn twice(x: f32) -> f32 {
///     x + x
/// }
///
/// wgsl_test!(twice);
/// # raydsl::testing::assert_valid_wgsl::<twice>();
/// ```
pub use raydsl_macros::wgsl_test;
pub use raydsl_macros::{HitRecord, RayQuery, Scene, Type, primitive};
/// `#[kernel]` on a function or an impl; the closure macro `kernel!` is in the [`prelude`].
pub use raydsl_macros::{kernel, kernels};
pub use shading::Scene;
