//! Path tracing on one thread: paths a second, and what a picture's error costs.
//!
//! A path is a sample of a pixel: up to six bounces, a light sampled at each, no Russian roulette.
//! Every variant of the library takes turns with a path tracer in plain Rust, `plain.rs`, over two
//! scenes: the Cornell box, and Sponza, of grey triangles under a white sky, from `sponza.tri` and
//! `cameras.json` in the folder `RAYDSL_DATA`. WGSL runs where there is a device, by the time of day;
//! on one that is the CPU in disguise, if `--device` says so.
//!
//! The error is relMSE: the mean over all pixels and channels of `(x - r)^2 / (r^2 + 0.01)`, none of
//! them left out, against a picture `r` of the library with other random numbers and more samples,
//! whose own error is a part of it. Error times seconds is, for independent samples, the same for any
//! number of them: less is better. The means of all pictures are compared: those that are off fail the
//! run.
//!
//! `--write-scenes` writes the scenes and references for other renderers: `benches/rivals/path.py`
//! measures those. Its settings are `--samples 64 --reference 8192`.

mod case;
mod plain;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use raydsl::bsdf::{Lambert, Luminous};
use raydsl::integrators::{PathLimits, PathOptions, PathState, path, path_step};
use raydsl::light::{AreaLight, Environment, Lights};
use raydsl::prelude::*;
use raydsl_benches::clock::{median, seconds_on, spread};
use raydsl_benches::scenes;
use raydsl_examples::cornell;
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde::Serialize;

use case::Case;
use plain::Plain;

type Error = Box<dyn std::error::Error>;

/// A path as a whole, and one step of it.
struct Paths<'a> {
    whole: Kernel<'a, (Ray, Sampler), Vec4>,
    step: Kernel<'a, (PathState,), PathState>,
}

