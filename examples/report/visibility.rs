//! How much of the sky is seen past one thing: closed forms.

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_report::work_precision::{Case, Order, Reference, Work};

/// Samples of each pixel.
pub(crate) const SAMPLES: [u32; 4] = [64, 256, 1024, 4096];

/// A disk.
#[primitive(disk(center, normal, radius))]
pub(crate) struct Disc {
    center: Vec3,
    normal: Vec3,
    radius: f32,
}

/// A ball.
#[primitive(sphere(center, radius))]
pub(crate) struct Ball {
    pub(crate) center: Vec3,
    pub(crate) radius: f32,
}

/// A rectangle.
#[primitive(rectangle(corner, u_edge, v_edge))]
pub(crate) struct Wall {
    corner: Vec3,
    u_edge: Vec3,
    v_edge: Vec3,
}

/// A plane.
#[primitive(plane(normal, offset))]
pub(crate) struct Ceiling {
    normal: Vec3,
    offset: f32,
}

/// What hides the sky.
#[primitive]
pub(crate) enum Occluder {
    /// A disk.
    Disc(Disc),
    /// A ball.
    Ball(Ball),
    /// A rectangle.
    Wall(Wall),
    /// A plane.
    Ceiling(Ceiling),
}

// ANCHOR: kernel
/// A ray from the origin of the plane z = 0, in a direction that is likely as the cosine, or as any
/// other, no longer than `reach`.
#[kernel]
fn to_the_sky(reach: f32, #[host] is_uniform: bool, sampler: Sampler) -> Ray {
    let mut sampler = sampler;
    let u = sampler.next_2d();
    let direction =
        if is_uniform { sample_uniform_hemisphere(u) } else { sample_cosine_hemisphere(u) };
    Ray { t_max: reach, ..Ray::new(vec3(0.0, 0.0, 0.0), direction) }
}

/// Whether such a ray sees the sky.
#[kernel]
pub(crate) fn visibility(
    occluders: &[Occluder],
    reach: f32,
    #[host] is_uniform: bool,
    sampler: Sampler,
) -> f32 {
    let ray = to_the_sky(reach, is_uniform, sampler);
    if occluders.any_hit(ray) { 0.0 } else { 1.0 }
}
// ANCHOR_END: kernel

fn disc(center: Vec3, radius: f32) -> Occluder {
    Occluder::Disc(Disc { center, normal: Vec3::NEG_Z, radius })
}

fn ball(center: Vec3, radius: f32) -> Occluder {
    Occluder::Ball(Ball { center, radius })
}

fn wall(corner: Vec3, u_edge: Vec3, v_edge: Vec3) -> Occluder {
    Occluder::Wall(Wall { corner, u_edge, v_edge })
}

/// What is in the way, and how much of the sky is seen.
pub(crate) struct Scene {
    /// Its name.
    pub(crate) name: &'static str,
    /// The share of the sky that is seen.
    pub(crate) seen: f64,
    /// What is in the way.
    pub(crate) occluders: [Occluder; 1],
    /// What is farther away does not count.
    pub(crate) reach: f32,
    /// Whether all directions count the same.
    pub(crate) is_uniform: bool,
}

/// All of them. Configuration factors are those of Howell, Mengüç, Daun and Siegel, "Thermal
/// Radiation Heat Transfer".
pub(crate) fn scenes() -> Vec<Scene> {
    let scene = |name, seen, occluder| {
        let (occluders, reach) = ([occluder], f32::INFINITY);
        Scene { name, seen, occluders, reach, is_uniform: false }
    };
    let ceiling = || Occluder::Ceiling(Ceiling { normal: Vec3::Z, offset: 1.0 });
    // A wall of this length leaves less than 1e-11 of what an infinite one has.
    let long = vec3(0.0, 8192.0, 0.0);
    let infinite = wall(vec3(1.0, -4096.0, 0.0), long, vec3(0.0, 0.0, 3.0));
    let window = wall(vec3(0.5, -1.0, 1.25), vec3(1.5, 0.0, 0.0), vec3(0.0, 2.5, 0.0));
    let near = |scene| Scene { reach: 1.6, ..scene };
    vec![
        scene("P-AO1", 0.8, disc(vec3(0.0, 0.0, 2.0), 1.0)),
        scene("P-AO2", 0.873_704_659_341_829_8, disc(vec3(1.5, 0.0, 1.0), 1.0)),
        scene("P-AO3", 0.821_114_561_800_016_9, ball(vec3(1.0, 0.0, 2.0), 1.0)),
        scene("P-AO4", 0.756_216_566_808_029_5, ball(vec3(1.25, 0.0, 1.0), 1.0)),
        scene("P-AO5", 0.991_861_698_270_285_7, ball(vec3(3.0, 0.0, 0.0), 1.0)),
        scene("P-AO6", 0.658_113_883_008_419, infinite),
        near(scene("P-AO7", 0.390_625, ceiling())),
        Scene { is_uniform: true, ..near(scene("P-AO7-uniform", 0.625, ceiling())) },
        scene("P-AO8", 0.830_989_940_095_277_9, window),
    ]
}

// ANCHOR: case
/// The case of a scene, with the orders of an integrand that has an edge.
fn case(scene: Scene) -> Case<'static> {
    let Scene { name, seen, occluders, reach, is_uniform } = scene;
    // The edge of the uniform one runs along the lines between strata, which then have no error.
    let edge = (!is_uniform).then_some(Order::at_most(-0.7));
    Case::new(name, Reference::closed_form(seen), move |run| {
        let occluders = &occluders[..];
        let kernel = kernel!(|_ray: Ray, sampler: Sampler| {
            visibility(occluders, reach, host(is_uniform), sampler)
        });
        run.integral(&kernel)
    })
    .counted(move |run| {
        run.integral_work(|sampler| {
            let ray = to_the_sky(reach, is_uniform, sampler);
            let cost = occluders.any_hit_with_cost(ray).1;
            Work { texture_fetches: Some(0), ..cost.into() }
        })
    })
    .values(&SAMPLES)
    .family("edges")
    .method(SampleMethod::Random, Some(Order::RANDOM))
    .method(SampleMethod::Stratified, edge)
    .method(SampleMethod::Sobol, edge)
}
// ANCHOR_END: case

/// All of them.
pub(crate) fn cases() -> Vec<Case<'static>> {
    scenes().into_iter().map(case).collect()
}
