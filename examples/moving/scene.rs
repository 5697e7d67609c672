//! Beads that circle in the smoke, and the picture of both.

use std::f32::consts::TAU;

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::volume::{Cut, ShadedCell, Volume, VolumeLight};

/// A bead. The first one is large, and clears the smoke around it.
#[primitive(sphere(center, radius))]
#[derive(Debug)]
pub(crate) struct Bead {
    pub(crate) center: Vec3,
    pub(crate) radius: f32,
    pub(crate) color: Vec3,
}

#[kernel]
impl Surface for Bead {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        self.color
    }
}

/// Beads in the swarm.
const COUNT: u32 = 90;

/// The swarm, with `phase` from 0 to 1 around its course.
pub(crate) fn beads(phase: f32) -> Vec<Bead> {
    let large = TAU * (phase + 0.2);
    let first = Bead {
        center: vec3(0.42 * large.cos(), 0.4 + 0.3 * large.cos(), 0.42 * large.sin()),
        radius: 0.14,
        color: vec3(0.85, 0.86, 0.9),
    };
    let bead = |i: u32| {
        let t = TAU * (i as f32 / COUNT as f32 + phase);
        let wobble = (i as f32 * 2.4).sin();
        let radius = 0.78 + 0.34 * (3.0 * t).cos() + 0.07 * wobble;
        let height = 0.35 + 0.55 * (2.0 * t).sin() + 0.08 * (i as f32 * 1.7).cos();
        let hue = i as f32 / COUNT as f32 * TAU;
        let tint = vec3(hue.sin(), (hue + 2.1).sin(), (hue + 4.2).sin());
        Bead {
            center: vec3(radius * t.cos(), height, radius * t.sin()),
            radius: 0.045 + 0.02 * wobble,
            color: vec3(0.5, 0.55, 0.6) + 0.36 * tint,
        }
    };
    std::iter::once(first).chain((0..COUNT).map(bead)).collect()
}

/// What is cut out of the smoke: a ball around the first bead, which follows it.
pub(crate) fn hollow(beads: &[Bead]) -> Vec<Bead> {
    beads.iter().take(1).map(|first| Bead { radius: 0.36, ..*first }).collect()
}

/// Height of the floor.
const FLOOR: f32 = -0.8;

/// Direction to the sun.
pub(crate) const SUN: Vec3 = vec3(0.55, 0.75, 0.37);

/// What no bead and no floor hides.
#[kernel]
fn sky(direction: Vec3) -> Vec3 {
    let up = clamp(direction.y * 1.4 + 0.25, 0.0, 1.0);
    vec3(0.50, 0.56, 0.66) * (1.0 - up) + vec3(0.14, 0.2, 0.34) * up
}

// ANCHOR: light
/// Light along a ray through smoke with a hollow.
#[kernel]
fn through(volume: &Volume<'_, u8>, hollow: &[Bead], method: ShadedCell, ray: Ray) -> VolumeLight {
    let mut light = VolumeLight::new();
    let mut cut = Cut::new(hollow, ray);
    while let Some(part) = cut.next_outside(hollow) {
        light = volume.integrate(&method, part, light);
    }
    light
}
// ANCHOR_END: light

/// Sunlight that comes to a point: beads hide it, smoke dims it.
#[kernel]
fn sunlight(
    bvh: &Bvh<'_, Bead>,
    volume: &Volume<'_, u8>,
    hollow: &[Bead],
    method: ShadedCell,
    from: Vec3,
) -> f32 {
    let ray = Ray::new(from, SUN).with_range(0.002, 10.0);
    if bvh.any_hit(ray) {
        return 0.0;
    }
    1.0 - through(volume, hollow, method, ray).opacity()
}

/// Light of a matte surface, with a highlight where it shines.
#[kernel]
fn lit(color: Vec3, normal: Vec3, direction: Vec3, sun: f32, shine: f32) -> Vec3 {
    let facing = max(normal.dot(SUN), 0.0);
    let ambient = 0.38 + 0.2 * normal.y;
    let half = (SUN - direction).normalize();
    let highlight = shine * pow(max(normal.dot(half), 0.0), 60.0);
    color * (ambient + 0.85 * facing * sun) + Vec3::ONE * (highlight * sun)
}

// ANCHOR: order
/// The picture: the nearest surface ends the ray, and the smoke in front is over it.
#[kernel]
pub(crate) fn seen(
    bvh: &Bvh<'_, Bead>,
    volume: &Volume<'_, u8>,
    hollow: &[Bead],
    method: ShadedCell,
    ray: Ray,
) -> Shaded {
    let hit = bvh.closest_hit(ray);
    let mut end = ray.t_max;
    let mut behind = sky(ray.direction);
    let down = (FLOOR - ray.origin.y) / ray.direction.y;
    if hit.is_hit {
        let bead = bvh.primitive(hit);
        let normal = bead.normal(ray, hit);
        let place = ray.at(hit.t) + normal * 0.002;
        let sun = sunlight(bvh, volume, hollow, method, place);
        behind = lit(bead.color, normal, ray.direction, sun, 0.6);
        end = hit.t;
    } else if ray.direction.y < 0.0 {
        let place = ray.at(down);
        let sun = sunlight(bvh, volume, hollow, method, place);
        let near = exp(-0.035 * place.dot(place));
        let floor = lit(vec3(0.52, 0.5, 0.48), vec3(0.0, 1.0, 0.0), ray.direction, sun, 0.0);
        behind = floor * near + behind * (1.0 - near);
        end = down;
    }
    let light = through(volume, hollow, method, ray.with_range(ray.t_min, end));
    Shaded { color: light.over(behind), depth: end, id: hit.prim_id }
}
// ANCHOR_END: order
