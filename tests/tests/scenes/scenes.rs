//! Scenes of more than one tree, of primitives that share data, and of memory that the application
//! has from elsewhere, in every variant.

use raydsl::bvh::{BuildError, ListError};
use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};
use raydsl_tests::rng::Rng;

#[primitive(sphere(center, radius))]
#[derive(Debug, PartialEq)]
struct Ball {
    center: Vec3,
    radius: f32,
}

fn balls(rng: &mut Rng, count: usize) -> Vec<Ball> {
    (0..count).map(|_| Ball { center: rng.point(3.0), radius: rng.range(0.2, 0.9) }).collect()
}

fn rays(rng: &mut Rng, count: usize) -> Vec<(Ray,)> {
    let mut all: Vec<(Ray,)> =
        (0..count).map(|_| (Ray::new(rng.point(4.0), rng.point(1.0)),)).collect();
    for (i, (ray,)) in all.iter_mut().enumerate() {
        match i % 5 {
            0 => ray.t_max = 2.0,
            1 => ray.t_min = 1.0,
            _ => {}
        }
    }
    all[7].0.origin.x = f32::NAN;
    all
}

/// The scenes of a list: an empty tree, copies of one primitive in two trees, a single one.
fn models(rng: &mut Rng) -> [Vec<Ball>; 4] {
    let many = balls(rng, 60);
    let mut others = balls(rng, 30);
    others.extend_from_slice(&many[..20]);
    [many, Vec::new(), others, balls(rng, 1)]
}

#[test]
fn a_list_answers_as_one_tree() {
    let mut rng = Rng::of("a list");
    let models = models(&mut rng);
    // ANCHOR: list
    let trees = models.each_ref().map(|m| Bvh::build(m).expect("finite bounds"));
    let list = BvhList::new(&trees).expect("few primitives");
    // ANCHOR_END: list
    let all = models.concat();
    let one = Bvh::build(&all).expect("finite bounds");
    let rays = rays(&mut rng, 3000);
    let (mut hits, mut last) = (0, 0);
    for (ray,) in &rays {
        let hit = one.closest_hit(*ray);
        hits += usize::from(hit.is_hit);
        assert_eq!(list.closest_hit(*ray), hit);
        assert_eq!(all[..].closest_hit(*ray), hit);
        assert_eq!(list.any_hit(*ray), hit.is_hit);
        assert_eq!(list.multi_hit::<4>(*ray), one.multi_hit::<4>(*ray));
        assert_eq!(list.primitive(hit), one.primitive(hit));
        assert_eq!(list.tree_of(hit).is_some(), hit.is_hit);
        if let Some(tree) = list.tree_of(hit) {
            last = last.max(tree);
            let own = (hit.prim_id - list.first_of(tree)) as usize;
            assert_eq!(models[tree][own], all[hit.prim_id as usize]);
        }
    }
    assert!(hits > 1000 && last == 3, "{hits} hits, the last of tree {last}");
    let closest = kernel!(|ray: Ray| {
        let hit = list.closest_hit(ray);
        let any = list.any_hit(ray);
        (hit, any, list.primitive(hit).radius)
    });
    assert_variants_agree!(&closest, &rays);
    let several = kernel!(|ray: Ray| {
        let hits = list.multi_hit::<3>(ray);
        let kept = list.closest_hit_where(ray, |hit: Hit| hit.prim_id % 3 != 1);
        let any = list.any_hit_where(ray, |hit: Hit| hit.prim_id > 70 && hit.t > 0.5);
        (hits[0], hits[2], kept, any)
    });
    assert_variants_agree!(&several, &rays);
    let each = kernel!(|ray: Ray| {
        let ahead = list.closest_hit_each::<2>(|i: u32| ray.with_range(i as f32, ray.t_max));
        let any = list.any_hit_each::<2>(|i: u32| ray.with_range(i as f32, ray.t_max));
        (ahead[0].prim_id, ahead[1].prim_id, any[0], any[1])
    });
    assert_variants_agree!(&each, &rays);
}

