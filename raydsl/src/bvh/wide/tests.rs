//! Invariants of wide trees and of their traversals.

use std::collections::{HashMap, HashSet};

use glam::Vec3;

use super::node::{Child, WIDTH, WideNode};
use super::octant::Octant;
use super::order::{Order, Portions, Sequence};
use super::rays::{GROUP, Rays, lanes_of, place, ray_at, ray_at_mut, row};
use super::trace::{self, Used};
use super::{Wide, entry};
use crate::bvh::build::{Primitives, build_watched};
use crate::bvh::contract::Padding;
use crate::bvh::stats::depth;
use crate::bvh::validate::check;
use crate::bvh::{
    BuildConfig, BuildQuality, Bvh, Node, RecordQuery, Settings, Traversal, validate,
};
use crate::geometry::{Aabb, Hit, Ray, SharedStore, Triangle};
use crate::machine::Simd8;

/// Returns the settings of a wide tree over any number of primitives.
fn wide() -> BuildConfig {
    BuildConfig { min_wide_size: 0, ..BuildConfig::default() }
}

/// Returns a pseudo-random point of the unit cube for each pair of numbers.
fn point(i: u32, k: u32) -> Vec3 {
    let coordinate = |k: u32| {
        let bits = (i * 31 + k).wrapping_mul(0x9e37_79b9) >> 8;
        bits as f32 / 16_777_216.0
    };
    Vec3::new(coordinate(k), coordinate(k + 1), coordinate(k + 2))
}

/// Returns triangles in clusters of every size, some of them equal.
fn triangles(count: u32) -> Vec<Triangle> {
    (0..count)
        .map(|i| {
            let i = if i % 11 == 0 { 0 } else { i };
            let (v0, size) = (point(i, 0) * 20.0, if i % 13 == 0 { 8.0 } else { 0.3 });
            Triangle { v0, v1: v0 + point(i, 3) * size, v2: v0 + point(i, 6) * size }
        })
        .collect()
}

/// Counts the primitives in the blocks below a child; returns the most pending children in the
/// worst traversal order.
fn traverse(
    tree: &Wide,
    child: Child,
    bounds: Aabb,
    prims: &[Triangle],
    seen: &mut [u32],
) -> usize {
    if child.is_block() {
        let block = tree.blocks.block::<Triangle>(child.index());
        let ids = block[block.len() - 1].0;
        let count = (1..WIDTH).find(|&lane| ids[lane] == ids[0]).unwrap_or(WIDTH);
        let once: HashSet<u32> = ids[..count].iter().copied().collect();
        assert_eq!(once.len(), count, "each once, then the first again: {ids:?}");
        assert!(ids[count..].iter().all(|&id| id == ids[0]), "{ids:?}");
        once.iter().for_each(|&id| seen[id as usize] += 1);
        for (lane, &id) in ids.iter().enumerate() {
            // Split primitives are in several blocks.
            let part = bounds.intersection(prims[id as usize].get_bounds());
            assert!(part.is_valid());
            let words: Vec<f32> =
                block[..9].iter().map(|row| f32::from_bits(row.0[lane])).collect();
            let Triangle { v0, v1, v2 } = prims[id as usize];
            assert_eq!(words, [v0, v1, v2].map(|v| v.to_array()).concat());
        }
        return 0;
    }
    let node = &tree.nodes[child.index()];
    let mut children = 0;
    let mut deepest = 0;
    for slot in 0..WIDTH {
        let below = Child(node.children[slot]);
        if below == Child::NONE {
            assert!(node.planes[0][slot] > node.planes[1][slot]);
            continue;
        }
        let corner = |side: usize| [0, 1, 2].map(|axis| node.planes[2 * axis + side][slot]);
        let own = Aabb::new(corner(0).into(), corner(1).into());
        assert_eq!(own.union(bounds), bounds, "a child is in its parent");
        children += 1;
        deepest = deepest.max(traverse(tree, below, own, prims, seen));
    }
    assert!(children > 0);
    (children - 1 + deepest).max(children)
}

