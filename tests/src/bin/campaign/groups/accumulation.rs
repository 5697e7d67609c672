//! Films: means and variances of many samples.

use std::error::Error;
use std::sync::{Mutex, PoisonError};

use raydsl::camera::Camera as _;
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::render::{FilmExtent, FilmPart, SAMPLE_BLOCK};
use raydsl_tests::gpu::gpu;
use raydsl_tests::in_parallel;
use raydsl_tests::rng::Rng as Source;

use super::largest;
use crate::measure::Run;
use crate::outcome::{Found, Outcome};
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "accumulation",
    title: "Means and variances of a pixel's samples",
    clauses: &[
        "A mean of up to 1e8 samples is right to 1e-6.",
        "The variance of samples around 1000, uniform over 1, is right to 0.5 %.",
        "Parts of a film may be joined in any order: means and variances differ by at most 2 ulp.",
        "A picture has the same bits with 1, 2, 7 and 64 threads.",
        "Every pixel with a NaN sample is NaN and counted, and no other.",
    ],
    rows,
};

fn rows() -> Vec<Row> {
    vec![
        Row::new("means of a pixel's samples", 1, Unit::Relative, Bound::all(1e-6), |run| {
            let outcome =
                of_films(run, |film, exact| {
                    let means = film.means().zip(exact);
                    largest(means.flat_map(|(mean, exact)| {
                        ((mean - exact.mean).abs() / exact.mean).to_array()
                    }))
                })?;
            Ok(outcome.beside(running_sum(run)))
        }),
        Row::new("variance around 1000", 2, Unit::Relative, Bound::all(5e-3), |run| {
            let outcome = of_films(run, |film, exact| {
                let variances = film.variance().pixels().to_vec().into_iter().zip(exact);
                let off = variances
                    .map(|(found, exact)| (f64::from(found.y) / exact.variance.y - 1.0).abs());
                largest(off)
            })?;
            Ok(outcome.beside(one_pass(run)))
        }),
        Row::new("parts joined in another order", 3, Unit::Ulp, Bound::all(2.0), joined),
        Row::new("1, 2, 7 and 64 threads", 4, Unit::Faults, Bound::NONE, threads),
        Row::new("pixels with a NaN sample", 5, Unit::Faults, Bound::NONE, nans),
    ]
}

fn camera() -> Pinhole {
    Pinhole::new(vec3(1.0, 2.0, -14.0), vec3(0.2, 0.0, 0.0), vec3(0.0, 1.0, 0.0), 0.9)
}

/// The column of pixels with NaN samples.
const NAN_AT: u32 = 1000;

/// A number from 0 to 1, one around 1000, rare bright ones, and the square of the first; NaN in one
/// column.
#[kernel]
fn sampled(_ray: Ray, pixel: UVec2, sampler: Sampler) -> Vec4 {
    let mut sampler = sampler;
    let u = sampler.next_2d();
    let bright = if u.y < 0.01 { 100.0 } else { 0.25 };
    let first = if pixel.x == NAN_AT && u.y < 0.5 { (-1.0 - u.x).sqrt() } else { u.x };
    vec4(first, 999.5 + u.y, bright, u.x * u.x)
}

/// Pixels of a film whose samples are counted by millions.
const PIXELS: u32 = 4;

fn sampling(samples: u32) -> Sampling {
    Sampling::new(samples).pixels(PixelSampler::Center).method(SampleMethod::Random)
}

/// Exact moments of a pixel.
#[derive(Clone, Copy)]
struct Moments {
    mean: glam::DVec4,
    variance: glam::DVec4,
}

/// The same samples in `f64`, around a number near their mean.
fn exact(samples: u32) -> Vec<Moments> {
    let (kernel, sampling) = (Kernel::of::<sampled>(), sampling(samples));
    let rays = camera().begin_frame(PIXELS, 1);
    let center = glam::dvec4(0.5, 1000.0, 1.0, 0.3);
    let of = |x: u32| {
        let all = Mutex::new([glam::DVec4::ZERO; 2]);
        in_parallel(samples as usize, 1 << 14, |part| {
            let mut sums = [glam::DVec4::ZERO; 2];
            for i in part {
                let pixel = uvec2(x, 0);
                let (ray, sampler) = sampling.sample(&rays, pixel, i as u32);
                let off = kernel.call((ray, pixel, sampler)).as_dvec4() - center;
                sums[0] += off;
                sums[1] += off * off;
            }
            let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
            all.iter_mut().zip(sums).for_each(|(mine, theirs)| *mine += theirs);
        });
        let [sum, squares] = all.into_inner().unwrap_or_else(PoisonError::into_inner);
        let n = f64::from(samples);
        let off = sum / n;
        Moments { mean: center + off, variance: (squares - off * off * n) / (n - 1.0) }
    };
    (0..PIXELS).map(of).collect()
}

