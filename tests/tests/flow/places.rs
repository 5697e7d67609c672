//! Fields on grids and cells at single places.

use glam::DVec3;
use raydsl::flow::{FlowEnd, FlowState, Ways, trace};
use raydsl::prelude::*;
use raydsl::volume::cells::{CellError, CellKind, CellMesh, CellVectors};
use raydsl::volume::{Centering, Grid, GridConfig, VectorGrid};
use raydsl_tests::rng::Rng;

use super::{follow, settings};

/// A grid of vectors is three grids of numbers, in which it is inside.
#[test]
fn vectors_are_three_numbers() {
    let mut rng = Rng::of("three grids");
    for (size, centering) in [
        (uvec3(5, 4, 3), Centering::Vertex),
        (uvec3(3, 5, 4), Centering::Cell),
        (uvec3(6, 1, 2), Centering::Vertex),
    ] {
        let count = (size.x * size.y * size.z) as usize;
        let vectors: Vec<Vec3> = (0..count).map(|_| rng.point(2.0)).collect();
        let turn = Mat3::from_rotation_z(0.4) * Mat3::from_diagonal(vec3(0.5, 1.5, 1.0));
        let config = GridConfig::new()
            .to_world(Affine3 { matrix3: turn, translation: vec3(1.0, -2.0, 0.5) })
            .centering(centering)
            .rescale(2.0, 0.25);
        let grid = VectorGrid::new(&vectors[..], size, config).expect("a grid");
        let parts = [0, 1, 2].map(|axis| {
            let numbers: Vec<f32> = vectors.iter().map(|v| v[axis]).collect();
            Grid::new(numbers, size, config).expect("a grid")
        });
        let half = if centering == Centering::Cell { 0.5 } else { 0.0 };
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..2000 {
            let voxel = rng.point(0.8) * size.as_vec3() + size.as_vec3() * 0.5 - 0.5;
            let voxel =
                if size.y == 1 && rng.unit() < 0.5 { vec3(voxel.x, 0.0, voxel.z) } else { voxel };
            let p = config.to_world.transform_point3(voxel);
            let last = (size - UVec3::ONE).as_vec3();
            let margin = (voxel + half).min_element().min((last + half - voxel).min_element());
            if margin.abs() < 1e-5 && size.y != 1 {
                continue;
            }
            match grid.value(p) {
                Some(found) => {
                    let expected = Vec3::from(parts.each_ref().map(|part| part.value(p)));
                    assert!(found.distance(expected) < 1e-5, "{p}: {found}, not {expected}");
                    assert!(margin > -1e-5, "{voxel}");
                    inside += 1;
                }
                None => {
                    assert!(margin < 1e-5, "{voxel} of {size}");
                    outside += 1;
                }
            }
        }
        assert!(inside > 100 || size.y == 1 && inside > 0, "{inside}");
        assert!(outside > 100, "{outside}");
    }
}

#[test]
fn places_without_a_value() {
    let mut vectors = vec![Vec3::X; 27];
    vectors[26] = vec3(0.0, f32::INFINITY, 0.0);
    let grid = VectorGrid::new(&vectors[..], uvec3(3, 3, 3), GridConfig::new()).expect("a grid");
    assert_eq!(grid.value(vec3(0.5, 0.5, 0.5)), Some(Vec3::X));
    assert_eq!(grid.value(vec3(1.5, 1.5, 1.5)), None);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e38, -1e38] {
        assert_eq!(grid.value(vec3(1.0, bad, 1.0)), None, "{bad}");
    }
    assert!(VectorGrid::new(&vectors[..], uvec3(3, 3, 2), GridConfig::new()).is_err());
}

/// Hexahedra over moved points, so many along each axis, with no overlap.
fn hexahedra(side: u32, moved: f32, rng: &mut Rng) -> (Vec<Vec3>, Vec<u32>) {
    let count = side + 1;
    let place = |i: u32| uvec3(i % count, i / count % count, i / (count * count));
    let inner = |p: UVec3| p.min_element() > 0 && p.max_element() < side;
    let points = (0..count.pow(3))
        .map(|i| {
            let p = place(i);
            p.as_vec3() + if inner(p) { rng.point(moved) } else { Vec3::ZERO }
        })
        .collect();
    let mut vertices = Vec::new();
    for i in 0..side.pow(3) {
        let at = uvec3(i % side, i / side % side, i / (side * side));
        for z in [at.z, at.z + 1] {
            let ring = [(0, 0), (1, 0), (1, 1), (0, 1)];
            vertices.extend(ring.map(|(x, y)| at.x + x + count * (at.y + y + count * z)));
        }
    }
    (points, vertices)
}

/// The linear interpolant in `f64`, of the tetrahedron that has the point farthest inside.
fn interpolated(mesh: &CellMesh<'_>, vectors: &[Vec3], p: DVec3) -> (f64, DVec3) {
    let of = |t: &raydsl::volume::cells::Tetrahedron| {
        let ids = t.vertices.to_array();
        let q = ids.map(|i| mesh.points()[i as usize].as_dvec3());
        let volume = |q: [DVec3; 4]| (q[1] - q[0]).cross(q[2] - q[0]).dot(q[3] - q[0]);
        let weights = [0, 1, 2, 3].map(|i| {
            let mut with = q;
            with[i] = p;
            volume(with) / volume(q)
        });
        let sum = (0..4).map(|i| weights[i] * vectors[ids[i] as usize].as_dvec3()).sum();
        (weights.into_iter().fold(f64::INFINITY, f64::min), sum)
    };
    let all = mesh.tetrahedra().iter().map(of);
    all.max_by(|a, b| a.0.total_cmp(&b.0)).expect("a tetrahedron")
}

