//! Numbers with few bits.

mod unorm;

pub use unorm::{Unorm8, Unorm8On, Unorm16, Unorm16On, Unorm32, Unorm32On};
