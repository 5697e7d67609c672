//! The primitive of the example `torus`, and its mail.

#[path = "../../../../examples/torus/mail.rs"]
mod mail;
#[path = "../../../../examples/torus/shape.rs"]
mod shape;

use raydsl::prelude::*;
use raydsl_benches::scenes::Scene;

use super::Shape;
use shape::Torus;

impl Shape for Torus {
    fn normal_at(&self, ray: Ray, hit: Hit) -> Vec3 {
        self.normal(ray, hit)
    }
}

/// 200,000 rings, woven into a cloth that reaches the horizon.
pub(crate) fn rings() -> Scene<Torus> {
    let camera = Pinhole::new(vec3(-12.0, 14.0, 30.0), vec3(1.0, 0.0, -6.0), Vec3::Y, 0.7);
    Scene { prims: mail::mail(500, 400), camera }
}
