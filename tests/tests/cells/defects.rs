//! Meshes with gaps, folds and other defects, whose results are defined all the same.

use raydsl::prelude::*;
use raydsl::volume::cells::{
    CellData, CellError, CellGrid, CellKind, CellMesh, CellVolume, MAX_COORDINATE,
};
use raydsl::volume::{ExactCell, VolumeLight};
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

use super::meshes::{Cells, Fill, filled, rays};
use super::{functions, homogeneous, with_grid};

fn cube(at: Vec3) -> Cells {
    filled(UVec3::splat(2), Fill::Mixed, 0.1, &mut Rng::of("cube")).moved(at)
}

/// Two boxes apart, touching without a common point, and overlapping.
#[test]
fn gaps_are_empty() {
    let along = Ray::new(vec3(0.9, 1.1, -3.0), Vec3::Z);
    for (at, expected) in [(5.0, 4.0), (2.0, 4.0), (1.0, 3.0), (0.0, 2.0)] {
        let mut cells = cube(Vec3::ZERO);
        cells.append(&cube(vec3(0.0, 0.0, at)));
        with_grid(
            &cells,
            |_| 1.0,
            |grid| {
                let length = grid.length_inside(along);
                assert!((length - expected).abs() < 1e-5, "{at}: {length}");
                let volume = CellVolume::new(grid, homogeneous(0.3));
                let light = volume.integrate(&ExactCell::new(), along, VolumeLight::new());
                assert!((light.depth - 0.3 * expected).abs() < 1e-5, "{at}: {}", light.depth);
                let back = Ray::new(vec3(0.9, 1.1, 12.0), -Vec3::Z);
                assert!((grid.length_inside(back) - expected).abs() < 1e-5);
            },
        );
    }
}

/// A ray leaves a concave mesh and enters it again.
#[test]
fn concave_meshes_are_entered_again() {
    let mut cells = filled(uvec3(3, 1, 2), Fill::Hexahedra, 0.0, &mut Rng::of("concave"));
    // Without the upper cell in the middle.
    let (middle, mut rest) = (vec3(1.5, 0.5, 1.5), &cells.vertices[..]);
    let mut notched = Cells { points: cells.points.clone(), ..Cells::default() };
    for kind in &cells.kinds {
        let (own, others) = rest.split_at(kind.vertices());
        rest = others;
        let sum: Vec3 = own.iter().map(|i| cells.points[*i as usize]).sum();
        if sum / own.len() as f32 != middle {
            notched.push(*kind, own);
        }
    }
    cells = notched;
    assert_eq!(cells.kinds.len(), 5);
    with_grid(
        &cells,
        |_| 1.0,
        |grid| {
            assert_eq!(grid.length_inside(Ray::new(vec3(-1.0, 0.4, 1.5), Vec3::X)), 2.0);
            assert_eq!(grid.length_inside(Ray::new(vec3(-1.0, 0.4, 0.5), Vec3::X)), 3.0);
            assert_eq!(grid.value(middle), None);
        },
    );
}

/// Cells may be given either way round, twice, and without a volume.
#[test]
fn orientation_does_not_matter() {
    let mut rng = Rng::of("orientation");
    let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, vec3(0.3, 0.3, 0.0), vec3(0.4, 0.4, -1.0)];
    let mut plain = Cells { points: points.to_vec(), ..Cells::default() };
    let kind = CellKind::Tetrahedron;
    for base in [[0, 1], [1, 2], [2, 0]] {
        plain.push(kind, &[base[0], base[1], 4, 3]);
        plain.push(kind, &[base[0], base[1], 4, 5]);
    }
    let mut odd = plain.clone();
    odd.vertices.chunks_mut(4).step_by(2).for_each(|own| own.swap(0, 1));
    odd.push(kind, &[3, 1, 0, 4]);
    // Flat ones beside two: between the points 0, 1, 2 and 4 there is no space.
    odd.push(kind, &[0, 1, 1, 2]);
    for ray in rays(&plain, scaled(500), &mut rng) {
        let length = with_grid(&plain, |_| 1.0, |grid| grid.length_inside(ray));
        let found = with_grid(&odd, |_| 1.0, |grid| grid.length_inside(ray));
        assert!((found - length).abs() < 1e-6, "{ray:?}: {found}, {length}");
    }
}

/// A vertex that is moved through its cells folds them over one another: no length is negative,
/// none counts twice, and opacity is at most 1.
#[test]
fn folded_cells_are_defined() {
    let mut rng = Rng::of("folded");
    for _ in 0..20 {
        let mut cells = filled(UVec3::splat(3), Fill::Mixed, 0.1, &mut rng);
        let inner = |p: &Vec3| p.min_element() > 0.3 && p.max_element() < 2.7;
        let first = cells.points.iter().position(inner).expect("a point inside");
        cells.points[first] = rng.point(1.0) + 1.5;
        with_grid(
            &cells,
            |p| p.x / 3.0,
            |grid| {
                for ray in rays(&cells, 200, &mut rng) {
                    let (length, is_along) = super::walks::in_box(Vec3::splat(3.0), ray);
                    let found = f64::from(grid.length_inside(ray));
                    assert!(
                        (found - length).abs() < 1e-5 || is_along,
                        "{ray:?}: {found}, {length}"
                    );
                }
                for transfer in functions() {
                    let volume = CellVolume::new(grid, transfer);
                    for ray in rays(&cells, 50, &mut rng) {
                        let light = volume.integrate(&ExactCell::new(), ray, VolumeLight::new());
                        assert!((0.0..=1.0).contains(&light.opacity()), "{light:?}");
                        let most = light.radiance.max_element();
                        assert!(most <= light.opacity() * (1.0 + 2e-6), "{light:?}");
                    }
                }
            },
        );
    }
}

