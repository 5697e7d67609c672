//! Primary rays, one thread: every variant of the CPU against plain scalar Rust.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use raydsl::camera::Camera;
use raydsl::prelude::*;
use raydsl_benches::clock::{median, seconds, spread};
use raydsl_benches::guard;
use raydsl_benches::hand::{self, ByHand};
use raydsl_benches::scenes::{self, Scene};
use serde::Serialize;

/// Measures packets against scalar code on primary rays.
#[derive(Parser)]
struct Args {
    /// Writes the rows to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Only the scenes whose names contain one of these words.
    #[arg(long)]
    scene: Vec<String>,
    /// Size of the film.
    #[arg(long, default_value = "1280x800", value_parser = parse_size)]
    size: (u32, u32),
    /// Points of the scan.
    #[arg(long, default_value_t = 2_000_000)]
    points: usize,
    /// Rounds; each measures every variant once.
    #[arg(long, default_value_t = 7)]
    rounds: usize,
    /// Threads; the figures are for one.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=1))]
    threads: u8,
    /// Only measures this row, for a profiler.
    #[arg(long)]
    only: Option<String>,
    /// Measures nothing: inspects the machine code of this program instead.
    #[arg(long)]
    guard: bool,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let (w, h) = text.split_once('x').ok_or("write WIDTHxHEIGHT")?;
    let side = |s: &str| s.parse::<u32>().ok().filter(|n| (1..=16384).contains(n));
    side(w).zip(side(h)).ok_or_else(|| "sides are 1 to 16384".to_owned())
}

#[derive(Serialize)]
struct Row {
    scene: &'static str,
    variant: &'static str,
    isa: &'static str,
    lanes: usize,
    mrays_per_s: f64,
    /// Against scalar; nothing for a row whose hits differ from the scalar ones.
    speedup: Option<f64>,
    spread: f64,
}

/// Renders a frame.
type Render<'a> = Box<dyn FnMut(&mut Image<Hit>) + 'a>;

/// A contender: its name, and how it renders the hits of a frame.
struct Entry<'a> {
    variant: &'static str,
    isa: &'static str,
    lanes: usize,
    render: Render<'a>,
}

fn main() -> ExitCode {
    let args = Args::parse();
    if args.guard {
        ask_a_wide_tree();
        return guard::run();
    }
    let mut rows = Vec::new();
    if wanted(&args, "colonnade") {
        rows.extend(measure(&args, "colonnade", &scenes::colonnade()));
    }
    match std::env::var_os("RAYDSL_DATA") {
        Some(data) if wanted(&args, "sibenik") => match scenes::sibenik(data.as_ref()) {
            Ok(scene) => rows.extend(measure(&args, "sibenik", &scene)),
            Err(error) => eprintln!("skipped sibenik: {error}"),
        },
        Some(_) => {}
        None => eprintln!("skipped sibenik: RAYDSL_DATA does not name its folder"),
    }
    if wanted(&args, "scan") {
        rows.extend(measure(&args, "scan", &scenes::scan(args.points)));
    }
    if let Some(path) = &args.json {
        let text = serde_json::to_string_pretty(&rows).expect("rows are plain data");
        if let Err(error) = std::fs::write(path, text) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        }
    }
    let void = rows.iter().any(|r| r.speedup.is_none());
    if void { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Asks one, so that this program has the walks through wide trees, which the guard inspects.
fn ask_a_wide_tree() {
    let scene = scenes::colonnade();
    let bvh = Bvh::build_wide(&scene.prims, &[], &BuildConfig::default());
    let bvh = bvh.expect("the scene has finite bounds");
    let ray = |i: u32| scene.camera.begin_frame(64, 64).primary_ray(i as f32 + 0.5, 32.5);
    let rays: Vec<Ray> = (0..64).map(ray).collect();
    let hits = bvh.closest_hits(&rays).iter().filter(|hit| hit.is_hit).count();
    let stopped = bvh.any_hits(&rays).iter().filter(|is_hit| **is_hit).count();
    let single = rays.iter().filter(|ray| bvh.closest_hit(**ray).is_hit).count();
    assert!(hits == stopped && hits == single, "{hits}, {stopped} and {single} rays hit something");
}

fn wanted(args: &Args, scene: &str) -> bool {
    args.scene.is_empty() || args.scene.iter().any(|word| scene.contains(word.as_str()))
}

fn measure<P: ByHand>(args: &Args, name: &'static str, scene: &Scene<P>) -> Vec<Row> {
    let bvh = Bvh::build(&scene.prims).expect("the scene has finite bounds");
    println!("{name}: {} primitives, {} x {}", scene.prims.len(), args.size.0, args.size.1);
    let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
    let mut entries = entries(&bvh, &scene.camera, &kernel);
    if let Some(only) = &args.only {
        entries.retain(|e| e.variant == only);
    }
    let rows = compare_entries(args, name, &mut entries);
    print_rows(&rows);
    rows
}

/// Every contender; the first one is what the others are compared with.
fn entries<'a, P: ByHand>(
    bvh: &'a Bvh<'a, P>,
    camera: &'a Pinhole,
    kernel: &'a Kernel<'a, (Ray,), Hit>,
) -> Vec<Entry<'a>> {
    let variants = [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16];
    let mut entries: Vec<Entry<'a>> = variants
        .into_iter()
        .map(|v| {
            let (isa, lanes) = v.isa();
            let scheduler = SimpleScheduler::new().variant(v);
            let render = Box::new(move |image: &mut Image<Hit>| {
                scheduler.frame(camera, kernel, image);
            });
            Entry { variant: v.name(), isa, lanes, render }
        })
        .collect();
    let render = Box::new(|image: &mut Image<Hit>| frame_by_hand(bvh, camera, image));
    entries.push(Entry { variant: "hand-written", isa: "scalar", lanes: 1, render });
    entries
}

