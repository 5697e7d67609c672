//! Enums of primitives: the methods that they forward, and kinds that share data beside kinds that
//! share none.

use raydsl::assert_variants_agree;
use raydsl::bsdf::Lambert;
use raydsl::integrators::direct_light;
use raydsl::kernel;
use raydsl::light::{AnyLight, DirectionalLight, Lights, PointLight};
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::testing::FilmTest;
use raydsl_tests::rng::Rng;

#[primitive(sphere(center, radius))]
#[derive(Debug)]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[primitive(rectangle(corner, u_edge, v_edge))]
#[derive(Debug)]
struct Panel {
    corner: Vec3,
    u_edge: Vec3,
    v_edge: Vec3,
}

#[kernel]
impl Surface for Ball {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        vec3(0.9, 0.5, self.radius)
    }
}

#[kernel]
impl Surface for Panel {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, ray: Ray, hit: Hit) -> Vec3 {
        let uv = Panel::uv(self, ray, hit);
        vec3(uv.x, uv.y, 0.5)
    }

    fn uv(&self, _ray: Ray, hit: Hit) -> Vec2 {
        vec2(hit.v, hit.u)
    }

    fn material(&self, _ray: Ray, _hit: Hit) -> u32 {
        7
    }
}

/// Its methods are those of its kinds, one of which is of the library.
#[primitive(surface_point, normal, uv, area, sample, Surface)]
#[derive(Debug)]
enum Lamp {
    Ball(Ball),
    Panel(Panel),
    Facet(Triangle),
}

/// The methods of an enum that has one as a kind.
#[primitive(normal, Surface)]
enum Thing {
    Lamp(Lamp),
    Can(Can),
}

#[primitive(cylinder(p0, p1, radius))]
struct Can {
    p0: Vec3,
    p1: Vec3,
    radius: f32,
}

#[kernel]
impl Surface for Can {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::splat(0.25)
    }
}

fn ball(rng: &mut Rng) -> Ball {
    Ball { center: rng.point(3.0), radius: rng.range(0.1, 0.7) }
}

fn lamps(rng: &mut Rng) -> Vec<Lamp> {
    (0..60)
        .map(|i| match i % 3 {
            0 => Lamp::Ball(ball(rng)),
            1 => {
                let [u_edge, v_edge] = [(); 2].map(|()| rng.point(1.0));
                Lamp::Panel(Panel { corner: rng.point(3.0), u_edge, v_edge })
            }
            _ => {
                let at = rng.point(3.0);
                let [v0, v1, v2] = [(); 3].map(|()| at + rng.point(1.0));
                Lamp::Facet(Triangle { v0, v1, v2 })
            }
        })
        .collect()
}

fn rays(rng: &mut Rng, count: usize) -> Vec<(Ray,)> {
    (0..count).map(|_| (Ray::new(rng.point(4.0), rng.point(1.0)),)).collect()
}

