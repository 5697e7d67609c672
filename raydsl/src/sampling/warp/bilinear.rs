//! Bilinear densities.

use glam::{Vec2, Vec4, vec2};

use crate::kernel;
use crate::machine::functions::vec2;
use crate::machine::generic::{max, min};
use crate::sampling::rng::ONE_MINUS_EPSILON;

/// Samples a number from 0 to below 1 with a linear density from `a` at 0 to `b` at 1.
///
/// Without a difference of two large numbers, as in "Physically Based Rendering", 4th edition,
/// 2.3.2. Two zeros count as ones. Weights are normalized, so that squares neither overflow nor
/// vanish.
#[kernel]
#[inline]
fn sample_linear(u: f32, a: f32, b: f32) -> f32 {
    let most = max(a, b);
    let a = if most > 0.0 { a / most } else { 1.0 };
    let b = if most > 0.0 { b / most } else { 1.0 };
    let root = (a * a + u * (b * b - a * a)).sqrt();
    // At the dark end of a density that rises from 0 both are 0.
    min(u * (a + b) / max(a + root, f32::MIN_POSITIVE), ONE_MINUS_EPSILON)
}

/// Returns the number whose [`sample_linear`] is `x`.
#[kernel]
#[inline]
fn invert_linear(x: f32, a: f32, b: f32) -> f32 {
    if a + b > 0.0 { min(x * (a * (2.0 - x) + b * x) / (a + b), ONE_MINUS_EPSILON) } else { x }
}

/// Interpolates linearly: `a` at 0, `b` at 1.
#[kernel]
#[inline]
fn between(t: f32, a: f32, b: f32) -> f32 {
    (1.0 - t) * a + t * b
}

/// Samples a point of the unit square with a bilinear density between weights at the corners: those
/// at (0, 0), (1, 0), (0, 1) and (1, 1), none negative. All zeros count as ones.
///
/// For quads that light a point unevenly: the weights are cosines, or radiances.
#[kernel]
#[inline]
pub fn sample_bilinear(u: Vec2, weights: Vec4) -> Vec2 {
    let y = sample_linear(u.y, weights.x + weights.y, weights.z + weights.w);
    let left = between(y, weights.x, weights.z);
    let right = between(y, weights.y, weights.w);
    vec2(sample_linear(u.x, left, right), y)
}

/// Returns the density of [`sample_bilinear()`], per area of the square.
#[kernel]
#[inline]
pub fn bilinear_pdf(p: Vec2, weights: Vec4) -> f32 {
    let sum = weights.x + weights.y + weights.z + weights.w;
    let left = between(p.y, weights.x, weights.z);
    let right = between(p.y, weights.y, weights.w);
    if sum > 0.0 { 4.0 * between(p.x, left, right) / sum } else { 1.0 }
}

/// Inverts [`sample_bilinear()`]: returns the point whose sample is `p`.
#[kernel]
#[inline]
pub fn invert_bilinear(p: Vec2, weights: Vec4) -> Vec2 {
    let left = between(p.y, weights.x, weights.z);
    let right = between(p.y, weights.y, weights.w);
    let y = invert_linear(p.y, weights.x + weights.y, weights.z + weights.w);
    vec2(invert_linear(p.x, left, right), y)
}
