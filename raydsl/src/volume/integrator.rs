//! Integrators: how light along a ray through a volume is computed.

use glam::{Vec3, vec3};

use super::grid::Grid;
use super::light::VolumeLight;
use super::sample::index_of;
use super::volume::{Volume, VolumeView};
use super::voxel::Voxel;
use super::walk::CellWalk;
use crate::geometry::{Ray, RayOn, transform_ray};
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, length, max, min};
use crate::machine::{Machine, On};
use crate::{Type, kernel};

/// Integrator of emission and absorption along a ray: of `L' = extinction (color - L)`.
///
/// Kernels and the host call [`Volume::integrate`] with any of them.
pub trait VolumeIntegrator: Type {
    /// Returns `light` with what the volume adds behind it, between the ray's `t_min` and `t_max`.
    fn integrate<T: Voxel>(
        &self,
        volume: &Volume<'_, T>,
        ray: Ray,
        light: VolumeLight,
    ) -> VolumeLight;

    /// Lifted form of [`integrate`](Self::integrate).
    #[doc(hidden)]
    fn integrate_on<M: Machine, T: Voxel>(
        m: &M,
        this: On<Self, M>,
        volume: VolumeView<'_, T>,
        ray: RayOn<M>,
        light: On<VolumeLight, M>,
    ) -> On<VolumeLight, M>;
}

/// Implements [`VolumeIntegrator`] by a kernel.
macro_rules! integrator {
    ($name:ident, $kernel:ident) => {
        impl VolumeIntegrator for $name {
            #[inline]
            fn integrate<T: Voxel>(
                &self,
                volume: &Volume<'_, T>,
                ray: Ray,
                light: VolumeLight,
            ) -> VolumeLight {
                $kernel(*self, volume, ray, light)
            }

            #[inline(always)]
            fn integrate_on<M: Machine, T: Voxel>(
                m: &M,
                this: On<Self, M>,
                volume: VolumeView<'_, T>,
                ray: RayOn<M>,
                light: On<VolumeLight, M>,
            ) -> On<VolumeLight, M> {
                $kernel::on(m, this, volume, ray, light)
            }
        }
    };
}

pub(super) use integrator;

/// Part of a ray inside a grid, in voxel coordinates.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Inside {
    /// Where the ray enters the grid.
    pub(super) origin: Vec3,
    /// Direction of the ray in voxel coordinates; distances count in its lengths.
    pub(super) direction: Vec3,
    /// Distance of the end from `origin`; 0 if the ray misses.
    pub(super) end: f32,
    /// Length in the world of a distance of 1.
    pub(super) scale: f32,
}

/// Returns the part of a ray in a grid.
#[kernel]
#[inline]
pub(super) fn inside<T: Voxel>(grid: &Grid<'_, T>, ray: Ray) -> Inside {
    let (enter, leave) = grid.span(ray);
    let local = transform_ray(ray, grid.layout().to_voxels);
    let is_inside = enter < leave;
    let start = if is_inside { enter } else { 0.0 };
    Inside {
        origin: local.at(start),
        direction: local.direction,
        end: if is_inside { leave - enter } else { 0.0 },
        scale: length(ray.direction),
    }
}

/// Begins the walk from macro-cell to macro-cell.
#[kernel]
#[inline]
pub(super) fn macro_walk<T: Voxel>(grid: &Grid<'_, T>, part: Inside) -> CellWalk {
    let (first, last) = (vec3(0.0, 0.0, 0.0), grid.layout().last_macro);
    CellWalk::new(part.origin, part.direction, 8.0, first, last, 0.0, part.end)
}

/// Returns the greatest extinction in a macro-cell.
#[kernel]
#[inline]
pub(super) fn majorant_of<T: Voxel>(volume: &Volume<'_, T>, cell: Vec3) -> f32 {
    volume.majorant(index_of(cell, volume.grid().layout().macro_steps))
}

/// Returns the factor of colours on a surface with this normal of any length, under a light from
/// `to_light`, a unit vector, of which the share `ambient` has no direction. (Lambert's law, for
/// both sides.)
#[kernel]
#[inline]
pub(super) fn lambert(normal: Vec3, to_light: Vec3, ambient: f32) -> f32 {
    // In units of the largest component: squares of others may be infinite, or vanish.
    let size = max(normal.abs().max_element(), f32::MIN_POSITIVE);
    let normal = clamp(normal / size, vec3(-1.0, -1.0, -1.0), vec3(1.0, 1.0, 1.0));
    let cosine = normal.dot(to_light).abs() / max(length(normal), f32::MIN_POSITIVE);
    ambient + (1.0 - ambient) * min(cosine, 1.0)
}

/// Light within a macro-cell: sums short enough to be plain.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Layer {
    pub(super) radiance: Vec3,
    pub(super) transmittance: f32,
    pub(super) depth: f32,
}

#[kernel]
impl Layer {
    #[inline]
    pub(super) fn new() -> Layer {
        Layer { radiance: vec3(0.0, 0.0, 0.0), transmittance: 1.0, depth: 0.0 }
    }

    /// Adds a thin part behind: a colour of this opacity.
    #[inline(always)]
    pub(super) fn add(&mut self, color: Vec3, opacity: f32, depth: f32) {
        self.radiance += color * (self.transmittance * opacity);
        self.transmittance *= 1.0 - opacity;
        self.depth += depth;
    }
}
