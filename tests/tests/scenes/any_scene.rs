//! Kernels that are generic over their scene: a tree, a list, a slice, instances of an indexed mesh
//! and structs of several scenes, in every variant.

use std::error::Error;

use glam::{DAffine3, DMat3, DVec3};
use raydsl::bsdf::Lambert;
use raydsl::bvh::SceneRef;
use raydsl::integrators::{aovs, bvh_cost, direct_light};
use raydsl::light::{DirectionalLight, Lights};
use raydsl::prelude::*;
use raydsl::shading::{Mesh, MeshAttributes, Surface};
use raydsl::testing::run;
use raydsl::{assert_variants_agree, kernel};

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

    fn material(&self, _ray: Ray, _hit: Hit) -> u32 {
        7
    }
}

/// The radiance along a ray of diffuse surfaces under a white sky.
#[kernel]
fn path<S: Scene + ?Sized>(scene: &S, #[host] bounces: u32, ray: Ray, sampler: Sampler) -> Vec3 {
    let mut sampler = sampler;
    let mut ray = ray;
    let mut throughput = Vec3::ONE;
    for _ in 0..bounces + 1 {
        let hit = scene.closest_hit(ray);
        if !hit.is_hit {
            return throughput;
        }
        let seen = scene.shading_point(ray, hit);
        let point = facing(seen.point, ray.direction);
        let local = sample_cosine_hemisphere(sampler.next_2d());
        throughput *= seen.albedo;
        ray = point.ray(Frame::around(point.normal).to_world(local));
    }
    Vec3::ZERO
}

/// Passes its scene on.
#[kernel]
fn is_shadowed<S: RayQuery + ?Sized>(scene: &S, ray: Ray) -> bool {
    scene.any_hit(ray)
}

/// A method that takes any scene.
#[derive(Clone, Copy, Type)]
struct Lamp {
    position: Vec3,
}

#[kernel]
impl Lamp {
    fn reaches<S: Scene + ?Sized>(&self, scene: &S, ray: Ray, hit: Hit) -> bool {
        let point = facing(scene.surface(ray, hit), ray.direction);
        !is_shadowed(scene, point.ray_to(self.position))
    }
}

/// The hits of a scene, and what they say.
#[kernel]
fn hits_of<S: Scene + ?Sized>(scene: &S, ray: Ray) -> (f32, u32, u32, f32, bool) {
    let lamp = Lamp { position: vec3(0.0, 9.0, 2.0) };
    let hit = scene.closest_hit(ray);
    let (_, cost) = scene.closest_hit_with_cost(ray);
    let mut count = 0u32;
    let mut sum = 0.0;
    for crossing in scene.hits(ray) {
        count += 1 + crossing.inst_id * 16;
        sum += crossing.t;
    }
    let lit = hit.is_hit && lamp.reaches(scene, ray, hit);
    let local = scene.local_ray(ray, hit);
    (hit.t + local.origin.x, hit.prim_id + 100 * hit.inst_id + cost.primitives, count, sum, lit)
}

/// The other queries of a scene.
#[kernel]
fn queries_of<S: RayQuery<Hit = Hit> + ?Sized>(scene: &S, ray: Ray) -> (f32, u32, u32) {
    let two = scene.multi_hit::<2>(ray);
    let far = scene.closest_hit_where(ray, |hit: Hit| hit.t > 2.0);
    let any = scene.any_hit_where(ray, |hit: Hit| hit.prim_id == 3);
    let last = scene.multi_hit_by::<1>(ray, |a: Hit, b: Hit| a.t > b.t);
    let each = scene.closest_hit_each::<2>(|i: u32| Ray { t_min: i as f32 * 2.0, ..ray });
    let closed = scene.any_hit_each::<2>(|i: u32| Ray { t_min: i as f32 * 4.0, ..ray });
    let flags = any as u32 + 2 * (closed[0] as u32) + 4 * (closed[1] as u32);
    let distance = two[1].t + far.t + last[0].t + each[0].t + each[1].t;
    (distance, two[1].inst_id + 100 * far.inst_id + 10000 * last[0].inst_id, flags)
}

