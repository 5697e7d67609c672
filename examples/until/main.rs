//! A picture as good as asked for. Learn here how a film takes samples until its error is small
//! enough, who hears how far it is, and how Ctrl-C leaves the best picture so far.
//!
//! `cargo run --release --example until -- [FOLDER] [FILE] --error 1% --time 30s` writes
//! `until.png` to FOLDER (`out` if none is given), with `--adaptive` also `until_samples.png`. FILE
//! is an `.obj`, `.ply` or `.tri`; without one there is half a sponge. `--help` has the rest.

mod args;
mod sponge;
mod words;

use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{ExitCode, exit};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use args::Args;
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use raydsl::integrators::ambient_occlusion;
use raydsl::prelude::*;
use raydsl::render::{Budget, Display, Metric, ProgressObserver, Target, Until};
use raydsl_examples::heat_map::HeatMap;
use raydsl_examples::mesh;

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("until: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(&args.folder)?;
    let triangles = match &args.file {
        Some(file) => mesh::load(file)?,
        None => sponge::half(4),
    };
    let mesh = Bvh::build(&triangles)?;
    let (bounds, size) = (mesh.bounds(), (mesh.bounds().max - mesh.bounds().min).length());
    let radius = 0.3 * size;
    let eye = bounds.center() + vec3(0.66, 0.72, 0.8).normalize() * size * 1.2;
    let camera = Pinhole::new(eye, bounds.center(), Vec3::Y, 0.72);
    println!("{} triangles", triangles.len());

    // What is closed is blue, what is open nearly white. All that is shown comes from the kernel,
    // so that the error is that of the picture.
    let (paper, closed, open) =
        (vec3(0.80, 0.81, 0.84), vec3(0.02, 0.03, 0.09), vec3(1.0, 0.93, 0.8));
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let seen = ambient_occlusion::<_, 1>(&mesh, radius, ray, sampler);
        if seen.w > 0.0 { closed + (open - closed) * seen.x } else { paper }
    });

    // ANCHOR: until
    // The first Ctrl-C ends the rendering, a second one the program.
    let stop = Arc::new(AtomicBool::new(false));
    let pressed = Arc::clone(&stop);
    ctrlc::set_handler(move || {
        if pressed.swap(true, Relaxed) {
            exit(130);
        }
    })?;
    let bar = ProgressBar::new_spinner().with_style(ProgressStyle::with_template("{wide_msg}")?);
    let observer: ProgressObserver<'_> = &mut |progress| {
        bar.set_message(words::progress(progress));
        if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };

    // A pilot of 128 is plenty for a picture: its pixels have about the same variance.
    let target = Target::new(Metric::Rmse, args.error).confidence(args.confidence).pilot(128);
    let until = Until::new(target, Budget::of_time(args.time));
    let until = if args.adaptive { until.adaptive() } else { until };
    let (sampling, film) = (Sampling::new(1), &mut Film::new(args.size.0, args.size.1));
    let reached = match args.variant {
        Variant::Wgsl => {
            let gpu = GpuScheduler::new()?;
            gpu.render_until_observed(&camera, &kernel, &sampling, film, &until, observer)?
        }
        cpu => {
            let tiled = TiledScheduler::new().variant(cpu);
            tiled.render_until_observed(&camera, &kernel, &sampling, film, &until, observer)?
        }
    };
    bar.finish_and_clear();
    println!("{}", words::reached(&reached));
    if reached.samples == 0 {
        return Err("it ended before every pixel had a sample, so there is no picture".into());
    }
    let path = args.folder.join("until.png");
    Display::new().show(&film.image()).write_png(&path)?;
    // ANCHOR_END: until
    println!("{}", path.display());
    if args.adaptive {
        println!("{}", write_counts(film, &args.folder)?.display());
    }
    Ok(())
}

/// Writes where the samples went.
fn write_counts(film: &Film, folder: &Path) -> Result<PathBuf, Box<dyn Error>> {
    let path = folder.join("until_samples.png");
    let counts = film.sample_counts();
    let values = counts.pixels().iter().map(|&n| n as f32).collect();
    let (width, height) = (counts.width(), counts.height());
    HeatMap { title: "samples".to_owned(), width, height, values }.write_png(&path)?;
    Ok(path)
}
