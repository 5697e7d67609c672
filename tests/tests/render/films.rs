//! Films: the same samples from every scheduler, variant, tile and number of threads.

use std::error::Error;
use std::ops::ControlFlow;

use raydsl::camera::{Camera, CameraRays};
use raydsl::integrators::Stepped;
use raydsl::prelude::*;
use raydsl::render::{Shot, Watch};
use raydsl::{Type, kernel};
use raydsl_tests::gpu::gpu;
use raydsl_tests::scenes::spheres;

const CPU: [Variant; 4] = [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16];
const PATTERNS: [PixelSampler; 5] = [
    PixelSampler::Center,
    PixelSampler::Two,
    PixelSampler::Four,
    PixelSampler::Eight,
    PixelSampler::Jittered,
];

fn camera() -> Pinhole {
    Pinhole::new(vec3(1.0, 2.0, -14.0), vec3(0.2, 0.0, 0.0), vec3(0.0, 1.0, 0.0), 0.9)
}

/// A light of random colour, seen past spheres.
macro_rules! lit {
    ($bvh:ident) => {
        kernel!(|ray: Ray, pixel: UVec2, sampler: Sampler| {
            let mut sampler = sampler;
            let u = sampler.next_2d();
            let hit = $bvh.closest_hit(ray);
            let column = pixel.x as f32 * 0.01;
            if hit.is_hit { vec4(u.x, u.y, column, 1.0) } else { vec4(0.1, 0.2, u.x, 0.0) }
        })
    };
}

/// One scheduler that is the user's own.
struct Own;

impl Scheduler for Own {
    fn run<S: Shot>(&self, shot: &S, image: &mut Image<S::Output>, watch: &Watch<'_>) {
        for mut tile in image.tiles(5).rev() {
            tile.render(shot, Variant::Packet4);
            watch.advance(tile.area());
        }
    }

    fn run_batch<A: raydsl::Type, R: raydsl::Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    ) {
        kernel.run(Variant::Packet4, inputs, outputs);
    }
}

#[test]
fn every_scheduler_and_variant_and_tile() -> Result<(), Box<dyn Error>> {
    let balls = spheres(800);
    let bvh = Bvh::build(&balls)?;
    let methods = [SampleMethod::Random, SampleMethod::Stratified, SampleMethod::Sobol];
    for (pixels, i) in PATTERNS.into_iter().zip(0..) {
        let method = methods[i % 3];
        let kernel = lit!(bvh);
        let sampling = Sampling::new(70).pixels(pixels).method(method).seed(i as u32);
        let accumulated = |scheduler: &dyn Fn(&mut Film)| {
            let mut film = Film::new(37, 21);
            scheduler(&mut film);
            assert_eq!(film.samples(), 70);
            film
        };
        let expected = accumulated(&|film| {
            SimpleScheduler::new().accumulate(&camera(), &kernel, &sampling, film, 70);
        });
        let own = accumulated(&|film| Own.accumulate(&camera(), &kernel, &sampling, film, 70));
        assert!(own == expected, "own {pixels:?}");
        for v in CPU {
            for edge in [1, 7, 16, 64] {
                let found = accumulated(&|film| {
                    let tiled = TiledScheduler::new().variant(v).tile(edge);
                    tiled.accumulate(&camera(), &kernel, &sampling, film, 70);
                });
                assert!(found == expected, "{v:?} {pixels:?} tiles of {edge}");
            }
        }
        if let Some(gpu) = gpu() {
            let mut found = Film::new(37, 21);
            let timing = gpu.accumulate(&camera(), &kernel, &sampling, &mut found, 70)?;
            assert!(found == expected && timing.dispatches >= 2, "WGSL {pixels:?} {timing:?}");
        }
    }
    Ok(())
}

