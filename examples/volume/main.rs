//! A scan as a volume, cut open, by every variant of one kernel.
//!
//! Without an argument it makes a head in code; with a file (`.nii.gz`, `.vti`, `.mha`, `.nrrd`) it
//! shows that. It writes a picture for each variant, their differences, and a table that says
//! whether they agree.

mod args;
mod cuts;
mod everything;
mod transfer;

use std::process::ExitCode;
use std::time::Instant;

use args::{Args, Integrator};
use clap::Parser;
use cuts::Cuts;
use raydsl::prelude::*;
use raydsl::volume::{
    Adaptive, Centering, Cut, Euler, ExactCell, ExponentialLeft, Grid, GridConfig, Labels,
    MeanExtinction, Midpoint, PreIntegrated, ShadedCell, Volume, VolumeLight, Voxel,
};
use raydsl_examples::comparison::Frames;
use raydsl_examples::head::head;
use raydsl_io::volume::{VolumeFile, Voxels};

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

// ANCHOR: integrators
/// Any of the integrators: WGSL has the one that is captured.
#[derive(Clone, Copy, raydsl::Type)]
enum Method {
    Euler(Euler),
    ExponentialLeft(ExponentialLeft),
    Midpoint(Midpoint),
    MeanExtinction(MeanExtinction),
    PreIntegrated(PreIntegrated),
    Adaptive(Adaptive),
    ExactCell(ExactCell),
    ShadedCell(ShadedCell),
    Labels(Labels),
}
// ANCHOR_END: integrators

impl Method {
    /// The method that is asked for; shading is full where the value changes by `edge` per length.
    fn of(args: &Args, view: &View, edge: f32) -> Self {
        let step = args.step * view.voxel;
        match args.integrator() {
            Integrator::Euler => Self::Euler(Euler::new(step)),
            Integrator::ExponentialLeft => Self::ExponentialLeft(ExponentialLeft::new(step)),
            Integrator::Midpoint => Self::Midpoint(Midpoint::new(step)),
            Integrator::MeanExtinction => Self::MeanExtinction(MeanExtinction::new(step)),
            Integrator::PreIntegrated => Self::PreIntegrated(PreIntegrated::new(step)),
            Integrator::Adaptive => Self::Adaptive(Adaptive::new(args.tol.unwrap_or(1e-3))),
            Integrator::ExactCell => Self::ExactCell(ExactCell::new()),
            Integrator::ShadedCell => Self::ShadedCell(ShadedCell::new(view.to_light(), edge)),
            Integrator::Labels => Self::Labels(Labels::new(step).lit(view.to_light(), 0.35)),
        }
    }
}

/// Where the scan is in the world, and how it is looked at.
struct View {
    middle: Vec3,
    /// Size of the box around it.
    spans: Vec3,
    /// Longest side of that box.
    extent: f32,
    /// Distance of voxels along the longest side of the grid.
    voxel: f32,
    /// Direction to the camera.
    from: Vec3,
    up: Vec3,
}

impl View {
    fn new(grid: &Grid<'_, f32>, from: Option<[f64; 3]>) -> Self {
        let (size, to_world) = (grid.size(), grid.config().to_world);
        let Mat3 { x_axis, y_axis, z_axis } = to_world.matrix3;
        let count = size.as_vec3();
        let spans = x_axis.abs() * count.x + y_axis.abs() * count.y + z_axis.abs() * count.z;
        let extent = spans.max_element();
        let sides = [(x_axis, count.x), (y_axis, count.y), (z_axis, count.z)];
        let [x, y, z] = sides.map(|(axis, count)| (axis.length() * count, axis.length()));
        let longer = |a: (f32, f32), b: (f32, f32)| if b.0 > a.0 { b } else { a };
        let (_, voxel) = longer(longer(x, y), z);
        let from = from.map_or(vec3(0.75, 1.15, 0.55), |v| Vec3::from(v.map(|x| x as f32)));
        let from = from.normalize_or(Vec3::Y);
        Self {
            middle: to_world.transform_point3((size - 1).as_vec3() * 0.5),
            spans,
            extent,
            voxel,
            from,
            up: if from.z.abs() > 0.99 { Vec3::Y } else { Vec3::Z },
        }
    }

    fn camera(&self) -> Pinhole {
        Pinhole::new(self.middle + self.from * self.extent * 2.6, self.middle, self.up, 0.42)
    }

    /// Direction to the light, from beside the camera.
    fn to_light(&self) -> Vec3 {
        let right = self.from.cross(self.up).normalize();
        (self.from + right * 0.5 + self.up * 0.5).normalize()
    }
}

