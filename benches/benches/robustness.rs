//! Rays at what is hard: all campaigns in full, and the tables of the book's chapter about them.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use raydsl::bvh::BuildError;
use raydsl::camera::Camera;
use raydsl::prelude::*;
use raydsl_benches::clock::{median, seconds, spread};
use raydsl_benches::scenes;
use raydsl_benches::visits::visits;
use raydsl_tests::campaigns::{Tally, bounces, grouped, slabs, watertight};
use raydsl_tests::rng::Rng;

/// Rays of a campaign on the CPU.
const RAYS: f64 = 1e8;
/// Bounces, of triangles and of spheres each.
const BOUNCES: f64 = 1e7;
/// Rays of a campaign in WGSL.
const RAYS_OF_WGSL: f64 = 1e6;
/// Rays of a scene whose nodes are counted, of each kind.
const COUNTED: usize = 100_000;
/// Rays of a batch that is timed.
const TIMED: usize = 1 << 16;
const ROUNDS: usize = 9;

/// Loses rays, if it can.
#[derive(Parser)]
struct Args {
    /// The share of the rays: 1 is 1e8 rays a row, 1e7 bounces, 1e6 rays in WGSL.
    #[arg(long, default_value_t = 0.01)]
    share: f64,
    /// Writes the tables to this file.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Only the tables whose names contain one of these words.
    #[arg(long)]
    only: Vec<String>,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

impl Args {
    fn count(&self, full: f64) -> usize {
        (full * self.share) as usize
    }

    fn wants(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|word| name.contains(word.as_str()))
    }
}

