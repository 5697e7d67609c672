//! The GGX distribution of microfacet normals.
//!
//! Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough Surfaces"
//! (EGSR 2007); Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs"
//! (JCGT 2014).

use core::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3, vec3};

use crate::machine::functions::vec3;
use crate::machine::generic::{max, normalize};
use crate::math::elementary::sincos_2pi;
use crate::{Type, kernel};

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

/// A reflection by microfacets that reflect all light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub(super) struct Reflection {
    /// The direction that light is reflected to, above the surface.
    pub(super) i: Vec3,
    /// Cosine of the two directions to the normal of the microfacet.
    pub(super) cos: f32,
    /// The value, with the cosine of `i`, over the density.
    pub(super) weight: f32,
    /// Density of `i`; 0 where one of the directions is not above the surface.
    pub(super) pdf: f32,
}

/// Returns the reflection from `o` to `i`, both above the surface.
#[kernel]
#[inline]
pub(super) fn reflection(o: Vec3, i: Vec3, alpha: f32) -> Reflection {
    reflection_by(normalize(o + i), o, i, alpha)
}

/// Samples a reflection from `o`, above the surface, without some of the microfacets that reflect it
/// below.
///
/// Eto and Tokuyoshi, "Bounded VNDF Sampling for Smith-GGX Reflections" (SIGGRAPH Asia 2023).
#[kernel]
#[inline]
pub(super) fn sample_reflection(o: Vec3, u: Vec2, alpha: f32) -> Reflection {
    let stretched = normalize(vec3(alpha * o.x, alpha * o.y, o.z));
    let m = on_cap(stretched, u, bound(o, alpha) * stretched.z, alpha);
    reflection_by(m, o, reflected(o, m), alpha)
}

#[kernel]
#[inline]
fn reflection_by(m: Vec3, o: Vec3, i: Vec3, alpha: f32) -> Reflection {
    let (t_o, t_i) = (stretched(o, alpha), stretched(i, alpha));
    let width = bound(o, alpha) * o.z + t_o;
    let weight = i.z * width / (i.z * t_o + o.z * t_i);
    let pdf = ggx_distribution(m, alpha) / (2.0 * width);
    let is_above = o.z > 0.0 && i.z > 0.0;
    Reflection {
        i,
        cos: o.dot(m),
        weight: if is_above { weight } else { 0.0 },
        pdf: if is_above { pdf } else { 0.0 },
    }
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
