//! Trees with primitives in their leaves answer as the primitives alone do, ray by ray, in all
//! packets, and as the binary tree under them.

use core::fmt::Debug;
use std::sync::Mutex;

use raydsl::bvh::{Accelerated, Accelerator, AnyHits, ClosestHits};
use raydsl::machine::{Lanes, Machine, Packet};
use raydsl::prelude::*;
use raydsl::{Type, assert_variants_agree, kernel};
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

/// A ball that is found by steps, a few lengths of a table at a time: with early returns before a
/// loop, a call and a quotient of integers, and without heed of the ray's range.
#[primitive]
#[derive(Debug, PartialEq)]
struct Stepped {
    center: Vec3,
    radius: f32,
    steps: u32,
}

/// Behind an early return of its own.
#[kernel]
fn shorter(length: f32, by: u32) -> f32 {
    if length > 100.0 {
        return 100.0;
    }
    length / (1 + by / 2) as f32
}

#[primitive]
impl Stepped {
    const SLACK: f32 = 64.0 * sphere::SLACK;
    // So that what stands behind its early returns runs where no lane is left.
    const IS_SHORT: bool = true;

    fn intersect(&self, ray: Ray) -> Hit {
        let length = ray.direction.length();
        if length == 0.0 {
            return Hit::miss();
        }
        let direction = ray.direction / length;
        let middle = (self.center - ray.origin).dot(direction);
        let aside = (ray.origin + direction * middle - self.center).length();
        if aside > self.radius {
            return Hit::miss();
        }
        let lengths = [1.0, 0.5, 0.25, 0.125];
        let mut t = middle - self.radius;
        for i in 0..self.steps {
            let left = (ray.origin + direction * t - self.center).length() - self.radius;
            if left < 1e-4 * self.radius {
                return Hit::new(true, t / length);
            }
            t += shorter(left * lengths[(i % 4) as usize], 7 / (1 + i) % 2);
        }
        Hit::new(true, middle / length)
    }

    fn get_bounds(&self) -> Aabb {
        Aabb::from_sphere(self.center, self.radius)
    }
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

/// Makes wide trees however few primitives there are.
fn always() -> BuildConfig {
    BuildConfig { min_wide_size: 0, ..BuildConfig::default() }
}

fn leaves<P: Primitive<Shared = ()>>(prims: &[P], quality: BuildQuality) -> Bvh<'_, P> {
    let config = BuildConfig { quality, ..always() };
    Bvh::build_wide(prims, &[], &config).expect("finite bounds")
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
            // What counts goes through the binary tree.
            assert_eq!(closest, bvh.closest_hit_with_cost(*ray).0, "{ray:?}");
            assert_eq!(any, bvh.any_hit_with_cost(*ray).0, "{ray:?}");
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
        let mut bvh = leaves(&balls, BuildQuality::Balanced);
        for traversal in Traversal::ALL {
            bvh.set_traversal(traversal);
            let hits = assert_as_slice!(bvh, balls, rays);
            assert!(hits > 10, "{hits} of {count}, {traversal:?}");
        }
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
    let faces = triangles(&mut rng, 60);
    let mut things: Vec<Thing> = balls(&mut rng, 60).into_iter().map(Thing::Ball).collect();
    things.extend(faces.into_iter().map(Thing::Face));
    // Neither is short, so blocks have boxes of the primitives.
    let mut grains_tree = leaves(&grains, BuildQuality::Balanced);
    let mut things_tree = leaves(&things, BuildQuality::Best);
    for traversal in Traversal::ALL {
        grains_tree.set_traversal(traversal);
        let hits = assert_as_slice!(grains_tree, grains, rays);
        assert!(hits > 200, "{hits} with {traversal:?}");
        things_tree.set_traversal(traversal);
        let hits = assert_as_slice!(things_tree, things, rays);
        assert!(hits > 200, "{hits} with {traversal:?}");
    }
    // The first tree has packets, and its rays with hits go on in streams.
    grains_tree.set_traversal(Traversal::Packets);
    let moved: Vec<Grain> = grains.iter().map(|g| Grain { center: g.center * 0.8, ..*g }).collect();
    let mut moved_tree = leaves(&moved, BuildQuality::Balanced);
    moved_tree.set_traversal(Traversal::Streams);
    let (both, all) = ([grains_tree, moved_tree], [grains.clone(), moved.clone()].concat());
    let list = BvhList::new(&both).expect("few primitives");
    let hits = assert_as_slice!(list, all, rays);
    assert!(hits > 200, "{hits}");
}

