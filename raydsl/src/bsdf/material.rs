//! Materials: BSDFs with what integrators ask besides.

use glam::{Vec3, vec3};

use super::{
    Bsdf, BsdfSample, Coated, Conductor, Dielectric, Eon, Fresnel, Lambert, MetallicRoughness,
    Mirror, Mix, Sheen, SheenCoated, ThinDielectric,
};
use crate::machine::Type as MachineType;
use crate::machine::functions::vec3;
use crate::{Type, kernel};

/// Number of no light.
pub const NO_LIGHT: u32 = u32::MAX;

/// What integrators ask of a BSDF besides: all of it has a default.
///
/// ```
/// use raydsl::bsdf::{Lambert, Material};
/// use raydsl::kernel;
/// use raydsl::prelude::*;
///
/// /// Paint with a hole pattern.
/// #[derive(Clone, Copy, Type)]
/// struct Lace {
///     paint: Lambert,
///     is_hole: bool,
/// }
///
/// #[kernel]
/// impl Material for Lace {
///     fn opacity(&self) -> f32 {
///         if self.is_hole { 0.0 } else { 1.0 }
///     }
/// }
/// ```
#[kernel]
pub trait Material {
    /// Returns the number of the light that the surface is, among those of
    /// [`Lights`](crate::light::Lights), or [`NO_LIGHT`].
    fn light(&self) -> u32 {
        NO_LIGHT
    }

    /// Returns the probability with which a ray hits the surface instead of passing: 0 in the holes
    /// of an alpha mask.
    fn opacity(&self) -> f32 {
        1.0
    }

    /// Returns the normal of a normal map in the frame of the point's tangents, of any length.
    fn normal(&self) -> Vec3 {
        vec3(0.0, 0.0, 1.0)
    }
}

/// A surface that is a light, or is not, as its number says.
///
/// ```
/// use raydsl::bsdf::{Lambert, Luminous, NO_LIGHT};
/// use raydsl::prelude::*;
///
/// let wall = Luminous::<Lambert> { bsdf: Lambert { color: Vec3::ONE }, light: NO_LIGHT };
/// let lamp = Luminous::<Lambert> { bsdf: Lambert { color: Vec3::ZERO }, light: 0 };
/// # let _ = (wall, lamp);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct Luminous<B: Bsdf + MachineType> {
    /// How it scatters light.
    pub bsdf: B,
    /// Number of the light that it is, or [`NO_LIGHT`].
    pub light: u32,
}

#[kernel]
impl<B: Bsdf> Bsdf for Luminous<B> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let bsdf: B = self.bsdf;
        bsdf.eval(wo, wi)
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let bsdf: B = self.bsdf;
        bsdf.sample(wo, u)
    }

    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let bsdf: B = self.bsdf;
        bsdf.pdf(wo, wi)
    }

    #[inline]
    fn albedo(&self, wo: Vec3) -> Vec3 {
        let bsdf: B = self.bsdf;
        bsdf.albedo(wo)
    }
}

#[kernel]
impl<B: Bsdf> Material for Luminous<B> {
    #[inline]
    fn light(&self) -> u32 {
        self.light
    }
}

macro_rules! plain {
    ($($t:ident),*) => {
        $(
            #[kernel]
            impl Material for $t {}
        )*
    };
}

plain!(Lambert, Eon, Mirror, Dielectric, ThinDielectric, Sheen, MetallicRoughness);

#[kernel]
impl<F: Fresnel> Material for Conductor<F> {}

#[kernel]
impl<B: Bsdf> Material for Coated<B> {}

#[kernel]
impl<B: Bsdf> Material for SheenCoated<B> {}

#[kernel]
impl<A: Bsdf, B: Bsdf> Material for Mix<A, B> {}
