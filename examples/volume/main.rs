//! A scan as a volume, cut open, by every variant of one kernel.
//!
//! Without an argument it makes a head in code; with a file (`.nii.gz`, `.vti`, `.mha`, `.nrrd`) it
//! shows that. It writes a picture for each variant, their differences, and a table that says
//! whether they agree.

mod args;
mod cuts;

use std::process::ExitCode;
use std::time::Instant;

use args::{Args, Integrator, Preset};
use clap::Parser;
use cuts::Cuts;
use indicatif::{ProgressBar, ProgressStyle};
use raydsl::prelude::*;
use raydsl::volume::{
    Centering, Cut, Euler, ExactCell, ExponentialLeft, Grid, GridConfig, MeanExtinction, Midpoint,
    ShadedCell, TransferFunction, Volume, VolumeLight, Voxel,
};
use raydsl_examples::head::head;
use raydsl_io::volume::{VolumeFile, Voxels};
use raydsl_report::{Compare, Comparison};

/// What ends the program: one line, and exit code 2.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    Load(#[from] raydsl_io::LoadError),
    #[error(transparent)]
    Grid(#[from] raydsl::volume::GridError),
    #[error(transparent)]
    Transfer(#[from] raydsl::volume::TransferError),
    #[error(transparent)]
    Build(#[from] raydsl::bvh::BuildError),
    #[error(transparent)]
    Write(#[from] raydsl_report::WriteError),
    #[error("{0}")]
    Usage(String),
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("volume: {e}");
            ExitCode::from(2)
        }
    }
}

/// Voxels along each axis of the head that is made.
const SIDE: u32 = 192;

fn run(args: &Args) -> Result<(), Failure> {
    let scan = match &args.file {
        Some(path) => raydsl_io::volume::load(path)?,
        None => VolumeFile {
            size: UVec3::splat(SIDE),
            to_world: Affine3::from_scale_rotation_translation(
                Vec3::splat(2.0 / SIDE as f32),
                glam::Quat::IDENTITY,
                Vec3::splat(1.0 / SIDE as f32 - 1.0),
            ),
            is_cell_centred: true,
            voxels: Voxels::U8(head(SIDE)),
            scale: 1.0,
            offset: 0.0,
            no_data: None,
        },
    };
    let centering = if scan.is_cell_centred { Centering::Cell } else { Centering::Vertex };
    let config = GridConfig::new()
        .to_world(scan.to_world)
        .centering(centering)
        .rescale(scan.scale, scan.offset);
    // One type of voxels is one kernel to compile; integers of 8 and 16 bits are exact.
    let voxels: Vec<f32> = match scan.voxels {
        Voxels::U8(all) => numbers(&all),
        Voxels::U16(all) => numbers(&all),
        Voxels::I16(all) => numbers(&all),
        Voxels::F32(all) => all,
    };
    show(args, &Grid::new(voxels, scan.size, config)?)
}

fn numbers<T: Voxel>(all: &[T]) -> Vec<f32> {
    all.iter().map(|v| v.number()).collect()
}

/// Colours and opacities over the range of the values; `size` is that of the scan.
fn transfer(preset: Preset, range: Vec2, size: f32) -> Result<TransferFunction, Failure> {
    let at = |share: f32| range.x + (range.y - range.x) * share;
    let skin = vec3(0.86, 0.6, 0.48);
    let (grey, white, bone) = (vec3(0.8, 0.66, 0.6), vec3(0.93, 0.9, 0.84), vec3(1.0, 0.98, 0.9));
    let colors =
        [(at(0.22), skin), (at(0.36), skin), (at(0.46), grey), (at(0.66), white), (at(0.85), bone)];
    let opacities: &[(f32, f32)] = match preset {
        Preset::Tissue => &[(0.16, 0.0), (0.24, 0.55), (0.35, 0.6), (0.45, 0.9), (1.0, 0.97)],
        Preset::Glass => {
            &[(0.2, 0.0), (0.26, 0.03), (0.34, 0.02), (0.55, 0.04), (0.62, 0.7), (1.0, 0.9)]
        }
        Preset::Bone => &[(0.72, 0.0), (0.8, 0.9)],
        Preset::Xray => &[(0.15, 0.0), (1.0, 0.02)],
    };
    let opacities: Vec<_> =
        opacities.iter().map(|(share, opacity)| (at(*share), *opacity)).collect();
    Ok(TransferFunction::new(&colors, &opacities, size / 200.0)?)
}

// ANCHOR: integrators
/// Any of the integrators: WGSL has the one that is captured.
#[derive(Clone, Copy, raydsl::Type)]
enum Method {
    Euler(Euler),
    ExponentialLeft(ExponentialLeft),
    Midpoint(Midpoint),
    MeanExtinction(MeanExtinction),
    ExactCell(ExactCell),
    ShadedCell(ShadedCell),
}
// ANCHOR_END: integrators

impl Method {
    fn of(name: Integrator, step: f32, to_light: Vec3, edge: f32) -> Self {
        match name {
            Integrator::Euler => Self::Euler(Euler::new(step)),
            Integrator::ExponentialLeft => Self::ExponentialLeft(ExponentialLeft::new(step)),
            Integrator::Midpoint => Self::Midpoint(Midpoint::new(step)),
            Integrator::MeanExtinction => Self::MeanExtinction(MeanExtinction::new(step)),
            Integrator::ExactCell => Self::ExactCell(ExactCell::new()),
            Integrator::ShadedCell => Self::ShadedCell(ShadedCell::new(to_light, edge)),
        }
    }
}

fn show(args: &Args, grid: &Grid<'_, f32>) -> Result<(), Failure> {
    if !(args.step > 0.0 && args.step.is_finite()) {
        return Err(Failure::Usage(format!("--step {} is not above 0", args.step)));
    }
    let range = grid.range();
    let size = grid.size();
    println!("{} x {} x {} voxels, values from {} to {}", size.x, size.y, size.z, range.x, range.y);
    let to_world = grid.config().to_world;
    let middle = to_world.transform_point3((size - 1).as_vec3() * 0.5);
    let spans = to_world.matrix3 * size.as_vec3();
    let extent = spans.abs().max_element();
    let voxel = extent / size.max_element() as f32;
    let start = Instant::now();
    let volume = Volume::new(grid, transfer(args.tf, range, extent)?);
    let empty = volume.majorants().iter().filter(|m| **m == 0.0).count();
    println!(
        "{empty} of {} macro-cells are empty, found in {:.1} ms",
        volume.majorants().len(),
        start.elapsed().as_secs_f64() * 1e3
    );

    let mut cuts = Cuts::default();
    for text in &args.cut {
        cuts.add(text)?;
    }
    if args.cut.is_empty() && !args.whole {
        // A ball out of the front, and the side nearest to the camera.
        let [x, y, z] = (middle + spans.abs() * vec3(0.22, 0.3, 0.3)).to_array();
        cuts.add(&format!("sphere:{x},{y},{z},{}", extent * 0.3))?;
    }
    let (away, kept) = (cuts.away.scene()?, cuts.kept.scene()?);
    let keeps_all = cuts.kept.is_empty();

    let from = args.from.map_or(vec3(0.75, 1.15, 0.55), |v| Vec3::from(v.map(|x| x as f32)));
    let from = from.normalize_or(Vec3::Y);
    let up = if from.z.abs() > 0.99 { Vec3::Y } else { Vec3::Z };
    let camera = Pinhole::new(middle + from * extent * 2.6, middle, up, 0.42);
    let to_light = (from + from.cross(up).normalize() * 0.5 + up * 0.5).normalize();
    let method = Method::of(
        args.integrator,
        args.step * voxel,
        to_light,
        (range.y - range.x) / voxel * 0.08,
    );
    let background = vec3(0.05, 0.06, 0.08);
    // ANCHOR: kernel
    let primary = kernel!(|ray: Ray| {
        let mut light = VolumeLight::new();
        let mut inner = Cut::new(&kept, ray);
        let mut kept_part = if keeps_all { Some(ray) } else { inner.next_inside(&kept) };
        while let Some(whole) = kept_part {
            let mut outer = Cut::new(&away, whole);
            while let Some(part) = outer.next_outside(&away) {
                light = match method {
                    Method::Euler(method) => volume.integrate(&method, part, light),
                    Method::ExponentialLeft(method) => volume.integrate(&method, part, light),
                    Method::Midpoint(method) => volume.integrate(&method, part, light),
                    Method::MeanExtinction(method) => volume.integrate(&method, part, light),
                    Method::ExactCell(method) => volume.integrate(&method, part, light),
                    Method::ShadedCell(method) => volume.integrate(&method, part, light),
                };
            }
            kept_part = if keeps_all { None } else { inner.next_inside(&kept) };
        }
        Shaded { color: light.over(background), depth: light.depth, id: 0u32 }
    });
    // ANCHOR_END: kernel

    let found = compare_variants(args, &primary, &camera);
    println!("\n{}", found.table());
    if let Some(adapter) = &found.adapter {
        println!("WGSL ran on {adapter}.");
    }
    println!(
        "Medians of {} interleaved runs of {}x{} rays on {} threads; the pictures are in {}.",
        args.runs,
        args.size.0,
        args.size.1,
        rayon::current_num_threads(),
        args.out.display()
    );
    found.write(&args.out)?;
    Ok(())
}

/// Runs every variant that was asked for, with a bar.
fn compare_variants(
    args: &Args,
    kernel: &Kernel<'_, (Ray,), Shaded>,
    camera: &Pinhole,
) -> Comparison<Shaded> {
    let variants = args.variants();
    let steps = variants.iter().count() * (usize::from(args.runs) + 1);
    let style = ProgressStyle::with_template("{msg:28} {wide_bar} {percent:>3} %")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(steps as u64).with_style(style).with_message("rendering");
    let found = Compare::new()
        .size(args.size.0, args.size.1)
        .runs(args.runs.into())
        .variants(&variants)
        .progress(|name| {
            bar.set_message(format!("rendering {name}"));
            bar.inc(1);
        })
        .run(kernel, camera);
    bar.finish_and_clear();
    found
}
