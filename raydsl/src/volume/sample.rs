//! Values of grids at points: kernels.

use glam::{UVec3, Vec3, Vec4, uvec3, vec3};

use super::grid::Grid;
use super::voxel::{Corners, Voxel};
use crate::geometry::{Aabb, Ray, transform_ray};
use crate::machine::functions::{uvec3, vec3};
use crate::machine::generic::{clamp, max, min, transform_point};
use crate::{Type, kernel};

/// A cell, and a place in it.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct InCell {
    pub(super) corners: Corners,
    /// From (0, 0, 0) at the first corner to (1, 1, 1) at the last.
    pub(super) place: Vec3,
    /// Whether no voxel of the cell is missing.
    pub(super) is_whole: bool,
}

#[kernel]
#[inline(always)]
fn are_finite(v: Vec4) -> bool {
    v.is_finite()
}

/// Returns the number of a voxel, or of a macro-cell, from whole coordinates.
#[kernel]
#[inline(always)]
pub(super) fn index_of(at: Vec3, steps: UVec3) -> u32 {
    at.x as u32 * steps.x + at.y as u32 * steps.y + at.z as u32 * steps.z
}

/// Returns the corners of the cell with these whole coordinates, and whether none is missing.
#[kernel]
#[inline(always)]
pub(super) fn cell_at<T: Voxel>(grid: &Grid<'_, T>, cell: Vec3) -> InCell {
    let steps = grid.layout().steps;
    let corners: Corners = grid.corners(index_of(cell, steps), steps);
    let is_whole =
        if grid.has_gaps() { are_finite(corners.near) & are_finite(corners.far) } else { true };
    InCell { corners, place: vec3(0.0, 0.0, 0.0), is_whole }
}

/// Returns the cell around a point in voxel coordinates, with its place there.
#[kernel]
#[inline(always)]
pub(super) fn cell_around<T: Voxel>(grid: &Grid<'_, T>, at: Vec3) -> InCell {
    let last = grid.layout().last_cell;
    // A NaN becomes 0. At the border rounding decides nothing.
    let cell = min(max(vec3(0.0, 0.0, 0.0), at), last + 0.5).floor();
    let place = min(max(vec3(0.0, 0.0, 0.0), at - cell), vec3(1.0, 1.0, 1.0));
    InCell { place, ..cell_at(grid, cell) }
}

/// Interpolates the corners of a cell; equal ones give the same bits.
#[kernel]
#[inline(always)]
pub(super) fn trilinear(corners: Corners, place: Vec3) -> f32 {
    let Corners { near, far } = corners;
    let a = near.x + (near.y - near.x) * place.x;
    let b = near.z + (near.w - near.z) * place.x;
    let c = far.x + (far.y - far.x) * place.x;
    let d = far.z + (far.w - far.z) * place.x;
    let ab = a + (b - a) * place.y;
    let cd = c + (d - c) * place.y;
    ab + (cd - ab) * place.z
}

#[kernel]
#[inline]
fn to_voxels<T: Voxel>(grid: &Grid<'_, T>, p: Vec3) -> Vec3 {
    transform_point(grid.layout().to_voxels, p)
}

/// Returns a voxel's number as a value.
#[kernel]
#[inline(always)]
fn rescaled<T: Voxel>(grid: &Grid<'_, T>, number: f32) -> f32 {
    number * grid.layout().scale + grid.layout().offset
}

/// Returns the value in a cell, 0 if a voxel is missing.
#[kernel]
#[inline(always)]
pub(super) fn value_in<T: Voxel>(grid: &Grid<'_, T>, cell: InCell) -> f32 {
    let value = rescaled(grid, trilinear(cell.corners, cell.place));
    if grid.has_gaps() { if cell.is_whole { value } else { 0.0 } } else { value }
}

#[kernel]
#[inline]
pub(super) fn value<T: Voxel>(grid: &Grid<'_, T>, p: Vec3) -> f32 {
    value_in(grid, cell_around(grid, to_voxels(grid, p)))
}

#[kernel]
#[inline]
pub(super) fn has_value<T: Voxel>(grid: &Grid<'_, T>, p: Vec3) -> bool {
    if grid.has_gaps() { cell_around(grid, to_voxels(grid, p)).is_whole } else { true }
}