#[kernel]
fn farthest(scene: &BvhList<'_, Ball>, ray: Ray) -> f32 {
    scene.multi_hit_by::<1>(ray, |a: Hit, b: Hit| a.t > b.t)[0].t
}

#[test]
fn lists_of_no_tree_and_of_one() {
    let mut rng = Rng::of("short lists");
    let (balls, rays) = (balls(&mut rng, 40), rays(&mut rng, 500));
    let none = BvhList::<Ball>::new(&[]).expect("no primitives");
    assert_eq!(none.tree_count(), 0);
    assert!(rays.iter().all(|(ray,)| !none.closest_hit(*ray).is_hit && !none.any_hit(*ray)));
    let nothing =
        kernel!(|ray: Ray| (none.any_hit(ray), none.closest_hit(ray), farthest(&none, ray)));
    assert_variants_agree!(&nothing, &rays);
    let tree = [Bvh::build(&balls).expect("finite bounds")];
    let one = BvhList::new(&tree).expect("few primitives");
    assert_eq!((one.tree_count(), one.first_of(0)), (1, 0));
    let kernel = kernel!(|ray: Ray| (one.closest_hit(ray), farthest(&one, ray)));
    for (ray,) in &rays {
        assert_eq!(kernel.call((*ray,)).0, tree[0].closest_hit(*ray));
    }
    assert_variants_agree!(&kernel, &rays);
}

/// A hit may be that of another scene: the last primitive stands for what is not there. Plain Rust
/// has no such hit.
#[test]
fn hits_of_another_scene() {
    let mut rng = Rng::of("another scene");
    let balls = balls(&mut rng, 5);
    let bvh = Bvh::build(&balls).expect("finite bounds");
    let kernel =
        kernel!(|id: u32| bvh.primitive(Hit { prim_id: id, ..Hit::new(true, 1.0) }).radius);
    let inputs: Vec<(u32,)> = (0..5).map(|i| (i,)).collect();
    assert_variants_agree!(&kernel, &inputs);
    assert!(kernel.wgsl().contains("bvh_element("), "{}", kernel.wgsl());
}

#[kernel]
fn list_closer_hit(x: f32) -> f32 {
    x * 2.0
}

#[kernel]
fn list_any_hit_in(x: f32) -> f32 {
    x + 2.0
}

/// Names that the library gives to what belongs to buffers may be a user's.
#[test]
fn names_of_generated_code() {
    let mut rng = Rng::of("names");
    let (balls, rays) = (balls(&mut rng, 9), rays(&mut rng, 64));
    let trees = [Bvh::build(&balls).expect("finite bounds")];
    let list = BvhList::new(&trees).expect("few primitives");
    let len_of_list_roots = 2.0;
    let kernel = kernel!(|ray: Ray| {
        let own = list_closer_hit(ray.t_min) + list_any_hit_in(len_of_list_roots);
        (own, list.closest_hit(ray), list.any_hit(ray))
    });
    assert_variants_agree!(&kernel, &rays);
    let (i, len_of_i) = (&balls[..], 3.0);
    let kernel = kernel!(|ray: Ray| (i.closest_hit(ray), i[2].radius + len_of_i, i.len() as u32));
    assert_variants_agree!(&kernel, &rays);
}

/// Trees without primitives share anything, and no miss belongs to a tree.
#[test]
fn empty_trees_in_lists() {
    let (vertices, indexed) = mesh(6);
    let config = BuildConfig::default();
    let empty = || Bvh::<IndexedTriangle>::build_sharing(&[], &[], &config).expect("nothing");
    let full = Bvh::build_sharing(&indexed, &vertices, &config).expect("finite bounds");
    let trees = [empty(), full, empty()];
    let list = BvhList::new(&trees).expect("one slice of vertices");
    assert!(core::ptr::eq(list.shared(), &vertices[..]));
    let rays = rays(&mut Rng::of("empty trees"), 300);
    for (ray,) in &rays {
        let hit = list.closest_hit(*ray);
        assert_eq!(list.tree_of(hit), hit.is_hit.then_some(1));
    }
    let kernel = kernel!(|ray: Ray| (list.closest_hit(ray), list.multi_hit::<2>(ray)[1].t));
    assert_variants_agree!(&kernel, &rays);
}

