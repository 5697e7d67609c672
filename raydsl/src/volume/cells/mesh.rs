//! Meshes of cells: the application's points, and tetrahedra that know their neighbours.

use std::collections::HashSet;

use glam::{DVec3, UVec4, Vec3, uvec4};

use super::error::CellError;
use super::face::CellFace;
use super::kind::{CellKind, divide};
use super::topology;
use super::vectors::{least_of, weights_of};
use crate::geometry::{Aabb, Hit, Ray};
use crate::machine::Owner;
use crate::machine::generic::max;
use crate::primitive;

/// Largest coordinate of a point. A mesh smaller than some 1e-20 should be scaled too: products of its
/// coordinates underflow.
pub const MAX_COORDINATE: f32 = 1e12;

/// Maximum number of tetrahedra of a mesh; a hexahedron has six.
pub const MAX_TETRAHEDRA: u64 = 1 << 29;

/// No neighbour.
pub(super) const NONE: u32 = u32::MAX;

/// By how much a weight may be below 0 inside of a tetrahedron: rounding leaves gaps between two.
const WEIGHT_ERROR: f32 = 1.0 / 4096.0;

/// A tetrahedron of a mesh and its neighbours; with the mesh's points as shared data it is a
/// primitive, by which a tree finds where points are.
#[primitive]
#[derive(Debug, PartialEq, Eq)]
pub struct Tetrahedron {
    /// Indices of its points; positively oriented in a mesh that is not folded.
    pub vertices: UVec4,
    /// Across the face that lacks each vertex: four times the number of the tetrahedron there, plus
    /// the place of its own vertex that the face lacks; `u32::MAX` where there is none.
    pub across: UVec4,
    /// Index of the cell that it is a part of.
    pub cell: u32,
}

#[primitive]
impl Tetrahedron {
    const IS_SHORT: bool = true;
    const MAX_CROSSINGS: u32 = 1;

    /// Returns a hit if the ray begins inside. `t` is not a distance, but says by how much rounding
    /// puts the origin outside: from 0 inside to 1 at 2^-12 of the height over a face.
    #[inline]
    pub fn intersect(&self, ray: Ray, points: &[Vec3]) -> Hit {
        let i = self.vertices;
        let (a, b) = (points[i.x as usize], points[i.y as usize]);
        let (c, d) = (points[i.z as usize], points[i.w as usize]);
        let least = least_of(weights_of(ray.origin, a, b, c, d));
        let t = max(-least / WEIGHT_ERROR, 0.0);
        // Of a flat one it is a NaN.
        Hit::new(least >= -WEIGHT_ERROR && t >= ray.t_min && t <= ray.t_max, t)
    }

    /// Returns the bounds of its points.
    pub fn get_bounds(&self, points: &[Vec3]) -> Aabb {
        let vertices = self.vertices.to_array();
        Aabb::from_points(vertices.map(|i| points.get(i as usize).copied().unwrap_or(Vec3::NAN)))
    }
}

/// Cells over the application's points, divided into tetrahedra that are joined at the faces that
/// they share.
///
/// Hexahedra, wedges and pyramids are divided by the lowest indices of their vertices, so that
/// both cells at a face divide it alike: cells that share the points of a face share the face.
/// Cells may be given in either orientation. A cell that is given twice counts once. At a face of
/// more than two tetrahedra, and where orientations around a ring of cells contradict, the mesh is
/// cut open; rays leave it there and enter it again.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::cells::{CellKind, CellMesh};
///
/// let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::ONE];
/// let kinds = [CellKind::Tetrahedron; 2];
/// let mesh = CellMesh::new(&points, &[0, 1, 2, 3, 1, 2, 3, 4], &kinds)?;
/// assert_eq!(mesh.tetrahedra().len(), 2);
/// assert_eq!(mesh.faces().len(), 6);
/// # Ok::<(), raydsl::volume::cells::CellError>(())
/// ```
#[derive(Debug)]
pub struct CellMesh<'a> {
    points: &'a [Vec3],
    tetrahedra: Vec<Tetrahedron>,
    faces: Vec<CellFace>,
    cells: usize,
    pub(super) owner: Owner,
}

impl<'a> CellMesh<'a> {
    /// Creates the mesh of cells of these kinds, whose vertices, indices of points, follow one
    /// another in `vertices`. Without cells it is empty, which no ray hits.
    ///
    /// # Errors
    ///
    /// If a point is not finite or farther than [`MAX_COORDINATE`], a vertex is no point, the
    /// number of vertices is not that of the kinds, or there are more than [`MAX_TETRAHEDRA`].
    pub fn new(
        points: &'a [Vec3],
        vertices: &[u32],
        kinds: &[CellKind],
    ) -> Result<Self, CellError> {
        check(points, vertices, kinds)?;
        let (mut found, mut known) = (Vec::new(), HashSet::new());
        let mut rest = vertices;
        for (cell, kind) in kinds.iter().enumerate() {
            let (own, others) = rest.split_at(kind.vertices());
            rest = others;
            if let Some(&index) = own.iter().find(|i| **i as usize >= points.len()) {
                return Err(CellError::Index { cell, index, points: points.len() });
            }
            divide(*kind, own, |vertices| {
                let mut sorted = vertices;
                sorted.sort_unstable();
                if known.insert(sorted) {
                    let vertices = UVec4::from(vertices);
                    let across = uvec4(NONE, NONE, NONE, NONE);
                    found.push(Tetrahedron { vertices, across, cell: cell as u32 });
                }
            });
        }
        drop(known);
        topology::join(&mut found);
        topology::orient(&mut found, |vertices| volume(points, vertices));
        let faces = topology::outer_faces(&found);
        let (tetrahedra, cells) = (found, kinds.len());
        Ok(Self { points, tetrahedra, faces, cells, owner: Owner::new() })
    }

    /// Returns the application's points.
    #[inline(always)]
    pub fn points(&self) -> &'a [Vec3] {
        self.points
    }

    /// Returns the tetrahedra of all cells, in the cells' order.
    #[inline(always)]
    pub fn tetrahedra(&self) -> &[Tetrahedron] {
        &self.tetrahedra
    }

    /// Returns the faces that no two tetrahedra share.
    #[inline(always)]
    pub fn faces(&self) -> &[CellFace] {
        &self.faces
    }

    /// Returns the number of cells.
    #[inline(always)]
    pub fn cells(&self) -> usize {
        self.cells
    }
}

/// Checks what is told about the whole mesh.
fn check(points: &[Vec3], vertices: &[u32], kinds: &[CellKind]) -> Result<(), CellError> {
    let limit = MAX_COORDINATE;
    let is_good = |p: &Vec3| p.is_finite() && p.abs().max_element() <= limit;
    if let Some(index) = points.iter().position(|p| !is_good(p)) {
        return Err(CellError::Point { index, position: points[index], limit });
    }
    let sum = |count: fn(CellKind) -> usize| kinds.iter().map(|k| count(*k) as u64).sum::<u64>();
    let expected = sum(CellKind::vertices);
    if expected != vertices.len() as u64 {
        return Err(CellError::Vertices { expected, found: vertices.len() });
    }
    let (count, limit) = (sum(CellKind::tetrahedra), MAX_TETRAHEDRA);
    if count > limit {
        return Err(CellError::TooMany { count, limit });
    }
    Ok(())
}

/// Returns six times the signed volume of a tetrahedron.
fn volume(points: &[Vec3], vertices: UVec4) -> f64 {
    let [a, b, c, d] = vertices.to_array().map(|i| points[i as usize].as_dvec3());
    DVec3::dot((b - a).cross(c - a), d - a)
}
