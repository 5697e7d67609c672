//! The primitive of the example `hair`, and its ball of fur.

#[path = "../../../../examples/hair/fur.rs"]
mod fur;
#[path = "../../../../examples/hair/shape.rs"]
mod shape;

use raydsl::prelude::*;
use raydsl_benches::scenes::Scene;

use super::Shape;
use shape::{Hair, HairHit};

impl Shape for Hair {
    /// Of the cross-section: towards the ray, across the hair.
    fn normal_at(&self, ray: Ray, found: HairHit) -> Vec3 {
        let toward = -ray.direction;
        (toward - found.tangent * toward.dot(found.tangent)).normalize_or(toward)
    }
}

/// The 36,000 hairs of the example, seen as there.
pub(crate) fn fur() -> Scene<Hair> {
    let camera = Pinhole::new(vec3(0.0, 0.5, 4.6), vec3(0.02, -0.07, 0.0), Vec3::Y, 0.61);
    Scene { prims: fur::fur(36_000), camera }
}
