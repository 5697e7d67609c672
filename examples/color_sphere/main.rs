//! A laser scan as coloured spheres of 16 bytes, by every variant of one closure.
//!
//! Without an argument it makes a landscape of 2 million points; with a file (`.laz`, `.las`,
//! `.ply`, `.xyz`) it shows that. It writes a picture for each variant, their differences, a heat
//! map of the traversal's cost, and a table that says whether they agree.

mod args;
mod scan;

use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use args::Args;
use clap::Parser;
use raydsl::bvh::{BuildConfig, BuildError};
use raydsl::prelude::*;
use raydsl_examples::comparison::{Frames, bar};
use raydsl_examples::everything::beside_all_surfaces;
use raydsl_examples::heat_map::HeatMap;
use raydsl_report::SceneInfo;
use rayon::prelude::*;
use scan::Scan;

// ANCHOR: primitive
/// A point of a scan: the 16 bytes of the paper's Listing 5.
#[primitive]
struct ColorSphere {
    center: Vec3,
    radius: Unorm8,
    color: [Unorm8; 3],
}

#[primitive]
impl ColorSphere {
    const SLACK: f32 = sphere::SLACK;

    fn intersect(&self, ray: Ray) -> Hit {
        sphere::intersect(ray, self.center, self.radius.to_f32())
    }

    fn get_bounds(&self) -> Aabb {
        Aabb::from_sphere(self.center, self.radius.to_f32())
    }

    fn rgb(&self) -> Vec3 {
        vec3(self.color[0].to_f32(), self.color[1].to_f32(), self.color[2].to_f32())
    }
}
// ANCHOR_END: primitive

/// What ends the program: one line, and exit code 2.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    Load(#[from] raydsl_io::LoadError),
    #[error(transparent)]
    Scale(#[from] raydsl_examples::cloud::ScaleError),
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error(transparent)]
    Write(#[from] raydsl_report::WriteError),
    #[error("{0}")]
    Usage(String),
    #[error("cannot write {path}: {reason}; choose another place")]
    File { path: String, reason: String },
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("color_sphere: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), Failure> {
    let (width, height) = (args.size.0, args.size.1);
    let scan = Scan::load(args)?;
    println!("{}", scan.description());
    let start = Instant::now();
    let bvh = build(&scan.spheres)?;
    let build_ms = start.elapsed().as_secs_f64() * 1e3;
    println!("tree: {} nodes, {build_ms:.0} ms", bvh.nodes().len());

    // ANCHOR: kernel
    let zenith = vec3(0.36, 0.52, 0.76);
    let horizon = vec3(0.86, 0.88, 0.90);
    let up = scan.up;
    let primary = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let color = if hit.is_hit {
            bvh.primitive(hit).rgb()
        } else {
            let height = clamp(ray.direction.dot(up) * 1.6 + 0.7, 0.0, 1.0);
            horizon + (zenith - horizon) * height
        };
        Shaded { color, depth: hit.t, id: if hit.is_hit { hit.prim_id } else { 0xffff_ffffu32 } }
    });
    // ANCHOR_END: kernel
    if args.explain {
        let recording = primary.record_frame(&scan.camera, args.size);
        let features = "spheres in 16 bytes, closest hit, a camera";
        let table = beside_all_surfaces("color_sphere", features, recording);
        println!("{}", table.map_err(|error| Failure::Usage(error.to_string()))?);
        return Ok(());
    }

    let frames =
        Frames { size: args.size, runs: args.runs, variants: &args.variants, out: &args.out };
    let found = frames.compare(&primary, &scan.camera);
    frames.report(&found)?;
    let costs = heat_map(&scan, &bvh, width, height);
    let path = args.out.join("cost.png");
    costs.write_png(&path).map_err(|e| cannot_write(&path, &e))?;
    println!("A ray visits {:.1} nodes and spheres on average: cost.png.", costs.mean());

    if let Some(path) = &args.json {
        let scene = SceneInfo {
            scene: scan.name.clone(),
            primitives: scan.spheres.len() as u64,
            build_ms,
            bvh_bytes: bvh.bytes() as u64,
        };
        let text = format!("{:#}\n", found.json(&scene));
        std::fs::write(path, text).map_err(|e| cannot_write(path, &e))?;
    }
    Ok(())
}

/// Builds the tree, with a bar: for a hundred million spheres it takes a minute.
fn build(spheres: &[ColorSphere]) -> Result<Bvh<'_, ColorSphere>, BuildError> {
    const STEPS: f64 = 1000.0;
    let bar = bar(STEPS as u64, "building the tree");
    let bvh = Bvh::build_observed(spheres, &[], &BuildConfig::default(), |done| {
        bar.set_position((done * STEPS) as u64);
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    bvh
}

fn cannot_write(path: &Path, e: &dyn std::fmt::Display) -> Failure {
    Failure::File { path: path.display().to_string(), reason: e.to_string() }
}

/// Nodes and primitives that the ray of every pixel visits, as in the paper's Figure 5.
fn heat_map(scan: &Scan, bvh: &Bvh<'_, ColorSphere>, width: u32, height: u32) -> HeatMap {
    use raydsl::camera::{Camera, CameraRays};
    let rays = scan.camera.begin_frame(width, height);
    let values = (0..u64::from(width) * u64::from(height))
        .into_par_iter()
        .map(|i| {
            let (x, y) = ((i % u64::from(width)) as f32, (i / u64::from(width)) as f32);
            let ray = CameraRays::primary_ray(&rays, x + 0.5, y + 0.5);
            let (_, cost) = bvh.closest_hit_with_cost(ray);
            (cost.nodes + cost.primitives) as f32
        })
        .collect();
    HeatMap { title: "nodes+spheres".to_owned(), width, height, values }
}
