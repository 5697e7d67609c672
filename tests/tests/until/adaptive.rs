//! Variants end alike, and adaptive sampling puts samples where they are needed.

use std::error::Error;
use std::sync::Mutex;
use std::time::Duration;

use raydsl::integrators::{PathLimits, PathOptions};
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::render::{
    Budget, Estimate, FilmArgs, Metric, Outcome, Radiance, Reached, Target, Until,
};
#[cfg(feature = "gpu")]
use raydsl_tests::gpu::gpu;
use raydsl_tests::transport::{BALL, Paint, far_ball, paint, shining_sphere};
use raydsl_tests::{in_parallel, scaled};

use crate::camera;
use crate::coverage::{CLAIMED, Known, Tally, holds, tally};
use crate::estimators::{SQUARE, sample_of, texture};
use crate::paths::{Paths, sky};

fn same_but_for_time(a: &Reached, b: &Reached) -> bool {
    Reached { elapsed: Duration::ZERO, ..*a } == Reached { elapsed: Duration::ZERO, ..*b }
}

/// Noise around 1; a part of the columns has thirty times that of the others.
macro_rules! uneven {
    ($noisy:ident, $method:ident) => {
        kernel!(|_ray: Ray, pixel: UVec2, sampler: Sampler| {
            let mut sampler = Sampler { method: $method, ..sampler };
            let spread = if pixel.x < $noisy { 1.0 } else { 0.03 };
            1.0 + spread * (sampler.next_1d() - 0.5)
        })
    };
}

/// Every variant and scheduler of the CPU ends with the same bits; a device ends as well.
#[test]
fn every_variant_ends_with_the_same_picture() -> Result<(), Box<dyn Error>> {
    let texture = texture();
    let kernel = kernel!(|_ray: Ray, sampler: Sampler| {
        let mut sampler = sampler;
        sample_of(SQUARE, &texture, sampler.next_2d())
    });
    let even = Until::new(Target::new(Metric::Rmse, 2e-3), Budget::of_samples(100_000));
    let target = Target::new(Metric::Rmse, 2e-3).pilot(64);
    let adaptive = Until::new(target, Budget::of_samples(2000)).adaptive();
    let (noisy, random) = (9, SampleMethod::Stratified);
    let uneven = uneven!(noisy, random);
    ends_alike(&kernel, &even, (9, 7))?;
    let film = ends_alike(&uneven, &adaptive, (37, 20))?;
    let counts = film.sample_counts();
    let (some, most) = (counts.get(36, 0), counts.get(0, 0));
    assert!(some.zip(most).is_some_and(|(some, most)| 3 * some < *most), "{some:?} {most:?}");
    Ok(())
}

/// Runs it by all variants; gives the film.
fn ends_alike<A: FilmArgs, R: Radiance>(
    kernel: &Kernel<'_, A, R>,
    until: &Until,
    (width, height): (u32, u32),
) -> Result<Film, Box<dyn Error>> {
    let sampling = Sampling::new(1).seed(5);
    let mut expected = Film::new(width, height);
    let scalar = SimpleScheduler::new();
    let of_scalar = scalar.render_until(&camera(), kernel, &sampling, &mut expected, until)?;
    assert_eq!(of_scalar.outcome, Outcome::Converged);
    assert!(until.adaptive || of_scalar.samples == expected.samples());
    for v in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        let mut film = Film::new(width, height);
        let tiled = TiledScheduler::new().variant(v).tile(4);
        let reached = tiled.render_until(&camera(), kernel, &sampling, &mut film, until)?;
        assert!(film == expected && same_but_for_time(&reached, &of_scalar), "{v:?} {reached:?}");
    }
    #[cfg(feature = "gpu")]
    if let Some(gpu) = gpu() {
        let mut film = Film::new(width, height);
        let reached = gpu.render_until(&camera(), kernel, &sampling, &mut film, until)?;
        assert_eq!((reached.outcome, reached.samples), (of_scalar.outcome, of_scalar.samples));
        let apart = |a: Estimate, b: Estimate| (a.high / b.high - 1.0).abs();
        assert!(apart(reached.estimate, of_scalar.estimate) < 1e-3, "{reached:?} {of_scalar:?}");
    }
    Ok(expected)
}

