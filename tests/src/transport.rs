//! Scenes of light transport that have closed forms: a sphere, a floor under a dome, a medium.

use std::f32::consts::PI;

use raydsl::bsdf::{Bsdf, BsdfSample, Material, NO_LIGHT};
use raydsl::light::{AnyLight, AreaLight, LightShape, SphereShape};
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::volume::{Grid, GridConfig, GridError, TransferError, TransferFunction};
use raydsl::{Type, kernel};

/// A sphere.
#[primitive(sphere(center, radius))]
#[derive(Debug)]
pub struct Ball {
    /// The centre.
    pub center: Vec3,
    /// The radius.
    pub radius: f32,
}

/// A disk.
#[primitive(disk(center, normal, radius))]
#[derive(Debug)]
pub struct Plate {
    /// The centre.
    pub center: Vec3,
    /// The unit normal.
    pub normal: Vec3,
    /// The radius.
    pub radius: f32,
}

macro_rules! surfaces {
    ($($t:ident),+) => {
        $(
            #[kernel]
            impl Surface for $t {
                fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
                    self.surface_point(ray, hit)
                }

                fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
                    Vec3::ONE
                }
            }
        )+
    };
}

surfaces!(Ball, Plate);

/// A dome, and a floor under it.
#[derive(Debug, Scene)]
pub struct Dome<'a> {
    /// Spheres around the floor; their instance id is 0.
    pub dome: &'a [Ball],
    /// Disks; their instance id is 1.
    pub floor: &'a [Plate],
}

/// The unit sphere.
pub const BALL: [Ball; 1] = [Ball { center: Vec3::ZERO, radius: 1.0 }];
/// The unit disk that faces `+z`.
pub const FLOOR: [Plate; 1] = [Plate { center: Vec3::ZERO, normal: Vec3::Z, radius: 1.0 }];

/// Paint that is half a mirror, and lets a part of the light pass; samples of its diffuse part are
/// uniform, so that their weights are up to twice their mean.
#[derive(Clone, Copy, Debug, Type)]
pub struct Paint {
    /// Share of the light that is reflected.
    pub albedo: f32,
    /// Share of it that is reflected as by a mirror.
    pub mirrored: f32,
    /// Index of the light that the surface is, or [`NO_LIGHT`].
    pub light: u32,
    /// Share of the rays that meet the surface.
    pub opacity: f32,
}

#[kernel]
impl Bsdf for Paint {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let diffuse = self.albedo * (1.0 - self.mirrored) * wi.z.abs() / PI;
        Vec3::splat(if wo.z * wi.z > 0.0 { diffuse } else { 0.0 })
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        if u.z < self.mirrored {
            let mirrored = vec3(-wo.x, -wo.y, wo.z);
            return BsdfSample::delta(mirrored, Vec3::splat(self.albedo), self.mirrored);
        }
        let up = sample_uniform_hemisphere(vec2(u.x, u.y));
        let wi = vec3(up.x, up.y, if wo.z < 0.0 { -up.z } else { up.z });
        BsdfSample::of(wi, Paint::eval(self, wo, wi), Paint::pdf(self, wo, wi))
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z * wi.z > 0.0 { (1.0 - self.mirrored) * (0.5 / PI) } else { 0.0 }
    }
}

#[kernel]
impl Material for Paint {
    fn light(&self) -> u32 {
        self.light
    }

    fn opacity(&self) -> f32 {
        self.opacity
    }
}

/// Returns opaque diffuse paint that is no light.
pub const fn paint(albedo: f32) -> Paint {
    Paint { albedo, mirrored: 0.0, light: NO_LIGHT, opacity: 1.0 }
}

/// Returns a light of this shape and radiance.
pub fn area<S: LightShape + Type>(shape: S, radiance: f32, is_two_sided: bool) -> AreaLight<S> {
    AreaLight::<S> { shape, radiance: Vec3::splat(radiance), is_two_sided }
}

/// Returns the unit sphere as a light, on both sides.
pub fn shining_sphere(emission: f32) -> AnyLight {
    AnyLight::Sphere(area(SphereShape { center: Vec3::ZERO, radius: 1.0 }, emission, true))
}

/// Returns a box around all scenes.
pub fn cube() -> Aabb {
    Aabb { min: Vec3::splat(-2.0), max: Vec3::splat(2.0) }
}

/// Returns 3 x 3 x 3 voxels over the box around the unit sphere.
///
/// # Errors
///
/// If there are not 27 of them.
pub fn medium(voxels: &[f32]) -> Result<Grid<'_, f32>, GridError> {
    Grid::new(voxels, uvec3(3, 3, 3), GridConfig::new().origin(Vec3::splat(-1.0)))
}

/// Returns a function with one colour: 0 is an extinction of 0.2, and 1 of 3.
///
/// # Errors
///
/// If the colour is no number.
pub fn murk(albedo: f32) -> Result<TransferFunction, TransferError> {
    let color = Vec3::splat(albedo);
    TransferFunction::from_extinction(&[(0.0, color)], &[(0.0, 0.2), (1.0, 3.0)])
}

/// Returns a camera that sees [`BALL`] far away, in one block of 16 x 16 pixels of fifteen, the columns
/// and rows of its film, and the exact picture of a ball of albedo 0.75 in a white furnace, row by row
/// from the bottom, if rays pass through the middles of pixels.
///
/// # Panics
///
/// If rounding could decide whether a ray meets the ball.
pub fn far_ball() -> (Pinhole, (u32, u32), Vec<f64>) {
    let (size, fov, distance) = ((80, 48), 0.6f32, 12.0);
    let pixel = 2.0 * f64::from(fov / 2.0).tan() / f64::from(size.1);
    let truth = (0..size.0 * size.1).map(|i| {
        let at = |i: u32, n: u32| (f64::from(i) + 0.5 - 0.5 * f64::from(n)) * pixel;
        let square = at(i % size.0, size.0).powi(2) + at(i / size.0, size.1).powi(2);
        let aside = distance * distance * square / (1.0 + square);
        assert!((aside - 1.0).abs() > 1e-3, "a ray along the edge");
        if aside < 1.0 { 0.75 } else { 1.0 }
    });
    let eye = vec3(0.0, 0.0, distance as f32);
    (Pinhole::new(eye, Vec3::ZERO, Vec3::Y, fov), size, truth.collect())
}