#[test]
fn any_number_of_threads() -> Result<(), Box<dyn Error>> {
    let balls = spheres(800);
    let bvh = Bvh::build(&balls)?;
    let kernel = lit!(bvh);
    let sampling = Sampling::new(16);
    let mut expected = Film::new(131, 77);
    SimpleScheduler::new().accumulate(&camera(), &kernel, &sampling, &mut expected, 16);
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let mut found = Film::new(131, 77);
        pool.install(|| {
            TiledScheduler::new().accumulate(&camera(), &kernel, &sampling, &mut found, 16);
        });
        assert!(found == expected, "{threads} threads");
    }
    Ok(())
}

/// The mean of a film is that of its samples, and so is the variance.
#[test]
fn means_and_variances() {
    let kernel = kernel!(|_ray: Ray, sampler: Sampler| {
        let mut sampler = Sampler { method: SampleMethod::Random, ..sampler };
        sampler.next_1d()
    });
    let mut film = Film::new(40, 40);
    let sampling = Sampling::new(1000).pixels(PixelSampler::Center);
    TiledScheduler::new().accumulate(&camera(), &kernel, &sampling, &mut film, 500);
    TiledScheduler::new().accumulate(&camera(), &kernel, &sampling, &mut film, 500);
    let average = |image: &Image<Vec4>| {
        image.pixels().iter().map(|p| f64::from(p.x)).sum::<f64>() / image.pixels().len() as f64
    };
    // Of 1.6 million uniform numbers: five standard errors.
    assert!((average(&film.image()) - 0.5).abs() < 5.0 * (1.0 / 12.0f64 / 1.6e6).sqrt());
    let variance = average(&film.variance());
    assert!((variance * 12.0 - 1.0).abs() < 5e-3, "{variance}");
    let error = average(&film.standard_error());
    assert!((error - (1.0 / 12.0f64 / 1000.0).sqrt()).abs() < 1e-4, "{error}");
    assert_eq!(film.image().pixels()[0].w, 1.0);
    film.clear();
    assert_eq!((film.samples(), film.image().pixels()[7]), (0, Vec4::ZERO));
}

/// Jittered samples cover their pixel, and only that.
#[test]
fn samples_lie_in_their_pixel() {
    let camera = Flat;
    let kernel = kernel!(|ray: Ray, pixel: UVec2| {
        let place = vec2(ray.origin.x, ray.origin.y) - pixel.as_vec2();
        vec4(place.x, place.y, 0.0, 0.0)
    });
    for (pixels, width) in [(PixelSampler::Jittered, 1.0), (PixelSampler::Eight, 63.0 / 64.0)] {
        let mut film = Film::new(19, 11);
        let sampling = Sampling::new(64).pixels(pixels);
        SimpleScheduler::new().accumulate(&camera, &kernel, &sampling, &mut film, 64);
        for (mean, variance) in film.image().pixels().iter().zip(film.variance().pixels()) {
            let (mean, variance) = (mean.truncate().truncate(), variance.truncate().truncate());
            assert!((mean - 0.5).abs().max_element() < 0.02, "{pixels:?} {mean}");
            let expected = width / 12.0 * 64.0 / 63.0;
            assert!((variance - expected).abs().max_element() < 4e-3, "{pixels:?} {variance}");
        }
    }
}

/// Rays that begin at the point of the film.
struct Flat;

#[derive(Clone, Copy, Debug, raydsl::Type)]
struct FlatRays {
    z: f32,
}

#[raydsl::kernel]
impl CameraRays for FlatRays {
    fn primary_ray(&self, x: f32, y: f32) -> Ray {
        Ray::new(vec3(x, y, self.z), vec3(0.0, 0.0, 1.0))
    }
}

impl Camera for Flat {
    type Rays = FlatRays;

    fn begin_frame(&self, _: u32, _: u32) -> FlatRays {
        FlatRays { z: -1.0 }
    }
}

