//! The material of glTF.

use glam::{Vec3, vec3};

use super::{
    Bsdf, BsdfSample, Coated, Conductor, Dielectric, F82, Lambert, Mix, Sheen, SheenCoated,
    ThinDielectric,
};
use crate::machine::functions::vec3;
use crate::{Type, kernel};

/// The metallic-roughness material of glTF 2.0, with its extensions clearcoat, sheen, transmission,
/// volume, ior and specular, as lobes of this library.
///
/// | part of glTF | here |
/// |---|---|
/// | metal | [`Conductor`] with [`F82`], `normal` the base colour, `tint` 1: Schlick's reflectance |
/// | dielectric, its diffuse and specular part | [`Coated`] [`Lambert`]: glTF leaves their coupling open, here it is the directional albedo |
/// | transmission without a volume | [`ThinDielectric`] with the base colour as its tint |
/// | transmission with a volume | [`Dielectric`] with the base colour as its tint |
/// | `metallic` | [`Mix`] of the two, each with its own compensation for what is scattered several times |
/// | specular factor and colour | `strength` of the coat, at all angles alike: glTF tints the reflection at normal incidence alone; glass has none |
/// | clearcoat | [`Coated`] with index 1.5 on all of it |
/// | sheen | [`SheenCoated`] on all of that |
///
/// Most of these lobes are not reciprocal. Emission is that of a [light](crate::light).
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct MetallicRoughness {
    /// Base colour, linear: red, green and blue, each from 0 to 1.
    pub base_color: Vec3,
    /// Share of metal, from 0 to 1.
    pub metallic: f32,
    /// Roughness from 0 to 1; its square is the GGX parameter.
    pub roughness: f32,
    /// Index of refraction, from 1 to 3.
    pub ior: f32,
    /// Factor of the specular reflection of what is neither metal nor transmits: red, green and blue.
    pub specular: Vec3,
    /// Share of light that is transmitted where it is not reflected or metal, from 0 to 1.
    pub transmission: f32,
    /// Whether the surface bounds a volume, which refracts; otherwise it is thin.
    pub is_solid: bool,
    /// Strength of the clearcoat, from 0 to 1.
    pub clearcoat: f32,
    /// Its roughness, from 0 to 1.
    pub clearcoat_roughness: f32,
    /// Colour of the sheen; black is none.
    pub sheen_color: Vec3,
    /// Its roughness, from 0 to 1.
    pub sheen_roughness: f32,
}

/// The default of glTF: rough white metal.
impl Default for MetallicRoughness {
    fn default() -> Self {
        Self {
            base_color: Vec3::ONE,
            metallic: 1.0,
            roughness: 1.0,
            ior: 1.5,
            specular: Vec3::ONE,
            transmission: 0.0,
            is_solid: false,
            clearcoat: 0.0,
            clearcoat_roughness: 0.0,
            sheen_color: Vec3::ZERO,
            sheen_roughness: 0.0,
        }
    }
}

/// Glass, a body or a pane.
#[derive(Clone, Copy, Debug, Type)]
pub enum Glass {
    /// The surface of a body, which refracts.
    Solid(Dielectric),
    /// A pane.
    Thin(ThinDielectric),
}

#[kernel]
impl Bsdf for Glass {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        match *self {
            Glass::Solid(glass) => Dielectric::eval(&glass, wo, wi),
            Glass::Thin(glass) => ThinDielectric::eval(&glass, wo, wi),
        }
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        match *self {
            Glass::Solid(glass) => Dielectric::sample(&glass, wo, u),
            Glass::Thin(glass) => ThinDielectric::sample(&glass, wo, u),
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match *self {
            Glass::Solid(glass) => Dielectric::pdf(&glass, wo, wi),
            Glass::Thin(glass) => ThinDielectric::pdf(&glass, wo, wi),
        }
    }

    fn albedo(&self, _wo: Vec3) -> Vec3 {
        vec3(1.0, 1.0, 1.0)
    }
}

/// What is not metal.
type Dielectrics = Mix<Coated<Lambert>, Glass>;

/// What is under the clearcoat.
type Base = Mix<Dielectrics, Conductor<F82>>;

/// All layers of the material.
type Layers = SheenCoated<Coated<Base>>;

#[kernel]
impl MetallicRoughness {
    fn layers(self) -> Layers {
        let one = vec3(1.0, 1.0, 1.0);
        let alpha = self.roughness * self.roughness;
        let solid = Dielectric { ior: self.ior, alpha, tint: self.base_color };
        let thin = ThinDielectric { ior: self.ior, alpha, tint: self.base_color };
        let glass = if self.is_solid { Glass::Solid(solid) } else { Glass::Thin(thin) };
        let plastic = Coated::<Lambert> {
            base: Lambert { color: self.base_color },
            ior: self.ior,
            alpha,
            strength: self.specular,
        };
        let metal = Conductor::<F82> { fresnel: F82 { normal: self.base_color, tint: one }, alpha };
        let inner =
            Mix::<Coated<Lambert>, Glass> { under: plastic, over: glass, share: self.transmission };
        let base =
            Mix::<Dielectrics, Conductor<F82>> { under: inner, over: metal, share: self.metallic };
        let coated = Coated::<Base> {
            base,
            ior: 1.5,
            alpha: self.clearcoat_roughness * self.clearcoat_roughness,
            strength: one * self.clearcoat,
        };
        let sheen =
            Sheen { color: self.sheen_color, alpha: self.sheen_roughness * self.sheen_roughness };
        SheenCoated::<Coated<Base>> { base: coated, sheen }
    }
}

#[kernel]
impl Bsdf for MetallicRoughness {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let layers: Layers = MetallicRoughness::layers(*self);
        Layers::eval(&layers, wo, wi)
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let layers: Layers = MetallicRoughness::layers(*self);
        Layers::sample(&layers, wo, u)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let layers: Layers = MetallicRoughness::layers(*self);
        Layers::pdf(&layers, wo, wi)
    }

    fn albedo(&self, wo: Vec3) -> Vec3 {
        let layers: Layers = MetallicRoughness::layers(*self);
        Layers::albedo(&layers, wo)
    }
}