/// Measures path tracing.
#[derive(Parser)]
struct Args {
    /// Only this scene.
    #[arg(long, value_enum)]
    scene: Option<Name>,
    /// Writes the rows to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Writes the scenes and their references to this folder, and measures nothing.
    #[arg(long)]
    write_scenes: Option<PathBuf>,
    /// Takes the references from this folder.
    #[arg(long)]
    references: Option<PathBuf>,
    /// Samples of each pixel of the references.
    #[arg(long, default_value_t = 128)]
    reference: u32,
    /// Width and height of the pictures.
    #[arg(long, default_value_t = 512)]
    size: u32,
    /// Samples of each pixel.
    #[arg(long, default_value_t = 8)]
    samples: u32,
    /// How often light is scattered at most.
    #[arg(long, default_value_t = 6)]
    bounces: u32,
    /// Rounds; each measures everything once, with a seed of its own.
    #[arg(long, default_value_t = 3)]
    rounds: u32,
    /// Seed of the first round.
    #[arg(long, default_value_t = 0)]
    seed: u32,
    /// Only rows whose names contain one of these words.
    #[arg(long)]
    only: Vec<String>,
    /// The library's trees; the faster ones of each scene, unless said.
    #[arg(long, value_enum)]
    tree: Option<Tree>,
    /// Measures WGSL on a device that is the CPU in disguise, too.
    #[arg(long)]
    device: bool,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Name {
    Cornell,
    Sponza,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Tree {
    Binary,
    Wide,
}

/// Who renders.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Contender {
    Library(Variant, SampleMethod),
    /// In steps, lanes refilled.
    Steps(Variant),
    Plain,
}

#[derive(Serialize)]
struct Row {
    scene: &'static str,
    renderer: String,
    isa: &'static str,
    /// Millions of paths a second, the median of all rounds.
    rate: f64,
    /// The middle half of the rounds, as a share.
    spread: f64,
    /// Against plain Rust, the median of the rounds' ratios.
    to_plain: Option<f64>,
    /// The picture's error.
    rel_mse: f64,
    /// That times the seconds that the picture took.
    rel_mse_seconds: f64,
    /// The mean of the picture over the reference's, less 1.
    bias: f64,
    /// Whether that is more than noise.
    is_off: bool,
}

/// Seed of the references.
const OTHER_SEED: u32 = 0x9e37_79b9;

const NO_SPONZA: &str = "RAYDSL_DATA names no folder with sponza.tri";

/// Greatest difference of a picture's mean from the reference's, beside noise.
const TOLERANCE: f64 = 0.01;

struct Bench {
    args: Args,
    device: Option<GpuScheduler>,
    one_thread: ThreadPool,
}

fn main() -> ExitCode {
    match run(Args::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => {
            eprintln!("path: a picture differs from the reference by more than its noise");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("path: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: Args) -> Result<bool, Error> {
    let device = GpuScheduler::new();
    let is_asked = |gpu: &GpuScheduler| args.device || !is_software(gpu);
    match &device {
        Ok(gpu) if is_asked(gpu) => println!("WGSL on {}", gpu.context().adapter_name()),
        Ok(gpu) => println!("no WGSL: {} is the CPU", gpu.context().adapter_name()),
        Err(error) => println!("no WGSL: {error}"),
    }
    let device = device.ok().filter(is_asked);
    let one_thread = ThreadPoolBuilder::new().num_threads(1).build()?;
    let bench = Bench { args, device, one_thread };
    let (size, samples) = (bench.args.size, bench.args.samples);
    if bench.args.write_scenes.is_none() {
        println!("{size} x {size} pixels, {samples} samples each, one thread");
        println!(
            "{:<9}{:<18}{:<9}{:>8}{:>8}{:>9}{:>10}{:>12}{:>8}",
            "scene", "renderer", "isa", "M/s", "spread", "to plain", "relMSE", "relMSE x s", "bias"
        );
    }
    let mut rows = Vec::new();
    if bench.args.scene != Some(Name::Sponza) {
        rows.extend(in_cornell(&bench)?);
    }
    if bench.args.scene != Some(Name::Cornell) {
        let data = std::env::var_os("RAYDSL_DATA").map(PathBuf::from);
        match data.filter(|data| data.join("sponza.tri").exists()) {
            Some(data) => rows.extend(in_sponza(&bench, &data)?),
            None if bench.args.scene.is_some() => return Err(NO_SPONZA.into()),
            None => eprintln!("SKIPPED sponza: {NO_SPONZA}"),
        }
    }
    if let Some(path) = &bench.args.json {
        std::fs::write(path, serde_json::to_vec_pretty(&rows)?)?;
    }
    Ok(rows.iter().all(|row| !row.is_off))
}

/// Whether a device's threads are those of the CPU.
fn is_software(gpu: &GpuScheduler) -> bool {
    format!("{:?}", gpu.context().adapter_info().device_type) == "Cpu"
}

fn in_cornell(bench: &Bench) -> Result<Vec<Row>, Error> {
    let walls = cornell::walls();
    let lamps = cornell::lamps(&walls);
    let scene = match bench.args.tree {
        Some(Tree::Wide) => Bvh::build_wide(&walls, &[], &BuildConfig::default())?,
        _ => Bvh::build(&walls)?,
    };
    let lights = Lights::new(&lamps, scene.bounds())?;
    let limits = PathLimits { bounces: bench.args.bounces, roulette: u32::MAX };
    let whole = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |hit: Hit, _point: ShadingPoint| scene.primitive(hit).material();
        path::<_, _, Luminous<Lambert>>(&scene, surface, &lights, limits, ray, sampler).color
    });
    let options = PathOptions::new();
    let step = kernel!(|state: PathState| {
        let surface = |hit: Hit, _point: ShadingPoint| scene.primitive(hit).material();
        path_step::<_, _, Luminous<Lambert>>(&scene, surface, &lights, host(options), limits, state)
            .next
    });
    bench.measure(&case::of_walls(&walls, cornell::camera()), &Paths { whole, step })
}

fn in_sponza(bench: &Bench, data: &Path) -> Result<Vec<Row>, Error> {
    let scenes::Scene { prims, camera } = scenes::file(data, "sponza")?;
    let scene = match bench.args.tree {
        Some(Tree::Binary) => Bvh::build(&prims)?,
        _ => Bvh::build_wide(&prims, &[], &BuildConfig::default())?,
    };
    let sky = Environment::constant(Vec3::ONE)?;
    let none: [AreaLight<Triangle>; 0] = [];
    let lights = Lights::new(&none, scene.bounds())?.with_environment(&sky);
    let limits = PathLimits { bounces: bench.args.bounces, roulette: u32::MAX };
    let whole = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
        path::<_, _, Lambert>(&scene, surface, &lights, limits, ray, sampler).color
    });
    let options = PathOptions::new();
    let step = kernel!(|state: PathState| {
        let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
        path_step::<_, _, Lambert>(&scene, surface, &lights, host(options), limits, state).next
    });
    bench.measure(&case::of_triangles("sponza", &prims, camera), &Paths { whole, step })
}