/// Blocks are intersected without early returns.
#[test]
fn early_returns() {
    let mut rng = Rng::of("steps");
    let rays = rays(&mut rng, 1200);
    let stepped: Vec<Stepped> = balls(&mut rng, 120)
        .into_iter()
        .zip(0..)
        .map(|(Ball { center, radius }, i)| Stepped { center, radius, steps: i % 5 })
        .collect();
    let hits = assert_as_slice!(leaves(&stepped, BuildQuality::Balanced), stepped, rays);
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
    let bvh = Bvh::build_wide(&faces, &vertices, &always()).expect("finite bounds");
    let kernel = kernel!(|ray: Ray| (bvh.closest_hit(ray), bvh.any_hit(ray)));
    let plain = Bvh::build_sharing(&faces, &vertices, &BuildConfig::default()).expect("the same");
    let rays = rays(&mut rng, 1000);
    for (ray,) in &rays {
        assert_eq!(kernel.call((*ray,)).0, plain.closest_hit(*ray));
    }
    assert_packets(&kernel, &rays);
}

/// Some trees of a list may have leaves of their own and others not, and rays go through those
/// that all have as each says.
#[test]
fn lists() {
    let mut rng = Rng::of("lists of leaves");
    let rays = rays(&mut rng, 1500);
    let [a, b, c, d] = [50, 20, 9, 30].map(|count| balls(&mut rng, count));
    let models = [a, b, Vec::new(), c, d];
    let all = models.concat();
    for (borrows, shift) in [(5, 0), (5, 1), (5, 2), (5, 3), (1, 0)] {
        let trees: Vec<_> = models
            .iter()
            .enumerate()
            .map(|(i, model)| {
                // With one that sorts, rays are sorted for all.
                let ways = if shift % 2 == 0 { 4 } else { 3 };
                let traversal = Traversal::ALL[([0, 1, 0, 2, 3][i] + shift) % ways];
                let config = BuildConfig { traversal, ..always() };
                let is_wide = i < borrows;
                let tree = match is_wide {
                    true => Bvh::build_wide(model, &[], &config),
                    false => Bvh::build_with(model, &config),
                };
                tree.expect("finite bounds")
            })
            .collect();
        let list = BvhList::new(&trees).expect("few primitives");
        let hits = assert_as_slice!(list, all, rays);
        assert!(hits > 200, "{hits}");
    }
}

/// Compares all variants of a scene's queries, WGSL among them.
macro_rules! assert_on_devices {
    ($scene:expr, $rays:expr, $is_wide:expr) => {{
        let scene = &$scene;
        let kernel = kernel!(|ray: Ray| (scene.closest_hit(ray), scene.any_hit(ray)));
        assert_variants_agree!(&kernel, $rays);
        let text = kernel.wgsl();
        let has = [text.contains("struct CompressedNode "), text.contains("struct Node ")];
        assert_eq!(has, [$is_wide, !$is_wide], "{text}");
    }};
}