#[test]
fn methods_are_those_of_the_kind() {
    let mut rng = Rng::of("forwarded methods");
    let all = lamps(&mut rng);
    let bvh = Bvh::build(&all).expect("finite bounds");
    let rays = rays(&mut rng, 3000);
    let mut hits = [0; 3];
    for (ray,) in &rays {
        let hit = bvh.closest_hit(*ray);
        if !hit.is_hit {
            continue;
        }
        let (ray, u, lamp) = (*ray, vec2(0.25, 0.75), all[hit.prim_id as usize]);
        hits[hit.prim_id as usize % 3] += 1;
        let found = (
            (lamp.surface_point(ray, hit), lamp.normal(ray, hit), lamp.uv(ray, hit)),
            (lamp.area(), lamp.sample(u)),
            (lamp.surface(ray, hit), lamp.albedo(ray, hit), lamp.material(ray, hit)),
            Surface::uv(&lamp, ray, hit),
        );
        macro_rules! of {
            ($kind:expr) => {{
                let kind = $kind;
                (
                    (kind.surface_point(ray, hit), kind.normal(ray, hit), kind.uv(ray, hit)),
                    (kind.area(), kind.sample(u)),
                    (kind.surface(ray, hit), kind.albedo(ray, hit), kind.material(ray, hit)),
                    Surface::uv(&kind, ray, hit),
                )
            }};
        }
        let expected = match lamp {
            Lamp::Ball(b) => of!(b),
            Lamp::Panel(p) => of!(p),
            Lamp::Facet(f) => of!(f),
        };
        assert_eq!(found, expected);
    }
    assert!(hits.iter().all(|n| *n > 50), "{hits:?}");
    let shaded = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        if hit.is_hit {
            let lamp = bvh.primitive(hit);
            let point = lamp.surface_point(ray, hit);
            let sample = lamp.sample(Lamp::uv(&lamp, ray, hit));
            (point.position, lamp.normal(ray, hit), lamp.area(), sample.position, sample.normal)
        } else {
            (Vec3::ZERO, Vec3::ZERO, 0.0, Vec3::ZERO, Vec3::ZERO)
        }
    });
    assert_variants_agree!(&shaded, &rays);
    let list = &all[..12];
    let listed = kernel!(|ray: Ray| {
        let mut sum = 0.0;
        for lamp in list {
            sum += lamp.area() * lamp.sample(vec2(0.5, 0.25)).normal.dot(ray.direction);
        }
        sum
    });
    assert_variants_agree!(&listed, &rays[..200].to_vec());
}

/// The WGSL of a forwarded method has the kinds that are in the scene.
#[test]
fn the_text_of_methods_has_no_other_kind() {
    let mut rng = Rng::of("text of methods");
    let mut all: Vec<Lamp> = (0..9).map(|_| Lamp::Ball(ball(&mut rng))).collect();
    let text = |all: &[Lamp]| {
        let bvh = Bvh::build(all).expect("finite bounds");
        let kernel = kernel!(|ray: Ray| {
            let hit = bvh.closest_hit(ray);
            if hit.is_hit { bvh.primitive(hit).normal(ray, hit) } else { Vec3::ZERO }
        });
        kernel.wgsl()
    };
    let spheres = text(&all);
    assert!(!spheres.contains(".kind =="), "{spheres}");
    assert!(!spheres.contains("u_edge"), "{spheres}");
    all.push(Lamp::Panel(Panel { corner: Vec3::ZERO, u_edge: Vec3::X, v_edge: Vec3::Y }));
    let both = text(&all);
    assert!(both.contains(".kind ==") && both.contains("u_edge"), "{both}");
}

/// Integrators shade a tree of an enum, and one of an enum of enums.
#[test]
fn integrators_shade_enums() {
    let mut rng = Rng::of("integrators and enums");
    let balls: Vec<Ball> = (0..20).map(|_| ball(&mut rng)).collect();
    let of_balls: Vec<Lamp> = balls.iter().copied().map(Lamp::Ball).collect();
    let [p0, p1] = [vec3(-3.0, -3.0, 0.0), vec3(3.0, -3.0, 0.0)];
    let can = Thing::Can(Can { p0, p1, radius: 0.5 });
    let things: Vec<Thing> = lamps(&mut rng).into_iter().map(Thing::Lamp).chain([can]).collect();
    let plain = Bvh::build(&balls).expect("finite bounds");
    let of_balls = Bvh::build(&of_balls).expect("finite bounds");
    let things = Bvh::build(&things).expect("finite bounds");
    let lamp = PointLight { position: vec3(0.0, 5.0, 1.0), intensity: vec3(30.0, 20.0, 4.0) };
    let (direction, irradiance) = (vec3(0.6, 0.0, -0.8), vec3(1.0, 0.5, 2.0));
    let sun = DirectionalLight { direction, irradiance, sine: 0.0 };
    let list = [AnyLight::Point(lamp), AnyLight::Directional(sun)];
    let lights = Lights::new(&list, plain.bounds()).expect("finite powers");
    let sampler = Sampler::default();
    let rays = rays(&mut rng, 2000);
    let expected = kernel!(|ray: Ray| {
        let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
        direct_light::<_, _, Lambert>(&plain, surface, &lights, host(true), ray, sampler)
    });
    let found = kernel!(|ray: Ray| {
        let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
        direct_light::<_, _, Lambert>(&of_balls, surface, &lights, host(true), ray, sampler)
    });
    for (ray,) in &rays {
        assert_eq!(expected.call((*ray,)), found.call((*ray,)));
    }
    assert_variants_agree!(&found, &rays);
    // Of what an enum of enums says of a point, ray by ray.
    let nested = kernel!(|ray: Ray| {
        let hit = things.closest_hit(ray);
        let mut light = Vec3::ZERO;
        if hit.is_hit {
            let seen = things.shading_point(ray, hit);
            let point = facing(seen.point, ray.direction);
            for i in 0..lights.count() {
                let sample = lights.sample_light(i, point, Vec2::ZERO);
                light += seen.albedo * sample.light * max(point.normal.dot(sample.wi), 0.0);
            }
        }
        light
    });
    assert_variants_agree!(&nested, &rays);
    // A frame at a normal across z has tangents that rounding turns around: the means of a picture
    // decide.
    let lit = kernel!(|ray: Ray| {
        let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
        direct_light::<_, _, Lambert>(&things, surface, &lights, host(false), ray, sampler)
    });
    let camera = Pinhole::new(vec3(2.0, 3.0, 12.0), Vec3::ZERO, Vec3::Y, 0.8);
    assert_variants_agree!(&lit, &FilmTest::new(&camera, 24, 24));
}

