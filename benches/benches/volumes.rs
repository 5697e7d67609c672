//! Volumes on one thread: every integrator and variant, its rate and its error.
//!
//! The volume is the scan of a brain, `mni152_t1_1mm.nii.gz` in the folder `RAYDSL_DATA`; without
//! it, a head made in code. The rate is that of nominal samples: the length of all rays in the
//! volume's box over the step, one voxel for the exact cell. The error is against the exact cell in
//! `f64`.
//!
//! `--export` writes the case for other renderers: `benches/rivals/volumes.py` measures those.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use raydsl::prelude::*;
use raydsl::volume::{
    Adaptive, Centering, Euler, ExactCell, ExponentialLeft, Grid, GridConfig, MeanExtinction,
    Midpoint, PreIntegrated, TransferFunction, Volume, VolumeLight,
};
use raydsl_benches::clock::{median, seconds, spread};
use raydsl_examples::head::head;
use raydsl_io::volume::Voxels;
use serde::Serialize;

/// Measures the integrators of volumes.
#[derive(Parser)]
struct Args {
    /// The volume; the brain where its file is there, unless said.
    #[arg(long, value_enum)]
    subject: Option<Name>,
    /// Writes the rows to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Writes the volume, the camera, the functions and pictures of the exact cell to this folder,
    /// and measures nothing.
    #[arg(long)]
    export: Option<PathBuf>,
    /// Width and height of the picture, a multiple of 4.
    #[arg(long, default_value_t = 1024)]
    size: u32,
    /// Rounds; each measures every variant once.
    #[arg(long, default_value_t = 3)]
    rounds: usize,
    /// Only the integrators whose names contain one of these words.
    #[arg(long)]
    only: Vec<String>,
    /// Only this variant.
    #[arg(long)]
    variant: Option<String>,
    /// Steps of the integrators that have one, in voxels.
    #[arg(long, value_delimiter = ',', default_values_t = [1.0, 0.5, 0.25])]
    steps: Vec<f32>,
    /// The square root of the number of rays whose error is found; 0 finds none.
    #[arg(long, default_value_t = 24)]
    checked: u32,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Name {
    Brain,
    Head,
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
    config: GridConfig,
    /// Value from which on there is tissue, the middle of grey matter, and its width.
    edge: f32,
    peak: f32,
}

/// Returns the subject that was asked for, or the one that is there.
fn subject(asked: Option<Name>) -> Result<Subject, String> {
    match (asked, std::env::var_os("RAYDSL_DATA")) {
        (Some(Name::Head), _) => Ok(made_head()),
        (_, Some(data)) => brain(&Path::new(&data).join("mni152_t1_1mm.nii.gz")),
        (Some(Name::Brain), None) => Err("RAYDSL_DATA names no folder".to_owned()),
        (None, None) => {
            eprintln!("RAYDSL_DATA names no folder with the brain: measuring a head made in code");
            Ok(made_head())
        }
    }
}

fn made_head() -> Subject {
    let config = GridConfig::new().centering(Centering::Cell);
    let size = UVec3::splat(192);
    Subject { name: "head", size, voxels: head(192), config, edge: 60.0, peak: 125.0 }
}

fn brain(path: &Path) -> Result<Subject, String> {
    let scan = raydsl_io::volume::load(path).map_err(|error| error.to_string())?;
    let Voxels::U8(voxels) = scan.voxels else {
        return Err(format!("{}: voxels are no bytes", path.display()));
    };
    let centering = if scan.is_cell_centred { Centering::Cell } else { Centering::Vertex };
    // Values are the stored bytes: the functions below are of those.
    let config = GridConfig::new().to_world(scan.to_world).centering(centering);
    Ok(Subject { name: "brain", size: scan.size, voxels, config, edge: 60.0, peak: 165.0 })
}

/// Perspective camera over a square picture, from the side, in front and above.
struct Camera {
    eye: Vec3,
    forward: Vec3,
    right: Vec3,
    up: Vec3,
}

/// Width and height of the camera's picture at a distance of 1.
const EXTENT: f32 = 0.5;

impl Camera {
    fn new(grid: &Grid<'_, u8>) -> Self {
        let config = grid.config();
        let center = config.to_world.transform_point3((grid.size().as_vec3() - 1.0) * 0.5);
        let extent = (config.to_world.matrix3 * grid.size().as_vec3()).abs().max_element();
        let eye = center + vec3(1.1, 1.5, 0.7) * extent;
        let forward = (center - eye).normalize();
        let right = forward.cross(Vec3::Z).normalize();
        Self { eye, forward, right, up: right.cross(forward) }
    }

