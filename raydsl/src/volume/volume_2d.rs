//! Volumes with transfer functions of the value and the length of its gradient.

use super::grid::{Grid, GridView};
use super::integrator::{Inside, Layer, inside, macro_walk};
use super::light::VolumeLight;
use super::march::{MOST_STEPS, Midpoint, RUN, Step, march, opacity_of};
use super::sample::{cell_around, gradient_in, index_of, value_in};
use super::transfer::TransferSample;
use super::transfer_2d::{TransferFunction2d, TransferLayout2d};
use super::voxel::Voxel;
use crate::geometry::{Ray, RayOn};
use crate::machine::functions::vec2;
use crate::machine::generic::{clamp, length, max, min};
use crate::machine::table_view;
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    Capture, DescribedSlice, F, Leaves, Machine, Method, On, Parameter, Resource, Schema, Slice,
    Table, TableView, Type as MachineType, U, Value, name, visit_value,
};
use crate::{Type, kernel};
use glam::{Vec3, uvec3, vec2, vec3};

/// Grid that is seen through a transfer function of its value and of the length of its gradient.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::{
///     Grid, GridConfig, Midpoint, TransferFunction2d, Volume2d, VolumeLight,
/// };
///
/// // A border between 0 and 1.
/// let voxels: Vec<f32> = (0..40).map(|i| if i < 20 { 0.0 } else { 1.0 }).collect();
/// let grid = Grid::new(voxels, uvec3(2, 2, 10), GridConfig::new())?;
/// let clear = (Vec3::ONE, 0.0);
/// let samples = [clear, clear, (Vec3::ONE, 0.75), (Vec3::ONE, 0.75)];
/// let unit = vec2(0.0, 1.0);
/// let borders = Volume2d::new(&grid, TransferFunction2d::new(&samples, uvec2(2, 2), unit, unit, 1.0)?);
/// let kernel = kernel!(|ray: Ray| {
///     borders.integrate(Midpoint::new(0.1), ray, VolumeLight::new()).opacity()
/// });
/// let through = Ray::new(vec3(0.5, 0.5, -1.0), Vec3::Z);
/// assert!((kernel.call((through,)) - 0.75).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Volume2d<'a, T: Voxel> {
    grid: &'a Grid<'a, T>,
    transfer: TransferFunction2d,
    /// The length of no gradient in a macro-cell is greater.
    gradients: Vec<f32>,
    majorants: Vec<f32>,
}

impl<'a, T: Voxel> Volume2d<'a, T> {
    /// Joins a grid and a transfer function.
    pub fn new(grid: &'a Grid<'a, T>, transfer: TransferFunction2d) -> Self {
        let gradients = longest_gradients(grid);
        let majorants = majorants(grid, &gradients, &transfer);
        Self { grid, transfer, gradients, majorants }
    }

    /// Replaces the transfer function, which takes time in proportion to the number of macro-cells;
    /// no kernel is recorded or compiled again.
    pub fn set_transfer(&mut self, transfer: TransferFunction2d) {
        self.majorants = majorants(self.grid, &self.gradients, &transfer);
        self.transfer = transfer;
    }

    /// Returns the grid.
    #[inline(always)]
    pub fn grid(&self) -> &'a Grid<'a, T> {
        self.grid
    }

    /// Returns the transfer function.
    pub fn transfer(&self) -> &TransferFunction2d {
        &self.transfer
    }

    /// Returns a bound on the extinction in each macro-cell, as [`Grid::ranges`] are ordered; 0 in
    /// those that are empty.
    pub fn majorants(&self) -> &[f32] {
        &self.majorants
    }

    /// Returns `light` with what the volume adds behind it, between the ray's `t_min` and `t_max`,
    /// by steps with the sample in the middle of each.
    #[inline]
    pub fn integrate(&self, rule: Midpoint, ray: Ray, light: VolumeLight) -> VolumeLight {
        midpoint_2d(rule, self, ray, light)
    }

    #[inline(always)]
    fn majorant(&self, i: u32) -> f32 {
        self.majorants[i as usize]
    }

