//! Pictures by many machines, over MPI.
//!
//! Two divisions of the work:
//!
//! * [`films`]: every rank has the whole scene. Films are divided into windows and ranges of samples,
//!   which any rank renders; their sum has the same bits for every division.
//! * [`frames`]: the scene is too large for one memory. Each rank has a part of space, and what a
//!   ray meets there; the parts of a ray are composited in visibility order.
//!
//! [`launch`] starts the ranks of a run on one machine, [`run`] is one of them. [`scaling`] computes
//! from reports of measured runs how long more nodes would take.

pub mod args;
mod disk;
mod divide;
pub mod films;
pub mod frames;
pub mod launch;
mod progress;
pub mod report;
pub mod run;
pub mod scaling;
pub mod scenes;
#[cfg(test)]
mod tests;
mod wire;

pub use run::Failure;
