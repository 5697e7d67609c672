//! Path tracing through media.

use glam::{Vec3, Vec3Swizzles as _, uvec2, vec3, vec4};

use super::direct::{Scattering, is_bright, next_3d, scattered_light, scattering_at};
use super::masks::{closest_surface, is_occluded};
use super::path_tracing::{
    LightSampling, PathLimits, PathOptions, PathSample, hit_density, seen_first, survival,
    survival_of_all,
};
use crate::bsdf::{Bsdf, BsdfSample, Material};
use crate::geometry::{Hit, Ray, SurfacePoint};
use crate::light::{Light, Lights, NO_RIVAL};
use crate::machine::Type as MachineType;
use crate::machine::functions::{uvec2, vec3, vec4};
use crate::machine::generic::{length, normalize};
use crate::sampling::{Rng, Sampler, power_heuristic};
use crate::shading::{Scene, ShadingPoint};
use crate::volume::{Collision, henyey_greenstein, sample_henyey_greenstein};
use crate::{Type, kernel};

/// As [`path_with()`](super::path_with()), through a medium around and between the surfaces.
///
/// `collision` returns what light on a ray meets in the medium between `t_min` and `t_max`, at random:
/// of a [`Volume`](crate::volume::Volume) it is [`collision()`](crate::volume::collision()), of
/// [`Fog`](crate::volume::Fog) a method; of several media it is the closest. `transmittance` estimates
/// how much of the light passes, as [`ratio_transmittance()`](crate::volume::ratio_transmittance())
/// does; of several media it is the product. What a closure draws comes from the generator that it is
/// given: several media draw from it one after another, as numbers of their own. A collision counts as a
/// bounce. (Lafortune and Willems, "Rendering Participating Media with
/// Bidirectional Path Tracing", 1996, without paths from lights; Novák, Georgiev, Hanika and Jarosz,
/// "Monte Carlo Methods for Volumetric Light Transport Simulation", 2018.)
///
/// Where the first thing is a collision, the sample's albedo is that of the medium, its normal 0, its
/// depth that of the collision, and its alpha 1.
///
/// ```
/// use raydsl::bsdf::Lambert;
/// use raydsl::integrators::{PathLimits, PathOptions, volume_path};
/// use raydsl::light::{AnyLight, Environment, Lights};
/// use raydsl::prelude::*;
/// use raydsl::volume::{
///     Grid, GridConfig, TransferFunction, Volume, collision, ratio_transmittance,
/// };
///
/// // A cloud that absorbs nothing cannot be seen in a white furnace.
/// let grid = Grid::new(&[1.0f32; 8][..], uvec3(2, 2, 2), GridConfig::new())?;
/// let function = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 1.0)])?;
/// let cloud = Volume::new(&grid, function);
/// let nothing: &[Triangle] = &[];
/// let sky = Environment::constant(Vec3::ONE)?;
/// let none: [AnyLight; 0] = [];
/// let bounds = raydsl::geometry::Aabb { min: Vec3::ZERO, max: Vec3::ONE };
/// let lights = Lights::new(&none, bounds)?.with_environment(&sky);
/// let (limits, options) = (PathLimits::new(64), PathOptions::new());
/// let kernel = kernel!(|ray: Ray, sampler: Sampler| {
///     volume_path::<_, _, Lambert>(
///         nothing,
///         |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo },
///         |ray: Ray, rng: Rng| {
///             let mut rng = rng;
///             collision(&cloud, 0.5, ray, &mut rng)
///         },
///         |ray: Ray, rng: Rng| {
///             let mut rng = rng;
///             ratio_transmittance(&cloud, ray, &mut rng)
///         },
///         &lights,
///         host(options),
///         limits,
///         ray,
///         sampler,
///     )
///     .color
///     .x
/// });
/// let ray = Ray::new(vec3(0.3, 0.2, -1.0), Vec3::Z);
/// let path = |i| kernel.call((ray, Sampler::new(uvec2(0, 0), 0, i, 4096, SampleMethod::Sobol)));
/// let mean = (0..4096).map(path).sum::<f32>() / 4096.0;
/// assert!((mean - 1.0).abs() < 0.02, "{mean}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
// ANCHOR: trace
#[kernel]
#[expect(clippy::too_many_arguments, reason = "a closure each for what a scene may have")]
#[expect(clippy::collapsible_if, reason = "the outer one is decided before the kernel runs")]
pub fn volume_path<S: Scene + ?Sized, L: Light + MachineType, B: Bsdf + Material + MachineType>(
    scene: &S,
    surface: impl Fn(Hit, ShadingPoint) -> B,
    collision: impl Fn(Ray, Rng) -> Collision,
    transmittance: impl Fn(Ray, Rng) -> f32,
    lights: &Lights<'_, L>,
    #[host] options: PathOptions,
    limits: PathLimits,
    ray: Ray,
    sampler: Sampler,
) -> PathSample {
    let (mut ray, mut sampler) = (ray, sampler);
    let (mut radiance, mut throughput) = (vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0));
    let mut first = PathSample::nothing();
    let mut from = SurfacePoint { position: ray.origin, normal: NO_NORMAL, error: 0.0 };
    let mut pdf = NO_RIVAL;
    let seed = uvec2(sampler.key.x, sampler.index);
    let is_occluded = |ray: Ray| is_occluded::<S, B>(scene, &surface, options.masks, ray, seed);
    for bounce in 0..=limits.bounces {
        // Find what the path hits, and what it meets before that.
        let ahead = normalize(ray.direction);
        let hit = closest_surface::<S, B>(scene, &surface, options.masks, ray, seed);
        let end = if hit.is_hit { hit.t } else { ray.t_max };
        let before = ray.with_range(ray.t_min, end);
        let met: Collision = collision(before, Rng::new(seed, 2 * bounce, 0));
        if !hit.is_hit && !met.is_met {
            radiance += throughput * lights.missed(ahead, pdf);
            break;
        }

        // Add the light that it emits, and scatter light from a light, and to where the path goes.
        let is_last = bounce == limits.bounces;
        let mut next = Scattered::nowhere(from, ray);
        if met.is_met {
            if bounce == 0 {
                first = seen_in_medium(met, ray);
            }
            radiance += throughput * met.emission;
            if !is_last {
                next = in_medium::<L>(lights, is_occluded, options.lights, met, ray, &mut sampler);
            }
        } else {
            let seen = scene.shading_point(ray, hit);
            let material: B = surface(hit, seen);
            let at = scattering_at::<B>(seen, material, -ahead);
            if bounce == 0 {
                first = seen_first::<B>(at, hit.t * length(ray.direction));
            }
            radiance += throughput * lights.emitted(material.light(), at.point, from, ahead, pdf);
            if !is_last {
                next = on_surface::<L, B>(lights, is_occluded, options.lights, at, &mut sampler);
            }
        }
        if options.lights.has_samples() {
            if next.is_lit {
                let passed = transmittance(next.shadow, Rng::new(seed, 2 * bounce + 1, 0));
                radiance += throughput * next.light * passed;
            }
        }

        // Go on with the probability of what is left.
        throughput *= next.weight;
        let chance = if options.without_roulette {
            survival_of_all(throughput, &mut sampler)
        } else {
            survival(throughput, bounce, limits, &mut sampler)
        };
        if chance <= 0.0 {
            break;
        }
        throughput /= chance;
        (from, ray, pdf) = (next.point, next.ray, next.pdf);
    }
    first.color = vec4(radiance.x, radiance.y, radiance.z, first.color.w);
    first
}
// ANCHOR_END: trace

