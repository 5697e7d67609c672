//! One function for one ray and for packets of any width.

use raydsl::kernel;
use raydsl::prelude::*;

/// Rays that miss a unit sphere leave early; the others get its depth along the ray.
#[kernel]
pub(crate) fn thickness(ray: Ray) -> f32 {
    let d = ray.direction.normalize();
    let along = ray.origin.dot(d);
    let aside = ray.origin - d * along;
    let square = 1.0 - aside.dot(aside);
    if square < 0.0 {
        return 0.0;
    }
    2.0 * square.sqrt()
}

/// The mean, by packets of a width that the caller chooses, and by the function itself.
pub(crate) fn means(variant: Variant, rays: &[(Ray,)]) -> (f32, f32) {
    let mut found = vec![0.0; rays.len()];
    Kernel::of::<thickness>().run(variant, rays, &mut found);
    let scalar: f32 = rays.iter().map(|(ray,)| thickness(*ray)).sum();
    (found.iter().sum::<f32>() / rays.len() as f32, scalar / rays.len() as f32)
}