/// A list in a loop of the kernel's own, a list beside one of its trees, and a list of an enum.
#[test]
fn lists_within_control_flow() {
    let mut rng = Rng::of("lists in loops");
    let models = models(&mut rng);
    let trees = models.each_ref().map(|m| Bvh::build(m).expect("finite bounds"));
    let list = BvhList::new(&trees).expect("few primitives");
    let (first, rays) = (&trees[0], rays(&mut rng, 500));
    let kernel = kernel!(|ray: Ray| {
        let mut sum = 0.0;
        'steps: for i in 0u32..3 {
            let start = ray.with_range(ray.t_min + 0.3 * i as f32, ray.t_max);
            if list.any_hit_where(start, |hit: Hit| hit.prim_id % 5 == i) {
                break 'steps;
            }
            sum += first.closest_hit(start).t + list.closest_hit(start).t;
        }
        sum
    });
    assert_variants_agree!(&kernel, &rays);
}

/// A closed mesh: a ball of triangles, as an index buffer has it.
fn mesh(segments: u32) -> (Vec<Vec3>, Vec<IndexedTriangle>) {
    let at = |i: u32, k: u32| {
        let (a, b) = (i as f32 / segments as f32, k as f32 / segments as f32);
        let (around, down) = (core::f32::consts::TAU * a, core::f32::consts::PI * b);
        vec3(down.sin() * around.cos(), down.sin() * around.sin(), down.cos())
    };
    let vertices = (0..=segments).flat_map(|k| (0..segments).map(move |i| at(i, k))).collect();
    let number = |i: u32, k: u32| k * segments + i % segments;
    let triangles = (0..segments).flat_map(|k| {
        (0..segments).flat_map(move |i| {
            let corner = [number(i, k), number(i + 1, k), number(i, k + 1), number(i + 1, k + 1)];
            [[corner[0], corner[1], corner[2]], [corner[1], corner[3], corner[2]]]
        })
    });
    (vertices, triangles.map(|vertices| IndexedTriangle { vertices }).collect())
}

#[test]
fn indexed_triangles_are_triangles() {
    let (vertices, indexed) = mesh(24);
    assert_eq!(size_of::<IndexedTriangle>(), 12);
    let inline: Vec<Triangle> = indexed.iter().filter_map(|t| t.on(&vertices)).collect();
    // ANCHOR: indexed
    let config = BuildConfig::default();
    let tree = Bvh::build_sharing(&indexed, &vertices, &config).expect("finite bounds");
    // ANCHOR_END: indexed
    let plain = Bvh::build(&inline).expect("finite bounds");
    assert_eq!((tree.nodes(), tree.indices()), (plain.nodes(), plain.indices()));
    assert!(core::ptr::eq(tree.primitives(), &indexed[..]));
    assert!(core::ptr::eq(tree.shared(), &vertices[..]));
    let rays = rays(&mut Rng::of("indexed"), 3000);
    for (ray,) in &rays {
        assert_eq!(tree.closest_hit(*ray), plain.closest_hit(*ray));
        assert_eq!(tree.multi_hit::<3>(*ray), inline[..].multi_hit::<3>(*ray));
    }
    // ANCHOR: shading
    let kernel = kernel!(|ray: Ray| {
        let hit = tree.closest_hit(ray);
        let vertices = tree.shared();
        let mut normal = vec3(0.0, 0.0, 0.0);
        let mut corner = normal;
        if hit.is_hit {
            let triangle = tree.primitive(hit);
            normal = triangle.normal(ray, hit, vertices);
            corner = vertices[triangle.vertices[2] as usize];
        }
        let any = tree.any_hit_where(ray, |hit: Hit| hit.u > 0.5);
        (hit, normal, corner, any)
    });
    // ANCHOR_END: shading
    assert_variants_agree!(&kernel, &rays);
}

