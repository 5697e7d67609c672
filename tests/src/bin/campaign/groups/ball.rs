//! A sphere that lights paths and cuts volumes.

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::shading::Surface;

#[primitive(sphere(center, radius))]
pub(super) struct Ball {
    pub(super) center: Vec3,
    pub(super) radius: f32,
}

#[kernel]
impl Surface for Ball {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::ONE
    }
}
