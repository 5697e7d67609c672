//! What kernels may say, and that every variant does the same.

mod closures;
mod glam;
mod integers;
mod language;
mod listings;
mod names;
mod patterns;
mod sums;
mod walls;
