//! Diffuse reflection.

use core::f32::consts::PI;

use glam::{Vec3, Vec3Swizzles as _, vec3};

use super::{Bsdf, BsdfSample, upwards};
use crate::machine::functions::vec3;
use crate::machine::generic::max;
use crate::sampling::{cosine_hemisphere_pdf, sample_cosine_hemisphere};
use crate::{Type, kernel};

/// Samples the cosine above the side of `wo`.
#[kernel]
#[inline]
pub(super) fn sample_cosine(wo: Vec3, u: Vec3) -> Vec3 {
    upwards(sample_cosine_hemisphere(u.xy()), wo)
}

/// Returns the density of [`sample_cosine()`].
#[kernel]
#[inline]
pub(super) fn cosine_pdf(wo: Vec3, wi: Vec3) -> f32 {
    if wo.z * wi.z > 0.0 { cosine_hemisphere_pdf(wi.z.abs()) } else { 0.0 }
}

/// Ideal diffuse reflection. (Lambert, "Photometria", 1760.)
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Lambert {
    /// Share of light that is reflected: red, green and blue, each from 0 to 1.
    pub color: Vec3,
}

#[kernel]
impl Bsdf for Lambert {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        self.color * cosine_pdf(wo, wi)
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let wi = sample_cosine(wo, u);
        let pdf = cosine_pdf(wo, wi);
        let weight = if pdf > 0.0 { self.color } else { vec3(0.0, 0.0, 0.0) };
        BsdfSample { wi, weight, pdf, is_delta: false }
    }

    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        cosine_pdf(wo, wi)
    }

    #[inline]
    fn albedo(&self, _wo: Vec3) -> Vec3 {
        self.color
    }
}

/// Rough diffuse reflection that keeps energy: the model of Oren and Nayar as Fujii wrote it, with
/// light that is scattered several times.
///
/// Portsmouth, Kutz and Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF" (JCGT 2025),
/// with the approximate albedo of their section 3. It is reciprocal, and a white one reflects all
/// light, to within 0.001.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Eon {
    /// Share of light that is reflected at roughness 0: red, green and blue, each from 0 to 1. At
    /// other roughnesses light that is scattered several times is more saturated.
    pub color: Vec3,
    /// Roughness, from 0, which is Lambert's law, to 1.
    pub roughness: f32,
}

/// `1/2 - 2/(3 pi)`: the albedo of one scattering at normal incidence is 1 over 1 plus this times
/// the roughness.
const AT_NORMAL: f32 = 0.5 - 2.0 / (3.0 * PI);

/// `2/3 - 28/(15 pi)`: the same for the mean over all directions.
const ON_AVERAGE: f32 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

/// Returns the albedo of one scattering of a white surface, off by less than 0.001.
#[kernel]
#[inline]
fn single_albedo(cos: f32, roughness: f32) -> f32 {
    let c = 1.0 - cos;
    let g = c * (0.057_108_53 + c * (0.491_881_87 + c * (-0.332_181_44 + c * 0.071_443)));
    (1.0 + roughness * g) / (1.0 + AT_NORMAL * roughness)
}

#[kernel]
impl Eon {
    /// Returns the BRDF times pi, both directions above the surface.
    #[inline]
    fn reflected(self, wo: Vec3, wi: Vec3) -> Vec3 {
        let one = vec3(1.0, 1.0, 1.0);
        let s = wo.x * wi.x + wo.y * wi.y;
        let ratio = if s > 0.0 { s / max(max(wo.z, wi.z), f32::MIN_POSITIVE) } else { s };
        let share = 1.0 / (1.0 + AT_NORMAL * self.roughness);
        let mean = share * (1.0 + ON_AVERAGE * self.roughness);
        let once = self.color * (share * (1.0 + self.roughness * ratio));
        let lost_o = max(1.0 - single_albedo(wo.z, self.roughness), 1e-7);
        let lost_i = max(1.0 - single_albedo(wi.z, self.roughness), 1e-7);
        let lost = max(1.0 - mean, 1e-7);
        let again = self.color * self.color * mean / (one - self.color * lost);
        once + again * (lost_o * lost_i / lost)
    }
}

#[kernel]
impl Bsdf for Eon {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let brdf = self.reflected(upwards(wo, wo), upwards(wi, wo));
        brdf * cosine_pdf(wo, wi)
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let wi = sample_cosine(wo, u);
        let pdf = cosine_pdf(wo, wi);
        BsdfSample::of(wi, self.reflected(upwards(wo, wo), upwards(wi, wo)) * pdf, pdf)
    }

    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        cosine_pdf(wo, wi)
    }

    #[inline]
    fn albedo(&self, _wo: Vec3) -> Vec3 {
        self.color
    }
}
