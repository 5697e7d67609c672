//! The integrators: every variant, against references in `f64` and in closed form.

use std::error::Error;

use glam::DVec3;
use raydsl::bsdf::Lambert;
use raydsl::bvh::{Cost, Node};
use raydsl::integrators::{
    ambient_occlusion, aovs, bvh_cost, bvh_cost_color, clamped, direct_light, heat_color,
};
use raydsl::light::{AnyLight, DirectionalLight, Lights, PointLight};
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::testing::run;
use raydsl::{assert_variants_agree, kernel};
use raydsl_tests::gpu::gpu;
use raydsl_tests::scenes::{broken_rays, random_rays, triangles};

const CPU: [Variant; 4] = [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16];

/// A sphere of one colour.
#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
    color: Vec3,
}

#[kernel]
impl Surface for Ball {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        self.color
    }
}

/// What is not finite stays for the film to count, in every component.
#[test]
fn colors_that_are_not_finite_are_not_clamped() {
    let (nan, infinite) = (f32::NAN, f32::INFINITY);
    for [x, y, z] in [[5.0, nan, 0.0], [nan, 5.0, 0.0], [0.0, 5.0, nan], [5.0, 0.0, -infinite]] {
        let color = vec4(x, y, z, 1.0);
        let (kept, lost) = clamped(color, 2.0);
        assert_eq!(kept.to_array().map(f32::to_bits), color.to_array().map(f32::to_bits));
        assert_eq!(lost, Vec3::ZERO, "{color}");
    }
    assert_eq!(
        clamped(vec4(4.0, 1.0, 0.0, 1.0), 2.0),
        (vec4(2.0, 0.5, 0.0, 1.0), vec3(2.0, 0.5, 0.0))
    );
}

fn balls(count: u32) -> Vec<Ball> {
    let mut rng = Rng::new(UVec2::ZERO, 0, 3);
    let mut ball = |_| {
        let (at, color) = (rng.next_3d() * 6.0 - 3.0, rng.next_3d());
        Ball { center: at, radius: 0.1 + 0.6 * rng.next_f32(), color }
    };
    (0..count).map(&mut ball).collect()
}

/// Where a ray meets a ball in `f64`, and how far the answer is from another one.
fn meets(ball: &Ball, origin: DVec3, direction: DVec3) -> (Option<f64>, f64) {
    let (center, radius) = (ball.center.as_dvec3(), f64::from(ball.radius));
    let d = direction.normalize();
    let along = (center - origin).dot(d);
    let beside = (center - origin - along * d).length();
    let (edge, half) = ((beside - radius).abs(), (radius * radius - beside * beside).sqrt());
    let near = [along - half, along + half].into_iter().find(|t| *t > 1e-6);
    let margin = if half.is_nan() { edge } else { edge.min((along + half).abs()) };
    (near.map(|t| t / direction.length()), margin)
}

/// The closest ball, and the least margin of all.
fn closest(balls: &[Ball], origin: DVec3, direction: DVec3) -> (Option<(f64, Ball)>, f64) {
    let all = balls.iter().map(|b| (b, meets(b, origin, direction)));
    let margin = all.clone().map(|(_, (_, margin))| margin).fold(f64::INFINITY, f64::min);
    let hits = all.filter_map(|(b, (t, _))| Some((t?, *b)));
    (hits.min_by(|a, b| a.0.total_cmp(&b.0)), margin)
}