#[test]
fn an_index_without_a_vertex_is_an_error() {
    let vertices = [Vec3::X, Vec3::Y, Vec3::Z];
    for wrong in [[3, 0, 1], [0, 3, 1], [0, 1, 3]] {
        let indexed = [[0, 1, 2], wrong].map(|vertices| IndexedTriangle { vertices });
        let built = Bvh::build_sharing(&indexed, &vertices, &BuildConfig::default());
        assert_eq!(built.err(), Some(BuildError::NanBounds { index: 1 }), "{wrong:?}");
    }
}

#[test]
fn trees_of_a_list_share_one_slice() {
    let (vertices, indexed) = mesh(8);
    let (here, config) = (vertices.clone(), BuildConfig::default());
    let (front, back) = indexed.split_at(70);
    let tree =
        |prims, vertices| Bvh::build_sharing(prims, vertices, &config).expect("finite bounds");
    let apart = [tree(front, &vertices), tree(back, &here)];
    let error = BvhList::new(&apart).err();
    assert_eq!(error, Some(ListError::SharesAnother { first: 0, tree: 1 }));
    let trees = [tree(front, &vertices), tree(back, &vertices)];
    let list = BvhList::new(&trees).expect("one slice of vertices");
    let whole = tree(&indexed, &vertices);
    let rays = rays(&mut Rng::of("shared"), 1000);
    assert!(rays.iter().all(|(ray,)| list.closest_hit(*ray) == whole.closest_hit(*ray)));
    let kernel = kernel!(|ray: Ray| {
        let hit = list.closest_hit(ray);
        let corner = list.shared()[list.primitive(hit).vertices[0] as usize];
        (hit, corner)
    });
    assert_variants_agree!(&kernel, &rays);
}

/// Steps of a stair, which share a table of heights and widths: any primitive may share.
#[primitive]
#[derive(Debug)]
struct Step {
    at: f32,
    kind: u32,
}

/// The members of a step's kind, and whether it may be seen from below.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Kind {
    size: Vec3,
    is_open: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Type, HitRecord)]
struct Landing {
    hit: Hit,
    height: f32,
}

// ANCHOR: step
#[primitive]
impl Step {
    fn intersect(&self, ray: Ray, kinds: &[Kind]) -> Landing {
        let kind = kinds[self.kind as usize];
        let low = vec3(self.at, 0.0, 0.0);
        let hit = cuboid::intersect(ray, low, low + kind.size);
        let is_hit = hit.is_hit && !(kind.is_open && ray.direction.z > 0.0);
        Landing { hit: Hit { is_hit, ..hit }, height: kind.size.z }
    }

    fn get_bounds(&self, kinds: &[Kind]) -> Aabb {
        let low = vec3(self.at, 0.0, 0.0);
        Aabb::new(low, low + kinds[self.kind as usize].size)
    }
}
// ANCHOR_END: step

