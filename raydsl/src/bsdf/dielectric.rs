//! Glass.

use glam::{Vec3, Vec3Swizzles as _, vec3};

use super::albedo::ggx_albedo;
use super::fresnel::{fresnel_between, fresnel_dielectric};
use super::microfacet::{
    MIN_ALPHA, ggx_distribution, ggx_masking, ggx_shadowing, reflected, reflection,
    sample_ggx_normal, sample_reflection, stretched,
};
use super::{Bsdf, BsdfSample, upwards};
use crate::machine::functions::vec3;
use crate::machine::generic::{max, normalize};
use crate::{Type, kernel};

/// The surface of glass, smooth or rough: what it does not reflect, it refracts.
///
/// Walter et al. 2007, with the GGX distribution; masking and shadowing are correlated in
/// reflection and separable in transmission. Light that is scattered several times between
/// microfacets is lost. With index 1.5, in the directions of the tests, that is for `alpha` 0.1 up to
/// 0.4 % from outside and 5 % from inside, for 0.5 up to 8 % and 36 %, for 1 a quarter and more than half.
///
/// An index within 0.001 of 1 refracts nothing: light passes straight on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Dielectric {
    /// Index of refraction of the inside, where `z` is below 0, over that of the outside.
    pub ior: f32,
    /// GGX parameter, from 0, smooth, to 1.
    pub alpha: f32,
    /// Share of transmitted light that is not absorbed: red, green and blue.
    pub tint: Vec3,
}

/// Least difference of an index from 1 that refracts.
const MIN_INDEX_STEP: f32 = 1e-3;

/// Returns the direction that `wo`, on the side of `normal`, is refracted to, given the cosine
/// beyond.
#[kernel]
#[inline]
fn refracted(wo: Vec3, normal: Vec3, eta: f32, cos: f32) -> Vec3 {
    let across = normal * wo.dot(normal) - wo;
    normalize(across / eta - normal * cos)
}

#[kernel]
impl Dielectric {
    /// Returns the index beyond the surface over that on the side of `wo`.
    #[inline]
    fn eta(self, wo: Vec3) -> f32 {
        if wo.z < 0.0 { 1.0 / self.ior } else { self.ior }
    }

    #[inline]
    fn is_smooth(self) -> bool {
        !(self.alpha >= MIN_ALPHA && (self.ior - 1.0).abs() >= MIN_INDEX_STEP)
    }

    /// Returns the microfacet normal, above the surface, that scatters `o`, above it too, to `i`.
    #[inline]
    fn half(o: Vec3, i: Vec3, eta: f32) -> Vec3 {
        let sum = if i.z > 0.0 { o + i } else { o + i * eta };
        let m = normalize(sum);
        if m.z < 0.0 { -m } else { m }
    }

    /// Samples a smooth surface.
    #[inline]
    fn sample_smooth(self, wo: Vec3, u: f32) -> BsdfSample {
        let o = upwards(wo, wo);
        // The same index on both sides: nothing is reflected, however grazing.
        let is_matched = (self.ior - 1.0).abs() < MIN_INDEX_STEP;
        let eta = self.eta(wo);
        let split = fresnel_dielectric(o.z, eta);
        let reflected = if is_matched { 0.0 } else { split.reflected };
        if u < reflected {
            return BsdfSample::delta(vec3(-wo.x, -wo.y, wo.z), vec3(1.0, 1.0, 1.0), reflected);
        }
        let bent = refracted(o, vec3(0.0, 0.0, 1.0), eta, split.cos);
        let through = if is_matched { -wo } else { upwards(bent, wo) };
        BsdfSample::delta(through, self.tint, 1.0 - reflected)
    }
}

#[kernel]
impl Bsdf for Dielectric {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        if Dielectric::is_smooth(*self) || wo.z == 0.0 || wi.z == 0.0 {
            return vec3(0.0, 0.0, 0.0);
        }
        let (o, i, alpha) = (upwards(wo, wo), upwards(wi, wo), self.alpha);
        let eta = Dielectric::eta(*self, wo);
        let m = Dielectric::half(o, i, eta);
        let (o_m, i_m) = (o.dot(m), i.dot(m));
        let split = fresnel_dielectric(o_m, eta);
        let facets = ggx_distribution(m, alpha);
        if i.z > 0.0 {
            let share = split.reflected * facets * ggx_shadowing(o, i, alpha) * i.z;
            return vec3(share, share, share);
        }
        let seen = ggx_masking(o, alpha) * ggx_masking(i, alpha) * o_m * i_m.abs() / o.z;
        let spread = o_m + eta * i_m;
        let is_facing = o_m > 0.0 && i_m < 0.0;
        // By both cosines, next to the critical angle too.
        let through = fresnel_between(o_m, -i_m, eta).transmitted;
        let share = through * facets * seen * (eta * eta) / (spread * spread);
        self.tint * (if is_facing { share } else { 0.0 })
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        if Dielectric::is_smooth(*self) {
            return Dielectric::sample_smooth(*self, wo, u.z);
        }
        let (o, alpha) = (upwards(wo, wo), self.alpha);
        let eta = Dielectric::eta(*self, wo);
        let m = sample_ggx_normal(o, u.xy(), alpha);
        let o_m = o.dot(m);
        let split = fresnel_dielectric(o_m, eta);
        let is_reflected = u.z < split.reflected;
        let i = if is_reflected { reflected(o, m) } else { refracted(o, m, eta, split.cos) };
        if !(o.z > 0.0 && (i.z > 0.0) == is_reflected && i.z != 0.0) {
            return BsdfSample::absorbed();
        }
        // The density of the normal over the distribution and its share of the microfacets.
        let facets = ggx_distribution(m, alpha) / (2.0 * (o.z + stretched(o, alpha)));
        if is_reflected {
            let (t_o, t_i) = (stretched(o, alpha), stretched(i, alpha));
            let share = i.z * (o.z + t_o) / (i.z * t_o + o.z * t_i);
            return BsdfSample {
                wi: upwards(i, wo),
                weight: vec3(share, share, share),
                pdf: split.reflected * facets,
                is_delta: false,
            };
        }
        let spread = o_m + eta * i.dot(m);
        let jacobian = 4.0 * o_m * i.dot(m).abs() * (eta * eta) / (spread * spread);
        BsdfSample {
            wi: upwards(i, wo),
            weight: self.tint * ggx_masking(i, alpha),
            pdf: split.transmitted * facets * jacobian,
            is_delta: false,
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if Dielectric::is_smooth(*self) || wo.z == 0.0 || wi.z == 0.0 {
            return 0.0;
        }
        let (o, i, alpha) = (upwards(wo, wo), upwards(wi, wo), self.alpha);
        let eta = Dielectric::eta(*self, wo);
        let m = Dielectric::half(o, i, eta);
        let (o_m, i_m) = (o.dot(m), i.dot(m));
        let split = fresnel_dielectric(o_m, eta);
        let facets = ggx_distribution(m, alpha) / (2.0 * (o.z + stretched(o, alpha)));
        let spread = o_m + eta * i_m;
        let jacobian = 4.0 * o_m * i_m.abs() * (eta * eta) / (spread * spread);
        let through =
            if o_m > 0.0 && i_m < 0.0 { split.transmitted * facets * jacobian } else { 0.0 };
        if i.z > 0.0 { split.reflected * facets } else { through }
    }

