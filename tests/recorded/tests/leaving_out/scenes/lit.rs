//! Scenes with light: occlusion, materials, lights, paths.

use raydsl::bsdf::{
    Bsdf, BsdfSample, ComplexIor, Conductor, Dielectric, Lambert, Luminous, Material, NO_LIGHT,
};
use raydsl::integrators::{
    PathLimits, PathOptions, PathSample, ambient_occlusion, direct_light, path, path_with,
    volume_path, whitted,
};
use raydsl::kernel;
use raydsl::light::{AnyLight, AreaLight, DirectionalLight, Environment, Lights, PointLight};
use raydsl::machine::Recording;
use raydsl::prelude::*;
use raydsl::volume::Fog;

use super::Made;
use super::primitives::{Ball, Face, balls};

/// Returns a sampler of the method with the least code.
#[kernel]
pub(super) fn sampler_of(pixel: UVec2) -> Sampler {
    Sampler::new(pixel, 0, 0, 1, SampleMethod::Random)
}

#[kernel]
pub(crate) fn open_sky(scene: &Bvh<'_, Face>, ray: Ray, pixel: UVec2) -> Vec4 {
    ambient_occlusion::<_, 2>(scene, 1.0, ray, sampler_of(pixel))
}

pub(super) fn occlusion() -> Made {
    let (soup, _) = lit_triangles();
    let bvh = &Bvh::build(&soup)?;
    Ok(recorded!(open_sky(bvh)(ray: Ray, pixel: UVec2) -> Vec4))
}

pub(super) fn lamp() -> PointLight {
    PointLight { position: vec3(0.0, 9.0, 0.0), intensity: Vec3::splat(40.0) }
}

#[kernel]
pub(super) fn lit(
    scene: &Bvh<'_, Ball>,
    lights: &Lights<'_, AnyLight>,
    ray: Ray,
    pixel: UVec2,
) -> Vec4 {
    let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
    let sampler = sampler_of(pixel);
    direct_light::<_, _, Lambert>(scene, surface, lights, true, ray, sampler)
}

pub(super) fn direct() -> Made {
    let balls = balls();
    let scene = &Bvh::build(&balls)?;
    let sun = DirectionalLight { direction: Vec3::Y, irradiance: Vec3::ONE, sine: 0.0 };
    let list = [AnyLight::Point(lamp()), AnyLight::Directional(sun)];
    let lights = &Lights::new(&list, scene.bounds())?;
    Ok(recorded!(lit(scene, lights)(ray: Ray, pixel: UVec2) -> Vec4))
}

#[kernel]
pub(super) fn mirrored(
    scene: &Bvh<'_, Ball>,
    lights: &Lights<'_, PointLight>,
    ray: Ray,
    pixel: UVec2,
) -> Vec4 {
    let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
    whitted::<_, _, Lambert>(scene, surface, lights, true, 3, ray, sampler_of(pixel))
}

pub(super) fn mirrors() -> Made {
    let balls = balls();
    let scene = &Bvh::build(&balls)?;
    let list = [lamp()];
    let lights = &Lights::new(&list, scene.bounds())?;
    Ok(recorded!(mirrored(scene, lights)(ray: Ray, pixel: UVec2) -> Vec4))
}

/// A lamp over a floor.
pub(crate) fn lit_triangles() -> (Vec<Face>, [AreaLight<Triangle>; 1]) {
    let floor = Face { v0: vec3(-9.0, 0.0, -9.0), v1: vec3(9.0, 0.0, -9.0), v2: Vec3::Z * 9.0 };
    let (v0, v1, v2) = (vec3(-1.0, 5.0, -1.0), vec3(1.0, 5.0, -1.0), Vec3::Y * 5.0);
    let shape = Triangle { v0, v1, v2 };
    let lamp = AreaLight { shape, radiance: Vec3::ONE, is_two_sided: true };
    (vec![floor, Face { v0, v1, v2 }], [lamp])
}

