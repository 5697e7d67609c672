//! One solid without another, from the crossings of both. (generic scenes, option, bare integers,
//! early return)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

use crate::{Ball, balls, rays};

/// How many surfaces of a closed scene a ray has crossed at `t`.
#[kernel]
fn depth_at<S: RayQuery + ?Sized>(scene: &S, ray: Ray, t: f32) -> i32 {
    let mut depth = 0;
    for hit in scene.hits(ray) {
        if hit.t > t {
            break;
        }
        depth += 1;
    }
    depth
}

/// The first point of `solid` that is not in `hole`.
#[kernel]
fn first_of_difference<A: RayQuery + ?Sized, B: RayQuery + ?Sized>(
    solid: &A,
    hole: &B,
    ray: Ray,
) -> Option<f32> {
    for hit in solid.hits(ray) {
        let inside_solid = depth_at(solid, ray, hit.t) % 2 == 1;
        let inside_hole = depth_at(hole, ray, hit.t) % 2 == 1;
        if inside_solid && !inside_hole {
            return Some(hit.t);
        }
    }
    for hit in hole.hits(ray) {
        if depth_at(hole, ray, hit.t) % 2 == 0 && depth_at(solid, ray, hit.t) % 2 == 1 {
            return Some(hit.t);
        }
    }
    None
}

#[test]
fn holes_are_cut() {
    let solid = balls();
    let hole = [Ball { center: vec3(0.0, 0.0, 4.2), radius: 1.1 }];
    let (tree, hole) = (Bvh::build(&solid).unwrap(), &hole[..]);
    let kernel = kernel!(|ray: Ray| first_of_difference(&tree, hole, ray).unwrap_or(-1.0));
    assert_variants_agree!(&kernel, &rays(20));
    let hits = rays(20).iter().filter(|r| kernel.call((**r,)) > 0.0).count();
    let all = rays(20).iter().filter(|r| tree.any_hit(**r)).count();
    assert!(hits > 20 && hits <= all, "{hits} of {all}");
}