    fn albedo(&self, _wo: Vec3) -> Vec3 {
        vec3(1.0, 1.0, 1.0)
    }
}

/// A pane of glass without thickness, smooth or rough: its two sides together reflect light, or let it
/// pass straight on.
///
/// Reflections between the sides add up to `2 F / (1 + F)`. (Stokes, "On the Intensity of the Light
/// Reflected from or Transmitted through a Pile of Plates", 1862.) A rough one blurs what passes as
/// it blurs what it reflects; light that is scattered several times between microfacets is added by
/// scaling with the directional albedo (Turquin 2019), which keeps energy and is not reciprocal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct ThinDielectric {
    /// Index of refraction of the glass over that of its surroundings, at least 1.
    pub ior: f32,
    /// GGX parameter, from 0, smooth, to 1.
    pub alpha: f32,
    /// Share of transmitted light that is not absorbed: red, green and blue.
    pub tint: Vec3,
}

#[kernel]
impl ThinDielectric {
    /// Returns the share that both sides reflect.
    #[inline]
    fn reflectance(self, cos: f32) -> f32 {
        let one_side = fresnel_dielectric(cos, max(self.ior, 1.0)).reflected;
        2.0 * one_side / (1.0 + one_side)
    }
}

#[kernel]
impl Bsdf for ThinDielectric {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let alpha = max(self.alpha, MIN_ALPHA);
        let o = vec3(wo.x, wo.y, wo.z.abs());
        let i = vec3(wi.x, wi.y, wi.z.abs());
        let lobe = reflection(o, i, alpha);
        let share = ThinDielectric::reflectance(*self, lobe.cos);
        let one = vec3(1.0, 1.0, 1.0);
        let factor = if wo.z * wi.z > 0.0 { one * share } else { self.tint * (1.0 - share) };
        let value = lobe.weight * lobe.pdf / ggx_albedo(o.z, alpha);
        factor * (if self.alpha >= MIN_ALPHA { value } else { 0.0 })
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let o = vec3(wo.x, wo.y, wo.z.abs());
        let is_rough = self.alpha >= MIN_ALPHA;
        let alpha = max(self.alpha, MIN_ALPHA);
        let rough = sample_reflection(o, u.xy(), alpha);
        let i = if is_rough { rough.i } else { vec3(-o.x, -o.y, o.z) };
        if !(o.z > 0.0 && i.z > 0.0) {
            return BsdfSample::absorbed();
        }
        let share = ThinDielectric::reflectance(*self, if is_rough { rough.cos } else { o.z });
        let is_reflected = u.z < share;
        let side = if (wo.z < 0.0) == is_reflected { -i.z } else { i.z };
        let wi = vec3(i.x, i.y, side);
        let chance = if is_reflected { share } else { 1.0 - share };
        let one = vec3(1.0, 1.0, 1.0);
        let factor = if is_reflected { one } else { self.tint };
        if !is_rough {
            return BsdfSample::delta(wi, factor, chance);
        }
        let weight = factor * (rough.weight / ggx_albedo(o.z, alpha));
        BsdfSample { wi, weight, pdf: chance * rough.pdf, is_delta: false }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let alpha = max(self.alpha, MIN_ALPHA);
        let o = vec3(wo.x, wo.y, wo.z.abs());
        let i = vec3(wi.x, wi.y, wi.z.abs());
        let lobe = reflection(o, i, alpha);
        let share = ThinDielectric::reflectance(*self, lobe.cos);
        let chance = if wo.z * wi.z > 0.0 { share } else { 1.0 - share };
        if self.alpha >= MIN_ALPHA { chance * lobe.pdf } else { 0.0 }
    }

    fn albedo(&self, _wo: Vec3) -> Vec3 {
        vec3(1.0, 1.0, 1.0)
    }
}
