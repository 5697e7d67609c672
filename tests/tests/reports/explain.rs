//! Which mismatches rounding accounts for: none of a wrong variant's, all of a right one's.

use std::error::Error;
use std::f32::consts::FRAC_PI_3;

use raydsl::kernel::Lifted;
use raydsl::machine::{KernelFn, KernelInfo, Rounding};
use raydsl::prelude::*;
use raydsl::testing::{
    Cause, Explanation, FilmTest, MeansTest, MeansVerdict, PairedMeans, Sample, explain,
    variants_agree,
};
use raydsl::{assert_variants_agree, kernel};
use raydsl_report::{Compare, Missing, Verdict};
use raydsl_tests::check::recorded;
use raydsl_tests::gpu::gpu;
use raydsl_tests::kernels;
use raydsl_tests::rng::Rng;
use raydsl_tests::scenes::{ColorSphere, random_rays, spheres, triangles};
use raydsl_tests::values::{Numbers, floats, random};

macro_rules! primary {
    ($bvh:ident) => {
        kernel!(|ray: Ray| {
            let hit = $bvh.closest_hit(ray);
            let color = if hit.is_hit { $bvh.primitive(hit).rgb() } else { vec3(0.1, 0.2, 0.3) };
            Shaded { color, depth: hit.t, id: hit.prim_id }
        })
    };
}

fn camera() -> Pinhole {
    Pinhole::new(vec3(1.0, 2.0, -14.0), vec3(0.2, 0.0, 0.0), vec3(0.0, 1.0, 0.0), 0.9)
}

/// The rays of a film.
fn rays(size: u32) -> Vec<Ray> {
    use raydsl::camera::Camera;
    let rays = camera().begin_frame(size, size);
    let pixel = |i: u32| rays.primary_ray((i % size) as f32 + 0.5, (i / size) as f32 + 0.5);
    (0..size * size).map(pixel).collect()
}

fn show(who: &str, found: &Explanation) {
    println!(
        "{who}: {} differ, {} by rounding, {} explained, {} unexplained; {:.3} % uncertain",
        found.causes.len(),
        found.count(Cause::Rounding),
        found.count(Cause::Decision),
        found.unexplained(),
        100.0 * found.sample.share()
    );
}

// Wrong variants.

#[test]
fn a_scaled_distance_is_a_mistake() -> Result<(), Box<dyn Error>> {
    let points = spheres(800);
    let bvh = Bvh::build(&points)?;
    let primary = primary!(bvh);
    let inputs: Vec<(Ray,)> = rays(96).into_iter().map(|r| (r,)).collect();
    let mut outputs: Vec<Shaded> = inputs.iter().map(|a| primary.call(*a)).collect();
    outputs.iter_mut().for_each(|o| o.depth *= 1.0 + 1e-5);
    let hits = outputs.iter().filter(|o| o.depth > 0.0).count();
    let found = explain(&primary, &inputs, &outputs, Rounding::IEEE);
    show("scaled", &found);
    assert!(hits > 500 && found.unexplained() * 10 > hits * 9, "{} of {hits}", found.unexplained());
    Ok(())
}

#[test]
fn a_neighbours_id_is_a_mistake() -> Result<(), Box<dyn Error>> {
    let points = spheres(800);
    let bvh = Bvh::build(&points)?;
    let primary = primary!(bvh);
    let inputs: Vec<(Ray,)> = rays(200).into_iter().map(|r| (r,)).collect();
    let mut outputs: Vec<Shaded> = inputs.iter().map(|a| primary.call(*a)).collect();
    outputs.iter_mut().skip(5).step_by(10_000).for_each(|o| o.id += 1);
    let found = explain(&primary, &inputs, &outputs, Rounding::IEEE);
    show("wrong ids", &found);
    assert_eq!((found.causes.len(), found.unexplained()), (4, 4));
    Ok(())
}

