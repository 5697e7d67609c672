//! Numbers with few bits, and elementary functions.

pub mod elementary;
mod unorm;

pub use unorm::{Unorm8, Unorm8On, Unorm16, Unorm16On, Unorm32, Unorm32On};
