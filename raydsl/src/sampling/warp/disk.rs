//! Unit disk sampling.

use core::f32::consts::FRAC_1_PI;

use glam::{Vec2, vec2};

use crate::kernel;
use crate::machine::functions::vec2;
use crate::machine::generic::{clamp, max};
use crate::math::elementary::{atan, sincos_2pi};
use crate::sampling::rng::ONE_MINUS_EPSILON;

/// 4 / pi: eighths of a turn per radian.
const EIGHTHS: f32 = 4.0 * FRAC_1_PI;

/// Density of [`sample_concentric_disk()`], per area.
pub const CONCENTRIC_DISK_PDF: f32 = FRAC_1_PI;

/// Samples a uniform point of the unit disk: squares around the middle become circles, so that
/// neighbours stay close. (.5, .5) maps to (0, 0).
///
/// Shirley and Chiu, "A Low Distortion Map Between Disk and Square" (1997). The distance from the
/// middle is at most 1, to within rounding.
#[kernel]
#[inline]
pub fn sample_concentric_disk(u: Vec2) -> Vec2 {
    let x = 2.0 * u.x - 1.0;
    let y = 2.0 * u.y - 1.0;
    let is_wide = x.abs() > y.abs();
    let radius = if is_wide { x } else { y };
    let other = if is_wide { y } else { x };
    let share = if radius == 0.0 { 0.0 } else { other / radius };
    let around = sincos_2pi(0.125 * share);
    let along = radius * around.cos;
    let aside = radius * around.sin;
    if is_wide { vec2(along, aside) } else { vec2(aside, along) }
}

/// Returns the exact distance from the middle of the point that [`sample_concentric_disk()`]
/// returns.
#[kernel]
#[inline]
pub(super) fn concentric_radius(u: Vec2) -> f32 {
    max((2.0 * u.x - 1.0).abs(), (2.0 * u.y - 1.0).abs())
}

/// Inverts [`sample_concentric_disk()`]: returns the point of the unit square that maps to `p`.
#[kernel]
#[inline]
pub fn invert_concentric_disk(p: Vec2) -> Vec2 {
    let is_wide = p.x.abs() > p.y.abs();
    let along = if is_wide { p.x } else { p.y };
    let aside = if is_wide { p.y } else { p.x };
    let length = p.length();
    let radius = if along < 0.0 { -length } else { length };
    let ratio = if along == 0.0 { 0.0 } else { aside / along };
    let other = radius * (atan(ratio) * EIGHTHS);
    let square = if is_wide { vec2(radius, other) } else { vec2(other, radius) };
    clamp(square * 0.5 + vec2(0.5, 0.5), vec2(0.0, 0.0), vec2(ONE_MINUS_EPSILON, ONE_MINUS_EPSILON))
}