/// The lens is asked for its own dimensions, and only where there is one.
#[test]
fn lenses_blur_what_is_not_at_their_distance() -> Result<(), Box<dyn Error>> {
    let balls = spheres(800);
    let bvh = Bvh::build(&balls)?;
    let seen = kernel!(|ray: Ray| if bvh.any_hit(ray) { 1.0 } else { 0.0 });
    let sampling = Sampling::new(32).pixels(PixelSampler::Center);
    let film = |lens: f32, variant: Variant| {
        let mut film = Film::new(33, 17);
        let camera = ThinLens::new(camera(), lens, 3.0);
        let scheduler = TiledScheduler::new().variant(variant);
        scheduler.accumulate(&camera, &seen, &sampling, &mut film, 32);
        film
    };
    let grey =
        |film: &Film| film.image().pixels().iter().filter(|p| p.x > 0.0 && p.x < 1.0).count();
    assert_eq!(grey(&film(0.0, Variant::Scalar)), 0);
    let expected = film(0.5, Variant::Scalar);
    assert!(grey(&expected) > 100, "{}", grey(&expected));
    for v in CPU {
        assert!(film(0.5, v) == expected, "{v:?}");
    }
    Ok(())
}

/// An observer hears of progress, and stops a picture; a film keeps whole passes.
#[test]
fn observers_are_told_and_obeyed() {
    let kernel = kernel!(|ray: Ray| ray.direction.y);
    let tiled = TiledScheduler::new();
    let mut shares = Vec::new();
    let mut image = Image::filled(100, 100, 7.0);
    let end = tiled.frame_observed(&camera(), &kernel, &mut image, &mut |share| {
        shares.push(share);
        ControlFlow::Continue(())
    });
    assert!(end.is_continue() && !image.pixels().contains(&7.0));
    assert!(shares.is_sorted() && shares[0] == 0.0 && shares.last() == Some(&1.0), "{shares:?}");
    let mut image = Image::filled(100, 100, 7.0);
    let stop =
        tiled.frame_observed(&camera(), &kernel, &mut image, &mut |_| ControlFlow::Break(()));
    assert!(stop.is_break() && image.pixels().iter().all(|&p| p == 7.0));
    // On one thread, so that no tile finds the observer busy.
    let mut film = Film::new(20, 20);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let stop = pool.install(|| {
        tiled.accumulate_observed(
            &camera(),
            &kernel,
            &Sampling::new(256),
            &mut film,
            256,
            &mut |done| if done > 0.6 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) },
        )
    });
    assert!(stop.is_break());
    assert_eq!(film.samples(), 128, "two passes of 64");
    let mut expected = Film::new(20, 20);
    tiled.accumulate(&camera(), &kernel, &Sampling::new(256), &mut expected, 128);
    assert!(film == expected);
}

/// A sample that is no number is seen, counted, and never taken for a number.
#[test]
fn samples_that_are_no_numbers_are_counted() {
    let kernel = kernel!(|ray: Ray, pixel: UVec2| {
        let x: f32 = if pixel.x == 3 { -1.0 } else { 1.0 };
        vec4(x.sqrt(), ray.direction.y, 0.0, 1.0)
    });
    let mut film = Film::new(8, 4);
    TiledScheduler::new().accumulate(&camera(), &kernel, &Sampling::new(4), &mut film, 4);
    assert_eq!(film.nan_pixels(), 4);
    let shown = raydsl::render::Display::new().show(&film.image());
    assert_eq!(shown.get(3, 2).map(|p| p.map(|c| c.to_bits())), Some([255, 0, 255, 255]));
}

#[test]
fn batches_without_a_camera() {
    let kernel = kernel!(|x: f32, n: u32| x * n as f32);
    let inputs: Vec<(f32, u32)> = (0..5000).map(|i| (i as f32 * 0.5, i)).collect();
    let expected: Vec<f32> = inputs.iter().map(|&(x, n)| x * n as f32).collect();
    for v in CPU {
        let mut found = vec![0.0; inputs.len()];
        TiledScheduler::new().variant(v).batch(&kernel, &inputs, &mut found);
        assert_eq!(found, expected, "{v:?}");
    }
    let mut found = vec![0.0; inputs.len()];
    Own.batch(&kernel, &inputs, &mut found);
    assert_eq!(found, expected);
}