/// What `direct_light` should give in `f64`, if rounding decides nothing.
fn lit(
    balls: &[Ball],
    lamps: &[PointLight],
    suns: &[DirectionalLight],
    shadows: bool,
    ray: Ray,
) -> Option<[f64; 4]> {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (seen, margin) = closest(balls, origin, direction);
    if margin < 1e-4 {
        return None;
    }
    let Some((t, ball)) = seen else { return Some([0.0; 4]) };
    let point = origin + t * direction;
    let outside = (point - ball.center.as_dvec3()).normalize();
    let is_inside = outside.dot(direction) > 0.0;
    let normal = if is_inside { -outside } else { outside };
    // Balls are convex: no ball darkens its own outside, and every one its inside.
    let others: Vec<Ball> = balls.iter().filter(|b| b.center != ball.center).copied().collect();
    let from_lamps = lamps.iter().map(|l| {
        let way = l.position.as_dvec3() - point;
        (way, 1.0, l.intensity.as_dvec3() * normal.dot(way.normalize()) / way.length_squared())
    });
    let from_suns = suns.iter().map(|l| {
        let way = l.direction.as_dvec3();
        (way, f64::INFINITY, l.irradiance.as_dvec3() * normal.dot(way))
    });
    let mut sum = DVec3::ZERO;
    for (way, end, light) in from_lamps.chain(from_suns).filter(|(way, ..)| normal.dot(*way) > 0.0)
    {
        let (between, margin) = closest(&others, point, way);
        if shadows && margin < 1e-4 {
            return None;
        }
        let is_dark = shadows && (is_inside || between.is_some_and(|(t, _)| t < end));
        sum += if is_dark { DVec3::ZERO } else { light };
    }
    let color = ball.color.as_dvec3() * sum / std::f64::consts::PI;
    Some([color.x, color.y, color.z, 1.0])
}

#[test]
fn direct_light_is_what_f64_says() -> Result<(), Box<dyn Error>> {
    let balls = balls(24);
    let scene = Bvh::build(&balls)?;
    let lamp = |x, y, z, intensity| PointLight { position: vec3(x, y, z), intensity };
    let lamps =
        [lamp(0.0, 5.0, 1.0, vec3(30.0, 20.0, 4.0)), lamp(-4.0, 0.5, 3.0, vec3(0.0, 9.0, 20.0))];
    let direction = vec3(0.6, 0.0, -0.8);
    let suns = [DirectionalLight { direction, irradiance: vec3(1.0, 0.5, 2.0), sine: 0.0 }];
    let sampler = Sampler::default();
    let rays: Vec<(Ray,)> = random_rays(5, 3000)
        .into_iter()
        .map(|ray| (Ray::new(ray.origin, ray.direction),))
        .chain(broken_rays().into_iter().map(|ray| (ray,)))
        .collect();
    for (lamps, suns, shadows) in
        [(&lamps[..], &suns[..], true), (&lamps, &suns, false), (&lamps[..1], &[], true)]
    {
        let points = lamps.iter().copied().map(AnyLight::Point);
        let all: Vec<AnyLight> =
            points.chain(suns.iter().copied().map(AnyLight::Directional)).collect();
        let lights = Lights::new(&all, scene.bounds())?;
        let kernel = kernel!(|ray: Ray| {
            let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
            direct_light::<_, _, Lambert>(&scene, surface, &lights, host(shadows), ray, sampler)
        });
        assert_variants_agree!(&kernel, &rays);
        let mut compared = 0;
        for (ray,) in &rays[..3000] {
            let Some(expected) = lit(&balls, lamps, suns, shadows, *ray) else { continue };
            let found = kernel.call((*ray,)).to_array().map(f64::from);
            for (e, f) in expected.iter().zip(found) {
                assert!((e - f).abs() <= 2e-4 * (1.0 + e), "{ray:?}: {expected:?} {found:?}");
            }
            compared += usize::from(expected[3] == 1.0 && expected[..3].iter().any(|c| *c > 0.0));
        }
        assert!(compared > 100, "{compared} lit points");
    }
    Ok(())
}

