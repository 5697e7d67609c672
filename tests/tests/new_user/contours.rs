//! Outlines where the primitive or the distance changes between neighbours. (closure, computed
//! index, bare integers, early return, generic scene)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

use super::{balls, rays};

const AROUND: [Vec2; 4] =
    [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, -1.0)];

/// 1 on a silhouette, less on a crease.
#[kernel]
fn contour<S: RayQuery + ?Sized>(scene: &S, pixel: f32, ray: Ray) -> f32 {
    let see = |offset: Vec2| {
        let direction = ray.direction + vec3(offset.x, offset.y, 0.0) * pixel;
        scene.closest_hit(Ray::new(ray.origin, direction))
    };
    let here = see(Vec2::ZERO);
    let mut strongest = 0.0;
    for i in 0..4 {
        let there = see(AROUND[i]);
        if here.is_hit != there.is_hit {
            return 1.0;
        }
        if here.is_hit && here.prim_id != there.prim_id {
            strongest = max(strongest, min(1.0, (here.t - there.t).abs()));
        }
    }
    strongest
}

#[test]
fn outlines_surround_balls() {
    let prims = balls();
    let bvh = Bvh::build(&prims).unwrap();
    let kernel = kernel!(|ray: Ray| contour(&bvh, 0.02, ray));
    assert_variants_agree!(&kernel, &rays(24));
    let lines = rays(24).iter().filter(|r| kernel.call((**r,)) > 0.5).count();
    assert!(lines > 20 && lines < 400, "{lines}");
}
