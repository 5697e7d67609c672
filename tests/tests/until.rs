//! Rendering until an error is reached: the claimed confidence holds, and budgets do.
//!
//! The cases have closed forms. `RAYDSL_TEST_SHARE=16 cargo test --test until -- --nocapture` runs
//! 1024 seeds of each and prints the table of the book.

use std::error::Error;
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::render::{
    Budget, Estimate, FilmArgs, Metric, Outcome, Radiance, Reached, Target, Until, UntilError,
};
use raydsl::texture::Filter;
use raydsl_tests::gpu::gpu;
use raydsl_tests::{in_parallel, scaled};

/// Whether a ray from the origin meets a sphere.
#[kernel]
fn meets(d: Vec3, center: Vec3, radius: f32) -> bool {
    let along = d.dot(center);
    let aside = center - d * along;
    along > 0.0 && aside.dot(aside) <= radius * radius
}

/// One sample of a case: what a point at the origin, with its normal along z, is to estimate.
#[kernel]
fn sample_of(case: u32, emission: &Texture2<'_, f32>, u: Vec2) -> f32 {
    let d = sample_cosine_hemisphere(u);
    let on_light = vec3(2.0 * u.x - 1.0, 2.0 * u.y - 1.0, 1.0);
    let square = on_light.dot(on_light);
    // Both cosines, over the squared distance, times the area.
    let from_light = 4.0 / (square * square);
    match case {
        0 => {
            let p = d * (2.0 / d.z);
            if p.x * p.x + p.y * p.y <= 1.0 { 0.0 } else { 1.0 }
        }
        1 => {
            let p = d / d.z - vec3(1.5, 0.0, 0.0);
            if p.x * p.x + p.y * p.y <= 1.0 { 0.0 } else { 1.0 }
        }
        2 => {
            if meets(d, vec3(1.0, 0.0, 2.0), 1.0) {
                0.0
            } else {
                1.0
            }
        }
        3 => {
            if meets(d, vec3(3.0, 0.0, 0.0), 1.0) {
                0.0
            } else {
                1.0
            }
        }
        4 => {
            let p = d * (1.25 / d.z);
            let is_in = p.x >= 0.5 && p.x <= 2.0 && p.y >= -1.0 && p.y <= 1.5;
            if is_in { 0.0 } else { 1.0 }
        }
        5 => {
            if meets(d, vec3(1.0, 0.0, 2.0), 0.5) {
                31.415_926
            } else {
                0.0
            }
        }
        6 => from_light,
        7 => {
            let p = vec3(on_light.x, on_light.y, 1.5);
            let distance = p.length();
            1.5 / (distance * distance * distance)
        }
        8 => tex2(emission, u),
        9 => from_light * tex2(emission, u),
        _ => {
            if u.x < 0.01 {
                100.0
            } else {
                0.0
            }
        }
    }
}

/// Texels of a dark surface with some bright places.
const TEXELS: [f32; 20] = [
    0.1, 0.2, 0.1, 4.0, 0.3, 0.1, 0.9, 0.5, 0.2, 0.1, 0.1, 2.5, 0.3, 0.1, 0.6, 0.2, 0.1, 0.1, 0.7,
    8.0,
];
const SIZE: [u32; 2] = [5, 4];

/// What a square light of these texels gives, by the midpoint rule in each texel.
fn textured_light() -> f64 {
    const N: usize = 400;
    let [columns, rows] = SIZE.map(|n| n as usize);
    let place = |i: usize, size: usize| 2.0 * (i as f64 + 0.5) / (size * N) as f64 - 1.0;
    let mut sum = 0.0;
    for j in 0..rows * N {
        for i in 0..columns * N {
            let (x, y) = (place(i, columns), place(j, rows));
            let square = x * x + y * y + 1.0;
            sum += 4.0 / (square * square) * f64::from(TEXELS[j / N * columns + i / N]);
        }
    }
    sum / (columns * rows * N * N) as f64
}

struct Case {
    name: &'static str,
    number: u32,
    truth: f64,
    metric: Metric,
    /// Columns and rows.
    film: (u32, u32),
}

