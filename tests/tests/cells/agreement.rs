//! The variants of kernels over cells.

use raydsl::prelude::*;
use raydsl::volume::cells::{CellData, CellGrid, CellMesh, CellVolume};
use raydsl::volume::{ExactCell, ShadedCell, VolumeLight};
use raydsl_tests::close::assert_close;
use raydsl_tests::rng::Rng;

use super::functions;
use super::meshes::{Cells, Fill, filled, rays};

/// Smooth values of a mesh, a mesh in two parts, and one with folds and missing values.
fn meshes(rng: &mut Rng) -> Vec<(Cells, Vec<f32>)> {
    let smooth = |p: &Vec3| 0.5 + 0.5 * (p.x * 0.9).sin() * (p.y * 0.7).cos() * (p.z * 0.8).sin();
    let whole = filled(uvec3(4, 5, 4), Fill::Mixed, 0.12, rng);
    let mut parted = filled(uvec3(2, 2, 2), Fill::Mixed, 0.1, rng);
    parted.append(&filled(uvec3(2, 3, 2), Fill::Hexahedra, 0.0, rng).moved(vec3(1.0, 0.5, 3.0)));
    let mut folded = filled(uvec3(3, 3, 3), Fill::Mixed, 0.1, rng);
    let inner = folded.points.iter().position(|p| p.min_element() > 0.5 && p.max_element() < 2.5);
    folded.points[inner.expect("a point inside")] = vec3(2.4, 2.3, 2.2);
    let all = [whole, parted, folded];
    let mut all: Vec<_> = all
        .into_iter()
        .map(|cells| {
            let values: Vec<f32> = cells.points.iter().map(smooth).collect();
            (cells, values)
        })
        .collect();
    all[2].1[7] = f32::NAN;
    all
}

#[test]
fn variants_agree() {
    let mut rng = Rng::of("agreement of cells");
    for (cells, values) in meshes(&mut rng) {
        let mesh = CellMesh::new(&cells.points, &cells.vertices, &cells.kinds).expect("a mesh");
        let grid = CellGrid::new(&mesh, CellData::Points(&values)).expect("a grid");
        let inputs: Vec<(Ray,)> = rays(&cells, 300, &mut rng).into_iter().map(|r| (r,)).collect();
        let values = kernel!(|ray: Ray| {
            let (mut t, mut slope) = (-1.0, 0.0);
            if let Some(hit) = grid.first_surface(ray, 0.55) {
                t = hit.t;
                slope = length(hit.gradient);
            }
            vec4(t, slope, grid.length_inside(ray), grid.value(ray.at(7.0)).unwrap_or(-1.0))
        });
        assert_close(&values, &inputs, 1e-3);
        for transfer in functions() {
            let volume = CellVolume::new(&grid, transfer);
            let exact = ExactCell::new();
            let kernel =
                kernel!(|ray: Ray| { volume.integrate(&exact, ray, VolumeLight::new()).rgba() });
            assert_close(&kernel, &inputs, 1e-4);
            let shaded = ShadedCell::new(vec3(0.6, 0.0, 0.8), 0.3);
            let kernel =
                kernel!(|ray: Ray| { volume.integrate(&shaded, ray, VolumeLight::new()).rgba() });
            assert_close(&kernel, &inputs, 1e-3);
        }
    }
}

/// A value for each cell, and its surfaces, which are faces.
#[test]
fn variants_agree_on_values_of_cells() {
    let mut rng = Rng::of("values of cells");
    let cells = filled(uvec3(4, 3, 4), Fill::Mixed, 0.1, &mut rng);
    let mesh = CellMesh::new(&cells.points, &cells.vertices, &cells.kinds).expect("a mesh");
    let values: Vec<f32> = (0..mesh.cells()).map(|_| rng.unit()).collect();
    let grid = CellGrid::new(&mesh, CellData::Cells(&values)).expect("a grid");
    let [soft, ..] = functions();
    let volume = CellVolume::new(&grid, soft);
    let exact = ExactCell::new();
    let inputs: Vec<(Ray,)> = rays(&cells, 300, &mut rng).into_iter().map(|r| (r,)).collect();
    for (ray,) in &inputs {
        if let Some(hit) = grid.first_surface(*ray, 0.5) {
            assert!((hit.gradient.length() - 1.0).abs() < 1e-5, "{hit:?}");
        }
    }
    let kernel = kernel!(|ray: Ray| {
        let light = volume.integrate(&exact, ray, VolumeLight::new());
        let mut t = -1.0;
        if let Some(hit) = volume.grid().first_surface(ray, 0.5) {
            t = hit.t;
        }
        vec4(light.radiance.x, light.radiance.y, light.depth, t)
    });
    assert_close(&kernel, &inputs, 1e-3);
}
