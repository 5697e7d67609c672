//! The Cornell box. Learn here how surfaces become lights, how a path tracer is given materials, and
//! how it is filled with fog.
//!
//! `cargo run --release --example cornell -- --help` tells the rest.

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use clap::Parser;
use raydsl::bsdf::{Lambert, Luminous};
use raydsl::integrators::{PathLimits, PathOptions, path, volume_path};
use raydsl::light::Lights;
use raydsl::prelude::*;
use raydsl::render::Display;
use raydsl::volume::Fog;
use raydsl_examples::args::{size, variant};
use raydsl_examples::cornell::{camera, lamps, walls};
use raydsl_examples::everything::beside_all_surfaces;

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
    /// Fill the box with fog of this mean free path in millimetres, which absorbs nothing.
    #[arg(long, value_name = "LENGTH", value_parser = free_path)]
    fog: Option<f32>,
    /// Only say how large the kernel's program is, beside one with all features.
    #[arg(long)]
    explain: bool,
    /// What runs the kernel: scalar, packet4, packet8, packet16 or wgsl.
    #[arg(long, default_value = Variant::widest().name(), value_parser = variant)]
    variant: Variant,
    /// Picture size.
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = size)]
    size: (u32, u32),
}

fn free_path(text: &str) -> Result<f32, String> {
    let length = text.parse::<f32>().ok().filter(|length| *length > 0.0);
    length.ok_or_else(|| "a length above 0".to_owned())
}

fn main() -> Result<(), Box<dyn Error>> {
    let args = Args::parse();
    std::fs::create_dir_all(&args.folder)?;
    // ANCHOR: cornell
    let walls = walls();
    let lamps = lamps(&walls);
    let scene = Bvh::build(&walls)?;
    let lights = Lights::new(&lamps, scene.bounds())?;
    let limits = PathLimits { bounces: args.bounces, roulette: args.roulette };
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |hit: Hit, _point: ShadingPoint| scene.primitive(hit).material();
        path::<_, _, Luminous<Lambert>>(&scene, surface, &lights, limits, ray, sampler).color
    });
    // ANCHOR_END: cornell
    let Some(free_path) = args.fog else { return render(&args, &kernel) };
    // ANCHOR: fog
    let fog = Fog { extinction: 1.0 / free_path, albedo: Vec3::ONE, anisotropy: 0.0 };
    let options = PathOptions::new();
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        // The camera is in front of the open side, in clear air.
        let enter = (0.0 - ray.origin.z) / ray.direction.z;
        let ray = Ray { origin: ray.at(enter), ..ray };
        volume_path::<_, _, Luminous<Lambert>>(
            &scene,
            |hit: Hit, _point: ShadingPoint| scene.primitive(hit).material(),
            |ray: Ray, rng: Rng| {
                let mut rng = rng;
                fog.collision(in_box(ray), &mut rng)
            },
            |ray: Ray, _rng: Rng| fog.transmittance(in_box(ray)),
            &lights,
            host(options),
            limits,
            ray,
            sampler,
        )
        .color
    });
    render(&args, &kernel)
}

/// Returns the part of a ray from within the box that is not in front of its open side.
#[raydsl::kernel]
fn in_box(ray: Ray) -> Ray {
    let leave = -ray.origin.z / min(ray.direction.z, -1e-6);
    ray.with_range(ray.t_min, if ray.direction.z < 0.0 { min(leave, ray.t_max) } else { ray.t_max })
}
// ANCHOR_END: fog

fn render(args: &Args, kernel: &Kernel<'_, (Ray, Sampler), Vec4>) -> Result<(), Box<dyn Error>> {
    let &Args { samples, variant, size: (width, height), .. } = args;
    let (camera, sampling) = (camera(), Sampling::new(samples));
    if args.explain {
        let features = "triangles, closest and any hit, Lambert, lamps of triangles, paths with \
                        roulette, Sobol samples, a camera";
        let recording = kernel.record_pass(&camera, &sampling, (width, height));
        println!("{}", beside_all_surfaces("cornell", features, recording)?);
        return Ok(());
    }
    let mut film = Film::new(width, height);
    let start = Instant::now();
    if variant == Variant::Wgsl {
        GpuScheduler::new()?.accumulate(&camera, kernel, &sampling, &mut film, samples)?;
    } else {
        let scheduler = TiledScheduler::new().variant(variant);
        scheduler.accumulate(&camera, kernel, &sampling, &mut film, samples);
    }
    let seconds = start.elapsed().as_secs_f64();
    let count = f64::from(width) * f64::from(height) * f64::from(samples);
    println!("{}: {:.2} million paths a second", variant.name(), count / seconds / 1e6);
    Display::new().show(&film.image()).write_png(args.folder.join("cornell.png"))?;
    Ok(())
}
