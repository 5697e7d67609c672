//! Kernels whose rays part ways, one thread: what packets gain over plain scalar Rust, and what the
//! branch policy gains over a test before every arm.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use raydsl::machine::KernelFn;
use raydsl::prelude::*;
use raydsl_benches::clock::{median, seconds, spread};
use raydsl_benches::divergent::{self, spheres};
use serde::Serialize;

/// Measures divergent kernels.
#[derive(Parser)]
struct Args {
    /// Writes the rows to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Only the kernels whose names contain one of these words.
    #[arg(long)]
    kernel: Vec<String>,
    /// How many inputs.
    #[arg(long, default_value_t = 100_000)]
    count: usize,
    /// Rounds; each measures every variant once.
    #[arg(long, default_value_t = 9)]
    rounds: usize,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

#[derive(Serialize)]
struct Row {
    kernel: &'static str,
    variant: &'static str,
    isa: &'static str,
    /// Million inputs a second.
    rate: f64,
    /// Against scalar.
    speedup: f64,
    /// Against the same variant with a test before every arm.
    policy: Option<f64>,
    spread: f64,
}

const PACKETS: [Variant; 3] = [Variant::Packet4, Variant::Packet8, Variant::Packet16];

/// Random numbers in [0, 1) (PCG, O'Neill 2014).
fn random(state: &mut u32) -> f32 {
    *state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((*state >> ((*state >> 28) + 4)) ^ *state).wrapping_mul(277_803_737);
    ((word >> 22 ^ word) >> 8) as f32 / 16_777_216.0
}

fn main() -> ExitCode {
    let args = Args::parse();
    let mut rows = Vec::new();
    println!(
        "{:<16}{:<10}{:<9}{:>10}{:>10}{:>10}{:>9}",
        "kernel", "variant", "isa", "M/s", "speedup", "policy", "spread"
    );
    macro_rules! measure {
        ($($name:ident $tested:ident),+) => {
            $(rows.extend(divergent_rows::<divergent::$name, divergent::$tested>(
                &args, stringify!($name),
            ));)+
        };
    }
    measure!(
        mandelbrot mandelbrot_tested, collatz collatz_tested, march march_tested,
        walk walk_tested, curves curves_tested, glass glass_tested
    );
    rows.extend(sphere_rows(&args));
    if let Some(path) = &args.json {
        let text = serde_json::to_string_pretty(&rows).expect("rows are plain data");
        if let Err(error) = std::fs::write(path, text) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn is_wanted(args: &Args, kernel: &str) -> bool {
    args.kernel.is_empty() || args.kernel.iter().any(|word| kernel.contains(word.as_str()))
}

fn divergent_rows<F, T>(args: &Args, name: &'static str) -> Vec<Row>
where
    F: KernelFn<Args = (f32, f32, u32), Output = f32>,
    T: KernelFn<Args = (f32, f32, u32), Output = f32>,
{
    if !is_wanted(args, name) {
        return Vec::new();
    }
    let mut state = 1;
    let inputs: Vec<_> = (0..args.count)
        .map(|_| {
            let mut number = || random(&mut state);
            (2.0 * number() - 1.0, 2.0 * number() - 1.0, (number() * 1e9) as u32)
        })
        .collect();
    rows(args, name, &Kernel::of::<F>(), Some(&Kernel::of::<T>()), &inputs)
}

fn sphere_rows(args: &Args) -> Vec<Row> {
    let mut state = 7;
    let mut number = || random(&mut state);
    let balls: Vec<spheres::Ball> = (0..64)
        .map(|_| spheres::Ball {
            center: vec3(number(), number(), number()) * 8.0 - 4.0,
            radius: 0.1 + 0.3 * number(),
        })
        .collect();
    let inputs: Vec<(Vec3, Vec3, u32)> = (0..args.count)
        .map(|_| {
            let mut vector = || vec3(number(), number(), number()) * 2.0 - 1.0;
            let o = vector().normalize() * 8.0;
            let aim = vector();
            // Every ray meets a ball, so that all of them shade.
            let ball = balls[(number() * 63.99) as usize];
            let target = ball.center + aim * (0.5 * ball.radius);
            (o, (target - o).normalize(), (number() * 1e9) as u32)
        })
        .collect();
    let balls = &balls[..];
    let mut all = Vec::new();
    if is_wanted(args, "spheres") {
        let kernel = kernel!(|o: Vec3, d: Vec3, seed: u32| {
            let hit = spheres::closest(balls, o, d);
            hit.t + (hit.id ^ seed) as f32
        });
        all.extend(rows(args, "spheres", &kernel, None, &inputs));
    }
    if is_wanted(args, "spheres_ao") {
        let kernel = kernel!(|o: Vec3, d: Vec3, seed: u32| spheres::occluded(balls, o, d, seed));
        all.extend(rows(args, "spheres_ao", &kernel, None, &inputs));
    }
    all
}

/// One kernel on every variant, interleaved: what the machine does meanwhile touches all alike.
fn rows<A: Type>(
    args: &Args,
    name: &'static str,
    kernel: &Kernel<'_, A, f32>,
    tested: Option<&Kernel<'_, A, f32>>,
    inputs: &[A],
) -> Vec<Row> {
    let mut expected = vec![0.0f32; inputs.len()];
    let mut found = expected.clone();
    let mut scalar = Vec::new();
    let mut times = [const { Vec::new() }; 3];
    let mut tested_times = [const { Vec::new() }; 3];
    // The first round warms up.
    for round in 0..=args.rounds {
        let time = seconds(|| kernel.run(Variant::Scalar, inputs, &mut expected));
        if round > 0 {
            scalar.push(time);
        }
        for (i, variant) in PACKETS.into_iter().enumerate() {
            let mut one = |kernel: &Kernel<'_, A, f32>, times: &mut Vec<f64>| {
                let time = seconds(|| kernel.run(variant, inputs, &mut found));
                assert_eq!(found, expected, "{name} on {} differs", variant.name());
                if round > 0 {
                    times.push(time);
                }
            };
            one(kernel, &mut times[i]);
            if let Some(tested) = tested {
                one(tested, &mut tested_times[i]);
            }
        }
    }
    let rate = |times: &[f64]| inputs.len() as f64 / median(times) * 1e-6;
    let ratios = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a / b).collect::<Vec<f64>>();
    let mut all = vec![Row {
        kernel: name,
        variant: "scalar",
        isa: "scalar",
        rate: rate(&scalar),
        speedup: 1.0,
        policy: None,
        spread: spread(&scalar),
    }];
    for (i, variant) in PACKETS.into_iter().enumerate() {
        let speedups = ratios(&scalar, &times[i]);
        let policy = tested.map(|_| median(&ratios(&tested_times[i], &times[i])));
        all.push(Row {
            kernel: name,
            variant: variant.name(),
            isa: variant.isa().0,
            rate: rate(&times[i]),
            speedup: median(&speedups),
            policy,
            spread: spread(&speedups),
        });
    }
    for r in &all {
        let policy = r.policy.map_or(String::new(), |p| format!("{p:.2}x"));
        println!(
            "{:<16}{:<10}{:<9}{:>10.2}{:>9.2}x{:>10}{:>8.1}%",
            r.kernel,
            r.variant,
            r.isa,
            r.rate,
            r.speedup,
            policy,
            r.spread * 100.0
        );
    }
    all
}
