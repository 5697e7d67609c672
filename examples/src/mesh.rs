//! Triangles from files.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};
use raydsl::prelude::*;
use tobj::LoadOptions;

/// A mesh that cannot be used, in one line: what is wrong, and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The operating system refused to read.
    #[error("{}: cannot be read ({source}); check the path and its permissions", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The refusal.
        source: std::io::Error,
    },
    /// The file's name does not tell a known format.
    #[error("{}: its name does not end in .obj, .ply or .tri; convert it to one of them", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The file contradicts its format.
    #[error("{}: is no valid mesh: {what}; write it again", path.display())]
    Corrupt {
        /// The file.
        path: PathBuf,
        /// The contradiction.
        what: String,
    },
}

/// Reads `.obj`, `.ply` or `.tri` (a `u32` that counts triangles, then nine `f32` for each, all
/// little-endian). Polygons become fans; there is at least one triangle, and all are finite.
///
/// # Errors
///
/// A file that is not there, or not what its name says.
pub fn load(path: &Path) -> Result<Vec<Triangle>, MeshError> {
    let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    let read = match extension.as_deref() {
        Some("obj") => obj,
        Some("ply") => ply,
        Some("tri") => tri,
        _ => return Err(MeshError::UnknownFormat { path: path.into() }),
    };
    let unreadable = |source| MeshError::Unreadable { path: path.into(), source };
    let file = File::open(path).map_err(unreadable)?;
    // A folder can be opened, but not read.
    if file.metadata().map_err(unreadable)?.is_dir() {
        return Err(unreadable(std::io::ErrorKind::IsADirectory.into()));
    }
    let checked = read(BufReader::new(file)).and_then(check);
    checked.map_err(|what| MeshError::Corrupt { path: path.into(), what })
}

fn check(triangles: Vec<Triangle>) -> Result<Vec<Triangle>, String> {
    let is_finite = |t: &Triangle| [t.v0, t.v1, t.v2].iter().all(|v| v.is_finite());
    match triangles.iter().position(|t| !is_finite(t)) {
        Some(bad) => Err(format!("triangle {bad} has a corner that is not a finite number")),
        None if triangles.is_empty() => Err("it holds no triangle".to_owned()),
        None => Ok(triangles),
    }
}

fn obj(mut file: BufReader<File>) -> Result<Vec<Triangle>, String> {
    let options = LoadOptions { triangulate: true, ..LoadOptions::default() };
    let no_materials = |_: &Path| Err(tobj::LoadError::GenericFailure);
    let (models, _) =
        tobj::load_obj_buf(&mut file, &options, no_materials).map_err(|e| e.to_string())?;
    let mut triangles = Vec::new();
    for mesh in models.iter().map(|m| &m.mesh) {
        let vertices: Vec<Vec3> = mesh.positions.chunks_exact(3).map(Vec3::from_slice).collect();
        // Lines and points have been made triangles without an area.
        for corners in mesh.indices.chunks_exact(3) {
            triangles.extend(fan(&vertices, corners.iter().map(|i| Some(*i as usize)))?);
        }
    }
    Ok(triangles)
}

fn ply(mut file: BufReader<File>) -> Result<Vec<Triangle>, String> {
    let parser = Parser::<DefaultElement>::new();
    let ply = parser.read_ply(&mut file).map_err(|e| first_line(&e.to_string()))?;
    let elements = |name: &str| ply.payload.get(name).map_or(&[][..], |list| &list[..]);
    let coordinate = |vertex: &DefaultElement, name| vertex.get(name).and_then(number);
    let vertex = |v| Some(vec3(coordinate(v, "x")?, coordinate(v, "y")?, coordinate(v, "z")?));
    let vertices: Option<Vec<Vec3>> = elements("vertex").iter().map(vertex).collect();
    let vertices = vertices.ok_or("a vertex has no x, y and z")?;
    let mut triangles = Vec::new();
    for face in elements("face") {
        let list = face.get("vertex_indices").or_else(|| face.get("vertex_index"));
        let corners = list.and_then(numbers).ok_or("a face has no list 'vertex_indices'")?;
        triangles.extend(fan(&vertices, corners.into_iter())?);
    }
    Ok(triangles)
}

fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().trim().chars().take(160).collect()
}

fn number(property: &Property) -> Option<f32> {
    match property {
        Property::Float(x) => Some(*x),
        Property::Double(x) => Some(*x as f32),
        _ => None,
    }
}

/// Indices; none for a negative one.
fn numbers(property: &Property) -> Option<Vec<Option<usize>>> {
    fn wide<T: Copy + TryInto<usize>>(list: &[T]) -> Vec<Option<usize>> {
        list.iter().map(|i| (*i).try_into().ok()).collect()
    }
    match property {
        Property::ListChar(list) => Some(wide(list)),
        Property::ListUChar(list) => Some(wide(list)),
        Property::ListShort(list) => Some(wide(list)),
        Property::ListUShort(list) => Some(wide(list)),
        Property::ListInt(list) => Some(wide(list)),
        Property::ListUInt(list) => Some(wide(list)),
        _ => None,
    }
}