/// Two scenes of different primitives, with different structures.
#[derive(Scene)]
struct Both<'a> {
    balls: Bvh<'a, Ball>,
    meshes: Mesh<'a, Instances<'a, IndexedTriangle>>,
}

/// Three scenes, one of them a struct of scenes.
#[derive(Scene)]
struct Three<'a> {
    first: &'a [Ball],
    both: Both<'a>,
    last: BvhList<'a, Ball>,
}

/// A trait whose method takes any scene, and a slice.
#[kernel]
trait Estimator {
    fn estimate<S: RayQuery + ?Sized>(&self, scene: &S, weights: &[f32], ray: Ray) -> f32;
}

#[derive(Clone, Copy, Type)]
struct Depth {
    far: f32,
}

#[derive(Clone, Copy, Type)]
struct Count {
    least: f32,
}

#[kernel]
impl Estimator for Depth {
    fn estimate<S: RayQuery + ?Sized>(&self, scene: &S, weights: &[f32], ray: Ray) -> f32 {
        let hit = scene.closest_hit(ray);
        if hit.is_hit { hit.t * weights[0] } else { self.far }
    }
}

#[kernel]
impl Estimator for Count {
    fn estimate<S: RayQuery + ?Sized>(&self, scene: &S, weights: &[f32], ray: Ray) -> f32 {
        let mut n = 0.0;
        for hit in scene.hits(ray) {
            if hit.t > self.least {
                n += weights[hit.prim_id as usize % weights.len()];
            }
        }
        n
    }
}

#[kernel]
fn both<E: Estimator, S: RayQuery + ?Sized>(e: E, scene: &S, weights: &[f32], ray: Ray) -> f32 {
    e.estimate(scene, weights, ray) + 1.0
}

/// What a surface looks like.
#[derive(Clone, Copy, Type)]
enum Paint {
    Plain(Vec3),
    Striped { a: Vec3, b: Vec3, width: f32 },
}

// ANCHOR: tables
/// A scene with tables: paints, and a picture of the sky.
#[derive(Scene)]
struct Painted<'a> {
    balls: Bvh<'a, Ball>,
    meshes: Mesh<'a, Instances<'a, IndexedTriangle>>,
    #[table]
    paints: &'a [Paint],
    #[table]
    sky: Texture2<'a, f32>,
}

/// The colour that a ray sees.
#[kernel]
fn painted(world: &Painted<'_>, ray: Ray) -> Vec3 {
    let hit = world.closest_hit(ray);
    if !hit.is_hit {
        return Vec3::splat(tex2(&world.sky, vec2(ray.direction.x, ray.direction.y)));
    }
    let seen = world.shading_point(ray, hit);
    paint_at(world.paints, seen.material as usize, seen.uv)
}
// ANCHOR_END: tables

#[kernel]
fn paint_at(paints: &[Paint], number: usize, uv: Vec2) -> Vec3 {
    match paints[number % paints.len()] {
        Paint::Plain(color) => color,
        Paint::Striped { a, b, width } => {
            let at = uv.x / width;
            if at - at.floor() < 0.5 { a } else { b }
        }
    }
}

/// Asks a scene that it knows nothing of.
fn sum_of_distances<S: RayQuery<Hit = Hit> + ?Sized>(scene: &S, rays: &[(Ray,)]) -> Vec<f32> {
    let scene = SceneRef::new(scene);
    let kernel = kernel!(|ray: Ray| {
        let mut sum = 0.0;
        for hit in scene.hits(ray) {
            sum += hit.t;
        }
        sum
    });
    assert_variants_agree!(&kernel, rays);
    run(&kernel, Variant::Packet8, rays)
}

/// Shades a scene that it knows nothing of.
fn facing_ratios<S: Scene + ?Sized>(scene: &S, rays: &[(Ray,)]) -> Vec<f32> {
    let scene = SceneRef::new(scene);
    let kernel = kernel!(|ray: Ray| {
        let hit = scene.closest_hit(ray);
        if hit.is_hit { scene.surface(ray, hit).normal.dot(ray.direction) } else { 0.0 }
    });
    assert_variants_agree!(&kernel, rays);
    run(&kernel, Variant::Packet4, rays)
}

