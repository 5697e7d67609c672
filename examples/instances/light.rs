//! What a ray sees of the forest.

use raydsl::kernel;
use raydsl::prelude::*;

use crate::forest::Facet;

/// Blue above, and bright where the sun stands.
#[kernel]
fn sky(direction: Vec3, sun: Vec3) -> Vec3 {
    let blue =
        vec3(0.8, 0.85, 0.88).lerp(vec3(0.26, 0.45, 0.75), clamp(2.2 * direction.y, 0.0, 1.0));
    let glow = max(direction.dot(sun), 0.0);
    blue + vec3(0.5, 0.35, 0.18) * pow(glow, 6.0)
}

/// A number from 0 to 1 for each instance.
#[kernel]
fn hashed(id: u32) -> f32 {
    let mixed = (id ^ (id >> 7)).wrapping_mul(0x9E37_79B9);
    ((mixed ^ (mixed >> 15)) >> 8) as f32 / 16_777_216.0
}

// ANCHOR: shade
/// The light along `ray`, whose direction has length 1.
#[kernel]
pub(crate) fn shade(scene: &Instances<'_, Facet>, sun: Vec3, ray: Ray) -> Shaded {
    let hit = scene.closest_hit(ray);
    if !hit.is_hit {
        return Shaded { color: sky(ray.direction, sun), depth: f32::MAX, id: 0xffff_ffffu32 };
    }
    let facet = scene.primitive(hit);
    // The triangle's normal is that of its own tree; shears make another of it.
    let local = scene.local_ray(ray, hit);
    let mut normal = scene.normal_in_scene(hit, facet.normal(local, hit));
    if normal.dot(ray.direction) > 0.0 {
        normal = -normal;
    }
    let leaf = facet.color[3].to_f32();
    let paint = vec3(facet.color[0].to_f32(), facet.color[1].to_f32(), facet.color[2].to_f32());
    // No two trees have the same green.
    let hue = (hashed(hit.inst_id) - 0.5) * leaf;
    let paint = paint * (1.0 + vec3(0.9, 0.35, -0.3) * hue);

    let at = ray.at(hit.t) + normal * 0.004;
    let mut light = vec3(0.4, 0.46, 0.55) * (0.7 + 0.3 * normal.y);
    if !scene.any_hit(Ray::new(at, sun)) {
        // Light goes through a leaf, too.
        let facing = normal.dot(sun);
        let lit = if facing > 0.0 { facing } else { -0.6 * facing * leaf };
        light += vec3(2.5, 2.2, 1.65) * lit;
    }
    let haze = 1.0 - exp(-0.0055 * hit.t);
    let color = (paint * light).lerp(sky(ray.direction, sun), haze);
    Shaded { color, depth: hit.t, id: hit.inst_id }
}
// ANCHOR_END: shade
