//! Ambient occlusion.

use glam::{Vec4, vec4};

use crate::bvh::RecordQuery;
use crate::geometry::{Ray, SurfacePoint};
use crate::kernel;
use crate::machine::functions::vec4;
use crate::sampling::{Frame, Sampler, sample_cosine_hemisphere};
use crate::shading::{Scene, facing};

// ANCHOR: ambient_occlusion
/// Tests whether a point is unoccluded up to the distance `radius`, in a cosine-distributed
/// direction chosen by the next two dimensions of the sampler. With a radius that is NaN, or not
/// above 0, every point is unoccluded.
#[kernel]
pub fn is_open<S: RecordQuery + ?Sized>(
    scene: &S,
    radius: f32,
    point: SurfacePoint,
    sampler: &mut Sampler,
) -> bool {
    let direction = sample_cosine_hemisphere(sampler.next_2d());
    let ray = point.ray(Frame::around(point.normal).to_world(direction));
    !scene.any_hit(Ray { t_max: radius, ..ray })
}

/// Estimates ambient occlusion at the closest hit of `ray` from `N` shadow rays: the share of them
/// that are unoccluded within `radius`, from black to white. Alpha is 1; all components are 0 where
/// the ray misses. The mean of many samples is the radiosity of a white diffuse surface under a
/// white sky.
///
/// The shadow rays are traced by one query, which is faster than one after the other, and share
/// their camera ray. Each takes the next two dimensions of the sampler, so those of one sample are
/// independent of each other: with [`SampleMethod::Sobol`](crate::sampling::SampleMethod::Sobol) and
/// [`SampleMethod::Stratified`](crate::sampling::SampleMethod::Stratified) the
/// same number of shadow rays from more samples, `N` of 1, are spread more evenly, and take longer.
/// `N` is at least 1.
///
/// (Zhukov, Iones and Kronin, "An Ambient Light Illumination Model", EGWR 1998, with a radius
/// instead of a falloff.)
#[kernel]
#[expect(clippy::needless_range_loop, reason = "kernels write elements by index")]
pub fn ambient_occlusion<S: Scene + ?Sized, const N: usize>(
    scene: &S,
    radius: f32,
    ray: Ray,
    sampler: Sampler,
) -> Vec4 {
    let hit = scene.closest_hit(ray);
    if !hit.is_hit {
        return vec4(0.0, 0.0, 0.0, 0.0);
    }
    let point = facing(scene.surface(ray, hit), ray.direction);
    let frame = Frame::around(point.normal);
    let mut sampler = sampler;
    let mut rays = [point.ray(point.normal); N];
    for i in 0..N {
        let direction = sample_cosine_hemisphere(sampler.next_2d());
        rays[i] = Ray { t_max: radius, ..point.ray(frame.to_world(direction)) };
    }
    let closed = scene.any_hit_each::<N>(|i: u32| rays[i as usize]);
    let mut open = 0.0;
    for is_closed in &closed {
        open += if *is_closed { 0.0 } else { 1.0 };
    }
    let light = open / N as f32;
    vec4(light, light, light, 1.0)
}
// ANCHOR_END: ambient_occlusion
