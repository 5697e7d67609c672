//! Shared code of the benchmarks: scenes, the hand-written loop, clocks, the guard.

pub mod clock;
pub mod divergent;
pub mod guard;
pub mod hand;
pub mod scenes;
