//! Lights at a point.

use core::f32::consts::PI;

use glam::{Vec2, Vec3, vec3};

use super::{Light, LightExtent, LightSample, luminance};
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, max};
use crate::{Type, kernel};

/// An isotropic point light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct PointLight {
    /// The position of the light.
    pub position: Vec3,
    /// Radiant intensity (flux per unit of solid angle) as red, green and blue, not negative. The
    /// irradiance at normal incidence and distance `r` is `intensity / r²`.
    pub intensity: Vec3,
}

/// A point light that shines into a cone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct SpotLight {
    /// The position of the light.
    pub position: Vec3,
    /// Radiant intensity along the axis: red, green and blue, not negative.
    pub intensity: Vec3,
    /// Unit vector along the axis, away from the light.
    pub direction: Vec3,
    /// Cosine of the angle to the axis up to which the intensity is that of the axis.
    pub cos_inner: f32,
    /// Cosine of the angle beyond which there is no light, less than `cos_inner`.
    pub cos_outer: f32,
}

/// Returns the sample of a point with an intensity.
#[kernel]
#[inline]
fn from_point(from: Vec3, position: Vec3, intensity: Vec3) -> LightSample {
    let way = position - from;
    let squared = way.dot(way);
    // A light at the point itself has no direction.
    let is_apart = squared > 1e-30;
    if !is_apart {
        return LightSample::dark();
    }
    LightSample::delta(way / squared.sqrt(), intensity / squared, position)
}

/// Returns the extent of a point that shines everywhere.
#[kernel]
#[inline]
fn of_point(position: Vec3) -> LightExtent {
    let axis = vec3(0.0, 0.0, 1.0);
    LightExtent { min: position, max: position, axis, cos_normals: -1.0, cos_emitted: 0.0 }
}

#[kernel]
impl Light for PointLight {
    #[inline]
    fn sample(&self, from: Vec3, _u: Vec2) -> LightSample {
        from_point(from, self.position, self.intensity)
    }

    fn power(&self, _radius: f32) -> f32 {
        4.0 * PI * luminance(self.intensity)
    }

    fn extent(&self) -> LightExtent {
        of_point(self.position)
    }
}

#[kernel]
impl Light for SpotLight {
    fn sample(&self, from: Vec3, _u: Vec2) -> LightSample {
        let sample = from_point(from, self.position, self.intensity);
        let cos = -self.direction.dot(sample.wi);
        let width = max(self.cos_inner - self.cos_outer, 1e-4);
        // The falloff of glTF.
        let share = clamp((cos - self.cos_outer) / width, 0.0, 1.0);
        LightSample { light: sample.light * (share * share), ..sample }
    }

    fn power(&self, _radius: f32) -> f32 {
        // The square falls off to a third on average.
        let whole = 1.0 - self.cos_inner;
        let edge = (self.cos_inner - self.cos_outer) * (1.0 / 3.0);
        2.0 * PI * (whole + edge) * luminance(self.intensity)
    }

    fn extent(&self) -> LightExtent {
        let point = of_point(self.position);
        LightExtent { axis: self.direction, cos_normals: 1.0, cos_emitted: self.cos_outer, ..point }
    }
}
