//! Integrators: ready-made kernels to render with, each as short as one would write it oneself.
//!
//! | kernel | result for a ray |
//! |---|---|
//! | [`direct_light()`] | radiance of diffuse surfaces under point and directional lights |
//! | [`ambient_occlusion()`] | unoccluded share of the hemisphere above the hit |
//! | [`aovs()`] | albedo, normal, depth and ids of the closest hit |
//! | [`bvh_cost()`], [`bvh_cost_color()`] | traversal cost, as counts or as a colour |
//!
//! They are kernels like any other: call them in a [`kernel!`](crate::prelude::kernel) of yours,
//! from a kernel of yours, or on the host. They take any [`Scene`](crate::shading::Scene): a
//! tree, a list, instances, or a struct of several. For other lights copy the source: each fits on a
//! page.
//!
//! ```
//! use raydsl::integrators::{DirectionalLight, direct_light};
//! use raydsl::prelude::*;
//!
//! let v = |x, y| vec3(x, y, 0.0);
//! let triangles = [Triangle { v0: v(-1.0, -1.0), v1: v(3.0, -1.0), v2: v(-1.0, 3.0) }];
//! let scene = Bvh::build(&triangles)?;
//! let suns = [DirectionalLight { direction: Vec3::Z, irradiance: Vec3::ONE }];
//! let (lamps, shadows) = (&[][..], true);
//! let suns = &suns[..];
//! let kernel = kernel!(|ray: Ray| direct_light(&scene, lamps, suns, host(shadows), ray));
//! let camera = Pinhole::new(vec3(0.0, 0.0, 2.0), Vec3::ZERO, Vec3::Y, 0.5);
//! let mut image = Image::filled(16, 16, Vec4::ZERO);
//! TiledScheduler::new().frame(&camera, &kernel, &mut image);
//! // 0.8 of the light comes back, evenly over the hemisphere.
//! assert!((image.pixels()[0].x - 0.8 / core::f32::consts::PI).abs() < 1e-6);
//! # Ok::<(), raydsl::bvh::BuildError>(())
//! ```

mod cost;
mod direct;
mod lights;
mod occlusion;
mod outputs;

pub use cost::{bvh_cost, bvh_cost_color, heat_color};
pub use direct::{direct_light, irradiance};
pub use lights::{DirectionalLight, Light, PointLight};
pub use occlusion::{ambient_occlusion, is_open};
pub use outputs::{Aovs, AovsOn, aovs};