/// A polygon's triangles, all with its first corner.
fn fan(
    vertices: &[Vec3],
    corners: impl Iterator<Item = Option<usize>>,
) -> Result<impl Iterator<Item = Triangle>, String> {
    let place = |i: Option<usize>| i.and_then(|i| vertices.get(i)).copied();
    let polygon: Option<Vec<Vec3>> = corners.map(place).collect();
    let polygon = polygon.ok_or_else(|| {
        format!("a face has a corner that is none of the {} vertices", vertices.len())
    })?;
    let count = polygon.len().saturating_sub(2);
    let triangle = move |i| Triangle { v0: polygon[0], v1: polygon[i], v2: polygon[i + 1] };
    Ok((1..=count).map(triangle))
}

fn tri(mut file: BufReader<File>) -> Result<Vec<Triangle>, String> {
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(|e| e.to_string())?;
    let (head, body) = bytes.split_first_chunk().ok_or("it is shorter than 4 bytes")?;
    let count = u32::from_le_bytes(*head);
    let expected = u64::from(count) * 36;
    if body.len() as u64 != expected {
        let found = body.len();
        return Err(format!("{count} triangles take {expected} bytes, {found} follow"));
    }
    let (numbers, _) = body.as_chunks::<4>();
    let numbers: Vec<f32> = numbers.iter().map(|b| f32::from_le_bytes(*b)).collect();
    let corner = |n: &[f32], i: usize| Vec3::from_slice(&n[3 * i..]);
    let face = |n: &[f32]| Triangle { v0: corner(n, 0), v1: corner(n, 1), v2: corner(n, 2) };
    Ok(numbers.chunks_exact(9).map(face).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a file of this name and content gives.
    fn read(name: &str, content: &[u8]) -> Result<Vec<Triangle>, String> {
        let path = std::env::temp_dir().join(format!("raydsl-{}-{name}", std::process::id()));
        std::fs::write(&path, content).expect("the temporary folder can be written");
        let found = load(&path);
        std::fs::remove_file(&path).expect("the file is there");
        found.map_err(|e| e.to_string())
    }

    const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
        property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

    #[test]
    fn a_square_in_every_format() {
        let obj = read("square.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
        let triangles = obj.expect("a square");
        assert_eq!(triangles.len(), 2);
        let ply = read("square.ply", format!("{PLY}4 0 1 2 3\n").as_bytes());
        assert_eq!(ply.expect("a square"), triangles);
        let mut tri = 2u32.to_le_bytes().to_vec();
        for t in &triangles {
            let corners = [t.v0, t.v1, t.v2].map(|v| v.to_array()).concat();
            tri.extend(corners.iter().flat_map(|x| x.to_le_bytes()));
        }
        assert_eq!(read("square.tri", &tri).expect("a square"), triangles);
        tri.pop();
        assert!(read("short.tri", &tri).is_err_and(|e| e.contains("71 follow")));
    }

    #[test]
    fn broken_files_are_named() {
        let missing = load(Path::new("no/such.obj")).expect_err("it is not there").to_string();
        assert!(missing.starts_with("no/such.obj: cannot be read"), "{missing}");
        assert!(read("mesh.stl", b"").is_err_and(|e| e.contains(".obj, .ply or .tri")));
        for (name, content, what) in [
            ("a.obj", "v 0 0 0\nf 1 2 3\n", "out of bounds"),
            ("b.obj", "v 0 0 x\n", "position"),
            ("c.obj", "v 0 0 0\n", "no triangle"),
            ("d.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "finite"),
            ("e.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -9 2 3\n", "out of bounds"),
            ("f.ply", "ply\nformat ascii 1.0\n", ""),
            ("g.ply", &format!("{PLY}3 0 1 9\n"), "none of the 4 vertices"),
            ("h.ply", &format!("{PLY}3 0 1 -1\n"), "none of the 4 vertices"),
            ("i.ply", &format!("{PLY}2 0 1\n"), "no triangle"),
            ("j.ply", PLY, ""),
            ("k.ply", &PLY.replace("float x", "int x"), ""),
            ("l.ply", &PLY.replace("vertex 4", "vertex 99999999999999"), ""),
            ("m.tri", "ab", "shorter than 4"),
            ("n.tri", "\u{7f}\u{7f}\u{7f}\u{7f}", "0 follow"),
        ] {
            let error = read(name, content.as_bytes()).expect_err(name);
            assert!(error.contains("is no valid mesh") && error.contains(what), "{error}");
            assert!(!error.contains('\n'), "{error}");
        }
    }
}
