//! Lights: what illuminates a scene.
//!
//! A light is a value with kernels, the trait [`Light`]. Those of the library are such values, and so
//! are a user's: a struct, or an enum of several kinds. [`Lights`] joins many of them, and an
//! [`Environment`], into one value that kernels capture; it chooses among them by their power, or by
//! a tree.
//!
//! | light | unit | sampled by | source |
//! |---|---|---|---|
//! | [`PointLight`] | intensity, W/sr | its direction | |
//! | [`SpotLight`] | intensity, W/sr | its direction | Khronos, `KHR_lights_punctual` |
//! | [`DirectionalLight`] | irradiance, W/m² | its direction, or the cone of a sun | |
//! | [`AreaLight`] of a [`SphereShape`] | radiance, W/(m² sr) | solid angle | Shirley, Wang and Zimmerman 1996 |
//! | [`AreaLight`] of a [`RectangleShape`] | radiance | solid angle, by its two triangles | |
//! | [`AreaLight`] of a [`Triangle`](crate::geometry::Triangle) | radiance | solid angle | Arvo 1995; Peters 2021 |
//! | [`AreaLight`] of a [`DiskShape`], or of your own [`LightShape`] | radiance | area | |
//! | [`Environment`] | radiance | a table of its texels | |
//!
//! Units are radiometric, in linear red, green and blue. Directions lead from the lit point to the
//! light. Densities are per solid angle.

mod any;
mod area;
mod directional;
mod environment;
mod lights;
mod punctual;
mod shapes;
mod tree;
mod triangle;

pub use any::AnyLight;
pub use area::AreaLight;
pub use directional::DirectionalLight;
pub use environment::{Environment, EnvironmentError, EnvironmentView};
pub use lights::{KernelLight, Lights, LightsError, LightsView, NO_RIVAL};
pub use punctual::{PointLight, SpotLight};
pub use shapes::{
    DiskShape, LightShape, RectangleShape, ShapeSample, SphereShape, area_pdf, sample_by_area,
};
pub use tree::LightChoice;

use glam::{Vec3, vec3};

use crate::geometry::SurfacePoint;
use crate::machine::functions::vec3;
use crate::{Type, kernel};

/// A light.
///
/// Colours have linear red, green and blue. A light that is a surface of the scene is met by rays as
/// well: then [`emitted`](Self::emitted) and [`pdf`](Self::pdf) say what it sends and how it would
/// have been sampled. One without a surface, infinitely far away, is seen where a ray hits nothing.
#[kernel]
pub trait Light {
    /// Samples the light from the point `from`, by a point of the unit square.
    fn sample(&self, from: Vec3, u: glam::Vec2) -> LightSample;

    /// Returns the density with which [`sample`](Self::sample) chooses the direction from `from` to
    /// the point `at` of the light's surface; 0 for a light without one.
    fn pdf(&self, _from: Vec3, _at: SurfacePoint) -> f32 {
        0.0
    }

    /// Returns the radiance from a point of the light's surface towards `to_viewer`, a unit vector.
    fn emitted(&self, _at: SurfacePoint, _to_viewer: Vec3) -> Vec3 {
        vec3(0.0, 0.0, 0.0)
    }

    /// Returns the radiance from infinitely far away in a direction, where a ray hits nothing, and
    /// the density with which [`sample`](Self::sample) chooses it.
    fn distant(&self, _direction: Vec3) -> DistantLight {
        DistantLight { radiance: vec3(0.0, 0.0, 0.0), pdf: 0.0 }
    }

    /// Returns whether the light is infinitely far away.
    fn is_distant(&self) -> bool {
        false
    }

    /// Returns about how much light it sends into a scene of this radius, by which it is chosen
    /// among others: not negative. It changes no mean.
    fn power(&self, radius: f32) -> f32;

    /// Returns the box around the light and where it shines, for a tree of lights; a light that is
    /// infinitely far away has none.
    fn extent(&self) -> LightExtent;
}

/// What a ray that hits nothing meets of a light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct DistantLight {
    /// Radiance.
    pub radiance: Vec3,
    /// Density with which a light sample would have this direction.
    pub pdf: f32,
}

/// Where a light is and shines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct LightExtent {
    /// Least coordinates.
    pub min: Vec3,
    /// Greatest coordinates.
    pub max: Vec3,
    /// Axis around which its normals are: a unit vector.
    pub axis: Vec3,
    /// Cosine of the greatest angle of a normal to the axis: 1 for a flat surface, -1 for a sphere.
    pub cos_normals: f32,
    /// Cosine of the greatest angle to a normal under which light leaves: 0 for a diffuse surface.
    pub cos_emitted: f32,
}

/// A sampled direction to a light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct LightSample {
    /// Unit vector towards the light.
    pub wi: Vec3,
    /// Radiance from there; of a delta light the irradiance at normal incidence. 0 where nothing
    /// arrives.
    pub light: Vec3,
    /// Density per solid angle; of a delta light the probability of choosing it.
    pub pdf: f32,
    /// Whether the light is a delta, which no ray meets by chance.
    pub is_delta: bool,
    /// Whether it is infinitely far away.
    pub is_distant: bool,
    /// The point of the light, where it is not.
    pub end: SurfacePoint,
}

#[kernel]
impl LightSample {
    /// Returns the sample of a direction from which nothing arrives.
    #[inline]
    pub fn dark() -> Self {
        let up = vec3(0.0, 0.0, 1.0);
        Self {
            wi: up,
            light: vec3(0.0, 0.0, 0.0),
            pdf: 0.0,
            is_delta: false,
            is_distant: true,
            end: SurfacePoint { position: up, normal: up, error: 0.0 },
        }
    }

    /// Returns the sample of a delta light at a position.
    #[inline]
    pub fn delta(wi: Vec3, irradiance: Vec3, position: Vec3) -> Self {
        Self {
            wi,
            light: irradiance,
            pdf: 1.0,
            is_delta: true,
            is_distant: false,
            end: SurfacePoint { position, normal: -wi, error: 0.0 },
        }
    }

    /// Returns the sample of a light that is infinitely far away.
    #[inline]
    pub fn distant(wi: Vec3, light: Vec3, pdf: f32, is_delta: bool) -> Self {
        let end = SurfacePoint { position: wi, normal: -wi, error: 0.0 };
        Self { wi, light, pdf, is_delta, is_distant: true, end }
    }

    /// Returns the ray by which the light is occluded, if it hits anything.
    #[inline]
    pub fn shadow_ray(&self, from: SurfacePoint) -> crate::geometry::Ray {
        if self.is_distant { from.ray(self.wi) } else { from.ray_between(self.end) }
    }
}

/// Returns the luminance of a colour with the primaries of sRGB. (IEC 61966-2-1.)
#[kernel]
#[inline]
pub fn luminance(color: Vec3) -> f32 {
    0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z
}
