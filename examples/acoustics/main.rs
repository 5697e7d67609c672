//! An impulse of sound in a box room: what a receiver hears, by rays, beside the exact solution by
//! image sources. Learn here how a kernel returns what it finds in parts of fixed size, so that any
//! number of arrivals fits, how an estimate is tested against the truth bin by bin, and how fast its
//! error falls.
//!
//! `cargo run --release --example acoustics -- FOLDER` writes `acoustics.png` to FOLDER (`out` if
//! none is given): the response, its decay, and the error for more and more rays. It prints the
//! speed of each variant, errors beside run times, and reverberation times. `--help` has the room's
//! numbers.
//!
//! Sound here is energy that goes straight on and is reflected as by mirrors: phases, scattering and
//! bending around corners are left out, of both.

mod args;
mod bins;
mod curves;
mod decay;
mod images;
mod paths;
mod room;
#[cfg(test)]
mod tests;

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use args::Args;
use bins::Bins;
use clap::Parser;
use curves::{BLUE, Curve, GREEN, INK, ORANGE, Panel};
use decay::{backward_integral, relative_error, reverberation_time};
use paths::{Flight, GROUPS, Path, fly, trace};
use raydsl::bvh::BuildError;
use raydsl::kernel::Kernel;
use raydsl::prelude::*;
use raydsl_examples::batches::{Batches, CompareError};
use raydsl_report::work_precision::Color;
use room::{Room, SPEED};

/// Rays by which variants are compared.
const COMPARED: u32 = 1 << 16;
/// Errors are those of bins from this share of the response on.
const LATE: f64 = 0.05;

