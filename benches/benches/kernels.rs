//! Parts of renderers, one thread: fetches of textures, ambient occlusion, numbers of samplers;
//! every variant against plain scalar Rust. WGSL runs where there is a device, whose own threads it
//! has; its time is that of the whole call, with what comes back.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use raydsl::integrators::ambient_occlusion;
use raydsl::prelude::*;
use raydsl::texture::Filter;
use raydsl_benches::clock::{median, quantile, seconds};
use raydsl_benches::scenes;
use serde::Serialize;

/// Measures textures, ambient occlusion and samplers.
#[derive(Parser)]
struct Args {
    /// Writes the rows to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Only the cases whose names contain one of these words.
    #[arg(long)]
    case: Vec<String>,
    /// Rays that march through textures, and samplers.
    #[arg(long, default_value_t = 20_000)]
    count: u32,
    /// Rounds; each measures every variant once.
    #[arg(long, default_value_t = 9)]
    rounds: usize,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

#[derive(Serialize)]
struct Row {
    case: String,
    /// What is counted.
    unit: &'static str,
    variant: &'static str,
    isa: &'static str,
    /// Millions of them a second, the median of all rounds.
    rate: f64,
    /// Against scalar, the median of all rounds.
    speedup: f64,
    /// The middle half of these.
    low: f64,
    high: f64,
}

const FILTERS: [(&str, Filter); 4] = [
    ("nearest", Filter::Nearest),
    ("linear", Filter::Linear),
    ("b-spline", Filter::BSpline),
    ("catmull-rom", Filter::CatmullRom),
];
const METHODS: [(&str, SampleMethod); 3] = [
    ("random", SampleMethod::Random),
    ("stratified", SampleMethod::Stratified),
    ("sobol", SampleMethod::Sobol),
];
/// Fetches of a ray that marches, and numbers that a sampler is asked for.
const STEPS: u32 = 32;

/// What is measured, and on what.
struct Bench {
    args: Args,
    device: Option<GpuScheduler>,
}

fn main() -> ExitCode {
    let args = Args::parse();
    let device = GpuScheduler::new();
    match &device {
        Ok(gpu) => println!("WGSL on {}", gpu.context().adapter_name()),
        Err(error) => println!("no WGSL: {error}"),
    }
    let bench = Bench { args, device: device.ok() };
    println!(
        "{:<20}{:<9}{:<9}{:>10} {:<12}{:>8}{:>16}",
        "case", "variant", "isa", "M/s", "", "speedup", "middle half"
    );
    let mut rows = textures(&bench);
    rows.extend(volumes(&bench));
    rows.extend(occlusion(&bench));
    rows.extend(samplers(&bench));
    if let Some(path) = &bench.args.json {
        let text = serde_json::to_string_pretty(&rows).expect("rows are plain data");
        if let Err(error) = std::fs::write(path, text) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

/// Interleaved rounds of one case: what the machine does meanwhile touches all variants alike.
/// `run` gives what must be the same for all variants of the CPU.
fn measure<R: PartialEq>(
    Bench { args, device }: &Bench,
    case: String,
    (unit, count): (&'static str, f64),
    mut run: impl FnMut(Variant) -> R,
) -> Vec<Row> {
    if !args.case.is_empty() && !args.case.iter().any(|word| case.contains(word.as_str())) {
        return Vec::new();
    }
    let has_device = device.is_some();
    let variants = Variant::ALL.into_iter().filter(|v| *v != Variant::Wgsl || has_device);
    let variants: Vec<Variant> = variants.collect();
    let mut times = vec![Vec::new(); variants.len()];
    // The first round warms up.
    for round in 0..=args.rounds {
        let mut expected = None;
        for (&variant, times) in variants.iter().zip(&mut times) {
            let mut result = None;
            let time = seconds(|| result = Some(run(variant)));
            if round > 0 {
                times.push(time);
            }
            let is_same = variant == Variant::Wgsl || expected.is_none() || expected == result;
            assert!(is_same, "{case} on {} differs", variant.name());
            expected = expected.or(result);
        }
    }
    let row = |(variant, of_variant): (Variant, &Vec<f64>)| {
        let ratios: Vec<f64> = times[0].iter().zip(of_variant).map(|(a, b)| a / b).collect();
        Row {
            case: case.clone(),
            unit,
            variant: variant.name(),
            isa: if variant == Variant::Wgsl { "device" } else { variant.isa().0 },
            rate: count / median(of_variant) * 1e-6,
            speedup: median(&ratios),
            low: quantile(&ratios, 0.25),
            high: quantile(&ratios, 0.75),
        }
    };
    let rows: Vec<Row> = variants.into_iter().zip(&times).map(row).collect();
    for Row { case, unit, variant, isa, rate, speedup, low, high } in &rows {
        print!("{case:<20}{variant:<9}{isa:<9}{rate:>10.1} {unit:<12}");
        println!("{speedup:>7.2}x{low:>8.2} -{high:>6.2}");
    }
    rows
}

/// Where rays begin and how far they go with each step: neighbours begin and go nearly alike, as
/// those of a camera do.
fn marches(count: u32) -> Vec<(Vec3, Vec3)> {
    let side = f64::from(count).sqrt().ceil() as u32;
    let march = |i: u32| {
        let (x, y) = ((i % side) as f32 / side as f32, (i / side) as f32 / side as f32);
        (vec3(x, y, 0.0), vec3(0.2 * y - 0.1, 0.1 - 0.2 * x, 1.0) / STEPS as f32)
    };
    (0..count).map(march).collect()
}

fn run<A: Type, R: Type + Default>(
    bench: &Bench,
    kernel: &Kernel<'_, A, R>,
    variant: Variant,
    inputs: &[A],
) -> Vec<R> {
    let mut outputs = vec![R::default(); inputs.len()];
    match (variant, &bench.device) {
        (Variant::Wgsl, Some(gpu)) => {
            gpu.batch(kernel, inputs, &mut outputs).expect("the device is not lost");
        }
        _ => kernel.run(variant, inputs, &mut outputs),
    }
    outputs
}

/// 512 by 512 texels of four bytes.
fn textures(bench: &Bench) -> Vec<Row> {
    let texel = |i: u32| [i, i >> 3, i >> 9, i >> 5].map(|n| Unorm8::from_bits(n as u8));
    let texels: Vec<[Unorm8; 4]> = (0..512 * 512).map(texel).collect();
    let inputs = marches(bench.args.count);
    let mut rows = Vec::new();
    for (name, filter) in FILTERS {
        let config = TextureConfig::new().filter(filter);
        let texture = Texture2::new(&texels[..], [512, 512], config).expect("the sizes fit");
        let kernel = kernel!(|start: Vec3, step: Vec3| {
            let mut sum = Vec4::ZERO;
            let mut at = vec2(start.x, start.y);
            for _i in 0..STEPS {
                sum += tex2(&texture, at);
                at += vec2(step.x, step.y + step.z * 0.3);
            }
            sum
        });
        let fetches = ("fetches", f64::from(bench.args.count) * f64::from(STEPS));
        rows.extend(measure(bench, format!("2-D {name}"), fetches, |v| {
            run(bench, &kernel, v, &inputs)
        }));
    }
    rows
}

/// 128³ texels of one byte.
fn volumes(bench: &Bench) -> Vec<Row> {
    let texel = |i: u32| Unorm8::from_bits((i ^ i >> 7 ^ i >> 13) as u8);
    let texels: Vec<Unorm8> = (0..1 << 21).map(texel).collect();
    let inputs = marches(bench.args.count);
    let mut rows = Vec::new();
    for (name, filter) in FILTERS {
        let config = TextureConfig::new().filter(filter);
        let texture = Texture3::new(&texels[..], [128; 3], config).expect("the sizes fit");
        let kernel = kernel!(|start: Vec3, step: Vec3| {
            let mut sum: f32 = 0.0;
            let mut at = start;
            for _i in 0..STEPS {
                sum += tex3(&texture, at);
                at += step;
            }
            sum
        });
        let fetches = ("fetches", f64::from(bench.args.count) * f64::from(STEPS));
        rows.extend(measure(bench, format!("3-D {name}"), fetches, |v| {
            run(bench, &kernel, v, &inputs)
        }));
    }
    rows
}

/// Four samples of each pixel of a hall, as the scheduler makes them.
fn occlusion(bench: &Bench) -> Vec<Row> {
    const SAMPLES: u32 = 4;
    let (width, height) = (320, 200);
    let hall = scenes::colonnade();
    let scene = Bvh::build(&hall.prims).expect("the scene has finite bounds");
    let mut rows = Vec::new();
    for (name, radius) in [("near", 1.0), ("far", 100.0)] {
        let kernel = kernel!(|ray: Ray, sampler: Sampler| {
            ambient_occlusion::<_, 1>(&scene, radius, ray, sampler)
        });
        let render = |variant: Variant| {
            let (mut film, sampling) = (Film::new(width, height), Sampling::new(SAMPLES));
            match (variant, &bench.device) {
                (Variant::Wgsl, Some(gpu)) => {
                    gpu.accumulate(&hall.camera, &kernel, &sampling, &mut film, SAMPLES)
                        .expect("the device is not lost");
                }
                _ => SimpleScheduler::new().variant(variant).accumulate(
                    &hall.camera,
                    &kernel,
                    &sampling,
                    &mut film,
                    SAMPLES,
                ),
            }
            film
        };
        // One ray to the surface, and one from it.
        let hits: f32 = render(Variant::widest()).image().pixels().iter().map(|p| 1.0 + p.w).sum();
        let rays = ("rays", f64::from(hits) * f64::from(SAMPLES));
        rows.extend(measure(bench, format!("occlusion {name}"), rays, render));
    }
    rows
}

/// Points of the unit square, `STEPS` of each sampler.
fn samplers(bench: &Bench) -> Vec<Row> {
    let inputs: Vec<(u32, u32)> = (0..bench.args.count).map(|i| (i / 64, i % 64)).collect();
    let mut rows = Vec::new();
    for (name, method) in METHODS {
        let kernel = kernel!(|pixel: u32, sample: u32| {
            let mut sampler = Sampler::new(uvec2(pixel & 511, pixel >> 9), 0, sample, 64, method);
            let mut sum = Vec2::ZERO;
            for _i in 0..STEPS {
                sum += sampler.next_2d();
            }
            sum
        });
        let points = ("points", f64::from(bench.args.count) * f64::from(STEPS));
        rows.extend(measure(bench, format!("sampler {name}"), points, |v| {
            run(bench, &kernel, v, &inputs)
        }));
    }
    rows
}
