//! Numbers with few bits, elementary functions, and what glam's matrices lack.

pub mod elementary;
pub(crate) mod matrix;
mod unorm;

pub use unorm::{Unorm8, Unorm8On, Unorm16, Unorm16On, Unorm32, Unorm32On};
