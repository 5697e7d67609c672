//! What rays see: leaves with masks, a mirror, and the shadows of a lamp.

use raydsl::camera::MatrixRays;
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::render::Fragment;

use crate::plant::{Part, between_ribs};

/// The number of what mirrors, beside those of leaves, stems and pots.
pub(crate) const MIRROR: u32 = 3;

// ANCHOR: queries
/// The closest hit of the plant, where a leaf's mask leaves something.
#[kernel]
fn seen(plant: &Bvh<'_, Part>, ray: Ray) -> Hit {
    plant.closest_hit_where(ray, |hit: Hit| plant.primitive(hit).is_there(hit))
}

/// Whether anything is between a point and the lamp, rasterised or not; holes let light through.
#[kernel]
fn is_dark(plant: &Bvh<'_, Part>, drawn: &Bvh<'_, Triangle>, at: Vec3, lamp: Vec3) -> bool {
    let ray = Ray::new(at, lamp - at).with_range(0.001, 1.0);
    drawn.any_hit(ray) || plant.any_hit_where(ray, |hit: Hit| plant.primitive(hit).is_there(hit))
}
// ANCHOR_END: queries

/// How much of a rasterised point's light is left in the shadow.
const IN_SHADOW: f32 = 0.4;

/// Green with light ribs; brown; terracotta.
#[kernel]
fn paint(part: Part, hit: Hit) -> Vec3 {
    if part.kind != 0 {
        return if part.kind == 1 { vec3(0.3, 0.42, 0.16) } else { vec3(0.72, 0.34, 0.2) };
    }
    let st = part.st_at(hit);
    let rib = clamp(1.0 - 8.0 * between_ribs(st), 0.0, 1.0);
    vec3(0.12, 0.42, 0.14).lerp(vec3(0.45, 0.6, 0.28), 0.4 * rib)
}

/// The light of a hit of the plant.
#[kernel]
fn lit(plant: &Bvh<'_, Part>, drawn: &Bvh<'_, Triangle>, lamp: Vec3, ray: Ray, hit: Hit) -> Vec3 {
    let part = plant.primitive(hit);
    let mut normal = part.normal(ray, hit);
    normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
    let at = ray.at(hit.t) + normal * 0.002;
    let to_lamp = lamp - at;
    let cosine = normal.dot(to_lamp) / to_lamp.length();
    // Leaves let half of the light through.
    let thin = if part.kind == 0 { 0.5 } else { 0.0 };
    let mut light = vec3(0.34, 0.37, 0.42) * (0.8 + 0.2 * normal.y);
    if !is_dark(plant, drawn, at, lamp) {
        light +=
            vec3(1.0, 0.92, 0.78) * (19.0 / to_lamp.dot(to_lamp)) * max(cosine, -thin * cosine);
    }
    paint(part, hit) * light
}

/// What is behind everything.
#[kernel]
pub(crate) fn behind(direction: Vec3) -> Vec3 {
    vec3(0.05, 0.06, 0.08).lerp(vec3(0.2, 0.24, 0.3), clamp(0.5 + direction.y, 0.0, 1.0))
}

/// The light along a ray that leaves the mirror: there the rasterised triangles are met by rays.
#[kernel]
fn mirrored(
    plant: &Bvh<'_, Part>,
    drawn: &Bvh<'_, Triangle>,
    colors: &[Vec3],
    lamp: Vec3,
    ray: Ray,
) -> Vec3 {
    let near = drawn.closest_hit(ray);
    let end = if near.is_hit { near.t } else { ray.t_max };
    let hit = seen(plant, ray.with_range(ray.t_min, end));
    let mut color = behind(ray.direction);
    if hit.is_hit {
        color = lit(plant, drawn, lamp, ray, hit);
    } else if near.is_hit {
        let at = ray.at(near.t) - ray.direction * 0.002;
        color = colors[near.prim_id as usize];
        color = if is_dark(plant, drawn, at, lamp) { color * IN_SHADOW } else { color };
    }
    color
}

// ANCHOR: traced
/// What a ray adds to a pixel of the rasteriser, which has `before`: the plant in front of it, or the
/// shadow on it, or what is behind all.
#[kernel]
pub(crate) fn traced(
    plant: &Bvh<'_, Part>,
    drawn: &Bvh<'_, Triangle>,
    colors: &[Vec3],
    lamp: Vec3,
    window: MatrixRays,
    before: Fragment,
    ray: Ray,
) -> Fragment {
    // The rasteriser's depth cuts the ray.
    let is_drawn = before.depth < 1.0;
    let end = if is_drawn { window.distance_at_depth(ray, before.depth) } else { ray.t_max };
    let hit = seen(plant, ray.with_range(ray.t_min, end));
    let mut color = behind(ray.direction);
    let mut alpha = 1.0;
    let mut depth = 1.0;
    if hit.is_hit {
        let part = plant.primitive(hit);
        if part.kind == MIRROR {
            let normal = part.normal(ray, hit);
            let at = ray.at(hit.t);
            let away = ray.direction.reflect(normal);
            let rest = Ray::new(at, away).with_range(0.002, f32::MAX);
            color = mirrored(plant, drawn, colors, lamp, rest) * vec3(0.86, 0.9, 0.92);
        } else {
            color = lit(plant, drawn, lamp, ray, hit);
        }
        depth = window.window_depth(ray.at(hit.t));
    } else if is_drawn {
        // A shadow is black on what is there, as deep as that.
        let at = ray.at(end) - ray.direction * 0.002;
        color = vec3(0.0, 0.0, 0.0);
        alpha = if is_dark(plant, drawn, at, lamp) { 1.0 - IN_SHADOW } else { 0.0 };
        depth = before.depth;
    }
    Fragment { color: vec4(color.x, color.y, color.z, alpha), depth }
}
// ANCHOR_END: traced
