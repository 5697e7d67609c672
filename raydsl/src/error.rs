//! Errors of the library are typed where they arise; this module names them in one place.
pub use crate::bvh::BuildError;
pub use crate::camera::CameraError;
#[cfg(feature = "gpu")]
pub use crate::gpu::GpuError;
pub use crate::sampling::TableError;
#[cfg(feature = "image")]
pub use crate::texture::LoadError;
pub use crate::texture::TextureError;