/// The first frame of a film of no pixels is one of no pixels.
#[test]
fn films_of_any_size() {
    let kernel = kernel!(|ray: Ray| ray.direction);
    for (width, height) in [(0, 5), (5, 0), (1, 1), (1, 70), (65_535, 1)] {
        let mut film = Film::new(width, height);
        TiledScheduler::new().accumulate(&camera(), &kernel, &Sampling::new(0), &mut film, 2);
        assert_eq!(film.image().pixels().len(), width as usize * height as usize);
        assert_eq!((film.samples(), film.nan_pixels()), (2, 0));
    }
}

/// A result of many channels.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
struct Pixel {
    light: Vec3,
    depth: f32,
    albedo: [f32; 3],
    id: u32,
    is_hit: bool,
}

#[kernel]
impl Radiance for Pixel {
    fn rgba(&self) -> Vec4 {
        self.light.extend(self.depth)
    }
}

macro_rules! pixel {
    ($bvh:ident) => {
        kernel!(|ray: Ray, sampler: Sampler| {
            let mut sampler = Sampler { method: SampleMethod::Random, ..sampler };
            let u = sampler.next_2d();
            let hit = $bvh.closest_hit(ray);
            let mut depth = 2.5;
            if hit.is_hit {
                depth = hit.t;
            }
            let light = vec3(u.x, u.y, 1.0) * depth;
            let albedo = [u.x * 0.5, 0.25, u.y * u.y];
            Pixel { light, depth, albedo, id: hit.prim_id, is_hit: hit.is_hit }
        })
    };
}

/// Every number of a result has its mean and its error, the same in every variant and tile.
#[test]
fn channels_of_every_variant() -> Result<(), Box<dyn Error>> {
    let balls = spheres(800);
    let bvh = Bvh::build(&balls)?;
    let kernel = pixel!(bvh);
    let sampling = Sampling::new(70).seed(5);
    let mut expected = Film::<Pixel>::of_channels(37, 21);
    // Without samples there is no error.
    assert_eq!(expected.channel_errors().pixels()[0].depth, 0.0);
    SimpleScheduler::new().variant(Variant::Scalar).accumulate(
        &camera(),
        &kernel,
        &sampling,
        &mut expected,
        70,
    );
    let (means, errors) = (expected.channels(), expected.channel_errors());
    // The same in `f64`, sample by sample.
    let rays = camera().begin_frame(37, 21);
    let mut most = 0.0f64;
    for (x, y) in [(0, 0), (18, 10), (17, 9), (36, 20)] {
        let sample = |i: u32| {
            let (ray, sampler) = sampling.sample(&rays, uvec2(x, y), i);
            kernel.call((ray, sampler))
        };
        let all: Vec<Pixel> = (0..70).map(sample).collect();
        let channel = |of: fn(&Pixel) -> f32, mean: f32, error: f32| {
            let value = |p: &Pixel| f64::from(of(p));
            let exact = all.iter().map(value).sum::<f64>() / 70.0;
            let squares = all.iter().map(|p| (value(p) - exact).powi(2)).sum::<f64>();
            let exact_error = (squares / 69.0 / 70.0).sqrt();
            assert!((f64::from(mean) - exact).abs() <= 2e-6 * exact.abs(), "{mean} {exact}");
            let off = (f64::from(error) - exact_error).abs();
            assert!(off <= 1e-4 * exact_error + 1e-6 * exact.abs(), "{error} {exact_error}");
            exact_error
        };
        let (mean, error) = (means.get(x, y).ok_or("inside")?, errors.get(x, y).ok_or("inside")?);
        channel(|p| p.light.y, mean.light.y, error.light.y);
        channel(|p| p.albedo[2], mean.albedo[2], error.albedo[2]);
        channel(|p| p.albedo[1], mean.albedo[1], error.albedo[1]);
        most = most.max(channel(|p| p.depth, mean.depth, error.depth));
        let last = all.last().ok_or("samples")?;
        assert_eq!((mean.id, mean.is_hit), (last.id, last.is_hit));
        assert_eq!((error.id, error.is_hit), (0, false));
    }
    assert!(most > 0.0, "an edge has a mean of two depths");
    // The colour is the one of a film of colours.
    let mut colors = Film::new(37, 21);
    SimpleScheduler::new().accumulate(&camera(), &kernel, &sampling, &mut colors, 70);
    assert_eq!(colors.image(), expected.image());
    assert_eq!(colors.standard_error(), expected.standard_error());
    for variant in CPU {
        for edge in [7, 16] {
            let mut film = Film::<Pixel>::of_channels(37, 21);
            let tiled = TiledScheduler::new().variant(variant).tile(edge);
            tiled.accumulate(&camera(), &kernel, &sampling, &mut film, 30);
            tiled.accumulate(&camera(), &kernel, &sampling, &mut film, 40);
            let same = |a: f32, b: f32| (a - b).abs() <= 1e-5 * b.abs();
            let found = film.channels();
            let pairs = found.pixels().iter().zip(means.pixels());
            for (a, b) in pairs {
                assert!(same(a.depth, b.depth) && same(a.light.x, b.light.x), "{a:?} {b:?}");
                assert_eq!((a.id, a.is_hit), (b.id, b.is_hit));
            }
            let mut film = Film::<Pixel>::of_channels(37, 21);
            tiled.accumulate(&camera(), &kernel, &sampling, &mut film, 70);
            assert!(film == expected, "{variant:?}");
        }
    }
    if let Some(gpu) = gpu() {
        let mut found = Film::<Pixel>::of_channels(37, 21);
        gpu.accumulate(&camera(), &kernel, &sampling, &mut found, 70)?;
        assert!(found == expected, "WGSL");
    }
    Ok(())
}

