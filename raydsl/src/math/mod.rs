//! Numbers with few bits, elementary functions, and arithmetic that keeps what rounding loses.

mod code;
pub mod elementary;
pub(crate) mod exact;
mod half;
mod unorm;

pub use half::{F16, F16On};
pub use unorm::{Unorm8, Unorm8On, Unorm16, Unorm16On, Unorm32, Unorm32On};
