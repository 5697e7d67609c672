//! Degenerate inputs.

use glam::Vec3;

use super::super::BuildConfig;
use super::{Numbers, trees, trees_with};
use crate::geometry::Aabb;

const COUNT: usize = 20_000;

/// Returns the random boxes after `change`.
fn changed(change: impl Fn(Aabb) -> Aabb) -> Vec<Aabb> {
    Numbers::boxes(COUNT, 0.01).into_iter().map(change).collect()
}

fn point(p: Vec3) -> Aabb {
    Aabb::new(p, p)
}

#[test]
fn none() {
    assert!(trees(&[]).iter().all(|tree| tree.nodes.is_empty()));
}

#[test]
fn few() {
    for count in 1..20 {
        trees(&Numbers::boxes(count, 0.1));
        trees(&vec![point(Vec3::ZERO); count]);
    }
}

#[test]
fn identical() {
    for tree in trees(&vec![Numbers::boxes(1, 1.0)[0]; 1 << 16]) {
        assert_eq!(tree.nodes.len(), (1 << 15) - 1, "halved until the leaves are full");
    }
}

#[test]
fn concentric() {
    trees(&changed(|b| Aabb::new(-b.max, b.max)));
}

#[test]
fn on_a_line() {
    trees(&changed(|b| point(Vec3::new(b.min.x, 0.5, 0.25))));
    trees(&changed(|b| point(Vec3::splat(b.min.x))));
    trees(&changed(|b| Aabb::new(Vec3::ZERO.with_y(b.min.y), Vec3::ZERO.with_y(b.max.y))));
}

#[test]
fn points_on_a_line_make_a_shallow_tree() {
    // Without the lengths in `Grid::measure` all planes are equal, and the depth is the limit.
    for tree in trees(&(0..1 << 14).map(|k| point(Vec3::X * k as f32)).collect::<Vec<_>>()) {
        assert!(depth(&tree, 0) <= 16);
    }
}

fn depth(tree: &super::Tree, node: usize) -> usize {
    let node = tree.nodes[node];
    if node.is_leaf() {
        return 0;
    }
    let first = node.first as usize;
    1 + depth(tree, first).max(depth(tree, first + 1))
}

#[test]
fn on_a_plane() {
    trees(&changed(|b| Aabb::new(b.min.with_z(-3.0), b.max.with_z(-3.0))));
}

#[test]
fn one_giant() {
    for size in [1e6, 1e30, 3e38] {
        let mut boxes = Numbers::boxes(COUNT, 0.01);
        boxes[77] = Aabb::new(Vec3::splat(-size), Vec3::splat(size));
        trees(&boxes);
    }
}

#[test]
fn any_scale() {
    for scale in [1e-45, 1e-40, 1e-37, 1e-30, 1e-20, 1e20, 1e30, 1e38] {
        trees(&changed(|b| Aabb::new(b.min * scale, b.max * scale)));
        trees(&changed(|b| Aabb::new((b.min - 0.5) * scale, (b.max - 0.5) * scale)));
    }
}

#[test]
fn the_tree_does_not_depend_on_the_scale() {
    // Powers of two: the boxes are the same up to their exponents. The smaller ones and the last
    // are scaled by the builder itself.
    let expected = trees(&changed(|b| b)).map(|tree| tree.indices);
    for exponent in [-100, -70, -30, 60, 110, 126] {
        let scale = 2f32.powi(exponent);
        let found = trees(&changed(|b| Aabb::new(b.min * scale, b.max * scale)));
        assert!(found.map(|tree| tree.indices) == expected, "2^{exponent}");
    }
}

#[test]
fn the_whole_range_of_numbers() {
    let far = |b: Aabb| (b.min * 246.0 - 120.0).exp2();
    trees(&changed(|b| point(far(b))));
    trees(&changed(|b| Aabb::new(-far(b), far(b))));
    trees(&changed(|b| Aabb::new(far(b).with_y(0.0), far(b).with_y(0.0) * 1.5)));
    // Everything but one is denormal.
    let mut boxes = changed(|b| Aabb::new(b.min * 1e-38, b.max * 1e-38));
    boxes[3] = Aabb::new(Vec3::splat(f32::MIN), Vec3::splat(f32::MAX));
    trees(&boxes);
    trees(&vec![boxes[3]; 100]);
}

#[test]
fn both_zeros() {
    let zero = |k: usize| if k.is_multiple_of(2) { 0.0 } else { -0.0 };
    let boxes: Vec<_> =
        (0..100).map(|k| point(Vec3::new(zero(k), k as f32, zero(k / 2)))).collect();
    for node in trees(&boxes).iter().flat_map(|tree| &tree.nodes) {
        assert!(node.min.z.is_sign_positive() && node.max.x.is_sign_positive());
    }
}

#[test]
fn extreme_settings() {
    let boxes = Numbers::boxes(3000, 0.05);
    for max_leaf_size in [1, 2, 256] {
        for bins in [2, 3, 32] {
            for (traversal_cost, intersection_cost) in [(0.0, 1e-6), (1e6, 1e-6), (0.0, 1e6)] {
                let default = BuildConfig::default();
                let costs = BuildConfig { traversal_cost, intersection_cost, ..default };
                trees_with(&boxes, &BuildConfig { max_leaf_size, bins, ..costs });
            }
        }
    }
}
