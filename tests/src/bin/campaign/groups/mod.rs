//! What is measured, a file for each subject.

mod accumulation;
mod ball;
mod boxes;
mod bsdfs;
mod builders;
mod elementary;
mod frames;
mod lights;
mod odd;
mod offsets;
mod sampling;
mod shadows;
mod spheres;
mod splits;
mod statistics;
mod textures;
mod triangles;
mod unorms;
mod volumes;

use std::error::Error;

use raydsl::bvh::BuildError;
use raydsl::prelude::*;

use crate::outcome::Outcome;
use crate::row::Group;

/// Every group, in the order of the book.
pub(crate) const ALL: &[Group] = &[
    triangles::GROUP,
    spheres::GROUP,
    boxes::GROUP,
    builders::GROUP,
    splits::GROUP,
    offsets::GROUP,
    elementary::GROUP,
    unorms::GROUP,
    textures::GROUP,
    volumes::GROUP,
    accumulation::GROUP,
    sampling::GROUP,
    frames::GROUP,
    bsdfs::GROUP,
    lights::GROUP,
    odd::GROUP,
];

/// Measures a row with a kernel, which is made where it is used.
type Measure<'m, A, R> = dyn for<'k> Fn(&[Kernel<'k, A, R>]) -> Measured + 'm;

/// What measuring gives.
type Measured = Result<Outcome, Box<dyn Error>>;

/// Why rows at the lowest scale are missed on some devices.
const FLUSHED: &str = "On a device that takes denormals for 0: products of coordinates are denormal at this \
                       scale.";

/// 1 for a fault.
fn fault(is_wrong: bool) -> Option<f64> {
    Some(f64::from(u8::from(is_wrong)))
}

/// Builds a tree, a binary or a wide one, however few the primitives are.
fn tree<P: Primitive<Shared = ()>>(prims: &[P], is_wide: bool) -> Result<Bvh<'_, P>, BuildError> {
    if !is_wide {
        return Bvh::build(prims);
    }
    Bvh::build_wide(prims, &[], &BuildConfig { min_wide_size: 0, ..BuildConfig::default() })
}

/// A kernel for the closest hit of a ray.
type Closest<'a> = Kernel<'a, (Ray,), Hit>;

/// Gives `work` a kernel for the closest hit in a tree of triangles. A kernel takes long to compile:
/// rows share this one.
fn closest<T>(bvh: &Bvh<'_, Triangle>, work: impl FnOnce(&Closest<'_>) -> T) -> T {
    let (mut work, mut result) = (Some(work), None);
    with_kernel(bvh, &mut |kernel| result = work.take().map(|work| work(kernel)));
    result.expect("the kernel is given once")
}

/// Not generic, so that it is compiled once.
fn with_kernel(bvh: &Bvh<'_, Triangle>, work: &mut dyn FnMut(&Closest<'_>)) {
    work(&kernel!(|ray: Ray| bvh.closest_hit(ray)));
}

/// The largest of some errors; a NaN is larger than all.
fn largest(errors: impl IntoIterator<Item = f64>) -> f64 {
    let number = |error: f64| if error.is_nan() { f64::INFINITY } else { error };
    errors.into_iter().map(number).fold(0.0, f64::max)
}
