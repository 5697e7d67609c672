//! The Cornell box. Learn here how surfaces become lights, and how a path tracer is given materials.
//!
//! `cargo run --release --example cornell -- --help` tells the rest.

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use clap::Parser;
use raydsl::bsdf::{Lambert, Luminous};
use raydsl::integrators::{PathLimits, path};
use raydsl::light::Lights;
use raydsl::prelude::*;
use raydsl::render::Display;
use raydsl_examples::args::{size, variant};
use raydsl_examples::cornell::{camera, lamps, walls};

/// Render the Cornell box by path tracing.
#[derive(Debug, Parser)]
#[command(about)]
struct Args {
    /// Folder of the picture, cornell.png.
    #[arg(value_name = "FOLDER", default_value = "out")]
    folder: PathBuf,
    /// Samples of each pixel.
    #[arg(long, default_value = "256")]
    samples: u32,
    /// How often light is scattered at most.
    #[arg(long, default_value = "6")]
    bounces: u32,
    /// The bounce from which on paths may end by chance; the first one is 0.
    #[arg(long, default_value = "3")]
    roulette: u32,
    /// What runs the kernel: scalar, packet4, packet8, packet16 or wgsl.
    #[arg(long, default_value = Variant::widest().name(), value_parser = variant)]
    variant: Variant,
    /// Picture size.
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = size)]
    size: (u32, u32),
}

fn main() -> Result<(), Box<dyn Error>> {
    let Args { folder, samples, bounces, roulette, variant, size: (width, height) } = Args::parse();
    std::fs::create_dir_all(&folder)?;
    // ANCHOR: cornell
    let walls = walls();
    let lamps = lamps(&walls);
    let scene = Bvh::build(&walls)?;
    let lights = Lights::new(&lamps, scene.bounds())?;
    let limits = PathLimits { bounces, roulette };
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |hit: Hit, _point: ShadingPoint| scene.primitive(hit).material();
        path::<_, _, Luminous<Lambert>>(&scene, surface, &lights, limits, ray, sampler).color
    });
    // ANCHOR_END: cornell
    let mut film = Film::new(width, height);
    let start = Instant::now();
    let (camera, sampling) = (camera(), Sampling::new(samples));
    if variant == Variant::Wgsl {
        GpuScheduler::new()?.accumulate(&camera, &kernel, &sampling, &mut film, samples)?;
    } else {
        let scheduler = TiledScheduler::new().variant(variant);
        scheduler.accumulate(&camera, &kernel, &sampling, &mut film, samples);
    }
    let seconds = start.elapsed().as_secs_f64();
    let count = f64::from(width) * f64::from(height) * f64::from(samples);
    println!("{}: {:.2} million paths a second", variant.name(), count / seconds / 1e6);
    Display::new().show(&film.image()).write_png(folder.join("cornell.png"))?;
    Ok(())
}