/// Without shadows a kernel has no shadow ray.
#[test]
fn what_has_no_shadows_asks_for_none() -> Result<(), Box<dyn Error>> {
    let balls = balls(3);
    let scene = Bvh::build(&balls)?;
    let lamps = [PointLight { position: Vec3::Y, intensity: Vec3::ONE }];
    let lights = Lights::new(&lamps, scene.bounds())?;
    let sampler = Sampler::default();
    let texts = [true, false].map(|shadows| {
        let kernel = kernel!(|ray: Ray| {
            let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
            direct_light::<_, _, Lambert>(&scene, surface, &lights, host(shadows), ray, sampler)
        });
        kernel.wgsl()
    });
    assert!(texts[0].contains("any_hit") && !texts[1].contains("any_hit"), "{}", texts[1]);
    Ok(())
}

/// A full, a gibbous and a half moon of a matt white ball: `(2/3π) (sin a + (π - a) cos a)`.
#[test]
fn phases_of_a_ball() -> Result<(), Box<dyn Error>> {
    let balls = [Ball { center: Vec3::ZERO, radius: 1.0, color: Vec3::ONE }];
    let scene = Bvh::build(&balls)?;
    let camera = Orthographic::new(vec3(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 2.1);
    for (degrees, expected) in [(0.0f64, 2.0 / 3.0), (60.0, 0.405998520), (90.0, 0.212206590)] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let direction = vec3(sin as f32, 0.0, cos as f32);
        let irradiance = Vec3::splat(std::f32::consts::PI);
        let suns = [DirectionalLight { direction, irradiance, sine: 0.0 }];
        let lights = Lights::new(&suns, scene.bounds())?;
        let (shadows, sampler) = (true, Sampler::default());
        let kernel = kernel!(|ray: Ray| {
            let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
            direct_light::<_, _, Lambert>(&scene, surface, &lights, host(shadows), ray, sampler)
        });
        let mut film = Film::new(64, 64);
        TiledScheduler::new().accumulate(&camera, &kernel, &Sampling::new(64), &mut film, 64);
        let sum: Vec4 = film.image().pixels().iter().sum();
        let mean = f64::from(sum.x) / f64::from(sum.w);
        assert!((mean - expected).abs() < 2e-4, "{degrees}: {mean} {expected}");
    }
    Ok(())
}

/// A flat round plate.
#[primitive(disk(center, normal, radius))]
struct Plate {
    center: Vec3,
    normal: Vec3,
    radius: f32,
}

#[kernel]
impl Surface for Plate {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::ONE
    }
}

/// Over a floor, a plate with this centre and radius, how far rays go, and which share is open:
/// that of Howell's catalogue of configuration factors; a ceiling that is near leaves `(h/r)²`.
const PLATES: [(Vec3, f32, f32, f64); 3] = [
    (Vec3::new(0.0, 0.0, 2.0), 1.0, 100.0, 0.8),
    (Vec3::new(1.5, 0.0, 1.0), 1.0, 100.0, 0.873_704_659_341_83),
    (Vec3::new(0.0, 0.0, 1.0), 1000.0, 1.6, 0.390_625),
];

#[test]
fn ambient_occlusion_is_the_form_factor() -> Result<(), Box<dyn Error>> {
    const SAMPLES: u32 = 1 << 20;
    for (center, size, radius, expected) in PLATES {
        let floor = Plate { center: Vec3::ZERO, normal: Vec3::Z, radius: 0.1 };
        let plates = [floor, Plate { center, normal: Vec3::NEG_Z, radius: size }];
        let scene = Bvh::build(&plates)?;
        let method = SampleMethod::Random;
        let down = Ray::new(vec3(0.0, 0.0, 0.5), Vec3::NEG_Z);
        let kernel = kernel!(|ray: Ray, i: u32, seed: u32| {
            let sampler = Sampler::new(uvec2(i % 1024, i / 1024), seed, 0, 1, method);
            ambient_occlusion::<_, 4>(&scene, radius, ray, sampler)
        });
        for seed in 0..2 {
            let inputs: Vec<(Ray, u32, u32)> = (0..SAMPLES).map(|i| (down, i, seed)).collect();
            let samples = run(&kernel, Variant::widest(), &inputs);
            let mean = samples.iter().map(|v| f64::from(v.x)).sum::<f64>() / f64::from(SAMPLES);
            let error = (expected * (1.0 - expected) / (4.0 * f64::from(SAMPLES))).sqrt();
            assert!((mean - expected).abs() < 4.0 * error, "{center} {seed}: {mean}, {expected}");
        }
        let inputs: Vec<(Ray, u32, u32)> = (0..2000).map(|i| (down, i, 9)).collect();
        assert_variants_agree!(&kernel, &inputs);
    }
    Ok(())
}

