//! Path tracing.

use glam::{Vec3, Vec4, uvec2, vec3, vec4};

use super::direct::{Scattering, next_3d, scattered_light, scattering_at};
use super::masks::{closest_surface, is_occluded};
use crate::bsdf::{Bsdf, BsdfSample, Material};
use crate::geometry::{Hit, Ray, SurfacePoint};
use crate::light::{Light, Lights, NO_RIVAL};
use crate::machine::functions::{uvec2, vec3, vec4};
use crate::machine::generic::{length, max, min, normalize};
use crate::machine::{Machine, Method, Type as MachineType, host_options, name};
use crate::sampling::Sampler;
use crate::shading::{Scene, ShadingPoint};
use crate::{Type, kernel};

/// What a path returns: the colour, and what denoisers ask for, of the same rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct PathSample {
    /// Radiance: red, green and blue; and alpha, 0 where the ray misses and 1 elsewhere.
    pub color: Vec4,
    /// Albedo of the first surface, a [`Bsdf::albedo`]; 0 where the ray misses.
    pub albedo: Vec3,
    /// Shading normal of the first surface, on the side that the ray comes from; 0 where the ray
    /// misses.
    pub normal: Vec3,
    /// Distance of the first surface, in units of the scene; [`f32::MAX`] where the ray misses.
    pub depth: f32,
}

#[kernel]
impl PathSample {
    /// Returns the sample of a ray that misses.
    #[inline]
    pub(super) fn nothing() -> Self {
        let none = vec3(0.0, 0.0, 0.0);
        Self { color: vec4(0.0, 0.0, 0.0, 0.0), albedo: none, normal: none, depth: f32::MAX }
    }
}

/// Returns a colour with more light.
#[kernel]
#[inline]
fn with_light(color: Vec4, light: Vec3) -> Vec4 {
    vec4(color.x + light.x, color.y + light.y, color.z + light.z, color.w)
}

/// How long paths are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Type)]
#[repr(C)]
pub struct PathLimits {
    /// How often light is scattered at most: 0 is emitted light alone, 1 direct light besides.
    pub bounces: u32,
    /// The bounce from which on Russian roulette ends paths: 3 unless set; `u32::MAX` is none, and
    /// [`PathOptions::without_roulette`] leaves out its code too.
    pub roulette: u32,
}

impl PathLimits {
    /// Creates limits with roulette from the fourth bounce on.
    pub const fn new(bounces: u32) -> Self {
        Self { bounces, roulette: 3 }
    }
}

/// How a path finds direct light, a host value: by next-event estimation, by its own rays, or by both
/// with multiple importance sampling.
#[doc(alias = "MIS")]
#[doc(alias = "next event estimation")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Type)]
#[repr(u32)]
pub enum LightSampling {
    /// By samples of lights and by rays that hit lights, weighted by the power heuristic (multiple
    /// importance sampling): the least noise.
    #[default]
    Weighted,
    /// By samples of lights alone (next-event estimation), but for mirrors and smooth glass: noisy
    /// where a glossy surface reflects a large light.
    LightsAlone,
    /// By rays that hit lights alone: noisy where lights are small, and blind for those that no ray
    /// hits.
    HitsAlone,
}

impl LightSampling {
    /// Returns whether lights are sampled.
    pub const fn has_samples(self) -> bool {
        !matches!(self, Self::HitsAlone)
    }

    /// Returns whether samples and hits are weighted against each other.
    pub const fn is_weighted(self) -> bool {
        matches!(self, Self::Weighted)
    }
}

/// What a path tracer does that not every scene needs: host values, all off unless set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Type)]
pub struct PathOptions {
    /// Whether there are surfaces with holes, or half-transparent ones: rays meet a surface with the
    /// probability of its [`Material::opacity`], and pass it otherwise. Queries ask the material of
    /// every hit then, which takes longer. A surface that is a light is opaque to its own samples: one
    /// that shines should be opaque.
    pub masks: bool,
    /// How light is found.
    pub lights: LightSampling,
    /// Whether no path ends by chance: [`PathLimits::roulette`] is not read, and a kernel has no code
    /// of it. Results are those of `u32::MAX` there: [`PathLimits::bounces`] alone ends a path that goes
    /// on to bring light, or numbers that are not finite.
    pub without_roulette: bool,
}

impl PathOptions {
    /// Creates options with everything off.
    pub const fn new() -> Self {
        Self { masks: false, lights: LightSampling::Weighted, without_roulette: false }
    }
}

