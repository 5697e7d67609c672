//! The enum of all shapes that have bounds.

use raydsl::assert_variants_agree;
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

use super::harness::{ray_at, square};
use super::subject::{Ball, Cone, Crate, Disk, Face, Leaf, Panel, Rod, Subject, Tube};

macro_rules! all {
    ($($shape:ident),+) => {
        /// A primitive of any shape.
        #[primitive]
        #[derive(Debug)]
        enum Any {
            $($shape($shape),)+
        }

        /// One of each in turn, and rays at them.
        fn scene(rng: &mut Rng, count: usize, size: f32) -> (Vec<Any>, Vec<(Ray,)>) {
            let (mut prims, mut rays) = (Vec::new(), Vec::new());
            for i in 0..count {
                $(
                    let offset = rng.point(size * 6.0);
                    let prim = $shape::random(rng, size, offset);
                    // Copies, of which the first one is hit.
                    prims.extend((0..1 + i % 2).map(|_| Any::$shape(prim)));
                    rays.extend((0..20).map(|_| (ray_at(rng, &prim, size, 1000.0),)));
                    let target = prim.point(square(rng)).position;
                    rays.push((Ray::new(target - Vec3::X * size, Vec3::X),));
                )+
            }
            (prims, rays)
        }
    };
}

all!(Ball, Face, Leaf, Panel, Disk, Rod, Tube, Cone, Crate);

#[test]
fn trees_change_nothing() {
    let mut rng = Rng::of("all shapes");
    for size in [1.0, 1e-6, 1e6] {
        let (prims, rays) = scene(&mut rng, scaled(300) / 10, size);
        let (bvh, slice) = (Bvh::build(&prims).expect("finite bounds"), &prims[..]);
        let mut hits = 0;
        for (ray,) in &rays {
            let (hit, expected) = (bvh.closest_hit(*ray), slice.closest_hit(*ray));
            let same = hit.t.to_bits() == expected.t.to_bits() && hit == expected;
            assert!(same, "{ray:?}: {hit:?} for {expected:?}");
            assert_eq!(bvh.any_hit(*ray), expected.is_hit, "{ray:?}");
            assert_eq!(bvh.multi_hit::<4>(*ray), slice.multi_hit::<4>(*ray), "{ray:?}");
            hits += usize::from(hit.is_hit);
        }
        assert!(hits * 2 > rays.len(), "{hits} hits of {}", rays.len());
    }
}

#[test]
fn variants() {
    let mut rng = Rng::of("variants of all shapes");
    let (prims, rays) = scene(&mut rng, 4, 1.0);
    let (bvh, slice) = (Bvh::build(&prims).expect("finite bounds"), &prims[..]);
    let of_tree = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let kept = bvh.closest_hit_where(ray, |hit: Hit| hit.prim_id % 3 != 1);
        (hit.is_hit, hit.t, hit.prim_id, kept.t, kept.prim_id)
    });
    assert_variants_agree!(&of_tree, &rays);
    let of_slice = kernel!(|ray: Ray| {
        let hits = slice.multi_hit::<2>(ray);
        (hits[0].t, hits[0].prim_id, hits[1].t, hits[1].prim_id, slice.any_hit(ray))
    });
    assert_variants_agree!(&of_slice, &rays);
}

/// Two trees of one enum in one kernel have the functions of their kinds alone.
#[test]
fn trees_with_different_kinds() {
    let mut rng = Rng::of("different kinds");
    let mut ball = || Any::Ball(Ball::random(&mut rng, 1.0, Vec3::ZERO));
    let balls: Vec<Any> = (0..20).map(|_| ball()).collect();
    let mut rng = Rng::of("other kinds");
    let mixed: Vec<Any> = (0..20)
        .map(|i| match i % 2 {
            0 => Any::Crate(Crate::random(&mut rng, 1.0, Vec3::X)),
            _ => Any::Disk(Disk::random(&mut rng, 1.0, Vec3::X)),
        })
        .collect();
    let (balls, mixed) = (Bvh::build(&balls), Bvh::build(&mixed));
    let (balls, mixed) = (balls.expect("finite bounds"), mixed.expect("finite bounds"));
    let kernel = kernel!(|ray: Ray| {
        let (a, b) = (balls.closest_hit(ray), mixed.closest_hit(ray));
        let inside = balls.any_hit_where(ray, |hit: Hit| hit.t < 1.0);
        (a, b, inside)
    });
    let mut rng = Rng::of("rays at kinds");
    let rays: Vec<(Ray,)> =
        (0..scaled(2000)).map(|_| (Ray::new(rng.point(3.0), rng.point(1.0)),)).collect();
    assert_variants_agree!(&kernel, &rays);
    let wgsl = kernel.wgsl();
    for shape in ["Ball", "Crate", "Disk"] {
        assert!(wgsl.contains(&format!("fn {shape}_intersect(")), "{wgsl}");
    }
    for shape in ["Face", "Leaf", "Panel", "Rod", "Tube", "Cone"] {
        assert!(!wgsl.contains(shape), "{shape} in {wgsl}");
    }
    let alone = kernel!(|ray: Ray| balls.closest_hit(ray).t).wgsl();
    assert!(!alone.contains("Crate") && !alone.contains("kind =="), "{alone}");
}
