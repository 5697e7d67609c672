//! A histogram of the distances that a sensor sees in a cone. (computed index, bare integers,
//! generic scene, closure)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

use super::{balls, rays};

/// How many of 16 rays around `ray` end in each of eight bins of `width`; a miss counts in none.
#[kernel]
fn histogram<S: RayQuery + ?Sized>(scene: &S, width: f32, ray: Ray) -> [i32; 8] {
    let mut bins = [0; 8];
    let tilt = |i: i32| (i as f32 - 1.5) * 0.02;
    for i in 0..4 {
        for j in 0..4 {
            let direction = ray.direction + vec3(tilt(i), tilt(j), 0.0);
            let hit = scene.closest_hit(Ray::new(ray.origin, direction));
            if hit.is_hit {
                let bin = (hit.t / width) as usize;
                bins[bin.min(7)] += 1;
            }
        }
    }
    bins
}

/// The fullest bin.
#[kernel]
fn mode(bins: [i32; 8]) -> usize {
    let mut best = 0;
    for i in 1..8 {
        if bins[i] > bins[best] {
            best = i;
        }
    }
    best
}

#[test]
fn distances_fall_in_bins() {
    let prims = balls();
    let bvh = Bvh::build(&prims).unwrap();
    let kernel = kernel!(|ray: Ray| {
        let bins = histogram(&bvh, 1.0, ray);
        (bins, mode(bins))
    });
    assert_variants_agree!(&kernel, &rays(20));
    let (bins, best) = kernel.call((Ray::new(Vec3::ZERO, Vec3::Z),));
    assert_eq!(bins.iter().sum::<i32>(), 16);
    assert_eq!(bins[best], *bins.iter().max().unwrap());
}