/// One kind has vertices, the others nothing but themselves.
#[primitive]
#[derive(Debug)]
enum Shape {
    Ball(Ball),
    Face(IndexedTriangle),
    Panel(Panel),
}

/// A triangle that shares vertices too, in another layout.
#[primitive]
#[derive(Debug)]
struct Strip {
    first: u32,
}

#[primitive]
impl Strip {
    const SLACK: f32 = triangle::SLACK;

    fn intersect(&self, ray: Ray, vertices: &[Vec3]) -> Hit {
        let i = self.first as usize;
        triangle::intersect(ray, vertices[i], vertices[i + 1], vertices[i + 2])
    }

    fn get_bounds(&self, vertices: &[Vec3]) -> Aabb {
        let i = self.first as usize;
        triangle::get_bounds(vertices[i], vertices[i + 1], vertices[i + 2])
    }
}

/// Enums of kinds, with data and without, and two kinds that share the same.
#[primitive]
enum Any {
    Lamp(Lamp),
    Strip(Strip),
    Shape(Shape),
}

fn shapes(rng: &mut Rng, vertices: &[Vec3]) -> Vec<Shape> {
    let index = |rng: &mut Rng| rng.below(vertices.len()) as u32;
    (0..60)
        .map(|i| match i % 3 {
            0 => Shape::Ball(ball(rng)),
            1 => Shape::Face(IndexedTriangle { vertices: [(); 3].map(|()| index(rng)) }),
            _ => {
                let [u_edge, v_edge] = [(); 2].map(|()| rng.point(1.0));
                Shape::Panel(Panel { corner: rng.point(3.0), u_edge, v_edge })
            }
        })
        .collect()
}

/// The closest of all hits, by brute force.
fn closest(hits: impl Iterator<Item = Hit>) -> Hit {
    let mut best = Hit::miss();
    for (id, hit) in hits.enumerate() {
        if hit.is_hit && (!best.is_hit || hit.t < best.t) {
            best = Hit { prim_id: id as u32, ..hit };
        }
    }
    best
}

fn of_shape(shape: &Shape, ray: Ray, vertices: &[Vec3]) -> Hit {
    match shape {
        Shape::Ball(b) => b.intersect(ray),
        Shape::Face(f) => f.intersect(ray, vertices),
        Shape::Panel(p) => p.intersect(ray),
    }
}

