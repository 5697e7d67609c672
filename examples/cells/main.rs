//! A field on an unstructured grid, by every variant of one kernel.
//!
//! Without an argument it makes hexahedra around a cylinder in code; with a `.vtu` it shows that.
//! It writes a picture for each variant, their differences, and a table that says whether they
//! agree.

mod args;
mod beside;
#[path = "../volume/cuts.rs"]
mod cuts;
#[path = "../volume/transfer.rs"]
mod transfer;

use std::process::ExitCode;
use std::time::Instant;

use args::{Args, Integrator};
use clap::Parser;
use cuts::Cuts;
use raydsl::prelude::*;
use raydsl::volume::cells::{CellData, CellGrid, CellKind, CellMesh, CellVolume};
use raydsl::volume::{Cut, ExactCell, ShadedCell, VolumeLight};
use raydsl_examples::cells::kind_of;
use raydsl_examples::comparison::Frames;
use raydsl_examples::ropes::ropes;
use raydsl_io::cells::CellFile;

/// Cells along the cylinder of the grid that is made in code.
const LEVELS: u32 = 48;

/// What ends the program: one line, and exit code 2.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    Load(#[from] raydsl_io::LoadError),
    #[error(transparent)]
    Cells(#[from] raydsl::volume::cells::CellError),
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
            eprintln!("cells: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), Failure> {
    if let Some(side) = args.beside {
        return beside::compare(args, side);
    }
    let file = match &args.file {
        Some(path) => raydsl_io::cells::load(path)?,
        None => ropes(LEVELS),
    };
    // ANCHOR: grid
    let kinds: Vec<CellKind> = file.kinds.iter().map(|kind| kind_of(*kind)).collect();
    let (values, is_of_cells) = values(args, &file)?;
    let start = Instant::now();
    let mesh = CellMesh::new(&file.points, &file.vertices, &kinds)?;
    let data = if is_of_cells { CellData::Cells(&values) } else { CellData::Points(&values) };
    let grid = CellGrid::new(&mesh, data)?;
    // ANCHOR_END: grid
    println!(
        "{} cells, {} tetrahedra, {} outer faces, made in {:.0} ms; values from {} to {}",
        mesh.cells(),
        mesh.tetrahedra().len(),
        mesh.faces().len(),
        start.elapsed().as_secs_f64() * 1e3,
        grid.range().x,
        grid.range().y
    );
    if file.skipped > 0 {
        println!("{} cells of other kinds are left out", file.skipped);
    }
    show(args, &grid)
}

/// The values that are shown, and whether they are of cells.
fn values(args: &Args, file: &CellFile) -> Result<(Vec<f32>, bool), Failure> {
    let found = match &args.array {
        Some(name) => file.array(name),
        None => file.scalars(),
    };
    let Some((array, is_of_cells)) = found else {
        let arrays = file.point_arrays.iter().chain(&file.cell_arrays);
        let known: Vec<String> = arrays.map(|a| format!("'{}'", a.name)).collect();
        return Err(Failure::Usage(format!("name one of the arrays: {}", known.join(", "))));
    };
    let tuples = array.values.chunks_exact(array.components);
    let size = |v: &[f32]| v.iter().map(|x| x * x).sum::<f32>().sqrt();
    let values = tuples.map(|v| if let [x] = v { *x } else { size(v) }).collect();
    Ok((values, is_of_cells))
}

/// Field of view, in radians.
const ANGLE: f32 = 0.42;

/// Where the grid is, and how it is looked at.
struct View {
    middle: Vec3,
    spans: Vec3,
    /// Longest side of the box around it.
    extent: f32,
    /// Direction to the camera.
    from: Vec3,
    up: Vec3,
}

impl View {
    fn new(grid: &CellGrid<'_>, from: Option<[f64; 3]>) -> Self {
        let bounds = grid.bounds();
        let from = from.map_or(vec3(0.55, 1.2, 0.5), |v| Vec3::from(v.map(|x| x as f32)));
        let from = from.normalize_or(Vec3::Y);
        Self {
            middle: bounds.center(),
            spans: bounds.size(),
            extent: bounds.size().max_element(),
            from,
            up: if from.z.abs() > 0.99 { Vec3::Y } else { Vec3::Z },
        }
    }

    /// A camera that sees all of the box, and little more.
    fn camera(&self) -> Pinhole {
        let right = self.from.cross(self.up).normalize();
        let across = |axis: Vec3| axis.abs().dot(self.spans);
        let wide = across(right).max(across(right.cross(self.from)));
        let far = wide * 0.5 / (ANGLE * 0.5).tan() + across(self.from) * 0.35;
        Pinhole::new(self.middle + self.from * far, self.middle, self.up, ANGLE)
    }

    /// Direction to the light, from beside the camera.
    fn to_light(&self) -> Vec3 {
        let right = self.from.cross(self.up).normalize();
        (self.from + right * 0.5 + self.up * 0.5).normalize()
    }
}

/// What is cut away by the arguments, or by default.
fn cuts(args: &Args, view: &View) -> Result<Cuts, Failure> {
    let mut cuts = Cuts::default();
    for text in &args.cut {
        cuts.add(text)?;
    }
    if args.cut.is_empty() && !args.whole && args.file.is_none() {
        // A ball out of the front of the made grid.
        let [x, y, z] = (view.middle + view.spans * vec3(0.2, 0.36, 0.16)).to_array();
        cuts.add(&format!("sphere:{x},{y},{z},{}", view.extent * 0.26))?;
    }
    Ok(cuts)
}

// ANCHOR: integrators
/// Either of the integrators: WGSL has the one that is captured.
#[derive(Clone, Copy, raydsl::Type)]
enum Method {
    Exact(ExactCell),
    Shaded(ShadedCell),
}
// ANCHOR_END: integrators

fn show(args: &Args, grid: &CellGrid<'_>) -> Result<(), Failure> {
    let (view, range) = (View::new(grid, args.from), grid.range());
    let unit = args.unit.unwrap_or(view.extent / 20.0);
    let volume = CellVolume::new(grid, args.tf.function(range, unit)?);
    let cuts = cuts(args, &view)?;
    let (away, kept) = (cuts.away.scene()?, cuts.kept.scene()?);
    let keeps_all = cuts.kept.is_empty();
    let to_light = view.to_light();
    let edge = (range.y - range.x) / view.extent;
    let method = match args.integrator {
        Integrator::ExactCell => Method::Exact(ExactCell::new()),
        Integrator::ShadedCell => Method::Shaded(ShadedCell::new(to_light, edge)),
    };
    let (has_surface, value) = (args.iso.is_some(), args.iso.unwrap_or(0.0));
    let color = vec3(0.35, 0.6, 0.75);
    let (above, below) = (vec3(0.17, 0.19, 0.24), vec3(0.03, 0.035, 0.045));
    // ANCHOR: kernel
    let primary = kernel!(|ray: Ray| {
        let mut light = VolumeLight::new();
        let mut background = below + (above - below) * (0.5 + 0.5 * ray.direction.z);
        let mut is_over = false;
        let mut inner = Cut::new(&kept, ray);
        let mut kept_part = if keeps_all { Some(ray) } else { inner.next_inside(&kept) };
        while let Some(whole) = kept_part {
            let mut outer = Cut::new(&away, whole);
            while let Some(part) = outer.next_outside(&away)
                && !is_over
            {
                let mut seen = part;
                if has_surface && let Some(hit) = volume.grid().first_surface(part, value) {
                    // What is behind the surface is not seen.
                    let cosine =
                        hit.gradient.dot(to_light).abs() / max(length(hit.gradient), 1e-30);
                    background = color * (0.25 + 0.75 * min(cosine, 1.0));
                    seen = part.with_range(part.t_min, hit.t);
                    is_over = true;
                }
                light = match method {
                    Method::Exact(method) => volume.integrate(&method, seen, light),
                    Method::Shaded(method) => volume.integrate(&method, seen, light),
                };
            }
            kept_part = if keeps_all || is_over { None } else { inner.next_inside(&kept) };
        }
        Shaded { color: light.over(background), depth: light.depth, id: 0u32 }
    });
    // ANCHOR_END: kernel

    let frames =
        Frames { size: args.size, runs: args.runs, variants: &args.variants, out: &args.out };
    frames.report(&frames.compare(&primary, &view.camera()))?;
    Ok(())
}