/// Returns the derivatives of the trilinear value along the cell's axes.
#[kernel]
#[inline]
pub(super) fn slopes(corners: Corners, place: Vec3) -> Vec3 {
    let Corners { near, far } = corners;
    let rest = 1.0 - place;
    let x = ((near.y - near.x) * rest.y + (near.w - near.z) * place.y) * rest.z
        + ((far.y - far.x) * rest.y + (far.w - far.z) * place.y) * place.z;
    let y = ((near.z - near.x) * rest.x + (near.w - near.y) * place.x) * rest.z
        + ((far.z - far.x) * rest.x + (far.w - far.y) * place.x) * place.z;
    let z = ((far.x - near.x) * rest.x + (far.y - near.y) * place.x) * rest.y
        + ((far.z - near.z) * rest.x + (far.w - near.w) * place.x) * place.y;
    vec3(x, y, z)
}

/// Returns the gradient in the world in a cell, 0 if a voxel is missing.
#[kernel]
#[inline]
pub(super) fn gradient_in<T: Voxel>(grid: &Grid<'_, T>, cell: InCell) -> Vec3 {
    let layout = grid.layout();
    let slopes = slopes(cell.corners, cell.place) * layout.scale;
    let gradient = layout.to_voxels.matrix3.transpose() * slopes;
    if grid.has_gaps() {
        if cell.is_whole { gradient } else { vec3(0.0, 0.0, 0.0) }
    } else {
        gradient
    }
}

#[kernel]
#[inline]
pub(super) fn gradient<T: Voxel>(grid: &Grid<'_, T>, p: Vec3) -> Vec3 {
    gradient_in(grid, cell_around(grid, to_voxels(grid, p)))
}

/// Returns the number of the voxel nearest to whole coordinates.
#[kernel]
#[inline]
fn voxel_at<T: Voxel>(grid: &Grid<'_, T>, at: Vec3) -> f32 {
    let layout = grid.layout();
    let last = layout.last_cell + min(layout.steps, uvec3(1, 1, 1)).as_vec3();
    let inside = min(max(vec3(0.0, 0.0, 0.0), at), last);
    let corners: Corners = grid.corners(index_of(inside, layout.steps), uvec3(0, 0, 0));
    corners.near.x
}

#[kernel]
#[inline]
pub(super) fn nearest<T: Voxel>(grid: &Grid<'_, T>, p: Vec3) -> f32 {
    let number = voxel_at(grid, (to_voxels(grid, p) + 0.5).floor());
    let value = rescaled(grid, number);
    if grid.has_gaps() { if number.is_finite() { value } else { 0.0 } } else { value }
}

/// Returns the weights of the four control points of a cubic B-spline. (Prautzsch, Boehm and
/// Paluszny, "Bézier and B-Spline Techniques", 2002, section 5.)
#[kernel]
#[inline]
fn spline_weights(x: f32) -> Vec4 {
    let rest = 1.0 - x;
    let (second, third) =
        (2.0 / 3.0 - 0.5 * x * x * (2.0 - x), 2.0 / 3.0 - 0.5 * rest * rest * (2.0 - rest));
    Vec4::new(rest * rest * rest / 6.0, second, third, x * x * x / 6.0)
}

#[kernel]
#[inline]
#[expect(clippy::needless_range_loop, reason = "each number is a place too")]
pub(super) fn b_spline<T: Voxel>(grid: &Grid<'_, T>, p: Vec3) -> f32 {
    let layout = grid.layout();
    let at = clamp(to_voxels(grid, p), layout.low, layout.high);
    let base = at.floor();
    let place = at - base;
    let (wx, wy, wz) = (spline_weights(place.x), spline_weights(place.y), spline_weights(place.z));
    let xs = [wx.x, wx.y, wx.z, wx.w];
    let ys = [wy.x, wy.y, wy.z, wy.w];
    let zs = [wz.x, wz.y, wz.z, wz.w];
    let center = voxel_at(grid, base);
    let mut sum = 0.0;
    let mut is_whole = true;
    for k in 0..4 {
        for j in 0..4 {
            for i in 0..4 {
                let number = voxel_at(grid, base + vec3(i as f32, j as f32, k as f32) - 1.0);
                is_whole &= number.is_finite();
                // Differences, so that a constant grid has its own value.
                sum += (number - center) * (xs[i] * ys[j] * zs[k]);
            }
        }
    }
    let value = rescaled(grid, center + sum);
    if grid.has_gaps() { if is_whole { value } else { 0.0 } } else { value }
}

#[kernel]
#[inline]
pub(super) fn span<T: Voxel>(grid: &Grid<'_, T>, ray: Ray) -> (f32, f32) {
    let layout = grid.layout();
    Aabb::new(layout.low, layout.high).span(transform_ray(ray, layout.to_voxels))
}
