//! Grids, cells and integrals: values at limits, and what is documented of them.

use raydsl::prelude::*;
use raydsl::volume::cells::{CellData, CellGrid, CellKind, CellMesh};
use raydsl::volume::{
    Adaptive, Grid, GridConfig, TransferFunction, VectorGrid, Volume, VolumeLight,
};
use raydsl::{assert_variants_agree, kernel};
use raydsl_tests::rng::Rng;

/// Two grids of one placement and other values are two buffers of a device.
#[test]
fn grids_of_one_layout_are_told_apart() {
    let size = uvec3(3, 4, 5);
    let values = |f: fn(f32) -> f32| (0..60u8).map(|i| f(f32::from(i))).collect::<Vec<f32>>();
    let (rising, falling) = (values(|i| i * 0.5), values(|i| 9.0 - i * i * 0.01));
    let first = Grid::new(rising, size, GridConfig::new()).expect("a grid");
    let second = Grid::new(falling, size, GridConfig::new()).expect("a grid");
    let kernel = kernel!(|p: Vec3| first.value(p) * 3.0 - second.value(p));
    let mut rng = Rng::of("grids");
    let inputs: Vec<(Vec3,)> = (0..100).map(|_| (rng.point(1.0) + 1.0,)).collect();
    assert_variants_agree!(&kernel, &inputs);
    let off = |p: Vec3| (kernel.call((p,)) - (first.value(p) * 3.0 - second.value(p))).abs();
    assert!(inputs.iter().all(|(p,)| off(*p) < 1e-5));
}

/// Between voxels whose difference is infinite there is no value.
#[test]
fn steps_too_far_apart_are_missing() {
    let now = |size: f32| {
        let grid = |value| Grid::new(vec![value; 8], uvec3(2, 2, 2), GridConfig::new());
        let (before, after) = (grid(-size).expect("a grid"), grid(size).expect("a grid"));
        let now = Grid::between(&before, &after, 0.25).expect("two steps of one layout");
        let p = vec3(0.3, 0.5, 0.7);
        (now.has_value(p), now.value(p))
    };
    assert_eq!(now(3e38), (false, 0.0));
    assert_eq!(now(2f32.powi(120)), (true, -2f32.powi(119)));
}

/// A grid of vectors has values up to its upper faces, and none behind them.
#[test]
fn grids_of_vectors_have_their_faces() {
    let place = |i: u32| uvec3(i % 2, i / 2 % 2, i / 4).as_vec3();
    let vectors: Vec<Vec3> = (0..8).map(place).collect();
    let config = GridConfig::new().spacing(vec3(1.0, 2.0, 4.0));
    let grid = VectorGrid::new(vectors, uvec3(2, 2, 2), config).expect("a grid");
    let kernel = kernel!(|p: Vec3| grid.value(p).unwrap_or(Vec3::splat(-1.0)));
    let (high, middle) = (vec3(1.0, 2.0, 4.0), vec3(0.5, 1.0, 2.0));
    let mut inputs = vec![(Vec3::ZERO,), (high,)];
    for axis in 0..3 {
        let mut p = middle;
        p[axis] = high[axis];
        assert_eq!(grid.value(p), Some(p / high), "the upper face across axis {axis}");
        inputs.push((p,));
        p[axis] = high[axis].next_up();
        assert_eq!(grid.value(p), None, "behind it");
        p[axis] = 0.0;
        assert_eq!(grid.value(p), Some(p / high), "the lower face");
        p[axis] = -f32::MIN_POSITIVE;
        assert_eq!(grid.value(p), None, "before it");
    }
    assert_variants_agree!(&kernel, &inputs);
}

/// The surface of a value is the border of what is above it: a ray that begins at the value itself
/// meets it where the value rises, and does not where it falls.
#[test]
fn rays_may_begin_at_the_surface_itself() {
    let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let mesh = CellMesh::new(&points, &[0, 1, 2, 3], &[CellKind::Tetrahedron]).expect("a mesh");
    let ray = Ray::new(vec3(0.25, 0.25, -1.0), Vec3::Z);
    let grid = |values| CellGrid::new(&mesh, values).expect("a grid");
    let rising = grid(CellData::Points(&[0.0, 0.0, 0.0, 2.0]));
    let hit = rising.first_surface(ray, 0.0).expect("above it from the face on");
    assert_eq!((hit.t, hit.gradient), (1.0, Vec3::Z * 2.0));
    let falling = grid(CellData::Points(&[2.0, 2.0, 2.0, 0.0]));
    assert_eq!(falling.first_surface(ray, 2.0), None);
    assert!(falling.first_surface(ray, 1.5).is_some());
}

/// Light of one colour only, at the end of a cell of even extinction: opacity says nothing about the
/// error of a step, and radiance does.
#[test]
fn colours_alone_make_steps_shorter() {
    let colors = [(0.85, 0.0), (0.9, 1.0), (0.95, 0.0)].map(|(v, c)| (v, Vec3::splat(c)));
    let transfer = TransferFunction::from_extinction(&colors, &[(0.0, 1.0)]).expect("a function");
    // The value goes from 0 to 1 along z, over a length of 3.
    let config = GridConfig::new().spacing(vec3(1.0, 1.0, 3.0));
    let voxels: Vec<f32> = (0..8u8).map(|i| f32::from(i / 4)).collect();
    let grid = Grid::new(voxels, uvec3(2, 2, 2), config).expect("a grid");
    let volume = Volume::new(&grid, transfer);
    let radiance = |v: f64| (1.0 - (v - 0.9).abs() / 0.05).max(0.0) * 3.0 * (-3.0 * v).exp();
    let steps = 100_000u32;
    let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(steps);
    let expected: f64 = (0..steps).map(|i| radiance(middle(i)) / f64::from(steps)).sum();
    let ray = Ray::new(vec3(0.5, 0.5, -1.0), Vec3::Z);
    for tolerance in [1e-3, 1e-4] {
        let light = volume.integrate(&Adaptive::new(tolerance), ray, VolumeLight::new());
        let off = (f64::from(light.radiance.x) - expected).abs();
        assert!(off <= 4.0 * f64::from(tolerance), "{tolerance}: off by {off} from {expected}");
    }
}
