//! Clouds of points as spheres under a sun.

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl_io::cloud::PointCloud;
use rayon::prelude::*;

use crate::Pose;
use crate::cloud::{Scaled, suggested_view};

/// A point of a scan: 16 bytes.
#[primitive(sphere(center, radius.to_f32()))]
pub struct Point {
    /// Where the point is.
    pub center: Vec3,
    /// How large it is drawn.
    pub radius: Unorm8,
    /// Its colour in sRGB.
    pub color: [Unorm8; 3],
}

#[kernel]
impl Surface for Point {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        vec3(
            srgb_to_linear(self.color[0].to_f32()),
            srgb_to_linear(self.color[1].to_f32()),
            srgb_to_linear(self.color[2].to_f32()),
        )
    }
}

/// Returns a scaled cloud as spheres, in the order of its points.
pub fn spheres(cloud: &PointCloud, scaled: &Scaled) -> Vec<Point> {
    let sphere = |(c, color): (&[f32; 3], &[u8; 3])| Point {
        center: Vec3::from_array(*c),
        radius: Unorm8::from_bits(scaled.radius_code),
        color: color.map(Unorm8::from_bits),
    };
    scaled.centers.par_iter().zip(&cloud.colors).map(sphere).collect()
}

/// Returns a camera that sees all of a cloud, in scaled units.
pub fn home(cloud: &PointCloud, scaled: &Scaled) -> Pose {
    let view = suggested_view(cloud);
    let place = |p: [f64; 3]| {
        let axis = |i: usize| ((p[i] - scaled.offset[i]) * scaled.scale) as f32;
        vec3(axis(0), axis(1), axis(2))
    };
    Pose {
        eye: place(view.eye),
        target: place(view.target),
        up: Vec3::from_array(view.up.map(|c| c as f32)).normalize_or(Vec3::Z),
        fov_y: view.fov_y_degrees.to_radians() as f32,
    }
}

/// Returns the direction to the sun where `up` is up.
pub fn to_sun(up: Vec3) -> Vec3 {
    (up + vec3(0.5, -0.3, 0.2)).normalize_or(up)
}

/// Returns the light of a clear sky from a direction.
#[kernel]
pub fn sky(up: Vec3, direction: Vec3) -> Vec3 {
    let zenith = vec3(0.11, 0.23, 0.53);
    let horizon = vec3(0.7, 0.76, 0.8);
    horizon + (zenith - horizon) * clamp(direction.dot(up) * 1.6 + 0.7, 0.0, 1.0)
}

/// Returns the light along a ray: that of a point under a sun, or of the sky.
#[kernel]
pub fn daylight(points: &Bvh<'_, Point>, up: Vec3, sun: Vec3, ray: Ray) -> Vec3 {
    let hit = points.closest_hit(ray);
    let mut color = sky(up, ray.direction);
    if hit.is_hit {
        let seen = facing(points.surface(ray, hit), ray.direction);
        let lit = max(seen.normal.dot(sun), 0.0);
        let above = 0.5 + 0.5 * seen.normal.dot(up);
        color = points.primitive(hit).albedo(ray, hit) * (0.25 + 0.3 * above + 0.65 * lit);
    }
    color
}