/// The volume of a scan, with a line on how much of it is skipped.
fn volume<'a>(
    args: &Args,
    grid: &'a Grid<'a, f32>,
    view: &View,
) -> Result<Volume<'a, f32>, Failure> {
    let unit = args.unit.unwrap_or(view.extent / 200.0);
    let function = args.tf.function(grid.range(), unit)?;
    let start = Instant::now();
    let volume = Volume::new(grid, function);
    let empty = volume.majorants().iter().filter(|m| **m == 0.0).count();
    println!(
        "{empty} of {} macro-cells are empty, found in {:.1} ms",
        volume.majorants().len(),
        start.elapsed().as_secs_f64() * 1e3
    );
    Ok(volume)
}

/// The cuts that were asked for, or else one that shows the inside.
fn cuts(args: &Args, view: &View) -> Result<Cuts, Failure> {
    let mut cuts = Cuts::default();
    for text in &args.cut {
        cuts.add(text)?;
    }
    if args.cut.is_empty() && !args.whole {
        // A ball out of the front, and the side nearest to the camera.
        let [x, y, z] = (view.middle + view.spans * vec3(0.22, 0.3, 0.3)).to_array();
        cuts.add(&format!("sphere:{x},{y},{z},{}", view.extent * 0.3))?;
    }
    Ok(cuts)
}

fn show(args: &Args, grid: &Grid<'_, f32>) -> Result<(), Failure> {
    let (size, range) = (grid.size(), grid.range());
    println!("{} x {} x {} voxels, values from {} to {}", size.x, size.y, size.z, range.x, range.y);
    let view = View::new(grid, args.from);
    let volume = volume(args, grid, &view)?;
    let cuts = cuts(args, &view)?;
    let (away, kept) = (cuts.away.scene()?, cuts.kept.scene()?);
    let (keeps_all, cuts_nothing) = (cuts.kept.is_empty(), cuts.away.is_empty());
    let edge = (range.y - range.x) / view.voxel * 0.08;
    let method = Method::of(args, &view, edge);
    let background = vec3(0.05, 0.06, 0.08);
    // ANCHOR: kernel
    let primary = kernel!(|ray: Ray| {
        let mut light = VolumeLight::new();
        let mut inner = Cut::new(&kept, ray);
        let mut kept_part = if keeps_all { Some(ray) } else { inner.next_inside(&kept) };
        while let Some(whole) = kept_part {
            let mut outer = Cut::new(&away, whole);
            let mut part = if cuts_nothing { Some(whole) } else { outer.next_outside(&away) };
            while let Some(ray) = part {
                light = match method {
                    Method::Euler(method) => volume.integrate(&method, ray, light),
                    Method::ExponentialLeft(method) => volume.integrate(&method, ray, light),
                    Method::Midpoint(method) => volume.integrate(&method, ray, light),
                    Method::MeanExtinction(method) => volume.integrate(&method, ray, light),
                    Method::PreIntegrated(method) => volume.integrate(&method, ray, light),
                    Method::Adaptive(method) => volume.integrate(&method, ray, light),
                    Method::ExactCell(method) => volume.integrate(&method, ray, light),
                    Method::ShadedCell(method) => volume.integrate(&method, ray, light),
                    Method::Labels(method) => volume.integrate(&method, ray, light),
                };
                part = if cuts_nothing { None } else { outer.next_outside(&away) };
            }
            kept_part = if keeps_all { None } else { inner.next_inside(&kept) };
        }
        Shaded { color: light.over(background), depth: light.depth, id: 0u32 }
    });
    // ANCHOR_END: kernel
    if args.explain {
        let recording = primary.record_frame(&view.camera(), args.size);
        let table = everything::beside(args, &volume, &view, edge, recording);
        println!("{}", table.map_err(|error| Failure::Usage(error.to_string()))?);
        return Ok(());
    }

    let frames =
        Frames { size: args.size, runs: args.runs, variants: &args.variants, out: &args.out };
    frames.report(&frames.compare(&primary, &view.camera()))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_are_of_the_box_around_the_grid() {
        let size = uvec3(8, 2, 4);
        let view = |config| {
            let grid = Grid::new(vec![0.0f32; 64], size, config).expect("a grid");
            View::new(&grid, None)
        };
        // The longest side is not the one with the most voxels.
        let long = view(GridConfig::new().spacing(vec3(1.0, 1.0, 4.0)));
        assert_eq!((long.spans, long.extent, long.voxel), (vec3(8.0, 2.0, 16.0), 16.0, 4.0));
        // Turned, so that the sides along x and y are both along either.
        let matrix3 = Mat3::from_cols(vec3(0.6, 0.8, 0.0), vec3(-0.8, 0.6, 0.0), Vec3::Z);
        let turned = view(GridConfig::new().to_world(Affine3 { matrix3, translation: Vec3::ZERO }));
        let off = (turned.spans - vec3(6.4, 7.6, 4.0)).abs().max_element();
        assert!(off < 1e-5 && (turned.voxel - 1.0).abs() < 1e-6, "{}", turned.spans);
    }
}
