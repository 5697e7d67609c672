//! Boxes of compressed nodes hold those of the tree, and a walk finds the hits.

use glam::Vec3;

use super::{Compressed, CompressedNode, Grid};
use crate::bvh::wide::node::{Child, WIDTH};
use crate::bvh::{BuildConfig, BuildQuality, Bvh, BvhList, RecordQuery, buffers, nearest_counted};
use crate::geometry::{Aabb, Ray, SharedStore, Triangle};
use crate::machine::bytes_of;

/// Returns a pseudo-random number from 0 to 1.
fn random(i: u32, k: u32) -> f32 {
    ((i * 31 + k).wrapping_mul(0x9e37_79b9) >> 8) as f32 / 16_777_216.0
}

fn point(i: u32, k: u32) -> Vec3 {
    Vec3::new(random(i, k), random(i, k + 1), random(i, k + 2))
}

/// Returns triangles of many sizes about `middle`, some of them equal and some flat.
fn triangles(count: u32, middle: Vec3, size: f32) -> Vec<Triangle> {
    let triangle = |i: u32| {
        let i = if i.is_multiple_of(11) { 0 } else { i };
        let at = |k: u32| {
            let p = middle + point(i, k) * size;
            if i.is_multiple_of(5) { Vec3::new(p.x, p.y, middle.z) } else { p }
        };
        let (v0, by) = (at(0), if i.is_multiple_of(13) { 0.4 } else { 0.02 });
        Triangle { v0, v1: v0 + (at(3) - v0) * by, v2: v0 + (at(6) - v0) * by }
    };
    (0..count).map(triangle).collect()
}

fn wide_tree<'a>(prims: &'a [Triangle], quality: BuildQuality) -> Bvh<'a, Triangle> {
    let config = BuildConfig { min_wide_size: 0, quality, ..BuildConfig::default() };
    Bvh::build_wide(prims, &[], &config).expect("finite bounds")
}

/// Where scenes lie, and how large they are.
fn places() -> [(Vec3, f32); 8] {
    [
        (Vec3::ZERO, 20.0),
        (Vec3::splat(-7.0), 1.0),
        (Vec3::new(1e7, -3e-3, 5.0), 3.0),
        (Vec3::splat(1e-30), 1e-30),
        (Vec3::ZERO, 1e-42),
        (Vec3::splat(-4e37), 8e37),
        (Vec3::splat(-1.7e38), 3.4e38),
        (Vec3::splat(5.0), 0.0),
    ]
}

/// Counts the primitives below a node, all of them within the boxes on the way, or in part where they
/// were split; returns the number of levels.
fn descend(
    tree: &Compressed,
    at: usize,
    within: Aabb,
    (prims, is_split): (&[Triangle], bool),
    seen: &mut [u32],
) -> usize {
    let node = &tree.nodes[at];
    let (mut next, mut levels) = (node.first_node as usize, 0);
    for slot in 0..WIDTH {
        let ([first, count], is_node) = (node.leaf(slot), node.slots >> slot & 1 == 1);
        if !is_node && count == 0 {
            continue;
        }
        let [low, high] = node.corners(slot);
        let within = within.intersection(Aabb::new(low, high));
        if is_node {
            assert_eq!(count, 0, "a slot has a node or a leaf");
            levels = levels.max(descend(tree, next, within, (prims, is_split), seen));
            next += 1;
        }
        for &id in &tree.ids[first..first + count] {
            let bounds = prims[id as usize].get_bounds();
            match is_split {
                false => assert_eq!(within.union(bounds), within, "{bounds:?}"),
                true => assert!(within.intersection(bounds).is_valid(), "{bounds:?}"),
            }
            seen[id as usize] += 1;
        }
    }
    1 + levels
}

#[test]
fn boxes_hold_their_primitives() {
    let everything = Aabb::new(Vec3::MIN, Vec3::MAX);
    for (middle, size) in places() {
        for count in [0, 1, 8, 9, 64, 1000] {
            let prims = triangles(count, middle, size);
            for quality in BuildQuality::ALL {
                let is_split = quality == BuildQuality::Best;
                let bvh = wide_tree(&prims, quality);
                let wide = bvh.tree.own.structure.wide().expect("a wide tree");
                if !wide.is_for_devices() {
                    assert!(size > 1e38, "devices ask the binary tree of the largest scenes");
                    continue;
                }
                let tree = wide.compressed(&prims, SharedStore::NONE);
                let mut seen = vec![0; prims.len()];
                if count > 0 {
                    let levels = descend(tree, 0, everything, (&prims, is_split), &mut seen);
                    assert_eq!(levels, wide.levels());
                }
                let is_right = |&n: &u32| if is_split { n >= 1 } else { n == 1 };
                assert!(seen.iter().all(is_right), "{count} {middle} {size}");
                assert_eq!((tree.nodes.len(), tree.ids.len()), (wide.len(), wide.entries()));
            }
        }
    }
}