host_options!(LightSampling, PathOptions);

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("has_samples") }, M, ()> for LightSampling {
    type Output = bool;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> bool {
        self.has_samples()
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("is_weighted") }, M, ()> for LightSampling {
    type Output = bool;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> bool {
        self.is_weighted()
    }
}

const PLAIN: PathOptions = PathOptions::new();

/// Estimates the radiance along `ray` by one path: light that is scattered up to `bounces` times.
///
/// `surface` returns the material of a hit. A light is sampled at each bounce, and weighted against
/// the path's own hits of lights. From bounce `roulette` on, the first one being 0, a path goes on with
/// a probability of its throughput, at most 0.95: 3 is a good choice, and `u32::MAX` never ends a path
/// by chance. (Kajiya, "The Rendering Equation", 1986; Veach, "Robust Monte Carlo
/// Methods for Light Transport Simulation", 1997, chapters 9 and 10.)
///
/// ```
/// use raydsl::bsdf::Lambert;
/// use raydsl::integrators::{PathLimits, path};
/// use raydsl::light::{AnyLight, Environment, Lights};
/// use raydsl::prelude::*;
///
/// // A white ball in a white furnace cannot be seen.
/// #[primitive(sphere(center, radius))]
/// struct Ball {
///     center: Vec3,
///     radius: f32,
/// }
/// # use raydsl::kernel;
/// #[kernel]
/// impl raydsl::shading::Surface for Ball {
///     fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
///         self.surface_point(ray, hit)
///     }
///
///     fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
///         vec3(1.0, 1.0, 1.0)
///     }
/// }
///
/// let balls = [Ball { center: Vec3::ZERO, radius: 1.0 }];
/// let scene = Bvh::build(&balls)?;
/// let sky = Environment::constant(Vec3::ONE)?;
/// let none: [AnyLight; 0] = [];
/// let lights = Lights::new(&none, scene.bounds())?.with_environment(&sky);
/// let limits = PathLimits::new(8);
/// let kernel = kernel!(|ray: Ray, sampler: Sampler| {
///     let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
///     path::<_, _, Lambert>(&scene, surface, &lights, limits, ray, sampler).color
/// });
/// let ray = Ray::new(vec3(0.3, 0.2, 3.0), -Vec3::Z);
/// let color = kernel.call((ray, Sampler::new(uvec2(0, 0), 0, 0, 1, SampleMethod::Sobol)));
/// assert!(color.x > 0.0 && color.x < 2.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[kernel]
pub fn path<S: Scene + ?Sized, L: Light + MachineType, B: Bsdf + Material + MachineType>(
    scene: &S,
    surface: impl Fn(Hit, ShadingPoint) -> B,
    lights: &Lights<'_, L>,
    limits: PathLimits,
    ray: Ray,
    sampler: Sampler,
) -> PathSample {
    path_with::<S, L, B>(scene, surface, lights, PLAIN, limits, ray, sampler)
}

/// As [`path()`], with options.
#[kernel]
pub fn path_with<S: Scene + ?Sized, L: Light + MachineType, B: Bsdf + Material + MachineType>(
    scene: &S,
    surface: impl Fn(Hit, ShadingPoint) -> B,
    lights: &Lights<'_, L>,
    #[host] options: PathOptions,
    limits: PathLimits,
    ray: Ray,
    sampler: Sampler,
) -> PathSample {
    let mut state = PathState::new(ray, sampler);
    let mut first = PathSample::nothing();
    while !state.is_over {
        let is_first = state.bounce == 0;
        let step: PathStep = path_step::<S, L, B>(scene, &surface, lights, options, limits, state);
        if is_first {
            first = step.seen;
        }
        state = step.next;
    }
    PathSample { color: state.color, ..first }
}

/// A path up to one of its rays.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct PathState {
    /// The next ray, of any length.
    pub ray: Ray,
    /// Where it begins, from which lights are chosen.
    pub from: SurfacePoint,
    /// Density of its direction, against which samples of lights are weighted.
    pub pdf: f32,
    /// Factor of the light that it brings: red, green and blue.
    pub throughput: Vec3,
    /// How often light has been scattered.
    pub bounce: u32,
    /// Whether there is no next ray.
    pub is_over: bool,
    /// The numbers of the next bounce.
    pub sampler: Sampler,
    /// What the path has brought so far: a [`PathSample::color`].
    pub color: Vec4,
}

/// What a step of a path returns.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct PathStep {
    /// The path behind it.
    pub next: PathState,
    /// What denoisers ask for, of what the ray hits; without a colour.
    pub seen: PathSample,
}

#[kernel]
impl PathStep {
    /// Returns the last step of a path.
    #[inline]
    fn last(state: PathState, color: Vec4, seen: PathSample) -> Self {
        PathStep { next: PathState { color, is_over: true, ..state }, seen }
    }
}

#[kernel]
impl PathState {
    /// Creates the path of a camera's ray.
    pub fn new(ray: Ray, sampler: Sampler) -> Self {
        Self {
            ray,
            from: SurfacePoint {
                position: ray.origin,
                normal: normalize(ray.direction),
                error: 0.0,
            },
            pdf: NO_RIVAL,
            throughput: vec3(1.0, 1.0, 1.0),
            bounce: 0,
            is_over: false,
            sampler,
            color: vec4(0.0, 0.0, 0.0, 0.0),
        }
    }
}

