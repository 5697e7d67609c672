//! Random boxes of all kinds.

use glam::Vec3;
use proptest::collection::vec;
use proptest::prelude::*;

use super::super::BuildConfig;
use super::{trees, trees_with};
use crate::geometry::Aabb;

/// Coordinates of one kind: smooth, on a coarse lattice (many coincide), of any magnitude, or any
/// finite number at all.
fn coordinate() -> impl Strategy<Value = BoxedStrategy<f32>> {
    prop_oneof![
        Just((-1.0f32..1.0).boxed()),
        Just((-2i8..=2).prop_map(f32::from).boxed()),
        Just((-126i32..127, any::<bool>()).prop_map(|(e, s)| signed(2f32.powi(e), s)).boxed()),
        Just(any::<f32>().prop_filter("finite", |x| x.is_finite()).boxed()),
        Just(Just(0.5f32).boxed()),
    ]
}

fn signed(x: f32, negative: bool) -> f32 {
    if negative { -x } else { x }
}

/// Boxes whose axes are each of one kind; some are points.
fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
    (coordinate(), coordinate(), coordinate()).prop_flat_map(|(x, y, z)| {
        let point = (x, y, z).prop_map(Vec3::from).boxed();
        let pair = (point.clone(), point.clone()).prop_map(|(a, b)| Aabb::from_points([a, b]));
        vec(prop_oneof![pair, point.prop_map(|p| Aabb::new(p, p))], 0..300)
    })
}

fn config() -> impl Strategy<Value = BuildConfig> {
    (1u32..=9, 2u32..=32, 0.0f32..4.0, 0.1f32..4.0).prop_map(
        |(max_leaf_size, bins, traversal_cost, intersection_cost)| BuildConfig {
            max_leaf_size,
            bins,
            traversal_cost,
            intersection_cost,
            ..BuildConfig::default()
        },
    )
}

proptest! {
    #[test]
    fn every_tree_is_sound(boxes in boxes(), config in config()) {
        trees_with(&boxes, &config);
    }
}

#[test]
fn a_split_pays() {
    // Two groups far apart: the root must separate them.
    let at = |x: f32| Aabb::new(Vec3::splat(x), Vec3::splat(x + 1.0));
    let boxes: Vec<_> = (0..8).map(|k| at(if k % 2 == 0 { 0.0 } else { 100.0 })).collect();
    for tree in trees(&boxes) {
        assert_eq!(tree.nodes.len(), 3);
        assert_eq!(tree.nodes[1].bounds(), at(0.0));
        assert_eq!(tree.nodes[2].bounds(), at(100.0));
    }
}