/// Rays that end exactly where they hit: the range is closed.
#[test]
fn an_open_range_is_a_mistake() -> Result<(), Box<dyn Error>> {
    let corner = |x, y| vec3(x, y, 3.0);
    let wall = [Triangle { v0: corner(0.0, 0.0), v1: corner(4.0, 0.0), v2: corner(0.0, 4.0) }];
    let bvh = Bvh::build(&wall)?;
    let occluded = kernel!(|ray: Ray| bvh.any_hit(ray));
    let ray = |i: u32| {
        let (x, y) = (0.25 * (i % 4 + 1) as f32, 0.25 * (i / 4 + 1) as f32);
        let t_max = if i.is_multiple_of(2) { 3.0 } else { 4.0 };
        Ray::new(vec3(x, y, 0.0), Vec3::Z).with_range(0.0, t_max)
    };
    let inputs: Vec<(Ray,)> = (0..16).map(|i| (ray(i),)).collect();
    let right: Vec<bool> = inputs.iter().map(|a| occluded.call(*a)).collect();
    assert!(right.iter().all(|hit| *hit));
    let open = |(ray,): &(Ray,)| {
        let hit = wall[0].intersect(*ray);
        hit.is_hit && hit.t >= ray.t_min && hit.t < ray.t_max
    };
    let outputs: Vec<bool> = inputs.iter().map(open).collect();
    let found = explain(&occluded, &inputs, &outputs, Rounding::IEEE);
    show("open range", &found);
    assert_eq!((found.causes.len(), found.unexplained()), (8, 8));
    Ok(())
}

/// Where the bounds hold everything, they hold mistakes.
#[test]
fn bounds_without_a_limit_explain_nothing() {
    let chaos = kernel!(|start: f32| {
        let mut x = start;
        for _ in 0..80u32 {
            x = 3.9 * x * (1.0 - x);
        }
        x
    });
    let inputs: Vec<(f32,)> = (1..1000).map(|i| (i as f32 * 0.001,)).collect();
    let outputs = vec![-1234.5; inputs.len()];
    let found = explain(&chaos, &inputs, &outputs, Rounding::IEEE);
    show("chaos", &found);
    assert_eq!(found.count(Cause::Rounding) + found.count(Cause::Decision), 0);
    assert_eq!(found.unexplained(), inputs.len());
    assert!(!found.sample.is_meaningful());
    // A NaN is no rounding error.
    let root = kernel!(|x: f32| {
        let d = x * x - 1.21;
        if d >= 0.0 { d.sqrt() } else { 0.0 }
    });
    let inputs = [(1.1f32,)];
    let found = explain(&root, &inputs, &[f32::NAN], Rounding::IEEE);
    assert_eq!((found.causes.len(), found.unexplained()), (1, 1));
}

/// A device that offers no more than WebGPU guarantees.
#[cfg(feature = "gpu")]
fn small_device() -> Option<GpuScheduler> {
    gpu()?;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let (device, queue) = pollster::block_on(async {
        let adapter = instance.request_adapter(&Default::default()).await.ok()?;
        adapter.request_device(&Default::default()).await.ok()
    })?;
    let context = raydsl::gpu::Context::from_wgpu(None, device, queue);
    Some(GpuScheduler::with_context(context))
}

/// A kernel that wants more buffers than the device has.
#[cfg(feature = "gpu")]
#[test]
fn a_device_that_refuses_does_not_agree() {
    let Some(gpu) = small_device() else { return };
    let all: Vec<Vec<f32>> = (0..12).map(|i| vec![i as f32; 4]).collect();
    let [a, b, c, d, e, f, g, h, i, j, k, l] = std::array::from_fn(|n| &all[n][..]);
    let sum = kernel!(|ray: Ray| {
        let n = (ray.direction.x > 0.0) as usize;
        let s = a[n] + b[n] + c[n] + d[n] + e[n] + f[n] + g[n] + h[n] + i[n] + j[n] + k[n] + l[n];
        Shaded { color: vec3(s, s, s), depth: s, id: 0 }
    });
    let found = Compare::new().size(32, 32).runs(1).gpu(&gpu).run(&sum, &camera());
    println!("{}", found.table());
    assert!(found.table().contains("refused: "));
    assert_eq!(found.verdict(), Verdict::Refused);
    assert!(!found.agrees());
    let wgsl = found.rows.iter().find(|r| r.variant == Variant::Wgsl);
    assert!(wgsl.is_some_and(|r| matches!(r.unavailable, Some(Missing::Refused(_)))));
}

