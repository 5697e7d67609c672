//! The shade below a cloud of balls: no closed form, so two halves of a reference.

use std::time::Instant;

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_report::Missing;
use raydsl_report::work_precision::{
    Backend, Case, Estimates, Method, Order, Reference, Run, Work,
};

use crate::visibility::{Ball, SAMPLES};

/// The film's edge in pixels: the reference has as many numbers.
pub(crate) const EDGE: u32 = 16;

/// Balls above the unit square.
fn balls() -> Vec<Ball> {
    let ball = |i: u32| {
        let u = Sampler::new(uvec2(i, 1), 0, 0, 1, SampleMethod::Random).next_2d();
        let v = Sampler::new(uvec2(i, 2), 0, 0, 1, SampleMethod::Random).next_2d();
        Ball {
            center: vec3(2.0 * u.x - 1.0, 2.0 * u.y - 1.0, 0.3 + v.x),
            radius: 0.03 + 0.05 * v.y,
        }
    };
    (0..300).map(ball).collect()
}

/// A ray to the sky from below where a camera's ray begins.
#[kernel]
fn to_the_sky(ray: Ray, sampler: Sampler) -> Ray {
    let mut sampler = sampler;
    let direction = sample_cosine_hemisphere(sampler.next_2d());
    Ray::new(vec3(ray.origin.x, ray.origin.y, 0.0), direction)
}

/// The sky that it sees.
#[kernel]
pub(crate) fn shade(cloud: &Bvh<'_, Ball>, ray: Ray, sampler: Sampler) -> f32 {
    if cloud.any_hit(to_the_sky(ray, sampler)) { 0.0 } else { 1.0 }
}

fn camera() -> Orthographic {
    Orthographic::new(vec3(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 2.0)
}

/// Tests of nodes and balls of the same samples.
fn work(cloud: &Bvh<'_, Ball>, run: &Run<'_>) -> Work {
    run.film_work(&camera(), |ray, sampler| {
        let cost = cloud.any_hit_with_cost(to_the_sky(ray, sampler)).1;
        Work { texture_fetches: Some(0), ..cost.into() }
    })
}

fn estimate(cloud: &Bvh<'_, Ball>, run: &Run<'_>) -> Result<Estimates, Missing> {
    let kernel = kernel!(|ray: Ray, sampler: Sampler| shade(cloud, ray, sampler));
    run.film(&camera(), &kernel)
}

/// Returns two renderings of so many samples of each pixel, by other numbers than those of any run.
pub(crate) fn halves(
    samples: u32,
    estimate: impl Fn(&Run<'_>) -> Result<Estimates, Missing>,
) -> Result<Reference, String> {
    let (method, backend) =
        (Method::from(SampleMethod::Sobol), Backend::Variant(Variant::widest()));
    let half = |seed| {
        let run = Run::new(&method, backend, samples).sized(EDGE, EDGE).seeded(seed);
        estimate(&run).map(|e| e.values).map_err(|missing| missing.to_string())
    };
    Ok(Reference::halves(half(1001)?, half(1002)?))
}

/// The case; each half of its reference has so many samples of each pixel.
pub(crate) fn case(samples: u32) -> Result<Case<'static>, Box<dyn core::error::Error>> {
    let balls: &'static [Ball] = balls().leak();
    let start = Instant::now();
    let cloud: &'static Bvh<'static, Ball> = Box::leak(Box::new(Bvh::build(balls)?));
    let build = start.elapsed();
    let reference = halves(samples, |run| estimate(cloud, run))?;
    // Edges in four dimensions, two of them the pixel's: theory says nothing of their constants.
    Ok(Case::new("cloud", reference, move |run| estimate(cloud, run))
        .counted(move |run| work(cloud, run))
        .built_in(build)
        .values(&SAMPLES)
        .family("openness")
        .method(SampleMethod::Random, Some(Order::RANDOM))
        .method(SampleMethod::Stratified, None)
        .method(SampleMethod::Sobol, None))
}
