//! What a run is given and what it says: budgets, observers, errors.

use std::error::Error;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::render::{Budget, Metric, Outcome, Target, Until, UntilError};
#[cfg(feature = "gpu")]
use raydsl_tests::gpu::gpu;

use crate::camera;

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