fn balls(count: u32, seed: u32) -> Vec<Ball> {
    let mut rng = Rng::new(UVec2::ZERO, seed, 3);
    let mut ball = |_| {
        let (at, color) = (rng.next_3d() * 6.0 - 3.0, rng.next_3d());
        Ball { center: at, radius: 0.1 + 0.5 * rng.next_f32(), color }
    };
    (0..count).map(&mut ball).collect()
}

/// An icosahedron's vertices and triangles.
fn solid() -> (Vec<Vec3>, Vec<IndexedTriangle>) {
    let g = 1.618_034;
    let vertices = [
        (-1.0, g, 0.0),
        (1.0, g, 0.0),
        (-1.0, -g, 0.0),
        (1.0, -g, 0.0),
        (0.0, -1.0, g),
        (0.0, 1.0, g),
        (0.0, -1.0, -g),
        (0.0, 1.0, -g),
        (g, 0.0, -1.0),
        (g, 0.0, 1.0),
        (-g, 0.0, -1.0),
        (-g, 0.0, 1.0),
    ];
    let faces = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    let vertices = vertices.map(|(x, y, z)| vec3(x, y, z) * 0.4);
    (vertices.to_vec(), faces.map(|vertices| IndexedTriangle { vertices }).to_vec())
}

/// Attributes of the solid.
struct Attributes {
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    colors: Vec<Vec3>,
    materials: Vec<u32>,
}

impl Attributes {
    fn of(vertices: &[Vec3], triangles: usize) -> Self {
        Self {
            normals: vertices.iter().map(|v| *v * 3.0).collect(),
            uvs: vertices
                .iter()
                .map(|v| vec2(v.x + 0.37 * v.z, v.y + 0.11 * v.x - 0.21 * v.z))
                .collect(),
            colors: vertices.iter().map(|v| v.abs()).collect(),
            materials: (0..triangles as u32).map(|i| i % 3).collect(),
        }
    }

    fn borrowed(&self) -> MeshAttributes<'_> {
        let Self { normals, uvs, colors, materials } = self;
        MeshAttributes { normals, uvs, colors, materials, ..Default::default() }
    }
}

fn placements() -> Vec<Instance> {
    let turn = |x: f32| Mat3::from_rotation_y(x) * Mat3::from_rotation_x(2.0 * x);
    let place = |i: u32| {
        let x = i as f32;
        let scale = Mat3::from_diagonal(vec3(1.0, 0.5 + 0.2 * x, 2.0 - 0.3 * x));
        let translation = vec3(2.0 * x - 4.0, (x * 1.7) % 3.0 - 1.5, 1.0 - 0.4 * x);
        Instance::new(0, Affine3 { matrix3: turn(x) * scale, translation })
    };
    (0..5).map(place).collect()
}

/// Rays from around the scenes towards their middle.
fn aimed_rays(seed: u32, count: usize) -> Vec<Ray> {
    let mut rng = Rng::new(UVec2::ZERO, seed, 9);
    let mut ray = |_| {
        let (from, to) = (sample_uniform_sphere(rng.next_2d()) * 9.0, rng.next_3d() * 5.0 - 2.5);
        Ray::new(from, to - from)
    };
    (0..count).map(&mut ray).collect()
}

fn inputs(count: usize) -> Vec<(Ray, Sampler)> {
    let rays = aimed_rays(11, count).into_iter().enumerate();
    rays.map(|(i, ray)| (ray, Sampler::new(uvec2(i as u32, 3), 5, 0, 1, SampleMethod::Random)))
        .collect()
}

