//! Surfaces that shine.

use core::f32::consts::PI;

use glam::{Vec2, Vec3, vec3};

use super::{Light, LightExtent, LightSample, LightShape, luminance};
use crate::geometry::SurfacePoint;
use crate::machine::Type as MachineType;
use crate::machine::functions::vec3;
use crate::{Type, kernel};

/// A surface that shines diffusely: the same radiance in all directions on the side of its normal,
/// or on both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct AreaLight<S: LightShape + MachineType> {
    /// The surface.
    pub shape: S,
    /// Radiance: red, green and blue, not negative.
    pub radiance: Vec3,
    /// Whether the back shines too.
    pub is_two_sided: bool,
}

#[kernel]
impl<S: LightShape> Light for AreaLight<S> {
    fn sample(&self, from: Vec3, u: Vec2) -> LightSample {
        let shape: S = self.shape;
        let chosen = shape.sample_from(from, u);
        let is_seen =
            chosen.pdf > 0.0 && (self.is_two_sided || chosen.point.normal.dot(chosen.wi) < 0.0);
        let dark = vec3(0.0, 0.0, 0.0);
        LightSample {
            wi: chosen.wi,
            light: if is_seen { self.radiance } else { dark },
            pdf: chosen.pdf,
            is_delta: false,
            is_distant: false,
            end: chosen.point,
        }
    }

    fn pdf(&self, from: Vec3, at: SurfacePoint) -> f32 {
        let shape: S = self.shape;
        shape.pdf_from(from, at)
    }

    fn emitted(&self, at: SurfacePoint, to_viewer: Vec3) -> Vec3 {
        let is_seen = self.is_two_sided || at.normal.dot(to_viewer) > 0.0;
        if is_seen { self.radiance } else { vec3(0.0, 0.0, 0.0) }
    }

    fn power(&self, _radius: f32) -> f32 {
        let shape: S = self.shape;
        let sides = if self.is_two_sided { 2.0 } else { 1.0 };
        sides * PI * shape.surface_area() * luminance(self.radiance)
    }

    fn extent(&self) -> LightExtent {
        let shape: S = self.shape;
        let extent = shape.shape_extent();
        let cos_normals = if self.is_two_sided { -1.0 } else { extent.cos_normals };
        LightExtent { cos_normals, ..extent }
    }
}
