//! Cosine-weighted directions.

use core::f32::consts::{FRAC_1_PI, TAU};

use glam::{Vec2, Vec3, vec2, vec3};

use super::disk::concentric_radius;
use super::{invert_concentric_disk, sample_concentric_disk, turn_to};
use crate::kernel;
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::{clamp, max};
use crate::math::elementary::{exp, expm1, log, log1p, pow, sincos_2pi};
use crate::sampling::rng::ONE_MINUS_EPSILON;

/// Samples a direction of the hemisphere around z with a density proportional to its cosine: a
/// point of the disk, projected to the sphere.
///
/// (Malley's method; Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th edition, A.5.3.)
/// The height is computed from the exact radius, so that it is accurate next to the horizon too. It
/// is above 0 except where `u.x` or `u.y` is 0.
#[kernel]
#[inline]
pub fn sample_cosine_hemisphere(u: Vec2) -> Vec3 {
    let p = sample_concentric_disk(u);
    let radius = concentric_radius(u);
    let z = ((1.0 - radius) * (1.0 + radius)).sqrt();
    vec3(p.x, p.y, z)
}

/// Returns the density of [`sample_cosine_hemisphere()`]; 0 below the horizon.
#[kernel]
#[inline]
pub fn cosine_hemisphere_pdf(cos: f32) -> f32 {
    max(cos, 0.0) * FRAC_1_PI
}

/// Inverts [`sample_cosine_hemisphere()`] for `direction`.
#[kernel]
#[inline]
pub fn invert_cosine_hemisphere(direction: Vec3) -> Vec2 {
    invert_concentric_disk(vec2(direction.x, direction.y))
}

/// Samples a direction of the hemisphere around z with a density proportional to a power of its
/// cosine: `exponent` is at least 0.
///
/// (The lobe of Phong and Blinn.) Powers are computed from the logarithm of the height, so that the
/// distance from the axis is accurate for exponents of millions.
#[kernel]
#[inline]
pub fn sample_power_cosine(u: Vec2, exponent: f32) -> Vec3 {
    let log_cos = log1p(-u.x) / (exponent + 1.0);
    let r = max(-expm1(2.0 * log_cos), 0.0).sqrt();
    let around = sincos_2pi(u.y);
    vec3(r * around.cos, r * around.sin, exp(log_cos))
}

/// Returns the density of [`sample_power_cosine()`]; 0 below the horizon.
#[kernel]
#[inline]
pub fn power_cosine_pdf(cos: f32, exponent: f32) -> f32 {
    if cos < 0.0 { 0.0 } else { (exponent + 1.0) * pow(cos, exponent) / TAU }
}

/// Inverts [`sample_power_cosine()`] for `direction`.
#[kernel]
#[inline]
pub fn invert_power_cosine(direction: Vec3, exponent: f32) -> Vec2 {
    let d = direction;
    // Near the axis the sine determines the cosine more precisely than the cosine itself.
    let log_cos = if d.z > 0.5 { 0.5 * log1p(-(d.x * d.x + d.y * d.y)) } else { log(d.z) };
    let x = -expm1((exponent + 1.0) * log_cos);
    vec2(clamp(x, 0.0, ONE_MINUS_EPSILON), turn_to(d.x, d.y))
}
