//! Unstructured grids: walks without leaks, integrals against `f64`, and what is defined of meshes
//! that are none.

mod agreement;
mod defects;
mod integrals;
mod meshes;
mod oracle;
mod walks;

use raydsl::prelude::*;
use raydsl::volume::TransferFunction;
use raydsl::volume::cells::{CellData, CellGrid, CellMesh};
use raydsl_tests::close::functions;

use meshes::Cells;

/// Calls `each` with the grid of a value at each point.
fn with_grid<R>(
    cells: &Cells,
    value: impl Fn(Vec3) -> f32,
    each: impl FnOnce(&CellGrid<'_>) -> R,
) -> R {
    let mesh = CellMesh::new(&cells.points, &cells.vertices, &cells.kinds).expect("a mesh");
    let values: Vec<f32> = cells.points.iter().map(|p| value(*p)).collect();
    each(&CellGrid::new(&mesh, CellData::Points(&values)).expect("a grid"))
}

/// Extinction of 1 for every value.
fn homogeneous(extinction: f32) -> TransferFunction {
    TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, extinction)])
        .expect("a function")
}
