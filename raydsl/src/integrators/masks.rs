//! Surfaces with holes, and half-transparent ones: each ray meets them with a probability.

use glam::{UVec2, uvec4};

use crate::bsdf::{Bsdf, Material};
use crate::geometry::{Hit, Ray};
use crate::kernel;
use crate::machine::Type as MachineType;
use crate::machine::functions::uvec4;
use crate::sampling::{pcg4d, unit_f32};
use crate::shading::{Scene, ShadingPoint};

/// Returns whether a ray meets a surface of this opacity at a hit. Rays of other seeds, and other
/// hits, have independent outcomes.
#[kernel]
#[inline]
fn is_met(opacity: f32, hit: Hit, seed: UVec2) -> bool {
    let place = hit.prim_id ^ hit.inst_id.rotate_left(16);
    let words = pcg4d(uvec4(place, hit.t.to_bits(), seed.x, seed.y));
    opacity >= 1.0 || unit_f32(words.x) < opacity
}

/// Returns the closest hit of a ray. Where `masks` is true, materials whose opacity is below 1 are
/// met with that probability, and passed otherwise.
#[kernel]
pub fn closest_surface<S: Scene + ?Sized, B: Bsdf + Material + MachineType>(
    scene: &S,
    surface: impl Fn(Hit, ShadingPoint) -> B,
    #[host] masks: bool,
    ray: Ray,
    seed: UVec2,
) -> Hit {
    if masks {
        return scene.closest_hit_where(ray, |hit: Hit| {
            let material: B = surface(hit, scene.shading_point(ray, hit));
            is_met(material.opacity(), hit, seed)
        });
    }
    scene.closest_hit(ray)
}

/// Returns whether anything occludes a ray, as [`closest_surface()`] meets it.
#[kernel]
pub fn is_occluded<S: Scene + ?Sized, B: Bsdf + Material + MachineType>(
    scene: &S,
    surface: impl Fn(Hit, ShadingPoint) -> B,
    #[host] masks: bool,
    ray: Ray,
    seed: UVec2,
) -> bool {
    if masks {
        return scene.any_hit_where(ray, |hit: Hit| {
            let material: B = surface(hit, scene.shading_point(ray, hit));
            is_met(material.opacity(), hit, seed)
        });
    }
    scene.any_hit(ray)
}