#[test]
fn any_primitive_may_share() {
    let kinds: Vec<Kind> = (1..5)
        .map(|i| Kind { size: vec3(0.8, 2.0, 0.4 * i as f32), is_open: i % 2 == 0 })
        .collect();
    let steps: Vec<Step> =
        (0..50).map(|i| Step { at: i as f32 * 0.2 - 5.0, kind: i % 4 }).collect();
    let bvh = Bvh::build_sharing(&steps, &kinds, &BuildConfig::default()).expect("finite bounds");
    let rays = rays(&mut Rng::of("steps"), 2000);
    let mut hits = 0;
    for (ray,) in &rays {
        let found = bvh.closest_hit(*ray);
        hits += usize::from(found.hit.is_hit);
        let mut least = Landing { hit: Hit::miss(), height: 0.0 };
        for (i, step) in steps.iter().enumerate() {
            let here = step.intersect(*ray, &kinds);
            if here.hit.is_hit && (!least.hit.is_hit || here.hit.t < least.hit.t) {
                least = Landing { hit: Hit { prim_id: i as u32, ..here.hit }, ..here };
            }
        }
        if ray.origin.is_finite() {
            assert_eq!(found, least);
        }
    }
    assert!(hits > 200, "{hits} hits");
    // The condition is given the record, several hits have theirs.
    let kernel = kernel!(|ray: Ray| {
        let high = bvh.closest_hit_where(ray, |found: Landing| found.height > 1.0);
        let hits = bvh.multi_hit_where::<2>(ray, |found: Landing| found.height < 1.5);
        let tall = bvh.multi_hit_by::<2>(ray, |a: Hit, b: Hit| a.prim_id % 7 > b.prim_id % 7);
        (high, hits[1], tall[0], bvh.any_hit_where(ray, |found: Landing| found.height > 1.5))
    });
    assert_variants_agree!(&kernel, &rays);
}

#[test]
fn hits_in_an_order_of_ones_own() {
    let mut rng = Rng::of("order");
    let balls = balls(&mut rng, 60);
    let bvh = Bvh::build(&balls).expect("finite bounds");
    let (rays, slice) = (rays(&mut rng, 2000), &balls[..]);
    // Large balls first; of equal ones, the nearer.
    let step = |id: u32| (balls[id as usize].radius * 8.0) as u32;
    for (ray,) in &rays {
        let mut all: Vec<Hit> = slice.multi_hit::<60>(*ray).to_vec();
        all.retain(|h| h.is_hit);
        all.sort_by_key(|h| core::cmp::Reverse(step(h.prim_id)));
        all.resize(3, Hit::miss());
        let closer = |a: Hit, b: Hit| step(a.prim_id) > step(b.prim_id);
        assert_eq!(bvh.multi_hit_by::<3>(*ray, closer)[..], all);
        // An order that is not strict means the same.
        let as_close = |a: Hit, b: Hit| step(a.prim_id) >= step(b.prim_id);
        assert_eq!(bvh.multi_hit_by::<3>(*ray, as_close)[..], all);
        assert_eq!(slice.multi_hit_by::<3>(*ray, closer)[..], all);
    }
    let kernel = kernel!(|ray: Ray| {
        let of_tree = bvh.multi_hit_by::<3>(ray, |a: Hit, b: Hit| {
            let (one, other) = (bvh.primitive(a).radius * 8.0, bvh.primitive(b).radius * 8.0);
            one as u32 > other as u32
        });
        let of_slice =
            slice.multi_hit_by::<2>(ray, |a: Hit, b: Hit| a.prim_id & 7 >= b.prim_id & 7);
        (of_tree[0], of_tree[2], of_slice[0], of_slice[1])
    });
    assert_variants_agree!(&kernel, &rays);
}

/// A point as a file holds it.
#[primitive(sphere(center, radius.to_f32()))]
#[derive(Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
struct Point {
    center: Vec3,
    radius: Unorm8,
    color: [Unorm8; 3],
}

fn points(count: usize) -> Vec<Point> {
    let mut rng = Rng::of("points");
    let mut share = || Unorm8::new(rng.range(0.1, 1.0));
    let (radii, colors): (Vec<_>, Vec<_>) =
        (0..count).map(|_| (share(), [share(), share(), share()])).unzip();
    let mut rng = Rng::of("centers");
    let point = |(radius, color)| Point { center: rng.point(6.0), radius, color };
    radii.into_iter().zip(colors).map(point).collect()
}