/// The means of a picture that a renderer made, and how long it took.
struct Picture {
    pixels: Vec<[f32; 3]>,
    seconds: f64,
}

/// What rounds of a renderer gave.
#[derive(Default)]
struct Rounds {
    rates: Vec<f64>,
    errors: Vec<f64>,
    costs: Vec<f64>,
    biases: Vec<f64>,
    is_off: bool,
}

impl Bench {
    /// Interleaved rounds over a scene: what the machine does meanwhile touches all alike.
    fn measure(&self, case: &Case, paths: &Paths<'_>) -> Result<Vec<Row>, Error> {
        let Args { size, samples, bounces, .. } = self.args;
        let reference = match &self.args.references {
            Some(folder) => {
                case::read_picture(&folder.join(case::reference_file(case.name)), size)?
            }
            None => {
                let samples = self.args.reference;
                let sampling = Sampling::new(samples).seed(OTHER_SEED);
                let mut film = Film::new(size, size);
                TiledScheduler::new().accumulate(
                    &case.camera,
                    &paths.whole,
                    &sampling,
                    &mut film,
                    samples,
                );
                pixels_of(&film)
            }
        };
        if let Some(folder) = &self.args.write_scenes {
            case.write(folder, (size, bounces), &reference)?;
            return Ok(Vec::new());
        }
        let plain = Plain::new(case);
        let contenders = self.contenders();
        let mut rounds: Vec<Rounds> = contenders.iter().map(|_| Rounds::default()).collect();
        for round in 0..self.args.rounds {
            let seed = self.args.seed + round;
            for (renderer, of) in contenders.iter().zip(&mut rounds) {
                let picture = match *renderer {
                    Contender::Library(variant, method) => {
                        let sampling = Sampling::new(samples).seed(seed).method(method);
                        self.render(case, paths, variant, sampling)?
                    }
                    Contender::Steps(variant) => {
                        self.in_steps(case, paths, variant, Sampling::new(samples).seed(seed))
                    }
                    Contender::Plain => {
                        let render = || plain.render(&case.camera, (size, samples), bounces, seed);
                        let (pixels, seconds) = seconds_on(1, render);
                        Picture { pixels, seconds }
                    }
                };
                let error = rel_mse(&picture.pixels, &reference);
                let (bias, noise) = bias(&picture.pixels, &reference);
                let paths = f64::from(size) * f64::from(size) * f64::from(samples);
                of.rates.push(paths / picture.seconds * 1e-6);
                of.errors.push(error);
                of.costs.push(error * picture.seconds);
                of.biases.push(bias);
                of.is_off |= bias.is_nan() || bias.abs() > TOLERANCE + 4.0 * noise;
            }
        }
        let plain = contenders.iter().position(|r| *r == Contender::Plain);
        let rows = contenders.iter().zip(&rounds).map(|(renderer, of)| {
            let ratios = plain.map(|i| of.rates.iter().zip(&rounds[i].rates).map(|(a, b)| a / b));
            let row = Row {
                scene: case.name,
                renderer: name_of(*renderer),
                isa: match renderer {
                    Contender::Library(Variant::Wgsl, _) => "device",
                    Contender::Library(variant, _) | Contender::Steps(variant) => variant.isa().0,
                    Contender::Plain => "",
                },
                rate: median(&of.rates),
                spread: spread(&of.rates),
                to_plain: ratios.map(|ratios| median(&ratios.collect::<Vec<f64>>())),
                rel_mse: median(&of.errors),
                rel_mse_seconds: median(&of.costs),
                bias: median(&of.biases),
                is_off: of.is_off,
            };
            print(&row);
            row
        });
        Ok(rows.collect())
    }

    fn contenders(&self) -> Vec<Contender> {
        let has_device = self.device.is_some();
        let is_here = |v: &Variant| v.is_native() || *v == Variant::Wgsl && has_device;
        let mut contenders = vec![Contender::Plain];
        let variants = Variant::ALL.into_iter().filter(is_here);
        contenders.extend(variants.map(|v| Contender::Library(v, SampleMethod::Sobol)));
        let packets = [Variant::Packet8, Variant::Packet16].into_iter().filter(is_here);
        contenders.extend(packets.map(Contender::Steps));
        let random = |v| Contender::Library(v, SampleMethod::Random);
        contenders.extend([Variant::Scalar, Variant::widest()].map(random));
        let is_asked = |r: &Contender| {
            self.args.only.is_empty() || self.args.only.iter().any(|w| name_of(*r).contains(w))
        };
        contenders.retain(is_asked);
        contenders
    }