/// Devices traverse wide trees, too: of primitives of any size, with spatial splits, with data that
/// they share, and lists; and the binary tree is not made for them.
#[test]
fn devices() {
    // Few: each difference to a device is explained primitive by primitive.
    let mut rng = Rng::of("leaves on devices");
    let rays = rays(&mut rng, 600);
    let faces = triangles(&mut rng, 120);
    let mut trees = vec![Bvh::build(&faces).expect("finite bounds")];
    trees.extend([0, 9].map(|count| leaves(&faces[..count], BuildQuality::Balanced)));
    let qualities = [BuildQuality::Balanced, BuildQuality::Best];
    trees.extend(qualities.map(|quality| leaves(&faces, quality)));
    // Devices ask a tree that was refitted as a binary one.
    let moved = triangles(&mut rng, 120);
    let refitted = leaves(&faces, BuildQuality::Balanced).detach().refit(&moved);
    trees.push(refitted.expect("as many with finite bounds"));
    let last = trees.len() - 1;
    // One kernel, whose text depends on the tree.
    for (i, bvh) in trees.iter().enumerate() {
        let is_wide = bvh.is_wide() && i != last;
        assert_on_devices!(*bvh, &rays, is_wide);
    }
    // Of very different sizes, so that the tree is deep.
    let spread: Vec<Ball> = (0..200)
        .map(|i| 1.4f32.powi(i))
        .map(|x| Ball { center: vec3(x, 0.0, 0.0), radius: 0.05 * x })
        .collect();
    let along: Vec<(Ray,)> = (0..60)
        .map(|i| Ray::new(vec3(1.4f32.powi(3 * i), 0.0, 0.0) + rng.point(1.0), Vec3::X))
        .map(|ray| (ray,))
        .collect();
    let bvh = leaves(&spread, BuildQuality::Balanced);
    assert_on_devices!(bvh, &along, true);
    let grain = |i: u32| Grain {
        center: rng.point(3.0),
        radius: Unorm8::new(rng.range(0.1, 1.0)),
        is_there: !i.is_multiple_of(3),
        shell: Unorm16::new(rng.range(0.2, 0.7)),
    };
    let grains: Vec<Grain> = (0..60).map(grain).collect();
    assert_on_devices!(leaves(&grains, BuildQuality::Balanced), &rays, true);
    let mut things: Vec<Thing> = balls(&mut rng, 40).into_iter().map(Thing::Ball).collect();
    things.extend(faces[..40].iter().copied().map(Thing::Face));
    assert_on_devices!(leaves(&things, BuildQuality::Best), &rays, true);
    let vertices: Vec<Vec3> = (0..60).map(|_| rng.point(3.0)).collect();
    let indexed: Vec<IndexedTriangle> = (0..60)
        .map(|_| IndexedTriangle { vertices: [0; 3].map(|_| rng.range(0.0, 59.9) as u32) })
        .collect();
    let bvh = Bvh::build_wide(&indexed, &vertices, &always()).expect("finite bounds");
    assert_on_devices!(bvh, &rays, true);
    let trees =
        [0..70, 70..70, 70..79, 79..144].map(|range| leaves(&faces[range], BuildQuality::Balanced));
    assert_on_devices!(BvhList::new(&trees).expect("few primitives"), &rays, true);
}

/// Packets per query.
const PACKETS: usize = 16;

/// Short rays that begin near each other, in all packets of a query.
struct Short<'a> {
    scene: BvhList<'a, Triangle>,
    rays: Vec<Ray>,
    found: Vec<bool>,
}

impl LevelTask for Short<'_> {
    fn run<L: Lanes>(&mut self, name: &str, lanes: L) {
        let (m, scene) = (Packet::new(lanes), self.scene.view());
        let chunks = self.rays.chunks_exact(PACKETS * L::N);
        for (rays, found) in chunks.zip(self.found.chunks_exact(PACKETS * L::N)) {
            let packets: [_; PACKETS] =
                core::array::from_fn(|q| Ray::from_lanes(&m, |lane| rays[q * L::N + lane]));
            let any = m.perform(&AnyHits(&scene), packets);
            for (i, (ray, found)) in rays.iter().zip(found).enumerate() {
                let is_hit = L::mask_lane(&any[i / L::N].0, i % L::N);
                assert_eq!(is_hit, *found, "{name} {ray:?}");
            }
        }
    }
}

/// Short rays, some of which begin behind their origin, begin at an entry node.
#[test]
fn short_rays() {
    let mut rng = Rng::of("short rays");
    let faces = triangles(&mut rng, 1500);
    let trees = [&faces[..1200], &faces[1200..]].map(|faces| leaves(faces, BuildQuality::Balanced));
    let mut rays = Vec::new();
    for length in [0.01, 0.1, 0.5, 2.0, 1e9] {
        for _ in 0..4 {
            let middle = rng.point(3.0);
            for i in 0..256 {
                let t_min = if i % 3 == 0 { -0.5 * length } else { 0.0 };
                let (from, to) = (middle + rng.point(0.1), rng.point(1.0));
                let direction = match i % 50 {
                    7 => Vec3::ZERO,
                    8 => Vec3::X,
                    9 => to * 1e-20,
                    _ => to,
                };
                rays.push(Ray { t_min, t_max: length, ..Ray::new(from, direction) });
            }
        }
    }
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX];
    for (i, value) in odd.into_iter().enumerate() {
        rays[256 * i + 20].t_max = value;
        rays[256 * (i + 5) + 20].t_min = value;
    }
    let found: Vec<bool> = rays.iter().map(|ray| faces.any_hit(*ray)).collect();
    let hits = found.iter().filter(|found| **found).count();
    assert!((1000..4500).contains(&hits), "{hits}");
    let scene = BvhList::new(&trees).expect("few primitives");
    assert_eq!(scene.any_hits(&rays), found);
    let mut short = Short { scene, rays, found };
    each_level(&mut short);
    widest_level(&mut short);
}

