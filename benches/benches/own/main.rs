//! Primitives of one's own beside Embree's user geometry: rings, hairs, coloured points and an enum of
//! three shapes; camera rays, and short shadow rays from what they hit.
//!
//! The rays are made once, and both systems are handed them: the library's kernels read them as the
//! application stores them, Embree finds them in its own layout, without a charge. Embree's callbacks
//! run the primitive's own `intersect`, once a ray or lifted to packets. They leave out the normal,
//! which a user would compute too. The library's record of a hair has its tangent, for which it
//! intersects the hair that is hit once more.

mod contender;
mod embree;
mod ours;
mod rays;
mod shapes;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use raydsl::prelude::Traversal;
use raydsl_benches::contest::{parse_size, parse_traversal};
use raydsl_benches::scenes::Scene;
use raydsl_benches::table::{Line, finish, print};

use contender::{Place, Query};
use rays::Workload;
use shapes::Shape;

/// Measures primitives of one's own beside Embree's user geometry.
#[derive(Parser)]
struct Args {
    /// Writes the figures to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Only the scenes whose names contain one of these words: torus, hair, color_sphere, enum.
    #[arg(long)]
    scene: Vec<String>,
    /// Numbers of threads, each measured on its own.
    #[arg(long, value_delimiter = ',', default_value = "1",
          value_parser = clap::value_parser!(u16).range(1..))]
    threads: Vec<u16>,
    /// Rounds; each measures every mode of every row once.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
    rounds: u16,
    /// Width and height of the film, a multiple of 16.
    #[arg(long, default_value = "512", value_parser = parse_size)]
    size: u32,
    /// How wide trees are traversed, each measured on its own: auto, streams, packets, sorted.
    #[arg(long, value_delimiter = ',', default_value = "auto", value_parser = parse_traversal)]
    traversal: Vec<Traversal>,
    /// Only this: primary, shadow_short.
    #[arg(long, value_delimiter = ',', value_parser = Query::from_name)]
    only: Vec<Query>,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    let args = Args::parse();
    let mut lines = Vec::new();
    lines.extend(of_scene(&args, "torus", shapes::rings));
    lines.extend(of_scene(&args, "hair", shapes::fur));
    lines.extend(of_scene(&args, "color_sphere", shapes::scan));
    lines.extend(of_scene(&args, "enum", shapes::kinds));
    if lines.is_empty() {
        eprintln!("own: no scene has such a name: torus, hair, color_sphere, enum");
    }
    finish(&lines, args.json.as_deref())
}

/// Measures a scene, if it is wanted, on each number of threads.
fn of_scene<P: Shape>(args: &Args, name: &str, make: fn() -> Scene<P>) -> Vec<Line> {
    let is_named = args.scene.iter().any(|word| name.contains(word.as_str()));
    if !is_named && !args.scene.is_empty() {
        return Vec::new();
    }
    let scene = make();
    let threads = args.threads.iter().map(|&threads| threads.into());
    threads.flat_map(|threads| measure(args, Place { scene: name, threads }, &scene)).collect()
}

fn measure<P: Shape>(args: &Args, place: Place<'_>, scene: &Scene<P>) -> Vec<Line> {
    let threads = place.threads;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.expect("threads can be started");
    pool.install(|| {
        let trees = ours::trees(&scene.prims, threads, &args.traversal);
        let device = embree::Device::load(&scene.prims, threads);
        let theirs = device.as_ref().map_or_else(Vec::new, embree::Device::trees);
        let work = Workload::new(&trees[0].bvh, &scene.camera, args.size);
        let (primary, shadow) = (work.primary.len(), work.shadow.len());
        println!(
            "{}: {} primitives, {primary} camera rays, {shadow} shadow rays, threads: {threads}\n",
            place.scene,
            scene.prims.len(),
        );
        let mut contenders = ours::contenders(&trees, &work, threads);
        contenders.extend(embree::contenders(&theirs, &work, threads));
        contenders.retain(|contender| args.only.is_empty() || args.only.contains(&contender.query));
        let rays = |query| match query {
            Query::Primary => primary,
            Query::Shadow => shadow,
        };
        let lines = contender::measure(place, &mut contenders, args.rounds.into(), rays);
        print(&lines);
        lines
    })
}