/// Runs the kernels over a scene in every variant.
macro_rules! assert_agree {
    ($scene:ident, $count:expr) => {{
        let inputs = inputs($count);
        // A path of several bounces turns the last bit of one into another path: on a device short
        // ones are compared.
        let bounces = 1;
        let short =
            kernel!(|ray: Ray, sampler: Sampler| path(&$scene, host(bounces), ray, sampler));
        assert_variants_agree!(&short, &inputs);
        let bounces = 4;
        let long = kernel!(|ray: Ray, sampler: Sampler| path(&$scene, host(bounces), ray, sampler));
        // On the host the source itself runs.
        let expected: Vec<Vec3> =
            inputs.iter().map(|(ray, sampler)| path(&$scene, 4, *ray, *sampler)).collect();
        for variant in [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16] {
            assert_eq!(run(&long, variant, &inputs), expected, "{variant:?}");
        }
        let found: Vec<Ray> = inputs.iter().map(|(ray, _)| *ray).collect();
        let hits = $scene.closest_hits(&found);
        let any = $scene.any_hits(&found);
        for (i, ray) in found.iter().enumerate() {
            assert_eq!(hits[i], $scene.closest_hit(*ray));
            assert_eq!(any[i], hits[i].is_hit);
        }
        hits.iter().filter(|hit| hit.is_hit).count()
    }};
}

/// Runs every query of a scene in every variant.
macro_rules! assert_answers_agree {
    ($scene:ident, $count:expr) => {{
        let rays: Vec<(Ray,)> = inputs($count).iter().map(|(ray, _)| (*ray,)).collect();
        let found = kernel!(|ray: Ray| hits_of(&$scene, ray));
        assert_variants_agree!(&found, &rays);
        let asked = kernel!(|ray: Ray| queries_of(&$scene, ray));
        assert_variants_agree!(&asked, &rays);
        for (ray,) in &rays {
            assert_eq!(found.call((*ray,)), hits_of(&$scene, *ray));
            assert_eq!(asked.call((*ray,)), queries_of(&$scene, *ray));
        }
    }};
}

#[test]
fn a_kernel_takes_any_scene() -> Result<(), Box<dyn Error>> {
    let some = balls(30, 1);
    let tree = Bvh::build(&some)?;
    assert!(assert_agree!(tree, 200) > 30);
    let others = balls(20, 2);
    let trees = [Bvh::build(&some)?, Bvh::build(&others)?];
    let list = BvhList::new(&trees)?;
    assert!(assert_agree!(list, 200) > 30);
    let few = &some[..8];
    assert!(assert_agree!(few, 200) > 3);
    Ok(())
}

#[test]
fn a_kernel_takes_meshes_and_structs_of_scenes() -> Result<(), Box<dyn Error>> {
    let (vertices, triangles) = solid();
    let attributes = Attributes::of(&vertices, triangles.len());
    let trees = [Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?];
    let instances = || Instances::build(&trees, &placements());
    let placed = instances()?;
    let mesh = Mesh::new(&placed, attributes.borrowed())?;
    assert!(assert_agree!(mesh, 200) > 20);

    let some = balls(25, 1);
    let of_both = instances()?;
    let both =
        Both { balls: Bvh::build(&some)?, meshes: Mesh::new(&of_both, attributes.borrowed())? };
    assert!(assert_agree!(both, 200) > 30);
    assert_answers_agree!(both, 120);

    let (few, others) = (balls(3, 8), balls(9, 9));
    let (of_three, of_others) = (instances()?, [Bvh::build(&others)?]);
    let three = Three {
        first: &few,
        both: Both {
            balls: Bvh::build(&some)?,
            meshes: Mesh::new(&of_three, attributes.borrowed())?,
        },
        last: BvhList::new(&of_others)?,
    };
    assert!(assert_agree!(three, 120) > 30);
    Ok(())
}