/// Many bounded rays are sorted by direction, and form ray packets while they are coherent.
#[test]
fn sorted_rays() {
    let mut rng = Rng::of("sorted rays");
    let faces = triangles(&mut rng, 1500);
    let trees = [&faces[..1200], &faces[1200..]].map(|faces| leaves(faces, BuildQuality::Balanced));
    let scene = BvhList::new(&trees).expect("few primitives");
    let mut ray = |i: usize| {
        let length = [0.1, 0.5, 2.0, 1e9][i / 3000 % 4];
        let direction = match i % 100 {
            7 => Vec3::ZERO,
            8 => Vec3::X,
            9 => Vec3::splat(1e-20),
            10 => vec3(f32::NAN, 1.0, 0.0),
            // A beam of many beside those that go anywhere.
            11..50 => vec3(1.0, 0.3, -0.2) + rng.point(0.02),
            _ => rng.point(1.0),
        };
        let size = if i % 100 == 60 { 1e30 } else { 1.0 };
        let origin = (vec3(0.5, -1.0, 1.0) + rng.point(0.1)) * size;
        let t_min = if i.is_multiple_of(3) { -0.5 * length } else { 0.0 };
        Ray { t_min, t_max: length, ..Ray::new(origin, direction) }
    };
    let mut rays: Vec<Ray> = (0..12_000).map(&mut ray).collect();
    rays[99].t_min = f32::NAN;
    rays[199].t_max = f32::NEG_INFINITY;
    let found: Vec<bool> = rays.iter().map(|ray| faces.any_hit(*ray)).collect();
    let hits = found.iter().filter(|found| **found).count();
    assert!((2000..8000).contains(&hits), "{hits}");
    for range in [0..511, 0..512, 3..516, 5..2048, 3000..12_000, 0..12_000] {
        assert_eq!(scene.any_hits(&rays[range.clone()]), found[range]);
    }
    // More of a packet than can be sorted at once, and some that are none.
    let kernel = kernel!(|ray: Ray| {
        let all = scene.any_hit_each::<600>(|i: u32| {
            let tenth = i % 10;
            let direction = ray.direction * if tenth == 0 { f32::NAN } else { 1.0 };
            Ray { direction, t_max: ray.t_max * (1.0 + 0.01 * i as f32), ..ray }
        });
        let mut count = 0u32;
        for is_hit in &all {
            count += if *is_hit { 1u32 } else { 0u32 };
        }
        (all[0], all[1], count)
    });
    let inputs: Vec<(Ray,)> = rays.iter().step_by(70).map(|ray| (*ray,)).collect();
    assert_packets(&kernel, &inputs);
    // One ray of a packet, by a thread that has asked nothing before.
    for input in inputs.iter().step_by(9) {
        std::thread::scope(|scope| {
            scope.spawn(|| assert_packets(&kernel, &[*input]));
        });
    }
}