/// The values are those of the closed forms beside them, with more digits than are needed.
fn cases() -> Vec<Case> {
    let mean = TEXELS.iter().map(|&t| f64::from(t)).sum::<f64>() / TEXELS.len() as f64;
    let (rmse, one, few) = (Metric::Rmse, (1, 1), (4, 4));
    let ao2 = {
        let (h, r) = (1.0f64 / 1.5, 1.0f64 / 1.5);
        let z = 1.0 + h * h + r * r;
        1.0 - 0.5 * (1.0 - (1.0 + h * h - r * r) / (z * z - 4.0 * r * r).sqrt())
    };
    let all = [
        ("occlusion by a disk above", 1.0 - 1.0 / 5.0, rmse, one),
        ("by a disk aside", ao2, rmse, few),
        ("by a sphere", 1.0 - 2.0 / 5.0f64.powf(1.5), Metric::Mean, few),
        ("by a dome on the plane", 0.991_861_698_270_285_7, rmse, one),
        ("by a rectangle", 0.830_989_940_095_277_9, rmse, few),
        ("light of a sphere", PI * 10.0 * 0.25 * 2.0 / 5.0f64.powf(1.5), rmse, few),
        ("of a square", 1.740_839_502_734_206_4, Metric::RelMse, few),
        ("of a point on a patch", 0.312_766_721_941_545, rmse, few),
        ("a texture", mean, rmse, few),
        ("a square light with a texture", textured_light(), rmse, one),
        ("100 with a probability of 0.01", 1.0, Metric::RelMse, one),
    ];
    let case = |((name, truth, metric, film), number)| Case { name, number, truth, metric, film };
    all.into_iter().zip(0..).map(case).collect()
}

fn camera() -> Pinhole {
    Pinhole::new(vec3(0.0, 0.0, 5.0), vec3(0.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), 1.0)
}

fn texture() -> Texture2<'static, f32> {
    let nearest = TextureConfig::new().filter(Filter::Nearest);
    Texture2::new(&TEXELS, SIZE, nearest).expect("twenty texels")
}

/// A case as a kernel of a film.
macro_rules! estimator {
    ($number:ident, $texture:ident, $method:ident) => {
        kernel!(|_ray: Ray, sampler: Sampler| {
            let mut sampler = Sampler { method: $method, ..sampler };
            sample_of($number, &$texture, sampler.next_2d())
        })
    };
}

/// The true error of a film, in the metric's unit.
fn error(case: &Case, film: &Film) -> f64 {
    let image = film.image();
    let values = image.pixels().iter().map(|p| f64::from(p.x));
    let n = values.len() as f64;
    let square = values.clone().map(|v| (v - case.truth) * (v - case.truth)).sum::<f64>() / n;
    match case.metric {
        Metric::Mean => (values.sum::<f64>() / n - case.truth).abs(),
        Metric::Rmse => square.sqrt(),
        // All pixels have one truth, to which the estimated value is close.
        Metric::RelMse => {
            values.map(|v| (v - case.truth).powi(2) / (v * v + 0.01)).sum::<f64>() / n
        }
    }
}

/// What many seeds gave.
#[derive(Default)]
struct Tally {
    seeds: u32,
    converged: u32,
    /// The true error was within the upper bound.
    below: u32,
    /// It was within the tolerance, and convergence was claimed.
    good: u32,
    samples: u64,
}

fn tally(case: &Case, method: SampleMethod, until: &Until, seeds: u32) -> Tally {
    let (texture, number) = (texture(), case.number);
    let kernel = estimator!(number, texture, method);
    let all = Mutex::new(Tally::default());
    in_parallel(seeds as usize, 8, |part| {
        for seed in part {
            let sampling = Sampling::new(1).pixels(PixelSampler::Center).seed(seed as u32);
            let mut film = Film::new(case.film.0, case.film.1);
            // A packet would have one lane at work for one pixel.
            let variant = if case.film == (1, 1) { Variant::Scalar } else { Variant::widest() };
            let scheduler = SimpleScheduler::new().variant(variant);
            let reached = scheduler
                .render_until(&camera(), &kernel, &sampling, &mut film, until)
                .expect("a target and a budget");
            let error = error(case, &film);
            let has_converged = reached.outcome == Outcome::Converged;
            let mut all = all.lock().expect("no one panics");
            all.seeds += 1;
            all.converged += u32::from(has_converged);
            all.below += u32::from(error <= reached.estimate.high);
            all.good += u32::from(has_converged && error <= until.target.tolerance);
            all.samples += u64::from(reached.spent);
        }
    });
    all.into_inner().expect("no one panics")
}

/// Of a tolerance that is a share of the value.
fn target(case: &Case, share: f64) -> Target {
    let tolerance = match case.metric {
        Metric::RelMse => share * share,
        _ => share * case.truth,
    };
    Target::new(case.metric, tolerance)
}

