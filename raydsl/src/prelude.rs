//! What most programs need: `use raydsl::prelude::*;`.

pub use glam::{Vec2, Vec3, Vec4, vec2, vec3, vec4};

pub use crate::bvh::{Bvh, Slice};
pub use crate::camera::Pinhole;
pub use crate::geometry::{Aabb, Hit, Primitive, Ray, Triangle, sphere};
#[cfg(feature = "gpu")]
pub use crate::gpu::GpuScheduler;
pub use crate::kernel::{Kernel, Variant, Variants};
pub use crate::machine::functions::{clamp, max, min, vec2, vec3, vec4};
pub use crate::machine::host::host;
pub use crate::math::elementary::{
    SinCos, acos, asin, atan, atan2, cos, exp, exp2, expm1, log, log1p, log2, pow, sin, sincos_2pi,
    tan,
};
pub use crate::math::{Unorm8, Unorm16, Unorm32};
pub use crate::render::{Image, Scheduler, Shaded, SimpleScheduler, TiledScheduler};
pub use crate::report::compare;
pub use crate::{Type, primitive};
pub use raydsl_macros::kernel_closure as kernel;
