//! BSDFs: how surfaces scatter light.
//!
//! A BSDF is a value with four kernels, the trait [`Bsdf`]. Lobes and layers of the library are such
//! values, and so are those of a user: a struct with `#[derive(Type)]` and a `#[kernel] impl Bsdf`,
//! or an enum of several kinds.
//!
//! | BSDF | what it is | source |
//! |---|---|---|
//! | [`Lambert`] | ideal diffuse reflection | Lambert 1760 |
//! | [`Eon`] | rough diffuse reflection that keeps energy | Portsmouth, Kutz and Hill 2025 |
//! | [`Mirror`] | ideal specular reflection | |
//! | [`Conductor`] | rough or smooth metal, by any [`Fresnel`]: [`F82`], [`ComplexIor`] | Walter et al. 2007; Turquin 2019 |
//! | [`Dielectric`] | rough or smooth glass: reflection and refraction | Walter et al. 2007 |
//! | [`ThinDielectric`] | a pane of glass without thickness | Stokes 1862 |
//! | [`Sheen`] | cloth, by the Charlie distribution | Estevez and Kulla 2017 |
//! | [`Coated`] | a dielectric coat on any BSDF | Kulla and Conty 2017 |
//! | [`SheenCoated`] | sheen on any BSDF | Estevez and Kulla 2017 |
//! | [`Mix`] | a share of one BSDF, the rest another | |
//! | [`MetallicRoughness`] | the material of glTF, of the above | Khronos, glTF 2.0 |
//!
//! # Conventions
//!
//! * Directions are in the frame of the surface, with `z` along the shading normal. `wo` is towards
//!   the viewer, `wi` towards the light; both lead away from the surface and have unit length.
//! * [`eval`](Bsdf::eval) is the BSDF times `|wi.z|`. Densities are per solid angle.
//! * A path carries basic radiance, radiance over the square of the refractive index (Nicodemus
//!   1963), which refraction does not change: white glass in a white furnace returns 1, from both
//!   sides. Where light and camera are in air, that is radiance.
//! * A BSDF that reflects only does so on both sides. One that transmits has the outside where `z`
//!   is above 0.
//! * Delta lobes, mirrors and smooth glass, exist for [`sample`](Bsdf::sample) alone: `eval` and
//!   `pdf` leave them out.
//! * `alpha` is the parameter of the GGX distribution, the square of the roughness of glTF. Below
//!   [`MIN_ALPHA`] a surface is smooth.

mod albedo;
mod coat;
mod conductor;
mod dielectric;
mod diffuse;
mod frame;
mod fresnel;
mod material;
mod metallic_roughness;
mod microfacet;
mod mirror;
mod mix;
mod sheen;

pub use albedo::{dielectric_albedo, ggx_albedo, sheen_albedo};
pub use coat::Coated;
pub use conductor::Conductor;
pub use dielectric::{Dielectric, ThinDielectric};
pub use diffuse::{Eon, Lambert};
pub use frame::ShadingFrame;
pub use fresnel::{ComplexIor, F82, Fresnel, FresnelSplit, fresnel_dielectric};
pub use material::{Luminous, Material, NO_LIGHT};
pub use metallic_roughness::{Glass, MetallicRoughness};
pub use microfacet::{MIN_ALPHA, ggx_distribution, ggx_masking, ggx_shadowing, sample_ggx_normal};
pub use mirror::Mirror;
pub use mix::Mix;
pub use sheen::{Sheen, SheenCoated};

use glam::{Vec3, vec3};

use crate::machine::functions::vec3;
use crate::{Type, kernel};

