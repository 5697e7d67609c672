//! Random kernels through every variant, against their own source.
//!
//! A seed gives a kernel ([`generator`]), which is printed as Rust (module [`mod@print`]). Kernels
//! are compiled in batches and run by their program ([`run`]), and a kernel that fails is made
//! smaller ([`shrink`]). The test program `fuzz` does all that ([`batch`]).
//!
//! # What must agree
//!
//! The untouched source says what is right. The scalar machine and packets of one lane and of every
//! width of every level give the same bits for all inputs, also with lanes moved, one lane alive
//! and NaN in lanes that do not run. Zeros of either sign are equal, and so is every NaN.
//!
//! WGSL gives the same bits for the inputs whose run has no operation on floats that WGSL leaves
//! open: every number that is computed or compared is finite, not subnormal, and *exact*, so that
//! it does not matter whether a driver reorders or fuses operations. A packet of one lane under
//! watch ([`watch`]) says which inputs these are. Kernels of integers and truth values are compared
//! for all inputs.

pub mod batch;
pub mod generator;
pub mod print;
pub mod progress;
pub mod run;
pub mod shrink;
pub mod tree;
pub mod types;
pub mod watch;
