//! What a ray sees of spheres over a chequered floor.

use raydsl::kernel;
use raydsl::prelude::*;

use crate::figure::Ball;

#[kernel]
impl Ball {
    /// Its colour.
    fn rgb(&self) -> Vec3 {
        vec3(self.color[0].to_f32(), self.color[1].to_f32(), self.color[2].to_f32())
    }
}

/// Blue, brighter towards the horizon.
#[kernel]
fn sky(direction: Vec3) -> Vec3 {
    let up = clamp(direction.y / direction.length(), 0.0, 1.0).sqrt();
    vec3(0.72, 0.82, 1.0).lerp(vec3(0.1, 0.2, 0.78), up)
}

/// Squares of two colours, which become one far away.
#[kernel]
fn floor_color(at: Vec3, distance: f32) -> Vec3 {
    let square = at.x.floor() as i32 + at.z.floor() as i32;
    let (yellow, green) = (vec3(0.95, 0.9, 0.12), vec3(0.08, 0.55, 0.14));
    let near = if square & 1 == 0 { yellow } else { green };
    near.lerp((yellow + green) * 0.5, clamp((distance - 6.0) / 40.0, 0.0, 1.0))
}

// ANCHOR: shade
/// The light that comes along `ray`: of what it meets, and of what is mirrored there.
#[kernel]
pub(crate) fn shade(scene: &Bvh<'_, Ball>, sun: Vec3, ray: Ray) -> Shaded {
    let mut way = ray;
    let mut share = 1.0;
    let mut color = Vec3::ZERO;
    let mut first = Shaded { color, depth: f32::MAX, id: 0xffff_ffffu32 };
    for bounce in 0..2u32 {
        let hit = scene.closest_hit(way);
        let down = -way.origin.y / way.direction.y;
        let is_floor = !hit.is_hit && down > 0.0;
        if !(hit.is_hit || is_floor) {
            color += sky(way.direction) * share;
            break;
        }
        let t = if is_floor { down } else { hit.t };
        let mut normal = Vec3::Y;
        let mut paint = floor_color(way.at(t), t);
        let mut mirror = 0.0;
        if hit.is_hit {
            let ball = scene.primitive(hit);
            normal = ball.normal(way, hit);
            paint = ball.rgb();
            mirror = ball.mirror.to_f32();
        }
        if bounce == 0 {
            first =
                Shaded { color, depth: t, id: if is_floor { 0xffff_fffeu32 } else { hit.prim_id } };
        }
        let at = way.at(t) + normal * 0.001;
        let mirrored = way.direction.reflect(normal);
        let mut light = Vec3::splat(0.28 + 0.12 * normal.y);
        let mut gloss = 0.0;
        if normal.dot(sun) > 0.0 && !scene.any_hit(Ray::new(at, sun)) {
            light += vec3(0.8, 0.77, 0.7) * normal.dot(sun);
            let shine = max(mirrored.normalize().dot(sun), 0.0);
            gloss = if is_floor { 0.0 } else { pow(shine, 60.0) * (0.3 + mirror) };
        }
        // Far away, the floor has the colour of the horizon.
        let haze = if is_floor { 1.0 - exp(-0.012 * t) } else { 0.0 };
        let own = (paint * light * (1.0 - mirror)).lerp(sky(way.direction), haze);
        color += (own + gloss) * share;
        // The second round is for mirrors only.
        share *= mirror;
        if share == 0.0 {
            break;
        }
        way = Ray::new(at, mirrored);
    }
    Shaded { color, ..first }
}
// ANCHOR_END: shade
