//! Trees with primitives in their leaves answer as the primitives alone do, in all packets. Other
//! variants have no use for the leaves.

use core::fmt::Debug;

use raydsl::machine::{Lanes, Machine, Packet};
use raydsl::prelude::*;
use raydsl::{Type, kernel};
use raydsl_tests::levels::{LevelTask, each_level, gangs, widest_level};
use raydsl_tests::rng::Rng;

#[primitive(sphere(center, radius))]
#[derive(Debug, PartialEq)]
struct Ball {
    center: Vec3,
    radius: f32,
}

/// Sixteen bytes, in which numbers of one and two bytes lie side by side.
#[primitive]
#[derive(Debug, PartialEq)]
struct Grain {
    center: Vec3,
    radius: Unorm8,
    is_there: bool,
    shell: Unorm16,
}

#[primitive]
impl Grain {
    const SLACK: f32 = sphere::SLACK;

    fn intersect(&self, ray: Ray) -> Hit {
        let hit = sphere::intersect(ray, self.center, self.radius.to_f32() * self.shell.to_f32());
        Hit { is_hit: hit.is_hit && self.is_there, ..hit }
    }

    fn get_bounds(&self) -> Aabb {
        Aabb::from_sphere(self.center, self.radius.to_f32() * self.shell.to_f32())
    }
}

#[primitive]
#[derive(Debug, PartialEq)]
enum Thing {
    Ball(Ball),
    Face(Triangle),
}

/// Rays of every kind: alike and apart, bounded, from within, beginning behind themselves, along
/// axes, too large for products, none at all.
fn rays(rng: &mut Rng, count: usize) -> Vec<(Ray,)> {
    let eye = rng.point(5.0);
    let ray = |i: usize, rng: &mut Rng| {
        let (from, to) = (rng.point(4.0), rng.point(1.0));
        match i / 64 % 9 {
            0 | 1 => Ray::new(eye, to * 0.2 - eye),
            2 => Ray { t_max: 2.0, ..Ray::new(from, to) },
            3 => Ray { t_min: -3.0, ..Ray::new(from, to) },
            4 => Ray::new(from, [Vec3::X, Vec3::NEG_Y, Vec3::Z][i % 3]),
            5 => Ray::new(from * 1e18, -from),
            6 => Ray::new(from, to * 1e-18),
            7 => Ray { t_min: 0.5, t_max: f32::MAX, ..Ray::new(from, to * 1e12) },
            _ => Ray::new(from, to),
        }
    };
    let mut all: Vec<(Ray,)> = (0..count).map(|i| (ray(i, rng),)).collect();
    for (i, value) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY].into_iter().enumerate() {
        all[64 * i + 3].0.origin.x = value;
        all[64 * i + 4].0.direction.y = value;
        all[64 * i + 5].0.t_max = value;
        all[64 * i + 6].0.t_min = value;
    }
    all[9].0.direction = Vec3::ZERO;
    all
}

fn balls(rng: &mut Rng, count: usize) -> Vec<Ball> {
    (0..count).map(|_| Ball { center: rng.point(3.0), radius: rng.range(0.05, 0.5) }).collect()
}

/// Triangles of every size and shape, and some of them twice.
fn triangles(rng: &mut Rng, count: usize) -> Vec<Triangle> {
    let mut all: Vec<Triangle> = (0..count)
        .map(|i| {
            let (v0, size) = (rng.point(3.0), if i % 7 == 0 { 3.0 } else { 0.4 });
            Triangle { v0, v1: v0 + rng.point(size), v2: v0 + rng.point(size) }
        })
        .collect();
    all.extend_from_within(..count / 5);
    all
}

fn leaves<P: Primitive<Shared = ()>>(prims: &[P], quality: BuildQuality) -> Bvh<'_, P> {
    let config = BuildConfig { quality, storage: Storage::Leaves, ..BuildConfig::default() };
    Bvh::build_with(prims, &config).expect("finite bounds")
}