/// A tuple is a result like any other; its colour is that of its first member.
#[test]
fn channels_of_a_tuple() -> Result<(), Box<dyn Error>> {
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let mut sampler = sampler;
        let u = sampler.next_1d();
        (vec3(u, 1.0, 0.0), ray.direction, u * u)
    });
    let sampling = Sampling::new(256);
    let mut film = Film::<(Vec3, Vec3, f32)>::of_channels(8, 8);
    TiledScheduler::new().accumulate(&camera(), &kernel, &sampling, &mut film, 256);
    for (pixel, (color, direction, square)) in
        film.image().pixels().iter().zip(film.channels().pixels())
    {
        assert_eq!(*pixel, color.extend(1.0));
        assert!((direction.length() - 1.0).abs() < 0.1);
        assert!((square - 1.0 / 3.0).abs() < 2e-3, "{square}");
    }
    if let Some(gpu) = gpu() {
        let mut found = Film::<(Vec3, Vec3, f32)>::of_channels(8, 8);
        gpu.accumulate(&camera(), &kernel, &sampling, &mut found, 256)?;
        assert_eq!(found.image(), film.image());
    }
    Ok(())
}

/// A run to a target error keeps the channels of the picture that it returns.
#[test]
fn channels_to_a_target_error() -> Result<(), Box<dyn Error>> {
    use raydsl::render::{Budget, Metric, Target, Until};
    let kernel = kernel!(|_ray: Ray, sampler: Sampler| {
        let mut sampler = Sampler { method: SampleMethod::Random, ..sampler };
        let u = sampler.next_1d();
        (u, 3.0 * u)
    });
    let target = Target::new(Metric::Rmse, 0.01).pilot(64);
    let until = Until::new(target, Budget::of_samples(100_000)).adaptive();
    let mut film = Film::<(f32, f32)>::of_channels(20, 20);
    // What was there is cleared.
    TiledScheduler::new().accumulate(&camera(), &kernel, &Sampling::new(3), &mut film, 3);
    let sampling = Sampling::new(1);
    let reached =
        TiledScheduler::new().render_until(&camera(), &kernel, &sampling, &mut film, &until)?;
    assert!(reached.samples > 64 && reached.samples.abs_diff(film.samples()) < 2000);
    let (means, errors) = (film.channels(), film.channel_errors());
    for (i, (mean, error)) in means.pixels().iter().zip(errors.pixels()).enumerate() {
        assert_eq!(mean.0, film.image().pixels()[i].x);
        assert!((mean.1 / mean.0 - 3.0).abs() < 1e-5 && (error.1 / error.0 - 3.0).abs() < 1e-3);
        assert!(error.0 > 0.0 && (mean.0 - 0.5).abs() < 6.0 * error.0, "{mean:?} {error:?}");
    }
    let variances = film.channel_variances();
    let mean = variances.pixels().iter().map(|v| f64::from(v.0)).sum::<f64>() / 400.0;
    assert!((mean * 12.0 - 1.0).abs() < 0.05, "{mean}");
    Ok(())
}

