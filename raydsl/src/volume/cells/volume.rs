//! Volumes of cells: a grid of cells seen through a transfer function.

use super::integrate::CellIntegrator;
use super::{CellGrid, CellGridView};
use crate::geometry::{Ray, RayOn};
use crate::machine::table_view;
use crate::machine::{
    Capture, Inferred, Leaves, Machine, Method, On, Parameter, Resource, Schema, Table, TableView,
    Value, name,
};
use crate::volume::VolumeLight;
use crate::volume::transfer::{TransferFunction, TransferView};

/// Grid of cells that is seen through a transfer function.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::cells::{CellData, CellGrid, CellKind, CellMesh, CellVolume};
/// use raydsl::volume::{ExactCell, TransferFunction, VolumeLight};
///
/// let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mesh = CellMesh::new(&points, &[0, 1, 2, 3], &[CellKind::Tetrahedron])?;
/// let grid = CellGrid::new(&mesh, CellData::Cells(&[1.0]))?;
/// let function = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 2.0)])?;
/// let volume = CellVolume::new(&grid, function);
/// let exact = ExactCell::new();
/// let kernel = kernel!(|ray: Ray| {
///     volume.integrate(&exact, ray, VolumeLight::new()).opacity()
/// });
/// let through = Ray::new(vec3(0.25, 0.25, -1.0), Vec3::Z);
/// assert!((kernel.call((through,)) - (1.0 - (-1.0f32).exp())).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct CellVolume<'a> {
    grid: &'a CellGrid<'a>,
    transfer: TransferFunction,
}

impl<'a> CellVolume<'a> {
    /// Joins a grid and a transfer function.
    pub fn new(grid: &'a CellGrid<'a>, transfer: TransferFunction) -> Self {
        Self { grid, transfer }
    }

    /// Replaces the transfer function; no kernel is recorded or compiled again.
    pub fn set_transfer(&mut self, transfer: TransferFunction) {
        self.transfer = transfer;
    }

    /// Returns the grid.
    #[inline(always)]
    pub fn grid(&self) -> &'a CellGrid<'a> {
        self.grid
    }

    /// Returns the transfer function.
    #[inline(always)]
    pub fn transfer(&self) -> &TransferFunction {
        &self.transfer
    }

    /// Returns `light` with what the volume adds behind it, between the ray's `t_min` and `t_max`:
    /// right to rounding in each tetrahedron, as [`ExactCell`](crate::volume::ExactCell) says.
    /// Between cells there is nothing; where cells overlap, the one counts that the ray enters
    /// first.
    #[inline]
    pub fn integrate<I: CellIntegrator>(
        &self,
        integrator: &I,
        ray: Ray,
        light: VolumeLight,
    ) -> VolumeLight {
        integrator.integrate_cells(self, ray, light)
    }

    fn named_view(&self, name: &'static str) -> CellVolumeView<'_> {
        CellVolumeView {
            grid: self.grid.named_view(name),
            transfer: self.transfer.named_view(name),
        }
    }
}

/// View of a [`CellVolume`] in kernels: a host value on every machine.
#[derive(Clone, Copy, Debug)]
pub struct CellVolumeView<'a> {
    grid: CellGridView<'a>,
    transfer: TransferView<'a>,
}

table_view!([] CellVolume<'_>, CellVolumeView, "volume", "volumes");

impl TableView for CellVolumeView<'_> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        self.grid.resources(visit);
        self.transfer.resources(visit);
    }

    fn is_same(&self, other: &Self) -> bool {
        self.grid.is_same(&other.grid) && self.transfer.is_same(&other.transfer)
    }
}

#[diagnostic::do_not_recommend]
impl<'a, M: Machine> Method<{ name("grid") }, M, ()> for CellVolumeView<'a> {
    type Output = CellGridView<'a>;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> CellGridView<'a> {
        self.grid
    }
}

#[diagnostic::do_not_recommend]
impl<'a, M: Machine> Method<{ name("transfer") }, M, ()> for CellVolumeView<'a> {
    type Output = TransferView<'a>;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> TransferView<'a> {
        self.transfer
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, I: Inferred<M>> Method<{ name("integrate") }, M, (I, RayOn<M>, On<VolumeLight, M>)>
    for CellVolumeView<'_>
where
    I::Host: CellIntegrator,
{
    type Output = On<VolumeLight, M>;

    #[inline(always)]
    fn call(
        self,
        m: &M,
        (integrator, ray, light): (I, RayOn<M>, On<VolumeLight, M>),
    ) -> Self::Output {
        I::Host::integrate_cells_on(m, integrator.give(m), self, ray, light)
    }
}