#[test]
fn blocks_hold_every_primitive_and_stacks_are_deep_enough() {
    for count in [1, 2, 8, 9, 64, 1000, 5000] {
        let prims = triangles(count);
        for quality in BuildQuality::ALL {
            let config = BuildConfig { quality, ..wide() };
            let bvh = Bvh::build_wide(&prims, &[], &config).expect("finite bounds");
            let tree = bvh.tree.own.structure.wide().expect("a wide tree was asked for");
            let mut seen = vec![0; prims.len()];
            let pending = traverse(tree, Child::node(0), bvh.bounds(), &prims, &mut seen);
            assert!(pending <= tree.pending, "{pending} of {}", tree.pending);
            let most = if quality == BuildQuality::Best { u32::MAX } else { 1 };
            assert!(seen.iter().all(|&n| n >= 1 && n <= most), "{count} {quality:?}");
        }
    }
}

#[test]
fn the_binary_tree_comes_back() {
    for count in [0, 1, 8, 9, 64, 1000, 5000] {
        let prims = triangles(count);
        let source = Primitives { prims: &prims, shared: &[] };
        for quality in BuildQuality::ALL {
            let settings = Settings { config: quality.into(), is_wide: true };
            let built =
                build_watched(&source, prims.len(), &settings, None).expect("finite bounds");
            let wide = Wide::of(&built, &prims, SharedStore::NONE, Traversal::Auto);
            let tree = wide.binary();
            assert_eq!(check(&tree.nodes, &tree.indices, prims.len(), &source), Ok(()));
            assert_eq!(tree.nodes.first().map(Node::bounds), built.nodes.first().map(Node::bounds));
            let boxes: HashSet<_> = built.nodes.iter().map(bits).collect();
            assert!(tree.nodes.iter().map(bits).all(|node| boxes.contains(&node)), "of its own");
            assert!(depth(&tree.nodes) <= depth(&built.nodes));
            // There is nothing left to collapse.
            assert_eq!(Wide::of(&tree, &prims, SharedStore::NONE, Traversal::Auto).binary(), tree);
        }
    }
}

/// Returns the bits of a node's box, as a key of hash sets.
fn bits(node: &Node) -> [[u32; 3]; 2] {
    // Zeros of either sign are the same plane.
    [node.min, node.max].map(|corner| (corner + 0.0).to_array().map(f32::to_bits))
}

#[test]
fn the_binary_tree_is_made_on_demand() {
    let prims = triangles(1000);
    let bvh = Bvh::build_wide(&prims, &[], &wide()).expect("finite bounds");
    let wide_only = bvh.bytes();
    assert_eq!(bvh.statistics().bytes, wide_only);
    assert!(validate(&bvh).is_ok());
    let rays: Vec<Ray> = (0..600)
        .map(|i| Ray { t_max: 9.0, ..Ray::new(point(i, 1) * 20.0, point(i, 5) - 0.5) })
        .collect();
    for ray in &rays {
        assert_eq!(bvh.closest_hit(*ray), prims.closest_hit(*ray));
        assert_eq!(bvh.any_hit(*ray), prims.any_hit(*ray));
    }
    assert_eq!(bvh.closest_hits(&rays).len() + bvh.any_hits(&rays).len(), 1200);
    assert_eq!(bvh.bytes(), wide_only, "nothing has asked for it");
    let degenerate = Ray::new(Vec3::splat(-1e30), Vec3::splat(1e-10));
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| assert_eq!(bvh.closest_hit(degenerate), prims.closest_hit(degenerate)));
        }
    });
    assert!(bvh.bytes() > wide_only, "a degenerate ray falls back to the binary tree");
    let binary = size_of_val(bvh.nodes()) + size_of_val(bvh.indices());
    assert_eq!((bvh.bytes(), bvh.bounds()), (wide_only + binary, bvh.nodes()[0].bounds()));
}

/// Collects the blocks below a node whose boxes overlap `bounds`.
fn blocks(tree: &Wide, node: &WideNode, bounds: Aabb, found: &mut HashSet<u32>) {
    for slot in 0..WIDTH {
        let child = Child(node.children[slot]);
        if child == Child::NONE || !node.bounds(slot).intersection(bounds).is_valid() {
            continue;
        }
        if child.is_block() {
            found.insert(child.0);
        } else {
            blocks(tree, &tree.nodes[child.index()], bounds, found);
        }
    }
}