/// The claimed 95 % are between 93 and 99 % of the seeds; and 90 % where a pixel is rarely bright.
#[test]
fn the_confidence_is_as_claimed() {
    let seeds = scaled(64) as u32;
    println!("{seeds} seeds: % of bounds that hold, and samples a pixel");
    println!("{:32} {:>16} {:>16} {:>16}", "", "random", "Sobol", "out of samples");
    let mut wrong = Vec::new();
    for case in cases() {
        let is_rare = case.number == 10;
        let (random, sobol) = (SampleMethod::Random, SampleMethod::Sobol);
        // A sphere of light is met by one direction in 22.
        let (loose, tight) = match case.number {
            5 => (0.06, 0.02),
            10 => (0.1, 0.02),
            _ => (0.03, 0.006),
        };
        let endless = Budget::of_samples(50_000_000);
        let runs = [
            (random, Until::new(target(&case, loose), endless)),
            (sobol, Until::new(target(&case, tight), endless)),
            (random, Until::new(target(&case, 1e-4), Budget::of_samples(6000))),
        ];
        let mut line = format!("{:32}", case.name);
        for (i, (method, until)) in runs.into_iter().enumerate() {
            let found = tally(&case, method, &until, seeds);
            let share = |n: u32| f64::from(n) / f64::from(found.seeds);
            let covered = share(found.below);
            line += &format!(" {:6.1} {:9}", 100.0 * covered, found.samples / u64::from(seeds));
            // Three standard errors of a share of so many seeds; a thousand leave no doubt.
            let doubt = match seeds {
                1000.. => 0.0,
                _ => 3.0 * (0.05 * 0.95 / f64::from(seeds)).sqrt(),
            };
            let (least, most) = if is_rare { (0.90, 1.0) } else { (0.93, 0.99) };
            let is_covered = covered >= least - doubt && covered <= most + doubt;
            let has_converged = found.converged == if i < 2 { seeds } else { 0 };
            let is_good = i == 2 || share(found.good) >= least - doubt;
            if !(has_converged && is_covered && is_good) {
                wrong.push((case.name, i, covered, found.converged, share(found.good)));
            }
        }
        println!("{line}");
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

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
    let case = &cases()[6];
    let (texture, number, method) = (texture(), case.number, SampleMethod::Sobol);
    let kernel = estimator!(number, texture, method);
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
        let doubt = 3.0 * (0.05 * 0.95 / f64::from(seeds)).sqrt();
        assert!(covered >= 0.93 - doubt, "{noisy}: {covered}");
    }
}

/// Noise that no budget of the tests makes good.
macro_rules! noise {
    ($method:ident) => {
        kernel!(|_ray: Ray, sampler: Sampler| {
            let mut sampler = Sampler { method: $method, ..sampler };
            sampler.next_1d()
        })
    };
}

#[test]
fn budgets_are_kept() -> Result<(), Box<dyn Error>> {
    let method = SampleMethod::Random;
    let kernel = noise!(method);
    let tiled = TiledScheduler::new();
    let target = Target::new(Metric::Rmse, 1e-6);
    for samples in [8, 15, 64, 700, 9000] {
        let mut film = Film::new(8, 8);
        let until = Until::new(target, Budget::of_samples(samples));
        let reached =
            tiled.render_until(&camera(), &kernel, &Sampling::new(1), &mut film, &until)?;
        assert_eq!(reached.outcome, Outcome::OutOfSamples);
        assert!(reached.spent <= samples && samples - reached.spent < 8, "{samples} {reached:?}");
        assert!(reached.estimate.error.is_finite() && film.samples() * 3 >= samples, "{reached:?}");
    }
    // On a shared machine a thread may be away for a while: the best of some.
    let over = (0..5).map(|_| {
        let mut film = Film::new(64, 64);
        let time = Duration::from_millis(400);
        let until = Until::new(target, Budget::of_time(time));
        let begin = Instant::now();
        let reached =
            tiled.render_until(&camera(), &kernel, &Sampling::new(1), &mut film, &until)?;
        let took = begin.elapsed();
        assert_eq!(reached.outcome, Outcome::OutOfTime);
        // What is kept for the end, at most a tenth, may not all be needed.
        let is_spent = took >= time - time / 10;
        assert!(reached.estimate.high.is_finite() && is_spent, "{reached:?}");
        Ok(took.as_secs_f64() / time.as_secs_f64())
    });
    let over = over.collect::<Result<Vec<f64>, UntilError>>()?;
    assert!(over.iter().any(|&t| t <= 1.05), "{over:?}");
    Ok(())
}