#[test]
fn nothing_compared_is_no_agreement() {
    let sky = kernel!(|ray: Ray| Shaded { color: ray.direction, depth: 0.0, id: 0 });
    let empty = Compare::new().size(0, 0).runs(1).variants(&Variants::cpu());
    assert_eq!(empty.run(&sky, &camera()).verdict(), Verdict::NothingCompared);
    let alone = Compare::new().size(8, 8).runs(1).variants(&Variants::of(&[Variant::Scalar]));
    assert_eq!(alone.run(&sky, &camera()).verdict(), Verdict::NothingCompared);
}

// Right variants.

/// A cancelling sum that drivers reorder: rounding accounts for all of it, however many ulp it is.
#[test]
fn a_picture_of_reordered_sums_agrees() {
    if gpu().is_none() {
        return;
    }
    let rings = kernel!(|ray: Ray| {
        let (x, y) = (ray.direction.x, ray.direction.y);
        let d = (x * x + y * y) - 0.05;
        Shaded { color: vec3(d, d, d), depth: d, id: 0 }
    });
    let compare = || Compare::new().size(160, 120).runs(1);
    let found = compare().run(&rings, &camera());
    println!("{}", found.table());
    assert_eq!(found.verdict(), Verdict::Agree);
    assert!(found.sample.median_width_ulp < 500.0);
    // Only where somebody asks for it, numbers have to be near in ulp too.
    let strict = compare().tolerance(0).run(&rings, &camera());
    let off = strict.rows.iter().any(|r| r.agreement.max_ulp > 0);
    assert_eq!(strict.verdict(), if off { Verdict::Differ } else { Verdict::Agree });
}

/// The least (t, id) of spheres in `f64`, rounded in the end.
fn in_f64(prims: &[ColorSphere], ray: Ray) -> Shaded {
    let wide = |v: Vec3| v.as_dvec3();
    let (o, d) = (wide(ray.origin), wide(ray.direction));
    let mut best: Option<(f64, usize)> = None;
    for (id, p) in prims.iter().enumerate() {
        let f = wide(p.center) - o;
        let r = f64::from(p.radius.to_bits()) / 255.0;
        let closest = f.dot(d) / d.dot(d);
        let aside = f - d * closest;
        let half = ((r * r - aside.dot(aside)) / d.dot(d)).sqrt();
        let t = if closest - half < ray.t_min.into() { closest + half } else { closest - half };
        let hits = r > 0.0 && t >= ray.t_min.into() && t <= ray.t_max.into();
        if hits && best.is_none_or(|b| t < b.0) {
            best = Some((t, id));
        }
    }
    match best {
        Some((t, id)) => Shaded { color: prims[id].rgb(), depth: t as f32, id: id as u32 },
        None => Shaded { color: vec3(0.1, 0.2, 0.3), depth: 0.0, id: 0 },
    }
}

#[test]
fn a_variant_in_f64_is_right() -> Result<(), Box<dyn Error>> {
    let points = spheres(800);
    let bvh = Bvh::build(&points)?;
    let primary = primary!(bvh);
    let mut inputs: Vec<(Ray,)> = rays(64).into_iter().map(|r| (r,)).collect();
    inputs.extend(random_rays(21, 4000).into_iter().map(|r| (r,)));
    // Rays that graze a sphere, for which rounding decides.
    let mut rng = Rng::new(5);
    inputs.extend((0..4000).map(|i| {
        let p = points[i % points.len()];
        let origin = rng.point(12.0);
        let way = (p.center - origin).normalize();
        let aside = way.cross(rng.direction()).normalize() * p.radius.to_f32();
        (Ray::new(origin, p.center + aside - origin),)
    }));
    let outputs: Vec<Shaded> = inputs.iter().map(|(ray,)| in_f64(&points, *ray)).collect();
    let found = explain(&primary, &inputs, &outputs, Rounding::IEEE);
    show("f64", &found);
    assert_eq!(found.unexplained(), 0);
    assert!(found.count(Cause::Rounding) > 1000 && found.count(Cause::Decision) > 10);
    Ok(())
}

