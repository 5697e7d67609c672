//! Millions of points, each a small ball: how long a tree over them takes and how large it is, and
//! primary rays, beside Embree's points. Every round builds every tree once.

mod systems;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use raydsl::prelude::*;
use raydsl_benches::clock::{median, spread};
use raydsl_benches::contest::TILE;
use raydsl_benches::device;
use raydsl_benches::scenes::{self, Scene};
use raydsl_benches::table::{Line, finish, print};

use systems::{Record, Rounds, Task};

/// Measures trees over points beside Embree's.
#[derive(Parser)]
struct Args {
    /// Writes the figures to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// The surface that the points lie on: `colonnade`, `grove`, a scene of RAYDSL_DATA, or a
    /// file, .tri, .obj or .ply.
    #[arg(long, default_value = "colonnade")]
    scene: Vec<String>,
    /// How many points, about.
    #[arg(long, default_value_t = 10_000_000)]
    points: usize,
    /// Numbers of threads, each measured on its own.
    #[arg(long, value_delimiter = ',', default_value = "1",
          value_parser = clap::value_parser!(u16).range(1..))]
    threads: Vec<u16>,
    /// Rounds; each builds every tree and measures every mode once.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
    rounds: u16,
    /// Width and height of the film, a multiple of 16.
    #[arg(long, default_value_t = 1024, value_parser = clap::value_parser!(u32).range(16..=4096))]
    size: u32,
    /// Measures WGSL, too, on this machine's device and by its clock.
    #[arg(long)]
    device: bool,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    let args = Args::parse();
    let device = match device::open(args.device, false) {
        Ok(device) => device,
        Err(error) => {
            eprintln!("points: {error}");
            return ExitCode::FAILURE;
        }
    };
    let mut lines = Vec::new();
    for name in &args.scene {
        match surface(name) {
            Ok(scene) => {
                let points = scenes::points(&scene.prims, args.points);
                for &threads in &args.threads {
                    lines.extend(measure(
                        &args,
                        name,
                        &points,
                        scene.camera,
                        threads.into(),
                        device.as_ref(),
                    ));
                }
            }
            Err(error) => eprintln!("skipped {name}: {error}"),
        }
    }
    finish(&lines, args.json.as_deref())
}

fn surface(name: &str) -> Result<Scene<Triangle>, String> {
    match (name, std::env::var_os("RAYDSL_DATA")) {
        ("colonnade", _) => Ok(scenes::colonnade()),
        ("grove", _) => Ok(scenes::grove()),
        (file, _) if Path::new(file).extension().is_some() => {
            scenes::mesh(file.as_ref()).map_err(|error| error.to_string())
        }
        (_, Some(data)) => scenes::file(data.as_ref(), name).map_err(|error| error.to_string()),
        (_, None) => Err("RAYDSL_DATA names no folder".to_owned()),
    }
}

fn measure(
    args: &Args,
    name: &str,
    points: &[scenes::Point],
    camera: Pinhole,
    threads: usize,
    device: Option<&GpuScheduler>,
) -> Vec<Line> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.expect("threads can be started");
    println!("{name}: {} points, threads: {threads}\n", points.len());
    let task = Task::new(points, camera, args.size.next_multiple_of(TILE), threads, device);
    let records = pool.install(|| Rounds::new(&task).run(args.rounds.into()));
    let scene = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    let lines: Vec<Line> =
        records.iter().map(|record| line(&scene, &task, record, &records)).collect();
    print(&lines);
    lines
}

/// The figures of one record beside Embree's best of its row.
fn line(scene: &str, task: &Task<'_>, record: &Record, records: &[Record]) -> Line {
    let rivals = records.iter().filter(|r| r.system == "embree" && r.row == record.row);
    let embree = rivals.min_by(|a, b| median(&a.seconds).total_cmp(&median(&b.seconds)));
    let first = records.iter().find(|r| r.row == record.row).unwrap_or(record);
    let expected = embree.unwrap_or(first);
    let count = if record.row == "build" { task.points.len() } else { task.primary.len() };
    let rates: Vec<f64> = record.seconds.iter().map(|s| count as f64 / s * 1e-6).collect();
    let ratio = |e: &Record| e.seconds.iter().zip(&record.seconds).map(|(a, b)| a / b).collect();
    let ratios: Option<Vec<f64>> = embree.map(ratio);
    let agrees = record.outcome.agrees(&expected.outcome, count);
    Line {
        scene: scene.to_owned(),
        row: record.row,
        system: record.system,
        mode: record.mode.clone(),
        isa: record.isa,
        lanes: record.lanes,
        rays: count,
        threads: task.threads,
        mrays_per_s: median(&rates),
        spread: spread(ratios.as_ref().unwrap_or(&rates)),
        ratio_to_embree: ratios.as_deref().map(median),
        ratio_to_robust: None,
        build_ms: record.cost.build_ms,
        bytes_per_primitive: record.cost.bytes_per_primitive,
        hits: record.outcome.hits,
        mean_t: record.outcome.mean(),
        status: if agrees { "ok" } else { "void" },
    }
}