#[test]
fn entry_nodes_lead_to_all_blocks_within_reach() {
    let e = Simd8(fearless_simd::Fallback::new());
    let prims = triangles(3000);
    let bvh = Bvh::build_wide(&prims, &[], &wide()).expect("finite bounds");
    let tree = bvh.tree.own.structure.wide().expect("a wide tree was asked for");
    let (root, padding) = (bvh.bounds(), Padding::of::<Triangle>());
    let (mut rays, mut opened) = (Rays::default(), 0);
    for case in 0..300 {
        let length = 10f32.powi(case as i32 % 5 - 3);
        let middle = point(case, 9) * 20.0;
        let ray = |i: u32| {
            let origin = middle + point(i, case) * 0.2;
            let direction = point(i, case + 50) - 0.5;
            Ray { t_min: -0.2 * length, t_max: length, ..Ray::new(origin, direction) }
        };
        let mut all: Vec<Ray> = (0..64).map(ray).collect();
        let reach = all.iter().fold(Aabb::EMPTY, |reach, ray| {
            let at = |t| ray.origin + ray.direction * t;
            let (from, to) = (at(ray.t_min), at(ray.t_max));
            reach.union(Aabb::new(from.min(to), from.max(to)))
        });
        let mut of = |all: &[Ray]| {
            rays.load(all);
            rays.prepare(e, &root, padding);
            entry::of(e, tree, &rays, &root, padding)
        };
        let entry = of(&all).expect("bounded rays");
        let (mut below, mut wanted) = (HashSet::new(), HashSet::new());
        blocks(tree, &entry, reach, &mut below);
        blocks(tree, &tree.nodes[0], reach, &mut wanted);
        assert_eq!(below, wanted);
        let is_new = |child: &u32| !tree.nodes[0].children.contains(child);
        opened += u32::from(entry.children.iter().any(is_new));
        all[7].t_max = f32::MAX;
        assert!(of(&all).is_none(), "one is unbounded");
        assert!(of(&all[20..60]).is_none(), "few");
    }
    assert!(opened > 200, "{opened}");
}

#[test]
fn an_empty_scene_has_a_wide_tree() {
    let bvh = Bvh::<Triangle>::build_wide(&[], &[], &wide()).expect("nothing");
    assert!(bvh.tree.own.structure.wide().is_some_and(|tree| tree.bytes() == 0));
}

#[test]
fn the_order_has_each_ray_once_octant_by_octant() {
    let e = Simd8(fearless_simd::Fallback::new());
    let direction = |i: u32| match i {
        7 => Vec3::ZERO,
        8 => Vec3::new(0.0, -0.0, 1e30),
        _ => point(i, 5) - 0.5,
    };
    let all: Vec<Ray> = (0..700).map(|i| Ray::new(Vec3::ZERO, direction(i))).collect();
    let mut rays = Rays::default();
    rays.load(&all);
    rays.prepare(e, &Aabb::new(Vec3::ZERO, Vec3::ONE), Padding::of::<Triangle>());
    let is_active = |i: &usize| !i.is_multiple_of(3);
    for (group, masks) in rays.masks.iter_mut().enumerate() {
        masks.active =
            (0..GROUP).filter(|lane| is_active(&(GROUP * group + lane))).map(|l| 1 << l).sum();
    }
    let active = (0..all.len()).filter(is_active);
    let numbers: HashMap<u32, usize> = active.map(|i| (place(i), i)).collect();
    let groups = 0..all.len() / GROUP;
    let mut order = Order::default();
    let sorted = order.by_direction(e, &rays, groups.clone());
    let once: HashSet<_> = sorted.iter().collect();
    let expected = numbers.values().filter(|&&i| i < GROUP * groups.len()).count();
    assert_eq!((sorted.len(), once.len()), (expected, expected));
    let octant = |place: &u32| all[numbers[place]].direction.to_array().map(|d| d >= 0.0);
    let changes = sorted.windows(2).filter(|pair| octant(&pair[0]) != octant(&pair[1])).count();
    // Directions along an axis are between octants.
    assert!(changes <= 7 + 4, "{changes}");
}

