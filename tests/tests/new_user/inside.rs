//! Is a point inside of closed surfaces, and how deep? (bare integers, option, early return, generic
//! scene)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

use super::balls;

/// The distance to the surface in the direction of `ray`, where its origin is inside.
#[kernel]
fn depth<S: RayQuery + ?Sized>(scene: &S, ray: Ray) -> Option<f32> {
    let mut crossings = 0;
    let mut first = 0.0;
    for hit in scene.hits(ray) {
        if crossings == 0 {
            first = hit.t;
        }
        crossings += 1;
        if crossings > 64 {
            return None;
        }
    }
    if crossings % 2 == 1 { Some(first) } else { None }
}

#[test]
fn points_inside_know_their_depth() {
    let prims = balls();
    let bvh = Bvh::build(&prims).unwrap();
    let kernel = kernel!(|p: Vec3| {
        match depth(&bvh, Ray::new(p, vec3(0.1, 0.2, 1.0))) {
            Some(t) => t,
            None => -1.0,
        }
    });
    let points: Vec<Vec3> = (0..300)
        .map(|i| {
            vec3(
                (i % 17) as f32 * 0.3 - 2.5,
                (i % 13) as f32 * 0.4 - 2.5,
                (i % 7) as f32 * 0.5 + 3.5,
            )
        })
        .collect();
    assert_variants_agree!(&kernel, &points);
    let inside = points.iter().filter(|p| kernel.call((**p,)) >= 0.0).count();
    let brute =
        points.iter().filter(|p| prims.iter().any(|b| p.distance(b.center) < b.radius)).count();
    assert!(brute > 10);
    // Where balls overlap, a point in two of them has an even number of crossings.
    assert!(inside <= brute && inside * 2 > brute);
}
