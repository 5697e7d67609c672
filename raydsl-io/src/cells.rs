//! Unstructured grids: fields on tetrahedra, pyramids, wedges and hexahedra, from VTU files.

use std::path::Path;

use glam::Vec3;

use crate::LoadError;
use crate::format::{self, Format, loader};
use crate::source::Source;

/// Names the kind of a cell, with its vertices numbered as VTK numbers them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CellKind {
    /// Four vertices.
    Tetrahedron,
    /// Four vertices around a quadrilateral, and the apex.
    Pyramid,
    /// Three vertices of a triangle, and those of another that they are joined to.
    Wedge,
    /// Four vertices around a quadrilateral, and those of another that they are joined to. Voxels
    /// of the file are hexahedra here.
    Hexahedron,
}

impl CellKind {
    /// Gives the number of its vertices: 4, 5, 6 or 8.
    pub const fn vertices(self) -> usize {
        match self {
            Self::Tetrahedron => 4,
            Self::Pyramid => 5,
            Self::Wedge => 6,
            Self::Hexahedron => 8,
        }
    }
}

/// Holds the numbers of one name, so many for each point or for each cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellArray {
    /// The name; empty where the file has none.
    pub name: String,
    /// Numbers for each point or cell: 1 for a scalar, 3 for a vector; at least 1.
    pub components: usize,
    /// The numbers, all of the first point or cell first, as floats of 32 bits: rounded, and
    /// infinite beyond their range. They may be NaN.
    pub values: Vec<f32>,
}

/// Holds cells and the fields on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellFile {
    /// The points, in units of the file; finite.
    pub points: Vec<Vec3>,
    /// The kind of each cell; at least one.
    pub kinds: Vec<CellKind>,
    /// The vertices of all cells, one after another, as indices of points.
    pub vertices: Vec<u32>,
    /// The arrays of the points.
    pub point_arrays: Vec<CellArray>,
    /// The arrays of the cells, without those of the cells that are left out.
    pub cell_arrays: Vec<CellArray>,
    /// The names of the active scalars of points and of cells, where the file has some.
    pub active: [Option<String>; 2],
    /// How many cells of other kinds are left out: vertices, lines, polygons, polyhedra and those
    /// with curved edges.
    pub skipped: usize,
}

impl CellFile {
    /// Gives the array of this name, of points or else of cells, and whether it is of cells.
    pub fn array(&self, name: &str) -> Option<(&CellArray, bool)> {
        let of = |arrays: &'_ [CellArray]| arrays.iter().position(|a| a.name == name);
        let of_points = of(&self.point_arrays).map(|i| (&self.point_arrays[i], false));
        of_points.or_else(|| of(&self.cell_arrays).map(|i| (&self.cell_arrays[i], true)))
    }

    /// Gives the active scalars of points, or else of cells, or else the first array of one
    /// component, and whether it is of cells.
    pub fn scalars(&self) -> Option<(&CellArray, bool)> {
        let lists = [(&self.point_arrays, false), (&self.cell_arrays, true)];
        let active = lists.iter().zip(&self.active).find_map(|((arrays, is_cells), name)| {
            let name = name.as_deref()?;
            let array = arrays.iter().find(|a| a.name == name && a.components == 1)?;
            Some((array, *is_cells))
        });
        let first = || {
            lists.iter().find_map(|(arrays, is_cells)| {
                Some((arrays.iter().find(|a| a.components == 1)?, *is_cells))
            })
        };
        active.or_else(first)
    }
}

type Reading = fn(Source) -> Result<CellFile, LoadError>;

const FORMATS: [Format<Reading>; 1] = [Format {
    extension: "vtu",
    name: "VTU",
    feature: "vtu",
    read: loader!("vtu", crate::vtu::read),
}];

/// Loads cells and all their arrays by their file's extension, in any case: `.vtu`. Arrays of text
/// are left out.
///
/// # Errors
///
/// When the file is missing, unreadable or of unknown extension, is cut off or corrupt, has several
/// pieces, no cell with a volume, 2^32 points or cells or more, a point that is not finite, or a
/// vertex that is no point.
///
/// # Examples
///
/// ```no_run
/// let file = raydsl_io::cells::load("fire.vtu")?;
/// println!("{} cells, {} points", file.kinds.len(), file.points.len());
/// # Ok::<(), raydsl_io::LoadError>(())
/// ```
pub fn load(path: impl AsRef<Path>) -> Result<CellFile, LoadError> {
    let path = path.as_ref();
    let (format, read) = format::of(path, &FORMATS)?;
    read(Source::open(path, format.name)?)
}
