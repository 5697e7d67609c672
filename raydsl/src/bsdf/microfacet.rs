//! The GGX distribution of microfacet normals.
//!
//! Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough Surfaces"
//! (EGSR 2007); Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs"
//! (JCGT 2014).

use core::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3, vec3};

use crate::kernel;
use crate::machine::functions::vec3;
use crate::machine::generic::{max, normalize};
use crate::math::elementary::sincos_2pi;

/// Parameter below which a surface is smooth: its lobe is a delta.
pub const MIN_ALPHA: f32 = 1e-4;

/// Returns the density of microfacet normals: `normal`, of unit length, is relative to the surface.
///
/// The squared sine is that of the components along the surface, so that nothing cancels around the
/// normal: off by less than 2e-6 of itself for `alpha` from 1e-4.
#[kernel]
#[inline]
pub fn ggx_distribution(normal: Vec3, alpha: f32) -> f32 {
    let (x, y) = (normal.x / alpha, normal.y / alpha);
    let e = x * x + y * y + normal.z * normal.z;
    FRAC_1_PI / (alpha * alpha * e * e)
}

/// Returns `|w.z|` of the ellipsoid: its length seen from `w`, `sqrt(alpha² sin² + cos²)`.
#[kernel]
#[inline]
pub(super) fn stretched(w: Vec3, alpha: f32) -> f32 {
    (alpha * alpha * (w.x * w.x + w.y * w.y) + w.z * w.z).sqrt()
}

/// Returns Smith's masking function: the share of the microfacets facing `w` that are seen from
/// there.
#[kernel]
#[inline]
pub fn ggx_masking(w: Vec3, alpha: f32) -> f32 {
    2.0 * w.z.abs() / (w.z.abs() + stretched(w, alpha))
}

/// Returns Smith's height-correlated masking and shadowing over `4 |wo.z| |wi.z|`. (Heitz 2014,
/// equation 99.)
#[kernel]
#[inline]
pub fn ggx_shadowing(wo: Vec3, wi: Vec3, alpha: f32) -> f32 {
    0.5 / (wi.z.abs() * stretched(wo, alpha) + wo.z.abs() * stretched(wi, alpha))
}

/// Samples the microfacet normals that are seen from `wo`, above the surface: their density is
/// `ggx_masking(wo) * ggx_distribution(normal) * dot(wo, normal) / wo.z`.
///
/// Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps" (HPG 2023).
#[kernel]
#[inline]
pub fn sample_ggx_normal(wo: Vec3, u: Vec2, alpha: f32) -> Vec3 {
    let stretched = normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
    on_cap(stretched, u, stretched.z, alpha)
}

/// As [`sample_ggx_normal()`], without some normals that reflect `wo` below the surface.
///
/// Eto and Tokuyoshi, "Bounded VNDF Sampling for Smith-GGX Reflections" (SIGGRAPH Asia 2023).
#[kernel]
#[inline]
pub(super) fn sample_reflecting_normal(wo: Vec3, u: Vec2, alpha: f32) -> Vec3 {
    let stretched = normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
    on_cap(stretched, u, bound(wo, alpha) * stretched.z, alpha)
}

/// Returns the factor by which the cap of reflecting normals is lower. (Eto and Tokuyoshi, equation
/// 5.)
#[kernel]
#[inline]
fn bound(wo: Vec3, alpha: f32) -> f32 {
    let s = 1.0 + (wo.x * wo.x + wo.y * wo.y).sqrt();
    let (a2, s2) = (alpha * alpha, s * s);
    (1.0 - a2) * s2 / (s2 + a2 * wo.z * wo.z)
}

/// Returns half of the inverse of the density of [`sample_reflecting_normal()`], as one of the
/// reflected direction, over the distribution.
#[kernel]
#[inline]
pub(super) fn reflecting_width(wo: Vec3, alpha: f32) -> f32 {
    bound(wo, alpha) * wo.z + stretched(wo, alpha)
}

/// Returns the normal half way between `stretched` and a point of the sphere's cap above `-low`.
#[kernel]
#[inline]
fn on_cap(stretched: Vec3, u: Vec2, low: f32, alpha: f32) -> Vec3 {
    let z = (1.0 - u.y) * (1.0 + low) - low;
    let r = max((1.0 - z) * (1.0 + z), 0.0).sqrt();
    let around = sincos_2pi(u.x);
    let half = vec3(r * around.cos, r * around.sin, z) + stretched;
    normalize(vec3(alpha * half.x, alpha * half.y, max(half.z, 1e-20)))
}

/// Returns the direction that `w` is reflected to by a microfacet.
#[kernel]
#[inline]
pub(super) fn reflected(w: Vec3, normal: Vec3) -> Vec3 {
    normal * (2.0 * w.dot(normal)) - w
}
