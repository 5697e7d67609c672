//! Meshes of triangles, from OBJ, PLY and TRI files.
//!
//! TRI is this project's own: a little-endian `u32` that counts triangles, and for each triangle
//! nine little-endian `f32`, its three corners.

use std::path::Path;

use glam::Vec3;

use crate::LoadError;
use crate::format::{self, Format, loader};
use crate::source::Source;

/// What to do with a mesh that is too large.
pub(crate) const SPLIT: &str = "split it into several files, or simplify it";

/// Holds triangles as indices into an array of vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The vertices, in units of the file.
    pub vertices: Vec<Vec3>,
    /// The normals, one for each vertex, as they are in the file: of any length. Empty where the
    /// file has none, or not for every corner.
    pub normals: Vec<Vec3>,
    /// The triangles, each three indices into `vertices`. A polygon of the file is a fan of
    /// triangles around its first corner.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Gives the three corners of each triangle.
    ///
    /// # Panics
    ///
    /// If an index is none of a vertex; those of a loaded mesh all are.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = [Vec3; 3]> + '_ {
        self.triangles.iter().map(|t| t.map(|i| self.vertices[i as usize]))
    }
}

type Reading = fn(Source) -> Result<Mesh, LoadError>;

const FORMATS: [Format<Reading>; 3] = [
    Format {
        extension: "obj",
        name: "OBJ",
        feature: "obj",
        read: loader!("obj", crate::obj::read),
    },
    Format {
        extension: "ply",
        name: "PLY",
        feature: "ply",
        read: loader!("ply", crate::ply::mesh::read),
    },
    Format {
        extension: "tri",
        name: "TRI",
        feature: "tri",
        read: loader!("tri", crate::tri::read),
    },
];

/// Loads a mesh by its file's extension, in any case: `.obj`, `.ply` or `.tri`.
///
/// There is at least one triangle, all indices are those of vertices, and the corners of all
/// triangles are finite. A vertex that no triangle uses may not be.
///
/// # Errors
///
/// When the file is missing, unreadable or of unknown extension, is cut off or corrupt, holds no
/// triangle, more than `u32::MAX` vertices or triangles, or a triangle with a corner that is not
/// finite.
///
/// # Examples
///
/// ```no_run
/// let mesh = raydsl_io::mesh::load("scene.ply")?;
/// for [a, b, c] in mesh.corners() {
///     println!("{a} {b} {c}");
/// }
/// # Ok::<(), raydsl_io::LoadError>(())
/// ```
pub fn load(path: impl AsRef<Path>) -> Result<Mesh, LoadError> {
    let path = path.as_ref();
    let (format, read) = format::of(path, &FORMATS)?;
    let mesh = read(Source::open(path, format.name)?)?;
    check(&mesh, path)?;
    Ok(mesh)
}

fn check(mesh: &Mesh, path: &Path) -> Result<(), LoadError> {
    for (what, count) in [("vertex", mesh.vertices.len()), ("triangle", mesh.triangles.len())] {
        let (count, limit) = (count as u64, u64::from(u32::MAX));
        if count > limit {
            let path = path.into();
            return Err(LoadError::TooMany { path, what, count, limit, remedy: SPLIT });
        }
    }
    if mesh.triangles.is_empty() {
        return Err(LoadError::Empty { path: path.into(), what: "triangle" });
    }
    let is_bad = |corners: &[Vec3; 3]| !corners.iter().all(|v| v.is_finite());
    let Some(first) = mesh.corners().position(|corners| is_bad(&corners)) else { return Ok(()) };
    Err(LoadError::NotFinite {
        path: path.into(),
        what: "triangle",
        count: mesh.corners().filter(is_bad).count(),
        total: mesh.triangles.len(),
        first,
        remedy: "remove its vertices, or scale it to what 32-bit floats hold",
    })
}

/// A polygon's triangles, all with its first corner.
pub(crate) fn fan<T: Copy>(polygon: &[T]) -> impl Iterator<Item = [T; 3]> + '_ {
    polygon.windows(2).skip(1).map(|pair| [polygon[0], pair[0], pair[1]])
}
