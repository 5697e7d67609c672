//! Queries of scenes in packets of every level and width, with a tree and without.
//!
//! Beside `rays`, which asks the natural variants about many more rays: here each operation of a
//! lane is a call, which is slow.

use raydsl::prelude::*;
use raydsl_tests::hard_rays::boxes;
use raydsl_tests::queries::{scalar_answers, slice_view};
use raydsl_tests::scaled;
use raydsl_tests::scenes::{broken_rays, random_rays};

const RAYS: usize = 16_000;
const RAYS_OF_SLICES: usize = 4000;
/// Of each row and size.
const RAYS_OF_BOXES: usize = 1600;

macro_rules! levels {
    ($scene:ident) => {
        #[test]
        fn $scene() -> Result<(), raydsl::bvh::BuildError> {
            let prims = raydsl_tests::scenes::$scene(3000);
            let bvh = Bvh::build(&prims)?;
            let mut rays = random_rays(41, scaled(RAYS));
            rays.extend(broken_rays());
            let answers = scalar_answers(bvh.view(), rays);
            answers.assert_levels("tree", bvh.view());
            answers.assert_gangs("tree", bvh.view());
            let few = slice_view(&prims[..60]);
            let rays = random_rays(43, scaled(RAYS_OF_SLICES));
            let answers = scalar_answers(few, rays);
            answers.assert_levels("slice", few);
            answers.assert_gangs("slice", few);
            Ok(())
        }
    };
}

/// Rays at boxes where a box test is easily wrong.
#[test]
fn boxes() -> Result<(), raydsl::bvh::BuildError> {
    for row in &boxes::ROWS {
        for (marks, answers) in boxes::answers(row, scaled(RAYS_OF_BOXES)) {
            let bvh = Bvh::build(&marks)?;
            answers.assert_levels(row.name, bvh.view());
            answers.assert_gangs(row.name, bvh.view());
        }
    }
    Ok(())
}

levels!(spheres);
levels!(triangles);