/// What ends the program: one line, and exit code 2.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error(transparent)]
    Compare(#[from] CompareError),
    #[error("{}: {reason}; choose another place", path.display())]
    Write { path: PathBuf, reason: String },
    #[error("{0}")]
    Usage(String),
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("acoustics: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), Failure> {
    let room = args.room().map_err(Failure::Usage)?;
    let bins = args.bins(&room).map_err(Failure::Usage)?;
    let start = Instant::now();
    let truth = images::response(&room, bins);
    if truth[first_late(bins)..].iter().all(|energy| *energy == 0.0) {
        return Err(Failure::Usage("no sound comes late; lower --absorption".to_owned()));
    }
    println!(
        "{:.0} image sources in {:.2} s, {} bins of {} ms",
        room.image_count(bins.reach()),
        start.elapsed().as_secs_f64(),
        bins.count,
        args.bin
    );

    // ANCHOR: kernel
    let walls = room.walls();
    let tree = Bvh::build(&walls)?;
    let (receiver, reach) = (room.ball(), bins.reach() as f32);
    let kernel = kernel!(|path: Path| fly(&tree, receiver, reach, path));
    // ANCHOR_END: kernel
    let source = room.source.as_vec3();
    let first: Vec<(Path,)> =
        (0..COMPARED).map(|i| (Path::emitted(source, args.seed, i),)).collect();
    println!("\nto the {}th arrival, or the end:", paths::ARRIVALS);
    Batches::of(&args.variants).compare(&args.variants, &kernel, &first, "rays")?;

    let steps = convergence(args, &room, bins, &truth, &kernel);
    let Some(last) = steps.last() else {
        return Err(Failure::Usage("no rays were asked for; raise --rays".to_owned()));
    };
    times(&room, args.bin * 1e-3, &truth, &last.response);

    let drawing = curves::drawing(&panels(&room, args, &truth, &steps));
    let path = args.folder.join("acoustics.png");
    let write = |path: &PathBuf, result: Result<(), String>| {
        result.map_err(|reason| Failure::Write { path: path.clone(), reason })
    };
    write(&args.folder, fs::create_dir_all(&args.folder).map_err(|e| e.to_string()))?;
    let picture = drawing.png(1.0).map_err(|e| e.to_string());
    write(&path, picture.and_then(|file| fs::write(&path, file).map_err(|e| e.to_string())))
}

/// The first of the bins whose errors are taken.
fn first_late(bins: Bins) -> usize {
    (LATE * bins.count as f64) as usize
}

/// What some number of rays gave.
struct Step {
    rays: u32,
    response: Vec<f64>,
    error: f64,
}

/// Traces a thousand rays, and ten times as many, up to what was asked for, and prints a table.
fn convergence(
    args: &Args,
    room: &Room,
    bins: Bins,
    truth: &[f64],
    kernel: &Kernel<'_, (Path,), Flight>,
) -> Vec<Step> {
    let first = first_late(bins);
    let mut steps = Vec::new();
    println!("\n      rays  seconds  error %  error x root of rays  mean z²  lost");
    let powers = (3..10).map(|e| 10u32.pow(e)).take_while(|rays| *rays <= args.rays);
    for rays in powers {
        let start = Instant::now();
        let heard = trace(room, bins, (rays, args.seed), kernel);
        let seconds = start.elapsed().as_secs_f64();
        let response = heard.response();
        let error = relative_error(&response, truth, first);
        let scaled = error * f64::from(rays).sqrt();
        let z2 = mean_z2(&heard, truth, first, (bins.count / 40).max(1));
        let lost = heard.lost;
        println!("{rays:10} {seconds:8.3} {:8.2} {scaled:21.1} {z2:8.2} {lost:5}", 100.0 * error);
        steps.push(Step { rays, response, error });
    }
    let freedom = (GROUPS - 1) as f64;
    println!("without bias z² has the mean {:.2}", freedom / (freedom - 2.0));
    steps
}

/// The mean square of errors in standard errors, in groups of `width` bins from `first` on. In a group
/// to which next to no ray came, the standard error is not known.
fn mean_z2(heard: &paths::Heard, truth: &[f64], first: usize, width: usize) -> f64 {
    let response = heard.response();
    let starts = (first..=truth.len().saturating_sub(width)).step_by(width);
    let of_group = |start: usize| {
        let group = start..start + width;
        let sum = |values: &[f64]| values[group.clone()].iter().sum::<f64>();
        (sum(&response) - sum(truth), heard.standard_error(group.clone()))
    };
    let groups = starts.map(of_group).filter(|(_, error)| *error > 0.0);
    let z2: Vec<f64> = groups.map(|(off, error)| (off / error).powi(2)).collect();
    z2.iter().sum::<f64>() / z2.len() as f64
}

/// Prints reverberation times.
fn times(room: &Room, step: f64, truth: &[f64], traced: &[f64]) {
    println!("\nreverberation time, from the decay    to -25 dB  to -35 dB");
    for (name, response) in [("image sources", truth), ("rays", traced)] {
        let time = |low| {
            let time = reverberation_time(response, step, low);
            time.map_or_else(|| "too short".to_owned(), |t| format!("{t:.3} s"))
        };
        println!("{name:35} {:>11} {:>10}", time(-25.0), time(-35.0));
    }
    println!("Sabine {:.3} s, Eyring {:.3} s", room.sabine(), room.eyring());
}

fn panels(room: &Room, args: &Args, truth: &[f64], steps: &[Step]) -> [Panel; 3] {
    let last = &steps[steps.len() - 1];
    let exact = ("image sources".to_owned(), INK);
    let traced = (format!("{} rays", last.rays), ORANGE);
    let largest = truth.iter().copied().fold(0.0, f64::max);
    let levels = |r: &[f64]| r.iter().map(|e| 10.0 * (e / largest).log10()).collect::<Vec<_>>();
    let over_time = |(name, color): &(String, Color), levels: Vec<f64>, width: f64| {
        let points = (0u32..).zip(levels).map(|(i, l)| ((f64::from(i) + 0.5) * args.bin, l));
        let (name, color, points) = (name.clone(), *color, points.collect());
        Curve { name, points, color, width, dash: None, is_marked: false }
    };
    // Straight from the decay's beginning, the arrival of the direct sound.
    let direct = (room.source.distance(room.receiver) - room.radius) / SPEED * 1e3;
    let straight = |name: &str, color, seconds: f64| {
        let points = vec![(direct, 0.0), (direct + 1e3 * seconds, -60.0)];
        Curve {
            name: name.to_owned(),
            points,
            color,
            width: 1.5,
            dash: Some(5.0),
            is_marked: false,
        }
    };
    let errors = steps.iter().map(|s| (f64::from(s.rays).log10(), (100.0 * s.error).log10()));
    let errors: Vec<_> = errors.collect();
    // Through the last point: of few rays some bins have heard none.
    let end = errors[errors.len() - 1];
    let root = errors.iter().map(|p| (p.0, end.1 + 0.5 * (end.0 - p.0))).collect();
    let ticks = |values: &[f64]| values.iter().map(|v| (*v, format!("{v}"))).collect();
    let decades = |range: std::ops::RangeInclusive<i32>, name: fn(i32) -> String| {
        range.map(|e| (f64::from(e), name(e))).collect::<Vec<_>>()
    };
    let early = (args.time / 5.0).round();
    let (low, high) = errors.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
        (low.min(p.1.floor()), high.max(p.1.ceil()))
    });
    [
        Panel {
            title: format!("energy in {} ms, dB of the largest", args.bin),
            x_name: "ms".to_owned(),
            xs: ticks(&[0.0, 0.25 * early, 0.5 * early, 0.75 * early, early]),
            ys: ticks(&[-40.0, -30.0, -20.0, -10.0, 0.0]),
            curves: vec![
                over_time(&traced, levels(&last.response), 4.0),
                over_time(&exact, levels(truth), 1.2),
            ],
        },
        Panel {
            title: "energy still to come, dB of all".to_owned(),
            x_name: "ms".to_owned(),
            xs: ticks(&[0.0, 0.25, 0.5, 0.75, 1.0].map(|s| (s * args.time).round())),
            ys: ticks(&[-60.0, -50.0, -40.0, -30.0, -20.0, -10.0, 0.0]),
            curves: vec![
                over_time(&traced, backward_integral(&last.response), 4.0),
                over_time(&exact, backward_integral(truth), 1.2),
                straight("Sabine", BLUE, room.sabine()),
                straight("Eyring", GREEN, room.eyring()),
            ],
        },
        Panel {
            title: "error of a bin, %".to_owned(),
            x_name: "rays".to_owned(),
            xs: decades(3..=(errors[errors.len() - 1].0.round() as i32).max(4), |e| {
                format!("1e{e}")
            }),
            ys: decades(low as i32..=high as i32, |e| format!("{}", 10f64.powi(e))),
            curves: vec![
                Curve {
                    name: "rays".to_owned(),
                    points: errors.clone(),
                    color: ORANGE,
                    width: 2.0,
                    dash: None,
                    is_marked: true,
                },
                Curve {
                    name: "1 / root of rays".to_owned(),
                    points: root,
                    color: INK,
                    width: 1.2,
                    dash: Some(5.0),
                    is_marked: false,
                },
            ],
        },
    ]
}
