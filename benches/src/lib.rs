//! Shared code of the benchmarks: scenes, the hand-written loop, clocks, the guard, Embree, tables
//! of systems beside each other.

pub mod clock;
pub mod contest;
pub mod device;
pub mod divergent;
pub mod embree;
pub mod guard;
pub mod hand;
pub mod scenes;
pub mod table;
