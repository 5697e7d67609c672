//! The mean of distances without the extremes. (computed index, bare integers, zip, generic scene)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

use super::{balls, rays};

/// Sorts by insertion.
#[kernel]
fn sort(values: &mut [f32; 6]) {
    for i in 1..6 {
        let mut j = i;
        while j > 0 && values[j - 1] > values[j] {
            values.swap(j - 1, j);
            j -= 1;
        }
    }
}

#[kernel]
fn trimmed_mean<S: RayQuery + ?Sized>(scene: &S, far: f32, ray: Ray) -> f32 {
    let turns = [0.0, 0.2, 0.4, 0.6, 0.8, 0.5];
    let tilts = [0.0, 0.01, 0.02, 0.01, 0.03, 0.02];
    let mut distances = [0.0; 6];
    let mut n = 0;
    for (turn, tilt) in turns.iter().zip(tilts) {
        let SinCos { sin, cos } = sincos_2pi(*turn);
        let direction = ray.direction + vec3(cos, sin, 0.0) * tilt;
        let hit = scene.closest_hit(Ray::new(ray.origin, direction));
        distances[n] = if hit.is_hit { hit.t } else { far };
        n += 1;
    }
    sort(&mut distances);
    let mut sum = 0.0;
    for d in &distances[1..5] {
        sum += d;
    }
    sum / 4.0
}

#[test]
fn extremes_do_not_count() {
    let prims = balls();
    let bvh = Bvh::build(&prims).unwrap();
    let kernel = kernel!(|ray: Ray| trimmed_mean(&bvh, 10.0, ray));
    assert_variants_agree!(&kernel, &rays(20));
    let mut values = [3.0, 1.0, 2.0, 6.0, 5.0, 4.0];
    sort(&mut values);
    assert_eq!(values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
}
