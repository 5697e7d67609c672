//! How much of its surroundings a point sees.

use glam::{Vec4, vec4};

use super::{Surface, facing};
use crate::bvh::{Bvh, RayQuery};
use crate::geometry::{Hit, Primitive, Ray, SurfacePoint};
use crate::kernel;
use crate::machine::functions::vec4;
use crate::sampling::{Frame, SampleMethod, Sampler, sample_cosine_hemisphere};

// ANCHOR: ambient_occlusion
/// Whether nothing is near a point, up to the distance `radius`, in a direction that is likely as
/// its cosine with the normal. The next two dimensions of the sampler choose it. A radius that is
/// no number, or not above 0, leaves everything open.
#[kernel]
pub fn is_open<P: Primitive>(
    scene: &Bvh<'_, P>,
    radius: f32,
    #[host] method: SampleMethod,
    point: SurfacePoint,
    sampler: &mut Sampler,
) -> bool {
    let direction = sample_cosine_hemisphere(sampler.next_2d(method));
    let ray = point.ray(Frame::around(point.normal).to_world(direction));
    !scene.any_hit(Ray { t_max: radius, ..ray })
}

/// Ambient occlusion where `ray` meets the scene, by `N` directions: the share of them in which
/// nothing is nearer than `radius`, from black to white; alpha is 1, or all is 0 where nothing is
/// met. The mean of many samples is the light that a matt white surface has from surroundings that
/// are white everywhere.
///
/// The directions are asked about together, which is quicker than one after the other, and share
/// their camera ray. Each takes the next two dimensions of the sampler, so those of a sample are
/// independent of each other: with [`SampleMethod::Sobol`] and [`SampleMethod::Stratified`] as many
/// rays of as many samples, `N` of 1, are spread more evenly, and take longer. `N` is at least 1.
///
/// (Zhukov, Iones and Kronin, "An Ambient Light Illumination Model", EGWR 1998, with a radius
/// instead of a falloff.)
#[kernel]
#[expect(clippy::needless_range_loop, reason = "kernels write elements by their numbers")]
pub fn ambient_occlusion<P: Primitive<Hit = Hit> + Surface, const N: usize>(
    scene: &Bvh<'_, P>,
    radius: f32,
    #[host] method: SampleMethod,
    ray: Ray,
    sampler: Sampler,
) -> Vec4 {
    let hit = scene.closest_hit(ray);
    if !hit.is_hit {
        return vec4(0.0, 0.0, 0.0, 0.0);
    }
    let prim: P = scene.primitive(hit);
    let point = facing(prim.surface(ray, hit), ray.direction);
    let frame = Frame::around(point.normal);
    let mut sampler = sampler;
    let mut rays = [point.ray(point.normal); N];
    for i in 0..N {
        let direction = sample_cosine_hemisphere(sampler.next_2d(method));
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
