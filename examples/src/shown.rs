//! The materials that are shown: an enum of BSDFs of the library. A list of your own looks the same.

use raydsl::bsdf::{
    Bsdf, BsdfSample, Coated, ComplexIor, Conductor, Dielectric, Eon, F82, Lambert, Material,
    MetallicRoughness, Mirror, Mix, Sheen, SheenCoated, ThinDielectric,
};
use raydsl::kernel;
use raydsl::prelude::*;

/// Declares an enum of BSDFs and implements each method by that of its kinds.
macro_rules! materials {
    ($($kind:ident($t:ty)),+ $(,)?) => {
        /// A material of one of several kinds.
        #[derive(Clone, Copy, Debug, Type)]
        pub enum Shown {
            $(#[doc = concat!("[`", stringify!($t), "`]")] $kind($t),)+
        }

        #[kernel]
        impl Bsdf for Shown {
            fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
                match *self {
                    $(Shown::$kind(b) => <$t>::eval(&b, wo, wi),)+
                }
            }

            fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
                match *self {
                    $(Shown::$kind(b) => <$t>::sample(&b, wo, u),)+
                }
            }

            fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
                match *self {
                    $(Shown::$kind(b) => <$t>::pdf(&b, wo, wi),)+
                }
            }

            fn albedo(&self, wo: Vec3) -> Vec3 {
                match *self {
                    $(Shown::$kind(b) => <$t>::albedo(&b, wo),)+
                }
            }
        }
    };
}

materials! {
    Lambert(Lambert),
    Eon(Eon),
    Mirror(Mirror),
    Metal(Conductor<ComplexIor>),
    Tinted(Conductor<F82>),
    Glass(Dielectric),
    Pane(ThinDielectric),
    Plastic(Coated<Eon>),
    Lacquer(Coated<Conductor<F82>>),
    Cloth(SheenCoated<Lambert>),
    Speckled(Mix<Coated<Eon>, Conductor<F82>>),
    Gltf(MetallicRoughness),
}

#[kernel]
impl Material for Shown {}

/// Gold at 630, 532 and 465 nm. (Johnson and Christy, "Optical Constants of the Noble Metals", 1972.)
const GOLD: ComplexIor =
    ComplexIor { n: Vec3::new(0.188, 0.543, 1.332), k: Vec3::new(3.403, 2.231, 1.869) };

/// The materials with their names.
pub fn all() -> Vec<(&'static str, Shown)> {
    let red = vec3(0.6, 0.08, 0.06);
    let blue = vec3(0.05, 0.2, 0.5);
    let copper = F82 { normal: vec3(0.955, 0.638, 0.538), tint: vec3(0.98, 0.85, 0.8) };
    let plastic = |alpha, color| Coated::<Eon> {
        base: Eon { color, roughness: 0.3 },
        ior: 1.5,
        alpha,
        strength: Vec3::ONE,
    };
    let metal = |alpha| Conductor::<ComplexIor> { fresnel: GOLD, alpha };
    let sheen = Sheen { color: Vec3::splat(0.9), alpha: 0.2 };
    let cloth = SheenCoated::<Lambert> { base: Lambert { color: vec3(0.25, 0.03, 0.12) }, sheen };
    let base = Conductor::<F82> { fresnel: copper, alpha: 0.3 };
    let lacquer = Coated::<Conductor<F82>> { base, ior: 1.5, alpha: 0.0, strength: Vec3::ONE };
    let speckled = Mix::<Coated<Eon>, Conductor<F82>> {
        under: plastic(0.01, blue),
        over: Conductor::<F82> { fresnel: copper, alpha: 0.1 },
        share: 0.4,
    };
    let coated = MetallicRoughness {
        base_color: vec3(0.02, 0.25, 0.12),
        metallic: 0.9,
        roughness: 0.45,
        clearcoat: 1.0,
        clearcoat_roughness: 0.05,
        ..Default::default()
    };
    let glass = |alpha| Dielectric { ior: 1.5, alpha, tint: vec3(0.97, 1.0, 0.98) };
    vec![
        ("Lambert", Shown::Lambert(Lambert { color: red })),
        ("EON, roughness 1", Shown::Eon(Eon { color: red, roughness: 1.0 })),
        ("plastic", Shown::Plastic(plastic(0.0, red))),
        ("rough plastic", Shown::Plastic(plastic(0.16, red))),
        ("cloth", Shown::Cloth(cloth)),
        ("mirror", Shown::Mirror(Mirror { color: Vec3::splat(0.95) })),
        ("gold", Shown::Metal(metal(0.005))),
        ("rough gold", Shown::Metal(metal(0.2))),
        ("copper, F82", Shown::Tinted(Conductor::<F82> { fresnel: copper, alpha: 0.08 })),
        ("lacquered copper", Shown::Lacquer(lacquer)),
        ("glass", Shown::Glass(glass(0.0))),
        ("rough glass", Shown::Glass(glass(0.15))),
        (
            "thin glass",
            Shown::Pane(ThinDielectric { ior: 1.5, alpha: 0.0, tint: vec3(0.9, 0.97, 1.0) }),
        ),
        ("plastic and metal", Shown::Speckled(speckled)),
        ("glTF with coat", Shown::Gltf(coated)),
    ]
}