#[test]
fn ambient_occlusion_in_every_variant() -> Result<(), Box<dyn Error>> {
    let soup = triangles(500);
    let scene = Bvh::build(&soup)?;
    for method in [SampleMethod::Stratified, SampleMethod::Sobol] {
        let kernel = kernel!(|ray: Ray, sampler: Sampler| {
            ambient_occlusion::<_, 4>(&scene, 1.5, ray, sampler)
        });
        let camera = Pinhole::new(vec3(2.0, 3.0, 16.0), Vec3::ZERO, Vec3::Y, 0.8);
        let film = |scheduler: &dyn Fn(&Sampling, &mut Film)| {
            let mut film = Film::new(37, 23);
            scheduler(&Sampling::new(16).method(method), &mut film);
            film
        };
        let expected = film(&|s, f| SimpleScheduler::new().accumulate(&camera, &kernel, s, f, 16));
        let grey = expected.image().pixels().iter().filter(|p| p.x > 0.0 && p.x < p.w).count();
        assert!(grey > 30, "{grey} pixels are partly open");
        for v in CPU {
            let tiled = TiledScheduler::new().variant(v);
            let found = film(&|s, f| tiled.accumulate(&camera, &kernel, s, f, 16));
            assert!(found == expected, "{v:?}");
        }
        if let Some(gpu) = gpu() {
            let mut found = Film::new(37, 23);
            let sampling = Sampling::new(16).method(method);
            gpu.accumulate(&camera, &kernel, &sampling, &mut found, 16)?;
            let (found, expected) = (found.image(), expected.image());
            let pairs = found.pixels().iter().zip(expected.pixels());
            // A sample that rounding sends past an edge is 1/16 of a pixel.
            let off = pairs.filter(|(f, e)| (**f - **e).abs().max_element() > 1e-6).count();
            assert!(off <= found.pixels().len() / 100, "{off} pixels differ on the device");
        }
    }
    Ok(())
}

/// What a ray costs by a walk without a stack, in `f64`, and boxes that are widened as `SLACK`
/// says.
fn plain_cost(bvh: &Bvh<'_, Triangle>, ray: Ray) -> Cost {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let root = &bvh.nodes()[0];
    let reach = (root.min - ray.origin).abs().max((root.max - ray.origin).abs()).max_element();
    let pad = f64::from(triangle::SLACK * reach);
    let enter = |node: &Node, limit: f64| {
        let (low, high) = (node.min.as_dvec3() - pad, node.max.as_dvec3() + pad);
        let (a, b) = ((low - o) / d, (high - o) / d);
        let near = a.min(b).max_element().max(f64::from(ray.t_min));
        (near <= a.max(b).min_element().min(limit)).then_some(near)
    };
    fn walk(
        bvh: &Bvh<'_, Triangle>,
        ray: Ray,
        node: &Node,
        enter: &dyn Fn(&Node, f64) -> Option<f64>,
        limit: &mut f64,
        cost: &mut Cost,
    ) {
        if node.is_leaf() {
            for &id in &bvh.indices()[node.first as usize..][..node.count as usize] {
                cost.primitives += 1;
                let hit = bvh.primitives()[id as usize].intersect(ray);
                if hit.is_hit && hit.t >= ray.t_min && hit.t <= ray.t_max {
                    *limit = limit.min(f64::from(hit.t));
                }
            }
            return;
        }
        cost.nodes += 2;
        let children = &bvh.nodes()[node.first as usize..][..2];
        let mut entered: Vec<_> =
            children.iter().filter_map(|c| Some((enter(c, *limit)?, c))).collect();
        entered.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (t, child) in entered {
            if t <= *limit {
                walk(bvh, ray, child, enter, limit, cost);
            }
        }
    }
    let (mut cost, mut limit) = (Cost { nodes: 1, primitives: 0 }, f64::from(ray.t_max));
    if enter(root, limit).is_some() {
        walk(bvh, ray, root, &enter, &mut limit, &mut cost);
    }
    cost
}

