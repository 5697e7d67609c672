//! Unstructured grids: fields on tetrahedra, pyramids, wedges and hexahedra.
//!
//! [`CellMesh`] divides cells into tetrahedra and joins those that share a face; [`CellGrid`] has a
//! value for each point, or for each cell; [`CellVolume`] sees it through a transfer function. A
//! ray finds by a tree where it enters the mesh, and goes on from cell to cell by the faces that
//! they share.
//!
//! Within a tetrahedron a field is linear, so integrals and surfaces along a ray are exact. Rays
//! pass from face to face by exact signs alone: of the four faces of a tetrahedron a ray passes
//! through two or none, also through edges and vertices. So each face has one way in and one way
//! out, no ray is lost, and no walk passes a cell twice.

mod error;
mod face;
mod frame;
mod grid;
mod integrate;
mod kind;
mod mesh;
mod topology;
mod values;
mod vectors;
mod view;
mod volume;
mod walk;

pub use error::CellError;
pub use face::CellFace;
pub use grid::{CellData, CellGrid};
pub use integrate::CellIntegrator;
pub use kind::CellKind;
pub use mesh::{CellMesh, MAX_COORDINATE, MAX_TETRAHEDRA, Tetrahedron};
pub use vectors::{CellVectors, CellVectorsView};
pub use view::{CellGridView, CellLayout};
pub use volume::{CellVolume, CellVolumeView};
pub use walk::{CellLine, CellPart, CellWalk};