/// The floor's material, or the lamp's.
#[kernel]
pub(super) fn material(hit: Hit, point: ShadingPoint) -> Luminous<Lambert> {
    let light = if hit.prim_id == 1 { 0u32 } else { NO_LIGHT };
    Luminous::<Lambert> { bsdf: Lambert { color: point.albedo }, light }
}

#[kernel]
pub(crate) fn diffuse_path(
    scene: &Bvh<'_, Face>,
    lights: &Lights<'_, AreaLight<Triangle>>,
    limits: PathLimits,
    ray: Ray,
    pixel: UVec2,
) -> Vec4 {
    let surface = |hit: Hit, point: ShadingPoint| material(hit, point);
    path::<_, _, Luminous<Lambert>>(scene, surface, lights, limits, ray, sampler_of(pixel)).color
}

pub(super) fn diffuse() -> Made {
    let (soup, lamps) = lit_triangles();
    let scene = &Bvh::build(&soup)?;
    let (lights, limits) = (&Lights::new(&lamps, scene.bounds())?, PathLimits::new(4));
    Ok(recorded!(diffuse_path(scene, lights, limits)(ray: Ray, pixel: UVec2) -> Vec4))
}

#[kernel]
pub(super) fn path_with_channels(
    scene: &Bvh<'_, Face>,
    lights: &Lights<'_, AreaLight<Triangle>>,
    limits: PathLimits,
    ray: Ray,
    pixel: UVec2,
) -> PathSample {
    let surface = |hit: Hit, point: ShadingPoint| material(hit, point);
    path::<_, _, Luminous<Lambert>>(scene, surface, lights, limits, ray, sampler_of(pixel))
}

/// The same with all that denoisers ask for.
pub(super) fn channels() -> Made {
    let (soup, lamps) = lit_triangles();
    let scene = &Bvh::build(&soup)?;
    let (lights, limits) = (&Lights::new(&lamps, scene.bounds())?, PathLimits::new(4));
    Ok(recorded!(path_with_channels(scene, lights, limits)(ray: Ray, pixel: UVec2) -> PathSample))
}

const WHOLE: PathOptions = PathOptions { without_roulette: true, ..PathOptions::new() };
const HOLES: PathOptions = PathOptions { masks: true, ..PathOptions::new() };

#[kernel]
pub(super) fn whole_path(
    scene: &Bvh<'_, Face>,
    lights: &Lights<'_, AreaLight<Triangle>>,
    limits: PathLimits,
    ray: Ray,
    pixel: UVec2,
) -> Vec4 {
    let surface = |hit: Hit, point: ShadingPoint| material(hit, point);
    let sampler = sampler_of(pixel);
    path_with::<_, _, Luminous<Lambert>>(scene, surface, lights, WHOLE, limits, ray, sampler).color
}

/// The diffuse path, which does not end by chance.
pub(super) fn without_roulette() -> Made {
    let (soup, lamps) = lit_triangles();
    let scene = &Bvh::build(&soup)?;
    let (lights, limits) = (&Lights::new(&lamps, scene.bounds())?, PathLimits::new(4));
    Ok(recorded!(whole_path(scene, lights, limits)(ray: Ray, pixel: UVec2) -> Vec4))
}

#[kernel]
pub(super) fn path_through_holes(
    scene: &Bvh<'_, Face>,
    lights: &Lights<'_, AreaLight<Triangle>>,
    limits: PathLimits,
    ray: Ray,
    pixel: UVec2,
) -> Vec4 {
    let surface = |hit: Hit, point: ShadingPoint| material(hit, point);
    let sampler = sampler_of(pixel);
    path_with::<_, _, Luminous<Lambert>>(scene, surface, lights, HOLES, limits, ray, sampler).color
}

/// The diffuse path among surfaces that may have holes.
pub(super) fn holes() -> Made {
    let (soup, lamps) = lit_triangles();
    let scene = &Bvh::build(&soup)?;
    let (lights, limits) = (&Lights::new(&lamps, scene.bounds())?, PathLimits::new(4));
    Ok(recorded!(path_through_holes(scene, lights, limits)(ray: Ray, pixel: UVec2) -> Vec4))
}