#[test]
fn costs_are_those_of_each_ray_alone() -> Result<(), Box<dyn Error>> {
    let soup = triangles(700);
    let scene = Bvh::build(&soup)?;
    let rays: Vec<(Ray,)> =
        random_rays(23, 2000).into_iter().chain(broken_rays()).map(|r| (r,)).collect();
    let kernel = kernel!(|ray: Ray| bvh_cost(&scene, ray));
    let expected: Vec<Cost> = rays.iter().map(|r| scene.closest_hit_with_cost(r.0).1).collect();
    for v in CPU {
        assert_eq!(run(&kernel, v, &rays), expected, "{v:?}");
    }
    let plain = rays.iter().map(|r| plain_cost(&scene, r.0));
    let same = plain.zip(&expected).take(2000).filter(|(a, b)| a == *b).count();
    assert!(same > 1980, "{same} of 2000 cost what a plain walk costs");
    if let Some(gpu) = gpu() {
        let mut found = vec![Cost::default(); rays.len()];
        gpu.batch(&kernel, &rays, &mut found)?;
        let same = found.iter().zip(&expected).filter(|(a, b)| a == b).count();
        assert!(same >= rays.len() * 99 / 100, "{same} of {} on the device", rays.len());
    }
    Ok(())
}

/// Other scenes count, too: slices, lists, instances in groups.
#[test]
fn costs_of_every_scene() -> Result<(), Box<dyn Error>> {
    let soup = triangles(60);
    let (some, others) = soup.split_at(25);
    let trees = [Bvh::build(some)?, Bvh::build(others)?];
    let list = BvhList::new(&trees)?;
    let turned = Affine3::from_scale(vec3(0.5, 1.0, 2.0));
    let places = [Instance::new(0, Affine3::IDENTITY), Instance::new(1, turned)];
    let placed = Instances::build(&trees, &places)?;
    let slice = &soup[..];
    let kernel = kernel!(|ray: Ray| {
        let (a, of_slice) = slice.closest_hit_with_cost(ray);
        let (b, of_list) = list.closest_hit_with_cost(ray);
        let (c, of_places) = placed.closest_hit_with_cost(ray);
        (a.t, of_slice, b.t, of_list, c.t, of_places)
    });
    let rays: Vec<(Ray,)> = random_rays(29, 1000).into_iter().map(|r| (r,)).collect();
    let expected = run(&kernel, Variant::Scalar, &rays);
    for ((ray,), row) in rays.iter().zip(&expected) {
        let hits = (slice.closest_hit(*ray), list.closest_hit(*ray), placed.closest_hit(*ray));
        assert_eq!((row.0, row.2, row.4), (hits.0.t, hits.1.t, hits.2.t));
        assert_eq!(row.1, Cost { nodes: 0, primitives: 60 });
        assert!(row.3.nodes >= 2 && row.5.nodes >= 1, "{row:?}");
    }
    for v in CPU {
        assert_eq!(run(&kernel, v, &rays), expected, "{v:?}");
    }
    if let Some(gpu) = gpu() {
        let mut found = expected.clone();
        found.fill(Default::default());
        gpu.batch(&kernel, &rays, &mut found)?;
        let costs = |row: &(f32, Cost, f32, Cost, f32, Cost)| (row.1, row.3, row.5);
        let same = found.iter().zip(&expected).filter(|(a, b)| costs(a) == costs(b)).count();
        assert!(same >= 990, "{same} of 1000 on the device");
    }
    Ok(())
}

