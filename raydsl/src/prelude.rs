//! What most programs need: `use raydsl::prelude::*;`.

pub use glam::{
    Affine3, BVec2, BVec3, BVec4, FloatExt as _, IVec2, IVec3, IVec4, Mat3, Mat4, UVec2, UVec3,
    UVec4, Vec2, Vec2Swizzles as _, Vec3, Vec3Swizzles as _, Vec4, Vec4Swizzles as _, bvec2, bvec3,
    bvec4, ivec2, ivec3, ivec4, mat3, mat4, uvec2, uvec3, uvec4, vec2, vec3, vec4,
};

pub use crate::bvh::{
    BuildConfig, BuildQuality, Bvh, BvhList, Instance, Instances, PrimitiveScene, Traversal,
};
pub use crate::camera::{
    Camera, CameraRays, DepthRange, Matrix, Orthographic, Pinhole, Stereo, ThinLens,
};
pub use crate::geometry::{
    Aabb, Hit, IndexedTriangle, Primitive, Ray, SurfacePoint, Triangle, cone, cuboid, cylinder,
    disk, offset_origin, plane, quad, rectangle, sphere, transform_ray, triangle, tube,
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
pub use crate::math::{F16, Unorm8, Unorm16, Unorm32};
pub use crate::render::{
    Film, Image, PixelSampler, Radiance, Renderer, Sampling, Scheduler, Shaded, SimpleScheduler,
    TiledScheduler,
};
pub use crate::sampling::{
    Distribution1d, Distribution2d, Frame, Rng, SampleMethod, Sampler, balance_heuristic,
    bilinear_pdf, cone_pdf, cosine_hemisphere_pdf, one_minus_cos, power_cosine_pdf,
    power_heuristic, sample_bilinear, sample_concentric_disk, sample_cone,
    sample_cosine_hemisphere, sample_power_cosine, sample_table, sample_table_2d, sample_triangle,
    sample_uniform_hemisphere, sample_uniform_sphere, solid_angle_pdf, table_2d_pdf, table_pdf,
};
pub use crate::shading::{ShadingPoint, facing};
pub use crate::texture::{
    Texture1, Texture2, Texture3, TextureConfig, TextureRef1, TextureRef2, TextureRef3,
    linear_to_srgb, srgb_to_linear, tex1, tex1_fetch, tex1_level, tex1_texels, tex2, tex2_fetch,
    tex2_level, tex2_texels, tex3, tex3_fetch, tex3_level, tex3_texels,
};
pub use crate::{HitRecord, RayQuery, RecordQuery, Scene, Type, primitive};
pub use raydsl_macros::kernel_closure as kernel;
