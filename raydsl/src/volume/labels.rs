//! Labels: the colours and extinctions of voxels, interpolated in place of their values.

use glam::{Vec3, Vec4, vec3};

use super::integrator::{
    Inside, Layer, VolumeIntegrator, inside, integrator, lambert, macro_walk, majorant_of,
};
use super::light::VolumeLight;
use super::march::{MOST_STEPS, RUN, Step, cell_at_distance, march, opacity_of};
use super::sample::{InCell, cell_around, trilinear};
use super::transfer::{TransferFunction, TransferSample};
use super::volume::{Volume, VolumeView};
use super::voxel::{Corners, Voxel};
use crate::geometry::{Ray, RayOn};
use crate::machine::functions::vec3;
use crate::machine::generic::{clamp, max, min};
use crate::machine::{Machine, On};
use crate::{Type, kernel};

/// Integrates a grid of labels: numbers that name organs, materials or regions, so that a mean of
/// two of them means nothing.
///
/// The transfer function is applied to voxels, and what it gives is interpolated: each label around
/// a point counts by its share there, and borders between labels are smooth surfaces.
/// (Pre-classification; Hadwiger et al., "Real-Time Volume Graphics", 2006, section 4.2.) It takes
/// exponential steps with the sample in the middle, as [`Midpoint`](super::Midpoint). With a light,
/// borders are shaded by the gradient of extinction, over two voxels each way.
/// [`TransferFunction::labels`] gives each label a colour. Of a grid
/// [between two steps](super::Grid::between) it sees blended numbers, which are other labels.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Labels {
    /// Greatest length of a step, in the world; above 0.
    pub step: f32,
    /// Transmittance below which the rest of a ray is left out.
    pub least: f32,
    /// Share of light without a direction, from 0 to 1; 1 is without shading.
    pub ambient: f32,
    /// Unit vector towards the light.
    pub to_light: Vec3,
}

#[kernel]
impl Labels {
    /// Creates the integrator with this step, without shading. It leaves out what is behind a
    /// transmittance of 0.001.
    #[inline]
    pub fn new(step: f32) -> Self {
        Self { step, least: 0.001, ambient: 1.0, to_light: vec3(0.0, 0.0, 1.0) }
    }

    /// Sets the transmittance below which the rest of a ray is left out.
    #[inline]
    #[must_use]
    pub fn least(self, least: f32) -> Self {
        Self { least, ..self }
    }

    /// Shades borders by a light in this direction, a unit vector, and this share of ambient light.
    #[inline]
    #[must_use]
    pub fn lit(self, to_light: Vec3, ambient: f32) -> Self {
        Self { ambient, to_light, ..self }
    }

    /// Returns the factor of colours where extinction has this gradient.
    #[inline]
    fn shade(self, gradient: Vec3) -> f32 {
        let shade = lambert(gradient, self.to_light, self.ambient);
        if gradient.abs().max_element() > 0.0 { shade } else { 1.0 }
    }
}

/// What the voxels around a point have.
#[derive(Clone, Copy, Debug, Type)]
struct Classified {
    extinctions: Corners,
    reds: Corners,
    greens: Corners,
    blues: Corners,
}

/// Returns the extinctions of four voxels, and their colours times those.
#[kernel]
#[inline]
fn classified_four(function: &TransferFunction, values: Vec4) -> (Vec4, Vec4, Vec4, Vec4) {
    let a: TransferSample = function.at(values.x);
    let b: TransferSample = function.at(values.y);
    let c: TransferSample = function.at(values.z);
    let d: TransferSample = function.at(values.w);
    let extinctions = Vec4::new(a.extinction, b.extinction, c.extinction, d.extinction);
    (
        extinctions,
        Vec4::new(a.color.x, b.color.x, c.color.x, d.color.x) * extinctions,
        Vec4::new(a.color.y, b.color.y, c.color.y, d.color.y) * extinctions,
        Vec4::new(a.color.z, b.color.z, c.color.z, d.color.z) * extinctions,
    )
}

#[kernel]
#[inline]
fn classified<T: Voxel>(volume: &Volume<'_, T>, cell: InCell) -> Classified {
    let layout = volume.grid().layout();
    let near = cell.corners.near * layout.scale + layout.offset;
    let far = cell.corners.far * layout.scale + layout.offset;
    let (near_extinctions, near_reds, near_greens, near_blues) =
        classified_four(volume.transfer(), near);
    let (far_extinctions, far_reds, far_greens, far_blues) =
        classified_four(volume.transfer(), far);
    Classified {
        extinctions: Corners { near: near_extinctions, far: far_extinctions },
        reds: Corners { near: near_reds, far: far_reds },
        greens: Corners { near: near_greens, far: far_greens },
        blues: Corners { near: near_blues, far: far_blues },
    }
}

/// Returns the extinction at a point in voxel coordinates.
#[kernel]
#[inline(never)]
fn extinction_at<T: Voxel>(volume: &Volume<'_, T>, at: Vec3) -> f32 {
    let cell = cell_around(volume.grid(), at);
    let extinctions = classified(volume, cell).extinctions;
    if cell.is_whole { trilinear(extinctions, cell.place) } else { 0.0 }
}

/// Returns the gradient of extinction in the world, over two voxels each way: within one cell, the
/// gradient shows the corners of voxels.
#[kernel]
#[inline]
fn gradient_at<T: Voxel>(volume: &Volume<'_, T>, at: Vec3) -> Vec3 {
    let mut gradient = vec3(0.0, 0.0, 0.0);
    for axis in 0..3 {
        let along = vec3(
            if axis == 0 { 1.0 } else { 0.0 },
            if axis == 1 { 1.0 } else { 0.0 },
            if axis == 2 { 1.0 } else { 0.0 },
        );
        for reach in 1..3 {
            let step = along * reach as f32;
            let change = extinction_at(volume, at + step) - extinction_at(volume, at - step);
            gradient += along * change;
        }
    }
    volume.grid().layout().to_voxels.matrix3.transpose() * gradient
}

#[kernel]
#[inline]
fn label_step<T: Voxel>(
    this: Labels,
    volume: &Volume<'_, T>,
    part: Inside,
    from: f32,
    to: f32,
) -> Step {
    let cell = cell_at_distance(volume, part, (from + to) * 0.5);
    let found = classified(volume, cell);
    let place = cell.place;
    let extinction = if cell.is_whole { trilinear(found.extinctions, place) } else { 0.0 };
    let depth = extinction * ((to - from) * part.scale);
    let mut color = vec3(0.0, 0.0, 0.0);
    if depth > 0.0 {
        let emission = vec3(
            trilinear(found.reds, place),
            trilinear(found.greens, place),
            trilinear(found.blues, place),
        );
        color = emission / extinction;
        if this.ambient < 1.0 {
            let at = part.origin + part.direction * ((from + to) * 0.5);
            color *= this.shade(gradient_at(volume, at));
        }
    }
    Step { color, opacity: opacity_of(depth), depth }
}

integrator!(Labels, labels);
march!(Labels by labels in Volume, |this, volume, part, from, to| {
    label_step(this, volume, part, from, to)
});