/// Judges films of every variant, each with the count's samples in a pixel.
fn of_films(
    run: &Run,
    error: impl Fn(&Film, Vec<Moments>) -> f64,
) -> Result<Outcome, Box<dyn Error>> {
    let samples = u32::try_from(run.count.clamp(1000, 1_000_000_000))?;
    let kernel = Kernel::of::<sampled>();
    let of_exact = exact(samples);
    let film = |variant: Variant| {
        let mut film = Film::new(PIXELS, 1);
        let scheduler = TiledScheduler::new().variant(variant);
        scheduler.accumulate(&camera(), &kernel, &sampling(samples), &mut film, samples);
        film
    };
    let mut outcome = Outcome::default();
    let mut add = |name: &'static str, film: &Film, samples: u32, exact: &[Moments]| {
        let mut found = Found::new(name);
        let error = error(film, exact.to_vec());
        found.add(run.unit, error, || format!("{:?}", film.means().collect::<Vec<_>>()));
        found.count = samples.into();
        outcome.found.push(found);
    };
    let scalar = film(Variant::Scalar);
    if run.scalar {
        add("scalar", &scalar, samples, &of_exact);
    }
    let mut other_bits = 0;
    for &packets in &run.packets {
        let film = film(packets);
        other_bits += u64::from(film != scalar);
        add(packets.name(), &film, samples, &of_exact);
    }
    if let Some(gpu) = gpu().filter(|_| run.wgsl) {
        let fewer = samples.min(run.most_in_wgsl.min(u32::MAX.into()) as u32);
        let mut film = Film::new(PIXELS, 1);
        gpu.accumulate(&camera(), &kernel, &sampling(fewer), &mut film, fewer)?;
        let of_fewer = if fewer == samples { of_exact } else { exact(fewer) };
        add("wgsl", &film, fewer, &of_fewer);
    }
    Ok(Outcome { other_bits, ..outcome })
}

/// The error of a sum in `f32` over its count.
fn running_sum(run: &Run) -> f64 {
    let mut rng = Source::new(run.seed);
    let (mut sum, mut exact) = (0.0f32, 0.0f64);
    for _ in 0..run.count {
        let u = rng.unit();
        sum += u;
        exact += f64::from(u);
    }
    (f64::from(sum) / exact - 1.0).abs()
}

/// The error of the mean square less the squared mean, in `f32`.
fn one_pass(run: &Run) -> f64 {
    let mut rng = Source::new(run.seed);
    let (mut sum, mut squares) = (0.0f32, 0.0f32);
    for _ in 0..run.count {
        let v = 999.5 + rng.unit();
        sum += v;
        squares += v * v;
    }
    let n = run.count as f32;
    (f64::from(squares / n - (sum / n) * (sum / n)) * 12.0 - 1.0).abs()
}

/// Samples of the film whose parts are joined: 16 blocks, and a part of one.
const JOINED: u32 = 16 * SAMPLE_BLOCK + 20;
const SIZE: UVec2 = UVec2::new(13, 7);

