//! Direct light: from lights to the eye by one surface, and by mirrors and glass in front of it.

use glam::{Vec3, Vec4, vec3, vec4};

use crate::bsdf::{Bsdf, BsdfSample, Material, ShadingFrame};
use crate::geometry::{Hit, Ray, SurfacePoint};
use crate::light::{Light, LightSample, Lights, NO_RIVAL};
use crate::machine::Type as MachineType;
use crate::machine::functions::{vec3, vec4};
use crate::machine::generic::normalize;
use crate::sampling::{Sampler, power_heuristic};
use crate::shading::{Scene, ShadingPoint};
use crate::{Type, kernel};

/// A point of a surface as light is scattered there, seen from a direction.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Scattering<B: Bsdf + MachineType> {
    /// How the surface scatters light.
    pub bsdf: B,
    /// Its frame.
    pub frame: ShadingFrame,
    /// The point.
    pub point: SurfacePoint,
    /// Unit vector to the viewer, in the frame.
    pub wo: Vec3,
}

/// Returns whether any component is above 0.
#[kernel]
#[inline]
pub(super) fn is_bright(color: Vec3) -> bool {
    color.x > 0.0 || color.y > 0.0 || color.z > 0.0
}

// ANCHOR: scattered_light
/// Returns the light of a sample that is scattered to the viewer, 0 in the shadow. It is weighted by
/// the power heuristic against samples of the BSDF, if those are taken too: where `is_weighted`.
///
/// `is_occluded` is asked for shadow rays, of directions from which light would be scattered.
#[kernel]
pub fn scattered_light<B: Bsdf + MachineType>(
    is_occluded: impl Fn(Ray) -> bool,
    #[host] is_weighted: bool,
    light: LightSample,
    at: Scattering<B>,
) -> Vec3 {
    let bsdf: B = at.bsdf;
    let wi = at.frame.to_local(light.wi);
    let is_lit = light.pdf > 0.0 && is_bright(light.light);
    if !(is_lit && at.frame.is_consistent(light.wi, wi)) {
        return vec3(0.0, 0.0, 0.0);
    }
    let scattered = bsdf.eval(at.wo, wi) * light.light;
    if !is_bright(scattered) || is_occluded(light.shadow_ray(at.point)) {
        return vec3(0.0, 0.0, 0.0);
    }
    let mut weight = 1.0;
    if is_weighted {
        let rival = if light.is_delta { 0.0 } else { bsdf.pdf(at.wo, wi) };
        weight = power_heuristic(1.0, light.pdf, 1.0, rival);
    }
    scattered * (weight / light.pdf)
}
// ANCHOR_END: scattered_light

// ANCHOR: from_each_light
/// Returns the light from every light that is scattered to the viewer, by one sample of each.
#[kernel]
pub fn from_each_light<S: Scene + ?Sized, L: Light + MachineType, B: Bsdf + MachineType>(
    scene: &S,
    lights: &Lights<'_, L>,
    #[host] shadows: bool,
    at: Scattering<B>,
    sampler: &mut Sampler,
) -> Vec3 {
    let is_occluded = |ray: Ray| shadows && scene.any_hit(ray);
    let mut sum = vec3(0.0, 0.0, 0.0);
    for i in 0..lights.count() {
        let light = lights.sample_light(i, at.point, sampler.next_2d());
        sum += scattered_light::<B>(is_occluded, false, light, at);
    }
    if lights.has_environment() {
        let light = lights.sample_environment(sampler.next_2d());
        sum += scattered_light::<B>(is_occluded, false, light, at);
    }
    sum
}
// ANCHOR_END: from_each_light

/// Returns the scattering at a hit, seen from the direction `to_viewer`, of unit length.
#[kernel]
#[inline]
pub fn scattering_at<B: Bsdf + Material + MachineType>(
    seen: ShadingPoint,
    material: B,
    to_viewer: Vec3,
) -> Scattering<B> {
    let frame = ShadingFrame::new(seen, material.normal(), to_viewer);
    let wo = frame.to_local(to_viewer);
    Scattering::<B> { bsdf: material, frame, point: seen.point, wo }
}

// ANCHOR: whitted
/// Returns the radiance along `ray`: direct light at the first surface that is neither mirror nor
/// smooth glass, seen by up to `bounces` of those. Of the two ways at glass, one is chosen at random.
/// Alpha is 0 where the ray misses.
///
/// `surface` returns the material of a hit. Without bounces it is plain direct light. Shadow rays are
/// traced only where `shadows` is true. (Whitted, "An Improved Illumination Model for Shaded
/// Display", 1980; Cook, Porter and Carpenter, "Distributed Ray Tracing", 1984.)
#[kernel]
pub fn whitted<S: Scene + ?Sized, L: Light + MachineType, B: Bsdf + Material + MachineType>(
    scene: &S,
    surface: impl Fn(Hit, ShadingPoint) -> B,
    lights: &Lights<'_, L>,
    #[host] shadows: bool,
    #[host] bounces: u32,
    ray: Ray,
    sampler: Sampler,
) -> Vec4 {
    let (mut ray, mut sampler) = (ray, sampler);
    let mut ahead = normalize(ray.direction);
    let (mut radiance, mut throughput) = (vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0));
    let mut from = SurfacePoint { position: ray.origin, normal: ahead, error: 0.0 };
    let mut alpha = 1.0;
    for bounce in 0..=bounces {
        let hit = scene.closest_hit(ray);
        if !hit.is_hit {
            radiance += throughput * lights.missed(ahead, NO_RIVAL);
            alpha = if bounce == 0 { 0.0 } else { alpha };
            break;
        }
        let seen = scene.shading_point(ray, hit);
        let material: B = surface(hit, seen);
        let light = material.light();
        radiance += throughput * lights.emitted(light, seen.point, from, ahead, NO_RIVAL);
        let at = scattering_at::<B>(seen, material, -ahead);
        let direct = from_each_light::<S, L, B>(scene, lights, shadows, at, &mut sampler);
        radiance += throughput * direct;
        // What is no mirror has its light already.
        let next: BsdfSample = material.sample(at.wo, next_3d(&mut sampler));
        let direction = at.frame.to_world(next.wi);
        if !(next.is_delta && at.frame.is_consistent(direction, next.wi)) {
            break;
        }
        throughput *= next.weight;
        (from, ahead) = (seen.point, direction);
        ray = seen.point.ray(direction);
    }
    vec4(radiance.x, radiance.y, radiance.z, alpha)
}
// ANCHOR_END: whitted

// ANCHOR: direct_light
/// Returns the radiance along `ray` from its closest hit, by one sample of each light: [`whitted()`]
/// without bounces.
#[kernel]
pub fn direct_light<S: Scene + ?Sized, L: Light + MachineType, B: Bsdf + Material + MachineType>(
    scene: &S,
    surface: impl Fn(Hit, ShadingPoint) -> B,
    lights: &Lights<'_, L>,
    #[host] shadows: bool,
    ray: Ray,
    sampler: Sampler,
) -> Vec4 {
    #[host]
    let bounces = 0u32;
    whitted::<S, L, B>(scene, surface, lights, shadows, bounces, ray, sampler)
}
// ANCHOR_END: direct_light

/// Returns three numbers of a sampler.
#[kernel]
#[inline]
pub fn next_3d(sampler: &mut Sampler) -> Vec3 {
    let (square, third) = (sampler.next_2d(), sampler.next_1d());
    vec3(square.x, square.y, third)
}