/// Packets give what the scalar function does.
fn assert_packets<R: Type + PartialEq + Debug>(kernel: &Kernel<'_, (Ray,), R>, rays: &[(Ray,)]) {
    let expected: Vec<R> = rays.iter().map(|ray| kernel.call(*ray)).collect();
    let mut found = expected.clone();
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        // Neither of two rays beside each other may do for the other one.
        found.rotate_left(1);
        kernel.run(variant, rays, &mut found);
        for (i, (found, expected)) in found.iter().zip(&expected).enumerate() {
            assert!(found == expected, "{variant:?} {i} {:?}: {found:?}, {expected:?}", rays[i]);
        }
    }
}

/// All queries of a scene agree in all packets, and with those of the slice under it.
macro_rules! assert_as_slice {
    ($bvh:expr, $prims:expr, $rays:expr) => {{
        let (bvh, prims, rays) = (&$bvh, &$prims[..], &$rays[..]);
        let kernel = kernel!(|ray: Ray| {
            let ahead =
                bvh.closest_hit_each::<3>(|i: u32| ray.with_range(0.3 * i as f32, ray.t_max));
            let any = bvh.any_hit_each::<9>(|i: u32| ray.with_range(0.3 * i as f32, ray.t_max));
            let one = (bvh.closest_hit(ray), bvh.any_hit(ray));
            (one, ahead[0], ahead[2], any[0], any[8])
        });
        let mut hits = 0;
        let host: Vec<Ray> = rays.iter().map(|(ray,)| *ray).collect();
        let many = bvh.closest_hits(&host).into_iter().zip(bvh.any_hits(&host));
        assert_eq!(many.len(), rays.len());
        for ((ray,), many) in rays.iter().zip(many) {
            let (closest, any) = kernel.call((*ray,)).0;
            assert_eq!((closest, any), many, "{ray:?}");
            hits += usize::from(any);
            assert_eq!(closest, prims.closest_hit(*ray), "{ray:?}");
            assert_eq!(any, prims.any_hit(*ray), "{ray:?}");
        }
        assert_packets(&kernel, rays);
        hits
    }};
}

#[test]
fn shapes() {
    let mut rng = Rng::of("leaves");
    let rays = rays(&mut rng, 2500);
    for count in [1, 7, 8, 9, 300] {
        let balls = balls(&mut rng, count);
        let hits = assert_as_slice!(leaves(&balls, BuildQuality::Balanced), balls, rays);
        assert!(hits > 10, "{hits} of {count}");
    }
    let faces = triangles(&mut rng, 400);
    for quality in BuildQuality::ALL {
        let hits = assert_as_slice!(leaves(&faces, quality), faces, rays);
        assert!(hits > 800, "{hits} with {quality:?}");
    }
}

#[test]
fn numbers_of_one_byte_and_kinds() {
    let mut rng = Rng::of("grains");
    let rays = rays(&mut rng, 1500);
    let grains: Vec<Grain> = (0..200)
        .map(|i| Grain {
            center: rng.point(3.0),
            radius: Unorm8::new(rng.range(0.1, 1.0)),
            is_there: i % 3 != 0,
            shell: Unorm16::new(rng.range(0.2, 0.7)),
        })
        .collect();
    let hits = assert_as_slice!(leaves(&grains, BuildQuality::Balanced), grains, rays);
    assert!(hits > 200, "{hits}");
    let faces = triangles(&mut rng, 60);
    let mut things: Vec<Thing> = balls(&mut rng, 60).into_iter().map(Thing::Ball).collect();
    things.extend(faces.into_iter().map(Thing::Face));
    let hits = assert_as_slice!(leaves(&things, BuildQuality::Best), things, rays);
    assert!(hits > 200, "{hits}");
}

/// Primitives that share data are fetched from it for each lane.
#[test]
fn indexed_triangles() {
    let mut rng = Rng::of("indexed leaves");
    let vertices: Vec<Vec3> = (0..60).map(|_| rng.point(3.0)).collect();
    let faces: Vec<IndexedTriangle> = (0..150)
        .map(|_| IndexedTriangle { vertices: [0; 3].map(|_| rng.range(0.0, 59.9) as u32) })
        .collect();
    let config = BuildConfig::from(Storage::Leaves);
    let bvh = Bvh::build_sharing(&faces, &vertices, &config).expect("finite bounds");
    let kernel = kernel!(|ray: Ray| (bvh.closest_hit(ray), bvh.any_hit(ray)));
    let plain = Bvh::build_sharing(&faces, &vertices, &BuildConfig::default()).expect("the same");
    let rays = rays(&mut rng, 1000);
    for (ray,) in &rays {
        assert_eq!(kernel.call((*ray,)).0, plain.closest_hit(*ray));
    }
    assert_packets(&kernel, &rays);
}

