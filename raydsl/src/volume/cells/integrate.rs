//! Emission and absorption along a ray through cells, without a step.

use super::values::gradient_in;
use super::volume::{CellVolume, CellVolumeView};
use super::walk::{CellPart, CellWalk};
use crate::bvh::RecordQuery;
use crate::geometry::{Ray, RayOn};
use crate::machine::generic::max;
use crate::machine::{Machine, On};
use crate::volume::cubic::Cubic;
use crate::volume::exact::{CellPieces, Interval, interval_at};
use crate::volume::integrator::Layer;
use crate::volume::{ExactCell, ShadedCell, VolumeLight};
use crate::{Type, kernel};

/// Integrator of emission and absorption through cells: [`ExactCell`], or [`ShadedCell`], which
/// shades by the gradient of each tetrahedron.
pub trait CellIntegrator: Type {
    /// Returns `light` with what the volume adds behind it, between the ray's `t_min` and `t_max`.
    fn integrate_cells(&self, volume: &CellVolume<'_>, ray: Ray, light: VolumeLight)
    -> VolumeLight;

    /// Lifted form of [`integrate_cells`](Self::integrate_cells).
    #[doc(hidden)]
    fn integrate_cells_on<M: Machine>(
        m: &M,
        this: On<Self, M>,
        volume: CellVolumeView<'_>,
        ray: RayOn<M>,
        light: On<VolumeLight, M>,
    ) -> On<VolumeLight, M>;
}

/// Implements [`CellIntegrator`] by a kernel.
macro_rules! integrator {
    ($name:ident, $kernel:ident) => {
        impl CellIntegrator for $name {
            #[inline]
            fn integrate_cells(
                &self,
                volume: &CellVolume<'_>,
                ray: Ray,
                light: VolumeLight,
            ) -> VolumeLight {
                $kernel(*self, volume, ray, light)
            }

            #[inline(always)]
            fn integrate_cells_on<M: Machine>(
                m: &M,
                this: On<Self, M>,
                volume: CellVolumeView<'_>,
                ray: RayOn<M>,
                light: On<VolumeLight, M>,
            ) -> On<VolumeLight, M> {
                $kernel::on(m, this, volume, ray, light)
            }
        }
    };
}

/// Number of cells whose light is one sum without its rounding errors.
const RUN: u32 = 16;

/// Returns whether all values of a part are in an interval without extinction; the value at its
/// upper end is behind a step there.
#[kernel]
#[inline]
fn is_clear(part: CellPart, interval: Interval) -> bool {
    let Interval { below, above, .. } = interval;
    (below.extinction + above.extinction == 0.0)
        & (part.from >= below.value)
        & (part.from < above.value)
        & (part.to >= below.value)
        & (part.to < above.value)
}

/// Integrates cell by cell; `shade` returns a factor for the colours of a tetrahedron.
#[kernel]
#[inline]
fn through_cells<F: Fn(u32) -> f32>(
    volume: &CellVolume<'_>,
    ray: Ray,
    least: f32,
    light: VolumeLight,
    shade: F,
) -> VolumeLight {
    let line = volume.grid().line(ray);
    let mut light = light;
    let mut interval = interval_at(volume.transfer(), 0u32);
    let mut done = line.first;
    for hit in volume.grid().entries().hits(line.ray) {
        let mut walk: CellWalk = volume.grid().enter(line, hit.prim_id);
        while walk.is_inside && walk.enter() < line.last && light.transmittance() >= least {
            let enough = least / max(light.transmittance(), f32::MIN_POSITIVE);
            let mut layer = Layer::new();
            let mut run = 0u32;
            while walk.is_inside
                && walk.enter() < line.last
                && run < RUN
                && (run == 0 || layer.transmittance >= enough)
            {
                let part: CellPart = walk.part(done, line.last);
                let is_there = walk.is_whole & (part.enter < part.leave);
                if is_there && !is_clear(part, interval) {
                    let length = (part.leave - part.enter) * line.scale;
                    let cubic = Cubic { c0: part.from, c1: part.to - part.from, c2: 0.0, c3: 0.0 };
                    let (radiance, depth) = (layer.radiance, layer.depth);
                    // At a step the value is behind it, as for the function itself.
                    if cubic.c0 < interval.below.value || cubic.c0 >= interval.above.value {
                        let index: u32 = volume.transfer().interval(cubic.c0);
                        interval = interval_at(volume.transfer(), index);
                    }
                    let mut pieces = CellPieces::of(cubic, length);
                    while pieces.x < 1.0 {
                        pieces.advance(&mut layer, &mut interval, volume.transfer());
                    }
                    if layer.depth > depth {
                        let factor = shade(walk.tetrahedron);
                        layer.radiance = radiance + (layer.radiance - radiance) * factor;
                    }
                }
                done = max(done, walk.leave());
                run += 1;
                walk.advance(volume.grid(), line);
            }
            light = light.then(layer.radiance, layer.depth);
        }
        if light.transmittance() < least {
            break;
        }
    }
    light
}

#[kernel]
#[inline(never)]
fn exact_cells(
    this: ExactCell,
    volume: &CellVolume<'_>,
    ray: Ray,
    light: VolumeLight,
) -> VolumeLight {
    through_cells(volume, ray, this.least, light, |_tetrahedron: u32| 1.0)
}

integrator!(ExactCell, exact_cells);

#[kernel]
#[inline(never)]
fn shaded_cells(
    this: ShadedCell,
    volume: &CellVolume<'_>,
    ray: Ray,
    light: VolumeLight,
) -> VolumeLight {
    let shade = |tetrahedron: u32| this.shade(gradient_in(volume.grid(), tetrahedron));
    through_cells(volume, ray, this.least, light, shade)
}

integrator!(ShadedCell, shaded_cells);
