//! Errors of the library are typed where they arise; this module names them in one place.
pub use crate::bvh::BuildError;
#[cfg(feature = "gpu")]
pub use crate::gpu::GpuError;
