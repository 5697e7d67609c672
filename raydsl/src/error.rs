//! Re-exports of the library's error types, which are defined where the errors arise.
pub use crate::bvh::BuildError;
pub use crate::camera::CameraError;
#[cfg(feature = "gpu")]
pub use crate::gpu::GpuError;
pub use crate::sampling::TableError;
#[cfg(feature = "image")]
pub use crate::texture::LoadError;
pub use crate::texture::TextureError;
