//! A dielectric coat on any BSDF.

use glam::{Vec3, Vec3Swizzles as _, vec3};

use super::albedo::dielectric_albedo;
use super::fresnel::fresnel_dielectric;
use super::microfacet::{MIN_ALPHA, reflection, sample_reflection};
use super::mix::{chance_of_second, of_part, sample_both};
use super::{Bsdf, BsdfSample, upwards};
use crate::machine::Type as MachineType;
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, max};
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

    /// Returns what a coat of this albedo lets pass to the base and back.
    #[inline]
    fn passed(self, coat: f32) -> Vec3 {
        // One share for all colours, or the complement of a coloured coat would shine through.
        let strength: Vec3 = self.strength;
        let passed = 1.0 - coat * clamp(strength.max_element(), 0.0, 1.0);
        vec3(passed, passed, passed)
    }

    /// Returns the probability with which a coat of this albedo is sampled.
    #[inline]
    fn chance(self, wo: Vec3, coat: f32) -> f32 {
        let base: B = self.base;
        let strength: Vec3 = self.strength;
        chance_of_second(base.albedo(wo) * Coated::<B>::passed(self, coat), strength * coat)
    }

    /// Returns what the coat reflects, and the density of its sample.
    #[inline]
    fn coat(self, wo: Vec3, wi: Vec3) -> (Vec3, f32) {
        let strength: Vec3 = self.strength;
        let lobe = reflection(upwards(wo, wo), upwards(wi, wo), max(self.alpha, MIN_ALPHA));
        let reflectance = fresnel_dielectric(lobe.cos, self.ior).reflected;
        let is_rough = self.alpha >= MIN_ALPHA;
        let eval = if is_rough { reflectance * (lobe.weight * lobe.pdf) } else { 0.0 };
        (strength * eval, if is_rough { lobe.pdf } else { 0.0 })
    }

    /// Samples the coat alone.
    #[inline]
    fn sample_coat(self, wo: Vec3, u: Vec3) -> BsdfSample {
        let strength: Vec3 = self.strength;
        let o = upwards(wo, wo);
        let is_rough = self.alpha >= MIN_ALPHA;
        if !is_rough {
            let reflectance = fresnel_dielectric(o.z, self.ior).reflected;
            return BsdfSample::delta(vec3(-wo.x, -wo.y, wo.z), strength * reflectance, 1.0);
        }
        let lobe = sample_reflection(o, u.xy(), self.alpha);
        if lobe.pdf <= 0.0 {
            return BsdfSample::absorbed();
        }
        let reflectance = fresnel_dielectric(lobe.cos, self.ior).reflected;
        let weight = strength * (reflectance * lobe.weight);
        BsdfSample { wi: upwards(lobe.i, wo), weight, pdf: lobe.pdf, is_delta: false }
    }
}

#[kernel]
impl<B: Bsdf> Bsdf for Coated<B> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let base: B = self.base;
        let (coat, _) = Coated::<B>::coat(*self, wo, wi);
        let albedo = Coated::<B>::coat_albedo(*self, wo.z.abs());
        coat + base.eval(wo, wi) * Coated::<B>::passed(*self, albedo)
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let base: B = self.base;
        let albedo = Coated::<B>::coat_albedo(*self, wo.z.abs());
        let chance = Coated::<B>::chance(*self, wo, albedo);
        let passed = Coated::<B>::passed(*self, albedo);
        if u.z < chance {
            let sample = Coated::<B>::sample_coat(*self, wo, u);
            return sample_both(sample, vec3(1.0, 1.0, 1.0), chance, |wi: Vec3| {
                (base.eval(wo, wi) * passed, base.pdf(wo, wi))
            });
        }
        let sample = base.sample(wo, vec3(u.x, u.y, of_part(u.z, chance, 1.0 - chance)));
        sample_both(sample, passed, 1.0 - chance, |wi: Vec3| Coated::<B>::coat(*self, wo, wi))
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let base: B = self.base;
        let albedo = Coated::<B>::coat_albedo(*self, wo.z.abs());
        let chance = Coated::<B>::chance(*self, wo, albedo);
        let (_, coat) = Coated::<B>::coat(*self, wo, wi);
        base.pdf(wo, wi) * (1.0 - chance) + coat * chance
    }

    fn albedo(&self, wo: Vec3) -> Vec3 {
        let base: B = self.base;
        let coat = Coated::<B>::coat_albedo(*self, wo.z.abs());
        self.strength * coat + base.albedo(wo) * Coated::<B>::passed(*self, coat)
    }
}
