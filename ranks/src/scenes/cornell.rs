//! The Cornell box, by path tracing.

use raydsl::bsdf::{Lambert, Luminous};
use raydsl::integrators::{PathLimits, path};
use raydsl::light::Lights;
use raydsl::prelude::*;
use raydsl_examples::cornell::{camera, lamps, walls};

use super::Run;
use crate::args::Args;
use crate::run::Failure;

/// How often light is scattered at most, and from when on paths may end by chance.
const LIMITS: PathLimits = PathLimits { bounces: 6, roulette: 3 };

pub(super) fn with(args: &Args, run: Run<'_>) -> Result<(), Failure> {
    let walls = walls();
    let lamps = lamps(&walls);
    let scene = Bvh::build(&walls)?;
    let lights = Lights::new(&lamps, scene.bounds())?;
    let limits = LIMITS;
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |hit: Hit, _point: ShadingPoint| scene.primitive(hit).material();
        path::<_, _, Luminous<Lambert>>(&scene, surface, &lights, limits, ray, sampler).color
    });
    let (scheduler, camera) = (TiledScheduler::new(), camera());
    let sampling = Sampling::new(args.samples).seed(args.seed);
    run(&|extent| scheduler.render_part(&camera, &kernel, &sampling, extent))
}