/// The colour map by the coefficients that d3 has for it, in `f64`: codes of sRGB up to 255.
fn turbo(t: f64) -> [f64; 3] {
    let red = [34.61, 1172.33, -10793.56, 33300.12, -38394.49, 14825.05];
    let green = [23.31, 557.33, 1225.33, -3574.96, 1073.77, 707.56];
    let blue = [27.2, 3211.1, -15327.97, 27814.0, -22569.18, 6838.66];
    [red, green, blue].map(|c| c.iter().rev().fold(0.0, |sum, c| sum * t + c).clamp(0.0, 255.0))
}

#[test]
fn heat_is_turbo() -> Result<(), Box<dyn Error>> {
    let inputs: Vec<(f32,)> = (-20..=120).map(|i| (i as f32 * 0.01,)).collect();
    let more = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY].map(|x| (x,));
    let inputs: Vec<(f32,)> = inputs.into_iter().chain(more).collect();
    assert_variants_agree!(heat_color, &inputs);
    for (x,) in &inputs[..141] {
        let codes = heat_color(*x).to_array().map(|c| f64::from(linear_to_srgb(c)) * 255.0);
        for (found, expected) in codes.into_iter().zip(turbo(f64::from(*x).clamp(0.0, 1.0))) {
            assert!((found - expected).abs() < 3.0, "{x}: {found} {expected}");
        }
    }
    assert_eq!(heat_color(f32::NAN), heat_color(0.0));
    assert_eq!(heat_color(7.0), heat_color(1.0));
    let soup = triangles(100);
    let scene = Bvh::build(&soup)?;
    let kernel = kernel!(|ray: Ray| bvh_cost_color(&scene, 40.0, ray));
    for ray in random_rays(2, 100) {
        let Cost { nodes, primitives } = scene.closest_hit_with_cost(ray).1;
        let expected = heat_color((nodes + primitives) as f32 / 40.0);
        for v in CPU {
            assert_eq!(run(&kernel, v, &[(ray,)]), [expected], "{v:?}");
        }
    }
    Ok(())
}

#[test]
fn aovs_are_those_of_the_closest_ball() -> Result<(), Box<dyn Error>> {
    let balls = balls(24);
    let scene = Bvh::build(&balls)?;
    let kernel = kernel!(|ray: Ray| aovs(&scene, ray));
    let rays: Vec<(Ray,)> = random_rays(6, 3000)
        .into_iter()
        .map(|ray| (Ray::new(ray.origin, ray.direction),))
        .chain(broken_rays().into_iter().map(|ray| (ray,)))
        .collect();
    assert_variants_agree!(&kernel, &rays);
    let (mut met, mut missed) = (0, 0);
    for (ray,) in &rays[..3000] {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let (seen, margin) = closest(&balls, origin, direction);
        if margin < 1e-4 {
            continue;
        }
        let found = kernel.call((*ray,));
        let Some((t, ball)) = seen else {
            missed += 1;
            assert_eq!((found.depth, found.prim_id, found.inst_id), (f32::MAX, u32::MAX, u32::MAX));
            assert_eq!((found.albedo, found.normal), (Vec3::ZERO, Vec3::ZERO));
            continue;
        };
        met += 1;
        let outside = (origin + t * direction - ball.center.as_dvec3()).normalize();
        let normal = if outside.dot(direction) > 0.0 { -outside } else { outside };
        assert_eq!(found.albedo, ball.color);
        assert_eq!((balls[found.prim_id as usize].center, found.inst_id), (ball.center, 0));
        assert!((f64::from(found.depth) / t - 1.0).abs() < 1e-4, "{found:?} {t}");
        assert!((found.normal.as_dvec3() - normal).length() < 1e-3, "{found:?} {normal}");
    }
    assert!(met > 200 && missed > 500, "{met} {missed}");
    Ok(())
}