/// No place inside is lost, at faces, edges and vertices neither, and values are linear.
#[test]
fn cells_have_a_value_everywhere_inside() {
    let mut rng = Rng::of("places in cells");
    for (scale, offset) in
        [(1.0, Vec3::ZERO), (1e-9, Vec3::ZERO), (1e9, Vec3::ZERO), (1.0, vec3(500.0, 0.0, -800.0))]
    {
        let (mut points, vertices) = hexahedra(5, 0.3, &mut rng);
        points.iter_mut().for_each(|p| *p = *p * scale + offset);
        let mesh = CellMesh::new(&points, &vertices, &[CellKind::Hexahedron; 125]).expect("a mesh");
        let vectors: Vec<Vec3> = points.iter().map(|_| rng.point(1.0)).collect();
        let field = CellVectors::new(&mesh, &vectors).expect("a field");
        let any = |rng: &mut Rng| points[rng.below(points.len())];
        for i in 0..3000 {
            let p = match i % 4 {
                0 => any(&mut rng),
                // In the middle of an edge, and on a face.
                1 | 2 => {
                    let t = mesh.tetrahedra()[rng.below(mesh.tetrahedra().len())];
                    let v = t.vertices.to_array().map(|i| points[i as usize]);
                    if i % 4 == 1 { (v[0] + v[1]) * 0.5 } else { (v[1] + v[2] + v[3]) / 3.0 }
                }
                _ => (rng.point(2.499) + 2.5) * scale + offset,
            };
            let (least, expected) = interpolated(&mesh, &vectors, p.as_dvec3());
            assert!(least > -1e-4, "the test's own points are inside: {least}");
            let found = field.value(p);
            let Some(found) = found else { panic!("{p} is lost, {least}") };
            let off = found.as_dvec3().distance(expected);
            let bound = if offset == Vec3::ZERO { 1e-5 } else { 2e-3 };
            assert!(off < bound, "{p}: {found}, not {expected}, off by {off:e}");
        }
        // Outside is nothing, but for a few thousandths of a cell.
        for _ in 0..1000 {
            let mut p = rng.point(4.0);
            let axis = rng.below(3);
            p[axis] = p[axis].signum() * rng.range(2.51, 9.0);
            assert_eq!(field.value((p + 2.5) * scale + offset), None, "{p}");
        }
    }
}

/// A linear field is linear in every cell: the line is that of the closed form.
#[test]
fn lines_through_cells() {
    let mut rng = Rng::of("a vortex in cells");
    let (points, vertices) = hexahedra(6, 0.3, &mut rng);
    let mesh = CellMesh::new(&points, &vertices, &[CellKind::Hexahedron; 216]).expect("a mesh");
    let vectors: Vec<Vec3> = points.iter().map(|p| vec3(3.0 - p.y, p.x - 3.0, 0.25)).collect();
    let field = CellVectors::new(&mesh, &vectors).expect("a field");
    let settings = settings(1e-5, 1.0).max_time(8.0).expect("a time");
    let kernel = kernel!(|state: FlowState| trace(|p: Vec3| field.value(p), state, settings));
    let lines = follow(&kernel, &[vec3(5.0, 3.0, 0.5), vec3(5.9, 5.9, 1.0)], Ways::Forwards);
    let last = lines[0].points().last().expect("a point");
    assert_eq!(lines[0].end(), FlowEnd::Time);
    let (sin, cos) = 8f32.sin_cos();
    assert!(last.at.distance(vec3(3.0 + 2.0 * cos, 3.0 + 2.0 * sin, 2.5)) < 1e-4, "{last:?}");
    // The other one leaves the box.
    assert_eq!(lines[1].end(), FlowEnd::Left);
    let last = lines[1].points().last().expect("a point");
    assert!((last.at.y - 6.0).abs() < 1e-3 || last.at.x.abs() < 1e-3, "{last:?}");
}

#[test]
fn vectors_are_counted() {
    let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let mesh = CellMesh::new(&points, &[0, 1, 2, 3], &[CellKind::Tetrahedron]).expect("a mesh");
    let error = CellVectors::new(&mesh, &[Vec3::X]).map(|_| ()).expect_err("too few");
    assert_eq!(error, CellError::Values { of: "points", expected: 4, found: 1 });
    // No cell, and a flat one: nowhere is a value.
    let none = CellMesh::new(&points, &[], &[]).expect("a mesh");
    let field = CellVectors::new(&none, &points).expect("a field");
    assert_eq!(field.value(Vec3::ZERO), None);
    let flat = [Vec3::ZERO, Vec3::X, Vec3::Y, vec3(1.0, 1.0, 0.0)];
    let mesh = CellMesh::new(&flat, &[0, 1, 2, 3], &[CellKind::Tetrahedron]).expect("a mesh");
    let field = CellVectors::new(&mesh, &points).expect("a field");
    assert_eq!(field.value(vec3(0.25, 0.25, 0.0)), None);
    // A vector that is no number.
    let mesh = CellMesh::new(&points, &[0, 1, 2, 3], &[CellKind::Tetrahedron]).expect("a mesh");
    let vectors = [Vec3::X, Vec3::X, Vec3::X, Vec3::NAN];
    let field = CellVectors::new(&mesh, &vectors).expect("a field");
    assert_eq!(field.value(vec3(0.25, 0.25, 0.25)), None);
    for bad in [f32::NAN, f32::INFINITY, 1e38] {
        assert_eq!(field.value(vec3(0.1, bad, 0.1)), None, "{bad}");
    }
}
