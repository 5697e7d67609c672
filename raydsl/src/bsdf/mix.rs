//! A mixture of two BSDFs.

use glam::{Vec3, vec3};

use super::{Bsdf, BsdfSample, mean};
use crate::machine::Type as MachineType;
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, max};
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
pub(super) fn within(u: f32, first: f32, width: f32) -> f32 {
    clamp((u - first) / width, 0.0, 0.999_999_94)
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
        if u.z < chance {
            let sample = over.sample(wo, vec3(u.x, u.y, within(u.z, 0.0, chance)));
            let pdf = sample.pdf * chance;
            if sample.pdf <= 0.0 {
                return BsdfSample::absorbed();
            }
            if sample.is_delta {
                return BsdfSample::delta(sample.wi, sample.weight * (share / chance), pdf);
            }
            let rest = under.eval(wo, sample.wi) * (1.0 - share);
            let all = sample.weight * (sample.pdf * share) + rest;
            return BsdfSample::of(sample.wi, all, pdf + under.pdf(wo, sample.wi) * (1.0 - chance));
        }
        let sample = under.sample(wo, vec3(u.x, u.y, within(u.z, chance, 1.0 - chance)));
        let pdf = sample.pdf * (1.0 - chance);
        if sample.pdf <= 0.0 {
            return BsdfSample::absorbed();
        }
        if sample.is_delta {
            let weight = sample.weight * ((1.0 - share) / (1.0 - chance));
            return BsdfSample::delta(sample.wi, weight, pdf);
        }
        let rest = over.eval(wo, sample.wi) * share;
        let all = sample.weight * (sample.pdf * (1.0 - share)) + rest;
        BsdfSample::of(sample.wi, all, pdf + over.pdf(wo, sample.wi) * chance)
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
