//! How open a hall is, with the time to build its tree: by each quality of the builder and both
//! layouts of nodes. No closed form, so two halves of a reference.

use core::error::Error;

use raydsl::bvh::BuildQuality;
use raydsl::integrators::ambient_occlusion;
use raydsl::prelude::*;
use raydsl_report::Missing;
use raydsl_report::work_precision::{Case, Estimates, Method, Run};
use rayon::ThreadPool;

use crate::cloud::halves;
use crate::open::Scene;

/// Names of the methods: a quality, of a binary tree unless it says `wide`.
pub(crate) const METHODS: [&str; 6] =
    ["fast", "balanced", "best", "fast-wide", "balanced-wide", "best-wide"];

/// What a method builds: the quality, and whether the tree is wide. A reference is by another name.
fn plan(method: &Method) -> (BuildQuality, bool) {
    let name = method.name();
    let plain = name.strip_suffix("-wide");
    let quality = BuildQuality::ALL.into_iter().find(|q| q.name() == plain.unwrap_or(name));
    (quality.unwrap_or(BuildQuality::Balanced), plain.is_some())
}

/// A run builds the tree and traces the rays, both on one thread.
fn estimate(
    run: &Run<'_>,
    scene: &Scene<Triangle>,
    pool: &ThreadPool,
) -> Result<Estimates, Missing> {
    let (quality, is_wide) = plan(run.method());
    let config = BuildConfig::from(quality);
    let primitives = &scene.primitives[..];
    let built = pool.install(|| {
        if is_wide {
            Bvh::build_wide(primitives, &[], &config)
        } else {
            Bvh::build_with(primitives, &config)
        }
    });
    let tree = built.map_err(|e| Missing::Refused(e.to_string()))?;
    let (tree, radius) = (&tree, scene.radius);
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        ambient_occlusion::<_, 1>(tree, radius, ray, sampler)
    });
    run.film(&scene.camera, &kernel)
}

/// The hall, 24 units long.
pub(crate) fn hall(primitives: Vec<Triangle>) -> Scene<Triangle> {
    let camera = Pinhole::new(vec3(-10.5, 1.8, 0.8), vec3(0.0, 2.2, -0.4), Vec3::Y, 1.0);
    Scene { primitives, camera, radius: 3.0 }
}

/// The case of a scene; each half of its reference has so many samples of each pixel.
pub(crate) fn case(
    name: &str,
    scene: Scene<Triangle>,
    samples: u32,
) -> Result<Case<'static>, Box<dyn Error>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let reference = halves(samples, |run| estimate(run, &scene, &pool))?;
    let case = Case::new(name, reference, move |run| estimate(run, &scene, &pool));
    let case = case.values(&[4, 16, 64, 256, 1024, 4096]).family("builders");
    Ok(METHODS.iter().fold(case, |case, name| case.method(*name, None)))
}
