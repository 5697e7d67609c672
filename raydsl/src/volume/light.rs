//! Light that a ray gathers in volumes, front to back.

use glam::{Vec3, Vec4, vec3, vec4};

use crate::machine::functions::{vec3, vec4};
use crate::machine::generic::min;
use crate::math::elementary::{exp, expm1};
use crate::{Type, kernel};

/// What a ray has gathered on its way: the radiance of what it passed, and the optical depth.
///
/// Integrators take it and return it with what the next part of the ray adds, so the parts of a
/// ray, volumes one behind another and surfaces between them are one sum, front to back. The sums
/// carry their rounding errors along: a million thin cells are as exact as one thick cell.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::VolumeLight;
///
/// let glass = VolumeLight::new().then(vec3(0.25, 0.0, 0.0), 4f32.ln());
/// assert!((glass.opacity() - 0.75).abs() < 1e-6);
/// assert!((glass.over(Vec3::ONE).y - 0.25).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct VolumeLight {
    /// Radiance that arrives at the ray's origin.
    pub radiance: Vec3,
    /// Optical depth: the integral of extinction along the ray.
    pub depth: f32,
    radiance_rest: Vec3,
    depth_rest: f32,
}

/// Optical depth that counts as infinite: sums of it stay finite.
pub(super) const MOST_OPTICAL_DEPTH: f32 = 1e30;

/// Returns the same number, opaque to compilers: those of some drivers reorder sums.
#[kernel]
#[inline]
fn kept(a: Vec4) -> Vec4 {
    min(a, vec4(f32::MAX, f32::MAX, f32::MAX, f32::MAX))
}

/// Returns the rounding error of `a + b`. (Knuth, TAOCP 2, 4.2.2, theorem B.)
#[kernel]
#[inline]
fn lost_by_sum(a: Vec4, b: Vec4) -> Vec4 {
    let sum = kept(a + b);
    let part = kept(sum - a);
    (a - (sum - part)) + (b - part)
}

#[kernel]
impl VolumeLight {
    /// Creates the light of a ray that has passed nothing yet.
    #[inline]
    pub fn new() -> Self {
        let none = vec3(0.0, 0.0, 0.0);
        Self { radiance: none, depth: 0.0, radiance_rest: none, depth_rest: 0.0 }
    }

    /// Returns the light behind a further part of the ray, with the part's own radiance and depth.
    #[inline]
    pub fn then(self, radiance: Vec3, depth: f32) -> Self {
        let arriving = radiance * self.transmittance();
        let depth = min(depth, MOST_OPTICAL_DEPTH);
        let sum = vec4(self.radiance.x, self.radiance.y, self.radiance.z, self.depth);
        let more = vec4(
            arriving.x + self.radiance_rest.x,
            arriving.y + self.radiance_rest.y,
            arriving.z + self.radiance_rest.z,
            depth + self.depth_rest,
        );
        let total = sum + more;
        let lost = lost_by_sum(sum, more);
        Self {
            radiance: vec3(total.x, total.y, total.z),
            depth: total.w,
            radiance_rest: vec3(lost.x, lost.y, lost.z),
            depth_rest: lost.w,
        }
    }

    /// Returns the share of light that passes, from 0 to 1.
    #[inline]
    pub fn transmittance(&self) -> f32 {
        exp(-self.depth)
    }

    /// Returns the share of light that is absorbed, from 0 to 1, without loss where it is small.
    #[inline]
    pub fn opacity(&self) -> f32 {
        -expm1(-self.depth)
    }

    /// Returns the radiance of the volume in front of a background.
    #[inline]
    pub fn over(&self, background: Vec3) -> Vec3 {
        self.radiance + background * self.transmittance()
    }

    /// Returns radiance and opacity, the colour of a pixel with premultiplied alpha.
    #[inline]
    pub fn rgba(&self) -> Vec4 {
        vec4(self.radiance.x, self.radiance.y, self.radiance.z, self.opacity())
    }
}
