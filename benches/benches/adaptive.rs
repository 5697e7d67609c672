//! Adaptive sampling of paths, one thread: what it gains in time, to the same error.
//!
//! `render_until` renders each scene to a tolerance with even and with adaptive sampling, in turns
//! with the same seeds. Samples need not cost the same everywhere, so the gain in time is not the gain
//! in samples. Errors are against closed forms where there are any, and otherwise against a picture with
//! more samples.

use std::process::ExitCode;

use clap::Parser;
use raydsl::bsdf::{Lambert, Luminous};
use raydsl::integrators::{PathLimits, path};
use raydsl::light::{AnyLight, Environment, Lights};
use raydsl::prelude::*;
use raydsl::render::{Budget, Metric, Outcome, Target, Until};
use raydsl_benches::clock::{median, seconds, spread};
use raydsl_examples::cornell;
use raydsl_tests::transport::{BALL, Dome, Paint, cube, far_ball, paint, shining_sphere};

type Error = Box<dyn std::error::Error>;

/// Measures adaptive sampling.
#[derive(Parser)]
struct Args {
    /// Rounds; each renders every scene both ways.
    #[arg(long, default_value_t = 7)]
    rounds: u32,
    /// Samples of each pixel of the reference of the Cornell box.
    #[arg(long, default_value_t = 4096)]
    reference: u32,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

/// A picture that is known, and how well it is to be rendered.
struct Known<C> {
    name: &'static str,
    camera: C,
    pixels: PixelSampler,
    /// Columns and rows.
    size: (u32, u32),
    truth: Vec<Vec3>,
    /// Root of the mean squared error.
    tolerance: f64,
}

/// What rounds of even or of adaptive sampling gave.
#[derive(Default)]
struct Rounds {
    seconds: Vec<f64>,
    samples: Vec<f64>,
    errors: Vec<f64>,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("adaptive: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> Result<(), Error> {
    println!("one thread, {} rounds; gain: even over adaptive", args.rounds);
    println!(
        "{:<16}{:>10}{:>9}{:>10}{:>7}{:>10}{:>10}{:>9}{:>7}{:>8}",
        "scene",
        "tolerance",
        "samples",
        "adaptive",
        "gain",
        "error",
        "adaptive",
        "seconds",
        "gain",
        "spread"
    );
    let (white, black) = (Environment::constant(Vec3::ONE)?, Environment::constant(Vec3::ZERO)?);
    let lamp = [shining_sphere(0.5)];
    let shining = Paint { light: 0, ..paint(0.5) };
    let inside = Pinhole::new(vec3(0.1, 0.2, 0.0), vec3(0.1, 0.8, 0.8), Vec3::Z, 1.0);
    let cavity = Known {
        name: "inside a sphere",
        camera: inside,
        pixels: PixelSampler::Jittered,
        size: (64, 64),
        truth: vec![Vec3::ONE; 64 * 64],
        tolerance: 0.007,
    };
    let (camera, size, truth) = far_ball();
    let far = Known {
        name: "a far ball",
        camera,
        pixels: PixelSampler::Center,
        size,
        truth: truth.iter().map(|&v| Vec3::splat(v as f32)).collect(),
        tolerance: 3e-4,
    };
    in_ball(args, &far, paint(0.75), &[], &white)?;
    in_ball(args, &cavity, shining, &lamp, &black)?;
    in_cornell(args)
}

fn in_ball(
    args: &Args,
    known: &Known<Pinhole>,
    paint: Paint,
    lights: &[AnyLight],
    sky: &Environment,
) -> Result<(), Error> {
    let scene = Dome { dome: &BALL, floor: &[] };
    let lights = Lights::new(lights, cube())?.with_environment(sky);
    let limits = PathLimits::new(64);
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |_hit: Hit, _point: ShadingPoint| paint;
        path::<_, _, Paint>(&scene, surface, &lights, limits, ray, sampler).color
    });
    measure(args, known, &kernel)
}

fn in_cornell(args: &Args) -> Result<(), Error> {
    let walls = cornell::walls();
    let lamps = cornell::lamps(&walls);
    let scene = Bvh::build(&walls)?;
    let lights = Lights::new(&lamps, scene.bounds())?;
    let limits = PathLimits::new(6);
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |hit: Hit, _point: ShadingPoint| scene.primitive(hit).material();
        path::<_, _, Luminous<Lambert>>(&scene, surface, &lights, limits, ray, sampler).color
    });
    let (size, camera) = ((128, 128), cornell::camera());
    let mut film = Film::new(size.0, size.1);
    let sampling = Sampling::new(args.reference).seed(0x9e37_79b9);
    TiledScheduler::new().accumulate(&camera, &kernel, &sampling, &mut film, args.reference);
    let truth = film.image().pixels().iter().map(|p| p.truncate()).collect();
    let (name, pixels, tolerance) = ("the Cornell box", PixelSampler::Jittered, 0.008);
    measure(args, &Known { name, camera, pixels, size, truth, tolerance }, &kernel)
}

/// Renders in turns, and prints a row: medians of the rounds.
fn measure<C: Camera + Sync>(
    args: &Args,
    known: &Known<C>,
    kernel: &Kernel<'_, (Ray, Sampler), Vec4>,
) -> Result<(), Error> {
    let target = Target::new(Metric::Rmse, known.tolerance).pilot(64);
    let even = Until::new(target, Budget::of_samples(1_000_000));
    let mut rounds = [Rounds::default(), Rounds::default()];
    for round in 0..args.rounds {
        let mut turns = [(0, even), (1, even.adaptive())];
        if round % 2 == 1 {
            turns.reverse();
        }
        for (which, until) in turns {
            let mut film = Film::new(known.size.0, known.size.1);
            let sampling = Sampling::new(1).pixels(known.pixels).seed(round);
            let scheduler = SimpleScheduler::new().variant(Variant::widest());
            let mut reached = None;
            let seconds = seconds(|| {
                let all =
                    scheduler.render_until(&known.camera, kernel, &sampling, &mut film, &until);
                reached = Some(all);
            });
            let reached = reached.ok_or("it ran")??;
            if reached.outcome != Outcome::Converged {
                return Err(format!("{}: {reached:?}", known.name).into());
            }
            rounds[which].seconds.push(seconds);
            rounds[which].samples.push(f64::from(reached.spent));
            rounds[which].errors.push(rmse(&film, &known.truth));
        }
    }
    let [even, adaptive] = &rounds;
    let gains: Vec<f64> = even
        .seconds
        .iter()
        .zip(&adaptive.seconds)
        .map(|(even, adaptive)| even / adaptive)
        .collect();
    let samples = [median(&even.samples), median(&adaptive.samples)];
    println!(
        "{:<16}{:>10}{:>9.0}{:>10.0}{:>7.2}{:>10.5}{:>10.5}{:>9.2}{:>7.2}{:>7.1}%",
        known.name,
        known.tolerance,
        samples[0],
        samples[1],
        samples[0] / samples[1],
        median(&even.errors),
        median(&adaptive.errors),
        median(&even.seconds),
        median(&gains),
        100.0 * spread(&gains)
    );
    Ok(())
}

/// The true error of a film.
fn rmse(film: &Film, truth: &[Vec3]) -> f64 {
    let image = film.image();
    let square = |(p, t): (&Vec4, &Vec3)| f64::from((p.truncate() - *t).length_squared()) / 3.0;
    let sum: f64 = image.pixels().iter().zip(truth).map(square).sum();
    (sum / truth.len() as f64).sqrt()
}