/// Primitives that lie in a file: nothing is read before a ray asks for it, and nothing is copied.
#[test]
#[allow(unsafe_code, reason = "a mapped file is as safe as the application keeps it")]
fn a_tree_over_a_mapped_file() -> std::io::Result<()> {
    let points = points(500);
    let path = std::env::temp_dir().join(format!("raydsl-points-{}", std::process::id()));
    std::fs::write(&path, bytemuck::cast_slice(&points))?;
    // ANCHOR: mapped
    let file = std::fs::File::open(&path)?;
    // SAFETY: the file is this test's own, and nobody writes to it while it is mapped.
    let map = unsafe { memmap2::Mmap::map(&file)? };
    let mapped: &[Point] = bytemuck::try_cast_slice(&map).expect("whole points");
    let bvh = Bvh::build(mapped).expect("finite bounds");
    // ANCHOR_END: mapped
    assert!(core::ptr::eq(bvh.primitives().as_ptr().cast(), map.as_ptr()));
    let rays = rays(&mut Rng::of("mapped"), 1000);
    let slice = &points[..];
    let hits = rays.iter().filter(|(ray,)| {
        let hit = bvh.closest_hit(*ray);
        assert_eq!(hit, slice.closest_hit(*ray));
        hit.is_hit
    });
    assert!(hits.count() > 300);
    let kernel = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        (hit, bvh.primitive(hit).color[1].to_f32())
    });
    assert_variants_agree!(&kernel, &rays);
    drop(file);
    std::fs::remove_file(&path)
}

#[cfg(feature = "gpu")]
mod on_a_gpu {
    use raydsl::gpu::{GpuError, GpuWindow};
    use raydsl::prelude::*;
    use raydsl_tests::rng::Rng;

    use super::{mesh, models, points, rays};

    fn filled(gpu: &GpuScheduler, bytes: &[u8]) -> wgpu::Buffer {
        let buffer = gpu.context().device().create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes.len() as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        gpu.context().queue().write_buffer(&buffer, 0, bytes);
        buffer
    }

    fn window(gpu: &GpuScheduler, bytes: &[u8]) -> GpuWindow {
        GpuWindow { buffer: filled(gpu, bytes), offset: 0, size: bytes.len() as u64 }
    }

    /// Runs a kernel, and gives the bytes that were sent for it.
    fn sent<R: Type + PartialEq + std::fmt::Debug>(
        gpu: &GpuScheduler,
        kernel: &Kernel<'_, (Ray,), R>,
        rays: &[(Ray,)],
    ) -> Result<u64, GpuError> {
        let before = gpu.context().uploaded_bytes();
        let zero = R::read(&[0; 64]);
        let mut found = vec![zero; rays.len()];
        gpu.batch(kernel, rays, &mut found)?;
        assert!(rays.iter().zip(&found).all(|(ray, found)| kernel.call(*ray) == *found));
        Ok(gpu.context().uploaded_bytes() - before)
    }

    /// A scene is sent once for all kernels, and not at all where the application has it.
    #[test]
    fn trees_over_buffers_of_the_application() -> Result<(), GpuError> {
        if raydsl_tests::gpu::gpu().is_none() {
            return Ok(());
        }
        let (points, rays) = (points(500), rays(&mut Rng::of("windows"), 300));
        let bvh = Bvh::build(&points).expect("finite bounds");
        let own = bvh.bytes() as u64;
        let closest = kernel!(|ray: Ray| bvh.closest_hit(ray));
        let any = kernel!(|ray: Ray| bvh.any_hit(ray));
        let gpu = GpuScheduler::new()?;
        {
            let points_buffer = filled(&gpu, bytemuck::cast_slice(&points));
            let size = size_of_val(&points[..]) as u64;
            // ANCHOR: window
            let window = GpuWindow { buffer: points_buffer, offset: 0, size };
            let _window = gpu.with_gpu(&bvh, window)?;
            // ANCHOR_END: window
            assert_eq!(sent(&gpu, &closest, &rays)?, own);
            assert_eq!(sent(&gpu, &any, &rays)?, 0);
        }
        assert_eq!(sent(&gpu, &any, &rays)?, 16 * points.len() as u64);
        assert_eq!(sent(&gpu, &closest, &rays)?, 0);
        Ok(())
    }