    /// Returns the ray through the middle of a pixel; rows count upwards.
    fn ray(&self, x: u32, y: u32, size: u32) -> Ray {
        let at = |i: u32| ((i as f32 + 0.5) / size as f32 - 0.5) * EXTENT;
        let towards = self.forward + self.right * at(x) + self.up * at(y);
        Ray::new(self.eye, towards.normalize())
    }
}

/// Returns the pixel of a ray: tiles of 4 by 4, so that the rays of a packet are neighbours.
fn pixel(i: u32, size: u32) -> (u32, u32) {
    let (tile, in_tile, tiles) = (i / 16, i % 16, size / 4);
    ((tile % tiles) * 4 + in_tile % 4, (tile / tiles) * 4 + in_tile / 4)
}

/// A transfer function's name and knots.
struct Function {
    name: &'static str,
    colors: [(f32, Vec3); 3],
    opacities: [(f32, f32); 3],
    unit: f32,
}

/// Returns a soft function, and one that is a narrow peak; opacities are those of a voxel.
fn functions(subject: &Subject, voxel: f32) -> [Function; 2] {
    let (edge, peak) = (subject.edge, subject.peak);
    let colors = [(edge, vec3(0.9, 0.6, 0.5)), (peak, vec3(0.8, 0.8, 0.7)), (255.0, Vec3::ONE)];
    let soft = [(edge, 0.0), (peak, 0.06), (255.0, 0.25)];
    let narrow = [(peak - 1.0, 0.0), (peak, 0.9), (peak + 1.0, 0.0)];
    let of = |name, opacities| Function { name, colors, opacities, unit: voxel };
    [of("soft", soft), of("peak", narrow)]
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("volumes: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> Result<(), String> {
    let subject = subject(args.subject)?;
    let grid = Grid::new(&subject.voxels[..], subject.size, subject.config)
        .map_err(|error| error.to_string())?;
    let size = args.size - args.size % 4;
    let camera = Camera::new(&grid);
    let rays: Vec<(Ray,)> =
        (0..size * size).map(|i| pixel(i, size)).map(|(x, y)| (camera.ray(x, y, size),)).collect();
    let voxel = subject.config.to_world.matrix3.x_axis.length();
    let length = |(ray,): &(Ray,)| {
        let (enter, leave) = grid.span(*ray);
        f64::from((leave - enter).max(0.0))
    };
    let length = rays.iter().map(length).sum::<f64>();
    if args.export.is_none() {
        println!("{}, {} rays, one thread", subject.name, rays.len());
        println!(
            "{:<6} {:<24}{:<10}{:<8}{:>9}{:>8}{:>10}{:>10}",
            "", "integrator", "variant", "isa", "M/s", "spread", "rms", "worst"
        );
    }
    let functions = functions(&subject, voxel);
    let mut rows = Vec::new();
    for Function { name, colors, opacities, unit } in &functions {
        let function =
            TransferFunction::new(colors, opacities, *unit).map_err(|error| error.to_string())?;
        let volume = Volume::new(&grid, function);
        match &args.export {
            Some(folder) => {
                let picture = reference(&volume, &rays, size);
                write(&folder.join(format!("{name}.f32")), bytes_of(&picture))?;
            }
            None => rows.extend(
                Bench { args, volume: &volume, rays: &rays, voxel, length, function: name }.all(),
            ),
        }
    }
    if let Some(folder) = &args.export {
        let Camera { eye, forward, right, up } = camera;
        let config = subject.config.to_world;
        let functions = functions.map(|Function { name, colors, opacities, unit }| {
            let colors = colors.map(|(value, c)| [value, c.x, c.y, c.z]);
            Exported { name, colors, opacities, unit, picture: format!("{name}.f32") }
        });
        let case = Case {
            subject: subject.name,
            voxels: "voxels.u8",
            size: subject.size.to_array(),
            axes: config.matrix3.to_cols_array_2d(),
            origin: config.translation.to_array(),
            voxel,
            length,
            pixels: size,
            eye: eye.to_array(),
            forward: forward.to_array(),
            right: right.to_array(),
            up: up.to_array(),
            extent: EXTENT,
            functions,
        };
        write(&folder.join("voxels.u8"), subject.voxels)?;
        write(&folder.join("case.json"), serde_json::to_vec_pretty(&case).expect("plain data"))?;
    }
    if let Some(path) = &args.json {
        write(path, serde_json::to_vec_pretty(&rows).expect("rows are plain data"))?;
    }
    Ok(())
}

fn write(path: &Path, bytes: Vec<u8>) -> Result<(), String> {
    std::fs::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))
}

