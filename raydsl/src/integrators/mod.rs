//! Integrators: ready-made kernels to render with, each as short as one would write it oneself.
//!
//! | kernel | result for a ray |
//! |---|---|
//! | [`direct_light()`] | radiance of any surfaces under any lights, by one sample of each light |
//! | [`whitted()`] | the same, seen by mirrors and smooth glass |
//! | [`path()`], [`path_with()`] | light that is scattered many times, by one path |
//! | [`path_step()`] | one step of a path, a [`Stepped`] state, for schedulers that refill lanes |
//! | [`volume_path()`] | the same, through a medium that scatters, absorbs or emits light |
//! | [`clamped()`] | a colour of at most a limit, and what it lost |
//! | [`ambient_occlusion()`] | unoccluded share of the hemisphere above the hit |
//! | [`aovs()`] | albedo, normal, depth and ids of the closest hit |
//! | [`bvh_cost()`], [`bvh_cost_color()`] | traversal cost, as counts or as a colour |
//!
//! They are kernels like any other: call them in a [`kernel!`](crate::prelude::kernel) of yours,
//! from a kernel of yours, or on the host. They take any [`Scene`](crate::shading::Scene): a
//! tree, a list, instances, or a struct of several; any material and any lights, those of
//! [`bsdf`](crate::bsdf) and [`light`](crate::light) or your own. Each fits on a page: copy the source
//! for what they do not do.
//!
//! ```
//! use raydsl::bsdf::Lambert;
//! use raydsl::integrators::direct_light;
//! use raydsl::light::{DirectionalLight, Lights};
//! use raydsl::prelude::*;
//!
//! let v = |x, y| vec3(x, y, 0.0);
//! let triangles = [Triangle { v0: v(-1.0, -1.0), v1: v(3.0, -1.0), v2: v(-1.0, 3.0) }];
//! let scene = Bvh::build(&triangles)?;
//! let sun = DirectionalLight { direction: Vec3::Z, irradiance: Vec3::ONE, sine: 0.0 };
//! let (suns, shadows) = ([sun], true);
//! let lights = Lights::new(&suns, scene.bounds())?;
//! let kernel = kernel!(|ray: Ray, sampler: Sampler| {
//!     let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
//!     direct_light::<_, _, Lambert>(&scene, surface, &lights, host(shadows), ray, sampler)
//! });
//! let camera = Pinhole::new(vec3(0.0, 0.0, 2.0), Vec3::ZERO, Vec3::Y, 0.5);
//! let mut film = Film::new(16, 16);
//! TiledScheduler::new().accumulate(&camera, &kernel, &Sampling::new(1), &mut film, 1);
//! // 0.8 of the light comes back, evenly over the hemisphere.
//! assert!((film.image().pixels()[0].x - 0.8 / core::f32::consts::PI).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod clamp;
mod cost;
mod direct;
mod masks;
mod media;
mod occlusion;
mod outputs;
mod path_tracing;
mod stepped;

pub use clamp::clamped;
pub use cost::{bvh_cost, bvh_cost_color, heat_color};
pub use direct::{
    Scattering, ScatteringOn, direct_light, from_each_light, next_3d, scattered_light,
    scattering_at, whitted,
};
pub use masks::{closest_surface, is_occluded};
pub use media::volume_path;
pub use occlusion::{ambient_occlusion, is_open};
pub use outputs::{Aovs, AovsOn, aovs};
pub use path_tracing::{
    LightSampling, PathLimits, PathLimitsOn, PathOptions, PathSample, PathSampleOn, PathState,
    PathStateOn, PathStep, PathStepOn, path, path_step, path_with,
};
pub use stepped::Stepped;