/// One value captures a scene with its tables.
#[test]
fn a_scene_has_tables() -> Result<(), Box<dyn Error>> {
    let (vertices, triangles) = solid();
    let attributes = Attributes::of(&vertices, triangles.len());
    let trees = [Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?];
    let placed = Instances::build(&trees, &placements())?;
    let some = balls(25, 1);
    let paints = [
        Paint::Plain(vec3(0.9, 0.1, 0.2)),
        Paint::Striped { a: Vec3::X, b: Vec3::Y, width: 0.25 },
        Paint::Plain(vec3(0.1, 0.8, 0.3)),
    ];
    let texels = [0.0, 0.25, 0.5, 1.0];
    let world = Painted {
        balls: Bvh::build(&some)?,
        meshes: Mesh::new(&placed, attributes.borrowed())?,
        paints: &paints,
        sky: Texture2::new(&texels, [2, 2], TextureConfig::default())?,
    };
    let rays: Vec<(Ray,)> = aimed_rays(11, 200).into_iter().map(|ray| (ray,)).collect();
    let by_function = kernel!(|ray: Ray| painted(&world, ray));
    assert_variants_agree!(&by_function, &rays);
    let by_name = kernel!(|ray: Ray| {
        let hit = world.closest_hit(ray);
        if hit.is_hit { paint_at(world.paints, 0, Vec2::ZERO) } else { Vec3::ZERO }
    });
    assert_variants_agree!(&by_name, &rays);
    let wgsl = by_function.wgsl();
    assert!(wgsl.contains("paints") && wgsl.contains("sky"), "{wgsl}");
    let expected: Vec<Vec3> = rays.iter().map(|(ray,)| painted(&world, *ray)).collect();
    assert_eq!(run(&by_function, Variant::Packet16, &rays), expected);
    let seen = |color: Vec3| expected.iter().filter(|c| **c == color).count();
    assert!(seen(vec3(0.9, 0.1, 0.2)) > 5 && seen(Vec3::X) + seen(Vec3::Y) > 5);
    Ok(())
}

/// Methods of traits take scenes and slices, whatever implements the trait.
#[test]
fn methods_of_traits_take_scenes() -> Result<(), Box<dyn Error>> {
    let some = balls(25, 1);
    let tree = Bvh::build(&some)?;
    let weights = [0.5, 2.0, 0.25];
    let (depth, count) = (Depth { far: 9.0 }, Count { least: 8.0 });
    let weights = &weights[..];
    let kernel =
        kernel!(|ray: Ray| { both(depth, &tree, weights, ray) + both(count, &tree, weights, ray) });
    let rays = aimed_rays(11, 200);
    assert_variants_agree!(&kernel, &rays);
    for ray in &rays {
        let expected =
            both(depth, &some[..], weights, *ray) + both(count, &some[..], weights, *ray);
        assert_eq!(kernel.call((*ray,)), expected);
    }
    Ok(())
}

/// Host functions are generic over their scene too.
#[test]
fn kernels_of_generic_host_functions_capture_scenes() -> Result<(), Box<dyn Error>> {
    let some = balls(25, 1);
    let tree = Bvh::build(&some)?;
    let rays: Vec<(Ray,)> = aimed_rays(11, 200).into_iter().map(|ray| (ray,)).collect();
    let sums = sum_of_distances(&some[..], &rays);
    assert!(sums.iter().filter(|sum| **sum > 0.0).count() > 20);
    assert_eq!(sum_of_distances(&tree, &rays), sums);
    let ratios = facing_ratios(&some[..], &rays);
    assert!(ratios.iter().filter(|ratio| **ratio != 0.0).count() > 20);
    assert_eq!(facing_ratios(&tree, &rays), ratios);
    Ok(())
}