    #[inline(always)]
    fn layout(&self) -> TransferLayout2d {
        self.transfer.layout
    }

    #[inline(always)]
    fn sample(&self, i: u32) -> TransferSample {
        self.transfer.samples[i as usize]
    }

    fn named_view(&self, name: &'static str) -> Volume2dView<'_, T> {
        let key = |part| Some(BufferKey { id: self.transfer.owner.id(), version: 0, part });
        Volume2dView {
            grid: self.grid.named_view(name),
            samples: Slice::owned(&self.transfer.samples, key(0), name).suffixed("samples"),
            majorants: Slice::owned(&self.majorants, key(1), name).suffixed("majorants"),
            layout: self.transfer.layout,
            name,
        }
    }
}

/// Returns the length that no gradient of a macro-cell exceeds: along each axis a slope is between
/// those at the edges of its cell, and the longest sum of three is at a corner of that box.
fn longest_gradients<T: Voxel>(grid: &Grid<'_, T>) -> Vec<f32> {
    let layout = grid.layout();
    let (macros, last) = (grid.macro_cells(), layout.last_cell.as_uvec3());
    let matrix = layout.to_voxels.matrix3.transpose();
    let longest = |i: u32| {
        let at = uvec3(i % macros.x, i / macros.x % macros.y, i / (macros.x * macros.y));
        let first = at * super::grid::MACRO_CELL;
        let end = (first + super::grid::MACRO_CELL - 1).min(last);
        let mut slopes = Vec3::ZERO;
        for z in first.z..=end.z {
            for y in first.y..=end.y {
                for x in first.x..=end.x {
                    let index = (uvec3(x, y, z) * layout.steps).element_sum();
                    let corners = grid.corners(index, layout.steps);
                    let (a, b) = (corners.near, corners.far);
                    let of = |pairs: [(f32, f32); 4]| {
                        let known = pairs.into_iter().filter(|(a, b)| (a + b).is_finite());
                        known.map(|(from, to)| (to - from).abs()).fold(0.0, f32::max)
                    };
                    slopes = slopes.max(vec3(
                        of([(a.x, a.y), (a.z, a.w), (b.x, b.y), (b.z, b.w)]),
                        of([(a.x, a.z), (a.y, a.w), (b.x, b.z), (b.y, b.w)]),
                        of([(a.x, b.x), (a.y, b.y), (a.z, b.z), (a.w, b.w)]),
                    ));
                }
            }
        }
        let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let ends = signs.map(|(y, z)| (matrix * (slopes * vec3(1.0, y, z))).length());
        ends.into_iter().fold(0.0, f32::max) * layout.scale.abs() * (1.0 + 8.0 * f32::EPSILON)
    };
    let count = macros.element_product();
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        (0..count).into_par_iter().map(longest).collect()
    }
    #[cfg(not(feature = "parallel"))]
    (0..count).map(longest).collect()
}

fn majorants<T: Voxel>(
    grid: &Grid<'_, T>,
    gradients: &[f32],
    transfer: &TransferFunction2d,
) -> Vec<f32> {
    let cells = grid.ranges().iter().zip(gradients);
    cells.map(|(range, gradient)| transfer.greatest_extinction(*range, *gradient)).collect()
}

/// View of a [`Volume2d`] in kernels: a host value on every machine.
#[derive(Debug)]
pub struct Volume2dView<'a, T: Voxel> {
    grid: GridView<'a, T>,
    samples: Slice<'a, TransferSample>,
    majorants: Slice<'a, f32>,
    layout: TransferLayout2d,
    name: &'static str,
}

impl<T: Voxel> Clone for Volume2dView<'_, T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T: Voxel> Copy for Volume2dView<'_, T> {}

table_view!([T: Voxel] Volume2d<'_, T>, Volume2dView, "volume", "volumes");

impl<T: Voxel> TableView for Volume2dView<'_, T> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        self.grid.resources(visit);
        visit(&DescribedSlice(self.samples));
        visit(&DescribedSlice(self.majorants));
        visit_value(InUniforms { transfer: self.layout }, self.name, visit);
    }

    fn is_same(&self, other: &Self) -> bool {
        self.grid.is_same(&other.grid)
            && core::ptr::eq(self.samples.elements(), other.samples.elements())
    }
}

