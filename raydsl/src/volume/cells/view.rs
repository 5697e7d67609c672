//! Grids of cells as kernels see them.

use super::CellGrid;
use super::face::CellFace;
use super::mesh::Tetrahedron;
use super::{values, walk};
use crate::Type;
use crate::bvh::SceneView;
use crate::geometry::{Aabb, RayOn};
use crate::machine::table_view;
use crate::machine::{
    Capture, DescribedSlice, F, HostFact, Leaves, Machine, Method, On, Parameter, Resource, Schema,
    Slice, Table, TableView, U, V3, Value, name, visit_value,
};
use crate::volume::SurfaceHit;

/// What kernels know of a grid of cells in the uniform block.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct CellLayout {
    /// Box around the mesh.
    pub bounds: Aabb,
    /// Number of tetrahedra.
    pub tetrahedra: u32,
}

/// View of a [`CellGrid`] in kernels: a host value on every machine.
#[derive(Clone, Copy, Debug)]
pub struct CellGridView<'a> {
    pub(super) entries: SceneView<'a, CellFace>,
    pub(super) tetrahedra: Slice<'a, Tetrahedron>,
    pub(super) faces: Slice<'a, CellFace>,
    pub(super) values: Slice<'a, f32>,
    pub(super) layout: CellLayout,
    pub(super) is_of_cells: bool,
    pub(super) has_gaps: bool,
    pub(super) name: &'static str,
}

table_view!([] CellGrid<'_>, CellGridView, "cells", "grids of cells");

impl TableView for CellGridView<'_> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&self.entries);
        visit(&DescribedSlice(self.tetrahedra));
        visit(&DescribedSlice(self.faces));
        visit(&DescribedSlice(self.values));
        visit_value(InUniforms { cells: self.layout }, self.name, visit);
        visit(&HostFact(self.is_of_cells.into()));
        visit(&HostFact(self.has_gaps.into()));
    }

    fn is_same(&self, other: &Self) -> bool {
        let tetrahedra = [self, other].map(|v| v.tetrahedra.elements().as_ptr());
        let values = [self, other].map(|v| v.values.elements().as_ptr());
        tetrahedra[0] == tetrahedra[1] && values[0] == values[1]
    }
}

/// Layout in the uniform block: `fire_cells`.
#[derive(Clone, Copy, Type)]
struct InUniforms {
    cells: CellLayout,
}

/// Implements a method of the view in kernels.
macro_rules! methods {
    ($($name:literal ($($arg:ident: $t:ty),*) -> $out:ty, |$this:ident, $m:ident| $body:expr;)+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<'a, M: Machine> Method<{ name($name) }, M, ($($t,)*)> for CellGridView<'a> {
                type Output = $out;

                #[inline(always)]
                fn call(self, $m: &M, ($($arg,)*): ($($t,)*)) -> $out {
                    let $this = self;
                    $body
                }
            }
        )+
    };
}

methods! {
    "layout"() -> On<CellLayout, M>, |this, m| {
        m.capture(this.name, InUniforms { cells: this.layout }).cells
    };
    "entries"() -> SceneView<'a, CellFace>, |this, _m| this.entries;
    "is_of_cells"() -> bool, |this, _m| this.is_of_cells;
    "has_gaps"() -> bool, |this, _m| this.has_gaps;
    "tetrahedron"(i: U<M>) -> On<Tetrahedron, M>, |this, m| m.element(&this.tetrahedra, i);
    "face"(i: U<M>) -> On<CellFace, M>, |this, m| m.element(&this.faces, i);
    "point"(i: U<M>) -> V3<M>, |this, m| m.element(&this.entries.shared(), i);
    "number"(i: U<M>) -> F<M>, |this, m| m.element(&this.values, i);
    "value"(p: V3<M>) -> On<Option<f32>, M>, |this, m| values::value::on(m, this, p);
    "length_inside"(ray: RayOn<M>) -> F<M>, |this, m| values::length_inside::on(m, this, ray);
    "first_surface"(ray: RayOn<M>, value: F<M>) -> On<Option<SurfaceHit>, M>, |this, m| {
        values::first_surface::on(m, this, ray, value)
    };
    "line"(ray: RayOn<M>) -> On<walk::CellLine, M>, |this, m| {
        walk::line_of::on(m, this, ray)
    };
    "enter"(line: On<walk::CellLine, M>, entry: U<M>) -> On<walk::CellWalk, M>, |this, m| {
        walk::enter::on(m, this, line, entry)
    };
}
