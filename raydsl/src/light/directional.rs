//! Lights that are infinitely far away.

use core::f32::consts::PI;

use glam::{Vec2, Vec3, vec3};

use super::{DistantLight, Light, LightExtent, LightSample, luminance};
use crate::machine::functions::vec3;
use crate::sampling::{Frame, cone_pdf, one_minus_cos, sample_cone};
use crate::{Type, kernel};

/// A directional light, so far away that its rays are parallel, such as the sun, or all but
/// parallel: then it is a disk in the sky, and its shadows have soft edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct DirectionalLight {
    /// Unit vector towards the light.
    pub direction: Vec3,
    /// Irradiance at normal incidence, as red, green and blue, not negative.
    pub irradiance: Vec3,
    /// Sine of half of the angle under which the disk is seen: 0 for parallel rays, 0.00465 for the
    /// sun, at most 1.
    pub sine: f32,
}

#[kernel]
impl DirectionalLight {
    /// Returns the radiance of the disk: its projected solid angle is `pi sine²`.
    #[inline]
    fn radiance(self) -> Vec3 {
        self.irradiance / (PI * self.sine * self.sine)
    }
}

/// Least sine of a disk; less is parallel.
const MIN_SINE: f32 = 1e-4;

#[kernel]
impl Light for DirectionalLight {
    fn sample(&self, _from: Vec3, u: Vec2) -> LightSample {
        let is_disk = self.sine >= MIN_SINE;
        if !is_disk {
            return LightSample::distant(self.direction, self.irradiance, 1.0, true);
        }
        let height = one_minus_cos(self.sine);
        let wi = Frame::around(self.direction).to_world(sample_cone(u, height));
        LightSample::distant(wi, DirectionalLight::radiance(*self), cone_pdf(height), false)
    }

    fn distant(&self, direction: Vec3) -> DistantLight {
        let none = vec3(0.0, 0.0, 0.0);
        let is_disk = self.sine >= MIN_SINE;
        if !is_disk {
            return DistantLight { radiance: none, pdf: 0.0 };
        }
        let height = one_minus_cos(self.sine);
        // The sine is accurate next to the axis, where the cosine is not.
        let across = self.direction.cross(direction);
        let is_ahead = self.direction.dot(direction) > 0.0;
        let is_within = is_ahead && across.dot(across) <= self.sine * self.sine;
        DistantLight {
            radiance: if is_within { DirectionalLight::radiance(*self) } else { none },
            pdf: if is_within { cone_pdf(height) } else { 0.0 },
        }
    }

    fn is_distant(&self) -> bool {
        true
    }

    fn power(&self, radius: f32) -> f32 {
        PI * radius * radius * luminance(self.irradiance)
    }

    fn extent(&self) -> LightExtent {
        let none = vec3(0.0, 0.0, 0.0);
        let axis = -self.direction;
        LightExtent { min: none, max: none, axis, cos_normals: 1.0, cos_emitted: 1.0 }
    }
}
