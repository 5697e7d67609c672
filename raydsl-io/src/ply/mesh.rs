//! Triangles of a PLY.

use glam::Vec3;

use super::body::{Body, Row};
use super::header::{self, Element, Header, Kind, Property};
use super::{REMEDY, coordinates, numbers, required};
use crate::mesh::{Mesh, SPLIT, fan};
use crate::source::Source;
use crate::{LoadError, Place};

pub(crate) fn read(mut source: Source) -> Result<Mesh, LoadError> {
    let header = header::read(&mut source)?;
    let vertex = required(&source, &header, "vertex", "")?;
    let face = required(&source, &header, "face", ": its points are loaded as a cloud")?;
    let places = coordinates(&source, vertex)?;
    let corners = corners(&source, face)?;
    let mut mesh = room(&source, &header, [vertex, face])?;
    let mut body = Body::new(source, &header);
    // What follows both is not asked for.
    let mut missing = 2;
    for element in &header.elements {
        match &*element.name {
            "vertex" => read_vertices(&mut body, vertex, places, &mut mesh)?,
            "face" => read_faces(&mut body, face, corners, vertex.count, &mut mesh)?,
            _ => {
                body.skip(element)?;
                continue;
            }
        }
        missing -= 1;
        if missing == 0 {
            break;
        }
    }
    Ok(mesh)
}

/// The place of the list of a face's corners.
fn corners(source: &Source, face: &Element) -> Result<usize, LoadError> {
    let is_named = |p: &&Property| p.name == "vertex_indices" || p.name == "vertex_index";
    let is_list = |p: &Property| matches!(p.kind, Kind::List(_, item) if item.is_integer());
    let found = face.properties.iter().position(|p| is_named(&p) && is_list(p));
    found.ok_or_else(|| {
        let what = "its faces have no list of integers 'vertex_indices' or 'vertex_index'";
        source.corrupt(Place::Somewhere, what.into(), REMEDY)
    })
}

/// Room for the rows that the header claims, as far as the file may hold them.
fn room(
    source: &Source,
    header: &Header,
    [vertex, face]: [&Element; 2],
) -> Result<Mesh, LoadError> {
    let mut mesh = Mesh::default();
    for (element, what) in [(vertex, "vertex"), (face, "triangle")] {
        let (count, limit) = (element.count, u64::from(u32::MAX));
        let path = || source.path.clone();
        if count > limit {
            return Err(LoadError::TooMany { path: path(), what, count, limit, remedy: SPLIT });
        }
        let held = source.remaining() / element.least_size(header.encoding).max(1);
        let credible = count.min(held) as usize;
        let reserved = match what {
            "vertex" => mesh.vertices.try_reserve_exact(credible),
            _ => mesh.triangles.try_reserve_exact(credible),
        };
        reserved.map_err(|_| LoadError::OutOfMemory {
            path: path(),
            what,
            count,
            remedy: SPLIT,
        })?;
    }
    Ok(mesh)
}

fn read_vertices(
    body: &mut Body,
    vertex: &Element,
    places: [usize; 3],
    mesh: &mut Mesh,
) -> Result<(), LoadError> {
    let normal = numbers(vertex, ["nx", "ny", "nz"]);
    let mut row = Row::default();
    for i in 0..vertex.count {
        body.read(vertex, i, None, &mut row)?;
        let vector = |places: [usize; 3]| Vec3::from(places.map(|p| row.numbers[p] as f32));
        mesh.vertices.push(vector(places));
        mesh.normals.extend(normal.map(vector));
    }
    Ok(())
}

fn read_faces(
    body: &mut Body,
    face: &Element,
    corners: usize,
    vertices: u64,
    mesh: &mut Mesh,
) -> Result<(), LoadError> {
    let (mut row, mut polygon) = (Row::default(), Vec::new());
    for i in 0..face.count {
        let start = body.source.at;
        body.read(face, i, Some(corners), &mut row)?;
        polygon.clear();
        for index in &row.list {
            // A text may write any number where the header says an integer.
            if index.fract() != 0.0 || !(0.0..vertices as f64).contains(index) {
                let what = format!("the corner {index} is none of the {vertices} vertices");
                return Err(body.bad_row(start, what));
            }
            polygon.push(*index as u32);
        }
        mesh.triangles.extend(fan(&polygon));
    }
    Ok(())
}
