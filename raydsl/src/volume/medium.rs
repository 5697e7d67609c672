//! Media that scatter light, as integrators of light transport see them.

use glam::{Vec3, vec3};

use super::integrator::{Inside, inside};
use super::march::sample_at;
use super::tracking::{delta_tracking, free_depth};
use super::transfer::TransferSample;
use super::volume::Volume;
use super::voxel::Voxel;
use crate::geometry::Ray;
use crate::machine::functions::vec3;
use crate::machine::generic::{length, max};
use crate::math::elementary::exp;
use crate::sampling::Rng;
use crate::{Type, kernel};

/// What light on a ray meets in a medium.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct Collision {
    /// Whether there is a collision; otherwise light passes.
    pub is_met: bool,
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
    /// Share of light that is scattered, and not absorbed, from 0 to 1: red, green and blue.
    pub albedo: Vec3,
    /// Radiance that the medium adds: what it emits over its extinction.
    pub emission: Vec3,
    /// Mean cosine of scattering: see [`henyey_greenstein()`](super::henyey_greenstein()).
    pub anisotropy: f32,
}

#[kernel]
impl Collision {
    /// Returns no collision.
    #[inline]
    pub fn none() -> Self {
        let none = vec3(0.0, 0.0, 0.0);
        Self { is_met: false, t: 0.0, albedo: none, emission: none, anisotropy: 0.0 }
    }
}

/// Returns a random collision on the ray between `t_min` and `t_max`, by [`delta_tracking()`]. The
/// colour of the transfer function is what is scattered.
///
/// For a medium that emits the colour instead, as the integrators of volumes see it:
/// `Collision { emission: c.albedo, albedo: Vec3::ZERO, ..c }`.
#[kernel]
#[inline(never)]
pub fn collision<T: Voxel>(
    volume: &Volume<'_, T>,
    anisotropy: f32,
    ray: Ray,
    rng: &mut Rng,
) -> Collision {
    let part: Inside = inside(volume.grid(), ray);
    let (start, _) = volume.grid().span(ray);
    let none = vec3(0.0, 0.0, 0.0);
    let found = delta_tracking(volume, ray, &mut *rng);
    let is_met = found.is_some();
    let t = found.unwrap_or(0.0);
    let mut albedo = none;
    if is_met {
        let sample: TransferSample = sample_at(volume, part, t - start);
        albedo = sample.color;
    }
    Collision { is_met, t, albedo, emission: none, anisotropy }
}

/// A medium that is the same everywhere, as fog is.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::Fog;
///
/// // Of light through a depth of 2, exp(-2) passes: by collisions, and by the formula.
/// let fog = Fog { extinction: 0.5, albedo: Vec3::ONE, anisotropy: 0.0 };
/// let ray = Ray::new(Vec3::ZERO, Vec3::Z * 2.0).with_range(0.0, 2.0);
/// let passes = kernel!(|seed: u32| {
///     let mut rng = Rng::new(uvec2(seed, 0), 0, 1);
///     !fog.collision(ray, &mut rng).is_met
/// });
/// let count = (0..10_000).filter(|seed| passes.call((*seed,))).count();
/// assert!((count as f32 / 1e4 - (-2.0f32).exp()).abs() < 0.02);
/// assert!((fog.transmittance(ray) - (-2.0f32).exp()).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct Fog {
    /// Extinction per length, at least 0: the inverse of the mean free path.
    pub extinction: f32,
    /// Share of it that is scattered, and not absorbed, from 0 to 1: red, green and blue.
    pub albedo: Vec3,
    /// Mean cosine of scattering: see [`henyey_greenstein()`](super::henyey_greenstein()).
    pub anisotropy: f32,
}

#[kernel]
impl Fog {
    /// Returns a random collision on the ray between `t_min` and `t_max`.
    #[inline]
    pub fn collision(self, ray: Ray, rng: &mut Rng) -> Collision {
        let per_length = self.extinction * length(ray.direction);
        let way = free_depth(&mut *rng) / per_length;
        let is_met = per_length > 0.0 && way < ray.t_max - ray.t_min;
        let t = if is_met { ray.t_min + way } else { 0.0 };
        let emission = vec3(0.0, 0.0, 0.0);
        Collision { is_met, t, albedo: self.albedo, emission, anisotropy: self.anisotropy }
    }

    /// Returns the transmittance between `t_min` and `t_max`; 1 where that is empty.
    #[inline]
    pub fn transmittance(self, ray: Ray) -> f32 {
        let way = max(ray.t_max - ray.t_min, 0.0);
        exp(-(self.extinction * length(ray.direction) * way))
    }
}
