//! Twelve others, written when the first twelve compiled, also before any was compiled.

mod bits;
mod clip;
mod cubic;
mod difference;
mod events;
mod mirrors;
mod openness;
mod palette;
mod patterns;
mod spectrum;
mod statistics;
mod tone;
