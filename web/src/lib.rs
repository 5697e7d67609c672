//! A page with raydsl in a browser: a landscape of points, a volume and the Cornell box, by WebGPU
//! or by packets in WebAssembly.
//!
//! `cargo run --release -p raydsl-web --bin serve` builds and serves it. A [`Request`] says what a
//! page shows, and [`Subject::with_kernel`] makes the kernel of it, on a page and elsewhere.

#[cfg(not(target_family = "wasm"))]
pub mod bundle;
#[cfg(target_family = "wasm")]
mod page;
mod passes;
mod request;
#[cfg(not(target_family = "wasm"))]
pub mod server;
mod subject;

pub use passes::{SAMPLING, next_pass};
pub use request::{Fault, Request, RequestError};
pub use subject::{PictureKernel, Subject, SubjectError};
