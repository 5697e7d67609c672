//! Spherical triangles.

use glam::{Vec2, Vec3};

use crate::kernel;
use crate::machine::generic::{clamp, max, normalize};
use crate::math::elementary::{atan2, sincos_2pi};

/// Returns the solid angle of a triangle seen from a point, from 0 to 2 pi.
///
/// Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle" (1983). The volume is formed from
/// the edges themselves, so that small and distant triangles keep their digits.
#[kernel]
#[inline(always)]
pub(super) fn solid_angle(from: Vec3, v0: Vec3, v1: Vec3, v2: Vec3) -> f32 {
    let (p0, p1, p2) = (v0 - from, v1 - from, v2 - from);
    let (l0, l1, l2) = (p0.dot(p0).sqrt(), p1.dot(p1).sqrt(), p2.dot(p2).sqrt());
    let volume = p0.dot((v1 - v0).cross(v2 - v0)).abs();
    let base = l0 * l1 * l2 + p0.dot(p1) * l2 + p0.dot(p2) * l1 + p1.dot(p2) * l0;
    2.0 * atan2(volume, base)
}

/// Samples a direction to a triangle, uniformly in its solid angle.
///
/// Arvo, "Stratified Sampling of Spherical Triangles" (1995), without angles: Peters, "BRDF
/// Importance Sampling for Polygonal Lights" (2021), section 5. A part of the triangle with the
/// share `u.x` of its solid angle is cut off by a line through `v1`; `u.y` chooses a point of that.
#[kernel]
#[inline(always)]
pub(super) fn sample_spherical_triangle(u: Vec2, from: Vec3, v0: Vec3, v1: Vec3, v2: Vec3) -> Vec3 {
    let (p0, p1, p2) = (v0 - from, v1 - from, v2 - from);
    let (l0, l1, l2) = (p0.dot(p0).sqrt(), p1.dot(p1).sqrt(), p2.dot(p2).sqrt());
    let (a, b, c) = (p0 / l0, p1 / l1, p2 / l2);
    let volume = p0.dot((v1 - v0).cross(v2 - v0)).abs() / (l0 * l1 * l2);
    let (ab, ac, bc) = (a.dot(b), a.dot(c), b.dot(c));
    let angle = 2.0 * atan2(volume, (1.0 + ab) + (ac + bc));
    let half = sincos_2pi(0.5 * angle * u.x * (0.5 * core::f32::consts::FRAC_1_PI));
    let offset = a * (volume * half.cos - (ac + bc) * half.sin) + c * ((1.0 + ab) * half.sin);
    let squared = max(offset.dot(offset), f32::MIN_POSITIVE);
    let cut = offset * (2.0 * a.dot(offset) / squared) - a;
    let cos_side = b.dot(cut);
    let cos = 1.0 + (cos_side - 1.0) * u.y;
    let sine2 = (1.0 - cos_side) * (1.0 + cos_side);
    let ratio = (max((1.0 - cos) * (1.0 + cos), 0.0) / max(sine2, f32::MIN_POSITIVE)).sqrt();
    let share = if sine2 > 0.0 { ratio } else { u.y };
    normalize(b * (cos - share * clamp(cos_side, -1.0, 1.0)) + cut * share)
}
