//! Warps from the unit square to disks, hemispheres and other domains.
//!
//! For each warp, `sample_*` maps a uniform point to a sample, `*_pdf` returns the density of a
//! sample, and `invert_*` the point that maps to it. Directions have their axis along z;
//! [`Frame`](super::Frame) rotates them elsewhere. Densities of directions are per solid angle.

mod bilinear;
mod cone;
mod cosine;
mod disk;

pub use bilinear::{bilinear_pdf, invert_bilinear, sample_bilinear};
pub use cone::{
    UNIFORM_HEMISPHERE_PDF, UNIFORM_SPHERE_PDF, cone_pdf, invert_cone, invert_uniform_hemisphere,
    invert_uniform_sphere, one_minus_cos, sample_cone, sample_uniform_hemisphere,
    sample_uniform_sphere,
};
pub use cosine::{
    cosine_hemisphere_pdf, invert_cosine_hemisphere, invert_power_cosine, power_cosine_pdf,
    sample_cosine_hemisphere, sample_power_cosine,
};
pub use disk::{CONCENTRIC_DISK_PDF, invert_concentric_disk, sample_concentric_disk};

use core::f32::consts::TAU;

use super::rng::ONE_MINUS_EPSILON;
use crate::kernel;
use crate::machine::generic::min;
use crate::math::elementary::atan2;

/// Returns the angle of (`x`, `y`) as a share of a turn from x to y: from 0 to below 1.
#[kernel]
#[inline]
fn turn_to(x: f32, y: f32) -> f32 {
    let turn = atan2(y, x) / TAU;
    // Angles barely below 0 would be rounded to a whole turn.
    min(if turn < 0.0 { turn + 1.0 } else { turn }, ONE_MINUS_EPSILON)
}