/// Reads the buffers of a list of trees, one of them empty, as a device does.
#[test]
fn buffers_of_a_list_hold_its_trees() {
    let prims = triangles(100, Vec3::ONE, 5.0);
    let parts = [&prims[..0], &prims[..1], &prims[1..10], &prims[10..]];
    let trees = parts.map(|prims| wide_tree(prims, BuildQuality::Balanced));
    let list = BvhList::new(&trees).expect("few primitives, none shared");
    let view = list.view();
    let bytes = |part| view.wide_bytes(part).expect("all trees are wide");
    let words = |part| bytemuck::pod_collect_to_vec::<u8, u32>(&bytes(part));
    let (ids, roots) = (words(buffers::LEAF_IDS), words(buffers::WIDE_ROOTS));
    let nodes: Vec<CompressedNode> = bytemuck::pod_collect_to_vec(&bytes(buffers::WIDE_NODES));
    assert_eq!(roots.len(), 3, "a root for each tree that has a primitive");
    let (leaves, size) = (bytes(buffers::LEAVES), size_of::<Triangle>());
    assert_eq!(leaves.len(), ids.len() * size);
    for (leaf, &id) in leaves.chunks_exact(size).zip(&ids) {
        assert_eq!(leaf, bytes_of(&prims[id as usize..][..1]));
    }
    let tree = Compressed { nodes, ids };
    let (mut seen, everything) = (vec![0; prims.len()], Aabb::new(Vec3::MIN, Vec3::MAX));
    for root in roots {
        descend(&tree, root as usize, everything, (&prims, false), &mut seen);
    }
    assert!(seen.iter().all(|&n| n == 1));
}

#[test]
fn boxes_are_little_larger() {
    let prims = triangles(2000, Vec3::ZERO, 20.0);
    let bvh = wide_tree(&prims, BuildQuality::Balanced);
    let wide = bvh.tree.own.structure.wide().expect("a wide tree");
    let area = |low: Vec3, high: Vec3| f64::from(Aabb::new(low, high).half_area());
    let areas = |node: &CompressedNode| {
        let is_there = |&slot: &usize| node.slots >> slot & 0x101 != 0;
        let of = |slot| {
            let [low, high] = node.corners(slot);
            area(low, high)
        };
        (0..WIDTH).filter(is_there).map(of).sum::<f64>()
    };
    let compressed: f64 = wide.compressed(&prims, SharedStore::NONE).nodes.iter().map(areas).sum();
    let exact = wide.nodes.iter().flat_map(|node| {
        let is_there = |&k: &usize| node.children[k] != Child::NONE.0;
        (0..WIDTH).filter(is_there).map(|k| node.bounds(k)).collect::<Vec<_>>()
    });
    let exact: f64 = exact.map(|b| area(b.min, b.max)).sum();
    assert!(compressed >= exact && compressed < 1.03 * exact, "{}", compressed / exact);
}

#[test]
fn a_walk_finds_the_hits() {
    let (mut found, mut visited, mut of_binary) = (0, 0, 0);
    for (middle, size) in places() {
        for quality in BuildQuality::ALL {
            let prims = triangles(600, middle, size);
            let bvh = wide_tree(&prims, quality);
            for i in 0..400 {
                let origin = middle + (point(i, 1) - 0.1) * (1.2 * size);
                let to = middle + point(i, 7) * size;
                let direction = match i % 4 {
                    0 => [Vec3::X, Vec3::NEG_Y, Vec3::Z][i as usize / 4 % 3],
                    _ => (to - origin).clamp(Vec3::splat(-1e30), Vec3::splat(1e30)),
                };
                let ray = Ray::new(origin, direction);
                let Some((hit, cost)) = bvh.hit_on_device(ray, false) else {
                    assert!(size > 1e38);
                    continue;
                };
                assert_eq!(hit, bvh.closest_hit(ray), "{ray:?}");
                let (any, _) = bvh.hit_on_device(ray, true).expect("a wide tree");
                assert_eq!(any.is_hit, hit.is_hit, "{ray:?}");
                if size == 20.0 {
                    found += u32::from(hit.is_hit);
                    visited += cost.nodes;
                    of_binary += nearest_counted(&bvh.view(), ray).cost.nodes;
                }
            }
        }
    }
    assert!(found > 300, "{found}");
    assert!(4 * visited < of_binary, "{visited} of {of_binary}");
}

#[test]
fn planes_are_exact() {
    let coordinates = |i: u32| {
        let exponent = (random(i, 1) * 245.0) as i32 - 126;
        let low = (random(i, 2) - 0.5) * 2f32.powi(exponent);
        let width = random(i, 3) * 2f32.powi(exponent - (random(i, 4) * 40.0) as i32);
        [low, (low + width).max(low)]
    };
    for i in 0..20_000 {
        let spans: [Option<[f32; 2]>; WIDTH] =
            core::array::from_fn(|k| (k != 3).then(|| coordinates(i * 2 + k as u32 / 7)));
        let (grid, planes) = Grid::over(spans.iter().flatten()).planes(&spans);
        let cell = f32::from_bits(grid.exponent << 23);
        for (slot, [low, high]) in spans.iter().enumerate().filter_map(|(k, s)| Some((k, (*s)?))) {
            for (side, bound) in [low, high].into_iter().enumerate() {
                let number = planes[side][slot];
                let plane = f32::from(number) * cell + grid.corner;
                assert_eq!(plane, f32::from(number).mul_add(cell, grid.corner));
                assert_eq!(f64::from(plane), grid.plane(number.into()));
                let is_outside = if side == 0 { plane <= bound } else { plane >= bound };
                assert!(is_outside, "{plane} {low} {high}");
            }
        }
    }
}
