//! A mixture of two BSDFs.

use glam::{Vec3, vec3};

use super::{Bsdf, BsdfSample, mean};
use crate::machine::Type as MachineType;
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, max};
use crate::sampling::ONE_MINUS_EPSILON;
use crate::{Type, kernel};

/// Two BSDFs beside each other on a surface, finer than the eye can tell: a share of `over`, the
/// rest `under`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct Mix<A: Bsdf + MachineType, B: Bsdf + MachineType> {
    /// What fills the rest of the surface.
    pub under: A,
    /// What fills `share` of it.
    pub over: B,
    /// The share of `over`, from 0 to 1.
    pub share: f32,
}

/// Returns the probability of the second of two lobes with these albedos: at least 0.1 for each
/// that is there at all, so that a wrong albedo costs little.
#[kernel]
#[inline]
pub(super) fn chance_of_second(first: Vec3, second: Vec3) -> f32 {
    let (a, b) = (mean(first), mean(second));
    let chance = clamp(b / max(a + b, f32::MIN_POSITIVE), 0.1, 0.9);
    let chance = if a > 0.0 { chance } else { 1.0 };
    if b > 0.0 { chance } else { 0.0 }
}

/// Returns the number for a lobe that was chosen by a part of the unit interval, from `first` on
/// and `width` wide: from 0 to below 1 again.
#[kernel]
#[inline]
pub(super) fn of_part(u: f32, first: f32, width: f32) -> f32 {
    clamp((u - first) / width, 0.0, ONE_MINUS_EPSILON)
}

/// Returns the sample of two lobes together, by one of a lobe that was chosen with the probability
/// `chance` and whose value has this factor. `other` returns the other lobe's value and density.
#[kernel]
#[inline]
pub(super) fn sample_both(
    sample: BsdfSample,
    factor: Vec3,
    chance: f32,
    other: impl Fn(Vec3) -> (Vec3, f32),
) -> BsdfSample {
    if sample.pdf <= 0.0 {
        return BsdfSample::absorbed();
    }
    let pdf = sample.pdf * chance;
    let weight = sample.weight * factor;
    if sample.is_delta {
        return BsdfSample::delta(sample.wi, weight / chance, pdf);
    }
    let (value, density) = other(sample.wi);
    let all = weight * sample.pdf + value;
    BsdfSample::of(sample.wi, all, pdf + density * (1.0 - chance))
}

#[kernel]
impl<A: Bsdf, B: Bsdf> Mix<A, B> {
    /// Returns the probability with which `over` is sampled.
    #[inline]
    fn chance(self, wo: Vec3) -> f32 {
        let under: A = self.under;
        let over: B = self.over;
        let share = clamp(self.share, 0.0, 1.0);
        chance_of_second(under.albedo(wo) * (1.0 - share), over.albedo(wo) * share)
    }
}

#[kernel]
impl<A: Bsdf, B: Bsdf> Bsdf for Mix<A, B> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let under: A = self.under;
        let over: B = self.over;
        let share = clamp(self.share, 0.0, 1.0);
        under.eval(wo, wi) * (1.0 - share) + over.eval(wo, wi) * share
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let under: A = self.under;
        let over: B = self.over;
        let share = clamp(self.share, 0.0, 1.0);
        let chance = Mix::<A, B>::chance(*self, wo);
        let (of_over, of_under) =
            (vec3(share, share, share), vec3(1.0 - share, 1.0 - share, 1.0 - share));
        if u.z < chance {
            let sample = over.sample(wo, vec3(u.x, u.y, of_part(u.z, 0.0, chance)));
            return sample_both(sample, of_over, chance, |wi: Vec3| {
                (under.eval(wo, wi) * of_under, under.pdf(wo, wi))
            });
        }
        let sample = under.sample(wo, vec3(u.x, u.y, of_part(u.z, chance, 1.0 - chance)));
        sample_both(sample, of_under, 1.0 - chance, |wi: Vec3| {
            (over.eval(wo, wi) * of_over, over.pdf(wo, wi))
        })
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let under: A = self.under;
        let over: B = self.over;
        let chance = Mix::<A, B>::chance(*self, wo);
        under.pdf(wo, wi) * (1.0 - chance) + over.pdf(wo, wi) * chance
    }

    fn albedo(&self, wo: Vec3) -> Vec3 {
        let under: A = self.under;
        let over: B = self.over;
        let share = clamp(self.share, 0.0, 1.0);
        under.albedo(wo) * (1.0 - share) + over.albedo(wo) * share
    }
}
