//! Computes strong and weak scaling to 1,024 nodes from reports of measured runs.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use raydsl_examples::args::size;
use raydsl_ranks::args::power_of_two;
use raydsl_ranks::report::Report;
use raydsl_ranks::scaling::{Cluster, Film, Frames, NODES, Row, Scaling, table};

/// Compute how long more nodes would take, from report.json of measured runs.
#[derive(Debug, Parser)]
#[command(about)]
struct Args {
    /// A film by two or more ranks.
    #[arg(long, value_name = "FILE")]
    film: Option<PathBuf>,
    /// Frames of points: one part, then more.
    #[arg(long, value_name = "FILE", num_args = 2)]
    points: Vec<PathBuf>,
    /// Frames of a volume: one part, then more.
    #[arg(long, value_name = "FILE", num_args = 2)]
    volume: Vec<PathBuf>,
    /// Picture size of the computed runs.
    #[arg(long, value_name = "WxH", default_value = "3840x2160", value_parser = size)]
    size: (u32, u32),
    /// Samples of each pixel of a film, for each node where scaling is weak.
    #[arg(long, default_value = "1024", value_parser = clap::value_parser!(u32).range(1..))]
    samples: u32,
    /// Blocks of 64 samples of a unit of work: a power of two.
    #[arg(long, default_value = "1", value_parser = power_of_two)]
    blocks: u32,
    /// Threads of a node.
    #[arg(long, default_value = "64", value_parser = clap::value_parser!(u32).range(1..))]
    threads: u32,
    /// Gigabits that a node sends in a second.
    #[arg(long, value_name = "GBIT", default_value = "100", value_parser = clap::value_parser!(u32).range(1..))]
    link: u32,
    /// Microseconds from sending a message to its arrival.
    #[arg(long, value_name = "US", default_value = "2")]
    latency: u32,
}

/// The bytes of a fragment of points and of a volume.
const POINT: f64 = 20.0;
const BRICK: f64 = 16.0;

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("scaling: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), String> {
    let cluster = Cluster {
        threads: f64::from(args.threads),
        bandwidth: f64::from(args.link) * 1e9 / 8.0,
        latency: f64::from(args.latency) * 1e-6,
    };
    let pixels = f64::from(args.size.0) * f64::from(args.size.1);
    if let Some(path) = &args.film {
        let report = read(path)?;
        let film = Film::of(&report).ok_or_else(|| not(path, "a film by two or more ranks"))?;
        let (samples, blocks) = (f64::from(args.samples), f64::from(args.blocks));
        let film = Film { pixels, samples, blocks, ..film };
        println!(
            "{}: {:.3} million samples a second and thread, {:.2} ns of the root for a byte\n",
            report.scene,
            film.rate / 1e6,
            film.root * 1e9,
        );
        both(|scaling, nodes| film.row(&cluster, scaling, nodes));
    }
    for (paths, bytes) in [(&args.points, POINT), (&args.volume, BRICK)] {
        let [one, more] = &paths[..] else { continue };
        let reports = (read(one)?, read(more)?);
        let frames = Frames::of(&reports.0, &reports.1, bytes)
            .ok_or_else(|| not(more, "frames of more parts than those of the first file"))?;
        let frames = Frames { pixels, ..frames };
        println!(
            "{}: {:.0} ns of a thread for a pixel, as parts to the power of {:.2};\n\
             {:.2} fragments a pixel of one part, as parts to the power of {:.2}; {:.0} ns for \
             compositing one\n",
            reports.0.scene,
            frames.render * 1e9,
            frames.overhead,
            frames.fragments,
            frames.growth,
            frames.composite * 1e9,
        );
        both(|scaling, nodes| frames.row(&cluster, scaling, nodes));
    }
    Ok(())
}

fn both(row: impl Fn(Scaling, u32) -> Row) {
    for (scaling, name) in [(Scaling::Strong, "Strong"), (Scaling::Weak, "Weak")] {
        println!("{name} scaling:\n\n{}", table(&NODES.map(|nodes| row(scaling, nodes))));
    }
}

fn read(path: &Path) -> Result<Report, String> {
    let told = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
    let text = std::fs::read_to_string(path).map_err(|e| told(&e))?;
    serde_json::from_str(&text).map_err(|e| told(&e))
}

fn not(path: &Path, what: &str) -> String {
    format!("{}: is no report of {what}", path.display())
}
