//! A dielectric coat on any BSDF.

use glam::{Vec3, vec3};

use super::albedo::dielectric_albedo;
use super::fresnel::fresnel_dielectric;
use super::microfacet::{
    MIN_ALPHA, ggx_distribution, ggx_shadowing, reflected, reflecting_width,
    sample_reflecting_normal, stretched,
};
use super::mix::{chance_of_second, within};
use super::{Bsdf, BsdfSample, first_two, upwards};
use crate::machine::Type as MachineType;
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, max, normalize};
use crate::{Type, kernel};

/// A thin dielectric coat, smooth or rough, on any BSDF: `Coated<Lambert>` is plastic, and a coat on
/// [`Conductor`](super::Conductor) is lacquered metal.
///
/// The coat reflects as [`Dielectric`](super::Dielectric) does, on both sides. What it does not
/// reflect, by its directional albedo, goes to the base: a white base keeps all energy, at least 0.99
/// and at most 1.0001. (Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", 2017;
/// Turquin 2019.) That is not reciprocal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct Coated<B: Bsdf + MachineType> {
    /// What is under the coat.
    pub base: B,
    /// Index of refraction of the coat over that of its surroundings, from 1 to 3.
    pub ior: f32,
    /// GGX parameter of the coat, from 0, smooth, to 1.
    pub alpha: f32,
    /// Factor of what the coat reflects, from 0 to 1: red, green and blue.
    pub strength: Vec3,
}

#[kernel]
impl<B: Bsdf> Coated<B> {
    /// Returns the share of light from everywhere that the coat reflects to `wo`.
    #[inline]
    fn coat_albedo(self, cos: f32) -> f32 {
        let rough = dielectric_albedo(cos, max(self.alpha, MIN_ALPHA), self.ior);
        let smooth = fresnel_dielectric(cos, self.ior).reflected;
        if self.alpha >= MIN_ALPHA { rough } else { smooth }
    }

    /// Returns what the coat lets pass to the base and back.
    #[inline]
    fn passed(self, cos: f32) -> Vec3 {
        // One share for all colours, or the complement of a coloured coat would shine through.
        let strength: Vec3 = self.strength;
        let passed =
            1.0 - Coated::<B>::coat_albedo(self, cos) * clamp(strength.max_element(), 0.0, 1.0);
        vec3(passed, passed, passed)
    }

    /// Returns the probability with which the coat is sampled.
    #[inline]
    fn chance(self, wo: Vec3) -> f32 {
        let base: B = self.base;
        let albedo = Coated::<B>::coat_albedo(self, wo.z.abs());
        let strength: Vec3 = self.strength;
        chance_of_second(base.albedo(wo) * Coated::<B>::passed(self, wo.z.abs()), strength * albedo)
    }

    /// Returns what the coat reflects, of directions above it, and the density of its sample.
    #[inline]
    fn lobe(self, o: Vec3, i: Vec3) -> (f32, f32) {
        let alpha = max(self.alpha, MIN_ALPHA);
        let m = normalize(o + i);
        let facets = ggx_distribution(m, alpha);
        let reflectance = fresnel_dielectric(o.dot(m), self.ior).reflected;
        let eval = reflectance * facets * ggx_shadowing(o, i, alpha) * i.z;
        let is_lobe = self.alpha >= MIN_ALPHA && o.z > 0.0 && i.z > 0.0;
        let pdf = facets / (2.0 * reflecting_width(o, alpha));
        (if is_lobe { eval } else { 0.0 }, if is_lobe { pdf } else { 0.0 })
    }

    /// Samples the coat, chosen with the probability `chance`.
    #[inline]
    fn sample_coat(self, wo: Vec3, u: Vec3, chance: f32) -> BsdfSample {
        let base: B = self.base;
        let strength: Vec3 = self.strength;
        let o = upwards(wo, wo);
        let is_rough = self.alpha >= MIN_ALPHA;
        if !is_rough {
            let reflectance = fresnel_dielectric(o.z, self.ior).reflected;
            let wi = vec3(-wo.x, -wo.y, wo.z);
            return BsdfSample::delta(wi, strength * (reflectance / chance), chance);
        }
        let m = sample_reflecting_normal(o, first_two(u), self.alpha);
        let i = reflected(o, m);
        if !(o.z > 0.0 && i.z > 0.0) {
            return BsdfSample::absorbed();
        }
        let wi = upwards(i, wo);
        let width = reflecting_width(o, self.alpha);
        let pdf = chance * (ggx_distribution(m, self.alpha) / (2.0 * width));
        let (t_o, t_i) = (stretched(o, self.alpha), stretched(i, self.alpha));
        let reflectance = fresnel_dielectric(o.dot(m), self.ior).reflected;
        let ratio = reflectance * i.z * width / (i.z * t_o + o.z * t_i) / chance;
        let rest = base.eval(wo, wi) * Coated::<B>::passed(self, o.z);
        BsdfSample::of(wi, strength * (ratio * pdf) + rest, pdf + base.pdf(wo, wi) * (1.0 - chance))
    }
}

#[kernel]
impl<B: Bsdf> Bsdf for Coated<B> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let base: B = self.base;
        let (coat, _) = Coated::<B>::lobe(*self, upwards(wo, wo), upwards(wi, wo));
        self.strength * coat + base.eval(wo, wi) * Coated::<B>::passed(*self, wo.z.abs())
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let base: B = self.base;
        let chance = Coated::<B>::chance(*self, wo);
        if u.z < chance {
            return Coated::<B>::sample_coat(*self, wo, u, chance);
        }
        let sample = base.sample(wo, vec3(u.x, u.y, within(u.z, chance, 1.0 - chance)));
        let pdf = sample.pdf * (1.0 - chance);
        let passed = Coated::<B>::passed(*self, wo.z.abs());
        if sample.pdf <= 0.0 {
            return BsdfSample::absorbed();
        }
        if sample.is_delta {
            return BsdfSample::delta(sample.wi, sample.weight * passed / (1.0 - chance), pdf);
        }
        let (coat, coat_pdf) = Coated::<B>::lobe(*self, upwards(wo, wo), upwards(sample.wi, wo));
        let all = self.strength * coat + sample.weight * passed * sample.pdf;
        BsdfSample::of(sample.wi, all, pdf + coat_pdf * chance)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let base: B = self.base;
        let chance = Coated::<B>::chance(*self, wo);
        let (_, coat) = Coated::<B>::lobe(*self, upwards(wo, wo), upwards(wi, wo));
        base.pdf(wo, wi) * (1.0 - chance) + coat * chance
    }

    fn albedo(&self, wo: Vec3) -> Vec3 {
        let base: B = self.base;
        let coat = Coated::<B>::coat_albedo(*self, wo.z.abs());
        self.strength * coat + base.albedo(wo) * Coated::<B>::passed(*self, wo.z.abs())
    }
}
