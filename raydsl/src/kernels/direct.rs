//! What is seen of matt surfaces under lights.

use core::f32::consts::FRAC_1_PI;

use glam::{Vec3, Vec4, vec4};

use super::{DirectionalLight, Light, PointLight, Surface, facing};
use crate::bvh::{Bvh, RayQuery};
use crate::geometry::{Hit, Primitive, Ray, SurfacePoint};
use crate::kernel;
use crate::machine::Type;
use crate::machine::functions::vec4;

// ANCHOR: direct_light
/// The light that falls on a point from all of `lights`, for each unit of its area.
///
/// Only where `shadows` is true are rays sent to see what is between.
#[kernel]
pub fn irradiance<P: Primitive, L: Light + Type>(
    scene: &Bvh<'_, P>,
    lights: &[L],
    #[host] shadows: bool,
    point: SurfacePoint,
) -> Vec3 {
    let mut sum = Vec3::ZERO;
    for light in lights {
        let light: L = *light;
        let arriving = light.falling_on(point);
        let is_lit = arriving.x + arriving.y + arriving.z > 0.0;
        if is_lit && !(shadows && scene.any_hit(light.shadow_ray(point))) {
            sum += arriving;
        }
    }
    sum
}

/// The radiance along `ray` of what it meets first: a surface that sends the light of `lamps` and
/// `suns` back evenly in all directions (Lambert, "Photometria", 1760), on both of its sides. Alpha
/// is 1, or all is 0 where nothing is met.
#[kernel]
pub fn direct_light<P: Primitive<Hit = Hit> + Surface>(
    scene: &Bvh<'_, P>,
    lamps: &[PointLight],
    suns: &[DirectionalLight],
    #[host] shadows: bool,
    ray: Ray,
) -> Vec4 {
    let hit = scene.closest_hit(ray);
    if !hit.is_hit {
        return vec4(0.0, 0.0, 0.0, 0.0);
    }
    let prim: P = scene.primitive(hit);
    let point = facing(prim.surface(ray, hit), ray.direction);
    let falling =
        irradiance(scene, lamps, shadows, point) + irradiance(scene, suns, shadows, point);
    let color = prim.albedo(ray, hit) * falling * FRAC_1_PI;
    vec4(color.x, color.y, color.z, 1.0)
}
// ANCHOR_END: direct_light
