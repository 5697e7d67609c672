//! Shared code of the benchmarks: scenes, the hand-written loop, clocks, the guard, visits of
//! nodes, Embree.

pub mod clock;
pub mod divergent;
pub mod embree;
pub mod guard;
pub mod hand;
pub mod scenes;
pub mod visits;