/// How a surface scatters light, in the frame of the surface: see the [module](self) for the
/// conventions.
///
/// ```
/// use core::f32::consts::FRAC_1_PI;
/// use raydsl::bsdf::{Bsdf, BsdfSample};
/// use raydsl::kernel;
/// use raydsl::prelude::*;
///
/// /// Moss, which is brighter where one looks along it.
/// #[derive(Clone, Copy, Debug, Type)]
/// struct Moss {
///     color: Vec3,
/// }
///
/// #[kernel]
/// impl Bsdf for Moss {
///     fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
///         let rim = (1.0 - wo.z.abs()) * (1.0 - wi.z.abs());
///         let is_reflected = wo.z * wi.z > 0.0;
///         let share = if is_reflected { FRAC_1_PI * wi.z.abs() * (0.5 + 0.5 * rim) } else { 0.0 };
///         self.color * share
///     }
///
///     fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
///         let up = sample_cosine_hemisphere(vec2(u.x, u.y));
///         let wi = vec3(up.x, up.y, if wo.z < 0.0 { -up.z } else { up.z });
///         BsdfSample::of(wi, Moss::eval(self, wo, wi), Moss::pdf(self, wo, wi))
///     }
///
///     fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
///         if wo.z * wi.z > 0.0 { cosine_hemisphere_pdf(wi.z.abs()) } else { 0.0 }
///     }
/// }
///
/// let moss = Moss { color: vec3(0.2, 0.5, 0.1) };
/// let kernel = kernel!(|wo: Vec3, u: Vec3| moss.sample(wo, u).weight.y);
/// assert!(kernel.call((Vec3::Z, vec3(0.3, 0.6, 0.5))) <= 0.5);
/// ```
#[kernel]
pub trait Bsdf {
    /// Returns the BSDF times `|wi.z|`, without delta lobes.
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3;

    /// Samples `wi` by a point of the unit cube; `u.z` chooses between lobes.
    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample;

    /// Returns the density with which [`sample`](Self::sample) chooses `wi`, without delta lobes.
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32;

    /// Returns about which share of the light from everywhere goes to `wo`: 0.5 unless the BSDF
    /// knows better. Layers and mixtures divide their samples by it: it changes no mean, as long as it
    /// is above 0 wherever anything is scattered.
    fn albedo(&self, _wo: Vec3) -> Vec3 {
        vec3(0.5, 0.5, 0.5)
    }
}

/// A sampled direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct BsdfSample {
    /// Unit vector towards the light.
    pub wi: Vec3,
    /// [`eval`](Bsdf::eval) over the density, which an estimate of the light is multiplied by; 0
    /// where nothing is scattered.
    pub weight: Vec3,
    /// Density per solid angle; of a delta lobe the probability of choosing it.
    pub pdf: f32,
    /// Whether the lobe is a delta: no light sample can have this direction.
    pub is_delta: bool,
}

#[kernel]
impl BsdfSample {
    /// Returns the sample of a direction with this value of [`eval`](Bsdf::eval) and this density:
    /// [`absorbed`](Self::absorbed) if that is 0.
    #[inline]
    pub fn of(wi: Vec3, eval: Vec3, pdf: f32) -> Self {
        let weight = if pdf > 0.0 { eval / pdf } else { vec3(0.0, 0.0, 0.0) };
        Self { wi, weight, pdf, is_delta: false }
    }

    /// Returns the sample of a delta lobe, which was chosen with the probability `pdf`.
    #[inline]
    pub fn delta(wi: Vec3, weight: Vec3, pdf: f32) -> Self {
        Self { wi, weight, pdf, is_delta: true }
    }

    /// Returns the sample of light that is absorbed.
    #[inline]
    pub fn absorbed() -> Self {
        let none = vec3(0.0, 0.0, 0.0);
        Self { wi: vec3(0.0, 0.0, 1.0), weight: none, pdf: 0.0, is_delta: false }
    }
}

/// Returns the direction on the other side if `wo` is below the surface: what reflects does so on
/// both sides.
#[kernel]
#[inline]
fn upwards(w: Vec3, wo: Vec3) -> Vec3 {
    vec3(w.x, w.y, if wo.z < 0.0 { -w.z } else { w.z })
}

/// Returns the arithmetic mean of red, green and blue.
#[kernel]
#[inline]
fn mean(color: Vec3) -> f32 {
    (color.x + color.y + color.z) * (1.0 / 3.0)
}