/// A struct of scenes finds what its parts find: the least (t, inst, prim) of all.
#[test]
fn a_struct_of_scenes_is_the_union_of_its_parts() -> Result<(), Box<dyn Error>> {
    let (vertices, triangles) = solid();
    let trees = [Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?];
    let placed = Instances::build(&trees, &placements())?;
    // The same balls in both parts: every hit is a tie.
    let some = balls(25, 1);

    #[derive(RayQuery)]
    struct Tied<'a> {
        first: Bvh<'a, Ball>,
        middle: &'a Instances<'a, IndexedTriangle>,
        last: Bvh<'a, Ball>,
    }
    let tied = Tied { first: Bvh::build(&some)?, middle: &placed, last: Bvh::build(&some)? };
    let offset = |hit: Hit, by: u32| Hit { inst_id: hit.inst_id + by, ..hit };
    let mut ties = 0;
    for ray in aimed_rays(4, 2000) {
        let first = tied.first.closest_hit(ray);
        let middle = offset(placed.closest_hit(ray), 1);
        let last = offset(first, 6);
        let all = [first, middle, last].into_iter().filter(|hit| hit.is_hit);
        let order = |hit: &Hit| (hit.t, hit.inst_id, hit.prim_id);
        let least = all.min_by(|a, b| order(a).partial_cmp(&order(b)).expect("numbers"));
        let found = tied.closest_hit(ray);
        assert_eq!(found.is_hit.then_some(found), least);
        let parts = tied.first.hits(ray).chain(placed.hits(ray).map(|hit| offset(hit, 1)));
        let mut every: Vec<Hit> =
            parts.chain(tied.last.hits(ray).map(|hit| offset(hit, 6))).collect();
        every.sort_by(|a, b| order(a).partial_cmp(&order(b)).expect("numbers"));
        assert_eq!(tied.hits(ray).collect::<Vec<_>>(), every);
        ties += usize::from(found.is_hit && found.inst_id == 0);
    }
    assert!(ties > 100, "{ties}");
    Ok(())
}

/// Points of instances are where `f64` says, within their error, and rays from there do not hit
/// their triangle again, however the instance is stretched and wherever it is.
#[test]
fn points_of_instances_are_within_their_error() -> Result<(), Box<dyn Error>> {
    let (vertices, triangles) = solid();
    let trees = [Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?];
    let mut rng = Rng::new(UVec2::ZERO, 77, 1);
    let mut worst: f64 = 0.0;
    let mut compared = 0;
    for round in 0..60 {
        let stretch = 10f32.powi(round % 5 - 2);
        let scale = vec3(1.0, stretch, 1.0 / stretch);
        let turn = Mat3::from_rotation_z(rng.next_f32() * 6.0)
            * Mat3::from_diagonal(scale)
            * Mat3::from_rotation_x(rng.next_f32() * 6.0);
        let far = [0.0, 10.0, 1e4][(round % 3) as usize];
        let at = (rng.next_3d() - 0.5) * far;
        let placed = Instances::build(
            &trees,
            &[Instance::new(0, Affine3 { matrix3: turn, translation: at })],
        )?;
        let none = MeshAttributes::default();
        let mesh = Mesh::new(&placed, none)?;
        let size = scale.max_element();
        for _ in 0..300 {
            let target = at + turn * ((rng.next_3d() - 0.5) * 0.8);
            let origin = at + (rng.next_3d() - 0.5) * 8.0 * size;
            let ray = Ray::new(origin, target - origin);
            let hit = mesh.closest_hit(ray);
            if !hit.is_hit {
                continue;
            }
            let point = mesh.surface(ray, hit);
            // The plane of the triangle in the scene, in f64, through the map that rays see.
            let map = placed.to_object(hit);
            let m = map.matrix3;
            let matrix3 =
                DMat3::from_cols(m.x_axis.as_dvec3(), m.y_axis.as_dvec3(), m.z_axis.as_dvec3());
            let to_scene = DAffine3 { matrix3, translation: map.translation.as_dvec3() }.inverse();
            let corners = triangles[hit.prim_id as usize].vertices;
            let [a, b, c] =
                corners.map(|i| to_scene.transform_point3(vertices[i as usize].as_dvec3()));
            let normal = (b - a).cross(c - a).normalize();
            let off = (point.position.as_dvec3() - a).dot(normal).abs();
            let error = f64::from(point.error);
            assert!(off <= error, "{round}: {off} above {error}, {point:?}");
            worst = worst.max(off / error);
            let aligned = normal.dot(point.normal.as_dvec3()).abs();
            assert!(aligned > 1.0 - 1e-5, "{round}: {aligned}");
            // Rays that leave on either side.
            for _ in 0..4 {
                let way = (rng.next_3d() - 0.5) * size;
                let side = facing(point, -way);
                let again = mesh.closest_hit(side.ray(way));
                let is_same = again.is_hit && again.prim_id == hit.prim_id;
                assert!(!is_same, "{round}: {again:?} from {side:?}");
            }
            compared += 1;
        }
    }
    assert!(compared > 2000, "{compared}");
    // A bound that is never approached would be of no use.
    assert!(worst > 0.01, "{worst}");
    Ok(())
}

