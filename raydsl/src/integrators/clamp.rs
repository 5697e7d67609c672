//! Clamping of samples.

use glam::{Vec3, Vec4, vec3, vec4};

use crate::kernel;
use crate::machine::functions::{vec3, vec4};
use crate::machine::generic::max;

/// Returns a colour scaled down so that no component is above `limit`, at least 0, and what it lost:
/// fewer bright specks, in a picture that is too dark by the mean of the second. A colour that is not
/// finite stays as it is, for the film to count.
///
/// No integrator does this unless you call it. In a film [of channels](crate::render::Film::of_channels)
/// the mean of what is lost stands beside the picture:
///
/// ```
/// use raydsl::integrators::clamped;
/// use raydsl::prelude::*;
///
/// let limit = 2.0;
/// let kernel = kernel!(|_ray: Ray, sampler: Sampler| {
///     let mut sampler = sampler;
///     let light = if sampler.next_1d() < 0.25 { 4.0 } else { 0.0 };
///     clamped(vec4(light, light, light, 1.0), limit)
/// });
/// let camera = Pinhole::new(vec3(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 0.9);
/// let (mut film, sampling) = (Film::<(Vec4, Vec3)>::of_channels(4, 4), Sampling::new(64));
/// TiledScheduler::new().accumulate(&camera, &kernel, &sampling, &mut film, 64);
/// for (color, lost) in film.channels().pixels() {
///     assert!((color.x - 0.5).abs() < 1e-6 && (lost.x - 0.5).abs() < 1e-6);
/// }
/// ```
#[kernel]
pub fn clamped(color: Vec4, limit: f32) -> (Vec4, Vec3) {
    let most = max(color.x, max(color.y, color.z));
    let size = color.truncate().abs();
    let is_finite = (size.x <= f32::MAX) & (size.y <= f32::MAX) & (size.z <= f32::MAX);
    let kept = if most > limit && is_finite { limit / most } else { 1.0 };
    let before = color.truncate();
    let after = before * kept;
    let lost = before * (1.0 - kept);
    let none = vec3(0.0, 0.0, 0.0);
    (vec4(after.x, after.y, after.z, color.w), if kept < 1.0 { lost } else { none })
}