/// Some trees of a list may have leaves of their own and others not.
#[test]
fn lists() {
    let mut rng = Rng::of("lists of leaves");
    let rays = rays(&mut rng, 1500);
    let models = [balls(&mut rng, 50), balls(&mut rng, 20), Vec::new(), balls(&mut rng, 9)];
    let all = models.concat();
    for borrows in [4, 1] {
        let trees: Vec<_> = models
            .iter()
            .enumerate()
            .map(|(i, model)| {
                let storage = if i < borrows { Storage::Leaves } else { Storage::Borrow };
                Bvh::build_with(model, &storage.into()).expect("finite bounds")
            })
            .collect();
        let list = BvhList::new(&trees).expect("few primitives");
        let hits = assert_as_slice!(list, all, rays);
        assert!(hits > 200, "{hits}");
    }
}

/// A tree, rays, and what they meet.
struct Asked<'a> {
    bvh: &'a Bvh<'a, Triangle>,
    rays: &'a [(Ray,)],
    hits: Vec<Hit>,
}

impl LevelTask for Asked<'_> {
    fn run<L: Lanes>(&mut self, name: &str, lanes: L) {
        let (m, scene) = (Packet::new(lanes), self.bvh.view());
        let chunks = self.rays.chunks_exact(2 * L::N).zip(self.hits.chunks_exact(2 * L::N));
        for (rays, hits) in chunks {
            let packets = [0, L::N].map(|from| Ray::from_lanes(&m, |lane| rays[from + lane].0));
            let (closest, any) = (m.closest_hits(&scene, &packets), m.any_hits(&scene, &packets));
            for (i, expected) in hits.iter().enumerate() {
                let found = Hit::lane(&closest[i / L::N], i % L::N);
                let is_met = L::mask_lane(&any[i / L::N].0, i % L::N);
                assert_eq!((found, is_met), (*expected, expected.is_hit), "{name} {:?}", rays[i]);
            }
        }
    }
}

/// Boxes are tested by other instructions at each level, and other ones may be visited.
#[test]
fn levels() {
    let mut rng = Rng::of("levels of leaves");
    let faces = triangles(&mut rng, 300);
    let bvh = leaves(&faces, BuildQuality::Balanced);
    let rays = rays(&mut rng, 9 * 64);
    let hits: Vec<Hit> = rays.iter().map(|(ray,)| faces.closest_hit(*ray)).collect();
    assert!(hits.iter().filter(|hit| hit.is_hit).count() > 100);
    let mut asked = Asked { bvh: &bvh, rays: &rays, hits };
    each_level(&mut asked);
    widest_level(&mut asked);
    // Of the narrower gang half the lanes do not run.
    for gang in gangs().into_iter().filter(|gang| gang.width == 64) {
        asked.run(&gang.name, gang.lanes);
    }
}

/// What has moved is where it is, also in the leaves.
#[test]
fn refitted() {
    let mut rng = Rng::of("refitted leaves");
    let rays = rays(&mut rng, 1000);
    let (before, after) = (balls(&mut rng, 200), balls(&mut rng, 200));
    let bvh = leaves(&before, BuildQuality::Balanced).refit(&after).expect("as many");
    let hits = assert_as_slice!(bvh, after, rays);
    assert!(hits > 200, "{hits}");
}

#[test]
fn bytes() {
    let mut rng = Rng::of("bytes of leaves");
    let faces = triangles(&mut rng, 10_000);
    let [borrowed, copied] = [Storage::Borrow, Storage::Leaves].map(|storage| {
        let bvh = Bvh::build_with(&faces, &storage.into()).expect("finite bounds");
        bvh.bytes() as f64 / faces.len() as f64
    });
    // Nine words and a number for each, in blocks that are mostly full, and the nodes.
    assert!(borrowed < 80.0 && copied > 40.0 && copied < 120.0, "{borrowed}, {copied}");
}