/// What many seeds gave for a film of noise: the samples a pixel, and how often the error was as
/// claimed.
fn uneven(noisy: u32, tolerance: f64, adaptive: bool, seeds: u32) -> (f64, f64) {
    let method = SampleMethod::Random;
    let kernel = uneven!(noisy, method);
    let target = Target::new(Metric::Rmse, tolerance).pilot(64);
    let until = Until::new(target, Budget::of_samples(10_000_000));
    let until = if adaptive { until.adaptive() } else { until };
    let all = Mutex::new((0.0, 0.0));
    in_parallel(seeds as usize, 1, |part| {
        for seed in part {
            let mut film = Film::new(64, 32);
            let scheduler = SimpleScheduler::new().variant(Variant::widest());
            let sampling = Sampling::new(1).seed(seed as u32);
            let reached = scheduler
                .render_until(&camera(), &kernel, &sampling, &mut film, &until)
                .expect("a target and a budget");
            assert_eq!(reached.outcome, Outcome::Converged);
            let counts = film.sample_counts();
            let total: f64 = counts.pixels().iter().map(|&n| f64::from(n)).sum();
            let mean = total / counts.pixels().len() as f64;
            assert!((mean - f64::from(reached.samples)).abs() < 1.0, "{mean} {reached:?}");
            let squares =
                film.image().pixels().iter().map(|p| f64::from(p.x - 1.0).powi(2)).sum::<f64>();
            let error = (squares / counts.pixels().len() as f64).sqrt();
            let mut all = all.lock().expect("no one panics");
            all.0 += f64::from(reached.spent) / f64::from(seeds);
            all.1 += if error <= reached.estimate.high { 1.0 } else { 0.0 } / f64::from(seeds);
        }
    });
    all.into_inner().expect("no one panics")
}

/// Samples go where they are needed: the same error takes fewer where a part of the picture is
/// noisy, and hardly more where all of it is; the claimed confidence holds.
#[test]
fn samples_go_where_they_are_needed() {
    let seeds = scaled(64) as u32 / 4;
    for (noisy, tolerance, least, most) in [(16, 6e-3, 1.5, 8.0), (64, 1.5e-2, 0.95, 1.05)] {
        let (even, _) = uneven(noisy, tolerance, false, seeds);
        let (adaptive, covered) = uneven(noisy, tolerance, true, seeds);
        let gain = even / adaptive;
        println!("{noisy} of 64 columns: {even:.0} or {adaptive:.0} samples, {covered:.3} covered");
        assert!(gain >= least && gain <= most, "{noisy}: {gain}");
        let count = (covered * f64::from(seeds)).round() as u32;
        assert!(holds(count, seeds, (CLAIMED.0, 1.0)), "{noisy}: {covered}");
    }
}

/// Adaptive sampling of paths: the claimed confidence holds where one block in fifteen is hard, which
/// takes fewer samples, and where all pixels are alike, which takes about as many.
/// `RAYDSL_TEST_SHARE=64` has 1024 seeds.
#[test]
fn adaptive_paths_are_as_good_as_claimed() {
    let seeds = scaled(64) as u32 / 4;
    let (white, black) = (sky(1.0), sky(0.0));
    let furnace = Paths {
        dome: &BALL,
        floor: &[],
        paints: [paint(0.75); 2],
        lights: &[],
        sky: &white,
        options: PathOptions::new(),
        limits: PathLimits::new(2),
    };
    let lamp = [shining_sphere(0.5)];
    let paints = [Paint { light: 0, ..paint(0.5) }; 2];
    let limits = PathLimits::new(64);
    let cavity = Paths { paints, lights: &lamp, sky: &black, limits, ..furnace };
    let camera = Pinhole::new(vec3(0.1, 0.2, 0.0), vec3(0.1, 0.8, 0.8), Vec3::Z, 1.0);
    let (pixels, film, metric) = (PixelSampler::Center, (32, 32), Metric::Rmse);
    let (far_camera, far_film, truth) = far_ball();
    let far = Known { camera: far_camera, pixels, film: far_film, metric, truth };
    let inside = Known { camera, pixels, film, metric, truth: vec![1.0; 32 * 32] };
    for (name, paths, known, tolerance, least, most) in [
        ("a far ball", furnace, far, 6e-3, 1.5, 15.0),
        ("inside a sphere", cavity, inside, 0.06, 0.9, 1.1),
    ] {
        let target = Target::new(Metric::Rmse, tolerance).pilot(32);
        let even = Until::new(target, Budget::of_samples(1_000_000));
        paths.with(&mut |kernel| {
            let of = |until: &Until| tally(&known, kernel, SampleMethod::Random, until, seeds);
            let (even, adaptive) = (of(&even), of(&even.adaptive()));
            let mean = |tally: &Tally| tally.samples as f64 / f64::from(seeds);
            let (few, many) = (mean(&adaptive), mean(&even));
            let covered = 100.0 * f64::from(adaptive.below) / f64::from(seeds);
            println!(
                "{name:16} {seeds} seeds: {many:.0} or {few:.0} samples, {covered:.1} % covered"
            );
            assert_eq!((even.converged, adaptive.converged), (seeds, seeds), "{name}");
            assert!(holds(adaptive.below, seeds, CLAIMED), "{name}: {covered}");
            assert!(holds(adaptive.good, seeds, (CLAIMED.0, 1.0)), "{name}: {}", adaptive.good);
            let gain = many / few;
            assert!(gain >= least && gain <= most, "{name}: {gain}");
        });
    }
}
