//! Volumes: a grid seen through a transfer function.

use super::grid::{Grid, GridView};
use super::integrator::VolumeIntegrator;
use super::light::VolumeLight;
use super::transfer::{TransferFunction, TransferView};
use super::voxel::Voxel;
use crate::geometry::{Ray, RayOn};
use crate::machine::table_view;
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    Capture, DescribedSlice, F, Inferred, Leaves, Machine, Method, On, Owner, Parameter, Resource,
    Schema, Slice, Table, TableView, U, Value, name,
};

/// Grid that is seen through a transfer function, with the greatest extinction of each macro-cell,
/// by which integrators skip empty space.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::{ExactCell, Grid, GridConfig, TransferFunction, Volume, VolumeLight};
///
/// let voxels = [1.0f32; 8];
/// let grid = Grid::new(&voxels[..], uvec3(2, 2, 2), GridConfig::new())?;
/// let function = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 2.0)])?;
/// let volume = Volume::new(&grid, function);
/// let exact = ExactCell::new();
/// let kernel = kernel!(|ray: Ray| {
///     volume.integrate(&exact, ray, VolumeLight::new()).opacity()
/// });
/// let through = Ray::new(vec3(0.5, 0.5, -1.0), Vec3::Z);
/// assert!((kernel.call((through,)) - (1.0 - (-2.0f32).exp())).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Volume<'a, T: Voxel> {
    grid: &'a Grid<'a, T>,
    transfer: TransferFunction,
    majorants: Vec<f32>,
    owner: Owner,
}

impl<'a, T: Voxel> Volume<'a, T> {
    /// Joins a grid and a transfer function.
    pub fn new(grid: &'a Grid<'a, T>, transfer: TransferFunction) -> Self {
        let majorants = majorants(grid, &transfer);
        Self { grid, transfer, majorants, owner: Owner::new() }
    }

    /// Replaces the transfer function, which takes time in proportion to the number of macro-cells;
    /// no kernel is recorded or compiled again.
    pub fn set_transfer(&mut self, transfer: TransferFunction) {
        *self = Self::new(self.grid, transfer);
    }

    /// Returns the grid.
    #[inline(always)]
    pub fn grid(&self) -> &'a Grid<'a, T> {
        self.grid
    }

    /// Returns the transfer function.
    #[inline(always)]
    pub fn transfer(&self) -> &TransferFunction {
        &self.transfer
    }

    /// Returns the greatest extinction in each macro-cell, as [`Grid::ranges`] are ordered; 0 in
    /// those that are empty.
    pub fn majorants(&self) -> &[f32] {
        &self.majorants
    }

    /// Returns `light` with what the volume adds behind it, between the ray's `t_min` and `t_max`.
    ///
    /// The parts of a ray follow one another, front to back: what is behind a cut, other volumes, a
    /// surface at the end.
    #[inline]
    pub fn integrate<I: VolumeIntegrator>(
        &self,
        integrator: &I,
        ray: Ray,
        light: VolumeLight,
    ) -> VolumeLight {
        integrator.integrate(self, ray, light)
    }

    #[inline(always)]
    pub(super) fn majorant(&self, i: u32) -> f32 {
        self.majorants[i as usize]
    }

    fn named_view(&self, name: &'static str) -> VolumeView<'_, T> {
        let key = BufferKey { id: self.owner.id(), version: 0, part: 0 };
        VolumeView {
            grid: self.grid.named_view(name),
            transfer: self.transfer.named_view(name),
            majorants: Slice::owned(&self.majorants, Some(key), name).suffixed("majorants"),
        }
    }
}

fn majorants<T: Voxel>(grid: &Grid<'_, T>, transfer: &TransferFunction) -> Vec<f32> {
    grid.ranges().iter().map(|range| transfer.greatest_extinction(*range)).collect()
}

/// View of a [`Volume`] in kernels: a host value on every machine.
#[derive(Debug)]
pub struct VolumeView<'a, T: Voxel> {
    grid: GridView<'a, T>,
    transfer: TransferView<'a>,
    majorants: Slice<'a, f32>,
}

impl<T: Voxel> Clone for VolumeView<'_, T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T: Voxel> Copy for VolumeView<'_, T> {}

table_view!([T: Voxel] Volume<'_, T>, VolumeView, "volume", "volumes");

impl<T: Voxel> TableView for VolumeView<'_, T> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        self.grid.resources(visit);
        self.transfer.resources(visit);
        visit(&DescribedSlice(self.majorants));
    }

    fn is_same(&self, other: &Self) -> bool {
        self.grid.is_same(&other.grid) && self.transfer.is_same(&other.transfer)
    }
}

#[diagnostic::do_not_recommend]
impl<'a, M: Machine, T: Voxel> Method<{ name("grid") }, M, ()> for VolumeView<'a, T> {
    type Output = GridView<'a, T>;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> GridView<'a, T> {
        self.grid
    }
}

#[diagnostic::do_not_recommend]
impl<'a, M: Machine, T: Voxel> Method<{ name("transfer") }, M, ()> for VolumeView<'a, T> {
    type Output = TransferView<'a>;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> TransferView<'a> {
        self.transfer
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel> Method<{ name("majorant") }, M, (U<M>,)> for VolumeView<'_, T> {
    type Output = F<M>;

    #[inline(always)]
    fn call(self, m: &M, (i,): (U<M>,)) -> F<M> {
        m.element(&self.majorants, i)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Voxel, I: Inferred<M>>
    Method<{ name("integrate") }, M, (I, RayOn<M>, On<VolumeLight, M>)> for VolumeView<'_, T>
where
    I::Host: VolumeIntegrator,
{
    type Output = On<VolumeLight, M>;

    #[inline(always)]
    fn call(
        self,
        m: &M,
        (integrator, ray, light): (I, RayOn<M>, On<VolumeLight, M>),
    ) -> Self::Output {
        I::Host::integrate_on(m, integrator.give(m), self, ray, light)
    }
}
