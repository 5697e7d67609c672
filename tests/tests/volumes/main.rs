//! Volumes: grids against an oracle in `f64`, integrals against closed forms, in every variant.

#![allow(clippy::excessive_precision, reason = "closed forms are written as they were computed")]

mod agreement;
mod closed_forms;
mod cuts;
mod edit;
mod fields;
mod labels;
mod oracle;
mod orders;
mod stiff;
mod surfaces;
mod tracking;
mod transfer;
mod two_dimensional;

#[path = "../../../examples/report/volumes.rs"]
mod cases;

use raydsl::prelude::*;
use raydsl::volume::{Grid, GridConfig, TransferFunction, Volume};

/// Grid of one cell across and `count` along z, `depth` deep in all, whose values run over
/// `values`.
fn column(count: u32, depth: f32, value: impl Fn(f32) -> f32) -> Grid<'static, f32> {
    let size = uvec3(2, 2, count + 1);
    let voxels: Vec<f32> = (0..size.z).flat_map(|z| [value(z as f32 / count as f32); 4]).collect();
    let config = GridConfig::new().spacing(vec3(1.0, 1.0, depth / count as f32));
    Grid::new(voxels, size, config).expect("a small grid")
}

/// The ray along the middle of a column.
fn along() -> Ray {
    Ray::new(vec3(0.5, 0.5, -1.0), Vec3::Z)
}

/// Extinction `scale` times the value, and colours over the values from 0 to 1.
fn linear(scale: f32, from: f32, to: f32) -> TransferFunction {
    let colors = [(0.0, Vec3::splat(from)), (1.0, Vec3::splat(to))];
    TransferFunction::from_extinction(&colors, &[(0.0, 0.0), (1.0, scale)]).expect("a function")
}

fn volume<'a>(grid: &'a Grid<'a, f32>, transfer: TransferFunction) -> Volume<'a, f32> {
    Volume::new(grid, transfer)
}