/// Two fixed places, half of which are bright: a half round more would show in the mean.
#[test]
fn fixed_places_are_taken_in_whole_rounds() -> Result<(), Box<dyn Error>> {
    let kernel = kernel!(|_ray: Ray, sampler: Sampler| {
        let mut sampler = Sampler { method: SampleMethod::Random, ..sampler };
        let noise = 1e-3 * sampler.next_1d();
        if sampler.index % 8 < 4 { noise } else { 1.0 + noise }
    });
    let sampling = Sampling::new(1).pixels(PixelSampler::Eight);
    let target = Target::new(Metric::Rmse, 1e-9).pilot(20);
    for samples in [64, 100, 777] {
        let until = Until::new(target, Budget::of_samples(samples)).adaptive();
        let mut film = Film::new(40, 20);
        let simple = SimpleScheduler::new().variant(Variant::widest());
        let reached = simple.render_until(&camera(), &kernel, &sampling, &mut film, &until)?;
        assert!(reached.samples >= 64 && reached.spent <= samples, "{reached:?}");
        assert!(film.sample_counts().pixels().iter().all(|n| n % 64 == 0 && *n > 0));
        let is_half = |p: &Vec4| (p.x - 0.5005).abs() < 5e-4;
        assert!(film.image().pixels().iter().all(is_half));
    }
    let until = Until::new(target, Budget::of_samples(63));
    let few = SimpleScheduler::new().render_until(
        &camera(),
        &kernel,
        &sampling,
        &mut Film::new(4, 4),
        &until,
    );
    assert_eq!(few, Err(UntilError::TooFewSamples { samples: 63, needed: 64 }));
    Ok(())
}