/// The packets of a gang query different scenes, in different iterations of loops, and end at
/// different times; the size of the gang changes nothing.
#[test]
fn gangs_of_packets() {
    let mut rng = Rng::of("gangs of packets");
    let faces = triangles(&mut rng, 400);
    let balls = balls(&mut rng, 100);
    let (faces, balls) =
        (leaves(&faces, BuildQuality::Balanced), leaves(&balls, BuildQuality::Fast));
    let kernel = kernel!(|ray: Ray| {
        let mut ray = ray;
        let mut length = 0.0;
        let mut hits = 0u32;
        for i in 0..9u32 {
            let face = faces.closest_hit(ray);
            if !face.is_hit {
                break;
            }
            length += face.t;
            if face.prim_id % 3 == 0 {
                let ball = balls.closest_hit(ray.with_range(0.0, face.t));
                hits += if ball.is_hit { ball.prim_id } else { i };
            } else if faces.any_hit(ray.with_range(face.t * 1.2, ray.t_max)) {
                hits += 1000;
            }
            ray = ray.with_range(face.t * 1.01 + 1e-3, ray.t_max);
        }
        (length, hits)
    });
    let rays = rays(&mut rng, 1500);
    let expected: Vec<(f32, u32)> = rays.iter().map(|ray| kernel.call(*ray)).collect();
    assert!(expected.iter().filter(|(_, hits)| *hits > 1000).count() > 50);
    let bits = |(length, hits): &(f32, u32)| (length.to_bits(), *hits);
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        for lanes in [0, 8, 24, 64, 100, 256, usize::MAX] {
            let mut found = vec![(0.0, 0); rays.len()];
            kernel.run_in_gangs(variant, lanes, &rays, &mut found);
            let is_same = |(a, b)| bits(a) == bits(b);
            assert!(found.iter().zip(&expected).all(is_same), "{variant:?} {lanes}");
        }
    }
    let camera = Pinhole::new(vec3(1.0, 2.0, 9.0), Vec3::ZERO, Vec3::Y, 0.8);
    let [mut single, mut gang] = [(); 2].map(|()| Image::filled(53, 37, (0.0, 0)));
    SimpleScheduler::new().variant(Variant::Packet8).frame(&camera, &kernel, &mut single);
    for (lanes, edge) in [(0, 16), (64, 16), (64, 7), (256, 64), (1000, 3)] {
        let scheduler = TiledScheduler::new().gang(lanes).tile(edge);
        scheduler.frame(&camera, &kernel, &mut gang);
        let same = single.pixels().iter().zip(gang.pixels());
        assert!(same.into_iter().all(|(a, b)| bits(a) == bits(b)), "{lanes} {edge}");
    }
}

/// A structure that asks another scene while it looks for candidates, with its lock held, and takes
/// up other work of the pool.
struct Asking<'a> {
    balls: &'a Bvh<'a, Ball>,
    lock: Mutex<usize>,
}

impl Accelerator for Asking<'_> {
    fn candidates(&self, ray: &Ray, _limit: f32, meet: &mut dyn FnMut(u32) -> f32) {
        let mut asked = self.lock.lock().expect("nobody panics");
        let balls = self.balls;
        let kernel = kernel!(|ray: Ray| balls.any_hit(ray));
        let mut hits = [false; 40];
        kernel.run(Variant::Packet8, &[(*ray,); 40], &mut hits);
        *asked += usize::from(hits[39]);
        drop(asked);
        rayon::join(|| balls.any_hit(*ray), || balls.closest_hit(*ray));
        (0..60).for_each(|id| _ = meet(id));
    }
}

#[test]
fn gangs_leave_nothing_halfway() {
    let mut rng = Rng::of("gangs and locks");
    let (faces, prims) = (triangles(&mut rng, 50), balls(&mut rng, 60));
    let (faces, balls) =
        (leaves(&faces, BuildQuality::Balanced), leaves(&prims, BuildQuality::Balanced));
    let scene = Accelerated::new(&prims, Asking { balls: &balls, lock: Mutex::default() });
    let kernel = kernel!(|ray: Ray| {
        let face = faces.closest_hit(ray);
        let ball = scene.closest_hit(ray);
        (face.t, ball.t, faces.any_hit(ray.with_range(0.0, ball.t)))
    });
    let rays = rays(&mut rng, 600);
    assert_packets(&kernel, &rays);
    let mut found = vec![(0.0, 0.0, false); rays.len()];
    let scheduler = TiledScheduler::new();
    scheduler.batch(&kernel, &rays, &mut found);
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
            let (closest, any) =
                (m.perform(&ClosestHits(&scene), packets), m.perform(&AnyHits(&scene), packets));
            for (i, expected) in hits.iter().enumerate() {
                let found = Hit::lane(&closest[i / L::N], i % L::N);
                let is_hit = L::mask_lane(&any[i / L::N].0, i % L::N);
                assert_eq!((found, is_hit), (*expected, expected.is_hit), "{name} {:?}", rays[i]);
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
    let trees = [Bvh::build(&faces), Bvh::build_wide(&faces, &[], &BuildConfig::default())];
    let [borrowed, copied] =
        trees.map(|bvh| bvh.expect("finite bounds").bytes() as f64 / faces.len() as f64);
    // Nine words and a number for each, in blocks that are mostly full, and the nodes.
    assert!(borrowed < 80.0 && copied > 40.0 && copied < 120.0, "{borrowed}, {copied}");
}