/// Follows a path by one ray: to what it hits, a light that shines there, and the next direction. The
/// kernel of [`accumulate_steps`](crate::render::TiledScheduler::accumulate_steps).
// ANCHOR: trace
#[kernel]
pub fn path_step<S: Scene + ?Sized, L: Light + MachineType, B: Bsdf + Material + MachineType>(
    scene: &S,
    surface: impl Fn(Hit, ShadingPoint) -> B,
    lights: &Lights<'_, L>,
    #[host] options: PathOptions,
    limits: PathLimits,
    state: PathState,
) -> PathStep {
    let PathState { ray, from, pdf, bounce, mut throughput, mut sampler, mut color, .. } = state;
    let ahead = normalize(ray.direction);
    let seed = uvec2(sampler.key.x, sampler.index);
    let is_occluded = |ray: Ray| is_occluded::<S, B>(scene, &surface, options.masks, ray, seed);

    // Find what the path hits.
    let hit = closest_surface::<S, B>(scene, &surface, options.masks, ray, seed);
    if !hit.is_hit {
        color = with_light(color, throughput * lights.missed(ahead, pdf));
        return PathStep::last(state, color, PathSample::nothing());
    }
    let seen = scene.shading_point(ray, hit);
    let material: B = surface(hit, seen);
    let at = scattering_at::<B>(seen, material, -ahead);
    let mut first = PathSample::nothing();
    if bounce == 0 {
        first = seen_first::<B>(at, hit.t * length(ray.direction));
    }
    color.w = 1.0;

    // Add the light that it emits.
    let light = material.light();
    color = with_light(color, throughput * lights.emitted(light, at.point, from, ahead, pdf));
    if bounce == limits.bounces {
        return PathStep::last(state, color, first);
    }

    // Add the light that one of the lights sends.
    let numbers = next_3d(&mut sampler);
    if options.lights.has_samples() {
        let lit = lights.sample(at.point, numbers);
        let scattered = scattered_light::<B>(is_occluded, options.lights.is_weighted(), lit, at);
        color = with_light(color, throughput * scattered);
    }

    // Go on in a direction of the surface's choice.
    let next: BsdfSample = material.sample(at.wo, next_3d(&mut sampler));
    let direction = at.frame.to_world(next.wi);
    throughput *= next.weight;
    let chance = if options.without_roulette {
        survival_of_all(throughput, &mut sampler)
    } else {
        survival(throughput, bounce, limits, &mut sampler)
    };
    let next = PathState {
        ray: at.point.ray(direction),
        from: at.point,
        pdf: hit_density(options.lights, next.pdf, next.is_delta),
        throughput: throughput / chance,
        bounce: bounce + 1,
        is_over: chance <= 0.0 || !at.frame.is_consistent(direction, next.wi),
        sampler,
        color,
    };
    PathStep { next, seen: first }
}
// ANCHOR_END: trace

/// Returns the probability with which a path went on, or 0 if it is over: by Russian roulette from a
/// bounce on, at most 0.95, so that a path whose throughput is not a number ends too.
#[kernel]
#[inline]
pub(super) fn survival(
    throughput: Vec3,
    bounce: u32,
    limits: PathLimits,
    sampler: &mut Sampler,
) -> f32 {
    let brightest = max(throughput.x, max(throughput.y, throughput.z));
    let mut chance = if brightest <= 0.0 { 0.0 } else { 1.0 };
    if bounce < limits.roulette {
        // The dimension is left out, so that all others are the same with and without roulette.
        sampler.dimension = sampler.dimension.wrapping_add(1);
    } else {
        // In this order a NaN yields the limit.
        let going_on = min(0.95, brightest);
        chance = if sampler.next_1d() < going_on { going_on } else { 0.0 };
    }
    chance
}

/// Returns what [`survival`] does without roulette: 1, or 0 for a path that brings nothing more.
#[kernel]
#[inline]
pub(super) fn survival_of_all(throughput: Vec3, sampler: &mut Sampler) -> f32 {
    // The dimension is left out here, too.
    sampler.dimension = sampler.dimension.wrapping_add(1);
    let brightest = max(throughput.x, max(throughput.y, throughput.z));
    if brightest <= 0.0 { 0.0 } else { 1.0 }
}

/// Returns the density of a direction against which samples of lights are weighted where a ray hits a
/// light: 0 where they alone count.
#[kernel]
#[inline]
pub(super) fn hit_density(#[host] lights: LightSampling, pdf: f32, is_delta: bool) -> f32 {
    let spread = match lights {
        LightSampling::Weighted => pdf,
        LightSampling::LightsAlone => 0.0,
        LightSampling::HitsAlone => NO_RIVAL,
    };
    if is_delta { NO_RIVAL } else { spread }
}

/// Returns the sample of a ray that hits a surface, before any light.
#[kernel]
#[inline]
pub(super) fn seen_first<B: Bsdf + MachineType>(at: Scattering<B>, depth: f32) -> PathSample {
    let bsdf: B = at.bsdf;
    let normal = if at.wo.z < 0.0 { -at.frame.z } else { at.frame.z };
    PathSample { color: vec4(0.0, 0.0, 0.0, 1.0), albedo: bsdf.albedo(at.wo), normal, depth }
}
