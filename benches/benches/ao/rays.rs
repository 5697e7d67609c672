//! The rays, which are the same for all systems.

use raydsl::camera::Camera;
use raydsl::kernel as kernel_fn;
use raydsl::prelude::*;
use raydsl::sampling::{pcg4d, unit_f32};
use raydsl_benches::contest::pixels;
use raydsl_benches::scenes;
use rayon::prelude::*;

/// Shadow rays from each hit.
pub(crate) const SAMPLES: u32 = 8;
/// Hits whose shadow rays stand together: the first ray of each, the second of each, and so on.
const GROUP: usize = 16;
/// Rays that are sorted among each other.
const SORTED: usize = 2048;
/// The end of short rays, as a share of the scene's diagonal.
const SHORT: f32 = 0.1;

/// Where shadow rays begin: a point, the normal there, and the pixel's number.
pub(crate) type Place = (Vec3, Vec3, u32);

/// What all systems are asked.
pub(crate) struct Workload {
    pub(crate) camera: Pinhole,
    pub(crate) size: u32,
    /// Rays of the camera, in blocks of pixels.
    pub(crate) primary: Vec<Ray>,
    /// These, with what they meet and the numbers of their pixels.
    pub(crate) hits: Vec<(Ray, Hit, u32)>,
    /// Where they meet something, in the same order.
    pub(crate) places: Vec<Place>,
    /// From there, without an end.
    pub(crate) shadow: Vec<Ray>,
    /// The same rays, sorted by direction within blocks.
    pub(crate) sorted: Vec<Ray>,
    /// Rays of both kinds: the camera's, and the first shadow ray of each place.
    pub(crate) single: Vec<Ray>,
    /// Where short rays end.
    pub(crate) short: f32,
    /// Of the scene.
    pub(crate) primitives: usize,
}

/// Ray `i` of a place: its direction is as likely as its cosine with the normal.
#[kernel_fn]
#[inline]
pub(crate) fn shadow_ray(origin: Vec3, frame: Frame, seed: u32, i: u32) -> Ray {
    let words = pcg4d(uvec4(seed, i, 0, 0));
    let u = vec2(unit_f32(words.x), unit_f32(words.y));
    Ray::new(origin, frame.to_world(sample_cosine_hemisphere(u)))
}

/// A number that all rays of a place have a part in.
#[kernel_fn]
#[inline]
pub(crate) fn sum_of_rays(origin: Vec3, normal: Vec3, seed: u32) -> f32 {
    let frame = Frame::around(normal);
    let mut sum = Vec3::ZERO;
    for i in 0..SAMPLES {
        let ray = shadow_ray(origin, frame, seed, i);
        sum += ray.origin + ray.direction;
    }
    sum.x + sum.y + sum.z
}

/// Where shadow rays begin that leave a hit, and the normal on their side.
#[kernel_fn]
#[inline]
pub(crate) fn place_of(triangle: Triangle, ray: Ray, hit: Hit) -> (Vec3, Vec3) {
    let point = facing(triangle.surface_point(ray, hit), ray.direction);
    (point.ray(point.normal).origin, point.normal)
}

impl Workload {
    /// The rays for a scene in the tree `bvh`.
    pub(crate) fn new(bvh: &Bvh<'_, Triangle>, camera: Pinhole, size: u32) -> Self {
        let rays = camera.begin_frame(size, size);
        let pixels = pixels(size);
        let ray = |&(x, y): &(u32, u32)| rays.primary_ray(x as f32 + 0.5, y as f32 + 0.5);
        let primary: Vec<Ray> = pixels.iter().map(ray).collect();
        let seen = |(ray, (x, y)): (&Ray, &(u32, u32))| (*ray, bvh.closest_hit(*ray), y * size + x);
        let hits: Vec<(Ray, Hit, u32)> = primary.par_iter().zip(&pixels).map(seen).collect();
        let place = |&(ray, hit, pixel): &(Ray, Hit, u32)| {
            hit.is_hit.then(|| {
                let (origin, normal) = place_of(bvh.primitive(hit), ray, hit);
                (origin, normal, pixel)
            })
        };
        let places: Vec<Place> = hits.iter().filter_map(place).collect();
        let shadow = shadow_rays(&places);
        let mut sorted = shadow.clone();
        sorted.par_chunks_mut(SORTED).for_each(|rays| rays.sort_by_key(direction_key));
        let first = places.iter().map(|p| shadow_ray(p.0, Frame::around(p.1), p.2, 0));
        let single = primary.iter().copied().chain(first).collect();
        let bounds = scenes::bounds(bvh.primitives());
        let short = SHORT * (bounds.max - bounds.min).length();
        let primitives = bvh.primitives().len();
        Self { camera, size, primary, hits, places, shadow, sorted, single, short, primitives }
    }
}

fn shadow_rays(places: &[Place]) -> Vec<Ray> {
    let of_group = |group: &[Place]| {
        let rays = (0..SAMPLES).flat_map(|i| {
            let ray = move |p: &Place| shadow_ray(p.0, Frame::around(p.1), p.2, i);
            group.iter().map(ray)
        });
        rays.collect::<Vec<Ray>>()
    };
    places.par_chunks(GROUP).flat_map_iter(of_group).collect()
}

/// Three bits of each axis, interleaved: where a direction lies on a Morton curve through the cube
/// that it points to, as the library sorts rays.
fn direction_key(ray: &Ray) -> u32 {
    let d = ray.direction / ray.direction.abs().max_element();
    let cells = ((d + 1.0) * 4.0).clamp(Vec3::ZERO, Vec3::splat(7.0));
    let spread = |x: f32| {
        let n = x as u32;
        (n & 1) | (n & 2) << 2 | (n & 4) << 4
    };
    spread(cells.x) | spread(cells.y) << 1 | spread(cells.z) << 2
}