#[test]
fn portions_have_each_ray_once_and_copy_its_result_back() {
    let e = Simd8(fearless_simd::Fallback::new());
    // More rays than are sorted at once.
    let all: Vec<Ray> = (0..5000)
        .map(|i| Ray::new(Vec3::splat(i as f32), if i % 9 == 5 { Vec3::NAN } else { point(i, 5) }))
        .collect();
    for sequence in [Sequence::AsTheyCome, Sequence::ByDirection] {
        let mut rays = Rays::default();
        rays.load(&all);
        assert_eq!(
            rays.activate_all() as usize,
            all.len() - (0..5000).filter(|i| i % 9 == 5).count()
        );
        for round in 1..=2 {
            let degenerate = |i: usize| i.is_multiple_of(100);
            Portions::default().each::<true, _>(e, &mut rays, sequence, |some| {
                for group in 0..some.masks.len() {
                    for lane in lanes_of(some.masks[group].queried) {
                        let mut ray = ray_at_mut(some.words(), place(GROUP * group + lane));
                        let index = ray.as_ref().float(row::ORIGIN);
                        let found = ray.as_ref().word(row::FOUND);
                        assert_eq!(found, round - 1, "the earlier result is there");
                        ray.set(row::FOUND, found + 1);
                        ray.set_float(row::T, index + round as f32);
                        ray.set(row::ID, index as u32);
                        ray.set_float(row::LIMIT, 2.0 * index);
                        some.masks[group].degenerate |=
                            u32::from(degenerate(index as usize)) << lane;
                    }
                }
            });
            for (i, Ray { direction, .. }) in all.iter().enumerate() {
                let ray = ray_at(rays.words(), place(i));
                let result = (ray.word(row::FOUND), ray.word(row::ID), ray.float(row::T));
                let limit = ray.float(row::LIMIT);
                let is_degenerate = rays.masks[i / GROUP].degenerate >> (i % GROUP) & 1 == 1;
                if direction.is_nan() {
                    assert!(result.0 == 0 && limit == all[i].t_max && !is_degenerate, "{i}");
                } else {
                    assert_eq!(result, (round, i as u32, i as f32 + round as f32));
                    assert!(limit == 2.0 * i as f32 && is_degenerate == degenerate(i), "{i}");
                }
            }
        }
    }
}

#[test]
fn octants_have_each_ray_once() {
    let e = Simd8(fearless_simd::Fallback::new());
    for count in [1, 16, 17, 64, 100, 130] {
        let all: Vec<Ray> = (0..count).map(|i| Ray::new(Vec3::ZERO, point(i, 5) - 0.5)).collect();
        let mut rays = Rays::default();
        rays.load(&all);
        rays.prepare(e, &Aabb::new(Vec3::ZERO, Vec3::ONE), Padding::of::<Triangle>());
        for (group, masks) in rays.masks.iter_mut().enumerate() {
            let lanes = (0..GROUP).filter(|lane| GROUP * group + lane < all.len());
            masks.active = lanes.map(|lane| 1 << lane).sum();
        }
        let mut seen = vec![0; all.len()];
        let mut octant = Octant::default();
        for groups in Octant::ranges(rays.masks.len()) {
            loop {
                let size = octant.take(&mut rays, groups.clone());
                if size == 0 {
                    break;
                }
                let lanes = octant
                    .groups()
                    .flat_map(|(group, bits)| lanes_of(bits).map(move |lane| GROUP * group + lane));
                let members: Vec<usize> = lanes.collect();
                assert_eq!(members.len(), size as usize);
                let signs = |i: usize| all[i].direction.to_array().map(|d| d < 0.0);
                assert!(members.iter().all(|&i| signs(i) == signs(members[0])));
                members.iter().for_each(|&i| seen[i] += 1);
                let mut bits = octant.groups().map(|(_, bits)| bits);
                assert!(!octant.leave(core::array::from_fn(|_| bits.next().unwrap_or(0))));
            }
        }
        assert!(seen.iter().all(|&n| n == 1), "{count}: {seen:?}");
    }
}

