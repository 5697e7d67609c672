//! Random rays: closest and any hit give the same bits in every variant, with a tree and without.

use raydsl::prelude::*;
use raydsl_tests::queries::{
    Answers, closest_spheres, closest_triangles, scalar_answers, slice_view,
};
use raydsl_tests::scaled;
use raydsl_tests::scenes::{broken_rays, random_rays, spheres, triangles};

const RAYS: usize = 1_000_000;
const RAYS_OF_SLICES: usize = 100_000;
const RAYS_OF_BRUTE_FORCE: usize = 100_000;
const RAYS_OF_WGSL: usize = 200_000;

const PRIMITIVES: usize = 3000;
/// In a plain slice: every ray tests them all.
const FEW: usize = 60;

/// The answers are worth comparing: some rays hit, some do not.
fn assert_mixed(answers: &Answers) {
    let share = answers.hits() as f64 / answers.rays.len() as f64;
    assert!((0.05..0.95).contains(&share), "{share} of the rays hit");
}

macro_rules! tree_and_slice {
    ($tree:ident $slice:ident $brute:ident: $scene:ident) => {
        mod $scene {
            use super::*;

            #[test]
            fn in_a_tree() -> Result<(), raydsl::bvh::BuildError> {
                let prims = $scene(PRIMITIVES);
                let bvh = Bvh::build(&prims)?;
                let answers = scalar_answers(bvh.view(), random_rays(17, scaled(RAYS)));
                assert_mixed(&answers);
                let some = answers.first(scaled(RAYS_OF_BRUTE_FORCE));
                some.assert_closest("brute force", &$brute(slice_view(&prims), &some.rays));
                answers.$tree("tree", &bvh, RAYS_OF_WGSL);
                Ok(())
            }

            #[test]
            fn in_a_slice() {
                let prims = $scene(FEW);
                let rays = random_rays(19, scaled(RAYS_OF_SLICES));
                let answers = scalar_answers(slice_view(&prims), rays);
                assert!(answers.hits() > 0);
                answers.$slice("slice", &prims, RAYS_OF_SLICES);
            }
        }
    };
}

tree_and_slice!(sphere_tree sphere_slice closest_spheres: spheres);
tree_and_slice!(triangle_tree triangle_slice closest_triangles: triangles);

/// A ray that is no ray misses everything, whatever primitives make of it.
#[test]
fn broken_rays_miss() -> Result<(), raydsl::bvh::BuildError> {
    let prims = spheres(PRIMITIVES);
    let bvh = Bvh::build(&prims)?;
    let answers = scalar_answers(bvh.view(), broken_rays());
    assert_eq!(answers.hits(), 0);
    assert!(answers.any.iter().all(|any| !any));
    answers.sphere_tree("tree", &bvh, RAYS_OF_WGSL);
    let few = spheres(FEW);
    answers.sphere_slice("slice", &few, RAYS_OF_WGSL);
    Ok(())
}

/// The range of a ray is closed, and a NaN in it hits nothing.
#[test]
fn ranges_are_kept() -> Result<(), raydsl::bvh::BuildError> {
    let wall =
        [Triangle { v0: vec3(-9.0, -9.0, 2.0), v1: vec3(9.0, -9.0, 2.0), v2: vec3(0.0, 9.0, 2.0) }];
    let bvh = Bvh::build(&wall)?;
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    let ranges = [
        ((0.0, 2.0), true),
        ((2.0, 2.0), true),
        ((2.0, 9.0), true),
        ((0.0, 1.999), false),
        ((2.001, 9.0), false),
        ((f32::NAN, 9.0), false),
        ((0.0, f32::NAN), false),
        ((0.0, f32::INFINITY), true),
        ((f32::NEG_INFINITY, f32::INFINITY), true),
    ];
    let rays = ranges.iter().map(|((a, b), _)| ray.with_range(*a, *b)).collect();
    let answers = scalar_answers(bvh.view(), rays);
    let hits: Vec<bool> = answers.closest.iter().map(|h| h.is_hit).collect();
    let expected: Vec<bool> = ranges.iter().map(|(_, hit)| *hit).collect();
    assert_eq!(hits, expected);
    assert_eq!(answers.any, expected);
    Ok(())
}