/// Divides ranges of samples at random, and joins what comes of it in random order.
fn joined(run: &Run) -> Result<Outcome, Box<dyn Error>> {
    let (camera, kernel, sampling) = (camera(), Kernel::of::<sampled>(), sampling(JOINED));
    let scheduler = TiledScheduler::new();
    let part = |samples| -> Result<FilmPart, Box<dyn Error>> {
        let extent = FilmExtent::new(SIZE, uvec2(0, 0), SIZE, samples)?;
        Ok(scheduler.render_part(&camera, &kernel, &sampling, &extent))
    };
    let whole = Film::from_parts(SIZE, &[part(0..JOINED)?])?;
    let mut found = Found::new("host");
    let mut rng = Source::new(run.seed);
    for _ in 0..(run.count / 100_000).clamp(3, 100) {
        let cuts = (1..16).filter(|_| rng.below(2) == 0).map(|block| block * SAMPLE_BLOCK);
        let cuts: Vec<u32> = [0].into_iter().chain(cuts).chain([JOINED]).collect();
        let parts = cuts.windows(2).map(|ends| part(ends[0]..ends[1]));
        let mut parts = parts.collect::<Result<Vec<_>, _>>()?;
        while parts.len() > 1 {
            let i = rng.below(parts.len() - 1);
            let next = parts.remove(i + 1);
            let before = parts.remove(i);
            parts.insert(i, before.join(next)?);
        }
        let other = Film::from_parts(SIZE, &parts)?;
        for (a, b) in [(other.image(), whole.image()), (other.variance(), whole.variance())] {
            for (a, b) in a.pixels().iter().zip(b.pixels()) {
                let off = (a.as_dvec4() - b.as_dvec4()).abs();
                let ulps = b.to_array().map(|b| f64::from(b.abs().next_up() - b.abs()));
                let off = (off / glam::DVec4::from_array(ulps)).to_array();
                found.add(run.unit, largest(off), || format!("cuts at {cuts:?}"));
            }
        }
    }
    Ok(Outcome::host(found))
}

fn threads(run: &Run) -> Result<Outcome, Box<dyn Error>> {
    let (kernel, size) = (Kernel::of::<sampled>(), uvec2(131, 77));
    let samples = (run.count / 10_000).clamp(2, 256) as u32;
    let rendered = |threads: usize| -> Result<Film, Box<dyn Error>> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let mut film = Film::new(size.x, size.y);
        let sampling = sampling(samples).pixels(PixelSampler::Jittered);
        pool.install(|| {
            let scheduler = TiledScheduler::new();
            scheduler.accumulate(&camera(), &kernel, &sampling, &mut film, samples);
        });
        Ok(film)
    };
    let expected = rendered(1)?;
    let mut found = Found::new("host");
    for threads in [2, 7, 64] {
        let film = rendered(threads)?;
        for (i, (a, b)) in film.means().zip(expected.means()).enumerate() {
            let is_other = a.to_array().map(f64::to_bits) != b.to_array().map(f64::to_bits);
            found.add(run.unit, f64::from(u8::from(is_other)), || {
                format!("pixel {i} with {threads} threads: {a}, not {b}")
            });
        }
        let is_other = film != expected;
        found.add(run.unit, f64::from(u8::from(is_other)), || format!("{threads} threads"));
    }
    Ok(Outcome::host(found))
}

fn nans(run: &Run) -> Result<Outcome, Box<dyn Error>> {
    let (kernel, size, samples) = (Kernel::of::<sampled>(), uvec2(NAN_AT + 10, 3), 64);
    let judged = |name: &'static str, film: &Film| {
        let mut found = Found::new(name);
        for (i, pixel) in film.image().pixels().iter().enumerate() {
            let is_nan = i as u32 % size.x == NAN_AT;
            found.add(run.unit, f64::from(u8::from(pixel.x.is_nan() != is_nan)), || {
                format!("pixel {i} is {pixel}")
            });
        }
        let (counted, expected) = (film.nan_pixels(), size.y as usize);
        found.add(run.unit, f64::from(u8::from(counted != expected)), || {
            format!("{counted} counted, not {expected}")
        });
        found
    };
    let mut outcome = Outcome::default();
    let scalar = [Variant::Scalar].into_iter().filter(|_| run.scalar);
    for variant in scalar.chain(run.packets.iter().copied()) {
        let mut film = Film::new(size.x, size.y);
        let scheduler = TiledScheduler::new().variant(variant);
        scheduler.accumulate(&camera(), &kernel, &sampling(samples), &mut film, samples);
        outcome.found.push(judged(variant.name(), &film));
    }
    if let Some(gpu) = gpu().filter(|_| run.wgsl) {
        let mut film = Film::new(size.x, size.y);
        gpu.accumulate(&camera(), &kernel, &sampling(samples), &mut film, samples)?;
        outcome.found.push(judged("wgsl", &film));
    }
    Ok(outcome)
}
