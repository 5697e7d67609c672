//! The same field as cells and as a structured grid: what cells cost.

use raydsl::prelude::*;
use raydsl::volume::cells::{CellData, CellGrid, CellKind, CellMesh, CellVolume};
use raydsl::volume::{ExactCell, Grid, GridConfig, Volume, VolumeLight};
use raydsl_examples::comparison::Frames;

use super::Failure;
use super::args::Args;

/// Renders a box of `side` cells along each axis both ways, and prints the tables of both.
pub(crate) fn compare(args: &Args, side: u32) -> Result<(), Failure> {
    let count = side + 1;
    let step = 1.0 / side as f32;
    let place = |i: u32| uvec3(i % count, i / count % count, i / (count * count));
    let points: Vec<Vec3> = (0..count.pow(3)).map(|i| place(i).as_vec3() * step).collect();
    let wave = |p: &Vec3| {
        let p = *p * 9.0;
        0.5 + 0.25 * (p.x.sin() * p.y.cos() + p.y.sin() * p.z.cos() + p.z.sin() * p.x.cos())
    };
    let values: Vec<f32> = points.iter().map(wave).collect();
    let mut vertices = Vec::new();
    for i in 0..side.pow(3) {
        let at = uvec3(i % side, i / side % side, i / (side * side));
        for z in [at.z, at.z + 1] {
            let ring = [(0, 0), (1, 0), (1, 1), (0, 1)];
            vertices.extend(ring.map(|(x, y)| at.x + x + count * (at.y + y + count * z)));
        }
    }
    let kinds = vec![CellKind::Hexahedron; side.pow(3) as usize];
    let mesh = CellMesh::new(&points, &vertices, &kinds)?;
    let cells = CellGrid::new(&mesh, CellData::Points(&values))?;
    let config = GridConfig::new().spacing(Vec3::splat(step));
    let grid = Grid::new(&values[..], UVec3::splat(count), config)?;
    let function = args.tf.function(grid.range(), args.unit.unwrap_or(0.2))?;
    let volume = Volume::new(&grid, function.clone());
    let cells = CellVolume::new(&cells, function);
    let exact = ExactCell::new();
    let camera = Pinhole::new(vec3(1.6, 2.4, 1.4), Vec3::splat(0.5), Vec3::Z, 0.7);
    let frames =
        Frames { size: args.size, runs: args.runs, variants: &args.variants, out: &args.out };
    let structured = kernel!(|ray: Ray| {
        let light = volume.integrate(&exact, ray, VolumeLight::new());
        Shaded { color: light.radiance, depth: light.depth, id: 0u32 }
    });
    println!("{side}^3 voxels, {} tetrahedra\n", mesh.tetrahedra().len());
    println!("structured:\n{}", frames.compare(&structured, &camera).table());
    let unstructured = kernel!(|ray: Ray| {
        let light = cells.integrate(&exact, ray, VolumeLight::new());
        Shaded { color: light.radiance, depth: light.depth, id: 0u32 }
    });
    println!("cells:\n{}", frames.compare(&unstructured, &camera).table());
    Ok(())
}
