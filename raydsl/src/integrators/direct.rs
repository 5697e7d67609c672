//! Direct light on diffuse surfaces.

use core::f32::consts::FRAC_1_PI;

use glam::{Vec3, Vec4, vec4};

use super::{DirectionalLight, Light, PointLight};
use crate::bvh::RecordQuery;
use crate::geometry::{Ray, SurfacePoint};
use crate::kernel;
use crate::machine::Type;
use crate::machine::functions::vec4;
use crate::shading::{Scene, facing};

// ANCHOR: direct_light
/// Sums the irradiance at a point from all of `lights`.
///
/// Shadow rays are traced only where `shadows` is true.
#[kernel]
pub fn irradiance<S: RecordQuery + ?Sized, L: Light + Type>(
    scene: &S,
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

/// Returns the radiance along `ray` from its closest hit, a two-sided Lambertian surface under the
/// point lights `lamps` and the directional lights `suns` (Lambert, "Photometria", 1760). Alpha is
/// 1; all components are 0 where the ray misses.
#[kernel]
pub fn direct_light<S: Scene + ?Sized>(
    scene: &S,
    lamps: &[PointLight],
    suns: &[DirectionalLight],
    #[host] shadows: bool,
    ray: Ray,
) -> Vec4 {
    let hit = scene.closest_hit(ray);
    if !hit.is_hit {
        return vec4(0.0, 0.0, 0.0, 0.0);
    }
    let seen = scene.shading_point(ray, hit);
    let point = facing(seen.point, ray.direction);
    let falling =
        irradiance(scene, lamps, shadows, point) + irradiance(scene, suns, shadows, point);
    let color = seen.albedo * falling * FRAC_1_PI;
    vec4(color.x, color.y, color.z, 1.0)
}
// ANCHOR_END: direct_light