/// Any of three materials.
#[derive(Clone, Copy, Debug, Type)]
pub(super) enum Any {
    Matte(Lambert),
    Metal(Conductor<ComplexIor>),
    Glass(Dielectric),
}

#[kernel]
impl Bsdf for Any {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        match *self {
            Any::Matte(b) => Lambert::eval(&b, wo, wi),
            Any::Metal(b) => Conductor::<ComplexIor>::eval(&b, wo, wi),
            Any::Glass(b) => Dielectric::eval(&b, wo, wi),
        }
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        match *self {
            Any::Matte(b) => Lambert::sample(&b, wo, u),
            Any::Metal(b) => Conductor::<ComplexIor>::sample(&b, wo, u),
            Any::Glass(b) => Dielectric::sample(&b, wo, u),
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match *self {
            Any::Matte(b) => Lambert::pdf(&b, wo, wi),
            Any::Metal(b) => Conductor::<ComplexIor>::pdf(&b, wo, wi),
            Any::Glass(b) => Dielectric::pdf(&b, wo, wi),
        }
    }
}

#[kernel]
impl Material for Any {}

#[kernel]
pub(super) fn glossy_path(
    scene: &Bvh<'_, Ball>,
    materials: &[Any],
    lights: &Lights<'_, PointLight>,
    limits: PathLimits,
    ray: Ray,
    pixel: UVec2,
) -> Vec4 {
    let surface =
        |hit: Hit, _point: ShadingPoint| materials[hit.prim_id as usize % materials.len()];
    path::<_, _, Any>(scene, surface, lights, limits, ray, sampler_of(pixel)).color
}

/// Records a path among these materials under a sky.
pub(super) fn path_among(list: &[Any]) -> Made {
    let balls = balls();
    let scene = &Bvh::build(&balls)?;
    let sky = Environment::constant(Vec3::ONE)?;
    let none: [PointLight; 0] = [];
    let lights = &Lights::new(&none, scene.bounds())?.with_environment(&sky);
    let (materials, limits) = (list, PathLimits::new(4));
    Ok(recorded!(glossy_path(scene, materials, lights, limits)(ray: Ray, pixel: UVec2) -> Vec4))
}

const MATTE: Any = Any::Matte(Lambert { color: Vec3::ONE });

pub(super) fn metal() -> Made {
    let gold = ComplexIor { n: vec3(0.2, 0.5, 1.3), k: vec3(3.4, 2.2, 1.9) };
    path_among(&[MATTE, Any::Metal(Conductor::<ComplexIor> { fresnel: gold, alpha: 0.2 })])
}

pub(super) fn glass() -> Made {
    path_among(&[MATTE, Any::Glass(Dielectric { ior: 1.5, alpha: 0.1, tint: Vec3::ONE })])
}

#[kernel]
pub(super) fn path_in_fog(
    scene: &Bvh<'_, Face>,
    lights: &Lights<'_, AreaLight<Triangle>>,
    fog: Fog,
    limits: PathLimits,
    ray: Ray,
    pixel: UVec2,
) -> Vec4 {
    volume_path::<_, _, Luminous<Lambert>>(
        scene,
        |hit: Hit, point: ShadingPoint| material(hit, point),
        |ray: Ray, rng: Rng| {
            let mut rng = rng;
            fog.collision(ray, &mut rng)
        },
        |ray: Ray, _rng: Rng| fog.transmittance(ray),
        lights,
        PLAIN,
        limits,
        ray,
        sampler_of(pixel),
    )
    .color
}

const PLAIN: PathOptions = PathOptions::new();

pub(super) fn fog() -> Made {
    let (soup, lamps) = lit_triangles();
    let scene = &Bvh::build(&soup)?;
    let (lights, limits) = (&Lights::new(&lamps, scene.bounds())?, PathLimits::new(4));
    let fog = Fog { extinction: 0.1, albedo: Vec3::ONE, anisotropy: 0.0 };
    Ok(recorded!(path_in_fog(scene, lights, fog, limits)(ray: Ray, pixel: UVec2) -> Vec4))
}
