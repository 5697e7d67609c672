//! Metals.

use glam::{Vec3, Vec3Swizzles as _, vec3};

use super::albedo::ggx_albedo;
use super::fresnel::Fresnel;
use super::microfacet::{MIN_ALPHA, reflection, sample_reflection};
use super::{Bsdf, BsdfSample, upwards};
use crate::machine::functions::vec3;
use crate::machine::generic::max;
use crate::{Type, kernel};

/// A metal, smooth or rough, with the GGX distribution.
///
/// Light that is scattered several times between microfacets is added by scaling with the
/// directional albedo, so that a white metal reflects all light: at least 0.99 of it, and at most
/// 1.0001. (Turquin, "Practical Multiple Scattering Compensation for Microfacet Models", 2019.) That
/// keeps energy and is not reciprocal.
///
/// ```
/// use raydsl::bsdf::{Bsdf, Conductor, F82};
/// use raydsl::prelude::*;
///
/// let gold = F82 { normal: vec3(1.0, 0.78, 0.34), tint: Vec3::ONE };
/// let metal = Conductor { fresnel: gold, alpha: 0.09 };
/// let kernel = kernel!(|wo: Vec3, u: Vec3| metal.sample(wo, u).weight.x);
/// assert!(kernel.call((Vec3::Z, vec3(0.2, 0.4, 0.0))) > 0.9);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct Conductor<F: Fresnel> {
    /// Reflectance of a microfacet.
    pub fresnel: F,
    /// GGX parameter, from 0, a mirror, to 1.
    pub alpha: f32,
}

#[kernel]
impl<F: Fresnel> Conductor<F> {
    /// Returns the factor for light that is scattered several times.
    #[inline]
    fn compensation(self, cos: f32) -> Vec3 {
        let fresnel: F = self.fresnel;
        let albedo = ggx_albedo(cos, self.alpha);
        vec3(1.0, 1.0, 1.0) + fresnel.at_normal() * ((1.0 - albedo) / albedo)
    }
}

#[kernel]
impl<F: Fresnel> Bsdf for Conductor<F> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let fresnel: F = self.fresnel;
        let alpha = self.alpha;
        if !(wo.z * wi.z > 0.0 && alpha >= MIN_ALPHA) {
            return vec3(0.0, 0.0, 0.0);
        }
        let (o, i) = (upwards(wo, wo), upwards(wi, wo));
        let lobe = reflection(o, i, alpha);
        let factor = fresnel.reflectance(lobe.cos) * Conductor::<F>::compensation(*self, o.z);
        factor * (lobe.weight * lobe.pdf)
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let fresnel: F = self.fresnel;
        let alpha = self.alpha;
        let o = upwards(wo, wo);
        let is_rough = alpha >= MIN_ALPHA;
        if !is_rough {
            let wi = vec3(-wo.x, -wo.y, wo.z);
            return BsdfSample::delta(wi, fresnel.reflectance(o.z), 1.0);
        }
        let lobe = sample_reflection(o, u.xy(), alpha);
        if lobe.pdf <= 0.0 {
            return BsdfSample::absorbed();
        }
        let factor = fresnel.reflectance(lobe.cos) * Conductor::<F>::compensation(*self, o.z);
        let wi = upwards(lobe.i, wo);
        BsdfSample { wi, weight: factor * lobe.weight, pdf: lobe.pdf, is_delta: false }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let alpha = self.alpha;
        let (o, i) = (upwards(wo, wo), upwards(wi, wo));
        let is_reflected = wo.z * wi.z > 0.0 && alpha >= MIN_ALPHA;
        let lobe = reflection(o, i, max(alpha, MIN_ALPHA));
        if is_reflected { lobe.pdf } else { 0.0 }
    }

    /// Returns the mean over the hemisphere of Schlick's reflectance: black metal reflects at grazing
    /// angles.
    fn albedo(&self, _wo: Vec3) -> Vec3 {
        let fresnel: F = self.fresnel;
        let normal: Vec3 = fresnel.at_normal();
        normal + (vec3(1.0, 1.0, 1.0) - normal) * (1.0 / 21.0)
    }
}
