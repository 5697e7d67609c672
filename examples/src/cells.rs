//! From cells of files to those of the library.

use raydsl::volume::cells::CellKind;
use raydsl_io::cells::CellKind as FileKind;

/// Returns the library's name of a file's kind of cell.
pub const fn kind_of(kind: FileKind) -> CellKind {
    match kind {
        FileKind::Tetrahedron => CellKind::Tetrahedron,
        FileKind::Pyramid => CellKind::Pyramid,
        FileKind::Wedge => CellKind::Wedge,
        FileKind::Hexahedron => CellKind::Hexahedron,
    }
}