/// The kernels for which a device need not give the CPU's bits.
#[test]
fn elementary_functions_on_a_device_are_right() {
    fn check<F: KernelFn>(name: &str) -> usize
    where
        F::Args: Sync,
        F::Output: Sync,
    {
        let Some(gpu) = gpu() else { return 0 };
        let (kernel, mut rng) = (recorded::<F>(), Rng::of(name));
        let is_finite = |a: &F::Args| floats(a).into_iter().all(f32::is_finite);
        let all = (0..20_000).map(|_| random::<F::Args>(&mut rng, Numbers::Any));
        let inputs: Vec<F::Args> = all.filter(is_finite).collect();
        let mut outputs: Vec<F::Output> = inputs.iter().map(|a| kernel.call(*a)).collect();
        if let Err(e) = gpu.batch(&kernel, &inputs, &mut outputs) {
            panic!("{name}: {e}");
        }
        let found = explain(&kernel, &inputs, &outputs, Rounding::IEEE);
        show(name, &found);
        let worst = found.causes.iter().find(|(_, c)| *c == Cause::Unexplained);
        assert_eq!(found.unexplained(), 0, "{name}: input {worst:?}");
        found.causes.len()
    }
    let differing = check::<kernels::angles>("angles")
        + check::<kernels::growth>("growth")
        + check::<kernels::fused>("fused")
        + check::<kernels::vectors>("vectors");
    println!("{differing} results differ from the CPU's");
}

fn agrees<R: raydsl::Type>(who: &str, kernel: &Kernel<'_, (Ray,), R>, camera: &Pinhole) -> Sample {
    let found = Compare::new().size(320, 240).runs(1).run(kernel, camera);
    println!("{who}\n{}", found.table());
    assert!(found.table().lines().all(|l| l.chars().count() <= 100));
    assert_eq!(found.verdict(), Verdict::Agree);
    assert!(found.rows.iter().all(|r| r.agreement.unexplained == 0));
    assert!(found.sample.inputs > 4000);
    found.sample
}

#[test]
fn every_variant_of_the_scenes_agrees() -> Result<(), Box<dyn Error>> {
    let points = spheres(800);
    let bvh = Bvh::build(&points)?;
    assert!(agrees("spheres", &primary!(bvh), &camera()).is_meaningful());
    let soup = triangles(2000);
    let mesh = Bvh::build(&soup)?;
    let faces = kernel!(|ray: Ray| {
        let hit = mesh.closest_hit(ray);
        Shaded { color: vec3(hit.u, hit.v, 0.0), depth: hit.t, id: hit.prim_id }
    });
    assert!(agrees("triangles", &faces, &camera()).is_meaningful());
    // Edges of shadows, and a point in the air between triangles that cross.
    let shadows = kernel!(|ray: Ray| {
        let hit = mesh.closest_hit(ray);
        let lit = !mesh.any_hit(Ray {
            origin: ray.at(hit.t * 0.999),
            direction: vec3(0.3, 1.0, -0.2),
            t_min: 0.0,
            t_max: 100.0,
        });
        Shaded { color: vec3(hit.u, hit.v, lit as u32 as f32), depth: hit.t, id: hit.prim_id }
    });
    assert!(agrees("shadows of triangles", &shadows, &camera()).is_meaningful());
    Ok(())
}