#[test]
fn an_observer_hears_of_the_error_and_stops() -> Result<(), Box<dyn Error>> {
    let method = SampleMethod::Random;
    let kernel = noise!(method);
    let tiled = TiledScheduler::new();
    let until = Until::new(
        Target::new(Metric::Rmse, 1e-6),
        Budget::of_time(Duration::from_secs(600)).samples(1_000_000),
    );
    let mut film = Film::new(16, 16);
    let mut heard = Vec::new();
    let mut observer = |progress: &raydsl::render::Progress| {
        heard.push(*progress);
        match progress.estimate.high {
            high if high < 0.02 => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    };
    let sampling = Sampling::new(1);
    let reached = tiled.render_until_observed(
        &camera(),
        &kernel,
        &sampling,
        &mut film,
        &until,
        &mut observer,
    )?;
    assert_eq!(reached.outcome, Outcome::Stopped);
    assert!(reached.estimate.high < 0.02 && film.samples() == reached.samples, "{reached:?}");
    assert_eq!(heard[0].estimate.error, f64::INFINITY);
    let last = heard.last().ok_or("it is told")?;
    assert_eq!((last.estimate, last.samples), (reached.estimate, reached.samples));
    assert!(heard.is_sorted_by(|a, b| a.spent <= b.spent && a.time_left >= b.time_left));
    // One that says so only once is obeyed, whenever it is.
    for nth in 0..40 {
        let mut calls = 0;
        let mut once = |_: &raydsl::render::Progress| {
            calls += 1;
            if calls == nth + 1 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let until = Until::new(until.target.pilot(64), Budget::of_samples(4096));
        let simple = SimpleScheduler::new();
        let reached = simple.render_until_observed(
            &camera(),
            &kernel,
            &sampling,
            &mut film,
            &until,
            &mut once,
        )?;
        assert_eq!((reached.outcome, calls), (Outcome::Stopped, nth + 1));
    }
    // Stopped at once, there is no picture, and its error is unknown.
    let nothing = tiled.render_until_observed(
        &camera(),
        &kernel,
        &sampling,
        &mut film,
        &until,
        &mut |_| ControlFlow::Break(()),
    )?;
    assert_eq!((nothing.samples, film.samples()), (0, 0));
    assert_eq!(nothing.estimate.high, f64::INFINITY);
    Ok(())
}

/// Tests that a device calls the observer after each dispatch. A stopped run leaves the image
/// unchanged, and the film has its whole passes.
#[cfg(feature = "gpu")]
#[test]
fn a_device_hears_the_observer() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu() else { return Ok(()) };
    let method = SampleMethod::Random;
    let kernel = noise!(method);
    let size = 1200;
    let break_at = |at: f64| {
        move |share: f64| match share {
            s if s >= at => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    };
    let mut image = Image::filled(size, size, 7.0f32);
    let mut heard = Vec::new();
    let mut listen = |share: f64| {
        heard.push(share);
        ControlFlow::Continue(())
    };
    let sky = kernel!(|ray: Ray| ray.direction.y);
    let stopped = gpu.frame_observed(&camera(), &sky, &mut image, &mut break_at(0.0))?;
    assert!(stopped.is_break() && image.pixels().iter().all(|&v| v == 7.0));
    assert!(gpu.frame_observed(&camera(), &sky, &mut image, &mut listen)?.is_continue());
    assert!(heard.is_sorted() && heard[0] == 0.0 && heard.last() == Some(&1.0), "{heard:?}");
    assert!(image.pixels().iter().all(|&v| v != 7.0));
    let mut film = Film::new(size, size);
    let (sampling, stop) = (Sampling::new(1), &mut break_at(0.5));
    let stopped = gpu.accumulate_observed(&camera(), &kernel, &sampling, &mut film, 128, stop)?;
    assert!(stopped.is_break() && film.samples() == 64, "{}", film.samples());
    // In the middle of a pass: of a film that no dispatch holds, however fast the device.
    let context = raydsl::gpu::Context::new()?.with_max_binding_bytes(1 << 20);
    let gpu = GpuScheduler::with_context(context);
    let mut film = Film::new(size, size);
    let stop = &mut break_at(0.3);
    let stopped = gpu.accumulate_observed(&camera(), &kernel, &sampling, &mut film, 128, stop)?;
    assert!(stopped.is_break() && film.samples() == 0, "{}", film.samples());
    Ok(())
}

/// What `f32` cannot hold is told at once, as is a picture without numbers.
#[test]
fn what_cannot_be_reached_is_told() -> Result<(), Box<dyn Error>> {
    let method = SampleMethod::Sobol;
    let kernel = noise!(method);
    let tiled = TiledScheduler::new();
    let sampling = Sampling::new(1);
    let budget = Budget::of_time(Duration::from_secs(600));
    let mut film = Film::new(8, 8);
    for (metric, tolerance) in [
        (Metric::Rmse, 1e-9),
        (Metric::Mean, 1e-9),
        (Metric::RelMse, 1e-18),
        (Metric::Rmse, 1e-300),
    ] {
        let until = Until::new(Target::new(metric, tolerance), budget);
        let reached = tiled.render_until(&camera(), &kernel, &sampling, &mut film, &until)?;
        let Outcome::Unresolvable { floor } = reached.outcome else { panic!("{reached:?}") };
        assert!(floor > tolerance / 4.0 && floor < 1e-6, "{metric:?} {floor}");
        assert_eq!(film.samples(), 1024, "the pilot");
    }
    let nan = kernel!(|ray: Ray| vec3(ray.direction.z, 1.0, 1.0) * (ray.direction.z - 2.0).sqrt());
    let until = Until::new(Target::new(Metric::Rmse, 0.1), budget);
    let reached = tiled.render_until(&camera(), &nan, &sampling, &mut film, &until)?;
    assert_eq!(reached.outcome, Outcome::Unresolvable { floor: f64::INFINITY });
    assert_eq!(reached.nan_pixels, 64);
    Ok(())
}

#[test]
fn what_cannot_be_asked_for_is_an_error() {
    let method = SampleMethod::Random;
    let kernel = noise!(method);
    let asked = |target: Target, budget: Budget, width: u32| {
        let mut film = Film::new(width, 4);
        let until = Until::new(target, budget);
        let simple = SimpleScheduler::new();
        simple.render_until(&camera(), &kernel, &Sampling::new(1), &mut film, &until).err()
    };
    let (good, some) = (Target::new(Metric::Rmse, 0.1), Budget::of_samples(8));
    for tolerance in [0.0, -1.0, f64::INFINITY] {
        let target = Target::new(Metric::Rmse, tolerance);
        assert_eq!(asked(target, some, 4), Some(UntilError::Tolerance { tolerance }));
    }
    let nan = asked(Target::new(Metric::Rmse, f64::NAN), some, 4);
    assert!(matches!(nan, Some(UntilError::Tolerance { tolerance }) if tolerance.is_nan()));
    for confidence in [0.0, 0.3, 1.0] {
        let found = asked(good.confidence(confidence), some, 4);
        assert_eq!(found, Some(UntilError::Confidence { confidence }));
    }
    assert_eq!(asked(good.pilot(0), some, 4), Some(UntilError::NoPilot));
    assert_eq!(asked(good, Budget::of_time(Duration::ZERO), 4), Some(UntilError::NoTime));
    let few = asked(good, Budget::of_samples(7), 4);
    assert_eq!(few, Some(UntilError::TooFewSamples { samples: 7, needed: 8 }));
    assert_eq!(asked(good, some, 0), Some(UntilError::NoPixels { width: 0, height: 4 }));
    assert_eq!(asked(good, some, 4), None);
}
