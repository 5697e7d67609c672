//! Counters of traversals, in trees with one node and one block.
#![cfg(feature = "counts")]

use raydsl::bvh::Counts;
use raydsl::prelude::*;

/// Three triangles, one behind the other.
fn triangles() -> [Triangle; 3] {
    [0.0, 1.0, 2.0].map(|z| Triangle {
        v0: Vec3::new(-9.0, -9.0, z),
        v1: Vec3::new(9.0, -9.0, z),
        v2: Vec3::new(0.0, 9.0, z),
    })
}

/// A ray straight down at one of the triangles, or past them.
fn ray(i: u16, is_aimed: bool) -> Ray {
    let x = if is_aimed { 0.0 } else { 100.0 } + f32::from(i) / 64.0;
    Ray::new(Vec3::new(x, 0.0, 5.0), Vec3::new(1e-3, 1e-3, -1.0))
}

/// A cylinder, whose test takes longer than that of its box.
#[primitive(cylinder(from, to, radius))]
struct Rod {
    from: Vec3,
    to: Vec3,
    radius: f32,
}

/// A ray straight down at the first, second or third of three rods.
fn ray_to_rod(i: u16) -> Ray {
    let x = 4.0 * f32::from(i % 3) + f32::from(i) / 256.0;
    Ray::new(Vec3::new(x, 0.0, 5.0), Vec3::new(1e-3, 1e-3, -1.0))
}

// One test: the counts are those of the process.
#[test]
fn counts_are_those_of_one_node_and_one_block() {
    let (_, lanes) = Variant::widest().isa();
    if lanes < 8 {
        eprintln!("SKIPPED: no wide trees on this machine");
        return;
    }
    let config = BuildConfig { min_wide_size: 0, ..BuildConfig::default() };
    let triangles = triangles();
    let bvh = Bvh::build_wide(&triangles, &[], &config).unwrap();
    let _ = Counts::take();

    // Each single ray is tested against three primitives at once, and the first of them is nearer.
    for i in 0..5 {
        assert!(bvh.closest_hit(ray(i, true)).is_hit);
        assert!(!bvh.closest_hit(ray(i, false)).is_hit);
    }
    let single = Counts { nodes: 10, blocks: 5, nearer: 5, ..Counts::default() };
    assert_eq!(Counts::take(), single);

    // A ray packet visits a node once; each of its registers is tested against single primitives.
    let rays: Vec<Ray> = (0..64).map(|i| ray(i, true)).collect();
    assert!(bvh.closest_hits(&rays).iter().all(|hit| hit.is_hit));
    let registers = 64 / lanes as u64;
    let packets = Counts {
        beams: 1,
        beam_rays: 64,
        beam_nodes: 1,
        beam_blocks: 1,
        register_boxes: registers,
        register_blocks: registers,
        register_primitives: 3 * registers,
        nearer: registers,
        ..Counts::default()
    };
    assert_eq!(Counts::take(), packets);

    let past: Vec<Ray> = (0..64).map(|i| ray(i, false)).collect();
    assert!(bvh.closest_hits(&past).iter().all(|hit| !hit.is_hit));
    let packets = Counts { beams: 1, beam_rays: 64, beam_nodes: 1, ..Counts::default() };
    assert_eq!(Counts::take(), packets);

    // In a stream each ray visits nodes by itself, and stops at a hit.
    assert!(bvh.any_hits(&rays).iter().all(|is_hit| *is_hit));
    assert_eq!(Counts::take(), Counts { nodes: 64, blocks: 64, ..Counts::default() });

    // Of primitives with boxes those are tested whose boxes a ray enters: one for each ray.
    let rods = [0.0, 4.0, 8.0].map(|x| Rod {
        from: Vec3::new(x, 0.0, 0.0),
        to: Vec3::new(x, 0.0, 1.0),
        radius: 0.5,
    });
    let bvh = Bvh::build_wide(&rods, &[], &config).unwrap();
    let rays: Vec<Ray> = (0..64).map(ray_to_rod).collect();
    assert!(bvh.any_hits(&rays).iter().all(|is_hit| *is_hit));
    let stream = Counts { nodes: 64, blocks: 64, pairs: 64, ..Counts::default() };
    assert_eq!(Counts::take(), stream);

    // A third of the rays of a register enters each box, so they are tested as pairs too.
    assert!(bvh.closest_hits(&rays).iter().zip(0..).all(|(hit, i)| hit.prim_id == i % 3));
    let packets = Counts {
        beams: 1,
        beam_rays: 64,
        beam_nodes: 1,
        beam_blocks: 1,
        register_boxes: 4 * registers,
        register_blocks: registers,
        pairs: 64,
        nearer: 64,
        ..Counts::default()
    };
    assert_eq!(Counts::take(), packets);
}