    #[test]
    fn meshes_in_buffers_of_the_application() -> Result<(), GpuError> {
        if raydsl_tests::gpu::gpu().is_none() {
            return Ok(());
        }
        let ((vertices, indexed), rays) = (mesh(12), rays(&mut Rng::of("meshes"), 300));
        let config = BuildConfig::default();
        let bvh = Bvh::build_sharing(&indexed, &vertices, &config).expect("finite bounds");
        let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
        let gpu = GpuScheduler::new()?;
        let _triangles = gpu.with_gpu(&bvh, window(&gpu, bytemuck::cast_slice(&indexed)))?;
        let own = window(&gpu, bytemuck::cast_slice(&vertices));
        let _vertices = gpu.with_gpu(bvh.view().shared(), own)?;
        assert_eq!(sent(&gpu, &kernel, &rays)?, bvh.bytes() as u64);
        Ok(())
    }

    /// What belongs to trees that are no more is freed, so that a scene built for each frame fits.
    #[test]
    fn trees_that_are_no_more_are_freed() -> Result<(), GpuError> {
        if raydsl_tests::gpu::gpu().is_none() {
            return Ok(());
        }
        let (points, rays) = (points(100), rays(&mut Rng::of("freed"), 64));
        let gpu = GpuScheduler::new()?;
        for _ in 0..4 {
            let bvh = Bvh::build(&points).expect("finite bounds");
            let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
            let whole = bvh.bytes() as u64 + 1600;
            assert_eq!(sent(&gpu, &kernel, &rays)?, whole);
            assert_eq!(gpu.context().scene_bytes(), whole);
        }
        Ok(())
    }

    /// A refitted tree sends what has changed.
    #[test]
    fn refitted_trees_send_no_indices() -> Result<(), GpuError> {
        if raydsl_tests::gpu::gpu().is_none() {
            return Ok(());
        }
        let (mut points, rays) = (points(100), rays(&mut Rng::of("refitted"), 64));
        let gpu = GpuScheduler::new()?;
        let bvh = Bvh::build(&points).expect("finite bounds");
        let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
        sent(&gpu, &kernel, &rays)?;
        drop(kernel);
        let tree = bvh.detach();
        points.iter_mut().for_each(|p| p.center.x += 0.5);
        let bvh = tree.refit(&points).expect("finite bounds");
        let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
        let nodes = size_of_val(bvh.nodes()) as u64;
        assert_eq!(sent(&gpu, &kernel, &rays)?, 1600 + nodes);
        assert_eq!(gpu.context().scene_bytes(), bvh.bytes() as u64 + 1600);
        Ok(())
    }

    /// The buffers of a list hold those of its trees, one after another.
    #[test]
    fn lists_are_sent_once() -> Result<(), GpuError> {
        if raydsl_tests::gpu::gpu().is_none() {
            return Ok(());
        }
        let mut rng = Rng::of("sent lists");
        let models = models(&mut rng);
        let trees = models.each_ref().map(|m| Bvh::build(m).expect("finite bounds"));
        let list = BvhList::new(&trees).expect("few primitives");
        let kernel = kernel!(|ray: Ray| list.closest_hit(ray));
        let rays = rays(&mut rng, 300);
        let gpu = GpuScheduler::new()?;
        let own: usize = trees.iter().map(Bvh::bytes).sum();
        // A root for each tree that is not empty.
        let whole = own + 16 * models.concat().len() + 3 * 4;
        assert_eq!(sent(&gpu, &kernel, &rays)?, whole as u64);
        assert_eq!(sent(&gpu, &kernel, &rays)?, 0);
        Ok(())
    }
}
