//! Shared code of the benchmarks: scenes, the hand-written loop, clocks, the guard, visits of
//! nodes.

pub mod clock;
pub mod divergent;
pub mod guard;
pub mod hand;
pub mod scenes;
pub mod visits;