/// The normal of a point of a medium.
const NO_NORMAL: Vec3 = Vec3::ZERO;

/// How light goes on from a point: from one of the lights to the path, and where the path goes.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Scattered {
    /// Whether a light sends light here, along `shadow`.
    is_lit: bool,
    /// What of it is scattered to the path, if all of it passes.
    light: Vec3,
    /// The ray to that light.
    shadow: Ray,
    /// Factor of the light that the path brings.
    weight: Vec3,
    /// Density of its direction, against which light is weighted.
    pdf: f32,
    /// Its next ray, of unit length.
    ray: Ray,
    /// The point.
    point: SurfacePoint,
}

#[kernel]
impl Scattered {
    /// Returns no light.
    #[inline]
    fn nowhere(point: SurfacePoint, ray: Ray) -> Self {
        let none = vec3(0.0, 0.0, 0.0);
        Self { is_lit: false, light: none, shadow: ray, weight: none, pdf: 0.0, ray, point }
    }
}

/// Returns light that is scattered by a surface.
#[kernel]
fn on_surface<L: Light + MachineType, B: Bsdf + Material + MachineType>(
    lights: &Lights<'_, L>,
    is_occluded: impl Fn(Ray) -> bool,
    #[host] sampling: LightSampling,
    at: Scattering<B>,
    sampler: &mut Sampler,
) -> Scattered {
    let bsdf: B = at.bsdf;
    let (numbers, choice) = (next_3d(&mut *sampler), next_3d(&mut *sampler));
    let next: BsdfSample = bsdf.sample(at.wo, choice);
    let direction = at.frame.to_world(next.wi);
    let goes_on = at.frame.is_consistent(direction, next.wi);
    let mut scattered = Scattered {
        weight: if goes_on { next.weight } else { vec3(0.0, 0.0, 0.0) },
        pdf: hit_density(sampling, next.pdf, next.is_delta),
        ..Scattered::nowhere(at.point, at.point.ray(direction))
    };
    if sampling.has_samples() {
        let sample = lights.sample(at.point, numbers);
        scattered.light = scattered_light::<B>(is_occluded, sampling.is_weighted(), sample, at);
        scattered.is_lit = is_bright(scattered.light);
        scattered.shadow = sample.shadow_ray(at.point);
    }
    scattered
}

