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

/// Functions with soft and narrow peaks, steps, and opaque layers, of values from 0 to 1.
fn functions() -> [TransferFunction; 4] {
    let colors =
        [(0.0, vec3(0.1, 0.0, 0.8)), (0.4, vec3(1.0, 0.5, 0.1)), (1.0, vec3(0.3, 0.9, 0.2))];
    let soft = [(0.2, 0.0), (0.5, 0.3), (0.9, 0.8)];
    let spike = [(0.5, 0.0), (0.505, 400.0), (0.51, 0.0)];
    let step = [(0.45, 0.0), (0.45, 3.0), (0.7, 3.0), (0.7, 0.1)];
    [
        TransferFunction::new(&colors, &soft, 1.0),
        TransferFunction::from_extinction(&colors, &spike),
        TransferFunction::from_extinction(&colors, &step),
        TransferFunction::new(&colors, &[(0.3, 0.0), (0.6, 1.0)], 0.1),
    ]
    .map(|f| f.expect("a function"))
}
