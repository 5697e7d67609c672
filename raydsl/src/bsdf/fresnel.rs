//! Fresnel's equations: which share of light an interface reflects.

use glam::{Vec3, vec3};

use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, max, min};
use crate::{Type, kernel};

/// The reflectance of a metal.
#[kernel]
pub trait Fresnel {
    /// Returns the reflectance, red, green and blue, where the cosine of the angle to the normal is
    /// `cos`, from 0 to 1.
    fn reflectance(&self, cos: f32) -> Vec3;

    /// Returns it at normal incidence.
    fn at_normal(&self) -> Vec3;
}

/// Schlick's approximation with a tint at 82 degrees, where metals differ most from it.
///
/// Hoffman, "Fresnel Equations Considered Harmful" (EG MAM 2019); Kutz, Hasan and Edmondson, "Novel
/// Aspects of the Adobe Standard Material" (2021).
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct F82 {
    /// Reflectance at normal incidence, from 0 to 1.
    pub normal: Vec3,
    /// Factor of Schlick's reflectance at about 82 degrees, from 0 to 1; with 1 it is Schlick's.
    pub tint: Vec3,
}

/// A metal by its complex index of refraction `n + i k`, relative to what is outside, for red,
/// green and blue.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct ComplexIor {
    /// Real part, above 0.
    pub n: Vec3,
    /// Imaginary part, not negative.
    pub k: Vec3,
}

#[kernel]
#[inline]
fn fifth(x: f32) -> f32 {
    let x2 = x * x;
    x2 * x2 * x
}

#[kernel]
impl Fresnel for F82 {
    #[inline]
    fn reflectance(&self, cos: f32) -> Vec3 {
        let one = vec3(1.0, 1.0, 1.0);
        let c = clamp(cos, 0.0, 1.0);
        // The cosine of 82 degrees is about 1/7, where cos * (1 - cos)^6 is greatest.
        let schlick_82 = self.normal + (one - self.normal) * 0.462_664_4;
        let lowered = schlick_82 * (one - self.tint) * (7.0 / 0.396_569_5);
        let dark = fifth(1.0 - c);
        let schlick = self.normal + (one - self.normal) * dark;
        max(schlick - lowered * (c * dark * (1.0 - c)), vec3(0.0, 0.0, 0.0))
    }

    #[inline]
    fn at_normal(&self) -> Vec3 {
        self.normal
    }
}

/// Returns the reflectance of a metal. (Born and Wolf, "Principles of Optics", section 14.2.)
#[kernel]
#[inline]
fn complex_reflectance(c: f32, n: f32, k: f32) -> f32 {
    let (c2, s2) = (c * c, (1.0 - c) * (1.0 + c));
    let t = (n - k) * (n + k) - s2;
    let a2_b2 = (t * t + 4.0 * (n * n * (k * k))).sqrt();
    let a = max(0.5 * (a2_b2 + t), 0.0).sqrt();
    let rs = (a2_b2 + c2 - 2.0 * a * c) / (a2_b2 + c2 + 2.0 * a * c);
    let p = c2 * a2_b2 + s2 * s2;
    let q = 2.0 * a * c * s2;
    let rp = rs * (p - q) / (p + q);
    0.5 * (rs + rp)
}

#[kernel]
impl Fresnel for ComplexIor {
    #[inline]
    fn reflectance(&self, cos: f32) -> Vec3 {
        let c = clamp(cos, 0.0, 1.0);
        vec3(
            complex_reflectance(c, self.n.x, self.k.x),
            complex_reflectance(c, self.n.y, self.k.y),
            complex_reflectance(c, self.n.z, self.k.z),
        )
    }

    #[inline]
    fn at_normal(&self) -> Vec3 {
        self.reflectance(1.0)
    }
}

/// What an interface between two dielectrics reflects and transmits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct FresnelSplit {
    /// Share that is reflected.
    pub reflected: f32,
    /// Share that is transmitted: formed directly, so that it is accurate near grazing angles too.
    pub transmitted: f32,
    /// Cosine of the refracted direction to the normal; 0 where all is reflected.
    pub cos: f32,
}

/// Returns the shares of unpolarised light that an interface reflects and transmits; `cos`, from 0
/// to 1, is the cosine of the direction to the normal, and `eta` the index of refraction beyond over
/// that on this side.
///
/// Both shares are within 1e-4 of themselves to 89.999 degrees, but for what is transmitted next to the
/// critical angle, where the cosine's own rounding counts.
#[kernel]
#[inline]
pub fn fresnel_dielectric(cos: f32, eta: f32) -> FresnelSplit {
    let c = clamp(cos, 0.0, 1.0);
    // The square of the cosine beyond, without a difference of numbers next to 1.
    let cos2 = (c * c + (eta - 1.0) * (eta + 1.0)) / (eta * eta);
    // Without an index beyond, or beyond the critical angle, all is reflected.
    let t = if cos2 > 0.0 { cos2.sqrt() } else { 0.0 };
    fresnel_between(c, t, eta)
}

/// Returns the same for known cosines of both directions, of which that beyond is 0 where all is
/// reflected.
#[kernel]
#[inline]
pub(super) fn fresnel_between(c: f32, t: f32, eta: f32) -> FresnelSplit {
    let (across, along) = (c + eta * t, eta * c + t);
    let s = (c - eta * t) / across;
    let p = (eta * c - t) / along;
    let through = 2.0 * eta * c * t * (1.0 / (across * across) + 1.0 / (along * along));
    let is_dark = !(c > 0.0 && t > 0.0);
    FresnelSplit {
        reflected: if is_dark { 1.0 } else { min(0.5 * (s * s + p * p), 1.0) },
        transmitted: if is_dark { 0.0 } else { through },
        cos: t,
    }
}
