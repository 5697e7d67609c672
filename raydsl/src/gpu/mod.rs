//! GPU runtime: generated WGSL run through wgpu.
//!
//! A [`Context`] owns, or borrows from the application, one device and its queue. Scene buffers are
//! uploaded once and kept ([`BufferKey`](crate::machine::wgsl::BufferKey)), pipelines are compiled
//! once and kept, and [`Context::run`] splits a grid into dispatches that fit the device's limits
//! and stay short. Every failure is returned as a [`GpuError`]: wgpu's own default, a panic, is
//! never left in place.
//!
//! In a browser nothing can wait: calls that need the device's answer are `async` there, and an
//! error of a call comes with the next one, or when a picture is awaited. On a machine the same
//! functions are awaited inside the plain ones.

mod answers;
#[cfg(not(target_family = "wasm"))]
mod background;
mod buffers;
mod chunks;
mod clock;
mod context;
mod device;
mod error;
#[cfg(not(target_family = "wasm"))]
mod exactness;
mod float_controls;
#[cfg(not(target_family = "wasm"))]
mod interface;
#[cfg(not(target_family = "wasm"))]
mod meanwhile;
mod pipeline;
#[cfg(not(target_family = "wasm"))]
mod pipeline_file;
mod pipelines;
mod run;
mod scheduler;
mod scopes;
mod slot;
#[cfg(not(target_family = "wasm"))]
mod spirv;
mod textures;
mod tiles;
mod window;

#[cfg(test)]
mod tests;

pub use context::Context;
pub use error::GpuError;
pub use pipeline::Checks;
pub use run::Timing;
pub use scheduler::GpuScheduler;
pub use window::{GpuWindow, OnGpu, OnHost, WindowError};