#[test]
fn some_kinds_share_data() {
    let mut rng = Rng::of("some kinds share data");
    let vertices: Vec<Vec3> = (0..40).map(|_| rng.point(3.0)).collect();
    let all = shapes(&mut rng, &vertices);
    let config = BuildConfig::default();
    let bvh = Bvh::build_sharing(&all, &vertices, &config).expect("finite bounds");
    let wide = BuildConfig { min_wide_size: 0, ..config };
    let wide = Bvh::build_wide(&all, &vertices, &wide).expect("finite bounds");
    let rays = rays(&mut rng, 3000);
    let mut hits = [0; 3];
    for (ray,) in &rays {
        let expected = closest(all.iter().map(|s| of_shape(s, *ray, &vertices)));
        assert_eq!(bvh.closest_hit(*ray), expected);
        assert_eq!(wide.closest_hit(*ray), expected);
        assert_eq!(bvh.any_hit(*ray), expected.is_hit);
        hits[expected.prim_id as usize % 3] += usize::from(expected.is_hit);
    }
    assert!(hits.iter().all(|n| *n > 50), "{hits:?}");
    let tree = kernel!(|ray: Ray| (bvh.closest_hit(ray), bvh.any_hit(ray)));
    assert_variants_agree!(&tree, &rays);
    let leaves = kernel!(|ray: Ray| wide.closest_hit(ray));
    assert_variants_agree!(&leaves, &rays);
    // The vertices are there only where a kind reads them.
    let text = tree.wgsl();
    assert!(text.contains("bvh_shared") && text.contains("axis_last"), "{text}");
    let balls: Vec<Shape> = all.iter().filter(|s| matches!(s, Shape::Ball(_))).copied().collect();
    let balls = Bvh::build_sharing(&balls, &vertices, &config).expect("finite bounds");
    let text = kernel!(|ray: Ray| balls.closest_hit(ray)).wgsl();
    assert!(!text.contains("shared") && !text.contains("axis_last"), "{text}");
}

#[test]
fn enums_of_kinds_share_data() {
    let mut rng = Rng::of("enums of kinds share data");
    let vertices: Vec<Vec3> = (0..40).map(|_| rng.point(3.0)).collect();
    let shapes = shapes(&mut rng, &vertices).into_iter().map(Any::Shape);
    let mut all: Vec<Any> = lamps(&mut rng).into_iter().map(Any::Lamp).chain(shapes).collect();
    all.extend((0..30).map(|first| Any::Strip(Strip { first })));
    let bvh = Bvh::build_sharing(&all, &vertices, &BuildConfig::default()).expect("finite bounds");
    let rays = rays(&mut rng, 1000);
    let of_any = |any: &Any, ray| match any {
        Any::Lamp(Lamp::Ball(b)) => b.intersect(ray),
        Any::Lamp(Lamp::Panel(p)) => p.intersect(ray),
        Any::Lamp(Lamp::Facet(f)) => f.intersect(ray),
        Any::Strip(s) => s.intersect(ray, &vertices),
        Any::Shape(s) => of_shape(s, ray, &vertices),
    };
    for (ray,) in &rays {
        let expected = closest(all.iter().map(|any| of_any(any, *ray)));
        assert_eq!(bvh.closest_hit(*ray), expected);
    }
    let tree = kernel!(|ray: Ray| bvh.closest_hit(ray));
    assert_variants_agree!(&tree, &rays);
}

/// A ball that shares a table of sizes.
#[primitive]
#[derive(Debug)]
struct Sized {
    center: Vec3,
    size: u32,
}

#[primitive]
impl Sized {
    const MAX_CROSSINGS: u32 = 2;

    fn intersect(&self, ray: Ray, sizes: &[f32]) -> Hit {
        sphere::intersect(ray, self.center, sizes[self.size as usize])
    }

    fn get_bounds(&self, sizes: &[f32]) -> Aabb {
        Aabb::from_sphere(self.center, sizes[self.size as usize])
    }
}

// ANCHOR: several
/// Two kinds that share different data, and one that shares none.
#[primitive(shared(Vec3, f32))]
#[derive(Debug)]
enum Mixed {
    Face(IndexedTriangle),
    Sized(Sized),
    Panel(Panel),
}
// ANCHOR_END: several

/// A disk that shares a table of radii, which are fractions.
#[primitive]
#[derive(Debug)]
struct Coin {
    center: Vec3,
    form: u32,
}

#[primitive]
impl Coin {
    fn intersect(&self, ray: Ray, forms: &[UVec2]) -> Hit {
        let form = forms[self.form as usize];
        disk::intersect(ray, self.center, vec3(0.6, 0.0, 0.8), form.x as f32 / form.y as f32)
    }

