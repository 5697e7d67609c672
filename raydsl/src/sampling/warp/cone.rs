//! Uniform directions of a cone, a hemisphere or the sphere.

use core::f32::consts::{FRAC_1_PI, TAU};

use glam::{Vec2, Vec3, vec2, vec3};

use super::turn_to;
use crate::kernel;
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::{clamp, max, min};
use crate::math::elementary::sincos_2pi;
use crate::sampling::rng::ONE_MINUS_EPSILON;

/// Density of [`sample_uniform_hemisphere()`].
pub const UNIFORM_HEMISPHERE_PDF: f32 = 0.5 * FRAC_1_PI;

/// Density of [`sample_uniform_sphere()`].
pub const UNIFORM_SPHERE_PDF: f32 = 0.25 * FRAC_1_PI;

/// Returns `1 - cos a` for an angle up to a right one with this sine: the height of a cone's cap.
///
/// `s^2 / (1 + cos a)` instead of the difference, which cancels at small angles. A ball of radius
/// `r` at the distance `d` has the sine `r / d`; a sine above 1 counts as 1.
#[kernel]
#[inline]
pub fn one_minus_cos(sine: f32) -> f32 {
    let s = min(sine, 1.0);
    s * s / (1.0 + ((1.0 - s) * (1.0 + s)).sqrt())
}

/// Samples a uniform direction of a cone around z, whose cap has this height: [`one_minus_cos()`]
/// of the angle between its axis and its side, above 0 to 2.
#[kernel]
#[inline]
pub fn sample_cone(u: Vec2, height: f32) -> Vec3 {
    let below = u.x * height;
    let r = max(below * (2.0 - below), 0.0).sqrt();
    let around = sincos_2pi(u.y);
    vec3(r * around.cos, r * around.sin, 1.0 - below)
}

/// Returns the density of directions in a cone.
#[kernel]
#[inline]
pub fn cone_pdf(height: f32) -> f32 {
    1.0 / (TAU * height)
}

/// Inverts [`sample_cone()`] for a `direction` of unit length in the cone.
#[kernel]
#[inline]
pub fn invert_cone(direction: Vec3, height: f32) -> Vec2 {
    let d = direction;
    let across = d.x * d.x + d.y * d.y;
    let below = if d.z > 0.0 { across / (1.0 + d.z) } else { 1.0 - d.z };
    vec2(clamp(below / height, 0.0, ONE_MINUS_EPSILON), turn_to(d.x, d.y))
}

/// Samples a uniform direction of the hemisphere around z.
#[kernel]
#[inline]
pub fn sample_uniform_hemisphere(u: Vec2) -> Vec3 {
    sample_cone(u, 1.0)
}

/// Inverts [`sample_uniform_hemisphere()`] for `direction`.
#[kernel]
#[inline]
pub fn invert_uniform_hemisphere(direction: Vec3) -> Vec2 {
    invert_cone(direction, 1.0)
}

/// Samples a uniform direction of the sphere.
#[kernel]
#[inline]
pub fn sample_uniform_sphere(u: Vec2) -> Vec3 {
    sample_cone(u, 2.0)
}

/// Inverts [`sample_uniform_sphere()`] for `direction`.
#[kernel]
#[inline]
pub fn invert_uniform_sphere(direction: Vec3) -> Vec2 {
    invert_cone(direction, 2.0)
}