/// The attributes of a mesh are those of its vertices.
#[test]
fn meshes_carry_attributes() -> Result<(), Box<dyn Error>> {
    let (vertices, triangles) = solid();
    let attributes = Attributes::of(&vertices, triangles.len());
    let bvh = Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?;
    let mesh = Mesh::new(&bvh, attributes.borrowed())?;
    let seen = kernel!(|ray: Ray| {
        let hit = mesh.closest_hit(ray);
        mesh.shading_point(ray, hit)
    });
    let rays = aimed_rays(6, 400).into_iter().map(|ray| (Ray::new(ray.origin, -ray.origin),));
    let rays: Vec<(Ray,)> = rays.filter(|(ray,)| mesh.any_hit(*ray)).collect();
    assert!(rays.len() > 390, "{}", rays.len());
    assert_variants_agree!(&seen, &rays);
    for (ray,) in &rays {
        let (hit, found) = (mesh.closest_hit(*ray), seen.call((*ray,)));
        let [a, b, c] = triangles[hit.prim_id as usize].vertices.map(|i| i as usize);
        let (u, v) = (f64::from(hit.u), f64::from(hit.v));
        let position = [a, b, c].map(|i| vertices[i].as_dvec3());
        let position = position[0] * (1.0 - u - v) + position[1] * u + position[2] * v;
        assert!((found.point.position.as_dvec3() - position).length() < 1e-6);
        // The normals are those of a sphere.
        let normal = position.normalize();
        let off = (found.shading_normal.as_dvec3() - normal).length();
        assert!(off < 1e-6, "{off}");
        let uv = glam::dvec2(
            position.x + 0.37 * position.z,
            position.y + 0.11 * position.x - 0.21 * position.z,
        );
        assert!((found.uv.as_dvec2() - uv).length() < 1e-6);
        assert_eq!(found.material, hit.prim_id % 3);
        // In the triangle, u grows along the tangent and v stays.
        let along =
            DVec3::new(found.tangent.x.into(), found.tangent.y.into(), found.tangent.z.into());
        assert!((along.length() - 1.0).abs() < 1e-6 && along.dot(normal).abs() < 1e-6);
        let corner = [a, b, c].map(|i| vertices[i].as_dvec3());
        let flat = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        // The tangent was moved along the shading normal, out of the triangle.
        let along = along - normal * (along.dot(flat) / normal.dot(flat));
        let (u, v) = (along.x + 0.37 * along.z, along.y + 0.11 * along.x - 0.21 * along.z);
        assert!(u > 0.0 && v.abs() < 1e-5 * u, "{along}: {u} {v}");
    }
    let suns = [DirectionalLight { direction: Vec3::Y, irradiance: Vec3::ONE, sine: 0.0 }];
    let lights = Lights::new(&suns, bvh.bounds())?;
    let (shadows, sampler) = (true, Sampler::default());
    let lit = kernel!(|ray: Ray| {
        let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
        direct_light::<_, _, Lambert>(&mesh, surface, &lights, host(shadows), ray, sampler)
    });
    assert_variants_agree!(&lit, &rays);
    let known = kernel!(|ray: Ray| aovs(&mesh, ray));
    assert_variants_agree!(&known, &rays);
    let cost = kernel!(|ray: Ray| bvh_cost(&mesh, ray));
    assert_variants_agree!(&cost, &rays);
    let short = MeshAttributes { uvs: &attributes.uvs[1..], ..Default::default() };
    let error = Mesh::new(&bvh, short).expect_err("one is missing");
    assert_eq!((error.attribute, error.count, error.expected), ("uvs", 11, 12));
    assert_eq!(error.to_string(), "a mesh has one element of `uvs` for each vertex: 12, not 11");
    Ok(())
}
