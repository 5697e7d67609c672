//! Fields on meshes of cells.

use glam::{Vec2, Vec3, vec2};

use super::error::CellError;
use super::face::CellFace;
use super::mesh::{CellMesh, Tetrahedron};
use super::view::{CellGridView, CellLayout};
use crate::bvh::{BuildConfig, Bvh};
use crate::geometry::Aabb;
use crate::machine::wgsl::BufferKey;
use crate::machine::{Owner, Slice};

/// Values of a field: one for each point, or one for each cell.
#[derive(Clone, Copy, Debug)]
pub enum CellData<'a> {
    /// A value for each point of the mesh; linear within each tetrahedron.
    Points(&'a [f32]),
    /// A value for each cell; constant within it.
    Cells(&'a [f32]),
}

/// Scalar field on a mesh of cells: the application's values, and a tree over the outer faces.
///
/// Tetrahedra with a value that is NaN or infinite are gaps, which rays pass as if there were no
/// cell.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::cells::{CellData, CellGrid, CellKind, CellMesh};
///
/// let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mesh = CellMesh::new(&points, &[0, 1, 2, 3], &[CellKind::Tetrahedron])?;
/// let grid = CellGrid::new(&mesh, CellData::Points(&[0.0, 1.0, 2.0, 4.0]))?;
/// let kernel = kernel!(|p: Vec3| grid.value(p).unwrap_or(-1.0));
/// assert_eq!(kernel.call((vec3(0.25, 0.25, 0.25),)), 1.75);
/// assert_eq!(kernel.call((vec3(1.0, 1.0, 1.0),)), -1.0);
/// # Ok::<(), raydsl::volume::cells::CellError>(())
/// ```
#[derive(Debug)]
pub struct CellGrid<'a> {
    mesh: &'a CellMesh<'a>,
    entries: Bvh<'a, CellFace>,
    data: CellData<'a>,
    layout: CellLayout,
    range: Vec2,
    has_gaps: bool,
    owner: Owner,
}

impl<'a> CellGrid<'a> {
    /// Joins a mesh and a value for each of its points, or of its cells. It sorts the outer faces
    /// into a tree.
    ///
    /// # Errors
    ///
    /// If the number of values is not that of points or cells, or the tree cannot be built.
    pub fn new(mesh: &'a CellMesh<'a>, data: CellData<'a>) -> Result<Self, CellError> {
        let (of, expected, values) = match data {
            CellData::Points(values) => ("points", mesh.points().len(), values),
            CellData::Cells(values) => ("cells", mesh.cells(), values),
        };
        if values.len() != expected {
            return Err(CellError::Values { of, expected, found: values.len() });
        }
        let entries = Bvh::build_sharing(mesh.faces(), mesh.points(), &BuildConfig::default())?;
        let finite = values.iter().copied().filter(|v| v.is_finite());
        let most = finite.clone().fold(f32::NEG_INFINITY, f32::max);
        let range = vec2(finite.fold(f32::INFINITY, f32::min), most);
        let layout =
            CellLayout { bounds: bounds(mesh), tetrahedra: mesh.tetrahedra().len() as u32 };
        let has_gaps = values.iter().any(|v| !v.is_finite());
        Ok(Self { mesh, entries, data, layout, range, has_gaps, owner: Owner::new() })
    }

    /// Returns the mesh.
    #[inline(always)]
    pub fn mesh(&self) -> &'a CellMesh<'a> {
        self.mesh
    }

    /// Returns the values.
    #[inline(always)]
    pub fn data(&self) -> CellData<'a> {
        self.data
    }

    /// Returns the least and the greatest finite value; the first is greater if there is none.
    pub fn range(&self) -> Vec2 {
        self.range
    }

    /// Returns the box around the mesh, a little larger, so that no ray misses it by rounding.
    pub fn bounds(&self) -> Aabb {
        self.layout.bounds
    }

    /// Returns the outer faces in a tree: what [`CellLine::ray`](super::CellLine::ray) hits where
    /// it enters the mesh.
    #[inline(always)]
    pub fn entries(&self) -> &Bvh<'a, CellFace> {
        &self.entries
    }

    fn values(&self) -> &'a [f32] {
        match self.data {
            CellData::Points(values) | CellData::Cells(values) => values,
        }
    }

    pub(super) fn named_view(&self, name: &'static str) -> CellGridView<'_> {
        let slice = |part| Some(BufferKey { id: self.mesh.owner.id(), version: 0, part });
        let own = Some(BufferKey { id: self.owner.id(), version: 0, part: 0 });
        CellGridView {
            entries: self.entries.view().named(name),
            tetrahedra: Slice::owned(self.mesh.tetrahedra(), slice(0), name).suffixed("tetrahedra"),
            faces: Slice::owned(self.mesh.faces(), slice(1), name).suffixed("faces"),
            values: Slice::owned(self.values(), own, name).suffixed("values"),
            layout: self.layout,
            is_of_cells: self.is_of_cells(),
            has_gaps: self.has_gaps,
            name,
        }
    }
}

/// What the kernels of this module read from a grid.
impl CellGrid<'_> {
    #[inline(always)]
    pub(super) fn layout(&self) -> CellLayout {
        self.layout
    }

    #[inline(always)]
    pub(super) fn is_of_cells(&self) -> bool {
        matches!(self.data, CellData::Cells(_))
    }

    #[inline(always)]
    pub(super) fn has_gaps(&self) -> bool {
        self.has_gaps
    }

    #[inline(always)]
    pub(super) fn tetrahedron(&self, i: u32) -> Tetrahedron {
        self.mesh.tetrahedra()[i as usize]
    }

    #[inline(always)]
    pub(super) fn face(&self, i: u32) -> CellFace {
        self.mesh.faces()[i as usize]
    }

    #[inline(always)]
    pub(super) fn point(&self, i: u32) -> Vec3 {
        self.mesh.points()[i as usize]
    }

    #[inline(always)]
    pub(super) fn number(&self, i: u32) -> f32 {
        self.values()[i as usize]
    }
}

/// Returns the box around all cells, larger by 2^-18 of its coordinates.
fn bounds(mesh: &CellMesh<'_>) -> Aabb {
    let corners = mesh.tetrahedra().iter().flat_map(|t| t.vertices.to_array());
    let whole = Aabb::from_points(corners.map(|i| mesh.points()[i as usize]));
    if !whole.is_finite() {
        return whole;
    }
    let more = whole.min.abs().max(whole.max.abs()).max_element() * (1.0 / 262_144.0);
    Aabb::new(whole.min - more, whole.max + more)
}