fn frame_by_hand<P: ByHand>(bvh: &Bvh<'_, P>, camera: &Pinhole, image: &mut Image<Hit>) {
    let (width, height) = (image.width(), image.height());
    let rays = camera.begin_frame(width, height);
    for (row, y) in image.pixels_mut().chunks_mut(width as usize).zip(0u16..) {
        for (pixel, x) in row.iter_mut().zip(0u16..) {
            let ray = rays.primary_ray(f32::from(x) + 0.5, f32::from(y) + 0.5);
            *pixel = hand::closest_hit(bvh, &ray);
        }
    }
}

/// Interleaved rounds: what the machine does meanwhile touches all contenders alike.
fn compare_entries(args: &Args, scene: &'static str, entries: &mut [Entry<'_>]) -> Vec<Row> {
    let blank = Image::filled(args.size.0, args.size.1, Hit::miss());
    let mut images: Vec<Image<Hit>> = vec![blank; entries.len()];
    let mut times = vec![Vec::new(); entries.len()];
    // The first round warms up.
    for round in 0..=args.rounds {
        for (i, entry) in entries.iter_mut().enumerate() {
            let time = seconds(|| (entry.render)(&mut images[i]));
            if round > 0 {
                times[i].push(time);
            }
        }
    }
    let rays = f64::from(args.size.0) * f64::from(args.size.1);
    let row = |i: usize| {
        let Entry { variant, isa, lanes, .. } = entries[i];
        let rates: Vec<f64> = times[i].iter().map(|t| rays / t * 1e-6).collect();
        let ratios: Vec<f64> = times[0].iter().zip(&times[i]).map(|(a, b)| a / b).collect();
        let same = images[i] == images[0];
        let speedup = same.then(|| median(&ratios));
        Row {
            scene,
            variant,
            isa,
            lanes,
            mrays_per_s: median(&rates),
            speedup,
            spread: spread(&ratios).max(spread(&rates)),
        }
    };
    (0..entries.len()).map(row).collect()
}

fn print_rows(rows: &[Row]) {
    println!(
        "{:<13}{:<9}{:>6}{:>10}{:>10}{:>9}",
        "variant", "isa", "lanes", "Mrays/s", "speedup", "spread"
    );
    for r in rows {
        let speedup = r.speedup.map_or("void".to_owned(), |s| format!("{s:.2}x"));
        println!(
            "{:<13}{:<9}{:>6}{:>10.2}{:>10}{:>8.1}%",
            r.variant,
            r.isa,
            r.lanes,
            r.mrays_per_s,
            speedup,
            100.0 * r.spread
        );
    }
    println!();
}
