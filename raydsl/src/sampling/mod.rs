//! Random numbers, sequences and warps, for kernels.
//!
//! * [`Rng`] generates random numbers, [`Sampler`] those of a pixel's samples, placed by a
//!   [`SampleMethod`].
//! * Warps map them to [disks](sample_concentric_disk()),
//!   [hemispheres](sample_cosine_hemisphere()), [cones](sample_cone()),
//!   [triangles](sample_triangle()) and [tables](sample_table()); [`Frame`] transforms directions
//!   to surfaces.
//! * [`balance_heuristic()`] and [`power_heuristic()`] weight samples that several warps could have
//!   generated.
//!
//! All are kernels. Integers are the same in every variant, on devices too. Floats have the same
//! bits on the CPU, and the rounding that WGSL allows on devices.

mod area;
mod digits;
mod frame;
mod hash;
mod heuristics;
mod rng;
mod sampler;
mod sobol;
mod stratified;
mod table;
mod warp;

pub use area::{TRIANGLE_PDF, invert_triangle, sample_triangle, solid_angle_pdf};
pub use digits::{radical_inverse, van_der_corput};
pub use frame::{Frame, FrameOn};
pub use hash::{pcg4d, philox4x32};
pub use heuristics::{balance_heuristic, power_heuristic};
pub use rng::{ONE_MINUS_EPSILON, Rng, RngOn, unit_f32};
pub use sampler::{SampleMethod, SampleMethodOn, Sampler, SamplerOn};
pub use sobol::{owen_scramble, scrambled_sobol_1d, scrambled_sobol_2d, sobol_2d};
pub use stratified::{permuted, stratified_1d, stratified_2d};
pub use table::{
    Distribution1d, Distribution2d, TableError, TableSample, TableSample2d, TableSample2dOn,
    TableSampleOn, invert_table, invert_table_2d, sample_table, sample_table_2d, table_2d_pdf,
    table_pdf,
};
pub use warp::{
    CONCENTRIC_DISK_PDF, UNIFORM_HEMISPHERE_PDF, UNIFORM_SPHERE_PDF, bilinear_pdf, cone_pdf,
    cosine_hemisphere_pdf, invert_bilinear, invert_concentric_disk, invert_cone,
    invert_cosine_hemisphere, invert_power_cosine, invert_uniform_hemisphere,
    invert_uniform_sphere, one_minus_cos, power_cosine_pdf, sample_bilinear,
    sample_concentric_disk, sample_cone, sample_cosine_hemisphere, sample_power_cosine,
    sample_uniform_hemisphere, sample_uniform_sphere,
};
