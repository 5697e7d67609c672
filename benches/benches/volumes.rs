//! Volumes on one thread: every integrator and variant, its rate and its error.
//!
//! The volume is the head made in code. The rate is that of nominal samples: the length of all rays
//! in the volume's box over the step, one voxel for the exact cell. The error is against the exact
//! cell in `f64`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use raydsl::prelude::*;
use raydsl::volume::{
    Centering, Euler, ExactCell, ExponentialLeft, Grid, GridConfig, MeanExtinction, Midpoint,
    TransferFunction, Volume, VolumeLight,
};
use raydsl_benches::clock::{median, seconds, spread};
use raydsl_examples::head::head;
use serde::Serialize;

/// Measures the integrators of volumes.
#[derive(Parser)]
struct Args {
    /// Writes the rows to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Width and height of the picture, a multiple of 4.
    #[arg(long, default_value_t = 1024)]
    size: u32,
    /// Rounds; each measures every variant once.
    #[arg(long, default_value_t = 3)]
    rounds: usize,
    /// Only the integrators whose names contain one of these words.
    #[arg(long)]
    only: Vec<String>,
    /// The square root of the number of rays whose error is found; 0 finds none.
    #[arg(long, default_value_t = 24)]
    checked: u32,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

#[derive(Serialize)]
struct Row {
    function: &'static str,
    integrator: String,
    variant: &'static str,
    isa: &'static str,
    /// Millions of nominal samples a second, the median of all rounds.
    rate: f64,
    /// The middle half of the rounds, as a share.
    spread: f64,
    /// Root mean square and greatest error of a colour or the opacity.
    rms: f64,
    worst: f64,
}

const CPU: [Variant; 4] = [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16];

/// The volume, and what is measured on it.
struct Subject {
    name: &'static str,
    size: UVec3,
    voxels: Vec<u8>,
    /// Value from which on there is tissue, the middle of grey matter, and its width.
    edge: f32,
    peak: f32,
}

fn subject() -> Subject {
    Subject { name: "head", size: UVec3::splat(192), voxels: head(192), edge: 60.0, peak: 125.0 }
}

/// Camera rays in tiles of 4 by 4, so that the rays of a packet are neighbours.
fn rays(grid: &Grid<'_, u8>, size: u32) -> Vec<(Ray,)> {
    let center = grid.config().to_world.transform_point3(grid.size().as_vec3() * 0.5);
    let extent = (grid.config().to_world.matrix3 * grid.size().as_vec3()).abs().max_element();
    let eye = center + vec3(1.1, 1.5, 0.7) * extent;
    let forward = (center - eye).normalize();
    let right = forward.cross(Vec3::Z).normalize();
    let up = right.cross(forward);
    let tiles = size / 4;
    let pixel = |i: u32| {
        let (tile, in_tile) = (i / 16, i % 16);
        let x = (tile % tiles) * 4 + in_tile % 4;
        let y = (tile / tiles) * 4 + in_tile / 4;
        let at = |i: u32| ((i as f32 + 0.5) / size as f32 - 0.5) * 0.72;
        (Ray::new(eye, (forward + right * at(x) + up * at(y)).normalize()),)
    };
    (0..size * size).map(pixel).collect()
}

fn main() -> ExitCode {
    let args = Args::parse();
    let subject = subject();
    let config = GridConfig::new().centering(Centering::Cell);
    let grid = match Grid::new(&subject.voxels[..], subject.size, config) {
        Ok(grid) => grid,
        Err(error) => {
            eprintln!("volumes: {error}");
            return ExitCode::FAILURE;
        }
    };
    let all = rays(&grid, args.size - args.size % 4);
    println!("{}, {} rays, one thread", subject.name, all.len());
    println!(
        "{:<6} {:<24}{:<10}{:<8}{:>9}{:>8}{:>10}{:>10}",
        "", "integrator", "variant", "isa", "M/s", "spread", "rms", "worst"
    );
    let (edge, peak) = (subject.edge, subject.peak);
    let colors = [(edge, vec3(0.9, 0.6, 0.5)), (peak, vec3(0.8, 0.8, 0.7)), (255.0, Vec3::ONE)];
    let soft = [(edge, 0.0), (peak, 0.06), (255.0, 0.25)];
    let narrow = [(peak - 1.0, 0.0), (peak, 0.9), (peak + 1.0, 0.0)];
    let mut rows = Vec::new();
    for (name, knots) in [("soft", &soft), ("peak", &narrow)] {
        let function = TransferFunction::new(&colors, knots, 1.0).expect("knots are sorted");
        let volume = Volume::new(&grid, function);
        rows.extend(Bench { args: &args, volume: &volume, rays: &all, function: name }.all());
    }
    if let Some(path) = &args.json {
        let text = serde_json::to_string_pretty(&rows).expect("rows are plain data");
        if let Err(error) = std::fs::write(path, text) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

struct Bench<'a> {
    args: &'a Args,
    volume: &'a Volume<'a, u8>,
    rays: &'a [(Ray,)],
    function: &'static str,
}

impl Bench<'_> {
    fn all(&self) -> Vec<Row> {
        let volume = self.volume;
        let mut rows = Vec::new();
        // ANCHOR: rays
        let exact = ExactCell::new();
        let kernel = kernel!(|ray: Ray| volume.integrate(&exact, ray, VolumeLight::new()).rgba());
        // ANCHOR_END: rays
        let checked = self.checked();
        let references: Vec<Vec<f64>> = checked.iter().map(|ray| kernel.reference(*ray)).collect();
        let truth = (&checked[..], &references[..]);
        rows.extend(self.measure("exact cell", 1.0, &kernel, truth));
        macro_rules! steps {
            ($($name:literal $integrator:ident $steps:expr;)+) => {
                $(for step in $steps {
                    let integrator = $integrator::new(step);
                    let kernel = kernel!(|ray: Ray| {
                        volume.integrate(&integrator, ray, VolumeLight::new()).rgba()
                    });
                    let name = format!("{} {step}", $name);
                    rows.extend(self.measure(&name, f64::from(step), &kernel, truth));
                })+
            };
        }
        steps! {
            "midpoint" Midpoint [1.0, 0.5, 0.25];
            "mean extinction" MeanExtinction [1.0];
            "exponential left" ExponentialLeft [1.0];
            "naive" Euler [1.0, 0.25];
        }
        rows
    }

    /// A few rays all over the picture.
    fn checked(&self) -> Vec<(Ray,)> {
        let count = (self.args.checked * self.args.checked) as usize;
        let stride = (self.rays.len() / count.max(1)).max(1);
        self.rays.iter().skip(stride / 2).step_by(stride).copied().collect()
    }

    fn measure(
        &self,
        name: &str,
        step: f64,
        kernel: &Kernel<'_, (Ray,), Vec4>,
        (checked, references): (&[(Ray,)], &[Vec<f64>]),
    ) -> Vec<Row> {
        if !self.args.only.is_empty() && !self.args.only.iter().any(|word| name.contains(word)) {
            return Vec::new();
        }
        let length = |ray: &Ray| {
            let (enter, leave) = self.volume.grid().span(*ray);
            f64::from((leave - enter).max(0.0))
        };
        let samples = self.rays.iter().map(|(ray,)| length(ray)).sum::<f64>() / step;
        let mut off = Vec::new();
        for (ray, expected) in checked.iter().zip(references) {
            let found = kernel.call(*ray).to_array();
            off.extend(expected.iter().zip(found).map(|(a, b)| (a - f64::from(b)).abs()));
        }
        let rms = (off.iter().map(|d| d * d).sum::<f64>() / off.len().max(1) as f64).sqrt();
        let worst = off.iter().copied().fold(0.0, f64::max);
        let variants: Vec<Variant> = CPU.into_iter().filter(|v| v.is_native()).collect();
        let mut rates = vec![Vec::new(); variants.len()];
        let mut pixels = vec![Vec4::ZERO; self.rays.len()];
        for _ in 0..self.args.rounds {
            for (variant, rates) in variants.iter().zip(&mut rates) {
                let time = seconds(|| kernel.run(*variant, self.rays, &mut pixels));
                rates.push(samples / time * 1e-6);
            }
        }
        let row = |(variant, rates): (&Variant, &Vec<f64>)| {
            let row = Row {
                function: self.function,
                integrator: name.to_owned(),
                variant: variant.name(),
                isa: variant.isa().0,
                rate: median(rates),
                spread: spread(rates),
                rms,
                worst,
            };
            println!(
                "{:<6} {:<24}{:<10}{:<8}{:>9.1}{:>7.1}%{:>10.1e}{:>10.1e}",
                row.function,
                row.integrator,
                row.variant,
                row.isa,
                row.rate,
                100.0 * row.spread,
                row.rms,
                row.worst
            );
            row
        };
        variants.iter().zip(&rates).map(row).collect()
    }
}