#[test]
fn every_variant_of_sibenik_agrees() -> Result<(), Box<dyn Error>> {
    let Some(folder) = std::env::var_os("RAYDSL_DATA") else {
        eprintln!("SKIPPED: RAYDSL_DATA does not name the folder with sibenik.tri");
        return Ok(());
    };
    let bytes = std::fs::read(std::path::Path::new(&folder).join("sibenik.tri"))?;
    let numbers: Vec<f32> =
        bytes[4..].chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    let point = |n: &[f32]| vec3(n[0], n[1], n[2]);
    let face = |n: &[f32]| Triangle { v0: point(n), v1: point(&n[3..]), v2: point(&n[6..]) };
    let faces: Vec<Triangle> = numbers.chunks_exact(9).map(face).collect();
    let bvh = Bvh::build(&faces)?;
    let kernel = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        Shaded { color: vec3(hit.u, hit.v, 0.0), depth: hit.t, id: hit.prim_id }
    });
    let camera = Pinhole::new(vec3(-17.5, -9.0, 0.5), vec3(5.0, -10.0, -0.5), Vec3::Y, FRAC_PI_3);
    // Some walls of the model are there twice, in two triangulations: they stay open.
    assert!(agrees("sibenik", &kernel, &camera).is_meaningful());
    Ok(())
}

// Paths: single samples say little, since one decision changes all that follows.

/// The light of one path among four balls. The origin is shifted by `shift`: rounding decides
/// anew, right in the mean. All light is `gain` times as bright, and a path ends too late by
/// `late`.
#[kernel]
fn bounced(first: Ray, mut sampler: Sampler, shift: f32, gain: f32, late: f32) -> Vec3 {
    let mut ray = first;
    ray.origin += vec3(shift, shift, -shift);
    let mut throughput = vec3(1.0, 1.0, 1.0);
    for bounce in 0..12u32 {
        let mut best = 1e30;
        let mut center = Vec3::ZERO;
        for i in 0..4u32 {
            let x = (i % 2) as f32;
            let y = (i / 2) as f32;
            let c = vec3(2.0 * x - 1.0, 2.0 * y - 1.0, 0.7 * x * y);
            let hit = sphere::intersect(ray, c, 0.97);
            if hit.is_hit && hit.t < best {
                best = hit.t;
                center = c;
            }
        }
        if best == 1e30 {
            let sky = 0.1 + 0.9 * max(ray.direction.y, 0.0);
            return throughput * vec3(sky, 0.5, 1.0 - 0.5 * sky) * gain;
        }
        let position = ray.at(best);
        let normal = (position - center).normalize();
        throughput *= vec3(0.9, 0.7, 0.5);
        if bounce > 2 {
            let chance = throughput.x;
            if sampler.next_1d() >= chance + late {
                break;
            }
            throughput /= chance;
        }
        let u = sampler.next_2d();
        let direction = Frame::around(normal).to_world(sample_cosine_hemisphere(u));
        ray = Ray { origin: position + normal * 1e-4, direction, t_min: 0.0, t_max: 1e30 };
    }
    vec3(0.0, 0.0, 0.0)
}

#[kernel]
fn path(ray: Ray, sampler: Sampler) -> Vec3 {
    bounced(ray, sampler, 0.0, 1.0, 0.0)
}

#[kernel]
fn path_rounded_otherwise(ray: Ray, sampler: Sampler) -> Vec3 {
    bounced(ray, sampler, 1e-5, 1.0, 0.0)
}

#[kernel]
fn brighter_path(ray: Ray, sampler: Sampler) -> Vec3 {
    bounced(ray, sampler, 1e-5, 1.01, 0.0)
}

#[kernel]
fn longer_path(ray: Ray, sampler: Sampler) -> Vec3 {
    bounced(ray, sampler, 1e-5, 1.0, 0.1)
}

/// `path`, with another kernel's WGSL.
macro_rules! path_with_wgsl_of {
    ($wgsl:ident) => {{
        static INFO: KernelInfo =
            KernelInfo { name: "path", file: "f.rs", line: 7, params: &[], known: None };
        let lifted = Lifted {
            native4: Some(Box::new(path::lifted)),
            native8: Some(Box::new(path::lifted)),
            native16: Some(Box::new(path::lifted)),
            recorder: Some(Box::new($wgsl::lifted)),
            margin: Some(Box::new(path::lifted)),
        };
        Kernel::scalar(&INFO, path::scalar).lifted(lifted, |_| {})
    }};
}

