//! Ambient occlusion of a pile of blocks.

use raydsl::integrators::ambient_occlusion;
use raydsl::prelude::*;
use raydsl_examples::blocks;

use super::Run;
use crate::args::Args;
use crate::run::Failure;

/// The blocks of the pile.
const BLOCKS: u32 = 400;
/// Directions that each sample looks in, asked about together.
const DIRECTIONS: usize = 4;

pub(super) fn with(args: &Args, run: Run<'_>) -> Result<(), Failure> {
    let triangles = blocks::pile(BLOCKS);
    let mesh = Bvh::build(&triangles)?;
    let bounds = mesh.bounds();
    let size = (bounds.max - bounds.min).length();
    let radius = 0.25 * size;
    // All of it from above on one side.
    let eye = bounds.center() + vec3(0.45, 0.4, 0.8).normalize() * size * 1.15;
    let camera = Pinhole::new(eye, bounds.center(), Vec3::Y, 0.72);
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let light = ambient_occlusion::<_, DIRECTIONS>(&mesh, radius, ray, sampler);
        // On white paper.
        light + vec4(1.0, 1.0, 1.0, 1.0) * (1.0 - light.w)
    });
    let scheduler = TiledScheduler::new();
    let sampling = Sampling::new(args.samples).seed(args.seed);
    run(&|extent| scheduler.render_part(&camera, &kernel, &sampling, extent))
}