    fn get_bounds(&self, forms: &[UVec2]) -> Aabb {
        let form = forms[self.form as usize];
        disk::get_bounds(self.center, vec3(0.6, 0.0, 0.8), form.x as f32 / form.y as f32)
    }
}

/// Three types of data; one kind is an enum that shares two of them.
#[primitive(shared(UVec2, f32, Vec3))]
#[derive(Debug)]
enum Everything {
    Mixed(Mixed),
    Coin(Coin),
    Strip(Strip),
}

fn mixed(rng: &mut Rng, vertices: &[Vec3], sizes: &[f32]) -> Vec<Mixed> {
    let sized =
        |rng: &mut Rng| Sized { center: rng.point(3.0), size: rng.below(sizes.len()) as u32 };
    let of_shape = |shape| match shape {
        Shape::Ball(_) => None,
        Shape::Face(face) => Some(Mixed::Face(face)),
        Shape::Panel(panel) => Some(Mixed::Panel(panel)),
    };
    let mut all: Vec<Mixed> = (0..30).map(|_| Mixed::Sized(sized(rng))).collect();
    all.extend(shapes(rng, vertices).into_iter().filter_map(of_shape));
    all
}

fn of_mixed(mixed: &Mixed, ray: Ray, vertices: &[Vec3], sizes: &[f32]) -> Hit {
    match mixed {
        Mixed::Face(f) => f.intersect(ray, vertices),
        Mixed::Sized(s) => s.intersect(ray, sizes),
        Mixed::Panel(p) => p.intersect(ray),
    }
}

#[test]
fn kinds_share_different_data() {
    let mut rng = Rng::of("kinds share different data");
    let vertices: Vec<Vec3> = (0..40).map(|_| rng.point(3.0)).collect();
    let sizes: Vec<f32> = (0..7).map(|i| 0.2 + 0.05 * i as f32).collect();
    let all = mixed(&mut rng, &vertices, &sizes);
    let config = BuildConfig { min_wide_size: 0, ..BuildConfig::default() };
    // ANCHOR: several_tree
    let bvh = Bvh::build_sharing(&all, (&vertices, &sizes), &config).expect("finite bounds");
    // ANCHOR_END: several_tree
    let wide = Bvh::build_wide(&all, (&vertices, &sizes), &config).expect("finite bounds");
    let (first, second) = all.split_at(all.len() / 2);
    let trees = [first, second].map(|half| {
        Bvh::build_sharing(half, (&vertices[..], &sizes[..]), &config).expect("finite bounds")
    });
    let list = BvhList::new(&trees).expect("trees share the same");
    let one = [bvh];
    let mut placed = Instances::new(&one).expect("trees share the same");
    let moved = Affine3::from_translation(vec3(1.0, 0.0, 0.0));
    placed.group(&[Instance::new(0, moved)]).expect("a transform with an inverse");
    let bvh = &one[0];
    let rays = rays(&mut rng, 2000);
    let mut hits = [0; 3];
    for (ray,) in &rays {
        let expected = closest(all.iter().map(|s| of_mixed(s, *ray, &vertices, &sizes)));
        assert_eq!(bvh.closest_hit(*ray), expected);
        assert_eq!(wide.closest_hit(*ray), expected);
        assert_eq!(list.closest_hit(*ray), expected);
        assert_eq!(bvh.any_hit(*ray), expected.is_hit);
        if expected.is_hit {
            hits[all[expected.prim_id as usize].kind() as usize] += 1;
        }
    }
    assert!(hits.iter().all(|n| *n > 50), "{hits:?}");
    let text = agreeing_text(bvh, &rays);
    assert!(text.contains("scene_shared:") && text.contains("scene_shared_2:"), "{text}");
    // Kernels read both slices, too.
    let others = kernel!(|ray: Ray| {
        let hit = list.closest_hit(ray);
        let (vertices, sizes) = placed.shared();
        let read = vertices[(hit.prim_id % 40) as usize] * sizes[(hit.prim_id % 7) as usize];
        (hit, placed.closest_hit(ray), read)
    });
    assert_variants_agree!(&others, &rays);
    let leaves = kernel!(|ray: Ray| wide.any_hit(ray));
    assert_variants_agree!(&leaves, &rays);
    // A scene of some kinds has their data alone.
    let faces: Vec<Mixed> = all.iter().filter(|s| matches!(s, Mixed::Face(_))).copied().collect();
    let faces = Bvh::build_sharing(&faces, (&vertices, &sizes), &config).expect("finite bounds");
    let text = agreeing_text(&faces, &rays);
    assert!(text.contains("scene_shared:") && !text.contains("scene_shared_2"), "{text}");
    let sized: Vec<Mixed> = all.iter().filter(|s| matches!(s, Mixed::Sized(_))).copied().collect();
    let sized = Bvh::build_sharing(&sized, (&vertices, &sizes), &config).expect("finite bounds");
    let text = agreeing_text(&sized, &rays);
    assert!(!text.contains("scene_shared:") && text.contains("scene_shared_2:"), "{text}");
}

