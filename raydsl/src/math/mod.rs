//! Low-precision numbers, elementary functions, and error-free transformations.

mod code;
pub mod elementary;
pub(crate) mod exact;
mod half;
mod unorm;

pub(crate) use half::half_to_f32;
pub use half::{F16, F16On};
pub use unorm::{Unorm8, Unorm8On, Unorm16, Unorm16On, Unorm32, Unorm32On};