fn balls() -> Pinhole {
    Pinhole::new(vec3(0.5, 0.3, 6.0), Vec3::ZERO, Vec3::Y, 0.7)
}

/// A comparison of films that a test can afford.
fn films<R: Radiance>(kernel: &Kernel<'_, (Ray, Sampler), R>) -> raydsl_report::Comparison<R> {
    let found = Compare::new().size(32, 24).runs(1).samples(64).run_film(kernel, &balls());
    println!("{}", found.table());
    assert!(found.table().lines().all(|l| l.chars().count() <= 100));
    assert!(found.rows.iter().all(|r| r.differing_means == 0));
    found
}

#[test]
fn paths_agree_in_their_means() {
    let right = films(&Kernel::of::<path>());
    let Some(means) = right.means else { return };
    assert!(right.agrees());
    assert!(means.light[0].worst <= 0.01, "it would find one per cent:\n{means}");
    // A device that rounds in another way: single samples say little.
    let other = films(&path_with_wgsl_of!(path_rounded_otherwise));
    assert!(other.scalar().agreement.is_bit_identical());
    let means = other.means.map(|m| m.verdict());
    assert_eq!(means, Some(MeansVerdict::Agree));
    let json = other.json(&raydsl_report::SceneInfo::default());
    assert_eq!(json["means"]["verdict"], "agree");
}

#[test]
fn biased_paths_differ() {
    for kernel in [path_with_wgsl_of!(brighter_path), path_with_wgsl_of!(longer_path)] {
        let found = films(&kernel);
        let Some(means) = found.means else { return };
        assert_eq!(found.verdict(), Verdict::Differ);
        assert_eq!(means.verdict(), MeansVerdict::Differ, "{means}");
    }
}

/// The same over many seeds, on the CPU.
#[test]
fn any_seed_finds_a_bias_and_nothing_else() {
    let test = |seed| MeansTest::new().sampling(Sampling::new(4).seed(seed));
    let verdict = |kernel: &Kernel<'_, (Ray, Sampler), Vec3>, seed: u32| {
        let (expected, test) = (Kernel::of::<path>(), test(seed));
        let mut means = PairedMeans::new(&test, 24, 24);
        for sampling in test.replications() {
            let film = |kernel| {
                let mut film = Film::new(24, 24);
                let n = sampling.planned;
                TiledScheduler::new().accumulate(&balls(), kernel, &sampling, &mut film, n);
                film
            };
            means.add(&film(&expected), &film(kernel));
        }
        means.agreement()
    };
    for seed in 0..12 {
        let right = verdict(&Kernel::of::<path_rounded_otherwise>(), seed);
        assert_eq!(right.verdict(), MeansVerdict::Agree, "{seed}\n{right}");
        assert!(right.light[2].z > 0.0, "some paths go another way:\n{right}");
        for mutant in [Kernel::of::<brighter_path>(), Kernel::of::<longer_path>()] {
            let wrong = verdict(&mutant, seed);
            assert_eq!(wrong.verdict(), MeansVerdict::Differ, "{seed}\n{wrong}");
        }
    }
}

#[test]
fn assertions_take_films() {
    assert_variants_agree!(path, &FilmTest::new(&balls(), 16, 16));
    if gpu().is_none() {
        return;
    }
    let camera = balls();
    let film = FilmTest::new(&camera, 24, 24);
    let (other, biased) =
        (path_with_wgsl_of!(path_rounded_otherwise), path_with_wgsl_of!(brighter_path));
    assert_eq!(variants_agree(&other, &film, Rounding::WGSL), Ok(()));
    let error = variants_agree(&biased, &film, Rounding::WGSL).expect_err("a bias of 1 %");
    println!("{error}");
    assert!(error.to_string().contains("the means differ"));
}
