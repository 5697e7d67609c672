//! How open a point is in each of six directions. (closure, computed index, generic scene, bare
//! integers)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

use crate::balls;

#[kernel]
fn openness<S: RayQuery + ?Sized>(scene: &S, p: Vec3, reach: f32) -> [f32; 6] {
    let axis = |i: u32| {
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        match i / 2 {
            0 => vec3(sign, 0.0, 0.0),
            1 => vec3(0.0, sign, 0.0),
            _ => vec3(0.0, 0.0, sign),
        }
    };
    let closed = scene.any_hit_each::<6>(|i: u32| Ray::new(p, axis(i)).with_range(0.0, reach));
    let mut open = [0.0; 6];
    for i in 0..6 {
        if !closed[i] {
            open[i] = 1.0;
        } else {
            let hit = scene.closest_hit(Ray::new(p, axis(i as u32)));
            open[i] = hit.t / reach;
        }
    }
    open
}

#[kernel]
fn most_open(open: [f32; 6]) -> usize {
    let mut best = 0;
    for (i, x) in open.iter().enumerate() {
        if *x > open[best] {
            best = i;
        }
    }
    best
}

#[test]
fn points_see_out() {
    let prims = balls();
    let bvh = Bvh::build(&prims).unwrap();
    let kernel = kernel!(|p: Vec3| {
        let open = openness(&bvh, p, 2.0);
        (open, most_open(open))
    });
    let points: Vec<Vec3> = (0..300)
        .map(|i| {
            vec3((i % 7) as f32 - 3.0, (i % 11) as f32 * 0.5 - 2.5, 3.0 + (i % 13) as f32 * 0.3)
        })
        .collect();
    assert_variants_agree!(&kernel, &points);
    let (open, best) = kernel.call((vec3(0.0, 0.0, -5.0),));
    assert_eq!((open, best), ([1.0; 6], 0));
}
