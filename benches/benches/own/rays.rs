//! The rays, which are made once and are the same for all systems.

use raydsl::camera::Camera;
use raydsl::geometry::HitRecord;
use raydsl::prelude::*;
use raydsl::sampling::{pcg4d, unit_f32};
use raydsl_benches::contest::pixels;
use rayon::prelude::*;

use crate::shapes::Shape;

/// Shadow rays from each hit.
pub(crate) const SAMPLES: u32 = 8;
/// Hits whose shadow rays stand together: the first ray of each, the second of each, and so on.
pub(crate) const GROUP: u32 = 16;
/// Hits next to each other of which all have shadow rays or none: a gang of the library.
const BLOCK: usize = 64;
/// The end of shadow rays, as a share of the scene's diagonal.
const SHORT: f32 = 0.1;
/// How far above their surface they begin, likewise.
const ABOVE: f32 = 1e-5;

/// What all systems are asked.
pub(crate) struct Workload<R> {
    /// Rays of the camera, in blocks of pixels.
    pub(crate) primary: Vec<Ray>,
    /// What these hit.
    pub(crate) hits: Vec<R>,
    /// Eight shadow rays of every so many blocks of hits, so that there are at most as many as camera
    /// rays. They end after [`Workload::short`].
    pub(crate) shadow: Vec<Ray>,
    /// Where shadow rays end.
    pub(crate) short: f32,
}

impl<R: HitRecord> Workload<R> {
    /// The rays for a scene in the tree `bvh`.
    pub(crate) fn new<P: Shape<Hit = R>>(bvh: &Bvh<'_, P>, camera: &Pinhole, size: u32) -> Self {
        let rays = camera.begin_frame(size, size);
        let pixels = pixels(size);
        let ray = |&(x, y): &(u32, u32)| rays.primary_ray(x as f32 + 0.5, y as f32 + 0.5);
        let primary: Vec<Ray> = pixels.iter().map(ray).collect();
        let hits: Vec<R> = primary.par_iter().map(|ray| bvh.closest_hit(*ray)).collect();
        let whole = |all: Aabb, p: &P| all.union(p.get_bounds(&[]));
        let bounds = bvh.primitives().iter().fold(Aabb::EMPTY, whole);
        let diagonal = (bounds.max - bounds.min).length();
        let short = SHORT * diagonal;
        let place = |((ray, found), pixel): ((&Ray, &R), u32)| {
            let hit = found.hit();
            hit.is_hit.then(|| {
                let normal = bvh.primitive(hit).normal_at(*ray, *found);
                let normal = normal * -normal.dot(ray.direction).signum();
                (ray.at(hit.t) + normal * (ABOVE * diagonal), Frame::around(normal), pixel)
            })
        };
        let places: Vec<_> = primary.iter().zip(&hits).zip(0u32..).filter_map(place).collect();
        let of_group = |group: &[(Vec3, Frame, u32)]| {
            let ray = |i: u32, &(origin, frame, seed): &(Vec3, Frame, u32)| {
                let words = pcg4d(uvec4(seed, i, 0, 0));
                let u = vec2(unit_f32(words.x), unit_f32(words.y));
                let direction = frame.to_world(sample_cosine_hemisphere(u));
                Ray::new(origin, direction).with_range(0.0, short)
            };
            let rays = (0..SAMPLES).flat_map(|i| group.iter().map(move |place| ray(i, place)));
            rays.collect::<Vec<Ray>>()
        };
        let step = (places.len() * SAMPLES as usize).div_ceil(primary.len()).max(1);
        let blocks = places.chunks_exact(BLOCK).step_by(step);
        let groups = blocks.flat_map(|block| block.chunks_exact(GROUP as usize));
        let shadow = groups.flat_map(of_group).collect();
        Self { primary, hits, shadow, short }
    }
}