    fn render(
        &self,
        case: &Case,
        paths: &Paths<'_>,
        variant: Variant,
        sampling: Sampling,
    ) -> Result<Picture, Error> {
        let mut film = Film::new(self.args.size, self.args.size);
        let (samples, kernel) = (sampling.planned, &paths.whole);
        let seconds = match (variant, &self.device) {
            (Variant::Wgsl, Some(gpu)) => {
                let start = std::time::Instant::now();
                gpu.accumulate(&case.camera, kernel, &sampling, &mut film, samples)?;
                start.elapsed().as_secs_f64()
            }
            _ => {
                let scheduler = TiledScheduler::new().variant(variant);
                let mut render =
                    || scheduler.accumulate(&case.camera, kernel, &sampling, &mut film, samples);
                // The clock is that of the thread which renders.
                self.one_thread.install(|| seconds_on(1, &mut render).1)
            }
        };
        Ok(Picture { pixels: pixels_of(&film), seconds })
    }

    fn in_steps(
        &self,
        case: &Case,
        paths: &Paths<'_>,
        variant: Variant,
        sampling: Sampling,
    ) -> Picture {
        let mut film = Film::new(self.args.size, self.args.size);
        let scheduler = TiledScheduler::new().variant(variant);
        let (camera, step, samples) = (&case.camera, &paths.step, sampling.planned);
        let mut render =
            || scheduler.accumulate_steps(camera, step, |s| s.color, &sampling, &mut film, samples);
        let seconds = self.one_thread.install(|| seconds_on(1, &mut render).1);
        Picture { pixels: pixels_of(&film), seconds }
    }
}

fn name_of(renderer: Contender) -> String {
    match renderer {
        Contender::Plain => "plain Rust".to_owned(),
        Contender::Library(variant, SampleMethod::Sobol) => format!("{} sobol", variant.name()),
        Contender::Library(variant, _) => format!("{} random", variant.name()),
        Contender::Steps(variant) => format!("{} steps", variant.name()),
    }
}

fn print(row: &Row) {
    let to_plain = row.to_plain.map_or("-".to_owned(), |ratio| format!("{ratio:.2}"));
    println!(
        "{:<9}{:<18}{:<9}{:>8.3}{:>7.1}%{to_plain:>9}{:>10.2e}{:>12.3e}{:>7.2}%{}",
        row.scene,
        row.renderer,
        row.isa,
        row.rate,
        100.0 * row.spread,
        row.rel_mse,
        row.rel_mse_seconds,
        100.0 * row.bias,
        if row.is_off { "  OFF" } else { "" }
    );
}

fn pixels_of(film: &Film) -> Vec<[f32; 3]> {
    film.image().pixels().iter().map(|p| [p.x, p.y, p.z]).collect()
}

/// All channels of all pixels of a picture, and the reference's.
fn pairs<'a>(
    picture: &'a [[f32; 3]],
    reference: &'a [[f32; 3]],
) -> impl Iterator<Item = (f64, f64)> + 'a {
    let of = |pixels: &'a [[f32; 3]]| pixels.iter().flatten().map(|x| f64::from(*x));
    of(picture).zip(of(reference))
}

/// The mean of `(x - r)^2 / (r^2 + 0.01)`.
fn rel_mse(picture: &[[f32; 3]], reference: &[[f32; 3]]) -> f64 {
    let sum: f64 = pairs(picture, reference).map(|(x, r)| (x - r) * (x - r) / (r * r + 0.01)).sum();
    sum / (3 * picture.len()) as f64
}

/// The relative difference of the means, and its standard error if all pixels are independent.
fn bias(picture: &[[f32; 3]], reference: &[[f32; 3]]) -> (f64, f64) {
    let (mut sum, mut squares, mut whole) = (0.0, 0.0, 0.0);
    for (x, r) in pairs(picture, reference) {
        sum += x - r;
        squares += (x - r) * (x - r);
        whole += r;
    }
    // Channels of a pixel have the same noise.
    (sum / whole, (3.0 * squares).sqrt() / whole)
}
