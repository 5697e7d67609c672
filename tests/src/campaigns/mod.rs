//! Campaigns: many rays at what is hard, and how many of them are lost.
//!
//! The tests run a share of each, the program `robustness` of the benchmarks runs all.

pub mod bounces;
mod exact;
pub mod mesh;
pub mod slabs;
mod tally;
pub mod watertight;

pub use tally::{Asked, Tally, grouped};

/// Natural variants of the CPU, in the order in which they are asked.
pub const VARIANTS: [raydsl::prelude::Variant; 4] = {
    use raydsl::prelude::Variant::{Packet4, Packet8, Packet16, Scalar};
    [Scalar, Packet4, Packet8, Packet16]
};

/// The name of what has nothing against rounding, in the column beside the library's variants.
pub const TEXTBOOK: &str = "textbook";