/// Layout in the uniform block: `volume_transfer`.
#[derive(Clone, Copy, Type)]
struct InUniforms {
    transfer: TransferLayout2d,
}

#[diagnostic::do_not_recommend]
impl<'a, M: Machine, T: Voxel> Method<{ name("grid") }, M, ()> for Volume2dView<'a, T> {
    type Output = GridView<'a, T>;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> GridView<'a, T> {
        self.grid
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel> Method<{ name("layout") }, M, ()> for Volume2dView<'_, T> {
    type Output = <TransferLayout2d as MachineType>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (): ()) -> Self::Output {
        m.capture(self.name, InUniforms { transfer: self.layout }).transfer
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel> Method<{ name("majorant") }, M, (U<M>,)> for Volume2dView<'_, T> {
    type Output = F<M>;

    #[inline(always)]
    fn call(self, m: &M, (i,): (U<M>,)) -> F<M> {
        m.element(&self.majorants, i)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel> Method<{ name("sample") }, M, (U<M>,)> for Volume2dView<'_, T> {
    type Output = <TransferSample as MachineType>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (i,): (U<M>,)) -> Self::Output {
        m.element(&self.samples, i)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel>
    Method<{ name("integrate") }, M, (On<Midpoint, M>, RayOn<M>, On<VolumeLight, M>)>
    for Volume2dView<'_, T>
{
    type Output = On<VolumeLight, M>;

    #[inline(always)]
    fn call(
        self,
        m: &M,
        (rule, ray, light): (On<Midpoint, M>, RayOn<M>, On<VolumeLight, M>),
    ) -> Self::Output {
        midpoint_2d::on(m, rule, self, ray, light)
    }
}

/// Returns a mix of two samples.
#[kernel]
#[inline(always)]
fn mixed(a: TransferSample, b: TransferSample, share: f32) -> TransferSample {
    TransferSample {
        color: a.color + (b.color - a.color) * share,
        extinction: a.extinction + (b.extinction - a.extinction) * share,
    }
}

/// Returns colour and extinction of a value with a gradient of this length.
#[kernel]
#[inline(always)]
fn sample_of<T: Voxel>(volume: &Volume2d<'_, T>, value: f32, gradient: f32) -> TransferSample {
    let TransferLayout2d { first, per, last, stride } = volume.layout();
    let place = clamp((vec2(value, gradient) - first) * per, vec2(0.0, 0.0), last);
    let cell = min(place, last - 0.5).floor();
    let share = place - cell;
    let i = cell.y as u32 * stride + cell.x as u32;
    let near = mixed(volume.sample(i), volume.sample(i + 1), share.x);
    let far = mixed(volume.sample(i + stride), volume.sample(i + stride + 1), share.x);
    mixed(near, far, share.y)
}

/// Returns a bound on the extinction in a macro-cell.
#[kernel]
#[inline(always)]
fn majorant_of<T: Voxel>(volume: &Volume2d<'_, T>, cell: Vec3) -> f32 {
    volume.majorant(index_of(cell, volume.grid().layout().macro_steps))
}

/// Returns what a step adds, by the sample in its middle.
#[kernel]
#[inline(always)]
fn step_2d<T: Voxel>(volume: &Volume2d<'_, T>, part: Inside, from: f32, to: f32) -> Step {
    let at = part.origin + part.direction * ((from + to) * 0.5);
    let cell = cell_around(volume.grid(), at);
    let gradient = length(gradient_in(volume.grid(), cell));
    let sample = sample_of(volume, value_in(volume.grid(), cell), gradient);
    let extinction = if cell.is_whole { sample.extinction } else { 0.0 };
    let depth = extinction * ((to - from) * part.scale);
    Step { color: sample.color, opacity: opacity_of(depth), depth }
}

march!(Midpoint by midpoint_2d in Volume2d, |this, volume, part, from, to| {
    step_2d(volume, part, from, to)
});
