//! Rejected inputs.

use glam::Vec3;

use super::super::{BuildConfig, BuildError, MAX_PRIMITIVES, build};
use super::Numbers;
use crate::geometry::{
    Aabb, cone, cuboid, cylinder, disk, quad, rectangle, sphere, triangle, tube,
};

/// Returns the error for 40,000 random boxes (several pieces of work) with some replaced.
fn error_with(replaced: &[(usize, Aabb)]) -> BuildError {
    let mut boxes = Numbers::boxes(40_000, 0.1);
    for &(index, bounds) in replaced {
        boxes[index] = bounds;
    }
    build(|k| boxes[k], boxes.len(), &BuildConfig::default()).expect_err("a box is invalid")
}

#[test]
fn invalid_boxes_are_named() {
    let one = Aabb::new(Vec3::ZERO, Vec3::ONE);
    let nan = Aabb { min: Vec3::new(0.0, f32::NAN, 0.0), ..one };
    let infinite = Aabb { max: Vec3::new(1.0, 1.0, f32::INFINITY), ..one };
    let inverted = Aabb { min: Vec3::new(2.0, 0.0, 0.0), ..one };
    assert_eq!(error_with(&[(3, nan)]), BuildError::NanBounds { index: 3 });
    assert_eq!(error_with(&[(39_999, infinite)]), BuildError::InfiniteBounds { index: 39_999 });
    assert_eq!(error_with(&[(20_000, inverted)]), BuildError::InvertedBounds { index: 20_000 });
    assert_eq!(error_with(&[(0, Aabb::EMPTY)]), BuildError::InvertedBounds { index: 0 });
    let all = [(30_000, nan), (17_000, infinite), (17_001, inverted)];
    assert_eq!(error_with(&all), BuildError::InfiniteBounds { index: 17_000 });
}

/// Whichever of the points it is.
#[test]
fn a_box_keeps_a_nan_of_its_points() {
    for i in 0..3 {
        let mut points = [Vec3::ZERO, Vec3::ONE, Vec3::NEG_ONE];
        points[i].y = f32::NAN;
        let bounds = Aabb::from_points(points);
        assert!(bounds.min.y.is_nan() && bounds.max.y.is_nan(), "{bounds:?}");
        assert_eq!(error_with(&[(7, bounds)]), BuildError::NanBounds { index: 7 });
    }
}

/// The bounds of a shape with these numbers, of which each in turn is a NaN.
fn check_numbers<const N: usize>(name: &str, bounds: impl Fn([f32; N]) -> Aabb) {
    let numbers: [f32; N] = core::array::from_fn(|i| (i * i + 1) as f32);
    assert!(bounds(numbers).is_valid(), "{name}");
    for i in 0..N {
        let mut numbers = numbers;
        numbers[i] = f32::NAN;
        assert!(!bounds(numbers).is_valid(), "{name}, number {i}: {:?}", bounds(numbers));
    }
}

#[test]
fn a_nan_in_a_shape_is_in_its_box() {
    let at = Vec3::from_slice;
    check_numbers("sphere", |n: [f32; 4]| sphere::get_bounds(at(&n), n[3]));
    check_numbers("cuboid", |n: [f32; 6]| cuboid::get_bounds(at(&n), at(&n[3..])));
    check_numbers("disk", |n: [f32; 7]| disk::get_bounds(at(&n), at(&n[3..]), n[6]));
    check_numbers("cylinder", |n: [f32; 7]| cylinder::get_bounds(at(&n), at(&n[3..]), n[6]));
    check_numbers("tube", |n: [f32; 7]| tube::get_bounds(at(&n), at(&n[3..]), n[6]));
    check_numbers("cone", |n: [f32; 7]| cone::get_bounds(at(&n), at(&n[3..]), n[6]));
    check_numbers("rectangle", |n: [f32; 9]| {
        rectangle::get_bounds(at(&n), at(&n[3..]), at(&n[6..]))
    });
    check_numbers("triangle", |n: [f32; 9]| triangle::get_bounds(at(&n), at(&n[3..]), at(&n[6..])));
    check_numbers("quad", |n: [f32; 12]| {
        quad::get_bounds(at(&n), at(&n[3..]), at(&n[6..]), at(&n[9..]))
    });
}

#[test]
fn too_many_primitives() {
    let none = |_| -> Aabb { unreachable!("refused before any box is read") };
    let error = build(none, MAX_PRIMITIVES + 1, &BuildConfig::default()).expect_err("too many");
    assert_eq!(
        error.to_string(),
        "1073741825 primitives are too many for one tree: split them into trees of at most 1073741824"
    );
}

#[test]
fn settings_out_of_range() {
    let default = BuildConfig::default();
    let bad = [
        ("max_leaf_size", BuildConfig { max_leaf_size: 0, ..default }),
        ("max_leaf_size", BuildConfig { max_leaf_size: 257, ..default }),
        ("bins", BuildConfig { bins: 1, ..default }),
        ("bins", BuildConfig { bins: 33, ..default }),
        ("traversal_cost", BuildConfig { traversal_cost: -1.0, ..default }),
        ("traversal_cost", BuildConfig { traversal_cost: f32::NAN, ..default }),
        ("intersection_cost", BuildConfig { intersection_cost: 0.0, ..default }),
        ("intersection_cost", BuildConfig { intersection_cost: f32::INFINITY, ..default }),
        ("max_duplication", BuildConfig { max_duplication: -0.1, ..default }),
        ("max_duplication", BuildConfig { max_duplication: f32::NAN, ..default }),
        ("min_overlap", BuildConfig { min_overlap: 1.5, ..default }),
    ];
    for (name, config) in bad {
        let error = build(|_| Aabb::EMPTY, 0, &config).expect_err("out of range");
        assert!(matches!(error, BuildError::InvalidConfig { field, .. } if field == name));
    }
    let error = build(|_| Aabb::EMPTY, 0, &BuildConfig { bins: 1, ..default }).expect_err("bins");
    assert_eq!(error.to_string(), "BuildConfig::bins is 1: choose a value in 2..=32");
}