/// Cells at random among random points: everything ends, and is finite.
#[test]
fn nonsense_ends() {
    let mut rng = Rng::of("nonsense");
    for round in 0..scaled(100) {
        let mut cells = Cells::default();
        let count = 4 + rng.below(12);
        cells.points.extend((0..count).map(|_| (rng.point(4.0)).round()));
        for _ in 0..rng.below(40) {
            let kind = rng.pick(&[
                CellKind::Tetrahedron,
                CellKind::Pyramid,
                CellKind::Wedge,
                CellKind::Hexahedron,
            ]);
            let own: Vec<u32> = (0..kind.vertices()).map(|_| rng.below(count) as u32).collect();
            cells.push(kind, &own);
        }
        if cells.kinds.is_empty() {
            continue;
        }
        with_grid(
            &cells,
            |p| p.x.sin().abs(),
            |grid| {
                let volume = CellVolume::new(grid, functions()[round % 4].clone());
                for ray in rays(&cells, 64, &mut rng) {
                    let length = grid.length_inside(ray);
                    assert!((0.0..=20.0).contains(&length), "{length}");
                    let light = volume.integrate(&ExactCell::new(), ray, VolumeLight::new());
                    assert!((0.0..=1.0).contains(&light.opacity()), "{light:?}");
                }
            },
        );
    }
}

/// Points with the values that are none make gaps of their cells.
#[test]
fn missing_values_are_gaps() {
    let cells = filled(uvec3(1, 1, 4), Fill::Hexahedra, 0.0, &mut Rng::of("missing"));
    let value = |p: Vec3| if p.z == 2.0 { f32::NAN } else { p.z };
    let ray = Ray::new(vec3(0.3, 0.6, -1.0), Vec3::Z);
    with_grid(&cells, value, |grid| {
        assert_eq!(grid.range(), vec2(0.0, 4.0));
        assert!((grid.length_inside(ray) - 2.0).abs() < 1e-6);
        assert_eq!(grid.value(vec3(0.3, 0.6, 2.5)), None);
        assert_eq!(grid.value(vec3(0.3, 0.6, 0.5)), Some(0.5));
        let volume = CellVolume::new(grid, homogeneous(0.5));
        let light = volume.integrate(&ExactCell::new(), ray, VolumeLight::new());
        assert!((light.depth - 1.0).abs() < 1e-6, "{}", light.depth);
        assert!(grid.first_surface(ray, 2.2).is_none());
    });
}

#[test]
fn errors_say_what_and_where() {
    let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let kinds = [CellKind::Tetrahedron];
    for bad in [f32::NAN, f32::INFINITY, 2e12] {
        let mut points = points;
        points[2].y = bad;
        let error = CellMesh::new(&points, &[0, 1, 2, 3], &kinds).expect_err("a bad point");
        assert!(
            matches!(error, CellError::Point { index: 2, limit: MAX_COORDINATE, .. }),
            "{error}"
        );
    }
    let error = CellMesh::new(&points, &[0, 1, 2, 4], &kinds).expect_err("no such point");
    assert_eq!(error, CellError::Index { cell: 0, index: 4, points: 4 });
    let error = CellMesh::new(&points, &[0, 1, 2], &kinds).expect_err("too few vertices");
    assert_eq!(error, CellError::Vertices { expected: 4, found: 3 });
    let mesh = CellMesh::new(&points, &[0, 1, 2, 3], &kinds).expect("a mesh");
    let error = CellGrid::new(&mesh, CellData::Points(&[1.0])).expect_err("too few values");
    assert_eq!(error, CellError::Values { of: "points", expected: 4, found: 1 });
    let error = CellGrid::new(&mesh, CellData::Cells(&[])).expect_err("no values");
    assert_eq!(error, CellError::Values { of: "cells", expected: 1, found: 0 });
}

#[test]
fn empty_meshes_are_never_hit() {
    let points = [Vec3::ZERO];
    let mesh = CellMesh::new(&points, &[], &[]).expect("an empty mesh");
    let grid = CellGrid::new(&mesh, CellData::Points(&[1.0])).expect("a grid");
    let ray = Ray::new(vec3(0.0, 0.0, -1.0), Vec3::Z);
    assert_eq!(grid.length_inside(ray), 0.0);
    assert_eq!(grid.value(Vec3::ZERO), None);
    let volume = CellVolume::new(&grid, homogeneous(1.0));
    let light = volume.integrate(&ExactCell::new(), ray, VolumeLight::new());
    assert_eq!(light, VolumeLight::new());
}
