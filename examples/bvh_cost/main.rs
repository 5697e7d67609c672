//! What rays cost in a tree, pixel by pixel, for each way of building it. Learn here what a better
//! tree buys, and what it takes.
//!
//! `cargo run --release --example bvh_cost -- FOLDER` writes `bvh_cost.png` to FOLDER (`out` if
//! none is given); `--scene FILE` looks at an OBJ, PLY or TRI.

mod hall;

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use hall::hall;
use raydsl::bvh::{BuildError, Cost};
use raydsl::integrators::bvh_cost;
use raydsl::prelude::*;
use raydsl_examples::args::{point, size};
use raydsl_examples::heat_map::HeatMap;
use raydsl_examples::mesh;
use raydsl_io::LoadError;

/// What is compared.
const QUALITIES: [(&str, BuildQuality); 3] = [
    ("Fast", BuildQuality::Fast),
    ("Balanced", BuildQuality::Balanced),
    ("Best", BuildQuality::Best),
];

/// What rays cost in a tree, for each way of building it.
#[derive(Parser)]
struct Args {
    /// Folder of the picture.
    #[arg(default_value = "out")]
    folder: PathBuf,
    /// The mesh: .obj, .ply or .tri [default: a hall that is made in code].
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// Size of each map.
    #[arg(long, value_name = "WxH", default_value = "300x240", value_parser = size)]
    size: (u32, u32),
    /// Where the camera is [default: in front of the hall, or where all is seen].
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    eye: Option<[f64; 3]>,
    /// What it looks at [default: the middle].
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    target: Option<[f64; 3]>,
}

/// What ends the program: one line, and exit code 2.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error("cannot write to {path}: {reason}; choose another place")]
    Write { path: String, reason: String },
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("bvh_cost: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), Failure> {
    let triangles = args.scene.as_deref().map_or_else(|| Ok(hall()), mesh::load)?;
    println!("{} triangles, {} x {} rays", triangles.len(), args.size.0, args.size.1);
    println!("quality     build ms  SAH cost  nodes/ray  primitives/ray  depth       bytes");
    let mut maps = Vec::new();
    for (name, quality) in QUALITIES {
        let start = Instant::now();
        let bvh = Bvh::build_with(&triangles, &quality.into())?;
        let build_ms = start.elapsed().as_secs_f64() * 1e3;
        let costs = costs(&bvh, &camera(args, bvh.bounds()), args.size);
        let row = row(&bvh, costs.pixels());
        println!("{name:10}  {build_ms:8.1}  {row}");
        maps.push(map(name, costs.pixels(), args.size));
    }
    let path = args.folder.join("bvh_cost.png");
    fs::create_dir_all(&args.folder)
        .map_err(|e| e.to_string())
        .and_then(|()| HeatMap::side_by_side(&maps).save(&path).map_err(|e| e.to_string()))
        .map_err(|reason| Failure::Write { path: path.display().to_string(), reason })
}

/// The camera that was asked for; without one, in front of the hall, or where all of a file is
/// seen.
fn camera(args: &Args, bounds: Aabb) -> Pinhole {
    let middle = bounds.min + bounds.size() * 0.5;
    let away = vec3(0.35, 0.25, 0.9).normalize() * (1.3 * bounds.size().length());
    let (eye, target) = match args.scene {
        Some(_) => (middle + away, middle),
        None => (vec3(-5.0, 2.9, 8.0), vec3(0.2, 2.1, 0.0)),
    };
    let given = |p: Option<[f64; 3]>, or| p.map_or(or, |p| Vec3::from_array(p.map(|x| x as f32)));
    Pinhole::new(given(args.eye, eye), given(args.target, target), Vec3::Y, 0.85)
}

// ANCHOR: costs
/// What the ray of each pixel costs, row by row from the bottom, on all threads.
fn costs(bvh: &Bvh<'_, Triangle>, camera: &Pinhole, (width, height): (u32, u32)) -> Image<Cost> {
    let mut image = Image::filled(width, height, Cost::default());
    let kernel = kernel!(|ray: Ray| bvh_cost(bvh, ray));
    TiledScheduler::new().frame(camera, &kernel, &mut image);
    image
}
// ANCHOR_END: costs

fn row(bvh: &Bvh<'_, Triangle>, costs: &[Cost]) -> String {
    let mean = |count: fn(&Cost) -> u32| {
        costs.iter().map(|c| f64::from(count(c))).sum::<f64>() / costs.len() as f64
    };
    let (nodes, primitives) = (mean(|c| c.nodes), mean(|c| c.primitives));
    let tree = bvh.statistics();
    let (cost, depth, bytes) = (tree.sah_cost, tree.depth, tree.bytes);
    format!("{cost:8.2}  {nodes:9.2}  {primitives:14.2}  {depth:5}  {bytes:10}")
}

fn map(name: &str, costs: &[Cost], (width, height): (u32, u32)) -> HeatMap {
    let values = costs.iter().map(|c| (c.nodes + c.primitives) as f32).collect();
    let mut map = HeatMap { title: String::new(), width, height, values };
    map.title = format!("{name}: {:.1} tests a ray", map.mean());
    map
}
