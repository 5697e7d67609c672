//! How open the places are that a camera sees in a scene: no closed form, so two halves of a
//! reference.

use core::error::Error;
use std::time::Instant;

use raydsl::integrators::ambient_occlusion;
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl_report::Missing;
use raydsl_report::work_precision::{Case, Estimates, Order, Run, Work};

use crate::cloud::halves;
use crate::visibility::{Ball, SAMPLES};

#[raydsl::kernel]
impl Surface for Ball {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        vec3(0.8, 0.8, 0.8)
    }
}

/// What is seen from where, and how far away its surroundings may be to count.
pub(crate) struct Scene<P> {
    /// Its primitives.
    pub(crate) primitives: Vec<P>,
    /// The camera.
    pub(crate) camera: Pinhole,
    /// What is farther away hides nothing.
    pub(crate) radius: f32,
}

/// A tree of the scene, and how to look at it.
struct View<P: Primitive + 'static> {
    tree: &'static Bvh<'static, P>,
    camera: Pinhole,
    radius: f32,
}

impl<P: Primitive<Hit = Hit, Shared = ()> + Surface + Sync + 'static> View<P> {
    fn estimate(&self, run: &Run<'_>) -> Result<Estimates, Missing> {
        let (tree, radius) = (self.tree, self.radius);
        let kernel = kernel!(|ray: Ray, sampler: Sampler| {
            ambient_occlusion::<_, 1>(tree, radius, ray, sampler)
        });
        run.film(&self.camera, &kernel)
    }

    /// The ray of the camera, and the one from where it meets the scene.
    fn work(&self, run: &Run<'_>) -> Work {
        run.film_work(&self.camera, |ray, mut sampler| {
            let (hit, cost) = self.tree.closest_hit_with_cost(ray);
            let seen = Work { texture_fetches: Some(0), ..cost.into() };
            if !hit.is_hit {
                return seen;
            }
            let point = facing(self.tree.primitive(hit).surface(ray, hit), ray.direction);
            let direction = sample_cosine_hemisphere(sampler.next_2d());
            let next = point.ray(Frame::around(point.normal).to_world(direction));
            let (_, cost) = self.tree.any_hit_with_cost(Ray { t_max: self.radius, ..next });
            seen + cost.into()
        })
    }
}

/// The case of a scene; each half of its reference has so many samples of each pixel.
pub(crate) fn case<P: Primitive<Hit = Hit, Shared = ()> + Surface + Sync + 'static>(
    name: &str,
    scene: Scene<P>,
    samples: u32,
) -> Result<Case<'static>, Box<dyn Error>> {
    let Scene { primitives, camera, radius } = scene;
    let start = Instant::now();
    let tree: &'static Bvh<'static, P> = Box::leak(Box::new(Bvh::build(primitives.leak())?));
    let (build, view) = (start.elapsed(), View { tree, camera, radius });
    let view: &'static View<P> = Box::leak(Box::new(view));
    let reference = halves(samples, |run| view.estimate(run))?;
    // Edges in four dimensions, two of them the pixel's: theory says nothing of their constants.
    Ok(Case::new(name, reference, move |run| view.estimate(run))
        .counted(move |run| view.work(run))
        .built_in(build)
        .values(&SAMPLES)
        .family("openness")
        .method(SampleMethod::Random, Some(Order::RANDOM))
        .method(SampleMethod::Stratified, None)
        .method(SampleMethod::Sobol, None))
}