fn main() -> ExitCode {
    let args = Args::parse();
    match run(&args) {
        Ok((text, lost)) => {
            if let Some(path) = &args.out
                && let Err(error) = std::fs::write(path, text)
            {
                eprintln!("{}: {error}", path.display());
                return ExitCode::FAILURE;
            }
            if lost == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// A table, and how many rays were lost.
type Table = Result<(String, u64), BuildError>;

/// How a table is made.
type Make = fn(&Args) -> Table;

fn run(args: &Args) -> Table {
    let tables: [(&str, Make); 5] = [
        ("watertight", watertight_table),
        ("slabs", slab_table),
        ("bounces", bounce_table),
        ("visits", visit_table),
        ("broken", broken_table),
    ];
    let (mut text, mut lost) = (String::new(), 0);
    for (name, table) in tables.into_iter().filter(|(name, _)| args.wants(name)) {
        let start = std::time::Instant::now();
        let (table, of_table) = table(args)?;
        println!("{name}, {:.0} s\n\n{table}", start.elapsed().as_secs_f64());
        let _ = writeln!(text, "<!-- ANCHOR: {name} -->\n{table}<!-- ANCHOR_END: {name} -->\n");
        lost += of_table;
    }
    Ok((text, lost))
}

fn tallies(head: &str, beside: &str, tallies: &[Tally]) -> (String, u64) {
    let mut text = format!(
        "| {head} | rays | scalar | x4 | x8 | x16 | WGSL | {beside} |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|\n"
    );
    for tally in tallies {
        let _ = writeln!(text, "{}", tally.row());
        if let Some(first) = &tally.first {
            eprintln!("{}: {first}", tally.name);
        }
    }
    (text, tallies.iter().map(Tally::lost).sum())
}

fn watertight_table(args: &Args) -> Table {
    let found = watertight::campaign(args.count(RAYS), args.count(RAYS_OF_WGSL))?;
    Ok(tallies("closed mesh of 320 triangles", "Möller and Trumbore", &found))
}

fn slab_table(args: &Args) -> Table {
    let found: Result<Vec<Tally>, BuildError> = slabs::ROWS
        .iter()
        .map(|row| slabs::campaign(row, args.count(RAYS), args.count(RAYS_OF_WGSL)))
        .collect();
    Ok(tallies("boxes", "IEEE alone", &found?))
}

fn bounce_table(args: &Args) -> Table {
    let wgsl = args.count(RAYS_OF_WGSL);
    let mut found = bounces::on_triangles(args.count(BOUNCES), wgsl, 1.0)?;
    found.extend(bounces::on_spheres(args.count(BOUNCES), wgsl, 1.0)?);
    let mut bare = bounces::on_triangles(args.count(BOUNCES / 100.0), 0, 0.0)?;
    bare.extend(bounces::on_spheres(args.count(BOUNCES / 100.0), 0, 0.0)?);
    for (tally, bare) in found.iter_mut().zip(bare) {
        tally.others.extend(bare.asked.into_iter().take(1));
    }
    Ok(tallies("surface", "not moved", &found))
}

/// Rays from the camera, and rays that leave what those hit.
fn rays_of<P: Primitive<Hit = Hit, Shared = ()>>(
    bvh: &Bvh<'_, P>,
    camera: &Pinhole,
) -> (Vec<Ray>, Vec<Ray>) {
    let film = camera.begin_frame(1280, 800);
    let mut rng = Rng::of("visits");
    let primary: Vec<Ray> =
        (0..COUNTED).map(|_| film.primary_ray(1280.0 * rng.unit(), 800.0 * rng.unit())).collect();
    let leaves = |ray: &Ray| {
        let hit = bvh.closest_hit(*ray);
        hit.is_hit.then(|| Ray::new(ray.at(hit.t * 0.999), rng.direction()))
    };
    let bounced = primary.iter().filter_map(leaves).collect();
    (primary, bounced)
}

fn visits_of<P: Primitive<Hit = Hit, Shared = ()>>(
    name: &str,
    scene: &scenes::Scene<P>,
) -> Result<String, BuildError> {
    let bvh = Bvh::build(&scene.prims)?;
    let (primary, bounced) = rays_of(&bvh, &scene.camera);
    let mut text = String::new();
    for (kind, rays) in [("primary", primary), ("bounced", bounced)] {
        let (robust, plain) = visits(&bvh, &rays);
        let (robust, plain) = (robust as f64, plain as f64);
        let of = |nodes: f64| nodes / rays.len() as f64;
        let more = 100.0 * (robust / plain - 1.0);
        let _ = writeln!(
            text,
            "| {name}, {kind} | {:.2} | {:.2} | {more:+.2} % |",
            of(robust),
            of(plain)
        );
    }
    Ok(text)
}

fn visit_table(_: &Args) -> Table {
    let mut text = String::from("| rays | nodes a ray | IEEE alone | more |\n|---|--:|--:|--:|\n");
    text += &visits_of("colonnade", &scenes::colonnade())?;
    text += &visits_of("scan", &scenes::scan(500_000))?;
    match std::env::var_os("RAYDSL_DATA") {
        Some(data) => {
            for name in scenes::FILES {
                match scenes::file(data.as_ref(), name) {
                    Ok(scene) => text += &visits_of(name, &scene)?,
                    Err(error) => eprintln!("skipped {name}: {error}"),
                }
            }
        }
        None => eprintln!("skipped the scenes of RAYDSL_DATA, which names no folder"),
    }
    Ok((text, 0))
}

/// Every second ray is none: a NaN or an infinity in one of its components.
fn half_broken(rays: &[(Ray,)]) -> Vec<(Ray,)> {
    let mut rng = Rng::of("broken");
    let mut rays = rays.to_vec();
    for (ray,) in rays.iter_mut().step_by(2) {
        let bad = rng.pick(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
        let part = if rng.below(2) == 0 { &mut ray.origin } else { &mut ray.direction };
        part[rng.below(3)] = bad;
    }
    rays
}

fn broken_table(_: &Args) -> Table {
    let scene = scenes::colonnade();
    let bvh = Bvh::build(&scene.prims)?;
    let film = scene.camera.begin_frame(256, 256);
    let pixel = |i: usize| film.primary_ray((i % 256) as f32 + 0.5, (i / 256) as f32 + 0.5);
    let whole: Vec<(Ray,)> = (0..TIMED).map(|i| (pixel(i),)).collect();
    let mixed = half_broken(&whole);
    let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
    let (mut text, mut lost) =
        (String::from("| variant | time | spread | hits of broken rays |\n|---|--:|--:|--:|\n"), 0);
    for variant in raydsl_tests::campaigns::VARIANTS {
        let mut found = vec![Hit::miss(); TIMED];
        let mut ratios = Vec::new();
        // The first round warms up.
        for round in 0..=ROUNDS {
            let normal = seconds(|| kernel.run(variant, &whole, &mut found));
            let half = seconds(|| kernel.run(variant, &mixed, &mut found));
            if round > 0 {
                ratios.push(half / normal);
            }
        }
        let hits = found.iter().step_by(2).filter(|hit| hit.is_hit).count() as u64;
        lost += hits;
        let (time, spread) = (median(&ratios), 100.0 * spread(&ratios));
        let name = variant.name();
        let _ = writeln!(text, "| {name} | {time:.2}x | {spread:.1} % | {} |", grouped(hits));
    }
    Ok((text, lost))
}
