//! What most programs need: `use raydsl::prelude::*;`.

pub use glam::{
    Affine3, BVec2, BVec3, BVec4, FloatExt as _, IVec2, IVec3, IVec4, Mat3, Mat4, UVec2, UVec3,
    UVec4, Vec2, Vec2Swizzles as _, Vec3, Vec3Swizzles as _, Vec4, Vec4Swizzles as _, bvec2, bvec3,
    bvec4, ivec2, ivec3, ivec4, mat3, mat4, uvec2, uvec3, uvec4, vec2, vec3, vec4,
};

pub use crate::bvh::{BuildConfig, BuildQuality, Bvh, BvhList, RayQuery};
pub use crate::camera::Pinhole;
pub use crate::geometry::{
    Aabb, Hit, IndexedTriangle, Primitive, Ray, Triangle, cone, cuboid, cylinder, disk, plane,
    quad, rectangle, sphere, triangle, tube,
};
#[cfg(feature = "gpu")]
pub use crate::gpu::GpuScheduler;
pub use crate::kernel::{Kernel, Variant, Variants};
pub use crate::machine::functions::{
    bvec2, bvec3, bvec4, ivec2, ivec3, ivec4, mat3, mat4, uvec2, uvec3, uvec4, vec2, vec3, vec4,
};
pub use crate::machine::generic::{
    all, any, clamp, determinant, distance, dot, inverse, length, max, min, normalize, select,
    transform_point, transform_vector,
};
pub use crate::machine::host::host;
pub use crate::machine::wgsl::Arithmetic;
pub use crate::math::elementary::{
    SinCos, acos, asin, atan, atan2, cos, exp, exp2, expm1, log, log1p, log2, pow, sin, sincos_2pi,
    tan,
};
pub use crate::math::{Unorm8, Unorm16, Unorm32};
pub use crate::render::{Image, Scheduler, Shaded, SimpleScheduler, TiledScheduler};
pub use crate::report::compare;
pub use crate::{HitRecord, Type, primitive};
pub use raydsl_macros::kernel_closure as kernel;
