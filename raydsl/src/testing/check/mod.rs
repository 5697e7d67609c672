//! Checks of materials and lights: whether what an author wrote holds together.
//!
//! | check | of | what it tests |
//! |---|---|---|
//! | [`bsdf()`] | a [`Bsdf`](crate::bsdf::Bsdf) | samples, densities and values agree; energy; reciprocity; numbers at extreme directions; every variant |
//! | [`light()`] | a [`Light`](crate::light::Light) | samples, densities and radiance agree; extreme places; every variant |
//! | [`environment()`] | an [`Environment`](crate::light::Environment) | the same |
//! | [`estimators()`] | both together | light samples, samples of the BSDF and both, weighted, have one mean |
//!
//! ```
//! use raydsl::bsdf::Lambert;
//! use raydsl::prelude::*;
//! use raydsl::testing::check;
//!
//! check::bsdf(Lambert { color: vec3(0.2, 0.5, 0.9) })?;
//! # Ok::<(), check::BsdfFailure>(())
//! ```
//!
//! The method is that of the tests of pbrt and Mitsuba: a histogram of samples against the integral
//! of their density over each of its bins, by Pearson's test. (Pharr, Jakob and Humphreys,
//! "Physically Based Rendering", 4th edition, 9.1; Subr and Arvo, "Statistical Hypothesis Testing for
//! Assessing Monte Carlo Estimators", 2007.)

mod bsdf;
mod estimators;
mod findings;
mod histogram;
mod light;
mod sphere;
mod statistics;
mod variants;

pub use bsdf::{BsdfFailure, BsdfReport, BsdfRow, BsdfTest, bsdf};
pub use estimators::{EstimatorsFailure, EstimatorsReport, EstimatorsTest, estimators};
pub use light::{LightFailure, LightTest, environment, light};