/// Tests that the variants agree on the closest hits, and returns the text for devices.
fn agreeing_text(scene: &Bvh<'_, Mixed>, rays: &[(Ray,)]) -> String {
    let kernel = kernel!(|ray: Ray| scene.closest_hit(ray));
    assert_variants_agree!(&kernel, rays);
    kernel.wgsl()
}

#[test]
fn trees_of_a_list_share_every_slice() {
    let mut rng = Rng::of("trees of a list share every slice");
    let vertices: Vec<Vec3> = (0..40).map(|_| rng.point(3.0)).collect();
    let sizes = [0.5; 7];
    let others = sizes.to_vec();
    let all = mixed(&mut rng, &vertices, &sizes);
    let config = BuildConfig::default();
    let tree =
        |sizes| Bvh::build_sharing(&all, (&vertices, sizes), &config).expect("finite bounds");
    let same = [tree(&sizes[..]), tree(&sizes[..])];
    assert!(BvhList::new(&same).is_ok());
    let other = [tree(&sizes[..]), tree(&others[..])];
    let error = BvhList::new(&other).err();
    assert_eq!(error, Some(raydsl::bvh::ListError::SharesAnother { first: 0, tree: 1 }));
}

#[test]
fn enums_of_kinds_share_different_data() {
    let mut rng = Rng::of("enums of kinds share different data");
    let vertices: Vec<Vec3> = (0..40).map(|_| rng.point(3.0)).collect();
    let sizes: Vec<f32> = (0..7).map(|i| 0.2 + 0.05 * i as f32).collect();
    let forms: Vec<UVec2> = (1..6).map(|i| UVec2::new(i, 4)).collect();
    let coin = |rng: &mut Rng| Coin { center: rng.point(3.0), form: rng.below(forms.len()) as u32 };
    let mut all: Vec<Everything> =
        mixed(&mut rng, &vertices, &sizes).into_iter().map(Everything::Mixed).collect();
    all.extend((0..30).map(|_| Everything::Coin(coin(&mut rng))));
    all.extend((0..30).map(|first| Everything::Strip(Strip { first })));
    let config = BuildConfig::default();
    let bvh =
        Bvh::build_sharing(&all, (&forms, &sizes, &vertices), &config).expect("finite bounds");
    let rays = rays(&mut rng, 1000);
    let of_all = |thing: &Everything, ray| match thing {
        Everything::Mixed(m) => of_mixed(m, ray, &vertices, &sizes),
        Everything::Coin(c) => c.intersect(ray, &forms),
        Everything::Strip(s) => s.intersect(ray, &vertices),
    };
    let mut hits = [0; 3];
    for (ray,) in &rays {
        let expected = closest(all.iter().map(|thing| of_all(thing, *ray)));
        assert_eq!(bvh.closest_hit(*ray), expected);
        if expected.is_hit {
            hits[all[expected.prim_id as usize].kind() as usize] += 1;
        }
    }
    assert!(hits.iter().all(|n| *n > 20), "{hits:?}");
    let tree = kernel!(|ray: Ray| bvh.closest_hit(ray));
    assert_variants_agree!(&tree, &rays);
}
