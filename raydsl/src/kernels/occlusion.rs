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

/// One sample of ambient occlusion where `ray` meets the scene: white where a point is open, black
/// where something is nearer than `radius`; alpha is 1, or all is 0 where nothing is met. The mean
/// of many is the light that a matt white surface has from surroundings that are white everywhere.
///
/// (Zhukov, Iones and Kronin, "An Ambient Light Illumination Model", EGWR 1998, with a radius
/// instead of a falloff.)
#[kernel]
pub fn ambient_occlusion<P: Primitive<Hit = Hit> + Surface>(
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
    let mut sampler = sampler;
    let light = if is_open(scene, radius, method, point, &mut sampler) { 1.0 } else { 0.0 };
    vec4(light, light, light, 1.0)
}
// ANCHOR_END: ambient_occlusion
