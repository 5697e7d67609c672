//! Errors of creating meshes of cells, and of joining values to them.

use glam::Vec3;

use crate::bvh::BuildError;

/// Why cells make no mesh, or values do not fit it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CellError {
    /// A point is not finite, or too far away.
    #[error(
        "point {index} of the cells is {position}: coordinates are finite and at most {limit:e}; \
         repair it, or choose a larger unit of length"
    )]
    Point {
        /// Index of the point.
        index: usize,
        /// The point.
        position: Vec3,
        /// [`MAX_COORDINATE`](super::MAX_COORDINATE).
        limit: f32,
    },
    /// A cell has a vertex that is no point.
    #[error("cell {cell} has point {index}, and there are {points}: indices count from 0")]
    Index {
        /// Index of the cell.
        cell: usize,
        /// The index that it has.
        index: u32,
        /// Number of points.
        points: usize,
    },
    /// The vertices of all cells are more or fewer than those given.
    #[error(
        "the kinds of cells have {expected} vertices in all, not {found}: give 4 for each \
         tetrahedron, 5 for each pyramid, 6 for each wedge and 8 for each hexahedron"
    )]
    Vertices {
        /// Sum over all cells.
        expected: u64,
        /// Number of vertices given.
        found: usize,
    },
    /// The cells have too many tetrahedra.
    #[error("{count} tetrahedra are too many: at most {limit}; split the mesh")]
    TooMany {
        /// Number of tetrahedra.
        count: u64,
        /// [`MAX_TETRAHEDRA`](super::MAX_TETRAHEDRA).
        limit: u64,
    },
    /// The number of values is not that of points or cells.
    #[error("{found} values for {expected} {of}: give one for each")]
    Values {
        /// `points` or `cells`.
        of: &'static str,
        /// Number of them.
        expected: usize,
        /// Number of values given.
        found: usize,
    },
    /// The tree over the outer faces cannot be built.
    #[error("outer faces of cells: {0}")]
    Tree(#[from] BuildError),
}
