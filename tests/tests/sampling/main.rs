//! Random numbers, sequences and warps: that every variant gives the same, that samples have the
//! density that they say, and how fast errors fall.

mod convergence;
mod directions;
mod numbers;
mod statistics;
mod tables;
mod variants;
mod warps;
