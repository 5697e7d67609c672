//! What a ray sees of the plant, in front of a wall.

use raydsl::kernel;
use raydsl::prelude::*;

use crate::plant::{Part, between_ribs};

// ANCHOR: queries
/// The closest hit where there is something. Each closure is asked about a triangle's hit, and says
/// whether the ray ends there.
#[kernel]
fn seen(plant: &Bvh<'_, Part>, #[host] masked: bool, ray: Ray) -> Hit {
    plant.closest_hit_where(ray, |hit: Hit| !masked || plant.primitive(hit).is_there(hit))
}

/// Whether something is between a point and a lamp: holes let light through.
#[kernel]
fn is_dark(plant: &Bvh<'_, Part>, #[host] masked: bool, ray: Ray) -> bool {
    plant.any_hit_where(ray, |hit: Hit| !masked || plant.primitive(hit).is_there(hit))
}
// ANCHOR_END: queries

/// Green with light ribs; brown; terracotta.
#[kernel]
fn paint(part: Part, hit: Hit) -> Vec3 {
    if part.kind != 0 {
        return if part.kind == 1 { vec3(0.3, 0.42, 0.16) } else { vec3(0.72, 0.34, 0.2) };
    }
    let st = part.st_at(hit);
    let middle = clamp(1.0 - 40.0 * st.y.abs(), 0.0, 1.0);
    let rib = clamp(1.0 - 8.0 * between_ribs(st), 0.0, 1.0);
    let green = vec3(0.1, 0.38, 0.13).lerp(vec3(0.22, 0.5, 0.14), st.x);
    green.lerp(vec3(0.45, 0.6, 0.28), 0.7 * max(middle, 0.5 * rib))
}

// ANCHOR: shade
/// The light along `ray`: of the plant, the wall behind it, or the table.
#[kernel]
pub(crate) fn shade(plant: &Bvh<'_, Part>, #[host] masked: bool, lamp: Vec3, ray: Ray) -> Shaded {
    let hit = seen(plant, masked, ray);
    let wall = (-1.25 - ray.origin.z) / ray.direction.z;
    let table = -ray.origin.y / ray.direction.y;
    let mut t = if table > 0.0 { min(wall, table) } else { wall };
    let mut normal = if t == wall { Vec3::Z } else { Vec3::Y };
    let mut color = if t == wall { vec3(0.78, 0.76, 0.72) } else { vec3(0.5, 0.36, 0.25) };
    let mut gloss = 0.0;
    let mut thin = 0.0;
    if hit.is_hit {
        let part = plant.primitive(hit);
        t = hit.t;
        normal = part.normal(ray, hit);
        normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
        color = paint(part, hit);
        gloss = if part.kind == 0 { 0.35 } else { 0.0 };
        thin = if part.kind == 0 { 0.5 } else { 0.0 };
    }
    let at = ray.at(t) + normal * 0.002;
    let to_lamp = lamp - at;
    let cosine = normal.dot(to_lamp) / to_lamp.length();
    let mut light = vec3(0.4, 0.44, 0.5) * (0.8 + 0.2 * normal.y);
    let mut shine = 0.0;
    if !is_dark(plant, masked, Ray::new(at, to_lamp).with_range(0.001, 1.0)) {
        let near = 19.0 / to_lamp.dot(to_lamp);
        light += vec3(1.0, 0.92, 0.78) * near * max(cosine, -thin * cosine);
        let mirrored = ray.direction.reflect(normal).normalize();
        shine = gloss * pow(max(mirrored.dot(to_lamp.normalize()), 0.0), 24.0);
    }
    Shaded { color: color * light + shine, depth: t, id: hit.prim_id }
}
// ANCHOR_END: shade