/// The stacks of streams are small here, so that some rays have to stay in their packet.
#[test]
fn every_traversal_finds_the_same_hits() {
    for count in [20, 3000] {
        let prims = triangles(count);
        let mut bvh = Bvh::build_wide(&prims, &[], &wide()).expect("finite bounds");
        for case in 0..12 {
            let number = [1, 511, 512, 600, 2500, 5000][case as usize % 6];
            let spread = if case < 6 { 0.05 } else { 2.0 };
            let rays: Vec<Ray> = (0..number)
                .map(|i| {
                    let origin = point(i, case) * if i % 40 == 3 { 1e30 } else { 4.0 };
                    let direction =
                        point(7, case) + 0.1 + point(i, case + 50) * spread - spread / 2.0;
                    let direction = if i % 9 == 5 { Vec3::NAN } else { direction };
                    let t_max = if case % 2 == 0 { 9.0 } else { f32::MAX };
                    Ray { t_max, ..Ray::new(origin, direction) }
                })
                .collect();
            let found: Vec<bool> = rays.iter().map(|ray| prims.any_hit(*ray)).collect();
            let hits: Vec<Hit> = rays.iter().map(|ray| prims.closest_hit(*ray)).collect();
            for traversal in Traversal::ALL {
                bvh.set_traversal(traversal);
                let ask = || (bvh.any_hits(&rays), bvh.closest_hits(&rays));
                let answer = on_its_own_thread(ask);
                assert_eq!(answer.0, found, "{count} {case} {traversal:?}");
                assert_eq!(answer.1, hits, "{count} {case} {traversal:?}");
            }
        }
    }
}

/// Runs `query` on a thread that has made no queries yet.
fn on_its_own_thread<T: Send>(query: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| scope.spawn(query).join()).expect("no panic")
}

#[test]
fn the_configured_traversal_is_used() {
    let prims = triangles(1000);
    let mut bvh = Bvh::build_wide(&prims, &[], &wide()).expect("finite bounds");
    let rays = |spread: f32, t_max: f32| -> Vec<Ray> {
        let ray = |i| {
            let direction = Vec3::splat(0.5) + (point(i, 0) - 0.5) * spread;
            Ray { t_max, ..Ray::new(Vec3::splat(-0.5), direction) }
        };
        (0..600).map(ray).collect()
    };
    let (of_a_camera, bounces) = (rays(0.1, f32::MAX), rays(0.9, f32::MAX));
    let (shadows, one) = (rays(2.0, 3.0), &rays(2.0, 3.0)[..1]);
    let (packets, streams) = (Used { packets: true, order: false }, Used::default());
    let sorted = Used { packets: true, order: true };
    for (traversal, closest, any) in [
        (Traversal::Auto, [packets, streams], [sorted, streams, streams]),
        (Traversal::Streams, [streams, streams], [streams, streams, streams]),
        (Traversal::Packets, [packets, packets], [packets, streams, packets]),
        (Traversal::Sorted, [sorted, sorted], [sorted, streams, sorted]),
    ] {
        bvh.set_traversal(traversal);
        assert_eq!(bvh.config().traversal, traversal);
        for (rays, expected) in [&of_a_camera, &bounces].into_iter().zip(closest) {
            let ask = || (bvh.closest_hits(rays), trace::used()).1;
            assert_eq!(on_its_own_thread(ask), expected, "{traversal:?} {}", rays[0].direction);
        }
        for (rays, expected) in [&shadows[..], one, &bounces[..]].into_iter().zip(any) {
            let ask = || (bvh.any_hits(rays), trace::used()).1;
            let (count, t_max) = (rays.len(), rays[0].t_max);
            assert_eq!(on_its_own_thread(ask), expected, "{traversal:?} of {count} to {t_max}");
        }
    }
    let config = BuildConfig { traversal: Traversal::Streams, ..wide() };
    let bvh = Bvh::build_wide(&prims, &[], &config).expect("finite bounds");
    let bvh = bvh.refit(&prims).expect("finite bounds");
    let ask = || (bvh.closest_hits(&of_a_camera), trace::used()).1;
    assert_eq!(on_its_own_thread(ask), streams, "set before, and refitted");
}
