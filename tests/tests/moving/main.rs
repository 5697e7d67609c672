//! Data that moves: what a change makes a device do, and pictures of geometry and volumes in one.

mod between;
mod device;
mod order;

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::shading::Surface;

#[primitive(sphere(center, radius))]
#[derive(Debug)]
struct Ball {
    center: Vec3,
    radius: f32,
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