/// Returns light that is scattered by a medium, at a collision on a ray.
#[kernel]
fn in_medium<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    is_occluded: impl Fn(Ray) -> bool,
    #[host] sampling: LightSampling,
    met: Collision,
    ray: Ray,
    sampler: &mut Sampler,
) -> Scattered {
    let (ahead, g) = (normalize(ray.direction), met.anisotropy);
    let point = SurfacePoint { position: ray.at(met.t), normal: NO_NORMAL, error: 0.0 };
    let (numbers, choice) = (next_3d(&mut *sampler), next_3d(&mut *sampler));
    let direction = sample_henyey_greenstein(ahead, choice.xy(), g);
    let pdf = henyey_greenstein(ahead.dot(direction), g);
    let mut scattered = Scattered {
        weight: met.albedo,
        pdf: hit_density(sampling, pdf, false),
        ..Scattered::nowhere(point, Ray::new(point.position, direction))
    };
    if sampling.has_samples() {
        let sample = lights.sample(point, numbers);
        let phase = henyey_greenstein(ahead.dot(sample.wi), g);
        let rival = if sample.is_delta { 0.0 } else { phase };
        let mut weight = 1.0;
        if sampling.is_weighted() {
            weight = power_heuristic(1.0, sample.pdf, 1.0, rival);
        }
        let light = met.albedo * sample.light * phase;
        scattered.shadow = sample.shadow_ray(point);
        if sample.pdf > 0.0 && is_bright(light) {
            scattered.light = light * (weight / sample.pdf);
            scattered.is_lit = !is_occluded(scattered.shadow);
        }
    }
    scattered
}

/// Returns the sample of a ray that a medium scatters, before any light.
#[kernel]
#[inline]
fn seen_in_medium(met: Collision, ray: Ray) -> PathSample {
    let none = vec3(0.0, 0.0, 0.0);
    let depth = met.t * length(ray.direction);
    PathSample { color: vec4(0.0, 0.0, 0.0, 1.0), albedo: met.albedo, normal: none, depth }
}
