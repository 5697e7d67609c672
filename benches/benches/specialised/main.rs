//! Kernels specialised for a scene beside a generic one, on one thread and on the device: what leaving
//! out gains in time, for the same pixels.
//!
//! A specialised kernel has the types of its scene: coloured spheres, triangles, one material, one kind
//! of lights, one integrator. The generic kernels are what a program for all scenes would have: six
//! kinds of primitives, twelve materials, seven kinds of lights with an environment, a texture, and
//! colours, occlusion or paths by a number; of volumes nine integrators by a number, and cuts. Their lists hold
//! one of every kind, which no ray meets and no light comes from, since WGSL is recorded without kinds
//! that no list holds; packets have a branch of the host for each.
//! Pixels must be the same, bit by bit, before anything is measured.

mod surfaces;
mod volumes;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;
use raydsl::gpu::Context;
use raydsl::prelude::*;
use raydsl::render::FilmArgs;
use raydsl_benches::clock::{median, seconds, spread};
use serde::Serialize;

type Error = Box<dyn std::error::Error>;

/// Measures specialised kernels beside generic ones.
#[derive(Parser)]
struct Args {
    /// Rounds; each renders every scene by both kernels, in turns.
    #[arg(long, default_value_t = 9)]
    rounds: usize,
    /// Width and height of the pictures.
    #[arg(long, default_value_t = 192)]
    size: u32,
    /// Only the scenes whose names contain this word.
    #[arg(long, default_value = "")]
    only: String,
    /// Writes the rows to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Measures WGSL on a device that is the CPU in disguise, too; it may compile for minutes.
    #[arg(long)]
    device: bool,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

#[derive(Serialize)]
struct Row {
    scene: &'static str,
    machine: &'static str,
    /// Seconds of a frame, medians of all rounds.
    specialised: f64,
    generic: f64,
    /// Generic over specialised, the median of the rounds' ratios.
    ratio: f64,
    /// The middle half of the ratios, as a share.
    spread: f64,
}

/// Measures a scene.
type Measured = fn(&Bench<'_>) -> Result<Vec<Row>, Error>;

/// What a scene is measured by.
struct Bench<'a> {
    name: &'static str,
    args: &'a Args,
    gpu: Option<&'a GpuScheduler>,
}

impl Bench<'_> {
    /// Renders by both in turns, once their pixels are compared.
    fn measure<A: FilmArgs>(
        &self,
        (camera, samples): (Pinhole, u32),
        specialised: &Kernel<'_, A, Vec4>,
        generic: &Kernel<'_, A, Vec4>,
    ) -> Result<Vec<Row>, Error> {
        let sampling = Sampling::new(samples);
        let host = SimpleScheduler::new().variant(Variant::widest());
        let render = |machine: &str, kernel: &Kernel<'_, A, Vec4>| -> Result<_, Error> {
            let mut film = Film::new(self.args.size, self.args.size);
            let taken = if let (WGSL, Some(gpu)) = (machine, self.gpu) {
                let timing = gpu.accumulate(&camera, kernel, &sampling, &mut film, samples)?;
                1e-3 * timing.device_ms.unwrap_or(timing.wall_ms)
            } else {
                seconds(|| {
                    host.accumulate(&camera, kernel, &sampling, &mut film, samples);
                })
            };
            let bits = |p: &Vec4| p.to_array().map(f32::to_bits);
            Ok((film.image().pixels().iter().map(bits).collect::<Vec<_>>(), taken))
        };
        let mut rows = Vec::new();
        for machine in [PACKETS].into_iter().chain(self.gpu.map(|_| WGSL)) {
            // The first pictures compile, too.
            let [(own, _), (other, _)] = [render(machine, specialised)?, render(machine, generic)?];
            let differ = own.iter().zip(&other).filter(|(a, b)| a != b).count();
            let seen = own.iter().filter(|pixel| **pixel != own[0]).count();
            if differ > 0 || seen < own.len() / 4 {
                return Err(format!("{}, {machine}: {differ} pixels differ", self.name).into());
            }
            let mut taken = [Vec::new(), Vec::new()];
            for round in 0..self.args.rounds {
                for turn in 0..2 {
                    let which = (round + turn) % 2;
                    taken[which].push(render(machine, [specialised, generic][which])?.1);
                }
            }
            let [own, other] = &taken;
            let ratios: Vec<f64> = own.iter().zip(other).map(|(a, b)| b / a).collect();
            let (specialised, generic) = (median(own), median(other));
            let (ratio, spread) = (median(&ratios), spread(&ratios));
            println!(
                "{:<34}{machine:<9}{specialised:>12.4}{generic:>12.4}{ratio:>8.2}{:>8.1}%",
                self.name,
                100.0 * spread
            );
            rows.push(Row { scene: self.name, machine, specialised, generic, ratio, spread });
        }
        Ok(rows)
    }
}

const PACKETS: &str = "packets";
const WGSL: &str = "WGSL";

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("specialised: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> Result<(), Error> {
    let gpu = device(args);
    println!("{} rounds; seconds of a frame", args.rounds);
    println!(
        "{:<34}{:<9}{:>12}{:>12}{:>8}{:>9}",
        "scene", "machine", "specialised", "generic", "ratio", "spread"
    );
    let scenes: [(&'static str, Measured); 5] = [
        ("coloured spheres", surfaces::points),
        ("ambient occlusion of triangles", surfaces::occlusion),
        ("diffuse paths", surfaces::diffuse_paths),
        ("a volume", volumes::volume),
        ("coated and textured triangles", surfaces::coated_paths),
    ];
    let mut rows = Vec::new();
    for (name, measured) in scenes {
        if name.contains(&args.only) {
            rows.extend(measured(&Bench { name, args, gpu: gpu.as_ref() })?);
        }
    }
    if rows.is_empty() {
        return Err(format!("no scene has a name with {:?} in it", args.only).into());
    }
    if let Some(path) = &args.json {
        std::fs::write(path, serde_json::to_string_pretty(&rows)?)?;
    }
    Ok(())
}

/// Returns the device that is asked for, and says so loudly if there is none.
fn device(args: &Args) -> Option<GpuScheduler> {
    let context = match Context::new() {
        Ok(context) => context.with_timeout(Duration::from_secs(600)),
        Err(error) => {
            println!("SKIPPED, WGSL: {error}");
            return None;
        }
    };
    let is_cpu = format!("{:?}", context.adapter_info().device_type) == "Cpu";
    if is_cpu && !args.device {
        println!("SKIPPED, WGSL: {} is the CPU; --device measures it", context.adapter_name());
        return None;
    }
    println!("WGSL on {}", context.adapter_name());
    Some(GpuScheduler::with_context(context))
}
