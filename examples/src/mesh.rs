//! Triangles from files.

use std::path::Path;

use raydsl::prelude::*;
use raydsl_io::LoadError;

/// Loads the triangles of an `.obj`, a `.ply` or a `.tri`, each with corners of its own.
///
/// # Errors
///
/// As [`raydsl_io::mesh::load`].
pub fn load(path: &Path) -> Result<Vec<Triangle>, LoadError> {
    let mesh = raydsl_io::mesh::load(path)?;
    Ok(mesh.corners().map(|[v0, v1, v2]| Triangle { v0, v1, v2 }).collect())
}