/// What other renderers need to make the same pictures.
#[derive(Serialize)]
struct Case {
    subject: &'static str,
    /// File of the voxels, bytes, the first axis fastest.
    voxels: &'static str,
    size: [u32; 3],
    /// From one voxel to the next along each axis, and the centre of the first one.
    axes: [[f32; 3]; 3],
    origin: [f32; 3],
    /// Edge of a voxel: steps count in it.
    voxel: f32,
    /// Length of all rays in the volume's box.
    length: f64,
    /// Width and height of the picture.
    pixels: u32,
    eye: [f32; 3],
    forward: [f32; 3],
    right: [f32; 3],
    up: [f32; 3],
    /// Width and height of the picture at a distance of 1.
    extent: f32,
    functions: [Exported; 2],
}

#[derive(Serialize)]
struct Exported {
    name: &'static str,
    /// Value and colour.
    colors: [[f32; 4]; 3],
    /// Value and opacity of a layer as thick as `unit`.
    opacities: [(f32, f32); 3],
    unit: f32,
    /// File of the exact picture: four `f32` a pixel, the lowest row first; premultiplied.
    picture: String,
}

/// Renders the exact picture, the lowest row first.
fn reference(volume: &Volume<'_, u8>, rays: &[(Ray,)], size: u32) -> Vec<Vec4> {
    let exact = ExactCell::new().least(0.0);
    let kernel = kernel!(|ray: Ray| volume.integrate(&exact, ray, VolumeLight::new()).rgba());
    let mut tiled = vec![Vec4::ZERO; rays.len()];
    kernel.run(Variant::Packet16, rays, &mut tiled);
    let mut rows = tiled.clone();
    for (i, color) in (0..).zip(tiled) {
        let (x, y) = pixel(i, size);
        rows[(y * size + x) as usize] = color;
    }
    rows
}

fn bytes_of(picture: &[Vec4]) -> Vec<u8> {
    picture.iter().flat_map(|c| c.to_array()).flat_map(f32::to_le_bytes).collect()
}

struct Bench<'a> {
    args: &'a Args,
    volume: &'a Volume<'a, u8>,
    rays: &'a [(Ray,)],
    /// Edge of a voxel.
    voxel: f32,
    /// Length of all rays in the box.
    length: f64,
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
        for tolerance in [1e-2, 1e-3] {
            let adaptive = Adaptive::new(tolerance);
            let kernel =
                kernel!(|ray: Ray| volume.integrate(&adaptive, ray, VolumeLight::new()).rgba());
            rows.extend(self.measure(&format!("adaptive {tolerance}"), 1.0, &kernel, truth));
        }
        macro_rules! steps {
            ($($name:literal $integrator:ident $steps:expr;)+) => {
                $(for step in $steps.iter().copied() {
                    let integrator = $integrator::new(step * self.voxel);
                    let kernel = kernel!(|ray: Ray| {
                        volume.integrate(&integrator, ray, VolumeLight::new()).rgba()
                    });
                    let name = format!("{} {step}", $name);
                    rows.extend(self.measure(&name, f64::from(step), &kernel, truth));
                })+
            };
        }
        steps! {
            "midpoint" Midpoint self.args.steps;
            "pre-integrated" PreIntegrated self.args.steps;
            "mean extinction" MeanExtinction self.args.steps;
            "exponential left" ExponentialLeft self.args.steps;
            "naive" Euler self.args.steps;
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
        let samples = self.length / f64::from(self.voxel) / step;
        let mut off = Vec::new();
        for (ray, expected) in checked.iter().zip(references) {
            let found = kernel.call(*ray).to_array();
            off.extend(expected.iter().zip(found).map(|(a, b)| (a - f64::from(b)).abs()));
        }
        let rms = (off.iter().map(|d| d * d).sum::<f64>() / off.len().max(1) as f64).sqrt();
        let worst = off.iter().copied().fold(0.0, f64::max);
        let variants: Vec<Variant> = CPU
            .into_iter()
            .filter(|v| v.is_native())
            .filter(|v| self.args.variant.as_ref().is_none_or(|name| v.name() == name))
            .collect();
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
