//! Cloth.

use core::f32::consts::FRAC_1_PI;

use glam::{Vec3, vec3};

use super::albedo::sheen_albedo;
use super::diffuse::{cosine_pdf, sample_cosine};
use super::mix::{chance_of_second, of_part, sample_both};
use super::{Bsdf, BsdfSample, upwards};
use crate::machine::Type as MachineType;
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, max, min, normalize};
use crate::math::elementary::{exp, log, pow};
use crate::{Type, kernel};

/// The sheen of cloth: fibres that stand up, by the Charlie distribution.
///
/// Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF" (2017), without their softer
/// terminator. It is sampled by the cosine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Sheen {
    /// Factor of what is reflected, from 0 to 1: red, green and blue.
    pub color: Vec3,
    /// Parameter of the distribution, from 0.07 to 1: the square of the roughness of glTF.
    pub alpha: f32,
}

/// Least parameter.
const MIN_SHEEN_ALPHA: f32 = 0.07;

/// Returns the logarithm of the shadowing of a direction with this cosine, up to 0.5. (Estevez and
/// Kulla, section 3.)
#[kernel]
#[inline]
fn shadowing_power(cos: f32, alpha: f32) -> f32 {
    let t = (1.0 - alpha) * (1.0 - alpha);
    let a = 21.5473 + t * (25.3245 - 21.5473);
    let b = 3.82987 + t * (3.32435 - 3.82987);
    let c = 0.19823 + t * (0.16801 - 0.19823);
    let d = -1.97760 + t * (-1.27393 + 1.97760);
    let e = -4.32054 + t * (-4.85967 + 4.32054);
    a / (1.0 + b * pow(cos, c)) + d * cos + e
}

#[kernel]
#[inline]
fn shadowing(cos: f32, alpha: f32) -> f32 {
    let near = min(cos, 1.0 - cos);
    let power = shadowing_power(max(near, 0.0), alpha);
    exp(if cos < 0.5 { power } else { 2.0 * shadowing_power(0.5, alpha) - power })
}

#[kernel]
impl Sheen {
    /// Returns what is reflected of directions above the surface, without the colour.
    #[inline]
    fn lobe(self, o: Vec3, i: Vec3) -> f32 {
        let alpha = clamp(self.alpha, MIN_SHEEN_ALPHA, 1.0);
        let m = normalize(o + i);
        let sine2 = m.x * m.x + m.y * m.y;
        let power = 1.0 / alpha;
        let sines = exp(0.5 * power * log(max(sine2, f32::MIN_POSITIVE)));
        let fibres = (2.0 + power) * sines * (0.5 * FRAC_1_PI);
        let seen = 1.0 / (1.0 + shadowing(o.z, alpha) + shadowing(i.z, alpha));
        let share = fibres * seen / (4.0 * o.z);
        if o.z > 0.0 && i.z > 0.0 { share } else { 0.0 }
    }
}

#[kernel]
impl Bsdf for Sheen {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        self.color * Sheen::lobe(*self, upwards(wo, wo), upwards(wi, wo))
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let wi = sample_cosine(wo, u);
        let lobe = Sheen::lobe(*self, upwards(wo, wo), upwards(wi, wo));
        BsdfSample::of(wi, self.color * lobe, cosine_pdf(wo, wi))
    }

    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        cosine_pdf(wo, wi)
    }

    fn albedo(&self, wo: Vec3) -> Vec3 {
        self.color * sheen_albedo(wo.z.abs(), clamp(self.alpha, MIN_SHEEN_ALPHA, 1.0))
    }
}

/// Sheen on any BSDF, which gets the light that the sheen does not reflect, by its directional
/// albedo: cloth is `SheenCoated<Lambert>`. That is not reciprocal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct SheenCoated<B: Bsdf + MachineType> {
    /// What is under the fibres.
    pub base: B,
    /// The fibres.
    pub sheen: Sheen,
}

#[kernel]
impl<B: Bsdf> SheenCoated<B> {
    /// Returns the share of light that passes to the base and back.
    #[inline]
    fn passed(self, wo: Vec3) -> f32 {
        let sheen: Sheen = self.sheen;
        max(1.0 - Sheen::albedo(&sheen, wo).max_element(), 0.0)
    }

    /// Returns the probability with which the sheen is sampled.
    #[inline]
    fn chance(self, wo: Vec3) -> f32 {
        let base: B = self.base;
        let sheen: Sheen = self.sheen;
        chance_of_second(
            base.albedo(wo) * SheenCoated::<B>::passed(self, wo),
            Sheen::albedo(&sheen, wo),
        )
    }
}

#[kernel]
impl<B: Bsdf> Bsdf for SheenCoated<B> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let base: B = self.base;
        let sheen: Sheen = self.sheen;
        Sheen::eval(&sheen, wo, wi) + base.eval(wo, wi) * SheenCoated::<B>::passed(*self, wo)
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let base: B = self.base;
        let sheen: Sheen = self.sheen;
        let chance = SheenCoated::<B>::chance(*self, wo);
        let passed = SheenCoated::<B>::passed(*self, wo);
        let one = vec3(1.0, 1.0, 1.0);
        if u.z < chance {
            return sample_both(Sheen::sample(&sheen, wo, u), one, chance, |wi: Vec3| {
                (base.eval(wo, wi) * passed, base.pdf(wo, wi))
            });
        }
        let sample = base.sample(wo, vec3(u.x, u.y, of_part(u.z, chance, 1.0 - chance)));
        sample_both(sample, one * passed, 1.0 - chance, |wi: Vec3| {
            (Sheen::eval(&sheen, wo, wi), cosine_pdf(wo, wi))
        })
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let base: B = self.base;
        let chance = SheenCoated::<B>::chance(*self, wo);
        base.pdf(wo, wi) * (1.0 - chance) + cosine_pdf(wo, wi) * chance
    }

    fn albedo(&self, wo: Vec3) -> Vec3 {
        let base: B = self.base;
        let sheen: Sheen = self.sheen;
        Sheen::albedo(&sheen, wo) + base.albedo(wo) * SheenCoated::<B>::passed(*self, wo)
    }
}
