//! Primitives of one's own, a scene of each with a camera, and how rays leave them.

mod hair;
mod kinds;
mod torus;

use raydsl::geometry::Primitive;
use raydsl::prelude::*;
use raydsl_benches::scenes::{self, ColorSphere, Scene};

pub(crate) use hair::fur;
pub(crate) use kinds::kinds;
pub(crate) use torus::rings;

/// A primitive with a normal, so that rays can leave it.
pub(crate) trait Shape: Primitive<Shared = ()> {
    /// The normal where `ray` hits.
    fn normal_at(&self, ray: Ray, found: Self::Hit) -> Vec3;
}

impl Shape for ColorSphere {
    fn normal_at(&self, ray: Ray, hit: Hit) -> Vec3 {
        (ray.at(hit.t) - self.center).normalize_or(Vec3::Y)
    }
}

/// 400,000 points of a scan: spheres of 16 bytes with a colour.
pub(crate) fn scan() -> Scene<ColorSphere> {
    scenes::scan(400_000)
}
