//! A laser scanner in an aeroplane, over the procedural landscape, into a LAS file. Learn here how
//! a kernel that simulates a sensor takes the index of a measurement and returns a struct of fixed
//! size, how `hits` follows a beam through leaves to the ground, and how noise from the library's
//! random numbers is the same in every variant.
//!
//! `cargo run --release --example lidar -- FOLDER` writes `lidar.las` and `lidar.png` to FOLDER
//! (`out` if none is given): the points from above, coloured by height, and a section through a
//! wood. It prints pulses a second of each variant, points per square metre, the error of ranges
//! and how many returns pulses have. `--help` has the scanner's numbers.

mod args;
mod echoes;
mod points;
mod scanner;
mod sheet;
#[cfg(test)]
mod tests;

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

use args::Args;
use clap::Parser;
use echoes::{ECHOES, Returns, Surfaces, returns};
use points::Point;
use raydsl::bvh::BuildError;
use raydsl::prelude::*;
use raydsl_examples::batches::{Batches, CompareError};
use raydsl_examples::cloud::facets;

/// The landscape.
const SEED: u64 = 7;
/// Side of its square, in metres.
const SIDE: f64 = 200.0;

/// What ends the program: one line, and exit code 2.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error(transparent)]
    Compare(#[from] CompareError),
    #[error("{}: {reason}; choose another place", path.display())]
    Write { path: PathBuf, reason: String },
    #[error("the file was written, but what was read back differs: {0}")]
    ReadBack(String),
    #[error("{0}")]
    Usage(String),
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("lidar: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), Failure> {
    let scanner = args.scanner().map_err(Failure::Usage)?;
    let land = facets(SEED);
    let tree = Bvh::build(&land.triangles)?;
    let pulses = scanner.lines * scanner.line_pulses;
    println!("{} triangles, {pulses} pulses on {} lines", land.triangles.len(), scanner.lines);

    // ANCHOR: kernel
    let surfaces = Surfaces::new(land.first_leaf());
    let kernel = kernel!(|pulse: u32| returns(&tree, surfaces, scanner, pulse));
    let inputs: Vec<(u32,)> = (0..pulses).map(|i| (i,)).collect();
    // ANCHOR_END: kernel
    let batches = Batches::of(&args.variants);
    let measured = batches.compare(&args.variants, &kernel, &inputs, "pulses")?;

    let points: Vec<Point> = (0u32..)
        .zip(&measured)
        .flat_map(|(pulse, returns)| Point::of(&scanner, &land, pulse, returns))
        .collect();
    report(args, &measured, &points);

    let write = |path: &PathBuf, result: Result<(), String>| {
        result.map_err(|reason| Failure::Write { path: path.clone(), reason })
    };
    write(&args.folder, fs::create_dir_all(&args.folder).map_err(|e| e.to_string()))?;
    let path = args.folder.join("lidar.las");
    write(&path, points::write_las(&points, &path).map_err(|e| e.to_string()))?;
    points::check_las(&points, &path).map_err(Failure::ReadBack)?;
    println!("{} read back: {} points", path.display(), points.len());
    let path = args.folder.join("lidar.png");
    write(&path, sheet::picture(&points, SIDE).save(&path).map_err(|e| e.to_string()))
}

/// Prints what was measured.
fn report(args: &Args, measured: &[Returns], points: &[Point]) {
    let half = 0.5 * SIDE;
    let is_on_land = |p: &&Point| p.position.x.abs() < half && p.position.y.abs() < half;
    let on_land = points.iter().filter(is_on_land);
    let (all, first) = on_land
        .fold((0u32, 0u32), |(all, first), p| (all + 1, first + u32::from(p.return_number == 1)));
    let density = |count: u32| f64::from(count) / (SIDE * SIDE);
    println!("{:.2} points and {:.2} first returns per m²", density(all), density(first));
    println!(
        "ranges are off by {:.4} m (root mean square), {} m were asked for",
        echoes::range_error(measured),
        args.noise
    );
    println!("returns  pulses");
    for count in 0..=ECHOES {
        let pulses = measured.iter().filter(|r| r.count as usize == count).count();
        println!("{count:7} {pulses:7}");
    }
}