/// A walk along numbers of a sampler, of very different lengths.
#[derive(Clone, Copy, Type)]
struct Walk {
    sampler: Sampler,
    at: f32,
    steps: u32,
}

#[kernel]
impl Stepped for Walk {
    fn begin(ray: Ray, sampler: Sampler) -> Self {
        Walk { sampler, at: 0.1 * ray.direction.x, steps: 0 }
    }

    fn is_over(&self) -> bool {
        self.at > 0.9 || self.steps >= 40
    }
}

#[kernel]
fn walked(walk: Walk) -> Walk {
    let mut sampler = walk.sampler;
    let at = 0.2 * walk.at + sampler.next_1d();
    Walk { sampler, at, steps: walk.steps + 1 }
}

/// Films of whole samples and of their steps are the same, whatever is in the lanes of a packet.
#[test]
fn steps_have_the_bits_of_whole_samples() {
    let whole = kernel!(|ray: Ray, sampler: Sampler| {
        let mut walk = walked(Walk::begin(ray, sampler));
        while !walk.is_over() {
            walk = walked(walk);
        }
        (walk.at, walk.steps as f32)
    });
    let step = kernel!(|walk: Walk| walked(walk));
    let sample = |walk: &Walk| (walk.at, walk.steps as f32);
    let pinhole = Pinhole::new(vec3(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 0.9);
    let lens = ThinLens::new(pinhole, 0.1, 3.0);
    for method in [SampleMethod::Random, SampleMethod::Stratified, SampleMethod::Sobol] {
        let sampling = Sampling::new(100).method(method).seed(5);
        let mut expected = Film::<(f32, f32)>::of_channels(37, 21);
        let scalar = TiledScheduler::new().variant(Variant::Scalar);
        scalar.accumulate(&lens, &whole, &sampling, &mut expected, 70);
        scalar.accumulate(&lens, &whole, &sampling, &mut expected, 30);
        for variant in CPU {
            for (edge, gang) in [(16, 64), (1, 0), (u32::MAX, 16)] {
                let scheduler = TiledScheduler::new().variant(variant).tile(edge).gang(gang);
                let mut film = Film::<(f32, f32)>::of_channels(37, 21);
                scheduler.accumulate_steps(&lens, &step, sample, &sampling, &mut film, 70);
                scheduler.accumulate_steps(&lens, &step, sample, &sampling, &mut film, 30);
                assert!(film == expected, "{method:?} {variant:?} {edge} {gang}");
            }
        }
    }
    let mut nothing = Film::new(0, 5);
    let light = |walk: &Walk| walk.at;
    TiledScheduler::new().accumulate_steps(
        &pinhole,
        &step,
        light,
        &Sampling::new(4),
        &mut nothing,
        4,
    );
}
